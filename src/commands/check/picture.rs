//! A picture of one gap: the faces on either side, seen so that the gap is about twenty pixels wide.
//!
//! The camera looks along the direction in which the gap shows best: from the side that the faces' normals
//! point to, perpendicular to the line between the two points. Only the faces of the edge are drawn, so that
//! nothing hides it. Below what 32-bit floats resolve at the size of a face the gap is drawn smaller.

use glam::{DVec2, DVec3};

use crate::commands::render::{png_of, prepare};
use crate::encoding::{DisplayMode, EdgeStyle, RenderOptions};
use crate::inspect::{Edge, EdgeUse, LiftedCurve};
use crate::kernel::view::{Bounds, Camera, Projection};
use crate::reference;
use crate::scene::records::ModelRecord;

/// Width and height of a picture.
pub const SIZE: [u32; 2] = [480, 320];
/// Pixels that the gap shall be wide.
const GAP_PX: f64 = 20.0;
/// A pixel is not smaller than this part of the faces' size.
const FINEST: f64 = 4e-7;
/// Faces drawn at most: a heap of them looks the same.
const MOST_FACES: usize = 8;

/// A picture with what labels need to know.
pub struct Picture {
    /// The PNG file.
    pub png: Vec<u8>,
    /// Millimetres that a pixel is wide.
    pub mm_per_px: f64,
    /// The two ends of the gap, pixels from the upper left corner.
    pub ends_px: [DVec2; 2],
    /// Where to write the numbers of the first two faces (from 1), pixels.
    pub labels_px: Vec<(usize, DVec2)>,
}

/// Draws the gap of `edge`; `None` when it has none or its faces cannot be drawn.
pub fn draw(model: &ModelRecord, edge: &Edge) -> Option<Picture> {
    let gap = edge.gap.as_ref()?;
    let numbers: Vec<usize> = edge.faces().into_iter().take(MOST_FACES).collect();
    let faces = numbers.iter().filter_map(|k| model.faces.get(*k).cloned()).collect();
    let part = ModelRecord { faces, ..ModelRecord::default() };
    let ready = prepare(&part, &|_| ());
    if ready.faces.iter().all(Option::is_none) {
        return None;
    }
    let curves = gap.between.map(|end| lifted(model, &edge.uses[end.side]));
    let inward: Vec<Option<DVec3>> =
        gap.between.iter().zip(&curves).map(|(end, c)| c.as_ref().and_then(|c| c.inward(end.t))).collect();
    let bounds = ready.faces.iter().flatten().fold(Bounds::EMPTY, |b, f| b.union(f.bounds));
    let [a, b] = gap.between.map(|end| end.point);
    let px = (gap.maximum / GAP_PX).max(FINEST * bounds.diagonal());
    let (direction, up) = sight(b - a, curves[0].as_ref(), gap.between[0].t, &inward, &part)?;
    let target = 0.5 * (a + b);
    let camera = Camera {
        eye: target - direction * (2.0 * bounds.diagonal()),
        target,
        up,
        projection: Projection::Orthographic { height: px * f64::from(SIZE[1]) },
    };
    let options = RenderOptions {
        samples: 4,
        mode: DisplayMode::Faces,
        edges: EdgeStyle { visible: false, ..EdgeStyle::default() },
        ..RenderOptions::new(camera, SIZE)
    };
    let image = reference::render_image(&ready.scene, &options);
    let (right, above, _) = camera.axes();
    let middle = DVec2::new(f64::from(SIZE[0]), f64::from(SIZE[1])) * 0.5;
    let flat = |d: DVec3| DVec2::new(d.dot(right), -d.dot(above));
    let label = |k: usize| {
        let toward = inward[k].map_or(DVec2::ZERO, flat).try_normalize()?;
        let face = edge.uses[gap.between[k].side].curve.face + 1;
        Some((face, middle + toward * 95.0))
    };
    Some(Picture {
        png: png_of(&image).ok()?,
        mm_per_px: px * model.unit.millimetres,
        ends_px: [a, b].map(|p| middle + flat(p - target) / px),
        labels_px: (0..2).filter_map(label).collect(),
    })
}

fn lifted(model: &ModelRecord, one: &EdgeUse) -> Option<LiftedCurve> {
    let record = model.faces.get(one.curve.face)?;
    crate::inspect::lift(one.curve.face, record).into_iter().find(|c| c.address == one.curve)
}

/// Direction of sight and what is up on the picture.
fn sight(
    apart: DVec3,
    curve: Option<&LiftedCurve>,
    t: f64,
    inward: &[Option<DVec3>],
    part: &ModelRecord,
) -> Option<(DVec3, DVec3)> {
    let curve = curve?;
    let along = curve.at(t).tangent.try_normalize()?;
    let normals: Vec<DVec3> =
        inward.iter().flatten().map(|inward| inward.cross(along)).filter_map(DVec3::try_normalize).collect();
    let first = *normals.first()?;
    // Conormals point apart, so their normals do too: all to the side of the first face's own normal.
    let outside = curve.ground().normal(curve.at(t).uv).unwrap_or(first);
    let reversed = part.faces.first().is_some_and(|f| f.reversed);
    let outside = if reversed { -outside } else { outside };
    let sum: DVec3 = normals.iter().map(|n| *n * n.dot(outside).signum()).sum();
    let normal = sum.try_normalize().unwrap_or(outside);
    let toward = match apart.try_normalize() {
        Some(line) => {
            let seen = normal - line * normal.dot(line);
            // A step is seen best at a slant: along the surface, a little from above.
            if seen.length() > 0.35 { seen } else { inward.iter().flatten().next().copied()? + 0.4 * normal }
        }
        None => normal,
    };
    let direction = -toward.try_normalize()?;
    let up = direction.cross(along).try_normalize().map_or(along, |side| side);
    Some((direction, up))
}
