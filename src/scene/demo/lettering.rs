//! The word HAIRLINE as outlines of lines and cubics, seven units high; the counters of A and R are
//! loops of their own, so a cut-out word leaves islands.

use glam::DVec2;

use super::outline::{bezier, polygon};
use crate::kernel::nurbs::NurbsCurve2;

/// Height of the capitals.
pub const HEIGHT: f64 = 7.0;
/// Space between letters.
const GAP: f64 = 1.15;

/// A loop of the word; placed by [`place`].
type Loop = Vec<NurbsCurve2>;

/// The loops of HAIRLINE with the lower left corner in the origin, and the width of the word.
pub fn word() -> (Vec<Loop>, f64) {
    let (mut loops, mut x) = (Vec::new(), 0.0);
    for (glyph, width) in [h(), a(), i(), r(), l(), i(), n(), e()] {
        loops.extend(glyph.into_iter().map(|curves| place(&curves, |p| p + DVec2::new(x, 0.0))));
        x += width + GAP;
    }
    (loops, x - GAP)
}

/// The loop with `map` applied to its control points. Exact when `map` is affine.
pub fn place(curves: &[NurbsCurve2], map: impl Fn(DVec2) -> DVec2) -> Loop {
    curves.iter().map(|c| c.map_points(&map)).collect()
}

fn corners(points: &[(f64, f64)]) -> Loop {
    polygon(&points.iter().map(|p| DVec2::from(*p)).collect::<Vec<_>>())
}

fn h() -> (Vec<Loop>, f64) {
    let outline = [
        (0.0, 0.0),
        (1.4, 0.0),
        (1.4, 2.85),
        (3.9, 2.85),
        (3.9, 0.0),
        (5.3, 0.0),
        (5.3, 7.0),
        (3.9, 7.0),
        (3.9, 4.15),
        (1.4, 4.15),
        (1.4, 7.0),
        (0.0, 7.0),
    ];
    (vec![corners(&outline)], 5.3)
}

fn a() -> (Vec<Loop>, f64) {
    let outline =
        [(0.0, 0.0), (1.45, 0.0), (1.9, 1.5), (3.8, 1.5), (4.25, 0.0), (5.7, 0.0), (3.6, 7.0), (2.1, 7.0)];
    let counter = [(2.29, 2.8), (3.41, 2.8), (2.85, 4.667)];
    (vec![corners(&outline), corners(&counter)], 5.7)
}

fn i() -> (Vec<Loop>, f64) {
    (vec![corners(&[(0.0, 0.0), (1.4, 0.0), (1.4, 7.0), (0.0, 7.0)])], 1.4)
}

fn r() -> (Vec<Loop>, f64) {
    let p = DVec2::new;
    let mut outline = open(&[
        (2.9, 7.0),
        (0.0, 7.0),
        (0.0, 0.0),
        (1.4, 0.0),
        (1.4, 2.7),
        (2.1, 2.7),
        (3.5, 0.0),
        (5.1, 0.0),
        (3.55, 2.95),
    ]);
    outline.push(bezier(vec![p(3.55, 2.95), p(5.6, 3.5), p(5.6, 7.0), p(2.9, 7.0)]));
    let mut counter = open(&[(2.8, 5.75), (1.4, 5.75), (1.4, 3.95), (2.8, 3.95)]);
    counter.push(bezier(vec![p(2.8, 3.95), p(4.05, 3.95), p(4.05, 5.75), p(2.8, 5.75)]));
    (vec![outline, counter], 5.1)
}

fn l() -> (Vec<Loop>, f64) {
    (vec![corners(&[(0.0, 0.0), (4.4, 0.0), (4.4, 1.3), (1.4, 1.3), (1.4, 7.0), (0.0, 7.0)])], 4.4)
}

fn n() -> (Vec<Loop>, f64) {
    let outline = [
        (0.0, 0.0),
        (1.4, 0.0),
        (1.4, 4.6),
        (3.9, 0.0),
        (5.3, 0.0),
        (5.3, 7.0),
        (3.9, 7.0),
        (3.9, 2.4),
        (1.4, 7.0),
        (0.0, 7.0),
    ];
    (vec![corners(&outline)], 5.3)
}

fn e() -> (Vec<Loop>, f64) {
    let outline = [
        (0.0, 0.0),
        (4.5, 0.0),
        (4.5, 1.3),
        (1.4, 1.3),
        (1.4, 2.9),
        (4.1, 2.9),
        (4.1, 4.15),
        (1.4, 4.15),
        (1.4, 5.7),
        (4.5, 5.7),
        (4.5, 7.0),
        (0.0, 7.0),
    ];
    (vec![corners(&outline)], 4.5)
}

/// Lines from point to point, not closed.
fn open(points: &[(f64, f64)]) -> Loop {
    points.windows(2).map(|w| NurbsCurve2::line(w[0].into(), w[1].into())).collect()
}
