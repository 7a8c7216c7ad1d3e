//! Knot insertion, clamping and restriction, as maps of control points.
//!
//! Insertion follows Boehm (1980), one knot at a time; it also serves unclamped ends. Restriction to an
//! interval goes straight to the new, clamped knots by the Oslo algorithm (Cohen, Lyche & Riesenfeld
//! 1980): row `i` is the blossom at the new knots `i + 1 ..= i + p`, on the span that holds new knot `i`.
//! Both are exact: the spline does not change where it is kept.

use super::spline_map::{Row, SplineMap};
use super::{KnotError, KnotVector};

impl KnotVector {
    /// Whether the end knots are repeated `degree + 1` times, so that splines start and end at control
    /// points.
    pub fn is_clamped(&self) -> bool {
        let (p, knots) = (self.degree(), self.as_slice());
        knots[0] == knots[p] && knots[knots.len() - 1] == knots[knots.len() - p - 1]
    }

    /// These knots with `new` ones (in any order, repeats allowed) put in.
    ///
    /// # Errors
    /// A new knot outside the domain, or one repeated more than `degree + 1` times in all.
    pub(crate) fn insertion(&self, new: &[f64]) -> Result<(Self, SplineMap), KnotError> {
        let p = self.degree();
        let (start, end) = self.domain();
        let mut knots = self.as_slice().to_vec();
        let mut rows = SplineMap::identity(self.control_count()).rows;
        for &t in new {
            if !(t >= start && t <= end) {
                return Err(KnotError::OutsideDomain { value: t, start, end });
            }
            let after = knots.partition_point(|k| *k <= t);
            let multiplicity = after - knots.partition_point(|k| *k < t);
            if multiplicity > p {
                return Err(KnotError::Multiplicity { value: t, most: p + 1 });
            }
            let last = after - 1;
            let mixed: Vec<Row> = (last - p + 1..=last - multiplicity)
                .map(|i| {
                    let alpha = (t - knots[i]) / (knots[i + p] - knots[i]);
                    Row::mix(alpha, &rows[i], &rows[i - 1])
                })
                .collect();
            if multiplicity == p {
                // The curve already passes through a control point here: one end for each side.
                rows.insert(last - p, rows[last - p].clone());
            } else {
                // Rows up to last - p stay; then the mixed ones; then from last - multiplicity on.
                rows.splice(last - p + 1..last - multiplicity, mixed);
            }
            knots.insert(after, t);
        }
        Ok((Self::new(p, knots)?, SplineMap { rows }))
    }

    /// Clamped knots over `[a, b]` that keep every knot between, and the map to their control points.
    ///
    /// # Errors
    /// When `[a, b]` is empty or leaves the domain.
    pub(crate) fn restriction(&self, a: f64, b: f64) -> Result<(Self, SplineMap), KnotError> {
        let p = self.degree();
        let (start, end) = self.domain();
        for value in [a, b] {
            if !(value >= start && value <= end) {
                return Err(KnotError::OutsideDomain { value, start, end });
            }
        }
        if !(a < b) {
            return Err(KnotError::EmptyDomain { start: a, end: b });
        }
        let mut knots = vec![a; p + 1];
        for &k in self.as_slice().iter().filter(|k| **k > a && **k < b) {
            // More than degree + 1 equal knots mean control points without effect.
            if knots[knots.len() - p - 1] != k {
                knots.push(k);
            }
        }
        knots.extend(std::iter::repeat_n(b, p + 1));
        let count = knots.len() - p - 1;
        let rows = (0..count)
            .map(|i| Row::blossom(self, self.span(knots[i]), knots[i + 1..=i + p].iter().copied()))
            .collect();
        Ok((Self::new(p, knots)?, SplineMap { rows }))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn rows_are_convex_combinations() {
        let knots = vec![0.0, 0.5, 1.0, 1.5, 2.0, 2.0, 2.0, 2.0, 2.5, 3.0, 3.0, 4.0, 5.0, 7.0];
        let knots = KnotVector::new(3, knots).expect("sorted");
        let (start, end) = knots.domain();
        let (_, inserted) = knots.insertion(&[start, 1.7, 2.2, 2.2, end, start]).expect("inside");
        let (_, restricted) = knots.restriction(1.6, 2.9).expect("inside");
        for row in inserted.rows.iter().chain(&restricted.rows) {
            assert!(row.weights.iter().all(|w| *w >= 0.0), "{row:?}");
            assert!((row.weights.iter().sum::<f64>() - 1.0).abs() < 1e-15);
        }
    }

    #[test]
    fn knots_outside_or_too_many_are_refused() {
        let knots = KnotVector::bezier(2, 0.0, 1.0).expect("valid");
        assert!(matches!(knots.insertion(&[1.5]), Err(KnotError::OutsideDomain { .. })));
        assert!(matches!(knots.insertion(&[f64::NAN]), Err(KnotError::OutsideDomain { .. })));
        assert!(matches!(knots.insertion(&[0.5; 4]), Err(KnotError::Multiplicity { .. })));
        assert!(knots.insertion(&[0.5; 3]).is_ok());
        assert!(knots.restriction(0.5, 0.5).is_err());
    }
}
