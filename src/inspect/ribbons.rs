//! The edges of a model as ribbons: fat lines as wide as the measured gaps.

use super::{EdgeKind, Inspection};
use crate::encoding::{FaceSlot, RibbonScene, RibbonShape};
use crate::kernel::face::Face;

/// Packs all edges with two sides or more. `face`: the derived face at a position of the model and its slot in the packed
/// scene.
pub fn ribbons<'a>(
    inspection: &Inspection,
    face: &dyn Fn(usize) -> Option<(&'a Face, FaceSlot)>,
) -> RibbonScene {
    let mut shapes = Vec::new();
    for (_, edge) in inspection.edges() {
        if edge.kind == EdgeKind::Degenerate || edge.uses.len() < 2 {
            continue;
        }
        let gap = edge.gap.map_or(0.0, |g| g.maximum + g.error_bound);
        for (k, used) in edge.uses.iter().enumerate() {
            let across = &edge.uses[(k + 1) % edge.uses.len()];
            let (Some((own, slot)), Some((_, other)), Some(curve)) =
                (face(used.curve.face), face(across.curve.face), inspection.curve(&used.curve))
            else {
                continue;
            };
            let (from, to) = used.interval;
            for (piece, (a, b)) in curve.pieces() {
                let (low, high) = ((from.max(*a) - a) / (b - a), (to.min(*b) - a) / (b - a));
                if high - low <= 1e-9 {
                    continue;
                }
                let whole = low <= 0.0 && high >= 1.0;
                let curve = if whole { piece.clone() } else { piece.restrict(low.max(0.0), high.min(1.0)) };
                shapes.push(RibbonShape { face: own, slot, other, curve, gap });
            }
        }
    }
    RibbonScene::new(shapes)
}
