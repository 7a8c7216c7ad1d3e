//! Parametric spline curve (112): cubic polynomials `A + B s + C s^2 + D s^3` between break points.

use glam::DVec3;

use super::error::EntityError;
use super::parameter::Args;
use crate::kernel::nurbs::{KnotVector, NurbsCurve3};

/// The spline as a cubic B-spline over the same break points, each inner one threefold.
pub(crate) fn read(args: &mut Args, scale: f64) -> Result<NurbsCurve3, EntityError> {
    args.skip(2); // kind of spline, degree of continuity
    let dimension = args.integer_or("dimension", 3)?;
    let count = args.count("number of segments", 13)?;
    let breaks = args.reals("break point", count + 1)?;
    let mut points = Vec::with_capacity(3 * count + 1);
    for i in 0..count {
        let c = args.reals("coefficient", 12)?;
        let h = breaks[i + 1] - breaks[i];
        let term = |k: usize| {
            DVec3::new(c[k], c[k + 4], if dimension == 2 && k > 0 { 0.0 } else { c[k + 8] }) * scale
        };
        points.extend(bezier([term(0), term(1), term(2), term(3)], h));
        if i + 1 < count {
            points.pop();
        }
    }
    if count == 0 {
        return Err(EntityError::Degenerate("no segments".into()));
    }
    let knots = KnotVector::new(3, threefold(&breaks)).map_err(EntityError::knots("t"))?;
    let weights = vec![1.0; points.len()];
    Ok(NurbsCurve3::new(knots, points, weights)?)
}

/// Bezier points of `a + b s + c s^2 + d s^3` over `s` in `[0, h]`.
pub(crate) fn bezier([a, b, c, d]: [DVec3; 4], h: f64) -> [DVec3; 4] {
    let (b, c, d) = (b * h, c * (h * h), d * (h * h * h));
    [a, a + b / 3.0, a + (b * 2.0 + c) / 3.0, a + b + c + d]
}

/// Cubic knots over `breaks`: ends fourfold, inner ones threefold.
pub(crate) fn threefold(breaks: &[f64]) -> Vec<f64> {
    let mut knots: Vec<f64> = breaks.iter().flat_map(|b| [*b; 3]).collect();
    if let (Some(first), Some(last)) = (breaks.first(), breaks.last()) {
        knots.insert(0, *first);
        knots.push(*last);
    }
    knots
}
