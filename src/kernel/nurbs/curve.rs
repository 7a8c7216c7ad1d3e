//! Rational B-spline curves in the uv plane and in model space.

use glam::{DVec2, DVec3};

use super::{KnotVector, NurbsError, check_points};
use crate::kernel::vector::Vector;

/// A rational B-spline curve. Control points are not premultiplied by their weights.
#[derive(Debug, Clone, PartialEq)]
pub struct NurbsCurve<V> {
    knots: KnotVector,
    points: Vec<V>,
    weights: Vec<f64>,
}

/// A curve in a surface's uv plane (a pcurve).
pub type NurbsCurve2 = NurbsCurve<DVec2>;
/// A curve in model space.
pub type NurbsCurve3 = NurbsCurve<DVec3>;

impl<V: Vector> NurbsCurve<V> {
    /// Puts a curve together from `knots`, `knots.control_count()` points and as many positive weights.
    ///
    /// # Errors
    /// Wrong counts, points that are not finite, weights that are not positive.
    pub fn new(knots: KnotVector, points: Vec<V>, weights: Vec<f64>) -> Result<Self, NurbsError> {
        check_points(&points, &weights, knots.control_count())?;
        Ok(Self { knots, points, weights })
    }

    /// The straight line from `start` to `end` over the parameters `[0, 1]`.
    pub fn line(start: V, end: V) -> Self {
        let knots = KnotVector::bezier(1, 0.0, 1.0).expect("degree 1 over [0, 1] is valid");
        Self { knots, points: vec![start, end], weights: vec![1.0; 2] }
    }

    /// Knot vector (with the degree).
    pub fn knots(&self) -> &KnotVector {
        &self.knots
    }

    /// Polynomial degree.
    pub fn degree(&self) -> usize {
        self.knots.degree()
    }

    /// Control points, not premultiplied.
    pub fn points(&self) -> &[V] {
        &self.points
    }

    /// Weights, one for each control point, all positive.
    pub fn weights(&self) -> &[f64] {
        &self.weights
    }

    /// Whether the weights differ.
    pub fn is_rational(&self) -> bool {
        self.weights.iter().any(|w| *w != self.weights[0])
    }

    /// First and last parameter.
    pub fn domain(&self) -> (f64, f64) {
        self.knots.domain()
    }

    /// Point at parameter `t` (clamped to no interval: outside the domain the end pieces go on).
    pub fn point(&self, t: f64) -> V {
        let span = self.knots.span(t);
        let basis = self.knots.basis(span, t, 0);
        let first = span - self.degree();
        let (mut a, mut w) = (V::ZERO, 0.0);
        for (j, b) in basis[0].iter().enumerate() {
            let weight = self.weights[first + j] * b;
            a = a + self.points[first + j] * weight;
            w += weight;
        }
        a * (1.0 / w)
    }

    /// Point and the first `order` derivatives at `t` (Piegl & Tiller, A3.2 and A4.2).
    pub fn derivatives(&self, t: f64, order: usize) -> Vec<V> {
        let span = self.knots.span(t);
        let basis = self.knots.basis(span, t, order);
        let first = span - self.degree();
        let mut result: Vec<V> = Vec::with_capacity(order + 1);
        let mut w = Vec::with_capacity(order + 1);
        for k in 0..=order {
            let row = &basis[k];
            let (mut a, mut wk) = (V::ZERO, 0.0);
            for (j, b) in row.iter().enumerate() {
                let weight = self.weights[first + j] * b;
                a = a + self.points[first + j] * weight;
                wk += weight;
            }
            w.push(wk);
            let mut binomial = 1.0;
            for i in 1..=k {
                binomial *= (k - i + 1) as f64 / i as f64;
                a = a - result[k - i] * (binomial * w[i]);
            }
            result.push(a * (1.0 / w[0]));
        }
        result
    }

    /// The same curve run through backwards, over the same domain.
    pub fn reversed(&self) -> Self {
        let (start, end) = self.domain();
        let knots = self.knots.as_slice().iter().rev().map(|k| start + end - k).collect();
        let knots = KnotVector::new(self.degree(), knots).expect("mirrored knots stay sorted");
        Self {
            knots,
            points: self.points.iter().rev().copied().collect(),
            weights: self.weights.iter().rev().copied().collect(),
        }
    }

    /// The curve with `map` applied to each control point. Exact when `map` is affine.
    pub fn map_points<W: Vector>(&self, map: impl Fn(V) -> W) -> NurbsCurve<W> {
        NurbsCurve {
            knots: self.knots.clone(),
            points: self.points.iter().map(|p| map(*p)).collect(),
            weights: self.weights.clone(),
        }
    }
}
