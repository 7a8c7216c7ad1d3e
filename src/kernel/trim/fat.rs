//! Fat bounds of a curve: how far a part of it can leave the part's chord.
//!
//! With P = (x, y, w) the homogeneous curve and A, C, B its points at parameters a < t < b, `cross(C - A, B - A)` is
//! det(P(a), P(t), P(b)) / (w(a) w(t) w(b)). Divided differences take the powers out of the determinant: it is
//! (t-a) (b-t) (b-a) det(P(a), P\[a,t\], P\[a,t,b\]), where P\[a,t\] is a mean of P' and P\[a,t,b\] one of P'' / 2. A
//! determinant is linear in each row, so control vectors give rigorous extremes, for rational curves
//! too: `cross / (b-a)^3` lies between the extremes of `det(P_i, P'_j, P''_k) / 8`, with 0, over the
//! cube of the smallest weight. For quadratics that determinant is one number.

use glam::{DVec2, DVec3};

use crate::kernel::bezier::bernstein::{MAX_COUNT, binomial_row};

/// Bounds of a record's curve. `words` are its words from 5 on (see the layout), exactly as stored.
pub fn bounds(words: &[f32], degree: usize, rational: bool, ends: [f32; 4]) -> (f64, f64) {
    let d = DVec2::new(f64::from(ends[2] - ends[0]), f64::from(ends[3] - ends[1]));
    if degree == 2 {
        let q = DVec2::new(f64::from(words[0]), f64::from(words[1]));
        let least_weight = if rational { (0.5 + 0.25 * f64::from(words[2])).min(1.0) } else { 1.0 };
        let bound = 0.25 * q.perp_dot(d) / cube(least_weight);
        return (bound.min(0.0), bound.max(0.0));
    }
    let mut net = [DVec3::ZERO; MAX_COUNT];
    let net = &mut net[..=degree];
    net[0] = DVec3::Z;
    net[degree] = d.extend(1.0);
    let stride = if rational { 3 } else { 2 };
    let binomials = &binomial_row(degree)[1..];
    for ((p, word), binomial) in net[1..degree].iter_mut().zip(words.chunks_exact(stride)).zip(binomials) {
        let w = if rational { f64::from(word[2]) } else { *binomial };
        *p = DVec3::new(f64::from(word[0]), f64::from(word[1]), w) / *binomial;
    }
    let (mut least, mut most) = (0.0f64, 0.0f64);
    for second in net.windows(3) {
        let second = second[0] - 2.0 * second[1] + second[2];
        for first in net.windows(2) {
            let normal = (first[1] - first[0]).cross(second);
            // Polynomials: all rows of points give the same, their derivatives having no w.
            for p in if rational { &net[..] } else { &net[..1] } {
                let value = p.dot(normal);
                least = least.min(value);
                most = most.max(value);
            }
        }
    }
    let factor = (degree * degree * (degree - 1)) as f64 / 8.0 / cube(least_weight(net));
    (least * factor, most * factor)
}

fn cube(x: f64) -> f64 {
    x * x * x
}

/// A lower bound of the weight function: the smallest control weight of its two halves.
fn least_weight(net: &[DVec3]) -> f64 {
    let mut weights = [1.0; MAX_COUNT];
    let weights = &mut weights[..net.len()];
    for (weight, p) in weights.iter_mut().zip(net) {
        *weight = p.z;
    }
    // In place, the ends of the shrinking rows are the control weights of the halves.
    let mut least = 1.0f64;
    for count in (1..weights.len()).rev() {
        for i in 0..count {
            weights[i] = 0.5 * (weights[i] + weights[i + 1]);
        }
        least = least.min(weights[0]).min(weights[count - 1]);
    }
    least
}

/// Both bounds in one word: 16 upper bits each, rounded away from 0.
pub fn pack((low, high): (f64, f64)) -> u32 {
    (half(-low) << 16) | 0x8000_0000 | half(high)
}

/// The upper 16 bits of the smallest such f32 that is at least `x` (`x >= 0`).
fn half(x: f64) -> u32 {
    // One more unit covers both roundings; a bound that overflows stays finite and huge.
    let bits = (x.min(1e30) * 1.000001) as f32;
    if x > 0.0 { (bits.to_bits() >> 16) + 1 } else { 0 }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::kernel::bezier::BezierCurve2;
    use crate::kernel::trim::{PackedSegments, PieceList, SegmentSet, record};
    use proptest::prelude::*;

    proptest! {
        /// Every part of every packed curve stays in its band.
        #[test]
        fn parts_stay_within_their_bounds(
            inner in prop::collection::vec((0.0f64..1.0, 0.0f64..1.0, -2.3f64..2.3), 1..9),
            rational in any::<bool>(),
            parts in prop::collection::vec((0u32..16, 1u32..5, 0.0f32..1.0), 20),
        ) {
            let mut points = vec![DVec2::new(0.1, 0.2)];
            points.extend(inner.iter().map(|(x, y, _)| DVec2::new(*x, *y)));
            points.push(DVec2::new(0.9, 0.7));
            let mut weights = vec![1.0; points.len()];
            for (w, (_, _, log)) in weights[1..].iter_mut().zip(&inner) {
                *w = if rational { log.exp() } else { 1.0 };
            }
            let closing = BezierCurve2::polynomial(vec![points[points.len() - 1], points[0]]);
            let list = PieceList::from_loops(&[vec![BezierCurve2 { points, weights }, closing]], 1e-9);
            let set = SegmentSet::new(&list);
            let packed = PackedSegments::new(&list, &set).expect("few segments");
            for (segment, word) in set.segments.iter().zip(&packed.words) {
                if record::entry_degree(*word) == 1 {
                    continue;
                }
                let curve = record::Curve::new(&packed.data, *word, segment.ends);
                let (low, high) = curve.bounds();
                let size = (segment.ends[2] - segment.ends[0]).abs() * (segment.ends[3] - segment.ends[1]);
                for (k, level, at) in &parts {
                    let length = 0.5f32.powi(*level as i32);
                    let start = length * (k % (1 << level)) as f32;
                    let (a, b) = (curve.point(start), curve.point(start + length));
                    let c = curve.point(start + length * at);
                    let side = (c[0] - a[0]) * (b[1] - a[1]) - (c[1] - a[1]) * (b[0] - a[0]);
                    let cube = length * length * length;
                    let slack = 2e-6 * size;
                    prop_assert!(side >= low * cube - slack && side <= high * cube + slack,
                        "{side} not in {} .. {}", low * cube, high * cube);
                }
            }
        }
    }
}
