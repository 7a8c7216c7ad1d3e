//! Cuts chains of monotone pieces to the unit square without changing any answer inside.
//!
//! Parts outside are moved to the nearest border: what lies left or right of the square stays left or right
//! of every point in it, what lies above or below is not crossed by any ray.

use glam::DVec2;

use super::oracle;
use super::pieces::{Piece, PieceList};
use crate::kernel::bezier::BezierCurve2;

/// How far some pieces reach out of the unit square at most (0: not at all).
pub fn overshoot(list: &PieceList, pieces: std::ops::Range<usize>) -> f64 {
    let out = |p: DVec2| (-p).max_element().max((p - 1.0).max_element());
    list.pieces()[pieces].iter().map(|piece| out(list.start(piece))).fold(0.0, f64::max)
}

/// Moves what the last chain has outside the unit square to its border. Takes the chain away when
/// nothing else is left.
pub fn last_chain_to_unit_square(list: &mut PieceList) {
    let chain = list.take_last_chain();
    for piece in chain.pieces() {
        clip_piece(&chain, piece, list);
    }
    list.close_chain();
}

fn clip_piece(list: &PieceList, piece: &Piece, result: &mut PieceList) {
    let (points, weights) = (list.points(piece), list.weights(piece));
    let (start, end) = (list.start(piece), list.end(piece));
    let inside = |p: DVec2| p == p.clamp(DVec2::ZERO, DVec2::ONE);
    if inside(start) && inside(end) {
        result.push(points, weights, piece.source);
        return;
    }
    let mut cuts = vec![0.0, 1.0];
    for axis in 0..2 {
        for border in [0.0, 1.0] {
            if (start[axis] - border) * (end[axis] - border) < 0.0 {
                cuts.push(crossing(list, piece, axis, border));
            }
        }
    }
    cuts.sort_unstable_by(f64::total_cmp);
    let curve = BezierCurve2 { points: points.to_vec(), weights: weights.to_vec() };
    let at = |t: f64| {
        if t == 0.0 {
            start
        } else if t == 1.0 {
            end
        } else {
            oracle::point(list, piece, t)
        }
    };
    let mut from = start.clamp(DVec2::ZERO, DVec2::ONE);
    for pair in cuts.windows(2) {
        let to = at(pair[1]).clamp(DVec2::ZERO, DVec2::ONE);
        let middle = at(0.5 * (pair[0] + pair[1]));
        if inside(middle) && piece.degree > 1 && pair[1] - pair[0] > 1e-12 {
            let mut part = curve.restrict(pair[0], pair[1]);
            part.points[0] = from;
            part.points[piece.degree as usize] = to;
            result.push(&part.points, &part.weights, piece.source);
        } else if from != to {
            result.push(&[from, to], &[1.0, 1.0], piece.source);
        }
        from = to;
    }
}

/// Parameter at which a monotone piece has the coordinate `value`.
fn crossing(list: &PieceList, piece: &Piece, axis: usize, value: f64) -> f64 {
    let rises = list.end(piece)[axis] > list.start(piece)[axis];
    let (mut low, mut high) = (0.0, 1.0);
    for _ in 0..60 {
        let t = 0.5 * (low + high);
        if (oracle::point(list, piece, t)[axis] < value) == rises { low = t } else { high = t }
    }
    0.5 * (low + high)
}
