//! Choosing an edge: from the table, by the tour, or in the viewport; the camera flies to where its gap is largest.

use bevy::prelude::*;
use bevy::window::RequestRedraw;
use glam::DVec3;

use super::{Findings, InspectionChoices, Row, Rows};
use crate::editor::camera::CameraRequest;
use crate::editor::panels::Notices;
use crate::editor::selection::{SelectMode, SelectRequest};
use crate::editor::settings::Settings;
use crate::editor::tools::{Action, CommandRequest};
use crate::editor::viewport::Viewport;
use crate::inspect::{Edge, EdgeKey, FINEST_PIXEL, GapSense, Inspection};

/// How wide the tour shows a gap, logical pixels.
const GAP_PX: f64 = 20.0;

/// The edge looked at.
#[derive(Resource, Debug, Clone, Copy, Default, PartialEq, Eq)]
pub struct Chosen {
    /// Its key; an edge that goes away by an edit is not chosen any more.
    pub edge: Option<EdgeKey>,
}

/// Asks for an edge to be looked at.
#[derive(Message, Debug, Clone, Copy, PartialEq, Eq)]
pub enum InspectRequest {
    /// Choose it and, when asked, fly there.
    Choose {
        /// The edge.
        edge: EdgeKey,
        /// Whether the camera goes there.
        fly: bool,
    },
    /// The next defect in the order of the table, or the one before; from the worst when none is chosen.
    Step {
        /// Towards the end of the table.
        forward: bool,
    },
    /// Choose none.
    Clear,
}

/// The tour from the command table; switching the inspection off chooses none.
pub(super) fn command_requests(
    mut commands: MessageReader<CommandRequest>,
    settings: Res<Settings>,
    mut requests: MessageWriter<InspectRequest>,
) {
    for CommandRequest(action) in commands.read() {
        match action {
            Action::NextDefect => requests.write(InspectRequest::Step { forward: true }),
            Action::PreviousDefect => requests.write(InspectRequest::Step { forward: false }),
            Action::ToggleInspection if !settings.inspection => requests.write(InspectRequest::Clear),
            _ => continue,
        };
    }
}

/// Serves the requests.
pub(super) fn serve(
    mut requests: MessageReader<InspectRequest>,
    findings: Res<Findings>,
    choices: Res<InspectionChoices>,
    rows: Res<Rows>,
    viewport: Res<Viewport>,
    mut chosen: ResMut<Chosen>,
    mut notices: ResMut<Notices>,
    mut select: MessageWriter<SelectRequest>,
    mut camera: MessageWriter<CameraRequest>,
    mut redraw: MessageWriter<RequestRedraw>,
) {
    let gone = chosen.edge.is_some_and(|key| findings.edge(&key).is_none());
    if gone {
        chosen.edge = None;
    }
    for request in requests.read() {
        let (edge, fly) = match *request {
            InspectRequest::Choose { edge, fly } => (Some(edge), fly),
            InspectRequest::Clear => (None, false),
            InspectRequest::Step { forward } => {
                let next = step(&rows.rows, chosen.edge, forward, choices.tolerance);
                if next.is_none() && findings.inspection().is_some() {
                    notices.info("No edge in the table is above the tolerance".into());
                }
                (next.or(chosen.edge), true)
            }
        };
        chosen.set_if_neq(Chosen { edge });
        redraw.write(RequestRedraw);
        let (Some(key), Some(inspection)) = (edge, findings.inspection()) else { continue };
        let Some(edge) = inspection.edge(&key) else { continue };
        let faces = edge.faces().into_iter().filter_map(|f| findings.face(f)).collect();
        select.write(SelectRequest { faces, mode: SelectMode::Replace });
        if fly && let Some((look, held)) = approach(inspection, edge, f64::from(viewport.size.y)) {
            camera.write(look);
            if held {
                notices.info("No nearer: the picture is not precise enough to show this gap wider".into());
            }
        }
    }
}

/// The defect after (or before) the chosen one in the order shown, round the end.
fn step(rows: &[Row], from: Option<EdgeKey>, forward: bool, tolerance: f64) -> Option<EdgeKey> {
    let defects: Vec<EdgeKey> = rows.iter().filter(|r| r.is_defect(tolerance)).map(|r| r.key).collect();
    let count = defects.len();
    let at = from.and_then(|key| defects.iter().position(|k| *k == key));
    let next = match (at, forward) {
        (_, _) if count == 0 => return None,
        (None, _) => 0,
        (Some(at), true) => (at + 1) % count,
        (Some(at), false) => (at + count - 1) % count,
    };
    Some(defects[next])
}

/// The view in which the gap is about [`GAP_PX`] wide, or less where that is closer than the picture is precise: along the normal, from the side where the sides are at
/// different heights. Edges without a gap are shown whole.
/// The flag tells of that.
fn approach(inspection: &Inspection, edge: &Edge, height_px: f64) -> Option<(CameraRequest, bool)> {
    let first = edge.uses.first()?;
    let curve = inspection.curve(&first.curve)?;
    let (point, t, size, held) = match &edge.gap {
        Some(gap) if gap.maximum > 0.0 => {
            let [a, b] = &gap.between;
            let t = if a.side == 0 { a.t } else { b.t };
            let wanted = gap.maximum * height_px / GAP_PX;
            let sides = edge.uses.iter().filter_map(|side| inspection.curve(&side.curve));
            let face_size = sides.map(|side| side.ground().size()).fold(0.0, f64::max);
            let least = FINEST_PIXEL * face_size * height_px;
            (a.point.midpoint(b.point), t, wanted.max(least), wanted < least)
        }
        _ => {
            let t = 0.5 * (first.interval.0 + first.interval.1);
            (curve.at(t).point, t, 1.6 * edge.length(), false)
        }
    };
    let at = curve.at(t);
    let normal = curve.ground().normal(at.uv)?;
    let along = at.tangent.try_normalize().unwrap_or_else(|| normal.any_orthonormal_vector());
    let inward = curve.inward(t).unwrap_or_else(|| normal.cross(along));
    let is_step = edge.gap.is_some_and(|g| g.sense == GapSense::Step);
    // Seen from 35 degrees above the surface a step shows its height.
    let back = if is_step { (normal * 0.57 - inward * 0.82).normalize_or(normal) } else { normal };
    let up = if is_step { normal } else { upright(back, inward) };
    let look = CameraRequest::Approach { point, direction: -back, up, size };
    (size.is_finite() && size > 0.0).then_some((look, held))
}

/// World z as up where that can be told, else into the face.
fn upright(back: DVec3, inward: DVec3) -> DVec3 {
    if back.z.abs() < 0.9 { DVec3::Z } else { inward }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::inspect::{CurveAddress, EdgeKind};

    fn row(face: usize, gap: f64) -> Row {
        let curve = CurveAddress { face, trim_loop: 0, curve: 0 };
        Row {
            key: EdgeKey { curve, position: 0 },
            kind: EdgeKind::Shared,
            faces: vec![face],
            gap: Some(gap),
            mean: None,
            sense: None,
            length: 1.0,
            angle: None,
        }
    }

    #[test]
    fn the_tour_goes_round_the_defects_and_passes_over_the_rest() {
        let rows = [row(0, 1.0), row(1, 1e-9), row(2, 0.5), row(3, 0.2)];
        let mut at = None;
        let mut seen = Vec::new();
        for _ in 0..4 {
            at = step(&rows, at, true, 0.1);
            seen.extend(at.map(|k| k.curve.face));
        }
        assert_eq!(seen, [0, 2, 3, 0]);
        assert_eq!(step(&rows, at, false, 0.1).map(|k| k.curve.face), Some(3));
        assert_eq!(step(&rows, None, true, 10.0), None);
    }
}
