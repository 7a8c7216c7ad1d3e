//! Ruled surface (118): straight lines between points of two curves with the same parameter.

use super::error::EntityError;
use super::generatrix;
use super::parameter::Args;
use super::store::Reader;
use crate::exchange::boundary::parameter_map::UvMap;
use crate::kernel::nurbs::{KnotVector, NurbsCurve3, NurbsSurface};
use crate::kernel::primitives::ruled;

/// The surface, both of whose parameters run from 0 to 1 (in IGES, in OpenCASCADE and here).
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
    let (a, b) = compatible(&first, &second)?;
    Ok((ruled(&a, &b)?, UvMap::IDENTITY))
}

/// Both curves over 0 to 1, with one degree and one knot vector.
fn compatible(first: &NurbsCurve3, second: &NurbsCurve3) -> Result<(NurbsCurve3, NurbsCurve3), EntityError> {
    let degree = first.degree().max(second.degree());
    let (first, second) = (over_unit(first, degree)?, over_unit(second, degree)?);
    Ok((first.inserted(&missing(&first, &second))?, second.inserted(&missing(&second, &first))?))
}

/// The curve with `degree` and clamped ends over 0 to 1.
fn over_unit(curve: &NurbsCurve3, degree: usize) -> Result<NurbsCurve3, EntityError> {
    let curve = curve.elevated(degree - curve.degree())?.clamped();
    let (start, end) = curve.domain();
    // The ends are set, not computed, so that those of two curves agree to the last bit.
    let unit = |k: &f64| match *k {
        k if k <= start => 0.0,
        k if k >= end => 1.0,
        k => (k - start) / (end - start),
    };
    let knots = curve.knots().as_slice().iter().map(unit).collect();
    let knots = KnotVector::new(degree, knots).map_err(EntityError::knots("t"))?;
    Ok(NurbsCurve3::new(knots, curve.points().to_vec(), curve.weights().to_vec())?)
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
