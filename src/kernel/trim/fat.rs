//! Fat bounds of a curve: how far a part of it can leave the part's chord.
//!
//! With chord end points A, B at parameters a < b, C - chord = -(integral of a positive kernel times C''),
//! at most (b-a)^2 / 8 in total weight, and B - A = (b-a) times a mean of C'. The cross product is linear in both, so
//! `cross(C - A, B - A) / (b-a)^3` lies between the extremes of `-cross(C''(x), C'(y)) / 8` over all
//! x, y, and 0. For polynomials the control vectors of C'' and C' give rigorous extremes.

use glam::DVec2;

use crate::kernel::bezier::bernstein::{MAX_COUNT, binomial_row};

/// Bounds of a record's curve. `words` are its words from 5 on (see the layout), exactly as stored.
pub fn bounds(words: &[f32], degree: usize, rational: bool, ends: [f32; 4]) -> (f64, f64) {
    let net = Net::new(words, degree, rational, ends);
    let (mut first, mut second) = (Vectors::default(), Vectors::default());
    if rational {
        let samples = 4 + degree;
        for k in 0..=samples {
            let (c1, c2) = net.derivatives(k as f64 / samples as f64);
            first.push(c1);
            second.push(c2);
        }
    } else {
        net.control_derivatives(&mut first, &mut second);
    }
    let (mut least, mut most) = (0.0f64, 0.0f64);
    for x in second.as_slice() {
        for y in first.as_slice() {
            let k = x.perp_dot(*y);
            least = least.min(k);
            most = most.max(k);
        }
    }
    let margin = if rational { RATIONAL_MARGIN } else { 1.0 };
    (-most / 8.0 * margin, -least / 8.0 * margin)
}

/// What sampling may miss between the samples of a rational curve's derivatives.
const RATIONAL_MARGIN: f64 = 1.25;

/// Control points and weights relative to the lower end, on the stack.
struct Net {
    points: [(DVec2, f64); MAX_COUNT],
    degree: usize,
}

/// A short list of vectors on the stack.
struct Vectors {
    items: [DVec2; 2 * MAX_COUNT + 6],
    count: usize,
}

impl Default for Vectors {
    fn default() -> Self {
        Self { items: [DVec2::ZERO; 2 * MAX_COUNT + 6], count: 0 }
    }
}

impl Vectors {
    fn push(&mut self, v: DVec2) {
        self.items[self.count] = v;
        self.count += 1;
    }

    fn as_slice(&self) -> &[DVec2] {
        &self.items[..self.count]
    }
}

impl Net {
    fn new(words: &[f32], degree: usize, rational: bool, ends: [f32; 4]) -> Self {
        let d = DVec2::new(f64::from(ends[2] - ends[0]), f64::from(ends[3] - ends[1]));
        let mut points = [(DVec2::ZERO, 1.0); MAX_COUNT];
        let stride = if rational { 3 } else { 2 };
        for (i, word) in words.chunks_exact(stride).take(degree - 1).enumerate() {
            let binomial = binomial_row(degree)[i + 1];
            let q = DVec2::new(f64::from(word[0]), f64::from(word[1])) / binomial;
            points[i + 1] = (q, if rational { f64::from(word[2]) / binomial } else { 1.0 });
        }
        points[degree] = (d, 1.0);
        Self { points, degree }
    }

    /// Control vectors of the first and second derivative of a polynomial.
    fn control_derivatives(&self, first: &mut Vectors, second: &mut Vectors) {
        let n = self.degree as f64;
        for pair in self.points[..=self.degree].windows(2) {
            first.push((pair[1].0 - pair[0].0) * n);
        }
        for pair in first.as_slice().windows(2) {
            second.push((pair[1] - pair[0]) * (n - 1.0));
        }
    }

    /// First and second derivative at `t` by de Casteljau's scheme on homogeneous points.
    fn derivatives(&self, t: f64) -> (DVec2, DVec2) {
        let n = self.degree;
        let mut a = self.points;
        let step = |a: &mut [(DVec2, f64)], count: usize| {
            for i in 0..count {
                a[i] = (a[i].0.lerp(a[i + 1].0, t), a[i].1 + (a[i + 1].1 - a[i].1) * t);
            }
        };
        for k in (2..n).rev() {
            step(&mut a, k + 1);
        }
        let degree = n as f64;
        let factor = degree * (degree - 1.0);
        let x2 = (a[2].0 - a[1].0 * 2.0 + a[0].0) * factor;
        let w2 = (a[2].1 - a[1].1 * 2.0 + a[0].1) * factor;
        step(&mut a, 2);
        let (x1, w1) = ((a[1].0 - a[0].0) * degree, (a[1].1 - a[0].1) * degree);
        step(&mut a, 1);
        let (x, w) = a[0];
        let c = x / w;
        let c1 = (x1 - c * w1) / w;
        (c1, (x2 - c1 * (2.0 * w1) - c * w2) / w)
    }
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
