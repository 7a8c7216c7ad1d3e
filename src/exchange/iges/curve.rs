//! Any curve entity as a run of NURBS curves in model space (millimetres) or in a surface's uv plane.

use glam::{DAffine3, DVec3};

use super::error::EntityError;
use super::store::Reader;
use super::{arc100, composite102, conic104, copious106, line110, spline112, spline126, transform124};
use crate::kernel::nurbs::NurbsCurve3;

/// Where a curve's coordinates live.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Space {
    /// Model space: lengths are converted to millimetres.
    Model,
    /// The parameter plane of a surface: numbers stay as they are.
    Parameter,
}

impl Space {
    /// Factor for coordinates.
    pub(crate) fn scale(self, reader: &Reader<'_, '_>) -> f64 {
        match self {
            Self::Model => reader.millimetres(),
            Self::Parameter => 1.0,
        }
    }
}

/// Reads the curve that `pointer` means, with its transformation and then `outer` applied; composites
/// come apart into their pieces, in order.
pub(crate) fn read(
    reader: &mut Reader<'_, '_>,
    pointer: i64,
    space: Space,
    outer: DAffine3,
    pieces: &mut Vec<NurbsCurve3>,
) -> Result<(), EntityError> {
    reader.open(pointer, "curve", |reader, mut opened| {
        let scale = space.scale(reader);
        let own = outer * transform124::transform(reader, opened.entry.transform, scale)?;
        let first = pieces.len();
        let args = &mut opened.args;
        match opened.entry.kind {
            102 => return composite102::read(reader, args, space, own, pieces),
            100 => pieces.push(arc100::read(args, scale)?),
            104 => pieces.push(conic104::read(args, opened.entry.form, scale)?),
            106 => copious106::read(args, scale, pieces)?,
            110 => pieces.push(line110::read(args, scale)?),
            112 => pieces.push(spline112::read(args, scale)?),
            126 => pieces.push(spline126::read(args, scale)?),
            kind => {
                return Err(EntityError::Kind { expected: "a curve", kind, target: pointer as u64 });
            }
        }
        if own != DAffine3::IDENTITY {
            for curve in &mut pieces[first..] {
                *curve = curve.map_points(|p: DVec3| own.transform_point3(p));
            }
        }
        Ok(())
    })
}
