//! Curve on a parametric surface (142): the same curve in the surface's parameters and in space.

use glam::DAffine3;

use super::error::EntityError;
use super::point116::expect;
use super::segment::{Segment, boundary};
use super::store::Reader;
use super::surface::Surface;
use super::transform124;
use crate::exchange::boundary::RawLoop;
use crate::scene::records::LoopRole;

/// Reads one boundary of `surface`; `outer` is the transformation of the face.
pub(crate) fn read(
    reader: &mut Reader<'_, '_>,
    pointer: i64,
    surface: &Surface,
    outer: DAffine3,
    role: LoopRole,
) -> Result<RawLoop, EntityError> {
    reader.open(pointer, "boundary", |reader, mut opened| {
        expect(opened.entry.kind, 142, "a curve on a surface (142)", pointer)?;
        let own = outer * transform124::transform(reader, opened.entry.transform, reader.millimetres())?;
        let args = &mut opened.args;
        args.skip(1); // how it was created
        args.pointer("surface")?;
        let uv = args.pointer("parameter curve")?;
        let space = args.pointer("space curve")?;
        let mut segment = Segment::read(reader, opened.index, uv.as_slice(), space, own)?;
        segment.prefers_space = args.integer_or("preference", 0)? == 2;
        boundary(reader, opened.index, surface, &[segment], role)
    })
}
