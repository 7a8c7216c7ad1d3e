//! Cuts Bezier patches into cells on which a quadratic model gives Newton's method safe starts.
//!
//! A piece is cut in half, in the direction that bends more, until its model is off by a small part of
//! the piece's own width and its normal turns by less than `NORMAL_LIMIT`: then a ray meets it at most
//! twice, and both meetings show in the model (Toth 1985 asks the same of Newton by intervals).

use glam::DVec2;

use super::cell::QuadraticModel;
use crate::kernel::bezier::BezierPatch;

/// Cosine of the largest turn of the normal between the middle of a cell and any other point.
const NORMAL_LIMIT: f64 = 0.88;
/// Largest error of the model relative to the least stretch of the piece.
const RESIDUAL_LIMIT: f64 = 0.04;
/// Most halvings in a row: bounds the work on folded or degenerate patches.
const MAX_DEPTH: u32 = 10;

/// Nearly quadratic pieces of `patch`, each with its parameter rectangle in `patch` (0..1).
pub fn pieces(patch: &BezierPatch) -> Vec<(BezierPatch, DVec2, DVec2)> {
    let mut stack = vec![(DVec2::ZERO, DVec2::ONE, 0)];
    let mut done = Vec::new();
    while let Some((min, max, depth)) = stack.pop() {
        let piece = patch.restrict(min, max);
        let split_u = match verdict(&piece) {
            Verdict::Good => None,
            _ if depth >= MAX_DEPTH => None,
            Verdict::SplitU => Some(true),
            Verdict::SplitV => Some(false),
        };
        match split_u {
            None => done.push((piece, min, max)),
            Some(in_u) => {
                let middle = 0.5 * (min + max);
                let (low_max, high_min) = if in_u {
                    (DVec2::new(middle.x, max.y), DVec2::new(middle.x, min.y))
                } else {
                    (DVec2::new(max.x, middle.y), DVec2::new(min.x, middle.y))
                };
                stack.push((high_min, max, depth + 1));
                stack.push((min, low_max, depth + 1));
            }
        }
    }
    done
}

enum Verdict {
    Good,
    SplitU,
    SplitV,
}

fn verdict(piece: &BezierPatch) -> Verdict {
    let model = QuadraticModel::fit(piece);
    let m = &model.coefficients;
    let flat = piece.degree_u <= 1 && piece.degree_v <= 1 && !piece.is_rational();
    let stretch = model.least_stretch();
    let close = model.residual <= RESIDUAL_LIMIT * stretch;
    let (turn_u, turn_v) = normal_turns(piece);
    let upright = turn_u.min(turn_v) >= NORMAL_LIMIT;
    if upright && (close || flat || model.residual <= 1e-12 * m[1].length().max(m[2].length())) {
        return Verdict::Good;
    }
    let in_u = if upright { error_along(piece, true) >= error_along(piece, false) } else { turn_u <= turn_v };
    if in_u { Verdict::SplitU } else { Verdict::SplitV }
}

const STATIONS: [f64; 5] = [0.0, 0.25, 0.5, 0.75, 1.0];

/// Smallest cosine between normals on one isoline and at its middle, in u and in v.
fn normal_turns(piece: &BezierPatch) -> (f64, f64) {
    let normal = |u: f64, v: f64| {
        // Poles have no normal of their own; one just beside them stands in.
        let inner = |x: f64| 1e-4 + (1.0 - 2e-4) * x;
        let t = piece.tangents(inner(u), inner(v));
        t.du.cross(t.dv).try_normalize()
    };
    let turn = |a: Option<glam::DVec3>, b: Option<glam::DVec3>| match (a, b) {
        (Some(a), Some(b)) => a.dot(b),
        _ => 1.0,
    };
    let (mut turn_u, mut turn_v) = (1.0f64, 1.0f64);
    for a in STATIONS {
        let (middle_u, middle_v) = (normal(0.5, a), normal(a, 0.5));
        for b in STATIONS {
            turn_u = turn_u.min(turn(middle_u, normal(b, a)));
            turn_v = turn_v.min(turn(middle_v, normal(a, b)));
        }
    }
    // The corners see both turns together.
    let centre = normal(0.5, 0.5);
    for (u, v) in [(0.0, 0.0), (0.0, 1.0), (1.0, 0.0), (1.0, 1.0)] {
        let both = turn(centre, normal(u, v));
        if both < NORMAL_LIMIT && turn_u.min(turn_v) >= NORMAL_LIMIT {
            if turn_u <= turn_v {
                turn_u = both;
            } else {
                turn_v = both;
            }
        }
    }
    (turn_u, turn_v)
}

/// Largest third difference along u (or v): what the quadratic model lacks in that direction.
fn error_along(piece: &BezierPatch, in_u: bool) -> f64 {
    let at = |a: f64, b: f64| if in_u { piece.point(a, b) } else { piece.point(b, a) };
    let third = |b: f64| {
        let p: Vec<_> = [0.0, 1.0 / 3.0, 2.0 / 3.0, 1.0].iter().map(|a| at(*a, b)).collect();
        (p[3] - 3.0 * p[2] + 3.0 * p[1] - p[0]).length()
    };
    // Mixed terms such as s^2 t also count: the second difference changes along the other direction.
    let second = |b: f64| at(0.0, b) - 2.0 * at(0.5, b) + at(1.0, b);
    let mixed = (second(0.0) - second(1.0)).length();
    [0.0, 0.5, 1.0].iter().map(|b| third(*b)).fold(mixed, f64::max)
}
