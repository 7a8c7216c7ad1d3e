//! Rational Bezier curves over the parameter interval `[0, 1]`.

use glam::{DVec2, DVec3};

use crate::kernel::vector::Vector;

/// A rational Bezier curve; degree = `points.len() - 1`; points not premultiplied; weights positive.
#[derive(Debug, Clone, PartialEq)]
pub struct BezierCurve<V> {
    /// Control points.
    pub points: Vec<V>,
    /// Weights, as many as points.
    pub weights: Vec<f64>,
}

/// A Bezier curve in a uv plane.
pub type BezierCurve2 = BezierCurve<DVec2>;
/// A Bezier curve in model space.
pub type BezierCurve3 = BezierCurve<DVec3>;

impl<V: Vector> BezierCurve<V> {
    /// A polynomial curve (all weights 1).
    pub fn polynomial(points: Vec<V>) -> Self {
        let weights = vec![1.0; points.len()];
        Self { points, weights }
    }

    /// Polynomial degree.
    pub fn degree(&self) -> usize {
        self.points.len() - 1
    }

    /// Whether the weights differ.
    pub fn is_rational(&self) -> bool {
        self.weights.iter().any(|w| *w != self.weights[0])
    }

    /// Point at `t` by de Casteljau's scheme on homogeneous points.
    pub fn point(&self, t: f64) -> V {
        let mut a: Vec<(V, f64)> =
            self.points.iter().zip(&self.weights).map(|(p, w)| (*p * *w, *w)).collect();
        for k in (1..a.len()).rev() {
            for i in 0..k {
                a[i] = (a[i].0 * (1.0 - t) + a[i + 1].0 * t, a[i].1 * (1.0 - t) + a[i + 1].1 * t);
            }
        }
        a[0].0 * (1.0 / a[0].1)
    }
}
