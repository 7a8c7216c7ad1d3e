//! Whether outer loops and holes lie in each other as their roles say.
//!
//! Depth is the number of other loops around a loop, found by counting crossings of a ray from one of its
//! points. Faces are drawn by parity, so an outer loop belongs at an even depth and a hole at an odd one;
//! when every loop is a hole, the border of the surface is the outer one.

use glam::DVec2;

use super::loops::{CutLoop, MonotonePiece};
use super::{At, LoopProblem, ProblemKind};
use crate::kernel::trim::domain::UvRect;
use crate::kernel::trim::loop_record::{LoopRecord, LoopRole};

/// The loops around a point of each loop, by its position among the cut ones.
pub(super) type Around = Vec<Vec<usize>>;

/// What is around each loop.
pub(super) fn around(cut: &[CutLoop]) -> Around {
    let boxes: Vec<UvRect> = cut.iter().map(|l| l.bounds).collect();
    let of = |own: &CutLoop| {
        let uv = inner_point(own);
        let others = cut.iter().zip(&boxes).filter(|(l, bounds)| bounds.contains(uv) && l.index != own.index);
        others.filter(|(l, _)| contains(&l.pieces, uv)).map(|(l, _)| l.index).collect()
    };
    cut.iter().map(of).collect()
}

/// The same after the loops `changed` (by position in the face) are others. `cut` has the loops that it had before.
pub(super) fn around_again(cut: &[CutLoop], changed: &[usize], around: &mut Around) {
    let is_changed = |l: &CutLoop| changed.contains(&l.index);
    let new: Vec<&CutLoop> = cut.iter().filter(|l| is_changed(l)).collect();
    for (own, around) in cut.iter().zip(around) {
        let uv = inner_point(own);
        let is_around =
            |l: &CutLoop| l.index != own.index && l.bounds.contains(uv) && contains(&l.pieces, uv);
        if is_changed(own) {
            *around = cut.iter().filter(|l| is_around(l)).map(|l| l.index).collect();
            continue;
        }
        for other in &new {
            match (around.binary_search(&other.index), is_around(other)) {
                (Err(at), true) => around.insert(at, other.index),
                (Ok(at), false) => drop(around.remove(at)),
                _ => {}
            }
        }
    }
}

/// A point of the loop that tells what is around it.
fn inner_point(of: &CutLoop) -> DVec2 {
    of.pieces.first().map_or(of.bounds.min, |piece| piece.bezier.point(0.5))
}

/// Adds problems of the loops for which `crossed` is false.
pub(super) fn check(
    cut: &[CutLoop],
    around: &Around,
    loops: &[&LoopRecord],
    crossed: &[bool],
    problems: &mut Vec<LoopProblem>,
) {
    let role = |l: &CutLoop| loops[l.index].role;
    let implied = usize::from(cut.iter().all(|l| role(l) == LoopRole::Inner));
    let judged = cut.iter().zip(around).filter(|(l, _)| role(l) != LoopRole::Unknown && !crossed[l.index]);
    for (own, around) in judged {
        let Some(piece) = own.pieces.first() else { continue };
        let depth = around.len() + implied;
        let kind = match (role(own), depth % 2) {
            (LoopRole::Outer, 1) => ProblemKind::OuterInside { around: around[around.len() - 1] },
            // Deeper ones are islands in holes, which files call inner as well.
            (LoopRole::Inner, 0) if depth == 0 => ProblemKind::HoleOutside,
            _ => continue,
        };
        let at = At { trim_loop: own.index, curve: piece.curve };
        problems.push(LoopProblem { at, uv: inner_point(own), kind });
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
