//! `hairline bench build`: microseconds and bytes for making the trimming structures.

use std::io::{self, Write};

use super::shapes::Shape;
use super::sheet::{Sheet, fastest, number};
use crate::kernel::trim::grid::GridOptions;
use crate::kernel::trim::pack::PackedSegments;
use crate::kernel::trim::{
    FillRule, IntervalLists, ParityGrid, PieceList, SegmentSet, SlabGrid, TrimStructure,
};
use crate::scene::records::{FaceRecord, ModelRecord};

/// P1's structure is not built beyond this many clipped curves.
const MOST_CLIPPED: usize = 500_000;

/// Prints the table of the shapes, then a line for each of `models`.
///
/// # Errors
/// `out` cannot be written.
pub fn run(models: &[ModelRecord], out: &mut impl Write) -> io::Result<()> {
    let mut sheet = Sheet::new(
        "Building, one thread, fastest of several runs. Split: us per curve; records, grid, slabs, P1: us per segment\n\
         (a slab is made when its cell is asked often; `all slabs` is what making every one would add)",
        &[
            "shape",
            "curves",
            "segments",
            "split",
            "records",
            "grid",
            "records+grid",
            "slabs",
            "all slabs",
            "P1",
            "B/segment",
            "slabs B/segment",
            "P1 B/segment",
            "P1 clipped",
        ],
    );
    for shape in [Shape::Holes, Shape::RationalHoles, Shape::Blob, Shape::Hair] {
        for curves in [12, 100, 1000, 10_000, 100_000] {
            sheet.row(shape_row(shape, curves));
        }
    }
    writeln!(out, "{sheet}")?;
    for model in models {
        let seconds = fastest(3, || model.faces.iter().map(FaceRecord::derive).filter(Result::is_ok).count());
        let parallel = fastest(3, || model.derive_all().len());
        writeln!(
            out,
            "{}: {} faces derived (patches, loops, grids) in {:.2} ms on one thread, {:.2} ms on all",
            model.name,
            model.faces.len(),
            1e3 * seconds,
            1e3 * parallel
        )?;
    }
    Ok(())
}

fn shape_row(shape: Shape, curves: usize) -> Vec<String> {
    let loops = shape.loops(curves);
    let given: usize = loops.iter().map(Vec::len).sum();
    let runs = (50_000 / curves).clamp(3, 200);
    let split = fastest(runs, || PieceList::from_loops(&loops, 1e-9));
    let pieces = PieceList::from_loops(&loops, 1e-9);
    let make = || {
        let set = SegmentSet::new(&pieces);
        let packed = PackedSegments::new(&pieces, &set);
        (set, packed)
    };
    let records = fastest(runs, make);
    let (set, packed) = make();
    let Ok(packed) = packed else { return vec![format!("{} {curves}: too many segments", shape.name())] };
    let options = GridOptions::default();
    let grid_time = fastest(runs, || ParityGrid::new(&set, &packed, &options));
    let grid = ParityGrid::new(&set, &packed, &options);
    let slabs_time = fastest(runs, || SlabGrid::new(&set, &packed, &options));
    let slabs = SlabGrid::new(&set, &packed, &options);
    let fresh =
        std::cell::RefCell::new((0..runs).map(|_| SlabGrid::over(slabs.grid().clone())).collect::<Vec<_>>());
    let all_slabs = fastest(runs, || fresh.borrow_mut().pop().map(|slabs| slabs.complete()));
    let clipped = IntervalLists::count_clipped(&set);
    let bounded = || IntervalLists::bounded(&pieces, &set, FillRule::EvenOdd, MOST_CLIPPED);
    let lists = bounded();
    let lists_time = lists.as_ref().map(|_| fastest(runs.min(3), bounded));
    let segments = set.segments.len() as f64;
    let us = |seconds: f64, per: f64| number(Some(1e6 * seconds / per));
    vec![
        shape.name().to_owned(),
        given.to_string(),
        set.segments.len().to_string(),
        us(split, given as f64),
        us(records, segments),
        us(grid_time, segments),
        us(records + grid_time, segments),
        us(slabs_time, segments),
        us(all_slabs, segments),
        number(lists_time.map(|t| 1e6 * t / segments)),
        number(Some(grid.memory_bytes() as f64 / segments)),
        number(Some(slabs.memory_bytes() as f64 / segments)),
        number(lists.map(|l| l.memory_bytes() as f64 / segments)),
        number(Some(clipped as f64 / segments)),
    ]
}
