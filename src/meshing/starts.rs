//! Where closed edges start: where the same edge of the neighbour starts.
//!
//! A loop of one closed curve may start anywhere on it. Its neighbour's, whose curve was made apart, starts nearby: nearer
//! along the edge than the two are off each other, or farther. Then neither start lies on the other curve, and no vertex
//! would be common. Such a loop is started anew, at the foot of the neighbour's start.
//!
//! Invariant: only chains that are one closed run are changed, to the same curve from another start.

use glam::DVec3;

use super::seams::RunAddress;
use super::stretches::rough_part;
use crate::kernel::query::BoundsTree;
use crate::kernel::tessellate::{Run, Tessellator};
use crate::kernel::view::Bounds;

/// Runs whose ends are this part of their length apart at most are closed.
const CLOSED: f64 = 1e-6;
/// Curves of which one is shorter than this part of the other are not one edge.
const ALIKE: f64 = 0.8;

/// A closed run.
struct Closed {
    address: RunAddress,
    start: DVec3,
    length: f64,
    /// Whether it is all of its chain, so that it may start elsewhere.
    whole: bool,
}

/// Starts loops anew that meet no start of another face's closed edge within `reach`, but come by one within `farthest`.
pub(super) fn meet(faces: &mut [Option<Tessellator>], reach: f64, farthest: f64) {
    let mut found = Vec::new();
    for (face, tessellator) in faces.iter().enumerate() {
        let Some(tessellator) = tessellator else { continue };
        for (chain, run, r) in tessellator.outline().runs() {
            let length = rough_part(r, 0.0, r.range());
            let [start, end] = r.ends();
            if start.distance(end) <= CLOSED * length && length > reach {
                let whole = tessellator.outline().chains[chain].len() == 1;
                found.push(Closed { address: RunAddress { face, chain, run }, start, length, whole });
            }
        }
    }
    let boxes: Vec<Bounds> = found.iter().map(|c| Bounds::of([c.start])).collect();
    let tree = BoundsTree::new(&boxes);
    for (number, own) in found.iter().enumerate().filter(|(_, own)| own.whole) {
        let mut met = false;
        tree.within(own.start, reach, |k| {
            let other = &found[k];
            met |= other.address.face != own.address.face && other.start.distance(own.start) <= reach;
        });
        if met {
            continue;
        }
        let Some(tessellator) = faces[own.address.face].as_mut() else { continue };
        let Some(run) = tessellator.outline().chains[own.address.chain].first() else { continue };
        if let Some(s) = foot(run, own, number, &found, &tree, farthest) {
            tessellator.start_at(own.address.chain, s);
        }
    }
}

/// The foot on `run` of the start that is nearest to it of another face's closed edge as long.
fn foot(
    run: &Run,
    own: &Closed,
    number: usize,
    found: &[Closed],
    tree: &BoundsTree,
    farthest: f64,
) -> Option<f64> {
    let around = Bounds::of(run.pieces.iter().flat_map(|p| p.space.points.iter().copied()));
    let mut best: Option<(f64, f64)> = None;
    tree.meeting(&around, farthest, |k| {
        let other = &found[k];
        let alike = own.length.min(other.length) >= ALIKE * own.length.max(other.length);
        // Of two that both could start elsewhere, the later one does.
        let stays = !other.whole || k < number;
        if other.address.face != own.address.face
            && alike
            && stays
            && let Some((s, off)) = run.nearest_within(other.start, farthest)
            && best.is_none_or(|b| off < b.1)
        {
            best = Some((s, off));
        }
    });
    best.map(|b| b.0)
}
