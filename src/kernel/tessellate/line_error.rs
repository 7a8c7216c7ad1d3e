//! How far a curve in space is from a chord: P2's error bounds, corrected.
//!
//! The distance to a segment is convex and zero at both ends, so it is at most the largest distance of a control
//! point times one minus the least sum of the two end functions. For equal weights that is `1 - 2^(1 - n)`
//! (P2 prints `1 - 2^(2 - n)`, which is zero for a parabola); for rational curves the end functions shrink by the ratio
//! of the end weights to the largest. [`within`] sharpens the bound by halving until it decides.

use glam::{DVec3, DVec4};

use crate::kernel::bezier::BezierCurve3;
use crate::kernel::bezier::bernstein::MAX_COUNT;

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
    part_within(curve, (0.0, 1.0), (a, b), tolerance)
}

/// The same for the part of `curve` between two parameters.
pub fn part_within(curve: &BezierCurve3, range: (f64, f64), chord: (DVec3, DVec3), tolerance: f64) -> bool {
    let whole = range == (0.0, 1.0) && (curve.start(), curve.end()) == chord;
    if whole && line_error(curve) <= tolerance {
        return true;
    }
    match curve.points.len() {
        0..=4 => Part::<4>::new(curve, range).within(chord, tolerance, DEPTH),
        5..=8 => Part::<8>::new(curve, range).within(chord, tolerance, DEPTH),
        9..=20 => Part::<20>::new(curve, range).within(chord, tolerance, DEPTH),
        _ => Part::<MAX_COUNT>::new(curve, range).within(chord, tolerance, DEPTH),
    }
}

/// Part of a curve: homogeneous control points.
#[derive(Clone, Copy)]
struct Part<const N: usize> {
    points: [DVec4; N],
    count: usize,
}

impl<const N: usize> Part<N> {
    fn new(curve: &BezierCurve3, (from, to): (f64, f64)) -> Self {
        let mut part = Self { points: [DVec4::ZERO; N], count: curve.points.len() };
        for (home, (p, w)) in part.points.iter_mut().zip(curve.points.iter().zip(&curve.weights)) {
            *home = (*p * *w).extend(*w);
        }
        if to < 1.0 {
            part = part.split(to).0;
        }
        if from > 0.0 {
            part = part.split(from / to).1;
        }
        part
    }

    fn split(mut self, t: f64) -> (Self, Self) {
        let mut left = self;
        let count = self.count;
        for k in 1..count {
            for i in 0..count - k {
                self.points[i] = self.points[i] * (1.0 - t) + self.points[i + 1] * t;
            }
            left.points[k] = self.points[0];
        }
        (left, self)
    }

    fn within(&self, (a, b): (DVec3, DVec3), tolerance: f64, depth: u32) -> bool {
        let near = |h: &DVec4| distance_to_segment(h.truncate() / h.w, a, b) <= tolerance;
        let points = &self.points[..self.count];
        let ends = [points[0], points[self.count - 1]];
        if depth == DEPTH && !ends.iter().all(near) {
            return false;
        }
        if points[1..self.count - 1].iter().all(near) {
            return true;
        }
        if depth == 0 {
            return false;
        }
        let (left, right) = self.split(0.5);
        near(&right.points[0])
            && left.within((a, b), tolerance, depth - 1)
            && right.within((a, b), tolerance, depth - 1)
    }
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
