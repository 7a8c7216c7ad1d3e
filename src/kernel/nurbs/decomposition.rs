//! Decomposition of splines into rational Bezier pieces that keep their native parameters.
//!
//! The Bezier control points of the piece over `[a, b]` are the blossom values `f(a^(p-i), b^i)`
//! (Ramshaw 1989), so only the knots around one span are read: unclamped knots and knots of
//! multiplicity `degree + 1` (jumps) need no special care. Invariant: where the spline is continuous, two
//! neighbouring pieces share bit-identical end points (surfaces: edge control points).

use glam::DVec2;

use super::spline_map::{Row, SplineMap};
use super::{KnotVector, NurbsCurve, NurbsSurface};
use crate::kernel::bezier::{BezierCurve, BezierPatch};
use crate::kernel::vector::Vector;

/// One polynomial piece of a spline basis: its interval and the map to its Bezier control points.
pub(crate) struct Piece {
    /// First and last native parameter.
    pub interval: (f64, f64),
    /// From all control points of the spline to the `degree + 1` of the piece.
    pub map: SplineMap,
}

impl KnotVector {
    /// The spans `(index, start, end)` of the domain that are longer than rounding.
    pub fn spans(&self) -> impl Iterator<Item = (usize, f64, f64)> + '_ {
        let knots = self.as_slice();
        (self.degree()..self.control_count()).filter_map(move |i| {
            let (a, b) = (knots[i], knots[i + 1]);
            (b - a > 2.0 * f64::EPSILON * a.abs().max(b.abs())).then_some((i, a, b))
        })
    }

    /// How often `t` is a knot.
    pub fn multiplicity(&self, t: f64) -> usize {
        self.as_slice().iter().filter(|k| **k == t).count()
    }

    /// The Bezier pieces of a spline over these knots, in order.
    pub(crate) fn pieces(&self) -> Vec<Piece> {
        let p = self.degree();
        let mut pieces: Vec<Piece> = Vec::new();
        for (span, a, b) in self.spans() {
            let rows = (0..=p)
                .map(|i| Row::blossom(self, span, (0..p).map(|k| if k < p - i { a } else { b })))
                .collect();
            let piece = Piece { interval: (a, b), map: SplineMap { rows } };
            if let Some(before) = pieces.last_mut()
                && before.interval.1 == a
                && self.multiplicity(a) <= p
            {
                before.map.rows[p] = piece.map.rows[0].clone();
            }
            pieces.push(piece);
        }
        pieces
    }
}

impl<V: Vector> NurbsCurve<V> {
    /// The Bezier pieces over the domain, in order, each with its native parameter interval.
    pub fn to_bezier(&self) -> Vec<(BezierCurve<V>, (f64, f64))> {
        if self.knots().is_bezier() {
            let whole = BezierCurve { points: self.points().to_vec(), weights: self.weights().to_vec() };
            return vec![(whole, self.domain())];
        }
        let rational = self.is_rational();
        let pieces = self.knots().pieces().into_iter().map(|piece| {
            let (points, weights) = piece.map.apply(self.points(), self.weights(), rational);
            (BezierCurve { points, weights }, piece.interval)
        });
        pieces.collect()
    }
}

impl NurbsSurface {
    /// The Bezier patches over the domain, those of one u-interval after the other; `uv_min` and
    /// `uv_max` hold the native parameters.
    pub fn to_bezier(&self) -> Vec<BezierPatch> {
        let rational = self.is_rational();
        let (degree_u, degree_v) = self.degrees();
        let (_, count_v) = self.counts();
        let pieces_v = self.knots_v().pieces();
        let mut patches = Vec::new();
        for u in self.knots_u().pieces() {
            let (points, weights) = u.map.apply_u(self.points(), self.weights(), rational, count_v);
            for v in &pieces_v {
                let (points, weights) = v.map.apply_v(&points, &weights, rational, count_v);
                let uv_min = DVec2::new(u.interval.0, v.interval.0);
                let uv_max = DVec2::new(u.interval.1, v.interval.1);
                patches.push(BezierPatch { degree_u, degree_v, points, weights, uv_min, uv_max });
            }
        }
        patches
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A curve with a jump at 1 (multiplicity `degree + 1`), a corner at 2 and unclamped ends.
    fn jumpy() -> NurbsCurve<DVec2> {
        let knots = vec![-1.0, -0.5, 0.0, 0.5, 1.0, 1.0, 1.0, 2.0, 2.0, 3.0, 3.5, 4.5];
        let knots = KnotVector::new(2, knots).expect("sorted");
        let count = knots.control_count();
        let points = (0..count).map(|k| DVec2::new(k as f64, ((k * k) % 5) as f64)).collect();
        let weights = (0..count).map(|k| 0.5 + ((k * 7) % 4) as f64).collect();
        NurbsCurve::new(knots, points, weights).expect("counts fit")
    }

    #[test]
    fn pieces_are_the_curve_and_share_ends_unless_it_jumps() {
        let curve = jumpy();
        let pieces = curve.to_bezier();
        assert_eq!(pieces.len(), 4);
        for (piece, (a, b)) in &pieces {
            for s in [1e-9, 0.25, 0.5, 0.9] {
                let t = a + (b - a) * s;
                assert!((piece.point(s) - curve.point(t)).length() < 1e-13, "at {t}");
            }
        }
        for pair in pieces.windows(2) {
            let jump = pair[0].1.1 == 1.0;
            assert_eq!(pair[0].0.end() == pair[1].0.start(), !jump);
        }
    }
}
