//! Products of Bernstein polynomials: numerators of normals and of slopes of rational patches.
//!
//! In scaled form, coefficients times their binomials, a product is a plain convolution (Farouki & Rajan
//! 1988). All factors left out are positive and common, so signs and directions of coefficients are those
//! of the true Bernstein coefficients, whose hull holds the polynomial.

use glam::DVec3;

use super::bernstein::binomial_row;
use super::{BezierCurve, BezierPatch};
use crate::kernel::vector::Vector;

/// A vector- or number-valued tensor-product polynomial in scaled Bernstein form: coefficient `(i, j)`
/// times `C(m, i) C(n, j)`.
pub(super) struct Scaled<T> {
    degree: (usize, usize),
    pub coefficients: Vec<T>,
}

/// A homogeneous control net.
pub(super) struct Net {
    degree: (usize, usize),
    values: Vec<(DVec3, f64)>,
}

impl Net {
    /// The net of `patch`, moved to the middle of its hull to lose no digits.
    pub fn of(patch: &BezierPatch) -> Self {
        let origin = patch.bounds().centre();
        let values = patch.points.iter().zip(&patch.weights).map(|(p, w)| ((*p - origin) * *w, *w));
        Self { degree: (patch.degree_u, patch.degree_v), values: values.collect() }
    }

    fn at(&self, i: usize, j: usize) -> (DVec3, f64) {
        self.values[i * (self.degree.1 + 1) + j]
    }

    /// Control net of the derivative in u, but for the factor `degree`, which is common to a product's
    /// terms.
    pub fn difference_u(&self) -> Self {
        let (m, n) = self.degree;
        let values = (0..m).flat_map(|i| (0..=n).map(move |j| difference(self.at(i + 1, j), self.at(i, j))));
        Self { degree: (m - 1, n), values: values.collect() }
    }

    pub fn difference_v(&self) -> Self {
        let (m, n) = self.degree;
        let values = (0..=m).flat_map(|i| (0..n).map(move |j| difference(self.at(i, j + 1), self.at(i, j))));
        Self { degree: (m, n - 1), values: values.collect() }
    }

    pub fn scaled<T>(&self, part: impl Fn((DVec3, f64)) -> T) -> Scaled<T>
    where
        T: std::ops::Mul<f64, Output = T>,
    {
        let (m, n) = self.degree;
        let (bu, bv) = (binomial_row(m), binomial_row(n));
        let values = self.values.iter().enumerate();
        let coefficients = values.map(|(k, h)| part(*h) * (bu[k / (n + 1)] * bv[k % (n + 1)])).collect();
        Scaled { degree: self.degree, coefficients }
    }
}

fn difference(a: (DVec3, f64), b: (DVec3, f64)) -> (DVec3, f64) {
    (a.0 - b.0, a.1 - b.1)
}

impl<T: Copy> Scaled<T> {
    /// The product under a bilinear `times`: a plain convolution in scaled form.
    pub fn product<S: Copy, P>(&self, other: &Scaled<S>, times: impl Fn(T, S) -> P) -> Scaled<P>
    where
        P: Copy + Default + std::ops::AddAssign,
    {
        let ((m1, n1), (m2, n2)) = (self.degree, other.degree);
        let degree = (m1 + m2, n1 + n2);
        let stride = degree.1 + 1;
        let mut coefficients = vec![P::default(); (degree.0 + 1) * stride];
        for (i, row) in self.coefficients.chunks_exact(n1 + 1).enumerate() {
            for (k, other_row) in other.coefficients.chunks_exact(n2 + 1).enumerate() {
                let sums = &mut coefficients[(i + k) * stride..][..stride];
                for (j, a) in row.iter().enumerate() {
                    for (sum, b) in sums[j..].iter_mut().zip(other_row) {
                        *sum += times(*a, *b);
                    }
                }
            }
        }
        Scaled { degree, coefficients }
    }
}

impl BezierPatch {
    /// Vectors whose hull holds positive multiples of all derivatives in u, and the same for v: the
    /// derivative's direction in each coordinate is known where all have one sign there.
    pub fn slopes(&self) -> (Vec<DVec3>, Vec<DVec3>) {
        let net = Net::of(self);
        let (du, dv) = (net.difference_u(), net.difference_v());
        if !self.is_rational() {
            return (du.scaled(|h| h.0).coefficients, dv.scaled(|h| h.0).coefficients);
        }
        let (p, w) = (net.scaled(|h| h.0), net.scaled(|h| h.1));
        let numerator = |d: &Net| {
            let first = d.scaled(|h| h.0).product(&w, |a, b| a * b);
            let second = p.product(&d.scaled(|h| h.1), |a, b| a * b);
            first.coefficients.iter().zip(&second.coefficients).map(|(a, b)| *a - *b).collect()
        };
        (numerator(&du), numerator(&dv))
    }
}

/// Scaled coefficients of the squared distance of `patch` from `target` times the squared weight, each with that
/// of the squared weight alone.
pub(crate) fn distance_coefficients(patch: &BezierPatch, target: DVec3) -> Vec<(f64, f64)> {
    let values = patch.points.iter().zip(&patch.weights).map(|(p, w)| ((*p - target) * *w, *w));
    let net = Net { degree: (patch.degree_u, patch.degree_v), values: values.collect() };
    let (off, w) = (net.scaled(|h| h.0), net.scaled(|h| h.1));
    let (distance, weight) = (off.product(&off, DVec3::dot), w.product(&w, |a, b| a * b));
    distance.coefficients.into_iter().zip(weight.coefficients).collect()
}

/// The same for a curve.
pub(crate) fn distance_coefficients_of_curve<V: Vector>(
    curve: &BezierCurve<V>,
    target: V,
) -> Vec<(f64, f64)> {
    let scale = binomial_row(curve.degree());
    let scaled: Vec<(V, f64)> = curve
        .points
        .iter()
        .zip(&curve.weights)
        .zip(scale)
        .map(|((p, w), b)| ((*p - target) * (w * b), w * b))
        .collect();
    let mut coefficients = vec![(0.0, 0.0); 2 * scaled.len() - 1];
    for (i, a) in scaled.iter().enumerate() {
        for (j, b) in scaled.iter().enumerate() {
            coefficients[i + j].0 += a.0.dot(b.0);
            coefficients[i + j].1 += a.1 * b.1;
        }
    }
    coefficients
}
