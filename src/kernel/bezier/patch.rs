//! Rational Bezier patches over the unit square, with the rectangle of the surface they came from.

use glam::{DVec2, DVec3};

/// A rational tensor-product Bezier patch. Control point `(i, j)` is number `i * (degree_v + 1) + j`.
#[derive(Debug, Clone, PartialEq)]
pub struct BezierPatch {
    /// Degree in u.
    pub degree_u: usize,
    /// Degree in v.
    pub degree_v: usize,
    /// Control points, u-major, not premultiplied.
    pub points: Vec<DVec3>,
    /// Weights, u-major, positive.
    pub weights: Vec<f64>,
    /// Surface parameters of the corner (0, 0).
    pub uv_min: DVec2,
    /// Surface parameters of the corner (1, 1).
    pub uv_max: DVec2,
}
