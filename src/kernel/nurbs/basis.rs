//! B-spline basis functions and their derivatives at one parameter.
//!
//! The usual orders and degrees are worked out on the stack: evaluation is the innermost loop of the
//! reader, and three allocations a point were most of its cost. All sizes run the same operations in
//! the same order, so results do not depend on which one is taken.
//!
//! Source: Piegl & Tiller, "The NURBS Book", algorithm A2.3.

use std::ops::{Index, IndexMut};

use super::KnotVector;

/// Basis functions at one parameter: `basis[k][j]` is the `k`-th derivative of `N_{span - degree + j}`.
#[derive(Debug, Clone)]
pub struct Basis {
    rows: Rows,
    count: usize,
}

/// Derivatives 0 to 2 of degrees up to 3 and up to 7 on the stack, anything else on the heap.
#[derive(Debug, Clone)]
enum Rows {
    Low([[f64; 4]; 3]),
    Middle([[f64; 8]; 3]),
    Any(Vec<Vec<f64>>),
}

impl Index<usize> for Basis {
    type Output = [f64];

    fn index(&self, derivative: usize) -> &[f64] {
        match &self.rows {
            Rows::Low(rows) => &rows[derivative][..self.count],
            Rows::Middle(rows) => &rows[derivative][..self.count],
            Rows::Any(rows) => &rows[derivative],
        }
    }
}

impl KnotVector {
    /// The `degree + 1` basis functions and their first `derivatives` derivatives at `t` in span `span`.
    pub fn basis(&self, span: usize, t: f64, derivatives: usize) -> Basis {
        let count = self.degree() + 1;
        let rows = match (derivatives, count) {
            (0..=2, 0..=4) => {
                let mut rows = [[0.0; 4]; 3];
                let (ndu, sides, a) = (&mut [[0.0; 4]; 4], &mut [[0.0; 4]; 2], &mut [[0.0; 4]; 2]);
                self.fill(span, t, derivatives, &mut rows, (ndu, sides, a));
                Rows::Low(rows)
            }
            (0..=2, 0..=8) => {
                let mut rows = [[0.0; 8]; 3];
                let (ndu, sides, a) = (&mut [[0.0; 8]; 8], &mut [[0.0; 8]; 2], &mut [[0.0; 8]; 2]);
                self.fill(span, t, derivatives, &mut rows, (ndu, sides, a));
                Rows::Middle(rows)
            }
            _ => {
                let zeros = |n: usize| vec![vec![0.0; count]; n];
                let mut rows = zeros(derivatives + 1);
                self.fill(
                    span,
                    t,
                    derivatives,
                    &mut rows,
                    (&mut zeros(count)[..], &mut zeros(2)[..], &mut zeros(2)[..]),
                );
                Rows::Any(rows)
            }
        };
        Basis { rows, count }
    }

    /// Algorithm A2.3 on zeroed rows of at least `degree + 1` numbers: `ders` takes the result; the
    /// others are room to work in (triangle of basis functions and knot differences, left and right
    /// differences, coefficients).
    fn fill<R: IndexMut<usize, Output = f64>>(
        &self,
        span: usize,
        t: f64,
        derivatives: usize,
        ders: &mut [R],
        (ndu, sides, a): (&mut [R], &mut [R], &mut [R]),
    ) {
        let (p, u) = (self.degree(), self.as_slice());
        ndu[0][0] = 1.0;
        for j in 1..=p {
            sides[0][j] = t - u[span + 1 - j];
            sides[1][j] = u[span + j] - t;
            let mut saved = 0.0;
            for r in 0..j {
                ndu[j][r] = sides[1][r + 1] + sides[0][j - r];
                let temp = ndu[r][j - 1] / ndu[j][r];
                ndu[r][j] = saved + sides[1][r + 1] * temp;
                saved = sides[0][j - r] * temp;
            }
            ndu[j][j] = saved;
        }
        for j in 0..=p {
            ders[0][j] = ndu[j][p];
        }
        if derivatives == 0 {
            return;
        }
        for r in 0..=p {
            let (mut s1, mut s2) = (0, 1);
            a[0][0] = 1.0;
            for k in 1..=derivatives.min(p) {
                let mut d = 0.0;
                let (pk, rk) = (p - k, r as isize - k as isize);
                if r >= k {
                    a[s2][0] = a[s1][0] / ndu[pk + 1][r - k];
                    d = a[s2][0] * ndu[r - k][pk];
                }
                let j1 = if rk >= -1 { 1 } else { (-rk) as usize };
                let j2 = if r as isize - 1 <= pk as isize { k - 1 } else { p - r };
                for j in j1..=j2 {
                    let column = (rk + j as isize) as usize;
                    a[s2][j] = (a[s1][j] - a[s1][j - 1]) / ndu[pk + 1][column];
                    d += a[s2][j] * ndu[column][pk];
                }
                if r <= pk {
                    a[s2][k] = -a[s1][k - 1] / ndu[pk + 1][r];
                    d += a[s2][k] * ndu[r][pk];
                }
                ders[k][r] = d;
                std::mem::swap(&mut s1, &mut s2);
            }
        }
        let mut factor = p as f64;
        for (k, row) in ders.iter_mut().enumerate().take(derivatives + 1).skip(1) {
            for j in 0..=p {
                row[j] *= factor;
            }
            factor *= p.saturating_sub(k) as f64;
        }
    }
}

impl KnotVector {
    /// The `degree + 1` basis functions at `t` in span `span` and their first derivatives: the same as
    /// [`Self::basis`] up to rounding, quicker and on the stack. `N` must exceed the degree.
    pub fn basis_and_slopes<const N: usize>(&self, span: usize, t: f64) -> [[f64; N]; 2] {
        let (p, u) = (self.degree(), self.as_slice());
        let [mut values, mut slopes, mut left, mut right] = [[0.0; N]; 4];
        values[0] = 1.0;
        for j in 1..=p {
            left[j] = t - u[span + 1 - j];
            right[j] = u[span + j] - t;
            let mut saved = 0.0;
            for r in 0..j {
                // In the last round the quotients are also what derivatives are differences of.
                let quotient = values[r] / (right[r + 1] + left[j - r]);
                slopes[r] = quotient;
                values[r] = saved + right[r + 1] * quotient;
                saved = left[j - r] * quotient;
            }
            values[j] = saved;
        }
        let mut before = 0.0;
        for slope in &mut slopes[..=p] {
            let quotient = *slope;
            *slope = p as f64 * (before - quotient);
            before = quotient;
        }
        [values, slopes]
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn all_sizes_agree_bit_for_bit() {
        for degree in 1..=9 {
            let inner = [0.2, 0.5, 0.5, 0.9];
            let knots = std::iter::repeat_n(0.0, degree + 1)
                .chain(inner)
                .chain(std::iter::repeat_n(1.0, degree + 1))
                .collect();
            let knots = KnotVector::new(degree, knots).unwrap();
            for k in 0..=20 {
                let t = f64::from(k) / 20.0;
                let span = knots.span(t);
                let (short, long) = (knots.basis(span, t, 2), knots.basis(span, t, 3));
                for order in 0..=2 {
                    assert_eq!(&short[order], &long[order], "degree {degree} at {t}");
                }
                assert_eq!(&knots.basis(span, t, 0)[0], &long[0]);
                let quick = knots.basis_and_slopes::<10>(span, t);
                for j in 0..=degree {
                    assert_eq!(quick[0][j], long[0][j]);
                    assert!((quick[1][j] - long[1][j]).abs() < 1e-12, "degree {degree} at {t}");
                }
                assert!((long[0].iter().sum::<f64>() - 1.0).abs() < 1e-14);
                assert!(long[1].iter().sum::<f64>().abs() < 1e-11);
            }
        }
    }
}
