//! Trimmed surface (144): a surface, an outer boundary or none, and inner boundaries.

use glam::DAffine3;

use super::error::EntityError;
use super::parameter::Args;
use super::store::Reader;
use super::{curve_on_surface142, surface, transform124};
use crate::kernel::nurbs::NurbsSurface;
use crate::scene::records::{LoopRecord, LoopRole};

/// Reads surface and loops.
pub(crate) fn read(
    reader: &mut Reader<'_, '_>,
    args: &mut Args,
    transform: i64,
    outer: DAffine3,
) -> Result<(NurbsSurface, Vec<LoopRecord>), EntityError> {
    let scale = reader.millimetres();
    let own = outer * transform124::transform(reader, transform, scale)?;
    let pointer = args.pointer("surface")?.ok_or(EntityError::Missing { index: 1, what: "surface" })?;
    let surface = surface::read(reader, pointer, own)?;
    let bounded = args.integer_or("outer boundary flag", 0)? != 0;
    let inner = args.count("number of inner boundaries", 1)?;
    let outline = args.pointer("outer boundary")?;
    let mut loops = Vec::new();
    if let Some(pointer) = outline.filter(|_| bounded) {
        loops.push(LoopRecord { role: LoopRole::Outer, curves: curve_on_surface142::read(reader, pointer)? });
    }
    for _ in 0..inner {
        if let Some(pointer) = args.pointer("inner boundary")? {
            loops.push(LoopRecord {
                role: LoopRole::Inner,
                curves: curve_on_surface142::read(reader, pointer)?,
            });
        }
    }
    Ok((surface, loops))
}
