//! Fewer control points: knot removal, degree reduction, and joining two curves into one.
//!
//! Removing is the least-squares inverse of the exact maps that insert knots and raise degrees: among all
//! splines over the coarse knots the one whose refinement is nearest to the given control points (Lyche &
//! Morken 1987), in homogeneous coordinates. Points that refinement copies are kept bit for bit, so a knot's
//! removal stays local and the ends stay put. The deviation returned is a bound from control points, not a
//! sample: two splines over the same knots are nowhere further apart than their control points.

use super::spline_map::SplineMap;
use super::{KnotError, KnotVector, NurbsCurve, NurbsError};
use crate::kernel::vector::Vector;

/// A simpler curve and how far it may be from the given one.
#[derive(Debug, Clone, PartialEq)]
pub struct Coarse<V> {
    /// The curve.
    pub curve: NurbsCurve<V>,
    /// Bound on the distance of points of equal parameter.
    pub deviation: f64,
}

impl<V: Vector> NurbsCurve<V> {
    /// The curve with one repeat of the inner knot nearest to `t` removed; `None` when there is no inner
    /// knot or weights would not stay positive.
    ///
    /// # Errors
    /// When the coarser knots are no knot vector.
    pub fn knot_removed(&self, t: f64) -> Result<Option<Coarse<V>>, NurbsError> {
        let clamped = self.clamped();
        let (start, end) = clamped.domain();
        let inner = clamped.knots().as_slice().iter().filter(|k| **k > start && **k < end);
        let Some(knot) = inner.copied().min_by(|a, b| (a - t).abs().total_cmp(&(b - t).abs())) else {
            return Ok(None);
        };
        let mut knots = clamped.knots().as_slice().to_vec();
        let at = knots.partition_point(|k| *k < knot);
        knots.remove(at);
        let build = || -> Result<_, KnotError> {
            let coarse = KnotVector::new(self.degree(), knots)?;
            let (_, map) = coarse.insertion(&[knot])?;
            Ok((coarse, map))
        };
        let (coarse, map) = build().map_err(|source| NurbsError::Knots { direction: "t", source })?;
        clamped.coarsened(coarse, &map)
    }

    /// The curve with its degree lowered by one; `None` at degree 1 or when weights would not stay
    /// positive.
    ///
    /// # Errors
    /// When the coarser knots are no knot vector.
    pub fn degree_reduced(&self) -> Result<Option<Coarse<V>>, NurbsError> {
        let degree = self.degree();
        if degree < 2 {
            return Ok(None);
        }
        // One repeat less of every knot; where the curve has a simple knot it gains one instead, so that
        // raising the degree again gives a basis that holds the curve.
        let clamped = self.clamped();
        let mut coarse = Vec::new();
        let knots = clamped.knots().as_slice();
        let mut raised = Vec::new();
        for (i, k) in knots.iter().enumerate() {
            let repeats = clamped.knots().multiplicity(*k);
            if i > 0 && knots[i - 1] == *k {
                continue;
            }
            let fewer = (repeats - 1).max(1).min(degree);
            coarse.extend(std::iter::repeat_n(*k, fewer));
            raised.extend(std::iter::repeat_n(*k, (fewer + 1).saturating_sub(repeats)));
        }
        let fine = clamped.inserted(&raised)?;
        let build = || -> Result<_, KnotError> {
            let coarse = KnotVector::new(degree - 1, coarse)?;
            let (_, map) = coarse.elevation(1)?;
            Ok((coarse, map))
        };
        let (coarse, map) = build().map_err(|source| NurbsError::Knots { direction: "t", source })?;
        fine.coarsened(coarse, &map)
    }

    /// This curve and then `next`, as one: exact, with a knot of full multiplicity where they meet. `next` is
    /// moved in its parameter to begin where this one ends, and run at this one's speed there. Its first
    /// control point gives way to this one's last.
    ///
    /// # Errors
    /// When the parameters overflow.
    pub fn joined(&self, next: &Self) -> Result<Self, NurbsError> {
        let degree = self.degree().max(next.degree());
        let raise = |curve: &Self| match degree - curve.degree() {
            0 => Ok(curve.clamped()),
            times => curve.elevated(times),
        };
        let (a, b) = (raise(self)?, raise(next)?);
        let (end, start) = (a.domain().1, b.domain().0);
        let speed = |curve: &Self, t: f64| curve.derivatives(t, 1)[1].length();
        let ratio = speed(&b, start) / speed(&a, end);
        // The second half of a split curve keeps its parameters to the bit.
        let same = end == start && (ratio - 1.0).abs() < 1e-9;
        let ratio = if same || !(ratio.is_finite() && ratio > 1e-6 && ratio < 1e6) { 1.0 } else { ratio };
        let mut knots = a.knots().as_slice().to_vec();
        knots.pop();
        let moved = |k: f64| if same { k } else { end + (k - start) * ratio };
        knots.extend(b.knots().as_slice()[degree + 1..].iter().map(|k| moved(*k)));
        let mut points = a.points().to_vec();
        let mut weights = a.weights().to_vec();
        let factor = weights[weights.len() - 1] / b.weights()[0];
        points.extend(&b.points()[1..]);
        weights.extend(b.weights()[1..].iter().map(|w| if factor == 1.0 { *w } else { w * factor }));
        let knots =
            KnotVector::new(degree, knots).map_err(|source| NurbsError::Knots { direction: "t", source })?;
        Self::new(knots, points, weights)
    }

    /// The curve over the knots `coarse` nearest to this one; `map` refines `coarse` to this curve's knots.
    fn coarsened(&self, coarse: KnotVector, map: &SplineMap) -> Result<Option<Coarse<V>>, NurbsError> {
        let rational = self.is_rational();
        let (points, weights) = (self.points(), self.weights());
        debug_assert_eq!(map.rows.len(), points.len());
        let count = coarse.control_count();
        let centre = points[0];
        let weight = |i: usize| if rational { weights[i] } else { 1.0 };
        // Homogeneous, relative to the first point, with the weight as one more coordinate.
        let given = |i: usize, axis: usize| {
            if axis == V::DIMENSION { weight(i) } else { (points[i] - centre).coordinate(axis) * weight(i) }
        };
        let mut kept: Vec<Option<usize>> = vec![None; count];
        for (i, row) in map.rows.iter().enumerate() {
            if row.weights.len() == 1 && kept[row.first].is_none() {
                kept[row.first] = Some(i);
            }
        }
        let axes = V::DIMENSION + usize::from(rational);
        let solved: Option<Vec<Vec<f64>>> =
            (0..axes).map(|axis| least_squares(map, &kept, |i| given(i, axis))).collect();
        let Some(solved) = solved else { return Ok(None) };
        let mut new_points = Vec::with_capacity(count);
        let mut new_weights = Vec::with_capacity(count);
        for j in 0..count {
            if let Some(i) = kept[j] {
                new_points.push(points[i]);
                new_weights.push(weights[i]);
                continue;
            }
            let w = if rational { solved[V::DIMENSION][j] } else { 1.0 };
            if !(w > 0.0) {
                return Ok(None);
            }
            let offset = (0..V::DIMENSION).fold(V::ZERO, |p, axis| p + V::unit(axis) * (solved[axis][j] / w));
            new_points.push(centre + offset);
            new_weights.push(if rational { w } else { weights[0] });
        }
        let curve = Self::new(coarse, new_points, new_weights)?;
        let (back, back_weights) = map.apply(curve.points(), curve.weights(), rational);
        // |C - C'| <= max |(a_i - a'_i) - (w_i - w'_i) C'| / min w_i, with C' in the hull of the points.
        let radius = back.iter().map(|p| (*p - centre).length()).fold(0.0, f64::max);
        let least = if rational { weights.iter().copied().fold(f64::INFINITY, f64::min) } else { 1.0 };
        let deviation = (0..points.len()).map(|i| {
            if !rational {
                return (points[i] - back[i]).length();
            }
            let numerator = (points[i] - centre) * weights[i] - (back[i] - centre) * back_weights[i];
            (numerator.length() + (weights[i] - back_weights[i]).abs() * radius) / least
        });
        let deviation = deviation.fold(0.0, f64::max);
        Ok(Some(Coarse { curve, deviation }))
    }
}

/// Coordinates of the coarse points that minimise `sum (row . x - given(i))^2`; those in `kept` are given. By
/// normal equations in banded form: the rows are well conditioned convex combinations.
fn least_squares(map: &SplineMap, kept: &[Option<usize>], given: impl Fn(usize) -> f64) -> Option<Vec<f64>> {
    let mut x: Vec<f64> = kept.iter().map(|i| i.map_or(0.0, &given)).collect();
    let unknowns: Vec<usize> = (0..kept.len()).filter(|j| kept[*j].is_none()).collect();
    let number: Vec<Option<usize>> = {
        let mut number = vec![None; kept.len()];
        unknowns.iter().enumerate().for_each(|(k, j)| number[*j] = Some(k));
        number
    };
    let band = map.rows.iter().map(|r| r.weights.len()).max().unwrap_or(1);
    let n = unknowns.len();
    // normal[i][k] is the entry (i, i - k) of the normal matrix.
    let mut normal = vec![vec![0.0; band]; n];
    let mut right = vec![0.0; n];
    for (i, row) in map.rows.iter().enumerate() {
        let mut rest = given(i);
        let mut terms: Vec<(usize, f64)> = Vec::with_capacity(band);
        for (k, w) in row.weights.iter().enumerate() {
            match number[row.first + k] {
                Some(unknown) => terms.push((unknown, *w)),
                None => rest -= w * x[row.first + k],
            }
        }
        for (a, wa) in &terms {
            right[*a] += wa * rest;
            for (b, wb) in terms.iter().filter(|(b, _)| b <= a) {
                normal[*a][a - b] += wa * wb;
            }
        }
    }
    // Cholesky: L L^T, row by row, inside the band.
    for i in 0..n {
        for k in (0..band.min(i + 1)).rev() {
            let j = i - k;
            let mut sum = normal[i][k];
            for m in 1..band {
                if m + k < band && m <= j {
                    sum -= normal[i][k + m] * normal[j][m];
                }
            }
            if k > 0 {
                normal[i][k] = sum / normal[j][0];
            } else if sum > 0.0 {
                normal[i][0] = sum.sqrt();
            } else {
                return None;
            }
        }
    }
    for i in 0..n {
        let sum: f64 = (1..band.min(i + 1)).map(|k| normal[i][k] * right[i - k]).sum();
        right[i] = (right[i] - sum) / normal[i][0];
    }
    for i in (0..n).rev() {
        let sum: f64 = (1..band).filter(|k| i + k < n).map(|k| normal[i + k][k] * right[i + k]).sum();
        right[i] = (right[i] - sum) / normal[i][0];
    }
    unknowns.iter().zip(right).for_each(|(j, value)| x[*j] = value);
    Some(x)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::kernel::nurbs::NurbsCurve2;
    use glam::DVec2;

    fn wavy(degree: usize, inner: &[f64], rational: bool) -> NurbsCurve2 {
        let mut knots = vec![0.0; degree + 1];
        knots.extend(inner);
        knots.extend(vec![1.0; degree + 1]);
        let knots = KnotVector::new(degree, knots).expect("sorted");
        let count = knots.control_count();
        let points = (0..count).map(|i| DVec2::new(i as f64, (1.7 * i as f64).sin())).collect();
        let weights = (0..count).map(|i| if rational { 1.0 + 0.4 * (i % 3) as f64 } else { 1.0 }).collect();
        NurbsCurve2::new(knots, points, weights).expect("finite")
    }

    fn off(a: &NurbsCurve2, b: &NurbsCurve2) -> f64 {
        let ((a0, a1), (b0, b1)) = (a.domain(), b.domain());
        let at = |k: usize| k as f64 / 300.0;
        (0..=300)
            .map(|k| a.point(a0 + (a1 - a0) * at(k)).distance(b.point(b0 + (b1 - b0) * at(k))))
            .fold(0.0, f64::max)
    }

    #[test]
    fn removing_what_was_inserted_or_raised_gives_the_curve_back() {
        for rational in [false, true] {
            for degree in [1, 2, 3, 5, 9] {
                let curve = wavy(degree, &[0.2, 0.5, 0.5, 0.9], rational);
                let more = curve.inserted(&[0.35]).expect("inside");
                let less = more.knot_removed(0.35).expect("valid").expect("weights stay positive");
                assert!(less.deviation < 1e-12, "{degree} {}", less.deviation);
                assert_eq!(less.curve.knots(), curve.knots());
                assert!(off(&less.curve, &curve) < 1e-12);
                let higher = curve.elevated(1).expect("degree in range");
                let lower = higher.degree_reduced().expect("valid").expect("weights stay positive");
                assert!(lower.deviation < 1e-10, "{degree} {}", lower.deviation);
                assert_eq!(lower.curve.degree(), degree);
                assert!(off(&lower.curve, &curve) < 1e-10);
            }
        }
    }

    #[test]
    fn the_deviation_bounds_what_removal_does() {
        for rational in [false, true] {
            let curve = wavy(3, &[0.2, 0.5, 0.7], rational);
            for coarse in [curve.knot_removed(0.5), curve.degree_reduced()] {
                let coarse = coarse.expect("valid").expect("positive weights");
                let off = off(&coarse.curve, &curve);
                assert!(off > 1e-3 && off <= coarse.deviation, "{off} {}", coarse.deviation);
                let (a, b) = (curve.points(), coarse.curve.points());
                assert_eq!((a.first(), a.last()), (b.first(), b.last()));
            }
        }
        let line = NurbsCurve2::line(DVec2::ZERO, DVec2::ONE);
        assert_eq!(line.knot_removed(0.5), Ok(None));
        assert_eq!(line.degree_reduced(), Ok(None));
    }

    #[test]
    fn joining_the_parts_of_a_curve_gives_all_of_it() {
        for rational in [false, true] {
            let curve = wavy(3, &[0.2, 0.5, 0.7], rational);
            let (a, b) =
                (curve.restricted(0.0, 0.6).expect("inside"), curve.restricted(0.6, 1.0).expect("inside"));
            let joined = a.joined(&b).expect("valid");
            assert_eq!(joined.knots().multiplicity(0.6), 3);
            assert!(off(&joined, &curve) < 1e-14);
            let mixed = a
                .joined(&NurbsCurve2::line(*a.points().last().expect("points"), DVec2::ZERO))
                .expect("valid");
            assert_eq!(mixed.degree(), 3);
            assert!(mixed.point(mixed.domain().1).length() < 1e-14);
        }
    }
}
