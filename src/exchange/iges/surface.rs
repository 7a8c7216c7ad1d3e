//! Any surface entity as a NURBS surface in model space (millimetres).

use glam::{DAffine3, DVec3};

use super::error::EntityError;
use super::store::Reader;
use super::{surface128, transform124};
use crate::kernel::nurbs::NurbsSurface;

/// Reads the surface that `pointer` means, with its transformation and then `outer` applied.
pub(crate) fn read(
    reader: &mut Reader<'_, '_>,
    pointer: i64,
    outer: DAffine3,
) -> Result<NurbsSurface, EntityError> {
    reader.open(pointer, "surface", |reader, mut opened| {
        let scale = reader.millimetres();
        let own = outer * transform124::transform(reader, opened.entry.transform, scale)?;
        let args = &mut opened.args;
        let surface = match opened.entry.kind {
            128 => surface128::read(args, scale)?,
            kind => return Err(EntityError::Kind { expected: "a surface", kind, target: pointer as u64 }),
        };
        Ok(if own == DAffine3::IDENTITY {
            surface
        } else {
            surface.map_points(|p: DVec3| own.transform_point3(p))
        })
    })
}

/// Whether an entity type is a surface.
pub(crate) fn is_surface(kind: u32) -> bool {
    matches!(kind, 108 | 114 | 118 | 120 | 122 | 128 | 140 | 190 | 192 | 194 | 196 | 198)
}
