//! Trimmed surfaces: with boundaries in parameter space (144) and bounded surfaces (143).

use glam::DAffine3;

use super::error::EntityError;
use super::parameter::Args;
use super::segment::{Segment, boundary};
use super::store::{Opened, Reader, Store};
use super::surface::{self, Surface};
use super::{boundary141, curve_on_surface142, transform124};
use crate::exchange::boundary::RawLoop;
use crate::exchange::report::Severity;
use crate::scene::records::LoopRole;

/// A surface and its loops, as read.
pub(crate) type Trimmed = (Surface, Vec<RawLoop>);

/// Reads a trimmed surface (144). A boundary that cannot be read is left out with a remark.
pub(crate) fn read144(
    reader: &mut Reader<'_, '_>,
    opened: &mut Opened<'_>,
    outer: DAffine3,
) -> Result<Trimmed, EntityError> {
    let own = outer * transform124::transform(reader, opened.entry.transform, reader.millimetres())?;
    let args: &mut Args = &mut opened.args;
    let pointer = args.required("surface")?;
    let surface = surface::read(reader, pointer, own)?;
    let bounded = args.integer_or("outer boundary flag", 0)? != 0;
    let inner = args.count("number of inner boundaries", 1)?;
    let outline = args.pointer("outer boundary")?;
    let mut loops = Vec::new();
    match outline.filter(|_| bounded) {
        Some(pointer) => {
            let result = curve_on_surface142::read(reader, pointer, &surface, own, LoopRole::Outer);
            keep(reader, opened.index, "outer boundary", result, &mut loops);
        }
        None => loops.extend(own_boundary(reader, &surface)),
    }
    for _ in 0..inner {
        if let Some(pointer) = args.pointer("inner boundary")? {
            let result = curve_on_surface142::read(reader, pointer, &surface, own, LoopRole::Inner);
            keep(reader, opened.index, "inner boundary", result, &mut loops);
        }
    }
    Ok((surface, loops))
}

/// Reads a bounded surface (143): like 144, but it does not say which boundary is the outer one.
pub(crate) fn read143(
    reader: &mut Reader<'_, '_>,
    opened: &mut Opened<'_>,
    outer: DAffine3,
) -> Result<Trimmed, EntityError> {
    let own = outer * transform124::transform(reader, opened.entry.transform, reader.millimetres())?;
    let args: &mut Args = &mut opened.args;
    args.skip(1); // which representations are there: the boundaries say so too
    let pointer = args.required("surface")?;
    let surface = surface::read(reader, pointer, own)?;
    let mut loops = Vec::new();
    for _ in 0..args.count("number of boundaries", 1)? {
        if let Some(pointer) = args.pointer("boundary")? {
            let result = boundary141::read(reader, pointer, &surface, own);
            keep(reader, opened.index, "boundary", result, &mut loops);
        }
    }
    Ok((surface, loops))
}

/// The curve that a plane (108, form 1) is bounded by itself.
pub(crate) fn own_boundary(reader: &mut Reader<'_, '_>, surface: &Surface) -> Option<RawLoop> {
    let (pointer, place) = surface.boundary?;
    let result = Segment::read(reader, surface.index, &[], Some(pointer), place)
        .and_then(|segment| boundary(reader, surface.index, surface, &[segment], LoopRole::Outer));
    let mut loops = Vec::new();
    keep(reader, surface.index, "bounding curve", result, &mut loops);
    loops.pop()
}

/// Holes in a plane: the bounding curves of other planes (108, form -1).
pub(crate) fn plane_holes(
    reader: &mut Reader<'_, '_>,
    surface: &Surface,
    holes: &[usize],
    outer: DAffine3,
) -> Vec<RawLoop> {
    let mut loops = Vec::new();
    for hole in holes {
        let result = reader.open(Store::number(*hole) as i64, "hole", |reader, mut opened| {
            let own = outer * transform124::transform(reader, opened.entry.transform, reader.millimetres())?;
            opened.args.skip(4); // the plane, which is the same
            let pointer = opened.args.required("bounding curve")?;
            let segment = Segment::read(reader, opened.index, &[], Some(pointer), own)?;
            boundary(reader, opened.index, surface, &[segment], LoopRole::Inner)
        });
        keep(reader, surface.index, "hole", result, &mut loops);
    }
    loops
}

fn keep(
    reader: &mut Reader<'_, '_>,
    index: usize,
    what: &str,
    result: Result<RawLoop, EntityError>,
    loops: &mut Vec<RawLoop>,
) {
    match result {
        Ok(l) => loops.push(l),
        Err(error) => {
            debug_assert!(index < reader.store.entries.len(), "{}", Store::number(index));
            reader.remark(index, Severity::Warning, format!("{what} left out: {error}"));
        }
    }
}
