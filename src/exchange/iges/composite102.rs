//! Composite curve (102): curves end to start.

use glam::DAffine3;

use super::curve::{self, Space};
use super::error::EntityError;
use super::parameter::Args;
use super::store::Reader;
use crate::kernel::nurbs::NurbsCurve3;

/// Appends the pieces, in order. Points among them (116, 132 are allowed as markers) are passed over.
pub(crate) fn read(
    reader: &mut Reader<'_, '_>,
    args: &mut Args,
    space: Space,
    outer: DAffine3,
    pieces: &mut Vec<NurbsCurve3>,
) -> Result<(), EntityError> {
    for _ in 0..args.count("number of curves", 1)? {
        if let Some(pointer) = args.pointer("curve")?
            && !matches!(reader.kind(pointer, "curve")?, 116 | 132)
        {
            curve::read(reader, pointer, space, outer, pieces)?;
        }
    }
    Ok(())
}
