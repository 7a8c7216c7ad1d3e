//! The parity grid for many questions on the processor: coarser cells, each with a slab that decides most of its
//! points by one read.
//!
//! Takes no more memory than the default grid, answers as it does bit for bit, and costs a few times its build:
//! worth it from some ten thousand points a face on.

use glam::Vec2;

use super::grid::slab::{decide, place, slabs};
use super::grid::{GridOptions, classify};
use super::pack::PackedSegments;
use super::segment::SegmentSet;
use super::tally::{Counters, Tally};
use super::{ParityGrid, TrimStructure};

/// Cells for each segment: with a word more for each, as many bytes as the default grid.
const CELLS_PER_SEGMENT: f64 = 2.0;

/// A parity grid with slabs.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct SlabGrid {
    grid: ParityGrid,
    /// One word for each cell of the outer block.
    slabs: Vec<u32>,
}

impl SlabGrid {
    /// Builds the structure of a face from its segments and their records.
    pub fn new(set: &SegmentSet, packed: &PackedSegments, options: &GridOptions) -> Self {
        let cells_per_segment = options.cells_per_segment.or(Some(CELLS_PER_SEGMENT));
        Self::over(ParityGrid::new(set, packed, &GridOptions { cells_per_segment, ..*options }))
    }

    /// Lays slabs over a grid.
    pub fn over(grid: ParityGrid) -> Self {
        let slabs = slabs(&grid);
        Self { grid, slabs }
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
            let word = self.slabs.get((row * header.columns + column) as usize);
            if let Some(inside) = word.and_then(|word| decide(*word, x, y)) {
                return inside;
            }
        }
        self.ask_grid(uv, tally)
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
