//! Degree elevation, as a map of control points.
//!
//! Control point `i` of the spline of degree `p + 1` over knots `T` (each distinct knot once more) is the
//! mean of the old blossom over the `p + 1` ways to leave out one of `T[i + 1] ..= T[i + p + 1]` (Ramshaw
//! 1989). Each term is a control point of a refinement of the old spline, so the map is a convex
//! combination, and it works across knots of any multiplicity.

use super::spline_map::{Row, SplineMap};
use super::{KnotError, KnotVector};

impl KnotVector {
    /// Clamped knots of degree `degree + times` over the same domain, and the map to their control points.
    ///
    /// # Errors
    /// When the new degree exceeds [`super::knots::MAX_DEGREE`].
    pub(crate) fn elevation(&self, times: usize) -> Result<(Self, SplineMap), KnotError> {
        let (start, end) = self.domain();
        let (mut knots, mut map) = self.restriction(start, end)?;
        for _ in 0..times {
            let (higher, step) = knots.elevated_once()?;
            map = step.after(&map);
            knots = higher;
        }
        Ok((knots, map))
    }

    /// One degree more; `self` is clamped.
    fn elevated_once(&self) -> Result<(Self, SplineMap), KnotError> {
        let p = self.degree();
        let mut knots = Vec::with_capacity(2 * self.as_slice().len());
        for &k in self.as_slice() {
            if knots.last() != Some(&k) {
                knots.push(k);
            }
            knots.push(k);
        }
        let higher = Self::new(p + 1, knots)?;
        let knots = higher.as_slice();
        let rows = (0..higher.control_count()).map(|i| {
            let (span, arguments) = (self.span(knots[i]), &knots[i + 1..=i + p + 1]);
            let mut weights = vec![0.0; p + 1];
            let mut left_out = 0;
            while left_out <= p {
                // Leaving out one of several equal knots gives the same term each time.
                let value = arguments[left_out];
                let repeats = arguments.iter().filter(|k| **k == value).count();
                let kept = (0..=p).filter(|k| *k != left_out).map(|k| arguments[k]);
                let term = Row::blossom(self, span, kept);
                for (k, w) in term.weights.iter().enumerate() {
                    weights[term.first + k + p - span] += w * repeats as f64 / (p + 1) as f64;
                }
                left_out += repeats;
            }
            Row::trimmed(span - p, &weights)
        });
        let rows = rows.collect();
        Ok((higher, SplineMap { rows }))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn rows_are_convex_combinations_at_high_degree() {
        let mut knots = vec![0.0; 10];
        knots.extend([0.3, 0.3, 0.7]);
        knots.extend([0.8; 10]);
        knots.extend([1.0; 10]);
        let knots = KnotVector::new(9, knots).expect("sorted");
        let (higher, map) = knots.elevation(13).expect("degree 22");
        assert_eq!(higher.degree(), 22);
        assert_eq!(map.rows.len(), higher.control_count());
        for row in &map.rows {
            assert!(row.weights.iter().all(|w| *w > -1e-16), "{row:?}");
            assert!((row.weights.iter().sum::<f64>() - 1.0).abs() < 1e-13);
        }
    }
}
