//! The parity grid for questions on the processor: coarser cells, each with a slab that decides most of its points
//! by one read.
//!
//! Takes no more memory than the default grid, is built in the same time, and answers as it does bit for bit. The slab of a
//! cell is made when the cell was asked [`MOST_ASKED`] times: by then as much was spent on asking without it. Until
//! then its coarser cells answer slower than the default grid; many questions are answered in about half the time. Who
//! will ask everywhere makes all slabs at once ([`SlabGrid::complete`]). Threads may ask at once: they make the same
//! words, in whatever order.

use std::sync::atomic::{AtomicU32, Ordering};

use glam::Vec2;

use super::grid::slab::{MOST_ASKED, asked, decide, place, slab, unmade};
use super::grid::{GridOptions, classify};
use super::pack::PackedSegments;
use super::segment::SegmentSet;
use super::tally::{Counters, Tally};
use super::{ParityGrid, TrimStructure};

/// Cells for each segment: with a word more for each, as many bytes as the default grid.
const CELLS_PER_SEGMENT: f64 = 2.0;

/// A parity grid with slabs.
#[derive(Debug, Default)]
pub struct SlabGrid {
    grid: ParityGrid,
    /// One word for each cell of the outer block.
    slabs: Vec<AtomicU32>,
}

impl SlabGrid {
    /// Builds the structure of a face from its segments and their records.
    pub fn new(set: &SegmentSet, packed: &PackedSegments, options: &GridOptions) -> Self {
        let cells_per_segment = options.cells_per_segment.or(Some(CELLS_PER_SEGMENT));
        Self::over(ParityGrid::new(set, packed, &GridOptions { cells_per_segment, ..*options }))
    }

    /// Lays slabs over a grid.
    pub fn over(grid: ParityGrid) -> Self {
        let cells = grid.header.columns as usize * grid.header.rows as usize;
        let slabs = (0..cells).map(|_| AtomicU32::new(unmade(1))).collect();
        Self { grid, slabs }
    }

    /// Makes all slabs now, for a face that will be asked everywhere.
    pub fn complete(&self) {
        let columns = self.grid.header.columns as usize;
        for (k, word) in self.slabs.iter().enumerate() {
            let cell = [(k % columns) as u32, (k / columns) as u32];
            if asked(word.load(Ordering::Relaxed)).is_some() {
                word.store(slab(&self.grid, cell), Ordering::Relaxed);
            }
        }
    }

    /// The grid below the slabs.
    pub fn grid(&self) -> &ParityGrid {
        &self.grid
    }

    #[inline]
    fn ask(&self, uv: Vec2, tally: &mut impl Tally) -> bool {
        // Bits of a number in [0, 1) are below those of 1; the border is left to the grid.
        const ONE: u32 = 1.0f32.to_bits();
        if uv.x.to_bits().max(uv.y.to_bits()) < ONE {
            let header = &self.grid.header;
            let ((column, x), (row, y)) = (place(uv.x, header.scale_u), place(uv.y, header.scale_v));
            if let Some(slab) = self.slabs.get((row * header.columns + column) as usize) {
                let word = slab.load(Ordering::Relaxed);
                return match decide(word, x, y) {
                    Some(inside) => inside,
                    None => self.ask_cell(uv, [column, row], word, slab, tally),
                };
            }
        }
        self.ask_grid(uv, tally)
    }

    /// A question that the slab of its cell, `word`, did not decide.
    #[inline(never)]
    fn ask_cell(
        &self,
        uv: Vec2,
        cell: [u32; 2],
        word: u32,
        kept: &AtomicU32,
        tally: &mut impl Tally,
    ) -> bool {
        if let Some(times) = asked(word) {
            let next = if times < MOST_ASKED { unmade(times + 1) } else { slab(&self.grid, cell) };
            kept.store(next, Ordering::Relaxed);
        }
        classify(&self.grid.view(), uv.x, uv.y, tally)
    }

    #[inline(never)]
    fn ask_grid(&self, uv: Vec2, tally: &mut impl Tally) -> bool {
        classify(&self.grid.view(), uv.x, uv.y, tally)
    }
}

impl TrimStructure for SlabGrid {
    #[inline]
    fn classify(&self, uv: Vec2) -> bool {
        self.ask(uv, &mut ())
    }

    fn classify_counted(&self, uv: Vec2, counters: &mut Counters) -> bool {
        self.ask(uv, counters)
    }

    fn memory_bytes(&self) -> usize {
        self.grid.memory_bytes() + 4 * self.slabs.len()
    }
}
