//! One row of constant v through a trimmed face: the integral of the area element along it.

use glam::DVec3;

use super::quadrature::rule;
use super::sheet::{Sheet, interval};
use crate::kernel::bezier::{BezierPatch, bernstein};

/// Intervals of u inside the region at one height, cut at the patch lines, with the iso-curves of the
/// patches there.
#[derive(Debug, Default)]
pub(crate) struct Row {
    /// From, to, and the position of the iso-curve.
    parts: Vec<(f64, f64, usize)>,
    curves: Vec<IsoCurve>,
}

/// A patch at constant v: control points of the curve in u and of its derivative in v, homogeneous.
#[derive(Debug)]
struct IsoCurve {
    low: f64,
    size: f64,
    points: Vec<[(DVec3, f64); 2]>,
}

impl Row {
    /// The row at height `v`, in patch row `cell`, within `limits` of u; sorted `crossings` pair up to
    /// intervals inside.
    pub fn new(sheet: &Sheet, cell: usize, v: f64, limits: (f64, f64), crossings: &[f64]) -> Self {
        let lines = sheet.u_lines();
        let mut row = Self::default();
        let mut last = None;
        for pair in crossings.chunks_exact(2) {
            let (from, to) = (pair[0].max(limits.0), pair[1].min(limits.1));
            if !(from < to) {
                continue;
            }
            for column in interval(lines, from)..=interval(lines, to) {
                let (a, b) = (from.max(lines[column]), to.min(lines[column + 1]));
                if !(a < b) {
                    continue;
                }
                if last != Some(column) {
                    let Some(patch) = sheet.cell(column, cell) else { continue };
                    row.curves.push(IsoCurve::new(patch, v));
                    last = Some(column);
                }
                row.parts.push((a, b, row.curves.len() - 1));
            }
        }
        row
    }

    /// Integral of `|du x dv|` over the row with the rule `(order, parts)`: `parts` equal parts of each
    /// interval, the rule of [`rule`] number `order` in each.
    pub fn integrate(&self, (order, parts): (usize, usize)) -> f64 {
        let mut sum = 0.0;
        for &(from, to, curve) in &self.parts {
            let step = (to - from) / parts as f64;
            for part in 0..parts {
                let start = from + step * part as f64;
                for (x, w) in rule(order) {
                    sum += w * step * self.curves[curve].area_element(start + step * x);
                }
            }
        }
        sum
    }
}

impl IsoCurve {
    fn new(patch: &BezierPatch, v: f64) -> Self {
        let size = patch.uv_max - patch.uv_min;
        let local = ((v - patch.uv_min.y) / size.y).clamp(0.0, 1.0);
        let count = patch.degree_v + 1;
        let b = bernstein::tangent::<{ bernstein::MAX_COUNT }>(patch.degree_v, local);
        let rows = patch.points.chunks_exact(count).zip(patch.weights.chunks_exact(count));
        let points = rows.map(|(points, weights)| {
            let mut sums = [(DVec3::ZERO, 0.0); 2];
            for (j, (p, w)) in points.iter().zip(weights).enumerate() {
                for (sum, b) in sums.iter_mut().zip(&b) {
                    sum.0 += *p * (w * b[j]);
                    sum.1 += w * b[j];
                }
            }
            sums[1].0 /= size.y;
            sums[1].1 /= size.y;
            sums
        });
        Self { low: patch.uv_min.x, size: size.x, points: points.collect() }
    }

    /// `|du x dv|` at native `u`.
    fn area_element(&self, u: f64) -> f64 {
        match self.points.len() {
            0..=4 => self.area_element_sized::<4>(u),
            5..=8 => self.area_element_sized::<8>(u),
            _ => self.area_element_sized::<{ bernstein::MAX_COUNT }>(u),
        }
    }

    fn area_element_sized<const N: usize>(&self, u: f64) -> f64 {
        let local = ((u - self.low) / self.size).clamp(0.0, 1.0);
        let b = bernstein::tangent::<N>(self.points.len() - 1, local);
        let (mut h, mut hu, mut hv) = ((DVec3::ZERO, 0.0), (DVec3::ZERO, 0.0), (DVec3::ZERO, 0.0));
        for (i, [p, d]) in self.points.iter().enumerate() {
            h = (h.0 + p.0 * b[0][i], h.1 + p.1 * b[0][i]);
            hu = (hu.0 + p.0 * b[1][i], hu.1 + p.1 * b[1][i]);
            hv = (hv.0 + d.0 * b[0][i], hv.1 + d.1 * b[0][i]);
        }
        let point = h.0 / h.1;
        let (du, dv) = (hu.0 - point * hu.1, hv.0 - point * hv.1);
        du.cross(dv).length() / (h.1 * h.1 * self.size)
    }
}
