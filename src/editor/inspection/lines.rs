//! Edges as polylines in space for drawing, in the colours of their gaps.
//!
//! The chord error is below half a thousandth of the edge's length; the lines mark edges, they do not measure them.
//! Lines of edges that did not change are kept.

use std::collections::HashMap;
use std::sync::Arc;

use bevy::prelude::*;
use glam::DVec3;

use super::{Chosen, Findings, InspectionChoices, ramp};
use crate::editor::object::{FaceChange, Shown};
use crate::inspect::{Edge, EdgeKey, EdgeKind, EdgeUse, Inspection, LiftedCurve};

/// Chord error allowed, as a share of the edge's length.
const CHORD: f64 = 5e-4;
/// Halvings of a stretch between two nodes at most.
const DEPTH: u32 = 5;
/// Widths in logical pixels: harmless edges, defects, the chosen edge.
const WIDTHS: [f32; 3] = [1.5, 3.0, 5.0];

/// One edge to draw.
#[derive(Debug, Clone, PartialEq)]
pub struct EdgeLine {
    /// Points along it.
    pub points: Arc<[DVec3]>,
    /// sRGB.
    pub colour: [u8; 3],
    /// Logical pixels.
    pub width: f32,
}

/// All edges to draw; empty when the colours are off.
#[derive(Resource, Debug, Clone, Default)]
pub struct EdgeLines {
    /// The lines, those to be on top last.
    pub lines: Arc<Vec<EdgeLine>>,
    /// Counts changes.
    pub revision: u64,
}

/// What the lines were made from.
#[derive(Default)]
pub(super) struct Made {
    key: Option<(u64, u64, f64, Option<EdgeKey>)>,
    points: HashMap<EdgeKey, (EdgeUse, Arc<[DVec3]>)>,
}

/// Makes the lines again when edges, tolerance, the chosen edge or what is shown changed.
pub(super) fn update(
    mut findings: ResMut<Findings>,
    choices: Res<InspectionChoices>,
    chosen: Res<Chosen>,
    shown: Query<&Shown>,
    mut changes: MessageReader<FaceChange>,
    mut visibility: Local<u64>,
    mut made: Local<Made>,
    mut lines: ResMut<EdgeLines>,
) {
    if changes.read().any(|c| matches!(c, FaceChange::Shown(_))) {
        *visibility += 1;
    }
    let on = choices.colours && findings.inspection().is_some();
    let key = on.then_some((findings.revision, *visibility, choices.tolerance, chosen.edge));
    if made.key == key {
        return;
    }
    made.key = key;
    lines.revision += 1;
    let Some(inspection) = findings.inspection().filter(|_| on) else {
        lines.lines = Arc::default();
        made.points.clear();
        return;
    };
    let is_shown = |face: usize| findings.face(face).and_then(|f| shown.get(f).ok()).is_some_and(|s| s.0);
    let mut kept = HashMap::with_capacity(made.points.len());
    let mut all: Vec<(u8, EdgeLine)> = Vec::new();
    for (key, edge) in inspection.edges() {
        let Some(first) = edge.uses.first() else { continue };
        if edge.kind == EdgeKind::Degenerate || !edge.uses.iter().any(|u| is_shown(u.curve.face)) {
            continue;
        }
        let known =
            made.points.remove(key).filter(|(on, _)| on == first && !findings.is_dirty(first.curve.face));
        let Some(points) = known.map(|(_, points)| points).or_else(|| polyline(inspection, first)) else {
            continue;
        };
        kept.insert(*key, (*first, points.clone()));
        let defect = is_defect(edge, choices.tolerance / findings.unit());
        let rank = if chosen.edge == Some(*key) { 2 } else { u8::from(defect) };
        let (colour, width) = (ramp::of_edge(edge, findings.unit()), WIDTHS[usize::from(rank)]);
        all.push((rank, EdgeLine { points, colour, width }));
    }
    all.sort_by_key(|(rank, _)| *rank);
    made.points = kept;
    lines.lines = Arc::new(all.into_iter().map(|(_, line)| line).collect());
    findings.clean();
}

fn is_defect(edge: &Edge, tolerance: f64) -> bool {
    match edge.kind {
        EdgeKind::Naked | EdgeKind::NonManifold => true,
        EdgeKind::Shared | EdgeKind::Seam => edge.gap.is_some_and(|g| g.maximum > tolerance),
        EdgeKind::Degenerate => false,
    }
}

/// The image of a stretch of a trim curve as a polyline.
fn polyline(inspection: &Inspection, on: &EdgeUse) -> Option<Arc<[DVec3]>> {
    let curve = inspection.curve(&on.curve)?;
    let (start, end) = on.interval;
    let inner = curve.nodes().iter().map(|n| n.t).filter(|t| *t > start && *t < end);
    let stops: Vec<f64> = std::iter::once(start).chain(inner).chain([end]).collect();
    let mut points = vec![curve.at(start).point];
    for pair in stops.windows(2) {
        let (a, b) = (curve.at(pair[0]).point, curve.at(pair[1]).point);
        refine(curve, (pair[0], a), (pair[1], b), CHORD * on.length, DEPTH, &mut points);
    }
    Some(points.into())
}

fn refine(
    curve: &LiftedCurve,
    from: (f64, DVec3),
    to: (f64, DVec3),
    error: f64,
    depth: u32,
    out: &mut Vec<DVec3>,
) {
    let t = 0.5 * (from.0 + to.0);
    let middle = curve.at(t).point;
    if depth > 0 && middle.distance(from.1.midpoint(to.1)) > error {
        refine(curve, from, (t, middle), error, depth - 1, out);
        refine(curve, (t, middle), to, error, depth - 1, out);
    } else {
        out.push(to.1);
    }
}
