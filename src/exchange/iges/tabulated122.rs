//! Tabulated cylinder (122): a curve moved along a vector.

use glam::DAffine3;

use super::error::EntityError;
use super::generatrix;
use super::parameter::Args;
use super::store::Reader;
use crate::exchange::boundary::parameter_map::{AxisMap, UvMap};
use crate::kernel::primitives::{Motion, Sweep};

/// The surface (u along the curve, v a length), and the map from IGES parameters (v from 0 to 1).
pub(crate) fn read(reader: &mut Reader<'_, '_>, args: &mut Args) -> Result<(Sweep, UvMap), EntityError> {
    let pointer = args.required("directrix")?;
    let directrix = generatrix::read(reader, pointer)?;
    let end = args.point("end of the generatrix", reader.millimetres())?;
    let curve = directrix.profile.spline()?;
    let direction = end - curve.point(curve.domain().0);
    let motion = Motion::Extrusion { direction };
    let sweep = Sweep { profile: directrix.profile, motion, model_from_local: DAffine3::IDENTITY };
    Ok((sweep, UvMap::new(directrix.native_from_iges, AxisMap::scaling(direction.length()))))
}
