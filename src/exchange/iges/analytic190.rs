//! Planes, cylinders, cones, spheres and tori of boundary representations (190, 192, 194, 196, 198).

use glam::{DAffine3, DMat3, DVec3};

use super::error::EntityError;
use super::parameter::Args;
use super::point116::{direction, point};
use super::store::Reader;
use crate::kernel::primitives::{AnalyticSurface, Shape};

/// Reads the surface of type `kind`. Without a reference direction (form 0) the x axis is
/// OpenCASCADE's choice.
pub(crate) fn read(
    reader: &mut Reader<'_, '_>,
    kind: u32,
    args: &mut Args,
) -> Result<AnalyticSurface, EntityError> {
    let scale = reader.millimetres();
    let origin = point(reader, args, "location")?;
    let length = |what: &'static str, args: &mut Args| -> Result<f64, EntityError> {
        let value = args.real(what)? * scale;
        if value > 0.0 {
            return Ok(value);
        }
        Err(EntityError::Degenerate(format!("the {what} is {value}; it must be positive")))
    };
    let (axis, shape) = match kind {
        196 => {
            let radius = length("radius", args)?;
            (direction(reader, args, "axis")?, Shape::Sphere { radius })
        }
        190 => (direction(reader, args, "normal")?, Shape::Plane),
        _ => {
            let axis = direction(reader, args, "axis")?;
            let shape = match kind {
                192 => Shape::Cylinder { radius: length("radius", args)? },
                194 => {
                    let radius = args.real("radius")? * scale;
                    let semi_angle = args.real("semi-angle")?.to_radians();
                    if radius < 0.0 || !(semi_angle > 0.0 && semi_angle < std::f64::consts::FRAC_PI_2) {
                        return Err(EntityError::Degenerate(format!(
                            "a cone of radius {radius} and semi-angle {semi_angle} rad is not a cone"
                        )));
                    }
                    Shape::Cone { radius, semi_angle }
                }
                _ => Shape::Torus {
                    major: length("major radius", args)?,
                    minor: length("minor radius", args)?,
                },
            };
            (axis, shape)
        }
    };
    let reference = direction(reader, args, "reference direction")?;
    let axis = axis.unwrap_or(DVec3::Z);
    let matrix3 = frame(axis, reference);
    Ok(AnalyticSurface { shape, model_from_local: DAffine3 { matrix3, translation: origin } })
}

/// Right-handed axes with z along `axis` and x as near to `reference` as can be.
fn frame(axis: DVec3, reference: Option<DVec3>) -> DMat3 {
    let x = reference
        .and_then(|r| (r - axis * r.dot(axis)).try_normalize())
        .unwrap_or_else(|| perpendicular(axis));
    DMat3::from_cols(x, axis.cross(x), axis)
}

/// The x direction that OpenCASCADE gives a frame of which only z is known.
fn perpendicular(n: DVec3) -> DVec3 {
    let [a, b, c] = n.to_array();
    let [aa, ba, ca] = n.abs().to_array();
    let x = if ba <= aa && ba <= ca {
        if aa > ca { DVec3::new(-c, 0.0, a) } else { DVec3::new(c, 0.0, -a) }
    } else if aa <= ba && aa <= ca {
        if ba > ca { DVec3::new(0.0, -c, b) } else { DVec3::new(0.0, c, -b) }
    } else if aa > ba {
        DVec3::new(-b, a, 0.0)
    } else {
        DVec3::new(b, -a, 0.0)
    };
    x.normalize()
}
