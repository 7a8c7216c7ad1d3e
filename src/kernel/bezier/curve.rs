//! Rational Bezier curves over the parameter interval `[0, 1]`.
//!
//! Evaluation works on stack arrays sized by degree class, without allocation.

use glam::{DVec2, DVec3};

use super::bernstein::{self, MAX_COUNT};
use crate::kernel::vector::Vector;

/// A rational Bezier curve; degree = `points.len() - 1`; points not premultiplied; weights positive.
#[derive(Debug, Clone, PartialEq)]
pub struct BezierCurve<V> {
    /// Control points.
    pub points: Vec<V>,
    /// Weights, as many as points.
    pub weights: Vec<f64>,
}

/// A Bezier curve in a uv plane.
pub type BezierCurve2 = BezierCurve<DVec2>;
/// A Bezier curve in model space.
pub type BezierCurve3 = BezierCurve<DVec3>;

/// Position and derivatives of a curve at one parameter.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct CurveJet<V> {
    /// Position.
    pub point: V,
    /// First derivative.
    pub d1: V,
    /// Second derivative.
    pub d2: V,
}

impl<V: Vector> BezierCurve<V> {
    /// A polynomial curve (all weights 1).
    pub fn polynomial(points: Vec<V>) -> Self {
        let weights = vec![1.0; points.len()];
        Self { points, weights }
    }

    /// Polynomial degree.
    pub fn degree(&self) -> usize {
        self.points.len() - 1
    }

    /// Whether the weights differ.
    pub fn is_rational(&self) -> bool {
        self.weights.iter().any(|w| *w != self.weights[0])
    }

    /// First control point, where the curve starts.
    pub fn start(&self) -> V {
        self.points[0]
    }

    /// Last control point, where the curve ends.
    pub fn end(&self) -> V {
        self.points[self.points.len() - 1]
    }

    /// Point at `t`.
    pub fn point(&self, t: f64) -> V {
        match self.points.len() {
            0..=4 => self.point_sized::<4>(t),
            5..=8 => self.point_sized::<8>(t),
            9..=20 => self.point_sized::<20>(t),
            _ => self.point_sized::<MAX_COUNT>(t),
        }
    }

    /// Point and first two derivatives at `t`.
    pub fn jet(&self, t: f64) -> CurveJet<V> {
        match self.points.len() {
            0..=4 => self.jet_sized::<4>(t),
            5..=8 => self.jet_sized::<8>(t),
            9..=20 => self.jet_sized::<20>(t),
            _ => self.jet_sized::<MAX_COUNT>(t),
        }
    }

    /// Point and first derivative at `t`.
    pub fn tangent(&self, t: f64) -> (V, V) {
        match self.points.len() {
            0..=4 => self.tangent_sized::<4>(t),
            5..=8 => self.tangent_sized::<8>(t),
            9..=20 => self.tangent_sized::<20>(t),
            _ => self.tangent_sized::<MAX_COUNT>(t),
        }
    }

    fn tangent_sized<const N: usize>(&self, t: f64) -> (V, V) {
        let b = bernstein::tangent::<N>(self.degree(), t);
        let mut h = [(V::ZERO, 0.0); 2];
        for (i, (p, w)) in self.points.iter().zip(&self.weights).enumerate() {
            for (sum, b) in h.iter_mut().zip(&b) {
                let factor = w * b[i];
                *sum = (sum.0 + *p * factor, sum.1 + factor);
            }
        }
        let w = 1.0 / h[0].1;
        let point = h[0].0 * w;
        (point, (h[1].0 - point * h[1].1) * w)
    }

    fn point_sized<const N: usize>(&self, t: f64) -> V {
        let mut b = [0.0; N];
        bernstein::values(self.degree(), t, &mut b);
        let (mut sum, mut weight) = (V::ZERO, 0.0);
        for ((p, w), b) in self.points.iter().zip(&self.weights).zip(b) {
            sum = sum + *p * (w * b);
            weight += w * b;
        }
        sum * (1.0 / weight)
    }

    fn jet_sized<const N: usize>(&self, t: f64) -> CurveJet<V> {
        let b = bernstein::jet::<N>(self.degree(), t);
        let mut h = [(V::ZERO, 0.0); 3];
        for (i, (p, w)) in self.points.iter().zip(&self.weights).enumerate() {
            for (sum, b) in h.iter_mut().zip(&b) {
                let factor = w * b[i];
                *sum = (sum.0 + *p * factor, sum.1 + factor);
            }
        }
        let w = 1.0 / h[0].1;
        let point = h[0].0 * w;
        let d1 = (h[1].0 - point * h[1].1) * w;
        let d2 = (h[2].0 - d1 * (2.0 * h[1].1) - point * h[2].1) * w;
        CurveJet { point, d1, d2 }
    }

    /// Smallest and largest coordinates of the control points, which hold the curve.
    pub fn hull(&self) -> (V, V) {
        let first = self.points[0];
        self.points.iter().fold((first, first), |(low, high), p| (low.min(*p), high.max(*p)))
    }

    /// The same curve run through backwards.
    pub fn reversed(&self) -> Self {
        Self {
            points: self.points.iter().rev().copied().collect(),
            weights: self.weights.iter().rev().copied().collect(),
        }
    }

    /// The curve with `map` applied to each control point. Exact when `map` is affine.
    pub fn map_points<W: Vector>(&self, map: impl Fn(V) -> W) -> BezierCurve<W> {
        BezierCurve { points: self.points.iter().map(|p| map(*p)).collect(), weights: self.weights.clone() }
    }

    /// Whether all control points, and so the curve, lie within `tolerance` of the segment between the
    /// ends. The curve then covers that segment, whatever its degree and weights.
    pub fn is_straight(&self, tolerance: f64) -> bool {
        let (start, chord) = (self.start(), self.end() - self.start());
        let squared = chord.dot(chord);
        self.points.iter().all(|p| {
            let offset = *p - start;
            let along = if squared > 0.0 { (offset.dot(chord) / squared).clamp(0.0, 1.0) } else { 0.0 };
            (offset - chord * along).length() <= tolerance
        })
    }

    /// The curve with its degree raised by `times`; the same points at the same parameters
    /// (Farin, section 6.1, on homogeneous points).
    pub fn elevated(&self, times: usize) -> Self {
        let rational = self.is_rational();
        let mut result = self.clone();
        for _ in 0..times {
            let n = result.degree() + 1;
            let (mut points, mut weights) = (Vec::with_capacity(n + 1), Vec::with_capacity(n + 1));
            for i in 0..=n {
                let alpha = i as f64 / n as f64;
                let (a, b) = (i.saturating_sub(1), i.min(n - 1));
                let (wa, wb) = (result.weights[a] * alpha, result.weights[b] * (1.0 - alpha));
                let weight = if rational { wa + wb } else { result.weights[0] };
                points.push((result.points[a] * wa + result.points[b] * wb) * (1.0 / weight));
                weights.push(weight);
            }
            result = Self { points, weights };
        }
        result
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_quarter_circle_has_radius_one_and_turns_evenly() {
        let arc = BezierCurve2 {
            points: vec![DVec2::X, DVec2::ONE, DVec2::Y],
            weights: vec![1.0, 0.5f64.sqrt(), 1.0],
        };
        for k in 0..=20 {
            let jet = arc.jet(k as f64 / 20.0);
            assert!((jet.point.length() - 1.0).abs() < 1e-15);
            assert!(jet.point.dot(jet.d1).abs() < 1e-15);
            // |x| = 1 twice differentiated: x . x'' + x' . x' = 0.
            assert!((jet.point.dot(jet.d2) + jet.d1.dot(jet.d1)).abs() < 1e-14);
            assert!((arc.elevated(5).point(k as f64 / 20.0) - jet.point).length() < 1e-15);
        }
    }

    #[test]
    fn straight_means_within_tolerance_of_the_segment_itself() {
        let points = |y: f64| (0..6).map(|k| DVec2::new(k as f64, if k == 3 { y } else { 0.0 })).collect();
        assert!(BezierCurve2::polynomial(points(1e-9)).is_straight(2e-9));
        assert!(!BezierCurve2::polynomial(points(1e-3)).is_straight(2e-9));
        // On the line but running past the ends.
        let past = vec![DVec2::ZERO, DVec2::new(3.0, 0.0), DVec2::X];
        assert!(!BezierCurve2::polynomial(past).is_straight(1e-9));
    }
}
