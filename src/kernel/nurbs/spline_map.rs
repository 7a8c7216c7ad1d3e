//! Changes of spline basis as linear maps of control points.
//!
//! Knot insertion, clamping, restriction, degree elevation and decomposition to Bezier pieces all send
//! the homogeneous control points through a banded matrix that depends on the knots only. A curve
//! applies the matrix once, a surface applies it along u or along v. Each row holds the values of a
//! blossom of the B-spline basis (Ramshaw 1989; Lyche & Morken, "Spline Methods", chapter 4).
//!
//! Invariant: with the spans chosen here all row entries are >= 0 and sum to 1 up to rounding, so the
//! maps are as well conditioned as de Casteljau's scheme, at any degree, and keep weights positive.

use super::KnotVector;
use crate::kernel::vector::Vector;

/// One new control point as a combination of old ones: `sum weights[k] * old[first + k]`.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Row {
    /// Position of the first old control point.
    pub first: usize,
    /// Factors, without zeros at either end.
    pub weights: Vec<f64>,
}

/// A banded matrix from old to new control points; see the module head.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct SplineMap {
    /// One row for each new control point.
    pub rows: Vec<Row>,
}

impl Row {
    /// The row that copies old control point `index`.
    pub fn copy(index: usize) -> Self {
        Self { first: index, weights: vec![1.0] }
    }

    /// The row `weights` starting at `first`, zeros at the ends dropped.
    pub fn trimmed(first: usize, weights: &[f64]) -> Self {
        let lead = weights.iter().position(|w| *w != 0.0).unwrap_or(0);
        let end = weights.iter().rposition(|w| *w != 0.0).map_or(weights.len(), |k| k + 1);
        Self { first: first + lead, weights: weights[lead..end].to_vec() }
    }

    /// `alpha * a + (1 - alpha) * b`.
    pub fn mix(alpha: f64, a: &Self, b: &Self) -> Self {
        let first = a.first.min(b.first);
        let end = (a.first + a.weights.len()).max(b.first + b.weights.len());
        let mut weights = vec![0.0; end - first];
        for (factor, row) in [(alpha, a), (1.0 - alpha, b)] {
            for (k, w) in row.weights.iter().enumerate() {
                weights[row.first - first + k] += factor * w;
            }
        }
        Self::trimmed(first, &weights)
    }

    /// The row of the blossom of the polynomial piece on `span`, taken at `degree` arguments: the
    /// B-spline basis recurrence with another argument in each step.
    pub fn blossom(knots: &KnotVector, span: usize, arguments: impl IntoIterator<Item = f64>) -> Self {
        let (p, u) = (knots.degree(), knots.as_slice());
        let mut row = vec![0.0; p + 1];
        row[0] = 1.0;
        for (k, x) in arguments.into_iter().enumerate() {
            let mut saved = 0.0;
            for r in 0..=k {
                let (low, high) = (u[span + r - k], u[span + r + 1]);
                let scaled = row[r] / (high - low);
                row[r] = saved + (high - x) * scaled;
                saved = (x - low) * scaled;
            }
            row[k + 1] = saved;
        }
        Self::trimmed(span - p, &row)
    }

    /// The combination of control points `index(k)`; points and weights as stored, not premultiplied.
    /// `rational` false: all weights are equal and stay so exactly.
    pub fn blend<V: Vector>(
        &self,
        points: &[V],
        weights: &[f64],
        rational: bool,
        index: impl Fn(usize) -> usize,
    ) -> (V, f64) {
        if self.weights.len() == 1 && self.weights[0] == 1.0 {
            let k = index(self.first);
            return (points[k], weights[k]);
        }
        let (mut a, mut w) = (V::ZERO, 0.0);
        for (k, factor) in self.weights.iter().enumerate() {
            let k = index(self.first + k);
            let weight = if rational { factor * weights[k] } else { *factor };
            a = a + points[k] * weight;
            w += weight;
        }
        if rational { (a * (1.0 / w), w) } else { (a, weights[0]) }
    }
}

impl SplineMap {
    /// The map that changes nothing, for `count` control points.
    pub fn identity(count: usize) -> Self {
        Self { rows: (0..count).map(Row::copy).collect() }
    }

    /// This map after `first`: old -> `first` -> `self`.
    pub fn after(&self, first: &Self) -> Self {
        let rows = self.rows.iter().map(|row| {
            let inner = &first.rows[row.first..row.first + row.weights.len()];
            let start = inner.iter().map(|r| r.first).min().unwrap_or(0);
            let end = inner.iter().map(|r| r.first + r.weights.len()).max().unwrap_or(0);
            let mut weights = vec![0.0; end - start];
            for (factor, r) in row.weights.iter().zip(inner) {
                for (k, w) in r.weights.iter().enumerate() {
                    weights[r.first - start + k] += factor * w;
                }
            }
            Row::trimmed(start, &weights)
        });
        Self { rows: rows.collect() }
    }

    /// New points and weights of one line of control points.
    pub fn apply<V: Vector>(&self, points: &[V], weights: &[f64], rational: bool) -> (Vec<V>, Vec<f64>) {
        self.rows.iter().map(|row| row.blend(points, weights, rational, |k| k)).unzip()
    }

    /// New points and weights of a u-major net with `count_v` points in each row, mapped along u.
    pub fn apply_u<V: Vector>(
        &self,
        points: &[V],
        weights: &[f64],
        rational: bool,
        count_v: usize,
    ) -> (Vec<V>, Vec<f64>) {
        let net = self.rows.iter().flat_map(|row| {
            (0..count_v).map(move |j| row.blend(points, weights, rational, |i| i * count_v + j))
        });
        net.unzip()
    }

    /// New points and weights of a u-major net with `count_v` points in each row, mapped along v.
    pub fn apply_v<V: Vector>(
        &self,
        points: &[V],
        weights: &[f64],
        rational: bool,
        count_v: usize,
    ) -> (Vec<V>, Vec<f64>) {
        let net = (0..points.len() / count_v).flat_map(|i| {
            self.rows.iter().map(move |row| row.blend(points, weights, rational, |j| i * count_v + j))
        });
        net.unzip()
    }
}
