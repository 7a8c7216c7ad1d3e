//! Rational B-spline surface (128), taken as it is.

use glam::DVec2;

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
    let knots_u = args.knots("knot in u", nu + du + 1)?;
    let knots_v = args.knots("knot in v", nv + dv + 1)?;
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
    let ((u0, u1), (v0, v1)) = (surface.knots_u().domain(), surface.knots_v().domain());
    let mut range =
        |what, start, end| Ok::<_, EntityError>((args.real_or(what, start)?, args.real_or(what, end)?));
    let (u, v) = (range("range of u", u0, u1)?, range("range of v", v0, v1)?);
    let part = |(a, b): (f64, f64), start: f64, end: f64| {
        let least = 1e-9 * (end - start);
        let (a, b) = (a.max(start), b.min(end));
        (b - a > least && (a - start > least || end - b > least)).then_some((a, b))
    };
    let (u, v) = (part(u, u0, u1), part(v, v0, v1));
    if u.is_none() && v.is_none() {
        return Ok(surface);
    }
    let (u, v) = (u.unwrap_or((u0, u1)), v.unwrap_or((v0, v1)));
    // A range that cannot be cut out is no reason to lose the surface.
    Ok(surface.restricted(DVec2::new(u.0, v.0), DVec2::new(u.1, v.1)).unwrap_or(surface))
}
