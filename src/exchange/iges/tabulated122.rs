//! Tabulated cylinder (122): a curve moved along a vector.

use glam::DAffine3;

use super::error::EntityError;
use super::generatrix;
use super::parameter::Args;
use super::store::Reader;
use crate::exchange::boundary::parameter_map::{AxisMap, UvMap};
use crate::kernel::primitives::{Motion, Sweep};

/// The surface (u along the curve, v a length), and the maps from IGES parameters that files are seen to use: both from 0
/// to 1, as IGES says, or u the curve's own parameter.
pub(crate) fn read(reader: &mut Reader<'_, '_>, args: &mut Args) -> Result<(Sweep, Vec<UvMap>), EntityError> {
    let pointer = args.required("directrix")?;
    let directrix = generatrix::read(reader, pointer)?;
    let end = args.point("end of the generatrix", reader.millimetres())?;
    let curve = directrix.profile.spline()?;
    let (from, to) = curve.domain();
    let direction = end - curve.point(from);
    let own = directrix.native_from_iges;
    let share = AxisMap { scale: to - from, offset: from, arc: own.arc };
    let motion = Motion::Extrusion { direction };
    let sweep = Sweep { profile: directrix.profile, motion, model_from_local: DAffine3::IDENTITY };
    let length = AxisMap::scaling(direction.length());
    let mut maps = vec![UvMap::new(share, length)];
    if own != share {
        maps.push(UvMap::new(own, length));
    }
    Ok((sweep, maps))
}
