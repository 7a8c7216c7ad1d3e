//! Closed outlines in a uv plane: exact circles, polygons, smooth shapes given by a function, and
//! single Bezier curves of very high degree.
//!
//! Every function returns the curves of one loop, head to tail, closed exactly. Points must be finite: callers
//! check what users give.

use std::f64::consts::TAU;

use glam::DVec2;

use crate::kernel::nurbs::{KnotVector, NurbsCurve2};
use crate::kernel::trim::{LoopRecord, LoopRole};

/// A loop of `curves`.
pub fn trim_loop(role: LoopRole, curves: Vec<NurbsCurve2>) -> LoopRecord {
    LoopRecord::new(role, curves)
}

/// The Bezier curve over `[0, 1]` with these control points and weights 1.
pub fn bezier(points: Vec<DVec2>) -> NurbsCurve2 {
    let weights = vec![1.0; points.len()];
    let knots = KnotVector::bezier(points.len() - 1, 0.0, 1.0).expect("degree is in range");
    NurbsCurve2::new(knots, points, weights).expect("callers give finite points")
}

/// The exact circle: one rational quadratic of four quarter arcs.
pub fn circle(centre: DVec2, radius: f64) -> Vec<NurbsCurve2> {
    let (knots, ring) = quarter_arcs();
    let points = ring.iter().map(|(p, _)| centre + *p * radius).collect();
    let weights = ring.iter().map(|(_, w)| *w).collect();
    vec![NurbsCurve2::new(knots, points, weights).expect("callers give finite points")]
}

/// Knots over `[0, 4]`, control points and weights of the unit circle, one quarter turn to each unit.
pub fn quarter_arcs() -> (KnotVector, [(DVec2, f64); 9]) {
    let knots = [0.0, 0.0, 0.0, 1.0, 1.0, 2.0, 2.0, 3.0, 3.0, 4.0, 4.0, 4.0];
    let h = std::f64::consts::FRAC_1_SQRT_2;
    let p = DVec2::new;
    let ring = [
        (p(1.0, 0.0), 1.0),
        (p(1.0, 1.0), h),
        (p(0.0, 1.0), 1.0),
        (p(-1.0, 1.0), h),
        (p(-1.0, 0.0), 1.0),
        (p(-1.0, -1.0), h),
        (p(0.0, -1.0), 1.0),
        (p(1.0, -1.0), h),
        (p(1.0, 0.0), 1.0),
    ];
    (KnotVector::new(2, knots.to_vec()).expect("these knots are sorted"), ring)
}

/// The closed polygon through `corners`, one line to a side.
pub fn polygon(corners: &[DVec2]) -> Vec<NurbsCurve2> {
    (0..corners.len()).map(|i| NurbsCurve2::line(corners[i], corners[(i + 1) % corners.len()])).collect()
}

/// The rectangle between two opposite corners.
pub fn rectangle(min: DVec2, max: DVec2) -> Vec<NurbsCurve2> {
    polygon(&[min, DVec2::new(max.x, min.y), max, DVec2::new(min.x, max.y)])
}

/// Cubic Hermite pieces through the closed path `path`, `t` in 0..=1, broken at `breaks` (sorted,
/// in 0..1, the first one repeated at the end by one turn).
pub fn smooth_at(path: impl Fn(f64) -> DVec2, breaks: &[f64]) -> Vec<NurbsCurve2> {
    const STEP: f64 = 1e-5;
    let tangent = |t: f64| (path(t + STEP) - path(t - STEP)) * (0.5 / STEP);
    let count = breaks.len();
    let ends: Vec<DVec2> = breaks.iter().map(|t| path(*t)).collect();
    let tangents: Vec<DVec2> = breaks.iter().map(|t| tangent(*t)).collect();
    (0..count)
        .map(|i| {
            let next = (i + 1) % count;
            let span = breaks[next] - breaks[i] + if next == 0 { 1.0 } else { 0.0 };
            let (a, b) = (ends[i], ends[next]);
            bezier(vec![a, a + tangents[i] * (span / 3.0), b - tangents[next] * (span / 3.0), b])
        })
        .collect()
}

/// [`smooth_at`] with `pieces` equal pieces.
pub fn smooth(path: impl Fn(f64) -> DVec2, pieces: usize) -> Vec<NurbsCurve2> {
    let breaks: Vec<f64> = (0..pieces).map(|i| i as f64 / pieces as f64).collect();
    smooth_at(path, &breaks)
}

/// A rosette around the origin, of mean radius 1: `1 + depth cos(petals * angle)`, as a path for [`smooth`].
pub fn rosette(petals: f64, depth: f64, turn: f64) -> impl Fn(f64) -> DVec2 {
    move |t| DVec2::from_angle(t * TAU + turn) * (1.0 + depth * (petals * t * TAU).cos())
}

/// One closed Bezier curve of `degree` that runs through `path` at `degree + 1` Chebyshev points.
pub fn single_bezier(path: impl Fn(f64) -> DVec2, degree: usize) -> Vec<NurbsCurve2> {
    let nodes: Vec<f64> =
        (0..=degree).map(|i| 0.5 - 0.5 * (std::f64::consts::PI * i as f64 / degree as f64).cos()).collect();
    let mut points = interpolate(&nodes, nodes.iter().map(|t| path(*t)).collect());
    points[degree] = points[0];
    vec![bezier(points)]
}

/// Bezier control points of the polynomial with `values` at `nodes` (distinct, ascending).
pub fn interpolate<V: crate::kernel::vector::Vector>(nodes: &[f64], mut values: Vec<V>) -> Vec<V> {
    let n = nodes.len();
    let mut rows: Vec<Vec<f64>> = nodes.iter().map(|t| bernstein(n - 1, *t)).collect();
    for column in 0..n {
        let pivot = (column..n)
            .max_by(|a, b| rows[*a][column].abs().total_cmp(&rows[*b][column].abs()))
            .expect("the range is not empty");
        rows.swap(column, pivot);
        values.swap(column, pivot);
        for row in column + 1..n {
            let factor = rows[row][column] / rows[column][column];
            for k in column..n {
                rows[row][k] -= factor * rows[column][k];
            }
            values[row] = values[row] - values[column] * factor;
        }
    }
    for row in (0..n).rev() {
        for k in row + 1..n {
            values[row] = values[row] - values[k] * rows[row][k];
        }
        values[row] = values[row] * (1.0 / rows[row][row]);
    }
    values
}

fn bernstein(degree: usize, t: f64) -> Vec<f64> {
    let mut binomial = 1.0;
    (0..=degree)
        .map(|i| {
            let value = binomial * t.powi(i as i32) * (1.0 - t).powi((degree - i) as i32);
            binomial *= (degree - i) as f64 / (i + 1) as f64;
            value
        })
        .collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn circles_are_exact() {
        let centre = DVec2::new(3.0, -1.0);
        let curve = &circle(centre, 2.0)[0];
        for i in 0..=40 {
            assert!((curve.point(i as f64 / 10.0).distance(centre) - 2.0).abs() < 1e-14);
        }
    }

    #[test]
    fn a_single_curve_of_degree_22_follows_its_path() {
        let path = rosette(4.0, 0.25, 0.3);
        let curve = &single_bezier(&path, 22)[0];
        assert_eq!(curve.degree(), 22);
        assert_eq!(curve.points()[0], curve.points()[22]);
        let off =
            (0..=200).map(|i| i as f64 / 200.0).map(|t| curve.point(t).distance(path(t))).fold(0.0, f64::max);
        assert!(off < 0.02, "{off}");
    }

    #[test]
    fn smooth_pieces_join_exactly_and_follow_their_path() {
        let path = rosette(5.0, 0.3, 0.0);
        let curves = smooth(&path, 40);
        for (i, curve) in curves.iter().enumerate() {
            assert_eq!(curve.points()[3], curves[(i + 1) % 40].points()[0]);
            assert!(curve.point(0.5).distance(path((i as f64 + 0.5) / 40.0)) < 1e-3);
        }
    }
}
