//! Circular arc (100): counter-clockwise about a centre in a plane z = constant.

use std::f64::consts::TAU;

use glam::DVec3;

use super::error::EntityError;
use super::parameter::Args;
use crate::kernel::nurbs::NurbsCurve3;
use crate::kernel::primitives::arc;

/// The arc over its angles: from the start point's, in `[0, 2 pi)`, on. Equal ends mean a full circle.
pub(crate) fn read(args: &mut Args, scale: f64) -> Result<NurbsCurve3, EntityError> {
    let (centre, radius, (start, end)) = shape(args, scale)?;
    Ok(arc(centre, radius * DVec3::X, radius * DVec3::Y, start, end)?)
}

/// Centre, radius and angles.
fn shape(args: &mut Args, scale: f64) -> Result<(DVec3, f64, (f64, f64)), EntityError> {
    let z = args.real("z")? * scale;
    let mut point =
        |what| Ok::<_, EntityError>(DVec3::new(args.real(what)? * scale, args.real(what)? * scale, z));
    let (centre, start, end) = (point("centre")?, point("start")?, point("end")?);
    let radius = (start - centre).length();
    if !(radius > 0.0) {
        return Err(EntityError::Degenerate("the radius of the arc is zero".into()));
    }
    let angle = |p: DVec3| (p.y - centre.y).atan2(p.x - centre.x).rem_euclid(TAU);
    let from = angle(start);
    // Ends closer than the digits a file carries are one point: a full circle.
    let sweep = (angle(end) - from).rem_euclid(TAU);
    let closed = (end - start).length() <= 1e-9 * radius || sweep == 0.0;
    Ok((centre, radius, (from, from + if closed { TAU } else { sweep })))
}
