//! Trim curves lifted to model space: a pcurve composed with the patch it runs on (P2, section 4).
//!
//! A curve of degree d on a patch of degrees (m, n) has degree d (m + n) in space. P2 solves for its control
//! points; composing is exact and well conditioned: with `u = X / W`, `v = Y / W` the point times `W^(m + n)` is
//! `sum_ij C(m,i) X^i (W - X)^(m-i) C(n,j) Y^j (W - Y)^(n-j) H_ij`, products of Bernstein polynomials, which in scaled
//! form are convolutions of numbers of one sign. All of it is homogeneous, so rational curves and surfaces are no
//! special case. A coordinate that stays constant adds no degree.

use glam::{DVec2, DVec3, DVec4};

use crate::kernel::bezier::bernstein::{self, MAX_COUNT, binomial_row};
use crate::kernel::bezier::{BezierCurve2, BezierCurve3, BezierPatch};

/// Highest degree that is composed exactly; beyond it binomials lose digits and splitting is dear.
pub const HIGHEST_DEGREE: usize = 60;

/// Polynomials of one degree in scaled Bernstein form (coefficient i times `C(degree, i)`), one after the other.
struct Scaled {
    coefficients: Vec<f64>,
    /// Coefficients of each.
    count: usize,
}

impl Scaled {
    fn each(&self) -> std::slice::ChunksExact<'_, f64> {
        self.coefficients.chunks_exact(self.count)
    }
}

/// Adds the product of two scaled polynomials to `result`.
fn add_product(a: &[f64], b: &[f64], result: &mut [f64]) {
    for (i, x) in a.iter().enumerate() {
        for (sum, y) in result[i..].iter_mut().zip(b) {
            *sum += x * y;
        }
    }
}

/// Bernstein basis of degree `n` along a curve: `C(n,k) A^k B^(n-k)`, each of degree `n` times that of A and B.
fn basis_along(n: usize, a: &[f64], b: &[f64]) -> Scaled {
    let degree = a.len() - 1;
    let count = n * degree + 1;
    // The k-th power has k times the degree, and starts after those before it.
    let start = |k: usize| k + degree * (k * k.saturating_sub(1)) / 2;
    let mut powers = vec![0.0; 2 * start(n + 1)];
    let (of_a, of_b) = powers.split_at_mut(start(n + 1));
    for (x, powers) in [(a, &mut *of_a), (b, &mut *of_b)] {
        powers[0] = 1.0;
        for k in 1..=n {
            let (before, rest) = powers[start(k - 1)..].split_at_mut(start(k) - start(k - 1));
            add_product(x, before, &mut rest[..k * degree + 1]);
        }
    }
    let mut coefficients = vec![0.0; (n + 1) * count];
    for (k, (value, scale)) in coefficients.chunks_exact_mut(count).zip(binomial_row(n)).enumerate() {
        let (x, y) = (&of_a[start(k)..start(k + 1)], &of_b[start(n - k)..start(n - k + 1)]);
        add_product(x, y, value);
        value.iter_mut().for_each(|x| *x *= scale);
    }
    Scaled { coefficients, count }
}

/// The basis along one coordinate: numbers where the coordinate is constant, polynomials else.
fn along(degree: usize, curve: &BezierCurve2, axis: usize, scale: &[f64]) -> Scaled {
    let first = curve.points[0][axis];
    if curve.points.iter().all(|p| p[axis] == first) {
        let mut values = [0.0; MAX_COUNT];
        bernstein::values(degree, first, &mut values);
        return Scaled { coefficients: values[..=degree].to_vec(), count: 1 };
    }
    let (mut a, mut b) = ([0.0; MAX_COUNT], [0.0; MAX_COUNT]);
    for (k, ((p, w), s)) in curve.points.iter().zip(&curve.weights).zip(scale).enumerate() {
        (a[k], b[k]) = (p[axis] * w * s, (1.0 - p[axis]) * w * s);
    }
    let count = curve.points.len();
    basis_along(degree, &a[..count], &b[..count])
}

/// Degree of the image of `curve`, given in the patch's own parameters.
pub fn lifted_degree(curve: &BezierCurve2, patch: &BezierPatch) -> usize {
    let varies = |axis: usize| curve.points.iter().any(|p| p[axis] != curve.points[0][axis]);
    let degree = |axis, n| if varies(axis) { n } else { 0 };
    curve.degree() * (degree(0, patch.degree_u) + degree(1, patch.degree_v))
}

/// The image of `curve`, given in the patch's own parameters (0 to 1), in model space. The degree must not exceed
/// [`HIGHEST_DEGREE`].
pub fn lift(curve: &BezierCurve2, patch: &BezierPatch) -> BezierCurve3 {
    if let Some(lifted) = on_parallelogram(curve, patch).or_else(|| iso_line(curve, patch)) {
        return lifted;
    }
    let scale = binomial_row(curve.degree());
    let bu = along(patch.degree_u, curve, 0, scale);
    let bv = along(patch.degree_v, curve, 1, scale);
    // Points relative to the patch's middle lose fewer digits.
    let origin = patch.bounds().centre();
    let rows = patch.points.chunks(patch.degree_v + 1).zip(patch.weights.chunks(patch.degree_v + 1));
    let mut sum = vec![DVec4::ZERO; bu.count + bv.count - 1];
    let mut row = vec![DVec4::ZERO; bv.count];
    for ((points, weights), u) in rows.zip(bu.each()) {
        row.fill(DVec4::ZERO);
        for ((p, w), v) in points.iter().zip(weights).zip(bv.each()) {
            let h = ((*p - origin) * *w).extend(*w);
            row.iter_mut().zip(v).for_each(|(r, b)| *r += h * *b);
        }
        for (i, a) in u.iter().enumerate() {
            for (sum, b) in sum[i..].iter_mut().zip(&row) {
                *sum += *b * *a;
            }
        }
    }
    let polynomial = !patch.is_rational() && !curve.is_rational();
    let scale = binomial_row(sum.len() - 1);
    let (points, weights) = sum
        .iter()
        .zip(scale)
        .map(|(h, s)| (origin + h.truncate() / h.w, if polynomial { 1.0 } else { h.w / s }))
        .unzip();
    reduced(BezierCurve3 { points, weights })
}

/// The image on a patch that is a parallelogram, run through evenly: an affine map keeps degree and weights.
fn on_parallelogram(curve: &BezierCurve2, patch: &BezierPatch) -> Option<BezierCurve3> {
    if patch.degree_u != 1 || patch.degree_v != 1 || patch.is_rational() {
        return None;
    }
    let [a, b, c, d] = [0, 1, 2, 3].map(|k| patch.points[k]);
    let (along_v, along_u) = (b - a, c - a);
    let twist = (d - c - along_v).length();
    let size = along_u.length().max(along_v.length());
    (twist <= LOSSLESS * size).then(|| curve.map_points(|p| a + along_u * p.x + along_v * p.y))
}

/// The image of a line along which one parameter stays the same, run through evenly: part of a row of the patch.
fn iso_line(curve: &BezierCurve2, patch: &BezierPatch) -> Option<BezierCurve3> {
    if curve.degree() != 1 || curve.is_rational() {
        return None;
    }
    let (start, end) = (curve.points[0], curve.points[1]);
    let axis = if start.x == end.x { 0 } else { 1 };
    if start[axis] != end[axis] {
        return None;
    }
    let (m, n) = (patch.degree_u, patch.degree_v);
    let degree = [m, n][axis];
    let mut basis = [0.0; MAX_COUNT];
    bernstein::values(degree, start[axis], &mut basis);
    let origin = patch.points[0];
    let row = |k: usize| {
        let mut sum = DVec4::ZERO;
        for (i, b) in basis[..=degree].iter().enumerate() {
            let at = if axis == 0 { i * (n + 1) + k } else { k * (n + 1) + i };
            sum += ((patch.points[at] - origin) * patch.weights[at]).extend(patch.weights[at]) * *b;
        }
        sum
    };
    let rational = patch.is_rational();
    let (points, weights) = (0..=[n, m][axis])
        .map(row)
        .map(|h| (origin + h.truncate() / h.w, if rational { h.w } else { 1.0 }))
        .unzip();
    let whole = BezierCurve3 { points, weights };
    let (from, to) = (start[1 - axis], end[1 - axis]);
    Some(reduced(match (from, to) {
        (0.0, 1.0) => whole,
        (1.0, 0.0) => whole.reversed(),
        _ if from < to => whole.restrict(from, to),
        _ => whole.restrict(to, from).reversed(),
    }))
}

/// Parts of this size of a curve's control polygon count as nothing when its degree is reduced.
const LOSSLESS: f64 = 1e-13;
/// A highest difference above this part of it is no rounding, up to a degree.
const NO_DOUBT: f64 = 1e-2;
const FEW: usize = 40;

/// Lossless degree reduction (P2, section 4, after Farin 1996): from both ends, on homogeneous points; taken
/// where both passes agree within rounding.
pub fn reduced(mut curve: BezierCurve3) -> BezierCurve3 {
    while curve.degree() > 1 {
        let n = curve.degree();
        let home = |i: usize| {
            let w = curve.weights[i];
            ((curve.points[i] - curve.points[0]) * w).extend(w)
        };
        // Both passes differ at their ends by the highest difference: mostly that says no.
        let (mut size, mut highest) = (0.0f64, DVec4::ZERO);
        for (i, binomial) in binomial_row(n).iter().enumerate() {
            let h = home(i);
            size = size.max(h.length());
            highest += h * if i % 2 == 0 { *binomial } else { -binomial };
        }
        if n <= FEW && highest.abs().max_element() > NO_DOUBT * size {
            break;
        }
        let home: Vec<DVec4> = (0..=n).map(home).collect();
        let mut left = vec![home[0]];
        for i in 1..n {
            left.push((home[i] * n as f64 - left[i - 1] * i as f64) / (n - i) as f64);
        }
        let mut right = vec![home[n]; n];
        for i in (1..n).rev() {
            right[i - 1] = (home[i] * n as f64 - right[i] * (n - i) as f64) / i as f64;
        }
        let close = left.iter().zip(&right).all(|(a, b)| (*a - *b).abs().max_element() <= LOSSLESS * size);
        if !close {
            break;
        }
        let middle = n / 2;
        let home: Vec<DVec4> = (0..n).map(|i| if i < middle { left[i] } else { right[i] }).collect();
        if home.iter().any(|h| !(h.w > 0.0)) {
            break;
        }
        let origin = curve.points[0];
        let (first, last) = (curve.points[0], curve.points[n]);
        let rational = curve.is_rational();
        curve.points = home.iter().map(|h| origin + h.truncate() / h.w).collect();
        curve.weights = home.iter().map(|h| if rational { h.w } else { 1.0 }).collect();
        curve.points[0] = first;
        curve.points[n - 1] = last;
    }
    curve
}

/// A cubic with the ends and end tangents of `curve` on a surface given by point and derivatives, for
/// degrees beyond [`HIGHEST_DEGREE`]: good for short pieces only.
pub fn hermite(start: (DVec3, DVec3), end: (DVec3, DVec3)) -> BezierCurve3 {
    let points = vec![start.0, start.0 + start.1 / 3.0, end.0 - end.1 / 3.0, end.0];
    BezierCurve3::polynomial(points)
}

/// A piece of a uv curve in the own parameters of the patch it runs on.
pub fn localised(curve: &BezierCurve2, patch: &BezierPatch) -> BezierCurve2 {
    // Exact where the curve follows a border of the patch, so that constants stay constant.
    let map = |p: DVec2| patch.local(p);
    curve.map_points(map)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn patch(rational: bool) -> BezierPatch {
        let point = |k: usize| {
            let (i, j) = ((k / 3) as f64, (k % 3) as f64);
            DVec3::new(i + 0.1 * j, j - 0.2 * i * j, (i * 1.3).sin() + 0.3 * j * j)
        };
        BezierPatch {
            degree_u: 3,
            degree_v: 2,
            points: (0..12).map(point).collect(),
            weights: (0..12).map(|k| if rational { 1.0 + 0.3 * (k % 5) as f64 } else { 1.0 }).collect(),
            uv_min: DVec2::ZERO,
            uv_max: DVec2::ONE,
        }
    }

    #[test]
    fn the_lifted_curve_is_the_image_of_the_curve() {
        let points = vec![DVec2::new(0.1, 0.2), DVec2::new(0.9, 0.1), DVec2::new(0.4, 0.8)];
        for (rational, weights) in [(false, [1.0; 3]), (true, [1.0; 3]), (true, [1.0, 0.4, 2.0])] {
            let (patch, curve) =
                (patch(rational), BezierCurve2 { points: points.clone(), weights: weights.to_vec() });
            let lifted = lift(&curve, &patch);
            assert!(lifted.degree() <= 10);
            for k in 0..=20 {
                let t = f64::from(k) / 20.0;
                let uv = curve.point(t);
                let off = lifted.point(t).distance(patch.point(uv.x, uv.y));
                assert!(off < 1e-13, "{off:e}");
            }
        }
    }

    #[test]
    fn iso_curves_keep_the_degree_of_the_patch() {
        let line = BezierCurve2::polynomial(vec![DVec2::new(0.0, 0.3), DVec2::new(1.0, 0.3)]);
        let lifted = lift(&line, &patch(true));
        assert_eq!(lifted.degree(), 3);
        assert_eq!(lifted_degree(&line, &patch(true)), 3);
    }

    #[test]
    fn lines_of_constant_parameter_and_planes_need_no_products() {
        let at = |from: (f64, f64), to: (f64, f64)| {
            BezierCurve2::polynomial(vec![DVec2::new(from.0, from.1), DVec2::new(to.0, to.1)])
        };
        let lines = [
            at((0.0, 0.3), (1.0, 0.3)),
            at((0.9, 0.0), (0.2, 0.0)),
            at((0.4, 1.0), (0.4, 0.0)),
            at((1.0, 0.2), (1.0, 0.7)),
        ];
        let mut plane = patch(false);
        (plane.degree_u, plane.degree_v) = (1, 1);
        let corners = [(0.0, 0.0), (1.0, 3.0), (2.0, 0.5), (3.0, 3.5)];
        plane.points = corners.iter().map(|c| DVec3::new(c.0, c.1, 1.0)).collect();
        plane.weights = vec![1.0; 4];
        let arc = BezierCurve2 {
            points: vec![DVec2::new(0.1, 0.2), DVec2::new(0.9, 0.1), DVec2::new(0.4, 0.8)],
            weights: vec![1.0, 0.4, 2.0],
        };
        for (patch, curves) in [(patch(true), &lines[..]), (patch(false), &lines[..]), (plane, &[arc][..])] {
            for curve in curves {
                let lifted = lift(curve, &patch);
                assert!(lifted.degree() <= 3);
                for k in 0..=20 {
                    let t = f64::from(k) / 20.0;
                    let uv = curve.point(t);
                    assert!(lifted.point(t).distance(patch.point(uv.x, uv.y)) < 1e-13);
                }
            }
        }
    }

    #[test]
    fn elevated_curves_come_back_to_their_degree() {
        let points = vec![DVec3::ZERO, DVec3::new(1.0, 2.0, 0.0), DVec3::new(3.0, 1.0, 4.0)];
        for weights in [vec![1.0; 3], vec![1.0, 0.5, 2.0]] {
            let curve = BezierCurve3 { points: points.clone(), weights };
            let back = reduced(curve.elevated(4));
            assert_eq!(back.degree(), 2);
            assert!(
                (0..=10)
                    .all(|k| back.point(f64::from(k) / 10.0).distance(curve.point(f64::from(k) / 10.0))
                        < 1e-12)
            );
        }
    }
}
