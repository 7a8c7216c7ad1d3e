//! A drag of handles in the 3D view, without any Bevy in it.
//!
//! Trim curves follow the pointer on the surface: its ray gives parameters, near those before. Control points of
//! the surface move in the plane that faces the viewer, or along an axis. Previews are relative to the
//! beginning, so the way the mouse took does not matter.

use bevy::prelude::Vec2;
use glam::{DVec2, DVec3};

use super::aim::{Aimed, Lens};
use super::shapes::HandleShapes;
use crate::editor::camera::motion;
use crate::editor::elements::{Element, FaceInHand};
use crate::editor::uv::moving::{Moved, surface_operation};
use crate::kernel::nurbs::NurbsCurve2;
use crate::scene::operation::Operation;

/// Reach of end points that a drag snaps to, logical pixels.
const SNAP_REACH_PX: f32 = 8.0;

/// What is dragged.
#[derive(Debug, Clone, PartialEq)]
pub enum HandleDrag {
    /// Elements of trim curves.
    Trim {
        /// Parameters of the place gripped.
        grip: DVec2,
        /// Between the pointer and that place when it was gripped, logical pixels.
        offset: Vec2,
        /// Where it is now: the next ray goes on from here.
        now: DVec2,
        /// What moves.
        what: Moved,
        /// Parameters of ends worth meeting.
        ends: Vec<DVec2>,
        /// The end that is met now.
        met: Option<DVec2>,
    },
    /// Control points of the surface.
    Net {
        /// The place gripped, in space.
        grip: DVec3,
        /// Between the pointer and that place when it was gripped, logical pixels.
        offset: Vec2,
        /// What moves.
        points: Vec<usize>,
        /// Along which axis, if along one.
        axis: Option<usize>,
        /// How far.
        by: DVec3,
    },
}

impl HandleDrag {
    /// Takes hold of `elements` at the handle that was aimed at.
    pub fn begin(
        aimed: Aimed,
        at: Vec2,
        elements: &[Element],
        face: &FaceInHand,
        shapes: &HandleShapes,
        lens: &Lens,
    ) -> Option<Self> {
        let (on_screen, _) = lens.project(aimed.place)?;
        let offset = on_screen - at;
        if matches!(aimed.element, Element::SurfacePoint { .. }) {
            let point = |e: &Element| match e {
                Element::SurfacePoint { point } => Some(*point),
                _ => None,
            };
            let points = elements.iter().filter_map(point).collect();
            return Some(Self::Net { grip: aimed.place, offset, points, axis: None, by: DVec3::ZERO });
        }
        let grip = match aimed.element {
            Element::Point { trim_loop, curve, point } => face.point((trim_loop, curve, point))?,
            _ => {
                let (trim_loop, number) = aimed.element.curve()?;
                nearest_parameters(face.curve(trim_loop, number)?, aimed.place, shapes)?
            }
        };
        let what = Moved::of(elements, face);
        let moving = crate::editor::uv::moving::with_joined(face, &what);
        let mut ends = Vec::new();
        for (l, record) in face.loops.iter().enumerate() {
            for (c, curve) in record.curves.iter().enumerate() {
                let last = curve.points().len() - 1;
                let still = [0, last].into_iter().filter(|p| !moving.contains(&(l, c, *p)));
                ends.extend(still.map(|p| curve.points()[p]));
            }
        }
        Some(Self::Trim { grip, offset, now: grip, what, ends, met: None })
    }

    /// Follows the pointer to `at`; the operation to preview, if something changed.
    pub fn follow(
        &mut self,
        at: Vec2,
        face: &FaceInHand,
        shapes: &HandleShapes,
        lens: &Lens,
        snaps: bool,
    ) -> Option<Operation> {
        match self {
            Self::Trim { grip, offset, now, what, ends, met } => {
                let target = at + *offset;
                let map = shapes.map.as_ref()?;
                let ray = lens.camera.ray(lens.viewport.ndc(target), lens.viewport.aspect());
                let free = map.follow(&ray, *now)?;
                *met = None;
                if snaps {
                    let close = |e: &&DVec2| {
                        lens.project(map.point(**e)).is_some_and(|(p, _)| p.distance(target) <= SNAP_REACH_PX)
                    };
                    *met = ends.iter().find(close).copied();
                }
                let uv = met.unwrap_or(free);
                if uv == *now || !uv.is_finite() {
                    return None;
                }
                *now = uv;
                Some(what.operation(face.id, uv - *grip))
            }
            Self::Net { grip, offset, points, axis, by } => {
                let ndc = lens.viewport.ndc(at + *offset);
                let aspect = lens.viewport.aspect();
                let to = match *axis {
                    None => motion::on_plane(lens.camera, *grip, ndc, aspect),
                    Some(axis) => along_axis(&lens.camera.ray(ndc, aspect), *grip, axis),
                };
                let next = to - *grip;
                if next == *by || !next.is_finite() {
                    return None;
                }
                *by = next;
                let (_, count_v) = face.surface.counts();
                Some(surface_operation(face.id, points, count_v, next))
            }
        }
    }
}

/// The point of the line through `from` along an axis that is nearest to a ray.
fn along_axis(ray: &crate::kernel::view::Ray, from: DVec3, axis: usize) -> DVec3 {
    let along = DVec3::AXES[axis];
    let (w, b) = (from - ray.origin, along.dot(ray.direction));
    let t = (b * w.dot(ray.direction) - w.dot(along)) / (1.0 - b * b);
    if t.is_finite() { from + along * t } else { from }
}

/// Parameters of the point of a trim curve whose image is nearest to a point of space: samples, then halving steps.
fn nearest_parameters(curve: &NurbsCurve2, place: DVec3, shapes: &HandleShapes) -> Option<DVec2> {
    const SAMPLES: usize = 64;
    let map = shapes.map.as_ref()?;
    let (start, end) = curve.domain();
    let spans = curve.knots().breaks().len().max(2) - 1;
    let count = SAMPLES * spans.min(64);
    let off = |t: f64| (map.point(curve.point(t)) - place).length();
    let sample = |k: usize| start + (end - start) * k as f64 / count as f64;
    let mut best = (0..=count).map(sample).min_by(|a, b| off(*a).total_cmp(&off(*b)))?;
    let mut step = (end - start) / count as f64;
    for _ in 0..30 {
        let candidates = [best - step, best, best + step].map(|t| t.clamp(start, end));
        best = candidates.into_iter().min_by(|a, b| off(*a).total_cmp(&off(*b)))?;
        step *= 0.5;
    }
    Some(curve.point(best))
}
