//! Fitting control points of a pcurve to given points by least squares, its knots and weights kept.
//!
//! The end points are met exactly. Unknowns are the inner control points; the normal equations of the rational
//! basis are symmetric, positive definite and banded (Piegl & Tiller, section 9.4.1).

use glam::DVec2;

use crate::kernel::nurbs::{KnotVector, NurbsCurve2};

/// Control points at most.
const MOST_POINTS: usize = 520;

/// The curve over the knots and weights of `curve` (clamped) closest to `goals`, of which the first and last are
/// met exactly. `None` when the goals do not determine it.
pub fn least_squares(curve: &NurbsCurve2, goals: &[(f64, DVec2)]) -> Option<NurbsCurve2> {
    let count = curve.points().len();
    let mut points = curve.points().to_vec();
    points[0] = goals.first()?.1;
    points[count - 1] = goals.last()?.1;
    let inner = count - 2;
    if inner > 0 {
        let mut matrix = vec![0.0; inner * inner];
        let mut right = vec![DVec2::ZERO; inner];
        for (t, goal) in goals {
            let (first, basis) = rational_basis(curve, *t);
            let known = |i: usize| i == 0 || i == count - 1;
            let rest = basis
                .iter()
                .enumerate()
                .filter(|(k, _)| known(first + k))
                .fold(*goal, |rest, (k, b)| rest - points[first + k] * *b);
            for (k, bk) in basis.iter().enumerate().filter(|(k, _)| !known(first + k)) {
                right[first + k - 1] += rest * *bk;
                for (l, bl) in basis.iter().enumerate().filter(|(l, _)| !known(first + l)) {
                    matrix[(first + k - 1) * inner + first + l - 1] += bk * bl;
                }
            }
        }
        let solved = cholesky(&mut matrix, &mut right, inner)?;
        points[1..count - 1].copy_from_slice(solved);
    }
    NurbsCurve2::new(curve.knots().clone(), points, curve.weights().to_vec()).ok()
}

/// The rational basis functions that do not vanish at `t`, from control point number `.0` on.
fn rational_basis(curve: &NurbsCurve2, t: f64) -> (usize, Vec<f64>) {
    let knots: &KnotVector = curve.knots();
    let span = knots.span(t);
    let basis = knots.basis(span, t, 0);
    let first = span - knots.degree();
    let weighted: Vec<f64> =
        basis[0].iter().enumerate().map(|(k, b)| b * curve.weights()[first + k]).collect();
    let sum: f64 = weighted.iter().sum();
    (first, weighted.into_iter().map(|b| b / sum).collect())
}

/// Solves a symmetric positive definite system in place; `None` when it is not.
fn cholesky<'a>(matrix: &mut [f64], right: &'a mut [DVec2], n: usize) -> Option<&'a [DVec2]> {
    for i in 0..n {
        for j in 0..=i {
            let dot: f64 = (0..j).map(|k| matrix[i * n + k] * matrix[j * n + k]).sum();
            let rest = matrix[i * n + j] - dot;
            if i == j {
                if !(rest > 1e-14 * matrix[i * n + i]) {
                    return None;
                }
                matrix[i * n + i] = rest.sqrt();
            } else {
                matrix[i * n + j] = rest / matrix[j * n + j];
            }
        }
    }
    for i in 0..n {
        let sum = (0..i).fold(right[i], |sum, k| sum - right[k] * matrix[i * n + k]);
        right[i] = sum / matrix[i * n + i];
    }
    for i in (0..n).rev() {
        let sum = (i + 1..n).fold(right[i], |sum, k| sum - right[k] * matrix[k * n + i]);
        right[i] = sum / matrix[i * n + i];
    }
    Some(right)
}

/// The same curve with more freedom: cubic first, then each span halved. `None` when it has enough.
pub fn refined(curve: &NurbsCurve2, round: u32) -> Option<NurbsCurve2> {
    if round == 0 && curve.degree() < 3 {
        return curve.elevated(3 - curve.degree()).ok();
    }
    let middles: Vec<f64> = curve.knots().spans().map(|(_, a, b)| 0.5 * (a + b)).collect();
    if curve.points().len() + middles.len() > MOST_POINTS {
        return None;
    }
    curve.inserted(&middles).ok()
}

/// The curve with its start (`end` 0) or end (1) moved from `from` to `to`.
pub fn with_end(curve: &NurbsCurve2, end: usize, from: DVec2, to: DVec2) -> NurbsCurve2 {
    let clamped = if curve.knots().is_clamped() { curve.clone() } else { curve.clamped() };
    let mut points = clamped.points().to_vec();
    let at = if end == 0 { 0 } else { points.len() - 1 };
    // Neighbours on the other side of a period keep their distance.
    points[at] += to - from;
    match NurbsCurve2::new(clamped.knots().clone(), points, clamped.weights().to_vec()) {
        Ok(moved) => moved,
        Err(_) => curve.clone(),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_curve_is_fitted_to_its_own_points() {
        let knots = KnotVector::new(3, vec![0.0, 0.0, 0.0, 0.0, 0.4, 1.0, 1.0, 1.0, 1.0]).unwrap();
        let points = [(0.0, 0.0), (0.2, 0.5), (0.7, 0.1), (0.4, 0.8), (1.0, 1.0)].map(DVec2::from).to_vec();
        let curve = NurbsCurve2::new(knots, points.clone(), vec![1.0, 2.0, 0.5, 1.5, 1.0]).unwrap();
        let goals: Vec<(f64, DVec2)> =
            (0..=20).map(|k| f64::from(k) / 20.0).map(|t| (t, curve.point(t))).collect();
        let mut wrong = points;
        wrong[2] = DVec2::ZERO;
        let start = NurbsCurve2::new(curve.knots().clone(), wrong, curve.weights().to_vec()).unwrap();
        let fitted = least_squares(&start, &goals).unwrap();
        for (a, b) in fitted.points().iter().zip(curve.points()) {
            assert!((*a - *b).length() < 1e-12);
        }
        let finer = refined(&curve, 1).unwrap();
        assert!(
            (0..=10)
                .all(|k| (finer.point(f64::from(k) / 10.0) - curve.point(f64::from(k) / 10.0)).length()
                    < 1e-14)
        );
    }
}
