//! Building the parity grid: purely combinatorial once the spans are known.
//!
//! Right of a cell's listed segments, the sum over all other segments is a step function of v inside
//! the row. Its steps at vertices cancel wherever both neighbours are right of the cell; a step stays only where a
//! listed segment meets one that is right of the cell, and that step goes into the listed one's
//! `lo` / `hi` bit. What remains is one number for the cell. No crossing is ever computed, and
//! the result equals the sum over all segments for any resolution.

use super::frame::Frame;
use super::layout::*;
use super::refine::{Listed, Refiner};
use super::span::{self, Span};
use crate::kernel::trim::pack::PackedSegments;
use crate::kernel::trim::segment::SegmentSet;

/// Choices of the build. The answers do not depend on them.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct GridOptions {
    /// Cells for each segment; `None`: 4, which keeps plain cubics within 60 bytes each.
    pub cells_per_segment: Option<f64>,
    /// Cells with more entries than this are refined.
    pub crowded: u32,
    /// Deepest nesting, 1 (never refine) to [`MAX_LEVELS`].
    pub levels: u32,
    /// Fill rule.
    pub rule: crate::kernel::trim::FillRule,
}

impl Default for GridOptions {
    fn default() -> Self {
        Self { cells_per_segment: None, crowded: 8, levels: MAX_LEVELS, rule: Default::default() }
    }
}

/// Cells and entries of a grid.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Built {
    /// Header with bases 0.
    pub header: GridHeader,
    /// Cell words.
    pub cells: Vec<u32>,
    /// Entry words.
    pub entries: Vec<u32>,
}

/// Cells for each segment unless told otherwise.
const CELLS_PER_SEGMENT: f64 = 4.0;
/// Most cells along one side of the outer block.
const MAX_SIDE: f64 = 4096.0;

/// Builds cells and entries for the segments of a face.
pub fn build(set: &SegmentSet, packed: &PackedSegments, options: &GridOptions) -> Built {
    if set.segments.is_empty() {
        return Built::default();
    }
    let header = header(set.segments.len(), options);
    let frame = Frame::outer(header.columns, header.rows);
    let spans = Spans::new(&frame, set, packed, |_| true);
    let lists = Lists::new(&frame, set, packed, &spans, |_| true);
    let mut built = Built { header, cells: Vec::new(), entries: Vec::new() };
    let mut refiner = Refiner::new(set, packed, options);
    refiner.write(&frame, lists, &mut built);
    built
}

/// Header of the grid of `count` segments.
pub(super) fn header(count: usize, options: &GridOptions) -> GridHeader {
    let per_segment = options.cells_per_segment.unwrap_or(CELLS_PER_SEGMENT);
    let side = (per_segment * count as f64).sqrt().round().clamp(1.0, MAX_SIDE) as u32;
    GridHeader {
        columns: side,
        rows: side,
        scale_u: side as f32,
        scale_v: side as f32,
        flags: if options.rule == crate::kernel::trim::FillRule::NonZero { FLAG_NON_ZERO } else { 0 },
        ..GridHeader::default()
    }
}

/// Spans of segments, row by row.
pub(super) struct Spans {
    spans: Vec<Span>,
    /// Of each segment: its first row and the position of the span in that row.
    rows: Vec<(i32, u32)>,
}

impl Spans {
    /// Spans of the segments in whose rows (first, last) `wanted` is interested.
    pub fn new(
        frame: &Frame,
        set: &SegmentSet,
        packed: &PackedSegments,
        wanted: impl Fn((i32, i32)) -> bool,
    ) -> Self {
        let count = set.segments.len();
        let mut result = Self { spans: Vec::with_capacity(2 * count), rows: Vec::with_capacity(count + 1) };
        for (segment, word) in set.segments.iter().zip(&packed.words) {
            let rows = span::rows(frame, segment);
            result.rows.push((rows.0, result.spans.len() as u32));
            if rows.0 <= rows.1 && wanted(rows) {
                span::append(frame, segment, *word, &packed.data, rows, &mut result.spans);
            }
        }
        result.rows.push((0, result.spans.len() as u32));
        result
    }

    /// Spans of a segment with their rows.
    fn of(&self, segment: usize) -> impl Iterator<Item = (i32, Span)> {
        let (row, first) = self.rows[segment];
        let end = self.rows[segment + 1].1;
        (row..).zip(self.spans[first as usize..end as usize].iter().copied())
    }

    /// Whether `segment`, which has a vertex in `row`, is entirely right of `column` there.
    fn right_of(&self, segment: u32, row: i32, column: i32) -> bool {
        let (first_row, first) = self.rows[segment as usize];
        self.spans[first as usize + (row - first_row) as usize].first > column
    }
}

/// Entry lists and winding numbers of the cells of one block.
pub(super) struct Lists {
    /// Of each cell: position of its first entry; one more at the end.
    pub first: Vec<u32>,
    /// Entries of all cells.
    pub entries: Vec<Listed>,
    /// Winding number of each cell.
    pub winding: Vec<i32>,
}

impl Lists {
    /// The lists of the `wanted` rows; `spans` has all segments that reach into these.
    pub fn new(
        frame: &Frame,
        set: &SegmentSet,
        packed: &PackedSegments,
        spans: &Spans,
        wanted: impl Fn(i32) -> bool,
    ) -> Self {
        let (columns, rows) = (frame.columns, frame.rows);
        let cells = (columns * rows) as usize;
        let mut first = vec![0u32; cells + 1];
        // right[row][c]: sum over segments of the row whose span starts at c and that pass its top.
        let stride = columns as usize + 1;
        let mut right = vec![0i32; stride * rows as usize];
        for (number, segment) in set.segments.iter().enumerate() {
            let top = frame.row(segment.ends[3]);
            let sign = if segment.down { -1 } else { 1 };
            for (row, span) in spans.of(number).filter(|(row, _)| wanted(*row)) {
                let base = (row * columns) as usize;
                for column in span.first.max(0)..=span.last.min(columns - 1) {
                    first[base + column as usize + 1] += 1;
                }
                if top > row && span.first > 0 {
                    right[row as usize * stride + span.first.min(columns) as usize] += sign;
                }
            }
        }
        for cell in 0..cells {
            first[cell + 1] += first[cell];
        }
        let mut winding = vec![0i32; cells];
        for row in 0..rows as usize {
            let mut sum = 0;
            for column in (0..columns as usize).rev() {
                sum += right[row * stride + column + 1];
                winding[row * columns as usize + column] = sum;
            }
        }
        let mut next = first.clone();
        let mut entries = vec![Listed::default(); first[cells] as usize];
        for (number, segment) in set.segments.iter().enumerate() {
            let (bottom, top) = (frame.row(segment.ends[1]), frame.row(segment.ends[3]));
            let sign = if segment.down { -1 } else { 1 };
            for (row, span) in spans.of(number).filter(|(row, _)| wanted(*row)) {
                for column in span.first.max(0)..=span.last.min(columns - 1) {
                    let cell = (row * columns + column) as usize;
                    let mut word = packed.words[number];
                    if row == bottom && spans.right_of(segment.below, row, column) {
                        word |= ENTRY_LO;
                    }
                    if row == top && spans.right_of(segment.above, row, column) {
                        word |= ENTRY_HI;
                        winding[cell] -= sign;
                    }
                    entries[next[cell] as usize] = Listed { segment: number as u32, word };
                    next[cell] += 1;
                }
            }
        }
        Self { first, entries, winding }
    }
}
