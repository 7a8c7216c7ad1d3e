//! Boundary (141): a closed run of space curves, each perhaps with its curves in parameter space.

use glam::DAffine3;

use super::error::EntityError;
use super::point116::expect;
use super::segment::{Segment, boundary};
use super::store::Reader;
use super::surface::Surface;
use super::transform124;
use crate::exchange::boundary::RawLoop;
use crate::scene::records::LoopRole;

/// Reads one boundary of `surface`.
pub(crate) fn read(
    reader: &mut Reader<'_, '_>,
    pointer: i64,
    surface: &Surface,
    outer: DAffine3,
) -> Result<RawLoop, EntityError> {
    reader.open(pointer, "boundary", |reader, mut opened| {
        expect(opened.entry.kind, 141, "a boundary (141)", pointer)?;
        let own = outer * transform124::transform(reader, opened.entry.transform, reader.millimetres())?;
        let args = &mut opened.args;
        let with_parameters = args.integer_or("type", 0)? == 1;
        let preference = args.integer_or("preference", 0)?;
        args.pointer("surface")?;
        let mut segments = Vec::new();
        for _ in 0..args.count("number of curves", 3)? {
            let space = args.pointer("space curve")?;
            let reversed = args.integer_or("sense", 1)? == 2;
            let mut uv = Vec::new();
            for _ in 0..args.count("number of parameter curves", 1)? {
                uv.extend(args.pointer("parameter curve")?);
            }
            if !with_parameters {
                uv.clear();
            }
            let mut segment = Segment::read(reader, opened.index, &uv, space, own)?;
            segment.prefers_space = preference == 1;
            if reversed {
                segment.reverse_space();
            }
            segments.push(segment);
        }
        boundary(reader, opened.index, surface, &segments, LoopRole::Unknown)
    })
}
