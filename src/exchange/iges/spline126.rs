//! Rational B-spline curve (126), taken as it is. A parameter range inside the knots is kept by insertion.

use super::error::EntityError;
use super::parameter::Args;
use crate::kernel::nurbs::{KnotVector, NurbsCurve3};

/// Reads degree, knots, weights, points and range.
pub(crate) fn read(args: &mut Args, scale: f64) -> Result<NurbsCurve3, EntityError> {
    let last = args.count("upper index K", 4)?;
    let degree = args.count("degree M", 0)?;
    args.skip(4); // planar, closed, polynomial, periodic: all derivable
    let knots = args.knots("knot", last + degree + 2)?;
    let weights = args.reals("weight", last + 1)?;
    let points =
        (0..=last).map(|_| args.point("control point", scale)).collect::<Result<Vec<_>, EntityError>>()?;
    let knots = KnotVector::new(degree, knots).map_err(EntityError::knots("t"))?;
    let (start, end) = knots.domain();
    let curve = NurbsCurve3::new(knots, points, weights)?;
    let range = (args.real_or("start parameter", start)?, args.real_or("end parameter", end)?);
    Ok(restrict(curve, range))
}

/// The part of `curve` over `range`, when the range is properly inside its domain.
fn restrict(curve: NurbsCurve3, range: (f64, f64)) -> NurbsCurve3 {
    let (start, end) = curve.domain();
    let (a, b) = (range.0.max(start), range.1.min(end));
    let least = 1e-9 * (end - start);
    if !(b - a > least) || (a - start <= least && end - b <= least) {
        return curve;
    }
    // A range that cannot be cut out is no reason to lose the curve.
    curve.restricted(a, b).unwrap_or(curve)
}
