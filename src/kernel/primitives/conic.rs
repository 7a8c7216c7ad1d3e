//! Arcs of circles, ellipses, hyperbolas and parabolas as rational quadratic splines.
//!
//! Circular arcs are cut into equal spans of less than 150 degrees, each a rational quadratic with
//! weights 1, cos(half span), 1, over knots that are angles. This is the split that OpenCASCADE
//! makes (its `TgtThetaOver2` parametrisation), so parameters agree with it also inside a span, where
//! the parameter is not the angle but follows `tan(angle / 2)`. [`arc_parameter`] converts.

use std::f64::consts::PI;

use glam::DVec3;

use crate::kernel::nurbs::{KnotVector, NurbsCurve3, NurbsError};

/// Number of rational quadratic spans for an arc of `sweep` radians: 3 for a full circle.
pub fn arc_spans(sweep: f64) -> usize {
    (1.2 * sweep.abs().min(100.0) / PI) as usize + 1
}

/// `centre + cos(t) x + sin(t) y` for `t` from `start` to `end` (`start < end`, radians).
///
/// # Errors
/// When the interval is empty or something is not finite.
pub fn arc(centre: DVec3, x: DVec3, y: DVec3, start: f64, end: f64) -> Result<NurbsCurve3, NurbsError> {
    let (knots, nodes) = arc_frame(start, end)?;
    let points = nodes.iter().map(|n| centre + x * n.x + y * n.y).collect();
    NurbsCurve3::new(knots, points, nodes.iter().map(|n| n.weight).collect())
}

/// A control point of the unit arc, with its weight.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ArcNode {
    /// Coefficient of the x axis.
    pub x: f64,
    /// Coefficient of the y axis.
    pub y: f64,
    /// Weight.
    pub weight: f64,
}

/// Knots and control points of the unit arc from `start` to `end`.
///
/// # Errors
/// When the interval is empty or not finite.
pub fn arc_frame(start: f64, end: f64) -> Result<(KnotVector, Vec<ArcNode>), NurbsError> {
    let spans = arc_spans(end - start);
    let half = (end - start) / (2 * spans) as f64;
    let mut knots = vec![start; 3];
    for k in 1..spans {
        knots.extend([start + 2.0 * half * k as f64; 2]);
    }
    knots.extend([end; 3]);
    let knots = KnotVector::new(2, knots).map_err(|source| NurbsError::Knots { direction: "t", source })?;
    let weight = half.cos();
    let node = |k: usize| {
        let (sin, cos) = (start + half * k as f64).sin_cos();
        if k.is_multiple_of(2) {
            ArcNode { x: cos, y: sin, weight: 1.0 }
        } else {
            ArcNode { x: cos / weight, y: sin / weight, weight }
        }
    };
    Ok((knots, (0..=2 * spans).map(node).collect()))
}

/// The spline parameter of the point at `angle` on the arc from `start` to `end`; continues past the
/// ends of the arc by whole arcs where it spans a full turn, else along the end spans.
pub fn arc_parameter(start: f64, end: f64, angle: f64) -> f64 {
    in_span(start, end, angle, |s, half| (0.5 * s * half).tan() / (0.5 * half).tan())
}

/// The angle of the point at spline parameter `t`: the inverse of [`arc_parameter`].
pub fn arc_angle(start: f64, end: f64, t: f64) -> f64 {
    in_span(start, end, t, |s, half| 2.0 * (s * (0.5 * half).tan()).atan() / half)
}

/// Applies `map` (on -1..1, odd, given half the span) within the span that holds `t`.
fn in_span(start: f64, end: f64, t: f64, map: impl Fn(f64, f64) -> f64) -> f64 {
    let spans = arc_spans(end - start) as f64;
    let half = (end - start) / (2.0 * spans);
    // Spans repeat beyond the ends; for a full turn that is the periodic continuation.
    let index = ((t - start) / (2.0 * half)).floor();
    let index = if t == end { spans - 1.0 } else { index };
    let middle = start + half * (2.0 * index + 1.0);
    middle + half * map((t - middle) / half, half)
}

/// `centre + cosh(t) x + sinh(t) y` for `t` from `start` to `end`: one rational quadratic.
///
/// # Errors
/// When the interval is empty or something is not finite.
pub fn hyperbola(centre: DVec3, x: DVec3, y: DVec3, start: f64, end: f64) -> Result<NurbsCurve3, NurbsError> {
    let knots =
        KnotVector::bezier(2, start, end).map_err(|source| NurbsError::Knots { direction: "t", source })?;
    let (middle, half) = (0.5 * (start + end), 0.5 * (end - start));
    let at = |t: f64| centre + x * t.cosh() + y * t.sinh();
    let weight = half.cosh();
    let top = centre + (x * middle.cosh() + y * middle.sinh()) * (1.0 / weight);
    NurbsCurve3::new(knots, vec![at(start), top, at(end)], vec![1.0, weight, 1.0])
}

/// `vertex + t^2 x + t y` for `t` from `start` to `end`: one polynomial quadratic.
///
/// # Errors
/// When the interval is empty or something is not finite.
pub fn parabola(vertex: DVec3, x: DVec3, y: DVec3, start: f64, end: f64) -> Result<NurbsCurve3, NurbsError> {
    let knots =
        KnotVector::bezier(2, start, end).map_err(|source| NurbsError::Knots { direction: "t", source })?;
    let at = |t: f64| vertex + x * (t * t) + y * t;
    let top = vertex + x * (start * end) + y * (0.5 * (start + end));
    NurbsCurve3::new(knots, vec![at(start), top, at(end)], vec![1.0; 3])
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::f64::consts::TAU;

    #[test]
    fn arcs_lie_on_the_ellipse_at_the_converted_parameter() {
        let (centre, x, y) =
            (DVec3::new(1.0, 2.0, 3.0), DVec3::new(2.0, 0.5, 0.0), DVec3::new(0.0, 1.0, 4.0));
        for (start, end) in [(0.0, TAU), (1.5, 1.5 + TAU), (-1.0, 0.2), (3.0, 7.0), (0.0, 2.7)] {
            let curve = arc(centre, x, y, start, end).unwrap();
            for k in 0..=50 {
                let angle = start + (end - start) * f64::from(k) / 50.0;
                let t = arc_parameter(start, end, angle);
                let expected = centre + x * angle.cos() + y * angle.sin();
                assert!((curve.point(t) - expected).length() < 1e-12, "{start} {end} {angle}");
                assert!((arc_angle(start, end, t) - angle).abs() < 1e-12);
            }
        }
    }

    #[test]
    fn a_full_circle_has_three_spans_as_in_opencascade() {
        let curve = arc(DVec3::ZERO, DVec3::X, DVec3::Y, 0.0, TAU).unwrap();
        assert_eq!(curve.points().len(), 7);
        assert!((curve.weights()[1] - 0.5).abs() < 1e-15);
    }

    #[test]
    fn hyperbolas_and_parabolas_satisfy_their_equations() {
        let h = hyperbola(DVec3::ZERO, 2.0 * DVec3::X, 3.0 * DVec3::Y, -0.7, 1.3).unwrap();
        let p = parabola(DVec3::ZERO, 0.25 * DVec3::X, DVec3::Y, -2.0, 3.0).unwrap();
        for k in 0..=20 {
            let s = f64::from(k) / 20.0;
            let q = h.point(-0.7 + 2.0 * s);
            assert!(((q.x / 2.0).powi(2) - (q.y / 3.0).powi(2) - 1.0).abs() < 1e-12);
            let t = -2.0 + 5.0 * s;
            assert!((p.point(t) - DVec3::new(0.25 * t * t, t, 0.0)).length() < 1e-12);
        }
    }
}
