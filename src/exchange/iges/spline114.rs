//! Parametric spline surface (114): bicubic polynomial patches over a grid of break points.

use glam::DVec3;

use super::error::EntityError;
use super::parameter::Args;
use super::spline112::{bezier, threefold};
use crate::kernel::nurbs::{KnotVector, NurbsSurface};

/// The surface as a bicubic B-spline over the same break points, each inner one threefold.
pub(crate) fn read(args: &mut Args, scale: f64) -> Result<NurbsSurface, EntityError> {
    args.skip(2); // kind of spline, kind of patch
    let m = args.count("number of segments in u", 1)?;
    let n = args.count("number of segments in v", 1)?;
    if m == 0 || n == 0 {
        return Err(EntityError::Degenerate("no patches".into()));
    }
    let breaks_u = args.reals("break point in u", m + 1)?;
    let breaks_v = args.reals("break point in v", n + 1)?;
    // The standard pads the grid of patches by one row and column; some writers leave them out.
    let needed = 48.0 * m as f64 * n as f64;
    let padded = 48.0 * (m as f64 * (n + 1) as f64) - 48.0 <= args.left() as f64;
    if needed > args.left() as f64 {
        let left = args.left();
        return Err(EntityError::Count { what: "number of patches", count: (m * n) as f64, needed, left });
    }
    let (nu, nv) = (3 * m + 1, 3 * n + 1);
    let mut points = vec![DVec3::ZERO; nu * nv];
    for i in 0..m {
        for j in 0..n {
            let k = args.reals("coefficient", 48)?;
            let (hu, hv) = (breaks_u[i + 1] - breaks_u[i], breaks_v[j + 1] - breaks_v[j]);
            let term = |a: usize, b: usize| {
                let at = a + 4 * b;
                DVec3::new(k[at], k[at + 16], k[at + 32]) * scale
            };
            // First along u for each power of v, then along v.
            let rows: [[DVec3; 4]; 4] =
                std::array::from_fn(|b| bezier([term(0, b), term(1, b), term(2, b), term(3, b)], hu));
            for a in 0..4 {
                let column = bezier([rows[0][a], rows[1][a], rows[2][a], rows[3][a]], hv);
                for (b, point) in column.into_iter().enumerate() {
                    points[(3 * i + a) * nv + 3 * j + b] = point;
                }
            }
        }
        if padded && i + 1 < m {
            args.skip(48);
        }
    }
    if padded {
        args.skip(48 * (n + 2));
    }
    let knots_u = KnotVector::new(3, threefold(&breaks_u)).map_err(EntityError::knots("u"))?;
    let knots_v = KnotVector::new(3, threefold(&breaks_v)).map_err(EntityError::knots("v"))?;
    Ok(NurbsSurface::new(knots_u, knots_v, points, vec![1.0; nu * nv])?)
}
