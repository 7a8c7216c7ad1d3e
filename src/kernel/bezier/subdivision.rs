//! Splitting and restricting Bezier curves and patches by de Casteljau's scheme on homogeneous points.
//!
//! Restriction to `[a, b]` keeps the part left of `b`, then of that the part right of `a / b`. Inside 0..1
//! every step is a convex combination, so hulls only shrink and weights stay positive.

use glam::{DVec2, DVec3};

use super::{BezierCurve, BezierPatch};
use crate::kernel::vector::Vector;

/// Homogeneous control points: premultiplied point and weight.
type Net<V> = Vec<(V, f64)>;

fn lift<V: Vector>(points: &[V], weights: &[f64]) -> Net<V> {
    points.iter().zip(weights).map(|(p, w)| (*p * *w, *w)).collect()
}

/// Back to points and weights. Nets of equal weights keep them exactly.
fn drop_weights<V: Vector>(net: &[(V, f64)], equal: Option<f64>) -> (Vec<V>, Vec<f64>) {
    let point = |(p, w): &(V, f64)| {
        let w = equal.unwrap_or(*w);
        (*p * (1.0 / w), w)
    };
    net.iter().map(point).unzip()
}

fn equal_weight(weights: &[f64]) -> Option<f64> {
    weights.iter().all(|w| *w == weights[0]).then(|| weights[0])
}

fn mix<V: Vector>(a: (V, f64), b: (V, f64), t: f64) -> (V, f64) {
    (a.0 * (1.0 - t) + b.0 * t, a.1 * (1.0 - t) + b.1 * t)
}

/// Keeps the part left of `t` of the `count` points from `start` on, `stride` apart.
fn keep_left<V: Vector>(net: &mut [(V, f64)], start: usize, stride: usize, count: usize, t: f64) {
    let at = |i: usize| start + i * stride;
    for k in 1..count {
        for i in (k..count).rev() {
            net[at(i)] = mix(net[at(i - 1)], net[at(i)], t);
        }
    }
}

/// Keeps the part right of `t`.
fn keep_right<V: Vector>(net: &mut [(V, f64)], start: usize, stride: usize, count: usize, t: f64) {
    let at = |i: usize| start + i * stride;
    for k in 1..count {
        for i in 0..count - k {
            net[at(i)] = mix(net[at(i)], net[at(i + 1)], t);
        }
    }
}

/// Restricts one line of points to `[a, b]` of its parameter.
fn restrict_line<V: Vector>(
    net: &mut [(V, f64)],
    (start, stride, count): (usize, usize, usize),
    (a, b): (f64, f64),
) {
    if b != 1.0 && b != 0.0 {
        keep_left(net, start, stride, count, b);
        if a != 0.0 {
            keep_right(net, start, stride, count, a / b);
        }
    } else if b == 1.0 {
        if a != 0.0 {
            keep_right(net, start, stride, count, a);
        }
    } else {
        // b = 0 and so a < 0: part right of a, then left of where 0 went.
        keep_right(net, start, stride, count, a);
        keep_left(net, start, stride, count, a / (a - 1.0));
    }
}

impl<V: Vector> BezierCurve<V> {
    /// The part over `[a, b]`, `a < b`, as a curve over `[0, 1]`. `a` and `b` may lie outside `[0, 1]`,
    /// at the price of extrapolation.
    pub fn restrict(&self, a: f64, b: f64) -> Self {
        let mut net = lift(&self.points, &self.weights);
        let count = net.len();
        restrict_line(&mut net, (0, 1, count), (a, b));
        let (points, weights) = drop_weights(&net, equal_weight(&self.weights));
        Self { points, weights }
    }

    /// Both parts at `t`. They share the point at `t` bit for bit.
    pub fn split(&self, t: f64) -> (Self, Self) {
        let equal = equal_weight(&self.weights);
        let mut right = lift(&self.points, &self.weights);
        let mut left = right.clone();
        let count = right.len();
        keep_left(&mut left, 0, 1, count, t);
        keep_right(&mut right, 0, 1, count, t);
        right[0] = left[count - 1];
        let part = |net: &[(V, f64)]| {
            let (points, weights) = drop_weights(net, equal);
            Self { points, weights }
        };
        (part(&left), part(&right))
    }
}

impl BezierPatch {
    /// The part over the rectangle `min..max` of the patch's own parameters, as a patch of its own;
    /// `uv_min` and `uv_max` follow.
    pub fn restrict(&self, min: DVec2, max: DVec2) -> Self {
        let mut net = lift(&self.points, &self.weights);
        let (nu, nv) = (self.degree_u + 1, self.degree_v + 1);
        for j in 0..nv {
            restrict_line(&mut net, (j, nv, nu), (min.x, max.x));
        }
        for i in 0..nu {
            restrict_line(&mut net, (i * nv, 1, nv), (min.y, max.y));
        }
        let (points, weights): (Vec<DVec3>, _) = drop_weights(&net, equal_weight(&self.weights));
        Self {
            degree_u: self.degree_u,
            degree_v: self.degree_v,
            points,
            weights,
            uv_min: self.native(min),
            uv_max: self.native(max),
        }
    }

    /// The four quarters: (low u, low v), (low u, high v), (high u, low v), (high u, high v).
    pub fn quarters(&self) -> [Self; 4] {
        let (low, mid, high) = (DVec2::ZERO, DVec2::splat(0.5), DVec2::ONE);
        let part = |min: DVec2, max: DVec2| self.restrict(min, max);
        [
            part(low, mid),
            part(DVec2::new(low.x, mid.y), DVec2::new(mid.x, high.y)),
            part(DVec2::new(mid.x, low.y), DVec2::new(high.x, mid.y)),
            part(mid, high),
        ]
    }
}
