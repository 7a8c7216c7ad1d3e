//! The gap probe: the exact distance between the two sides of an edge at the place under the pointer.

use bevy::prelude::*;
use glam::DVec3;

use super::Findings;
use crate::editor::camera::ViewCamera;
use crate::editor::camera::motion::view_size;
use crate::editor::picking::Picker;
use crate::editor::settings::Settings;
use crate::editor::viewport::Viewport;
use crate::inspect::nearest::nearest;
use crate::inspect::{Edge, EdgeKey, Inspection};

/// The probe takes hold of an edge within this distance on the screen, logical pixels.
const REACH_PX: f64 = 12.0;

/// What the probe measures now.
#[derive(Resource, Debug, Clone, Copy, Default, PartialEq)]
pub struct Probe {
    /// The edge and the two points, when an edge is under the pointer.
    pub reading: Option<(EdgeKey, [DVec3; 2])>,
}

impl Probe {
    /// The distance measured, model units.
    pub fn distance(&self) -> Option<f64> {
        self.reading.map(|(_, [a, b])| a.distance(b))
    }
}

/// Measures at the pointer. The surface point under it comes from the visibility buffer, so that only edges of that
/// face are looked at.
pub(super) fn at_pointer(
    settings: Res<Settings>,
    findings: Res<Findings>,
    picker: Res<Picker>,
    camera: Res<ViewCamera>,
    viewport: Res<Viewport>,
    mut probe: ResMut<Probe>,
) {
    let now = Probe {
        reading: settings.inspection.then(|| read(&findings, &picker, &camera, &viewport)).flatten(),
    };
    probe.set_if_neq(now);
}

fn read(
    findings: &Findings,
    picker: &Picker,
    camera: &ViewCamera,
    viewport: &Viewport,
) -> Option<(EdgeKey, [DVec3; 2])> {
    let (_, hit) = picker.answer.filter(|_| picker.wanted.is_some())?;
    let hit = hit?;
    let inspection = findings.inspection()?;
    let face = findings.number(hit.face)?;
    // In the plane of the hit: nearer than the target means larger on the screen.
    let nearness = match camera.now.projection {
        crate::kernel::view::Projection::Perspective { .. } => {
            camera.now.eye.distance(hit.position) / camera.now.distance().max(f64::MIN_POSITIVE)
        }
        crate::kernel::view::Projection::Orthographic { .. } => 1.0,
    };
    let reach = REACH_PX * view_size(&camera.now) * nearness / f64::from(viewport.size.y.max(1.0));
    let candidates = inspection.edges_of(face).into_iter();
    let measured = candidates.filter_map(|key| {
        let edge = inspection.edge(&key)?;
        let [a, b] = local_gap(inspection, edge, face, hit.position)?;
        let distance = a.distance(hit.position).min(b.distance(hit.position));
        (distance <= reach).then_some((distance, key, [a, b]))
    });
    measured
        .min_by(|x, y| x.0.total_cmp(&y.0).then_with(|| x.1.cmp(&y.1)))
        .map(|(_, key, points)| (key, points))
}

/// The two points of an edge between which its gap is measured beside `place`: on the side of `face`, and on the
/// side nearest to that. None for edges of one side.
pub fn local_gap(inspection: &Inspection, edge: &Edge, face: usize, place: DVec3) -> Option<[DVec3; 2]> {
    let own = edge.uses.iter().position(|u| u.curve.face == face)?;
    let a = nearest(inspection.curve(&edge.uses[own].curve)?, place, edge.uses[own].interval).at.point;
    let others = edge.uses.iter().enumerate().filter(|(k, _)| *k != own);
    let points =
        others.filter_map(|(_, u)| Some(nearest(inspection.curve(&u.curve)?, a, u.interval).at.point));
    let b = points.min_by(|p, q| p.distance(a).total_cmp(&q.distance(a)))?;
    Some([a, b])
}
