//! The camera of `--view`: as near as the visible parts of the faces allow.
//!
//! Framing is exact for sample points of the trimmed faces, not for their boxes: in perspective each pair of
//! opposite window sides asks for a distance and a sideways shift, and the larger distance wins.

use glam::{DVec2, DVec3};

use super::pack::Prepared;
use crate::commands::arguments::View;
use crate::commands::failure::Failure;
use crate::kernel::bezier::BezierPatch;
use crate::kernel::face::{Face, Side};
use crate::kernel::view::{Bounds, Camera, Projection, StandardView};
use crate::scene::records::ModelRecord;

/// Opening angle of the oblique view, radians.
const FOV_Y: f64 = 0.5;
/// Part of the window's half size that the model may fill.
const FILL: f64 = 0.93;
/// Samples along each side of a patch.
const STEPS: usize = 8;

/// A visible point of a face and the direction away from its outside.
type Sample = (DVec3, DVec3);

/// The camera that shows `view` of a whole model or one face in a window of `aspect` = width / height:
/// the oblique view in perspective, all others in parallel projection.
///
/// # Errors
/// [`Failure::Usage`] when the model has no such face.
pub fn camera_for(view: View, model: &ModelRecord, ready: &Prepared, aspect: f64) -> Result<Camera, Failure> {
    let faces = || ready.faces.iter().zip(&model.faces);
    let sampled = |(face, record): (&Option<Face>, &crate::scene::records::FaceRecord)| {
        face.as_ref().map_or_else(Vec::new, |face| samples(face, record.reversed))
    };
    match view {
        View::Standard(view) => {
            let points: Vec<DVec3> = faces().flat_map(sampled).map(|(point, _)| point).collect();
            let (direction, up) = view.directions();
            Ok(match view {
                StandardView::Iso => perspective(&points, direction, up, aspect),
                _ => parallel(&points, direction, up, aspect),
            })
        }
        View::Fit(number) => {
            let count = model.faces.len();
            let samples = faces().nth(number - 1).map(sampled).ok_or_else(|| Failure::Usage {
                reason: format!("there is no face {number} to fit; faces are numbered 1 to {count}"),
            })?;
            let direction = -outside(&samples);
            let up = if direction.z.abs() > 0.95 { DVec3::Y } else { DVec3::Z };
            let points: Vec<DVec3> = samples.iter().map(|(point, _)| *point).collect();
            Ok(parallel(&points, direction, up, aspect))
        }
    }
}

/// Visible points all over a face and on its trim loops; if none are found, points of the whole surface.
fn samples(face: &Face, reversed: bool) -> Vec<Sample> {
    let sign = if reversed { -1.0 } else { 1.0 };
    let (mut seen, mut all) = (Vec::new(), Vec::new());
    for patch in &face.patches {
        for k in 0..(STEPS + 1) * (STEPS + 1) {
            let uv = DVec2::new((k / (STEPS + 1)) as f64, (k % (STEPS + 1)) as f64) / STEPS as f64;
            let tangents = patch.tangents(uv.x, uv.y);
            let sample = (tangents.point, sign * tangents.du.cross(tangents.dv).normalize_or_zero());
            let native = patch.native(uv);
            all.push(sample);
            if face.classify_native(native.x, native.y) != Side::Out {
                seen.push(sample);
            }
        }
    }
    // Loops reach farthest, and narrow parts may lie between the samples.
    for piece in face.pieces.pieces() {
        let native = face.domain.native(face.pieces.start(piece));
        let holds = |p: &&BezierPatch| native.cmpge(p.uv_min).all() && native.cmple(p.uv_max).all();
        if let Some(patch) = face.patches.iter().find(holds) {
            let uv = patch.local(native);
            seen.push((patch.point(uv.x, uv.y), DVec3::ZERO));
        }
    }
    if seen.is_empty() { all } else { seen }
}

/// The mean direction away from the outside; of a closed face, that of one point.
fn outside(samples: &[Sample]) -> DVec3 {
    let sum: DVec3 = samples.iter().map(|(_, normal)| *normal).sum();
    let first = samples.iter().map(|(_, normal)| *normal).find(|n| *n != DVec3::ZERO);
    let normal = if sum.length() > 0.2 * samples.len() as f64 { Some(sum) } else { first };
    normal.and_then(DVec3::try_normalize).unwrap_or(DVec3::Z)
}

/// Points relative to `centre` along the window's axes: right, up, towards the viewer.
fn in_window(points: &[DVec3], centre: DVec3, camera: &Camera) -> Vec<DVec3> {
    let (right, up, back) = camera.axes();
    points.iter().map(|p| *p - centre).map(|p| DVec3::new(p.dot(right), p.dot(up), p.dot(back))).collect()
}

fn parallel(points: &[DVec3], direction: DVec3, up: DVec3, aspect: f64) -> Camera {
    let bounds = Bounds::of(points.iter().copied());
    let camera = Camera::fit(&bounds, direction, up, Projection::Orthographic { height: 1.0 }, aspect);
    let seen = Bounds::of(in_window(points, bounds.centre(), &camera));
    if seen.is_empty() {
        return camera;
    }
    let (right, up_axis, _) = camera.axes();
    let (middle, size) = (seen.centre(), seen.max - seen.min);
    let shift = right * middle.x + up_axis * middle.y;
    let height = (size.y.max(size.x / aspect) / FILL).max(1e-6 * bounds.diagonal()).max(f64::MIN_POSITIVE);
    Camera {
        eye: camera.eye + shift,
        target: camera.target + shift,
        projection: Projection::Orthographic { height },
        ..camera
    }
}

fn perspective(points: &[DVec3], direction: DVec3, up: DVec3, aspect: f64) -> Camera {
    let bounds = Bounds::of(points.iter().copied());
    let camera = Camera::fit(&bounds, direction, up, Projection::Perspective { fov_y: FOV_Y }, aspect);
    let seen = in_window(points, bounds.centre(), &camera);
    let tan = FILL * (0.5 * FOV_Y).tan();
    // The farthest that any point pushes a side plane of slope `tan` outwards.
    let reach = |tan: f64, along: &dyn Fn(&DVec3) -> f64| {
        seen.iter().map(|p| along(p) + tan * p.z).fold(f64::NEG_INFINITY, f64::max)
    };
    let (east, west) = (reach(tan * aspect, &|p| p.x), reach(tan * aspect, &|p| -p.x));
    let (north, south) = (reach(tan, &|p| p.y), reach(tan, &|p| -p.y));
    let distance = (0.5 * (east + west) / (tan * aspect)).max(0.5 * (north + south) / tan);
    if !(distance.is_finite() && distance > 1e-6 * bounds.diagonal()) {
        return camera;
    }
    let (right, up_axis, back) = camera.axes();
    let target = bounds.centre() + right * (0.5 * (east - west)) + up_axis * (0.5 * (north - south));
    Camera { eye: target + back * distance, target, ..camera }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn on_screen(camera: &Camera, point: DVec3, aspect: f64) -> DVec2 {
        let (right, up, back) = camera.axes();
        let from = point - camera.target;
        let half = camera.half_extent(aspect);
        let scale = match camera.projection {
            Projection::Perspective { .. } => camera.distance() / (camera.eye - point).dot(back),
            Projection::Orthographic { .. } => 1.0,
        };
        DVec2::new(from.dot(right), from.dot(up)) * scale / half
    }

    #[test]
    fn everything_is_in_the_window_and_touches_opposite_sides() {
        let points: Vec<DVec3> = (0..60_u32)
            .map(f64::from)
            .map(|k| {
                DVec3::new(30.0 * (k * 0.7).sin() + 500.0, 80.0 * (k * 1.3).cos(), 9.0 * (k * 2.1).sin())
            })
            .collect();
        for view in [StandardView::Iso, StandardView::Left, StandardView::Top] {
            let (direction, up) = view.directions();
            for aspect in [0.5, 1.0, 2.5] {
                for make in [perspective, parallel] {
                    let camera = make(&points, direction, up, aspect);
                    let seen: Vec<DVec2> = points.iter().map(|p| on_screen(&camera, *p, aspect)).collect();
                    let low = seen.iter().fold(DVec2::INFINITY, |a, p| a.min(*p));
                    let high = seen.iter().fold(DVec2::NEG_INFINITY, |a, p| a.max(*p));
                    assert!(low.min_element() >= -FILL - 1e-9 && high.max_element() <= FILL + 1e-9);
                    let filled = (high - low).max_element();
                    assert!((filled - 2.0 * FILL).abs() < 1e-9, "{view:?} {aspect} {filled}");
                }
            }
        }
    }
}
