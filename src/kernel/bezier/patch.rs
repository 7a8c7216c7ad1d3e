//! Rational Bezier patches over the unit square, with the rectangle of the surface they came from.
//!
//! Evaluation works on stack arrays sized by degree class, without allocation: Bernstein values in both
//! directions, one pass over the net. Derivatives are with respect to the patch's own (0..1) parameters.

use glam::{DVec2, DVec3};

use super::bernstein::{self, MAX_COUNT};
use crate::kernel::nurbs::surface::SurfaceJet;
use crate::kernel::view::Bounds;

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

/// Position and first derivatives of a patch at one parameter.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Tangents {
    /// Position.
    pub point: DVec3,
    /// First derivative in u.
    pub du: DVec3,
    /// First derivative in v.
    pub dv: DVec3,
}

impl BezierPatch {
    /// Whether the weights differ.
    pub fn is_rational(&self) -> bool {
        self.weights.iter().any(|w| *w != self.weights[0])
    }

    /// Point at `(u, v)`, both in 0..1.
    pub fn point(&self, u: f64, v: f64) -> DVec3 {
        match self.degree_u.max(self.degree_v) {
            0..4 => self.point_sized::<4>(u, v),
            4..8 => self.point_sized::<8>(u, v),
            8..16 => self.point_sized::<16>(u, v),
            _ => self.point_sized::<MAX_COUNT>(u, v),
        }
    }

    /// Point and first derivatives at `(u, v)`, both in 0..1.
    pub fn tangents(&self, u: f64, v: f64) -> Tangents {
        match self.degree_u.max(self.degree_v) {
            0..4 => self.tangents_sized::<4>(u, v),
            4..8 => self.tangents_sized::<8>(u, v),
            8..16 => self.tangents_sized::<16>(u, v),
            _ => self.tangents_sized::<MAX_COUNT>(u, v),
        }
    }

    /// Point, first and second derivatives at `(u, v)`, both in 0..1.
    pub fn jet(&self, u: f64, v: f64) -> SurfaceJet {
        match self.degree_u.max(self.degree_v) {
            0..4 => self.jet_sized::<4>(u, v),
            4..8 => self.jet_sized::<8>(u, v),
            8..16 => self.jet_sized::<16>(u, v),
            _ => self.jet_sized::<MAX_COUNT>(u, v),
        }
    }

    fn point_sized<const N: usize>(&self, u: f64, v: f64) -> DVec3 {
        let (mut bu, mut bv) = ([0.0; N], [0.0; N]);
        bernstein::values(self.degree_u, u, &mut bu);
        bernstein::values(self.degree_v, v, &mut bv);
        let (mut sum, mut weight) = (DVec3::ZERO, 0.0);
        for (i, (points, weights)) in self.rows().enumerate() {
            let (mut a, mut w) = (DVec3::ZERO, 0.0);
            for (j, (p, wj)) in points.iter().zip(weights).enumerate() {
                let b = bv[j] * wj;
                a += *p * b;
                w += b;
            }
            sum += a * bu[i];
            weight += w * bu[i];
        }
        sum / weight
    }

    fn tangents_sized<const N: usize>(&self, u: f64, v: f64) -> Tangents {
        let bu = bernstein::tangent::<N>(self.degree_u, u);
        let bv = bernstein::tangent::<N>(self.degree_v, v);
        let mut h = [(DVec3::ZERO, 0.0); 3];
        for (i, (points, weights)) in self.rows().enumerate() {
            let mut row = [(DVec3::ZERO, 0.0); 2];
            for (j, (p, w)) in points.iter().zip(weights).enumerate() {
                for (k, sum) in row.iter_mut().enumerate() {
                    let b = bv[k][j] * w;
                    sum.0 += *p * b;
                    sum.1 += b;
                }
            }
            for (sum, (k, l)) in h.iter_mut().zip([(0, 0), (1, 0), (0, 1)]) {
                sum.0 += row[l].0 * bu[k][i];
                sum.1 += row[l].1 * bu[k][i];
            }
        }
        let w = 1.0 / h[0].1;
        let point = h[0].0 * w;
        Tangents { point, du: (h[1].0 - point * h[1].1) * w, dv: (h[2].0 - point * h[2].1) * w }
    }

    fn jet_sized<const N: usize>(&self, u: f64, v: f64) -> SurfaceJet {
        let (bu, bv) = (bernstein::jet::<N>(self.degree_u, u), bernstein::jet::<N>(self.degree_v, v));
        // Homogeneous derivatives (u, v): 00 10 01 20 11 02.
        let mut h = [(DVec3::ZERO, 0.0); 6];
        for (i, (points, weights)) in self.rows().enumerate() {
            let mut row = [(DVec3::ZERO, 0.0); 3];
            for (j, (p, w)) in points.iter().zip(weights).enumerate() {
                for (k, sum) in row.iter_mut().enumerate() {
                    let b = bv[k][j] * w;
                    sum.0 += *p * b;
                    sum.1 += b;
                }
            }
            for (sum, (k, l)) in h.iter_mut().zip([(0, 0), (1, 0), (0, 1), (2, 0), (1, 1), (0, 2)]) {
                sum.0 += row[l].0 * bu[k][i];
                sum.1 += row[l].1 * bu[k][i];
            }
        }
        let w = 1.0 / h[0].1;
        let point = h[0].0 * w;
        let du = (h[1].0 - point * h[1].1) * w;
        let dv = (h[2].0 - point * h[2].1) * w;
        let duu = (h[3].0 - du * (2.0 * h[1].1) - point * h[3].1) * w;
        let duv = (h[4].0 - dv * h[1].1 - du * h[2].1 - point * h[4].1) * w;
        let dvv = (h[5].0 - dv * (2.0 * h[2].1) - point * h[5].1) * w;
        SurfaceJet { point, du, dv, duu, duv, dvv }
    }

    /// The rows of constant i: control points and weights.
    fn rows(&self) -> impl Iterator<Item = (&[DVec3], &[f64])> {
        let count = self.degree_v + 1;
        self.points.chunks_exact(count).zip(self.weights.chunks_exact(count))
    }

    /// The box around the control points, which holds the patch.
    pub fn bounds(&self) -> Bounds {
        Bounds::of(self.points.iter().copied())
    }

    /// Native surface parameters of the patch's `(u, v)` in 0..1.
    pub fn native(&self, uv: DVec2) -> DVec2 {
        self.uv_min * (DVec2::ONE - uv) + self.uv_max * uv
    }

    /// The patch's own parameters of native surface parameters.
    pub fn local(&self, native: DVec2) -> DVec2 {
        (native - self.uv_min) / (self.uv_max - self.uv_min)
    }

    /// The same patch with u and v exchanged.
    pub fn swap(&self) -> Self {
        let count = self.degree_v + 1;
        let order = (0..count).flat_map(|j| (0..=self.degree_u).map(move |i| i * count + j));
        Self {
            degree_u: self.degree_v,
            degree_v: self.degree_u,
            points: order.clone().map(|k| self.points[k]).collect(),
            weights: order.map(|k| self.weights[k]).collect(),
            uv_min: DVec2::new(self.uv_min.y, self.uv_min.x),
            uv_max: DVec2::new(self.uv_max.y, self.uv_max.x),
        }
    }
}
