//! Rational tensor-product B-spline surfaces.

use glam::{DVec3, DVec4};

use super::{KnotVector, NurbsError, check_points};
use crate::kernel::bezier::Tangents;

/// A rational B-spline surface. Control point `(i, j)` (i along u, j along v) is number
/// `i * count_v + j`; points are not premultiplied by their weights.
#[derive(Debug, Clone, PartialEq)]
pub struct NurbsSurface {
    knots_u: KnotVector,
    knots_v: KnotVector,
    points: Vec<DVec3>,
    weights: Vec<f64>,
}

/// Position and partial derivatives of a surface at one parameter.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct SurfaceJet {
    /// Position.
    pub point: DVec3,
    /// First derivative in u.
    pub du: DVec3,
    /// First derivative in v.
    pub dv: DVec3,
    /// Second derivative in u.
    pub duu: DVec3,
    /// Mixed second derivative.
    pub duv: DVec3,
    /// Second derivative in v.
    pub dvv: DVec3,
}

impl NurbsSurface {
    /// Puts a surface together; `points` and `weights` u-major as described at [`NurbsSurface`].
    ///
    /// # Errors
    /// Wrong counts, points that are not finite, weights that are not positive.
    pub fn new(
        knots_u: KnotVector,
        knots_v: KnotVector,
        points: Vec<DVec3>,
        weights: Vec<f64>,
    ) -> Result<Self, NurbsError> {
        check_points(&points, &weights, knots_u.control_count() * knots_v.control_count())?;
        Ok(Self { knots_u, knots_v, points, weights })
    }

    /// Knots in u (with the degree in u).
    pub fn knots_u(&self) -> &KnotVector {
        &self.knots_u
    }

    /// Knots in v (with the degree in v).
    pub fn knots_v(&self) -> &KnotVector {
        &self.knots_v
    }

    /// Degree in u and in v.
    pub fn degrees(&self) -> (usize, usize) {
        (self.knots_u.degree(), self.knots_v.degree())
    }

    /// Number of control points along u and along v.
    pub fn counts(&self) -> (usize, usize) {
        (self.knots_u.control_count(), self.knots_v.control_count())
    }

    /// Control points, u-major, not premultiplied.
    pub fn points(&self) -> &[DVec3] {
        &self.points
    }

    /// Weights, u-major, all positive.
    pub fn weights(&self) -> &[f64] {
        &self.weights
    }

    /// Whether the weights differ.
    pub fn is_rational(&self) -> bool {
        self.weights.iter().any(|w| *w != self.weights[0])
    }

    /// Point at `(u, v)`.
    pub fn point(&self, u: f64, v: f64) -> DVec3 {
        self.homogeneous(u, v, 0)[0][0].0
    }

    /// Point, first and second derivatives at `(u, v)` (Piegl & Tiller, A3.6 and A4.4).
    pub fn jet(&self, u: f64, v: f64) -> SurfaceJet {
        let d = self.homogeneous(u, v, 2);
        let w = d[0][0].1;
        let s = d[0][0].0;
        let du = (d[1][0].0 - s * d[1][0].1) / w;
        let dv = (d[0][1].0 - s * d[0][1].1) / w;
        let duu = (d[2][0].0 - du * (2.0 * d[1][0].1) - s * d[2][0].1) / w;
        let dvv = (d[0][2].0 - dv * (2.0 * d[0][1].1) - s * d[0][2].1) / w;
        let duv = (d[1][1].0 - dv * d[1][0].1 - du * d[0][1].1 - s * d[1][1].1) / w;
        SurfaceJet { point: s, du, dv, duu, duv, dvv }
    }

    /// Point and first derivatives at `(u, v)`.
    pub fn tangents(&self, u: f64, v: f64) -> Tangents {
        let (pu, pv) = self.degrees();
        match pu.max(pv) {
            0..=3 => self.tangents_sized::<4>(u, v),
            4..=7 => self.tangents_sized::<8>(u, v),
            _ => self.tangents_any(u, v),
        }
    }

    /// The same on the stack, row by row, where both degrees are below `N`: inspection asks hundreds of times
    /// a face.
    fn tangents_sized<const N: usize>(&self, u: f64, v: f64) -> Tangents {
        let (pu, pv) = self.degrees();
        let (_, count_v) = self.counts();
        let (su, sv) = (self.knots_u.span(u), self.knots_v.span(v));
        let (bu, bv) = (self.knots_u.basis_and_slopes::<N>(su, u), self.knots_v.basis_and_slopes::<N>(sv, v));
        let [mut value, mut along_u, mut along_v] = [DVec4::ZERO; 3];
        for i in 0..=pu {
            let first = (su - pu + i) * count_v + sv - pv;
            let (points, weights) = (&self.points[first..=first + pv], &self.weights[first..=first + pv]);
            let (mut row, mut row_v) = (DVec4::ZERO, DVec4::ZERO);
            for ((j, point), weight) in points.iter().enumerate().zip(weights) {
                let point = point.extend(1.0);
                row += point * (bv[0][j] * weight);
                row_v += point * (bv[1][j] * weight);
            }
            value += row * bu[0][i];
            along_u += row * bu[1][i];
            along_v += row_v * bu[0][i];
        }
        let w = value.w;
        let point = value.truncate() / w;
        let derivative = |a: DVec4| (a.truncate() - point * a.w) / w;
        Tangents { point, du: derivative(along_u), dv: derivative(along_v) }
    }

    fn tangents_any(&self, u: f64, v: f64) -> Tangents {
        let d = self.homogeneous(u, v, 1);
        let (point, w) = d[0][0];
        Tangents { point, du: (d[1][0].0 - point * d[1][0].1) / w, dv: (d[0][1].0 - point * d[0][1].1) / w }
    }

    /// `result[k][l]`: numerator (divided by the weight for k = l = 0 only) and weight derivatives,
    /// for `k + l <= order <= 2`.
    fn homogeneous(&self, u: f64, v: f64, order: usize) -> [[(DVec3, f64); 3]; 3] {
        let (pu, pv) = self.degrees();
        let (_, nv) = self.counts();
        let (su, sv) = (self.knots_u.span(u), self.knots_v.span(v));
        let (bu, bv) = (self.knots_u.basis(su, u, order), self.knots_v.basis(sv, v, order));
        let mut result = [[(DVec3::ZERO, 0.0); 3]; 3];
        for k in 0..=order {
            for l in 0..=order - k {
                let (mut a, mut w) = (DVec3::ZERO, 0.0);
                for (i, bi) in bu[k].iter().enumerate() {
                    let first = (su - pu + i) * nv + sv - pv;
                    let (points, weights) = (&self.points[first..], &self.weights[first..]);
                    for ((bj, point), own) in bv[l].iter().zip(points).zip(weights) {
                        let weight = bi * bj * own;
                        a += *point * weight;
                        w += weight;
                    }
                }
                result[k][l] = (a, w);
            }
        }
        let weight = result[0][0].1;
        result[0][0].0 /= weight;
        result
    }

    /// The surface with `map` applied to each control point. Exact when `map` is affine.
    pub fn map_points(&self, map: impl Fn(DVec3) -> DVec3) -> Self {
        Self { points: self.points.iter().map(|p| map(*p)).collect(), ..self.clone() }
    }

    /// The same surface with u and v exchanged.
    pub fn transposed(&self) -> Self {
        let (nu, nv) = self.counts();
        let order = (0..nv).flat_map(|j| (0..nu).map(move |i| i * nv + j));
        Self {
            knots_u: self.knots_v.clone(),
            knots_v: self.knots_u.clone(),
            points: order.clone().map(|k| self.points[k]).collect(),
            weights: order.map(|k| self.weights[k]).collect(),
        }
    }
}
