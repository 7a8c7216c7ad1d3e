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
    /// Ends of the closed chains among the edges.
    chain_ends: Vec<usize>,
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
    /// Whether the chain runs through it downwards.
    down: bool,
}

impl Boundary {
    /// Takes the monotone pieces of a face's loops, whose unit square stands for `domain`.
    pub fn new(pieces: &PieceList, domain: &UvRect) -> Self {
        let edges = pieces.pieces().iter().map(|piece| {
            let points = pieces.points(piece).iter().map(|p| domain.native(*p)).collect();
            let curve = BezierCurve2 { points, weights: pieces.weights(piece).to_vec() };
            Edge::new(curve)
        });
        let chain_ends = (0..pieces.chain_count()).map(|k| pieces.chain(k).end).collect();
        Self { edges: edges.collect(), chain_ends }
    }

    /// The rectangle that the patches of `sheet` tile; nothing when there are none.
    pub fn rectangle(sheet: &Sheet) -> Self {
        let (us, vs) = (sheet.u_lines(), sheet.v_lines());
        let ([u0, .., u1], [v0, .., v1]) = (us, vs) else { return Self::default() };
        let corner = |u: &f64, v: &f64| DVec2::new(*u, *v);
        let line = |a: DVec2, b: DVec2| Edge::new(BezierCurve2::polynomial(vec![a, b]));
        let edges = vec![
            line(corner(u0, v0), corner(u1, v0)),
            line(corner(u1, v0), corner(u1, v1)),
            line(corner(u1, v1), corner(u0, v1)),
            line(corner(u0, v1), corner(u0, v0)),
        ];
        Self { chain_ends: vec![edges.len()], edges }
    }

    /// The edges, in loop order.
    pub fn edges(&self) -> &[Edge] {
        &self.edges
    }

    /// The boundary as seen from the strip `from <= u <= to`: what runs outside of it is drawn straight
    /// along the strip's sides, and left out where it returns to where it left.
    pub fn strip(&self, from: f64, to: f64) -> Self {
        let mut strip = Self::default();
        let mut start = 0;
        for &end in &self.chain_ends {
            // The side, and the v at which the chain went there.
            let mut outside: Option<(f64, f64)> = None;
            let mut last = 0.0;
            for edge in &self.edges[start..end] {
                let (least, most) = edge.u_range();
                let side = if most <= from { Some(from) } else { (least >= to).then_some(to) };
                let (enter, leave) = if edge.down { (edge.high, edge.low) } else { (edge.low, edge.high) };
                if side != outside.map(|o| o.0) {
                    strip.close(&mut outside, last);
                    outside = side.map(|side| (side, enter));
                }
                if side.is_none() {
                    strip.edges.push(edge.clone());
                }
                last = leave;
            }
            strip.close(&mut outside, last);
            start = end;
        }
        strip
    }

    /// Ends a run outside of a strip at height `v`.
    fn close(&mut self, outside: &mut Option<(f64, f64)>, v: f64) {
        if let Some((side, entered)) = outside.take()
            && entered != v
        {
            let line = vec![DVec2::new(side, entered), DVec2::new(side, v)];
            self.edges.push(Edge::new(BezierCurve2::polynomial(line)));
        }
    }

    /// Whether `uv` is inside: an odd number of edges lie to its right (half-open in v).
    pub fn contains(&self, uv: DVec2) -> bool {
        let spans = self.edges.iter().filter(|e| uv.y >= e.low && uv.y < e.high);
        spans.filter(|e| e.u_at(uv.y) > uv.x).count() % 2 == 1
    }
}

impl Edge {
    fn new(curve: BezierCurve2) -> Self {
        let down = curve.end().y < curve.start().y;
        let curve = if down { curve.reversed() } else { curve };
        Self { low: curve.start().y, high: curve.end().y, curve, down }
    }

    /// The height at which the edge has `u`, when that lies strictly between its ends.
    pub fn v_at(&self, u: f64) -> Option<f64> {
        let (start, end) = (self.curve.start().x, self.curve.end().x);
        if !(start.min(end) < u && u < start.max(end)) {
            return None;
        }
        let (mut low, mut high) = (0.0, 1.0);
        for _ in 0..60 {
            let t = 0.5 * (low + high);
            if (self.curve.point(t).x < u) == (end > start) { low = t } else { high = t }
        }
        Some(self.curve.point(0.5 * (low + high)).y.clamp(self.low, self.high))
    }

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
