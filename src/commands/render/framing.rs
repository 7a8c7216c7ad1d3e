//! The camera of `--view`.

use glam::{DVec2, DVec3};

use crate::commands::arguments::View;
use crate::commands::failure::Failure;
use crate::encoding::{FaceSlot, PackedScene};
use crate::kernel::face::{Face, Side};
use crate::kernel::view::{Camera, Projection, StandardView};
use crate::scene::records::{FaceRecord, ModelRecord};

/// Opening angle of the oblique view, radians.
const FOV_Y: f64 = 0.5;

/// The camera that shows `view` of a whole model or one face in a window of `aspect` = width / height:
/// the oblique view in perspective, all others in parallel projection.
///
/// # Errors
/// [`Failure::Usage`] when the model has no such face.
pub fn camera_for(
    view: View,
    model: &ModelRecord,
    scene: &PackedScene,
    aspect: f64,
) -> Result<Camera, Failure> {
    let parallel = Projection::Orthographic { height: 1.0 };
    match view {
        View::Standard(view) => {
            let (direction, up) = view.directions();
            let projection = match view {
                StandardView::Iso => Projection::Perspective { fov_y: FOV_Y },
                _ => parallel,
            };
            Ok(Camera::fit(&scene.bounds(), direction, up, projection, aspect))
        }
        View::Fit(number) => {
            let count = model.faces.len();
            let missing = || Failure::Usage {
                reason: format!("there is no face {number} to fit; faces are numbered 1 to {count}"),
            };
            let record = model.faces.get(number - 1).ok_or_else(missing)?;
            let bounds = u32::try_from(number - 1).ok().and_then(|slot| scene.face_bounds(FaceSlot(slot)));
            let direction = -outside(record);
            let up = if direction.z.abs() > 0.95 { DVec3::Y } else { DVec3::Z };
            Ok(Camera::fit(&bounds.ok_or_else(missing)?, direction, up, parallel, aspect))
        }
    }
}

/// The mean direction away from the outside of a face; of a closed face, that of one point.
fn outside(record: &FaceRecord) -> DVec3 {
    const STEPS: usize = 16;
    let Ok(face) = Face::derive(record) else { return DVec3::Z };
    let (mut sum, mut first, mut count) = (DVec3::ZERO, DVec3::ZERO, 0.0);
    for k in 0..STEPS * STEPS {
        let step = DVec2::new((k / STEPS) as f64 + 0.5, (k % STEPS) as f64 + 0.5) / STEPS as f64;
        let uv = face.domain.native(step);
        if face.classify_native(uv.x, uv.y) == Side::Out {
            continue;
        }
        let jet = record.surface.jet(uv.x, uv.y);
        let normal = jet.du.cross(jet.dv).normalize_or_zero();
        first = if first == DVec3::ZERO { normal } else { first };
        sum += normal;
        count += 1.0;
    }
    let sign = if record.reversed { -1.0 } else { 1.0 };
    let normal = if sum.length() > 0.2 * count { sum } else { first };
    (sign * normal).try_normalize().unwrap_or(DVec3::Z)
}
