//! How far a curve in space is from a chord: P2's error bounds, corrected.
//!
//! The distance to a segment is convex and zero at both ends, so it is at most the largest distance of a control
//! point times one minus the least sum of the two end functions. For equal weights that is `1 - 2^(1 - n)`
//! (P2 prints `1 - 2^(2 - n)`, which is zero for a parabola); for rational curves the end functions shrink by the ratio
//! of the end weights to the largest. [`within`] sharpens the bound by halving until it decides.

use glam::DVec3;

use crate::kernel::bezier::BezierCurve3;

/// Distance of `p` from the segment between `a` and `b`.
pub fn distance_to_segment(p: DVec3, a: DVec3, b: DVec3) -> f64 {
    let chord = b - a;
    let squared = chord.length_squared();
    let along = if squared > 0.0 { ((p - a).dot(chord) / squared).clamp(0.0, 1.0) } else { 0.0 };
    (p - a - chord * along).length()
}

/// One minus the least sum of the two end functions of a curve's basis.
fn factor(curve: &BezierCurve3) -> f64 {
    let ends = curve.weights[0].min(curve.weights[curve.degree()]);
    let largest = curve.weights.iter().copied().fold(0.0, f64::max);
    1.0 - 0.5f64.powi(curve.degree() as i32 - 1) * (ends / largest)
}

/// Upper bound of the distance of a curve from the chord between its ends (P2's `eps_line`).
pub fn line_error(curve: &BezierCurve3) -> f64 {
    let (a, b) = (curve.start(), curve.end());
    let farthest = curve.points.iter().map(|p| distance_to_segment(*p, a, b)).fold(0.0, f64::max);
    factor(curve) * farthest
}

/// Upper bound of the distance between points of a curve and of its chord at equal parameters, which is P2's
/// `eps_point`: control points against even shares of the chord.
pub fn point_error(curve: &BezierCurve3) -> f64 {
    let (a, b, n) = (curve.start(), curve.end(), curve.degree() as f64);
    let off = |(i, p): (usize, &DVec3)| (*p - a.lerp(b, i as f64 / n)).length();
    let farthest = curve.points.iter().enumerate().map(off).fold(0.0, f64::max);
    factor(curve) * farthest
}

/// Position of the control point farthest from the chord.
pub fn farthest_point(curve: &BezierCurve3) -> usize {
    let (a, b) = (curve.start(), curve.end());
    let off = |i: usize| distance_to_segment(curve.points[i], a, b);
    (1..curve.degree().max(2)).max_by(|i, j| off(*i).total_cmp(&off(*j))).unwrap_or(0)
}

/// Halvings of a curve before an undecided part counts as too far.
const DEPTH: u32 = 5;

/// Whether all of `curve` provably lies within `tolerance` of the segment between `a` and `b`.
pub fn within(curve: &BezierCurve3, a: DVec3, b: DVec3, tolerance: f64) -> bool {
    fn halves(curve: &BezierCurve3, a: DVec3, b: DVec3, tolerance: f64, depth: u32) -> bool {
        if curve.points.iter().all(|p| distance_to_segment(*p, a, b) <= tolerance) {
            return true;
        }
        if depth == 0 || !(distance_to_segment(curve.point(0.5), a, b) <= tolerance) {
            return false;
        }
        let (left, right) = curve.split(0.5);
        halves(&left, a, b, tolerance, depth - 1) && halves(&right, a, b, tolerance, depth - 1)
    }
    let ends = [curve.start(), curve.end()];
    if ends == [a, b] && line_error(curve) <= tolerance {
        return true;
    }
    ends.iter().all(|p| distance_to_segment(*p, a, b) <= tolerance) && halves(curve, a, b, tolerance, DEPTH)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Largest distance of samples from the chord.
    fn sampled(curve: &BezierCurve3) -> f64 {
        let (a, b) = (curve.start(), curve.end());
        (0..=1000).map(|k| distance_to_segment(curve.point(f64::from(k) / 1000.0), a, b)).fold(0.0, f64::max)
    }

    #[test]
    fn the_bound_is_exact_for_a_parabola_where_the_printed_one_is_zero() {
        let curve =
            BezierCurve3::polynomial(vec![DVec3::ZERO, DVec3::new(1.0, 1.0, 0.0), DVec3::new(2.0, 0.0, 0.0)]);
        assert!((line_error(&curve) - 0.5).abs() < 1e-15);
        assert!((sampled(&curve) - 0.5).abs() < 1e-6);
    }

    #[test]
    fn the_bound_holds_for_rational_curves_of_all_degrees() {
        for seed in 0..400u32 {
            let number = |k: u32| {
                let x = (seed * 7919 + k).wrapping_mul(2_654_435_761) ^ (seed << 7);
                f64::from((x ^ (x >> 15)).wrapping_mul(2_246_822_519)) / f64::from(u32::MAX)
            };
            let count = 3 + seed % 6;
            let point = |k: u32| DVec3::new(number(4 * k), number(4 * k + 1), number(4 * k + 2));
            let weight = |k: u32| if seed % 2 == 0 { 1.0 } else { 10f64.powf(2.0 * number(4 * k + 3) - 1.0) };
            let curve = BezierCurve3 {
                points: (0..count).map(point).collect(),
                weights: (0..count).map(weight).collect(),
            };
            let truth = sampled(&curve);
            assert!(truth <= line_error(&curve) + 1e-12, "{seed}");
            assert!(line_error(&curve) <= point_error(&curve) + 1e-12);
            assert!(!within(&curve, curve.start(), curve.end(), 0.99 * truth));
            assert!(within(&curve, curve.start(), curve.end(), 1.02 * truth), "{seed}");
        }
    }
}
