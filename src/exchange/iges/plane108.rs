//! Plane (108): `A x + B y + C z = D`, perhaps with a bounding curve.

use glam::{DAffine3, DMat3, DVec3};

use super::error::EntityError;
use super::parameter::Args;
use crate::kernel::primitives::{AnalyticSurface, Shape};

/// The plane, with OpenCASCADE's choice of origin and x axis, and the bounding curve (if any).
pub(crate) fn read(args: &mut Args, scale: f64) -> Result<(AnalyticSurface, Option<i64>), EntityError> {
    let k = args.reals("coefficient", 4)?;
    let normal = DVec3::new(k[0], k[1], k[2]);
    let length = normal.length();
    if !(length > 0.0) {
        return Err(EntityError::Degenerate("the plane has no normal".into()));
    }
    let boundary = args.pointer("bounding curve")?;
    args.skip(4); // display symbol
    let n = normal / length;
    let (d, [a, b, c]) = (k[3] / length * scale, n.to_array());
    // The origin lies on the axis of the largest component; x has no part along the smallest.
    let [aa, ba, ca] = n.abs().to_array();
    let (origin, x) = if ba <= aa && ba <= ca {
        if aa > ca {
            (DVec3::new(d / a, 0.0, 0.0), DVec3::new(-c, 0.0, a))
        } else {
            (DVec3::new(0.0, 0.0, d / c), DVec3::new(c, 0.0, -a))
        }
    } else if aa <= ba && aa <= ca {
        if ba > ca {
            (DVec3::new(0.0, d / b, 0.0), DVec3::new(0.0, -c, b))
        } else {
            (DVec3::new(0.0, 0.0, d / c), DVec3::new(0.0, c, -b))
        }
    } else if aa > ba {
        (DVec3::new(d / a, 0.0, 0.0), DVec3::new(-b, a, 0.0))
    } else {
        (DVec3::new(0.0, d / b, 0.0), DVec3::new(b, -a, 0.0))
    };
    let x = x.normalize();
    let matrix3 = DMat3::from_cols(x, n.cross(x), n);
    let place = DAffine3 { matrix3, translation: origin };
    Ok((AnalyticSurface { shape: Shape::Plane, model_from_local: place }, boundary))
}
