//! Offset surface (140): a surface moved along its normal. Exact for planes, cylinders, cones, spheres and tori.

use glam::{DAffine3, DVec3};

use super::error::EntityError;
use super::parameter::Args;
use super::store::Reader;
use super::surface::{self, Surface};
use crate::exchange::report::Severity;
use crate::kernel::primitives::{AnalyticSurface, Shape};
use crate::kernel::query::{Carrier, offset};

/// Parts of the model's size that an approximated offset may be wrong by.
const TOLERANCE: f64 = 1e-6;

/// The same beyond which it is another surface and better left out.
const WORST: f64 = 1e-2;

/// The offset surface with the parameters of its base.
pub(crate) fn read(
    reader: &mut Reader<'_, '_>,
    args: &mut Args,
    outer: DAffine3,
    index: usize,
) -> Result<Surface, EntityError> {
    // The indicator tells on which side the distance is positive, as measured at mid parameters.
    let indicator = args.point("indicator", 1.0)?;
    let distance = args.real("distance")? * reader.millimetres();
    let pointer = args.required("base surface")?;
    let base = surface::read(reader, pointer, outer)?;
    let indicator = outer.transform_vector3(indicator);
    let carrier = match &base.carrier {
        Carrier::Analytic(surface) => Carrier::Analytic(moved(surface, indicator, distance)?),
        Carrier::Spline(spline) => {
            let s = spline.surface();
            let ((u0, u1), (v0, v1)) = (s.knots_u().domain(), s.knots_v().domain());
            let jet = s.jet(0.5 * (u0 + u1), 0.5 * (v0 + v1));
            let along = jet.du.cross(jet.dv).dot(indicator);
            let signed = if along < 0.0 { -distance } else { distance };
            let tolerance = TOLERANCE * s.bounds().diagonal().max(distance.abs());
            let (surface, error) = offset::offset(s, signed, tolerance)
                .ok_or_else(|| EntityError::Degenerate("the base surface has no normal somewhere".into()))?;
            if !(error <= WORST * s.bounds().diagonal().max(distance.abs())) {
                let reason =
                    format!("the offset folds or turns too sharply to be followed (off by {error:.2e} mm)");
                return Err(EntityError::Degenerate(reason));
            }
            reader.remark(
                index,
                if error <= tolerance { Severity::Note } else { Severity::Warning },
                format!("the offset surface is approximated by a spline; largest error found {error:.2e} mm"),
            );
            Carrier::spline(surface)
        }
    };
    // The base's arcs can no longer be cut: the offset is another surface.
    Ok(Surface { carrier, index, sweep: None, ..base })
}

fn moved(surface: &AnalyticSurface, indicator: DVec3, distance: f64) -> Result<AnalyticSurface, EntityError> {
    let [_, du, dv] = surface.jet(glam::DVec2::new(0.1, 0.1));
    let sign = if du.cross(dv).dot(indicator) < 0.0 { -1.0 } else { 1.0 };
    let d = sign * distance;
    let mut place = surface.model_from_local;
    let shape = match surface.shape {
        Shape::Plane => {
            place.translation += du.cross(dv).normalize() * d;
            Shape::Plane
        }
        Shape::Cylinder { radius } => Shape::Cylinder { radius: radius + d },
        Shape::Sphere { radius } => Shape::Sphere { radius: radius + d },
        Shape::Torus { major, minor } => Shape::Torus { major, minor: minor + d },
        Shape::Cone { radius, semi_angle } => {
            let (s, c) = semi_angle.sin_cos();
            place.translation -= place.matrix3.z_axis * (d * s);
            Shape::Cone { radius: radius + d * c, semi_angle }
        }
    };
    let sound = match shape {
        Shape::Plane => true,
        Shape::Cylinder { radius } | Shape::Sphere { radius } => radius > 0.0,
        Shape::Cone { radius, .. } => radius >= 0.0,
        Shape::Torus { minor, .. } => minor > 0.0,
    };
    if !sound {
        return Err(EntityError::Degenerate("the offset is larger than the radius".into()));
    }
    Ok(AnalyticSurface { shape, model_from_local: place })
}
