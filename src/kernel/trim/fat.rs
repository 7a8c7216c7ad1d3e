//! Fat bounds of a curve: how far a part of it can leave the part's chord.
//!
//! With chord end points A, B at parameters a < b, C - chord = -(integral of a positive kernel times C''),
//! at most (b-a)^2 / 8 in total weight, and B - A = (b-a) times a mean of C'. The cross product is linear in both, so
//! `cross(C - A, B - A) / (b-a)^3` lies between the extremes of `-cross(C''(x), C'(y)) / 8` over all
//! x, y, and 0. For polynomials the control vectors of C'' and C' give rigorous extremes.

use glam::DVec2;

/// Bounds of a record's curve. `words` are its words from 5 on (see the layout), exactly as stored.
pub fn bounds(words: &[f32], degree: usize, rational: bool, ends: [f32; 4]) -> (f64, f64) {
    let d = DVec2::new(f64::from(ends[2] - ends[0]), f64::from(ends[3] - ends[1]));
    let (first, second) =
        if rational { sampled_derivatives(words, degree, d) } else { control_derivatives(words, degree, d) };
    let (mut least, mut most) = (0.0f64, 0.0f64);
    for x in &second {
        for y in &first {
            let k = x.perp_dot(*y);
            least = least.min(k);
            most = most.max(k);
        }
    }
    let margin = if rational { RATIONAL_MARGIN } else { 1.0 };
    (-most / 8.0 * margin, -least / 8.0 * margin)
}

/// What sampling may miss between the samples of a rational curve's derivatives.
const RATIONAL_MARGIN: f64 = 1.1;

/// Control vectors of the first and second derivative of a polynomial.
fn control_derivatives(words: &[f32], degree: usize, d: DVec2) -> (Vec<DVec2>, Vec<DVec2>) {
    let mut points = vec![DVec2::ZERO];
    let mut binomial = 1.0;
    for i in 1..degree {
        binomial *= (degree - i + 1) as f64 / i as f64;
        let q = DVec2::new(f64::from(words[2 * i - 2]), f64::from(words[2 * i - 1]));
        points.push(q / binomial);
    }
    points.push(d);
    let n = degree as f64;
    let first: Vec<DVec2> = points.windows(2).map(|p| (p[1] - p[0]) * n).collect();
    let second = first.windows(2).map(|p| (p[1] - p[0]) * (n - 1.0)).collect();
    (first, second)
}

/// First and second derivatives of a rational curve at evenly spaced parameters.
fn sampled_derivatives(words: &[f32], degree: usize, d: DVec2) -> (Vec<DVec2>, Vec<DVec2>) {
    let mut points = vec![(DVec2::ZERO, 1.0)];
    let mut binomial = 1.0;
    for i in 1..degree {
        binomial *= (degree - i + 1) as f64 / i as f64;
        let at = 3 * (i - 1);
        let q = DVec2::new(f64::from(words[at]), f64::from(words[at + 1]));
        points.push((q / binomial, f64::from(words[at + 2]) / binomial));
    }
    points.push((d, 1.0));
    let samples = 8 + 4 * degree;
    let (mut first, mut second) = (Vec::with_capacity(samples + 1), Vec::with_capacity(samples + 1));
    for k in 0..=samples {
        let (c1, c2) = derivatives(&points, k as f64 / samples as f64);
        first.push(c1);
        second.push(c2);
    }
    (first, second)
}

/// First and second derivative at `t` by de Casteljau's scheme on homogeneous points.
fn derivatives(points: &[(DVec2, f64)], t: f64) -> (DVec2, DVec2) {
    let n = points.len() - 1;
    let mut a = points.to_vec();
    for k in (2..n).rev() {
        for i in 0..=k {
            a[i] = (a[i].0.lerp(a[i + 1].0, t), a[i].1 + (a[i + 1].1 - a[i].1) * t);
        }
    }
    let degree = n as f64;
    let (x2, w2) = (
        (a[2].0 - a[1].0 * 2.0 + a[0].0) * (degree * (degree - 1.0)),
        (a[2].1 - a[1].1 * 2.0 + a[0].1) * (degree * (degree - 1.0)),
    );
    for i in 0..=1 {
        a[i] = (a[i].0.lerp(a[i + 1].0, t), a[i].1 + (a[i + 1].1 - a[i].1) * t);
    }
    let (x1, w1) = ((a[1].0 - a[0].0) * degree, (a[1].1 - a[0].1) * degree);
    let (x, w) = (a[0].0.lerp(a[1].0, t), a[0].1 + (a[1].1 - a[0].1) * t);
    let c = x / w;
    let c1 = (x1 - c * w1) / w;
    (c1, (x2 - c1 * (2.0 * w1) - c * w2) / w)
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
