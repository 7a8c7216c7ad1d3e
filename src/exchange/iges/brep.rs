//! Faces of boundary representations (510) with their loops (508), edges (504) and vertices (502).

use glam::DAffine3;

use super::error::EntityError;
use super::point116::expect;
use super::segment::{Segment, boundary};
use super::store::{Opened, Reader};
use super::surface;
use super::transform124;
use super::trimmed144::Trimmed;
use crate::exchange::boundary::RawLoop;
use crate::exchange::report::Severity;
use crate::scene::records::LoopRole;

/// Reads a face (510).
pub(crate) fn read510(
    reader: &mut Reader<'_, '_>,
    opened: &mut Opened<'_>,
    outer: DAffine3,
) -> Result<Trimmed, EntityError> {
    let own = outer * transform124::transform(reader, opened.entry.transform, reader.millimetres())?;
    let pointer = opened.args.required("surface")?;
    let surface = surface::read(reader, pointer, own)?;
    let count = opened.args.count("number of loops", 1)?;
    let first_is_outer = opened.args.integer_or("outer loop flag", 0)? == 1;
    let mut loops = Vec::new();
    for k in 0..count {
        let Some(pointer) = opened.args.pointer("loop")? else { continue };
        let role = match (first_is_outer, k) {
            (true, 0) => LoopRole::Outer,
            (true, _) => LoopRole::Inner,
            (false, _) => LoopRole::Unknown,
        };
        match read508(reader, pointer, &surface, own, role) {
            Ok(l) => loops.extend(l),
            Err(error) => reader.remark(opened.index, Severity::Warning, format!("loop left out: {error}")),
        }
    }
    Ok((surface, loops))
}

/// Reads a loop (508); `None` for one that is a single vertex.
fn read508(
    reader: &mut Reader<'_, '_>,
    pointer: i64,
    surface: &surface::Surface,
    outer: DAffine3,
    role: LoopRole,
) -> Result<Option<RawLoop>, EntityError> {
    reader.open(pointer, "loop", |reader, mut opened| {
        expect(opened.entry.kind, 508, "a loop (508)", pointer)?;
        let args = &mut opened.args;
        let mut segments = Vec::new();
        for _ in 0..args.count("number of edges", 5)? {
            let is_vertex = args.integer_or("kind of edge", 0)? == 1;
            let list = args.required("edge or vertex list")?;
            let place = args.integer_or("index in the list", 1)?;
            let forward = args.integer_or("orientation", 1)? != 0;
            let mut uv = Vec::new();
            for _ in 0..args.count("number of parameter curves", 2)? {
                args.skip(1); // isoparametric or not
                uv.extend(args.pointer("parameter curve")?);
            }
            if is_vertex {
                // A pole: only its pcurve says something.
                if !uv.is_empty() {
                    segments.extend(Segment::read(reader, opened.index, &uv, None, outer).ok());
                }
                continue;
            }
            let curve = edge(reader, list, place)?;
            let mut segment = Segment::read(reader, opened.index, &uv, Some(curve), outer)?;
            if !forward {
                segment.reverse_space();
            }
            segment.edge = reader.edge(list, place);
            segments.push(segment);
        }
        if segments.iter().all(|s| s.space.is_empty()) {
            return Ok(None);
        }
        boundary(reader, opened.index, surface, &segments, role).map(Some)
    })
}

/// The curve of edge number `place` (from 1) of an edge list (504).
fn edge(reader: &mut Reader<'_, '_>, list: i64, place: i64) -> Result<i64, EntityError> {
    let store = reader.store;
    let index = store.index(list, "edge list")?;
    let curves = store.edge_list(index, || {
        reader.open(list, "edge list", |_, mut opened| {
            expect(opened.entry.kind, 504, "an edge list (504)", list)?;
            let count = opened.args.count("number of edges", 5)?;
            let mut curves = Vec::with_capacity(count);
            for _ in 0..count {
                curves.push(opened.args.pointer("curve of the edge")?.unwrap_or(0));
                opened.args.skip(4); // vertices: the ends of the curve are as good
            }
            Ok(curves)
        })
    })?;
    let curve = usize::try_from(place).ok().and_then(|p| curves.get(p.checked_sub(1)?)).copied();
    curve.filter(|c| *c != 0).ok_or_else(|| {
        EntityError::Degenerate(format!("edge {place} of a list of {} has no curve", curves.len()))
    })
}
