//! Line (110).

use super::error::EntityError;
use super::parameter::Args;
use crate::kernel::nurbs::NurbsCurve3;

/// The segment from the first to the second point. Forms 1 and 2 (half line, line) are taken as the
/// segment between the points they give.
pub(crate) fn read(args: &mut Args, scale: f64) -> Result<NurbsCurve3, EntityError> {
    let (start, end) = (args.point("start", scale)?, args.point("end", scale)?);
    Ok(NurbsCurve3::line(start, end))
}
