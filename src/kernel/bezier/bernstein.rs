//! Bernstein polynomials on stack arrays.
//!
//! `B(n, i)(t) = C(n, i) t^i (1 - t)^(n - i)` by two passes of running powers: O(n), every value with a
//! relative error of about `2 n` roundings, no cancellation for `t` in `[0, 1]`. Derivatives are
//! differences of the values of lower degree (Farin, "Curves and Surfaces for CAGD", chapter 5).

use crate::kernel::nurbs::knots::MAX_DEGREE;

/// Most control points along one direction.
pub const MAX_COUNT: usize = MAX_DEGREE + 1;

/// `BINOMIAL[n][k]` = n over k, exact up to about n = 57 and within a rounding or two beyond.
static BINOMIAL: [[f64; 2 * MAX_COUNT]; 2 * MAX_COUNT] = binomials();

const fn binomials() -> [[f64; 2 * MAX_COUNT]; 2 * MAX_COUNT] {
    let mut table = [[0.0; 2 * MAX_COUNT]; 2 * MAX_COUNT];
    let mut n = 0;
    while n < 2 * MAX_COUNT {
        table[n][0] = 1.0;
        let mut k = 1;
        while k <= n {
            table[n][k] = table[n - 1][k - 1] + table[n - 1][k];
            k += 1;
        }
        n += 1;
    }
    table
}

/// The binomial coefficients of row `n <= 2 * MAX_DEGREE + 1`.
pub fn binomial_row(n: usize) -> &'static [f64] {
    &BINOMIAL[n][..=n]
}

/// Values of the Bernstein polynomials of `degree` at `t` into `values[..= degree]`.
pub fn values(degree: usize, t: f64, values: &mut [f64]) {
    let row = binomial_row(degree);
    let s = 1.0 - t;
    let mut power = 1.0;
    for i in 0..=degree {
        values[i] = row[i] * power;
        power *= t;
    }
    power = 1.0;
    for i in (0..=degree).rev() {
        values[i] *= power;
        power *= s;
    }
}

/// Values and first derivatives at `t`: `result[k][i]` is the `k`-th derivative of polynomial `i`.
/// `N` must exceed `degree`.
pub fn tangent<const N: usize>(degree: usize, t: f64) -> [[f64; N]; 2] {
    let mut result = [[0.0; N]; 2];
    values(degree, t, &mut result[0]);
    if degree >= 1 {
        let mut lower = [0.0; N];
        values(degree - 1, t, &mut lower);
        for i in 0..=degree {
            let left = if i > 0 { lower[i - 1] } else { 0.0 };
            let right = if i < degree { lower[i] } else { 0.0 };
            result[1][i] = degree as f64 * (left - right);
        }
    }
    result
}

/// Values and first two derivatives at `t`: `result[k][i]` is the `k`-th derivative of polynomial `i`.
/// `N` must exceed `degree`.
pub fn jet<const N: usize>(degree: usize, t: f64) -> [[f64; N]; 3] {
    let [value, first] = tangent(degree, t);
    let mut result = [value, first, [0.0; N]];
    let n = degree as f64;
    if degree >= 2 {
        let mut lower = [0.0; N];
        values(degree - 2, t, &mut lower);
        let factor = n * (n - 1.0);
        for i in 0..=degree {
            let at = |k: usize| if k <= degree - 2 { lower[k] } else { 0.0 };
            let left = if i >= 2 { at(i - 2) } else { 0.0 };
            let middle = if i >= 1 { at(i - 1) } else { 0.0 };
            result[2][i] = factor * (left - 2.0 * middle + at(i));
        }
    }
    result
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn values_sum_to_one_at_all_degrees() {
        for degree in 0..=MAX_DEGREE {
            for t in [0.0, 1e-9, 0.1, 0.5, 0.77, 1.0] {
                let mut b = [0.0; MAX_COUNT];
                values(degree, t, &mut b);
                let sum: f64 = b[..=degree].iter().sum();
                assert!((sum - 1.0).abs() < 1e-13, "degree {degree}, t {t}: {sum}");
            }
        }
    }

    #[test]
    fn derivatives_match_central_differences() {
        for degree in 1..=9 {
            let (t, h) = (0.3, 1e-5);
            let (a, m, b) = (jet::<16>(degree, t - h), jet::<16>(degree, t), jet::<16>(degree, t + h));
            for i in 0..=degree {
                assert!((m[1][i] - (b[0][i] - a[0][i]) / (2.0 * h)).abs() < 1e-7);
                assert!((m[2][i] - (b[1][i] - a[1][i]) / (2.0 * h)).abs() < 1e-6);
            }
        }
    }
}
