//! Real roots in [0, 1] of a polynomial in Bernstein form.
//!
//! Descartes' rule holds for Bernstein coefficients: no change of sign means no root inside, one means
//! exactly one, which a bracketing iteration finds; otherwise the interval is halved (Collins & Loos
//! 1976; Lane & Riesenfeld 1981). Multiple roots end in an interval on which all coefficients vanish to
//! rounding, and are reported once. Invariant: results are sorted and lie in [0, 1].

/// Coefficients below this fraction of the largest count as zero.
const ROUNDING: f64 = 1e-15;
/// Roots nearer to each other than this are one.
const SAME: f64 = 1e-10;
/// Halvings before an interval with several roots is taken for one multiple root.
const DEPTH: u32 = 36;

/// Appends the roots in [0, 1] of the polynomial with Bernstein coefficients `c` to `roots`,
/// in order, multiple ones once. The zero polynomial has none.
pub fn append(c: &[f64], roots: &mut Vec<f64>) {
    let scale = c.iter().fold(0.0f64, |m, x| m.max(x.abs()));
    if c.len() < 2
        || scale == 0.0
        || !scale.is_finite()
        || (changes(c, 0.0) == 0 && c[0] != 0.0 && c[c.len() - 1] != 0.0)
    {
        return;
    }
    let zero = scale * ROUNDING;
    let before = roots.len();
    if c[0].abs() <= zero {
        roots.push(0.0);
    }
    if c.len() <= 3 {
        quadratic(c, roots);
    } else {
        isolate(c, 0.0, 1.0, zero, DEPTH, roots);
    }
    if c[c.len() - 1].abs() <= zero {
        roots.push(1.0);
    }
    roots[before..].sort_unstable_by(f64::total_cmp);
    let mut kept = before;
    for i in before..roots.len() {
        if kept == before || roots[i] - roots[kept - 1] > SAME {
            roots[kept] = roots[i];
            kept += 1;
        }
    }
    roots.truncate(kept);
}

/// All roots in [0, 1]; see [`append`].
pub fn in_unit_interval(c: &[f64]) -> Vec<f64> {
    let mut roots = Vec::new();
    append(c, &mut roots);
    roots
}

/// Changes of sign, coefficients of size `zero` or less left out.
fn changes(c: &[f64], zero: f64) -> usize {
    let (mut count, mut last) = (0, 0.0);
    for x in c.iter().filter(|x| x.abs() > zero) {
        count += usize::from(x * last < 0.0);
        last = x.signum();
    }
    count
}

/// Degrees 1 and 2 in closed form, roots inside (0, 1) only.
fn quadratic(c: &[f64], roots: &mut Vec<f64>) {
    let mut inside = |t: f64| {
        if t > 0.0 && t < 1.0 {
            roots.push(t);
        }
    };
    let (c0, c1) = (c[0], c[1]);
    let [_, _, c2] = *c else {
        inside(c0 / (c0 - c1));
        return;
    };
    // c0 s^2 + 2 c1 s t + c2 t^2 = 0 in r = t / (s + t); solved for the ratio, either way round.
    let discriminant = c1 * c1 - c0 * c2;
    if discriminant < 0.0 {
        if -discriminant <= 1e-14 * (c1 * c1) {
            inside(ratio(-c1, c2));
        }
        return;
    }
    let q = -(c1 + c1.signum() * discriminant.sqrt());
    // t / s = q / c2 and c0 / q.
    inside(ratio(q, c2));
    inside(ratio(c0, q));
}

/// The parameter t with `t / (1 - t) = a / b`.
fn ratio(a: f64, b: f64) -> f64 {
    a / (a + b)
}

fn isolate(c: &[f64], start: f64, end: f64, zero: f64, depth: u32, roots: &mut Vec<f64>) {
    match changes(c, zero) {
        0 => {
            if c.iter().all(|x| x.abs() <= zero) {
                roots.push(0.5 * (start + end));
            }
        }
        1 => roots.push(start + (end - start) * single(c, zero)),
        _ if depth == 0 => roots.push(0.5 * (start + end)),
        _ => {
            let mut right = c.to_vec();
            let left = halve(&mut right);
            let middle = 0.5 * (start + end);
            isolate(&left, start, middle, zero, depth - 1, roots);
            if right[0].abs() <= zero {
                roots.push(middle);
            }
            isolate(&right, middle, end, zero, depth - 1, roots);
        }
    }
}

/// Turns `c` into the coefficients of its right half; the result is the left half.
fn halve(c: &mut [f64]) -> Vec<f64> {
    let n = c.len();
    let mut left = Vec::with_capacity(n);
    for k in 1..=n {
        left.push(c[0]);
        for i in 0..n - k {
            c[i] = 0.5 * (c[i] + c[i + 1]);
        }
    }
    left
}

/// Value at `t` (Horner's scheme in Bernstein form).
pub fn value(c: &[f64], t: f64) -> f64 {
    let (s, n) = (1.0 - t, c.len() - 1);
    let (mut power, mut binomial, mut sum) = (1.0, 1.0, c[0]);
    for (i, x) in c.iter().enumerate().skip(1) {
        power *= t;
        binomial *= (n - i + 1) as f64 / i as f64;
        sum = sum * s + binomial * power * x;
    }
    sum
}

/// The only root of a polynomial with one change of sign, coefficients of size `zero` or less left out: Illinois steps with
/// a bisection guard.
fn single(c: &[f64], zero: f64) -> f64 {
    let (mut a, mut b) = (0.0, 1.0);
    let first = c.iter().find(|x| x.abs() > zero).copied().unwrap_or(0.0);
    let (mut fa, mut fb) = (c[0], c[c.len() - 1]);
    if fa.abs() <= zero || fb.abs() <= zero {
        // An end that is zero but for rounding hides the sign on its side: step in from it.
        return bisect(c, first.signum());
    }
    for step in 0..100 {
        let t = if step % 3 == 2 { 0.5 * (a + b) } else { (a * fb - b * fa) / (fb - fa) };
        let t = if t > a && t < b { t } else { 0.5 * (a + b) };
        let f = value(c, t);
        if f == 0.0 || b - a < 4.0 * f64::EPSILON {
            return t;
        }
        if f * fa < 0.0 {
            (b, fb) = (t, f);
            fa *= 0.5;
        } else {
            (a, fa) = (t, f);
            fb *= 0.5;
        }
    }
    0.5 * (a + b)
}

fn bisect(c: &[f64], sign: f64) -> f64 {
    let (mut a, mut b) = (0.0, 1.0);
    for _ in 0..60 {
        let t = 0.5 * (a + b);
        if value(c, t) * sign > 0.0 { a = t } else { b = t }
    }
    0.5 * (a + b)
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    /// Bernstein coefficients of the product of (t - r) over `roots`.
    fn from_roots(roots: &[f64]) -> Vec<f64> {
        let mut c = vec![1.0];
        for r in roots {
            let n = c.len();
            c = (0..=n)
                .map(|i| {
                    let a = if i < n { -r * c[i] * (n - i) as f64 } else { 0.0 };
                    let b = if i > 0 { (1.0 - r) * c[i - 1] * i as f64 } else { 0.0 };
                    (a + b) / n as f64
                })
                .collect();
        }
        c
    }

    #[test]
    fn double_roots_and_roots_at_the_ends_are_found_once() {
        for (roots, expected) in [
            (vec![0.3, 0.3], vec![0.3]),
            (vec![0.25, 0.25, 0.7], vec![0.25, 0.7]),
            (vec![0.0, 0.5, 1.0], vec![0.0, 0.5, 1.0]),
            (vec![0.5, 0.5, 0.5, 2.0, -3.0], vec![0.5]),
            (vec![1.5, 2.0], vec![]),
        ] {
            let found = in_unit_interval(&from_roots(&roots));
            assert_eq!(found.len(), expected.len(), "{roots:?}: {found:?}");
            for (a, b) in found.iter().zip(&expected) {
                assert!((a - b).abs() < 1e-5, "{roots:?}: {found:?}");
            }
        }
        assert!(in_unit_interval(&[0.0, 0.0, 0.0]).is_empty());
    }

    #[test]
    fn ends_that_are_zero_but_for_rounding_hide_no_root() {
        // The way across of a whole circle in one piece, from its own side: it turns at both ends, in the middle, and back.
        let across = [2.2, 4.3, 5.9, 6.1, 4.6, 1.7];
        for noise in [0.0, 1e-15, -1e-15] {
            let back = across.iter().rev().map(|x| -x);
            let c: Vec<f64> = [noise].into_iter().chain(across).chain(back).chain([noise]).collect();
            let found = in_unit_interval(&c);
            let inner: Vec<f64> = found.into_iter().filter(|t| *t > 1e-6 && *t < 1.0 - 1e-6).collect();
            assert_eq!(inner.len(), 1, "{noise}: {inner:?}");
            assert!((inner[0] - 0.5).abs() < 1e-12, "{inner:?}");
        }
    }

    proptest! {
        #[test]
        fn simple_roots_of_any_degree_are_found(steps in prop::collection::vec(0.05f64..0.5, 1..9)) {
            let mut roots: Vec<f64> = Vec::new();
            for step in steps {
                roots.push(roots.last().map_or(0.02, |r: &f64| *r) + step);
            }
            let expected: Vec<f64> = roots.iter().copied().filter(|r| *r < 1.0).collect();
            prop_assume!(roots.iter().all(|r| (r - 1.0).abs() > 1e-3));
            let found = in_unit_interval(&from_roots(&roots));
            prop_assert_eq!(found.len(), expected.len());
            for (a, b) in found.iter().zip(&expected) {
                prop_assert!((a - b).abs() < 1e-7);
            }
        }
    }
}
