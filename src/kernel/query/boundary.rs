//! The boundary of a trimmed region as curves over native parameters, each monotone in u and in v.

use glam::DVec2;

use super::sheet::Sheet;
use crate::kernel::bezier::BezierCurve2;
use crate::kernel::face::UvRect;
use crate::kernel::trim::PieceList;

/// A closed boundary; even-odd decides what is inside.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Boundary {
    edges: Vec<Edge>,
}

/// A monotone boundary curve, turned to run upwards in v (horizontal ones as they came).
#[derive(Debug, Clone, PartialEq)]
pub struct Edge {
    /// The curve, native parameters.
    pub curve: BezierCurve2,
    /// Smallest v.
    pub low: f64,
    /// Largest v.
    pub high: f64,
}

impl Boundary {
    /// Takes the monotone pieces of a face's loops, whose unit square stands for `domain`.
    pub fn new(pieces: &PieceList, domain: &UvRect) -> Self {
        let edges = pieces.pieces().iter().map(|piece| {
            let points = pieces.points(piece).iter().map(|p| domain.native(*p)).collect();
            let curve = BezierCurve2 { points, weights: pieces.weights(piece).to_vec() };
            let curve = if curve.end().y < curve.start().y { curve.reversed() } else { curve };
            Edge { low: curve.start().y, high: curve.end().y, curve }
        });
        Self { edges: edges.collect() }
    }

    /// The rectangle that the patches of `sheet` tile; nothing when there are none.
    pub fn rectangle(sheet: &Sheet) -> Self {
        let (us, vs) = (sheet.u_lines(), sheet.v_lines());
        let ([u0, .., u1], [v0, .., v1]) = (us, vs) else { return Self::default() };
        let corner = |u: &f64, v: &f64| DVec2::new(*u, *v);
        let line =
            |a: DVec2, b: DVec2| Edge { curve: BezierCurve2::polynomial(vec![a, b]), low: a.y, high: b.y };
        let edges = vec![
            line(corner(u0, v0), corner(u1, v0)),
            line(corner(u1, v0), corner(u1, v1)),
            line(corner(u0, v1), corner(u1, v1)),
            line(corner(u0, v0), corner(u0, v1)),
        ];
        Self { edges }
    }

    /// The edges, in loop order.
    pub fn edges(&self) -> &[Edge] {
        &self.edges
    }

    /// Whether `uv` is inside: an odd number of edges lie to its right (half-open in v).
    pub fn contains(&self, uv: DVec2) -> bool {
        let spans = self.edges.iter().filter(|e| uv.y >= e.low && uv.y < e.high);
        spans.filter(|e| e.u_at(uv.y) > uv.x).count() % 2 == 1
    }
}

impl Edge {
    /// Smallest and largest u.
    pub fn u_range(&self) -> (f64, f64) {
        let (a, b) = (self.curve.start().x, self.curve.end().x);
        (a.min(b), a.max(b))
    }

    /// The edge's u at height `v`, clamped to its ends (bracketed Newton's method).
    pub fn u_at(&self, v: f64) -> f64 {
        let (start, end) = (self.curve.start(), self.curve.end());
        if v <= self.low {
            return start.x;
        }
        if v >= self.high {
            return end.x;
        }
        let chord = (v - self.low) / (self.high - self.low);
        if self.curve.points.len() == 2 && !self.curve.is_rational() {
            return start.x + (end.x - start.x) * chord;
        }
        let (mut low, mut high, mut t) = (0.0, 1.0, chord);
        let accuracy = 4.0 * f64::EPSILON * self.low.abs().max(self.high.abs());
        let mut point = start;
        for _ in 0..80 {
            let jet = self.curve.tangent(t);
            point = jet.0;
            let off = point.y - v;
            if off.abs() <= accuracy {
                break;
            }
            if off > 0.0 {
                high = t
            } else {
                low = t
            }
            let next = t - off / jet.1.y;
            let next = if next > low && next < high { next } else { 0.5 * (low + high) };
            if next == t {
                break;
            }
            t = next;
        }
        point.x.clamp(start.x.min(end.x), start.x.max(end.x))
    }

    /// How far the edge's v-speed at its (lower, upper) end falls below its mean: near 0 where it
    /// turns, so that u is like a square root of v.
    pub fn end_speeds(&self) -> (f64, f64) {
        let rise = self.high - self.low;
        (self.curve.tangent(0.0).1.y / rise, self.curve.tangent(1.0).1.y / rise)
    }
}
