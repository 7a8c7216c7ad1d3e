//! Whether outer loops and holes lie in each other as their roles say.
//!
//! Depth is the number of other loops around a loop, found by counting crossings of a ray from one of its
//! points. Faces are drawn by parity, so an outer loop belongs at an even depth and a hole at an odd one;
//! when every loop is a hole, the border of the surface is the outer one.

use glam::DVec2;

use super::loops::{CutLoop, MonotonePiece};
use super::{At, LoopProblem, ProblemKind};
use crate::kernel::trim::loop_record::{LoopRecord, LoopRole};

/// Adds problems of the loops for which `crossed` is false.
pub(super) fn check(
    cut: &[CutLoop],
    loops: &[&LoopRecord],
    crossed: impl Fn(usize) -> bool,
    problems: &mut Vec<LoopProblem>,
) {
    let role = |l: &CutLoop| loops[l.index].role;
    let implied = usize::from(cut.iter().all(|l| role(l) == LoopRole::Inner));
    for own in cut.iter().filter(|l| role(l) != LoopRole::Unknown && !crossed(l.index)) {
        let Some(piece) = own.pieces.first() else { continue };
        let uv = piece.bezier.point(0.5);
        let around: Vec<usize> = cut
            .iter()
            .filter(|l| l.index != own.index && l.bounds.contains(uv) && contains(&l.pieces, uv))
            .map(|l| l.index)
            .collect();
        let depth = around.len() + implied;
        let kind = match (role(own), depth % 2) {
            (LoopRole::Outer, 1) => ProblemKind::OuterInside { around: around[around.len() - 1] },
            // Deeper ones are islands in holes, which files call inner as well.
            (LoopRole::Inner, 0) if depth == 0 => ProblemKind::HoleOutside,
            _ => continue,
        };
        let at = At { trim_loop: own.index, curve: piece.curve };
        problems.push(LoopProblem { at, uv, kind });
    }
}

/// Whether a ray in +u from `p` crosses the pieces an odd number of times.
fn contains(pieces: &[MonotonePiece], p: DVec2) -> bool {
    pieces.iter().filter(|piece| crosses(piece, p)).count() % 2 == 1
}

fn crosses(piece: &MonotonePiece, p: DVec2) -> bool {
    let bounds = piece.bounds();
    if !(bounds.min.y <= p.y && p.y < bounds.max.y) || p.x >= bounds.max.x {
        return false;
    }
    if p.x < bounds.min.x {
        return true;
    }
    // Monotone in v: halve the parameter until the height is met.
    let up = piece.end().y > piece.start().y;
    let (mut low, mut high) = (0.0, 1.0);
    for _ in 0..60 {
        let middle = 0.5 * (low + high);
        let at = piece.bezier.point(middle);
        if (at.y <= p.y) == up {
            low = middle;
        } else {
            high = middle;
        }
    }
    piece.bezier.point(0.5 * (low + high)).x > p.x
}
