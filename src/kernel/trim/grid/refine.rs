//! Crowded cells get a block of smaller cells of their own.
//!
//! A child block knows the rest of the face only through its parent cell: the parent's winding number and the
//! `lo` / `hi` bits of the parent's entries say what lies right of the parent cell at any height. Inside,
//! the same rule as for the outer block decides bits and numbers; a neighbour that the parent
//! does not list keeps the parent's bit.

use std::ops::Range;

use super::build::{Built, GridOptions, Lists};
use super::frame::Frame;
use super::layout::*;
use super::span::{self, Span};
use crate::kernel::trim::pack::{Move, PackedSegments};
use crate::kernel::trim::segment::SegmentSet;

/// A segment in the list of a cell.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq)]
pub(super) struct Listed {
    /// Number of the segment.
    pub segment: u32,
    /// Entry word.
    pub word: u32,
}

/// Cells are not made smaller than this: positions in f32 would not tell them apart.
const SMALLEST_CELL: f64 = 2e-5;
/// Largest child block, cells along one side.
const MAX_CHILD: f64 = 16.0;
/// A child block may take this many words for each entry of its parent: refining is for many small
/// segments in one cell, not for long strands side by side, which every child row would list again.
const WORDS_PER_ENTRY: usize = 4;

/// Writes blocks, refining where it pays.
pub(super) struct Refiner<'a> {
    set: &'a SegmentSet,
    packed: &'a PackedSegments,
    options: &'a GridOptions,
    /// Blocks still to be written: the entry word that will hold their place, and what is in them.
    waiting: Vec<(usize, Block)>,
    /// Where blocks that an edit left alone are copied from.
    source: Option<Source<'a>>,
}

/// A block to be written.
enum Block {
    /// From its lists.
    Listed(Frame, Lists),
    /// As in the source: index of its first cell there, and its k.
    Copied(usize, u32),
}

/// The grid before an edit.
#[derive(Clone, Copy)]
pub(super) struct Source<'a> {
    /// Its cell words.
    pub cells: &'a [u32],
    /// Its entry words.
    pub entries: &'a [u32],
    /// Where records went since.
    pub moves: &'a [Move],
}

impl<'a> Refiner<'a> {
    pub fn new(set: &'a SegmentSet, packed: &'a PackedSegments, options: &'a GridOptions) -> Self {
        Self { set, packed, options, waiting: Vec::new(), source: None }
    }

    /// Writes the outer block and everything below it.
    pub fn write(&mut self, frame: &Frame, lists: Lists, built: &mut Built) {
        self.listed(frame, &lists, 0..lists.winding.len(), built);
        self.finish(built);
    }

    /// The same with the rows that are not `touched` as in `source`.
    pub fn rewrite(
        &mut self,
        frame: &Frame,
        lists: Lists,
        touched: &[bool],
        source: Source<'a>,
        built: &mut Built,
    ) {
        self.source = Some(source);
        let columns = frame.columns as usize;
        for (row, touched) in touched.iter().enumerate() {
            let cells = row * columns..(row + 1) * columns;
            if *touched {
                self.listed(frame, &lists, cells, built);
            } else {
                self.copied(source, cells, built);
            }
        }
        self.finish(built);
    }

    /// Ends the outer block and writes those that wait.
    fn finish(&mut self, built: &mut Built) {
        built.cells.push(cell_word(built.entries.len() as u32, false, 0));
        while let Some((slot, block)) = self.waiting.pop() {
            built.entries[slot] = built.cells.len() as u32;
            match (block, self.source) {
                (Block::Listed(frame, lists), _) => {
                    self.listed(&frame, &lists, 0..lists.winding.len(), built);
                }
                (Block::Copied(first, k), Some(source)) => {
                    self.copied(source, first..first + (k * k) as usize, built);
                }
                (Block::Copied(..), None) => {}
            }
            built.cells.push(cell_word(built.entries.len() as u32, false, 0));
        }
    }

    /// Writes cells as they are in `source`.
    fn copied(&mut self, source: Source, cells: Range<usize>, built: &mut Built) {
        for index in cells {
            let word = source.cells[index];
            let first = (word >> CELL_SHIFT) as usize;
            let place = built.entries.len();
            built.cells.push((place as u32) << CELL_SHIFT | word & ((1 << CELL_SHIFT) - 1));
            if word & CELL_REFINED != 0 {
                let (child, k) = (source.entries[first] as usize, source.entries[first + 1]);
                built.entries.extend([0, k]);
                self.waiting.push((place, Block::Copied(child, k)));
            } else {
                let end = (source.cells[index + 1] >> CELL_SHIFT) as usize;
                built.entries.extend(source.entries[first..end].iter().map(|e| moved(*e, source.moves)));
            }
        }
    }

    fn listed(&mut self, frame: &Frame, lists: &Lists, cells: Range<usize>, built: &mut Built) {
        for cell in cells {
            let entries = &lists.entries[lists.first[cell] as usize..lists.first[cell + 1] as usize];
            let place = built.entries.len();
            let child = self.child(frame, cell as i32, entries, lists.winding[cell]);
            built.cells.push(cell_word(place as u32, child.is_some(), lists.winding[cell]));
            match child {
                Some((child_frame, child_lists)) => {
                    built.entries.extend([0, child_frame.columns as u32]);
                    self.waiting.push((place, Block::Listed(child_frame, child_lists)));
                }
                None => built.entries.extend(entries.iter().map(|e| e.word)),
            }
        }
    }

    /// The child block of a cell, if the cell is crowded and a block would thin its list out.
    fn child(&self, frame: &Frame, cell: i32, entries: &[Listed], winding: i32) -> Option<(Frame, Lists)> {
        let count = entries.len();
        if count <= self.options.crowded as usize || frame.level() >= self.options.levels.min(MAX_LEVELS) {
            return None;
        }
        let k = (count as f64).sqrt().ceil().clamp(2.0, MAX_CHILD) as u32;
        if frame.cell_size() / f64::from(k) < SMALLEST_CELL {
            return None;
        }
        let child = frame.child(cell % frame.columns, cell / frame.columns, k);
        let cells = (k * k) as usize;
        // Each entry will be listed about once in every row that it passes: tells strands early.
        let passed = |e: &Listed| {
            let rows = span::rows(&child, &self.set.segments[e.segment as usize]);
            (rows.1 - rows.0 + 1).max(0) as usize
        };
        if cells + entries.iter().map(passed).sum::<usize>() > WORDS_PER_ENTRY * count {
            return None;
        }
        let members: Vec<Member> =
            entries.iter().map(|e| Member::new(&child, e, self.set, self.packed)).collect();
        let listed: usize = members.iter().map(|m| m.cells(child.columns)).sum();
        let thins_out = 2 * listed <= count * cells && cells + listed <= WORDS_PER_ENTRY * count;
        thins_out.then(|| (child.clone(), self.child_lists(&child, entries, &members, winding)))
    }

    fn child_lists(&self, frame: &Frame, parent: &[Listed], members: &[Member], winding: i32) -> Lists {
        let (columns, rows) = (frame.columns, frame.rows);
        let member_of = |segment: u32| {
            // Entries stand in the order of their segments.
            parent.binary_search_by_key(&segment, |e| e.segment).ok().map(|i| &members[i])
        };
        let mut lists = Lists { first: vec![0], entries: Vec::new(), winding: Vec::new() };
        for row in 0..rows {
            let outside: i32 = winding + members.iter().map(|m| m.beyond(row)).sum::<i32>();
            for column in 0..columns {
                let mut number = outside;
                for (member, entry) in members.iter().zip(parent) {
                    let Some(span) = member.span(row) else { continue };
                    if span.first > column {
                        number += if member.top > row { member.sign } else { 0 };
                        continue;
                    }
                    if span.last < column {
                        continue;
                    }
                    let segment = &self.set.segments[entry.segment as usize];
                    let bit =
                        |neighbour: u32, inherited: bool| match member_of(neighbour).map(|m| m.span(row)) {
                            Some(Some(span)) => span.first > column,
                            _ => inherited,
                        };
                    let mut word = entry.word & !(ENTRY_LO | ENTRY_HI);
                    if member.bottom == row && bit(segment.below, member.lo) {
                        word |= ENTRY_LO;
                    }
                    if member.top == row && bit(segment.above, member.hi) {
                        word |= ENTRY_HI;
                        number -= member.sign;
                    }
                    lists.entries.push(Listed { segment: entry.segment, word });
                }
                lists.winding.push(number);
                lists.first.push(lists.entries.len() as u32);
            }
        }
        lists
    }
}

/// An entry word with the address that its record has after `moves`.
fn moved(entry: u32, moves: &[Move]) -> u32 {
    let address = entry >> ENTRY_SHIFT;
    let last = moves.iter().rev().find(|m| m.from <= address);
    entry.wrapping_add(last.map_or(0, |m| m.by) << ENTRY_SHIFT)
}

/// An entry of the parent, placed in the child block.
struct Member {
    sign: i32,
    lo: bool,
    hi: bool,
    /// Rows of its ends in the child block, -1 below and `rows` above it.
    bottom: i32,
    top: i32,
    first_row: i32,
    spans: Vec<Span>,
}

impl Member {
    fn new(frame: &Frame, entry: &Listed, set: &SegmentSet, packed: &PackedSegments) -> Self {
        let segment = &set.segments[entry.segment as usize];
        let rows = span::rows(frame, segment);
        let mut spans = Vec::new();
        if rows.0 <= rows.1 {
            span::append(
                frame,
                segment,
                packed.words[entry.segment as usize],
                &packed.data,
                rows,
                &mut spans,
            );
        }
        Self {
            sign: if segment.down { -1 } else { 1 },
            lo: entry.word & ENTRY_LO != 0,
            hi: entry.word & ENTRY_HI != 0,
            bottom: frame.row(segment.ends[1]),
            top: frame.row(segment.ends[3]),
            first_row: rows.0,
            spans,
        }
    }

    fn span(&self, row: i32) -> Option<Span> {
        usize::try_from(row - self.first_row).ok().and_then(|i| self.spans.get(i)).copied()
    }

    /// Number of cells that list it.
    fn cells(&self, columns: i32) -> usize {
        let cells = |s: &Span| (s.last.min(columns - 1) - s.first.max(0) + 1).max(0) as usize;
        self.spans.iter().map(cells).sum()
    }

    /// Its share of what lies right of the parent cell, at the top of `row`.
    fn beyond(&self, row: i32) -> i32 {
        let bit = if self.bottom > row { self.lo } else { self.top <= row && self.hi };
        if bit { self.sign } else { 0 }
    }
}
