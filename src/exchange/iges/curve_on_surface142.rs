//! Curve on a parametric surface (142): the same curve in the surface's parameters and in space.

use glam::{DAffine3, DVec3};

use super::curve::{self, Space};
use super::error::EntityError;
use super::store::Reader;
use crate::kernel::nurbs::{NurbsCurve2, NurbsCurve3};

/// Reads the pcurves of one boundary, in order.
pub(crate) fn read(reader: &mut Reader<'_, '_>, pointer: i64) -> Result<Vec<NurbsCurve2>, EntityError> {
    reader.open(pointer, "boundary", |reader, mut opened| {
        let args = &mut opened.args;
        if opened.entry.kind != 142 {
            let (kind, target) = (opened.entry.kind, pointer as u64);
            return Err(EntityError::Kind { expected: "a curve on a surface (142)", kind, target });
        }
        args.skip(1); // how it was created
        args.pointer("surface")?;
        let uv = args.pointer("parameter curve")?;
        args.pointer("space curve")?;
        let mut pieces: Vec<NurbsCurve3> = Vec::new();
        let uv = uv.ok_or(EntityError::Missing { index: 3, what: "parameter curve" })?;
        curve::read(reader, uv, Space::Parameter, DAffine3::IDENTITY, &mut pieces)?;
        Ok(pieces.iter().map(|c| c.map_points(|p: DVec3| p.truncate())).collect())
    })
}
