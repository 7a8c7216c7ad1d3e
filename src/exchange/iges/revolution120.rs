//! Surface of revolution (120): a generatrix turned about an axis from a start to an end angle.

use std::f64::consts::TAU;

use glam::{DAffine3, DMat3, DQuat};

use super::curve::{self, Space};
use super::error::EntityError;
use super::generatrix;
use super::parameter::Args;
use super::store::Reader;
use crate::exchange::boundary::parameter_map::{AxisMap, UvMap};
use crate::kernel::primitives::{Motion, Sweep};

/// The surface, with OpenCASCADE's parameters: u is the angle run backwards from the end angle (about
/// the axis turned round), v runs along the generatrix. IGES has u along the generatrix and v the angle.
pub(crate) fn read(reader: &mut Reader<'_, '_>, args: &mut Args) -> Result<(Sweep, UvMap), EntityError> {
    let axis = args.required("axis")?;
    let generatrix = args.required("generatrix")?;
    let (start, end) = (args.real("start angle")?, args.real("end angle")?);
    let mut pieces = Vec::new();
    curve::read(reader, axis, Space::Model, DAffine3::IDENTITY, &mut pieces)?;
    let line = &pieces[0];
    let (origin, tip) = (line.points()[0], line.points()[line.points().len() - 1]);
    let direction = tip - origin;
    if !(direction.length() > 0.0) {
        return Err(EntityError::Degenerate("the axis of revolution has no length".into()));
    }
    let generatrix = generatrix::read(reader, generatrix)?;
    let sweep = (end - start).abs();
    if !(sweep > 0.0) {
        return Err(EntityError::Degenerate("the angles of the surface of revolution are equal".into()));
    }
    // A little over a full turn is a full turn.
    let sweep = if (sweep - TAU).abs() < 1e-6 || sweep > TAU { TAU } else { sweep };
    let last = start.max(end);
    let rotation = DQuat::from_axis_angle(direction.normalize(), last);
    let profile = generatrix
        .profile
        .moved(DAffine3 { matrix3: DMat3::from_quat(rotation), translation: origin - rotation * origin });
    let motion = Motion::Revolution { origin, axis: -direction, sweep };
    let angle = AxisMap { scale: -1.0, offset: last, arc: Some((0.0, sweep)) };
    let map = UvMap { swap: true, u: angle, v: generatrix.native_from_iges };
    Ok((Sweep { profile, motion, model_from_local: DAffine3::IDENTITY }, map))
}
