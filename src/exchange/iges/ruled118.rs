//! Ruled surface (118): straight lines between points of two curves with the same parameter.

use super::error::EntityError;
use super::generatrix;
use super::parameter::Args;
use super::store::Reader;
use crate::exchange::boundary::parameter_map::{AxisMap, UvMap};
use crate::kernel::nurbs::{KnotVector, NurbsCurve3, NurbsSurface};
use crate::kernel::primitives::ruled;

/// The surface over the first curve's parameters in u and 0 to 1 in v; both of IGES' parameters run from
/// 0 to 1.
///
/// Form 0 asks for equal relative arc length, form 1 for equal relative parameters. Like other
/// readers this one pairs by parameter in both; for lines and arcs there is no difference.
pub(crate) fn read(
    reader: &mut Reader<'_, '_>,
    args: &mut Args,
) -> Result<(NurbsSurface, UvMap), EntityError> {
    let (first, second) = (args.required("first curve")?, args.required("second curve")?);
    let backwards = args.integer_or("direction flag", 0)? == 1;
    args.skip(1); // developable or not
    let first = generatrix::read(reader, first)?.profile.spline()?;
    let second = generatrix::read(reader, second)?.profile.spline()?;
    let second = if backwards { second.reversed() } else { second };
    let (start, end) = first.domain();
    let (a, b) = compatible(&first, &second)?;
    let surface = ruled(&a, &b)?;
    let u = AxisMap { scale: end - start, offset: start, arc: None };
    Ok((surface, UvMap::new(u, AxisMap::IDENTITY)))
}

/// Both curves over the first one's domain, with one degree and one knot vector.
fn compatible(first: &NurbsCurve3, second: &NurbsCurve3) -> Result<(NurbsCurve3, NurbsCurve3), EntityError> {
    let degree = first.degree().max(second.degree());
    let first = first.elevated(degree - first.degree())?.clamped();
    let second = second.elevated(degree - second.degree())?.clamped();
    let ((a, b), (c, d)) = (first.domain(), second.domain());
    // The clamped ends of both are set, not computed, so that they agree to the last bit.
    let knots = second
        .knots()
        .as_slice()
        .iter()
        .map(|k| {
            if *k == c {
                a
            } else if *k == d {
                b
            } else {
                a + (k - c) * ((b - a) / (d - c))
            }
        })
        .collect();
    let knots = KnotVector::new(degree, knots).map_err(EntityError::knots("t"))?;
    let second = NurbsCurve3::new(knots, second.points().to_vec(), second.weights().to_vec())?;
    Ok((first.inserted(&missing(&first, &second))?, second.inserted(&missing(&second, &first))?))
}

/// Knots of `other` that `curve` lacks, with multiplicity.
fn missing(curve: &NurbsCurve3, other: &NurbsCurve3) -> Vec<f64> {
    let mut own = curve.knots().as_slice().to_vec();
    let mut result = Vec::new();
    for knot in other.knots().as_slice() {
        match own.iter().position(|k| k == knot) {
            Some(position) => {
                own.swap_remove(position);
            }
            None => result.push(*knot),
        }
    }
    result
}
