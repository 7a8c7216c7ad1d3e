//! Rational B-spline surface (128), taken as it is.

use super::error::EntityError;
use super::parameter::Args;
use crate::kernel::nurbs::{KnotVector, NurbsSurface};

/// Reads degrees, knots, weights and points. IGES lists u first (`i` runs fastest); ours is u-major.
pub(crate) fn read(args: &mut Args, scale: f64) -> Result<NurbsSurface, EntityError> {
    let nu = args.count("upper index K1", 1)? + 1;
    let nv = args.count("upper index K2", 1)? + 1;
    let (du, dv) = (args.count("degree M1", 0)?, args.count("degree M2", 0)?);
    args.skip(5); // closed, polynomial, periodic: all derivable
    let needed = 4.0 * nu as f64 * nv as f64;
    if needed > args.left() as f64 {
        let left = args.left();
        return Err(EntityError::Count { what: "(K1+1)(K2+1)", count: needed / 4.0, needed, left });
    }
    let knots_u = args.reals("knot in u", nu + du + 1)?;
    let knots_v = args.reals("knot in v", nv + dv + 1)?;
    let weights = args.reals("weight", nu * nv)?;
    let points =
        (0..nu * nv).map(|_| args.point("control point", scale)).collect::<Result<Vec<_>, EntityError>>()?;
    let order = (0..nu).flat_map(|i| (0..nv).map(move |j| i + j * nu));
    let knots_u = KnotVector::new(du, knots_u).map_err(EntityError::knots("u"))?;
    let knots_v = KnotVector::new(dv, knots_v).map_err(EntityError::knots("v"))?;
    let surface = NurbsSurface::new(
        knots_u,
        knots_v,
        order.clone().map(|k| points[k]).collect(),
        order.map(|k| weights[k]).collect(),
    )?;
    Ok(surface)
}
