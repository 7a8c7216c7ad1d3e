//! The parity grid after an edit: only the rows that changed segments touch are built again.
//!
//! What a row holds depends on the segments that reach into it and on nothing else, and a changed segment
//! shares its end vertices, so their rows, with its neighbours. All other rows are copied with the new
//! addresses of their records. Invariant: the result equals [`super::build::build`] bit for bit.

use super::build::{Built, GridOptions, Lists, Spans, header};
use super::frame::Frame;
use super::layout::GridHeader;
use super::refine::{Refiner, Source};
use super::span;
use crate::kernel::trim::pack::{Move, PackedSegments};
use crate::kernel::trim::resume::Splice;
use crate::kernel::trim::segment::SegmentSet;

/// What an edit did to the segments of a face.
#[derive(Debug, Clone, Copy)]
pub struct SegmentEdit<'a> {
    /// Segments before the edit.
    pub before: &'a SegmentSet,
    /// Positions of those replaced, before and after it.
    pub splices: &'a [Splice],
    /// Where the records of the others went.
    pub moves: &'a [Move],
}

/// More than this part of all rows touched: building anew is no slower.
const MOST_ROWS: f64 = 0.5;

/// The cells and entries of `before` changed to those of `set`; `None` when little of it could stay.
pub(super) fn update(
    (old_header, cells, entries): (&GridHeader, &[u32], &[u32]),
    set: &SegmentSet,
    packed: &PackedSegments,
    edit: &SegmentEdit,
    options: &GridOptions,
) -> Option<Built> {
    let header = header(set.segments.len(), options);
    if set.segments.is_empty() || *old_header != header {
        return None;
    }
    let frame = Frame::outer(header.columns, header.rows);
    let mut touched = vec![false; header.rows as usize];
    for splice in edit.splices {
        let replaced = &edit.before.segments[splice.before.clone()];
        for segment in replaced.iter().chain(&set.segments[splice.after.clone()]) {
            let (first, last) = span::rows(&frame, segment);
            (first..=last).for_each(|row| touched[row as usize] = true);
        }
    }
    let mut below = vec![0u32; touched.len() + 1];
    for (row, touched) in touched.iter().enumerate() {
        below[row + 1] = below[row] + u32::from(*touched);
    }
    if f64::from(below[touched.len()]) > MOST_ROWS * f64::from(header.rows) {
        return None;
    }
    let reaches = |(first, last): (i32, i32)| below[last as usize + 1] > below[first as usize];
    let spans = Spans::new(&frame, set, packed, reaches);
    let lists = Lists::new(&frame, set, packed, &spans, |row| touched[row as usize]);
    let mut built = Built {
        header,
        cells: Vec::with_capacity(cells.len() + cells.len() / 16),
        entries: Vec::with_capacity(entries.len() + entries.len() / 16),
    };
    let source = Source { cells, entries, moves: edit.moves };
    Refiner::new(set, packed, options).rewrite(&frame, lists, &touched, source, &mut built);
    Some(built)
}
