//! The parity grid: a uniform grid over the unit square in which every cell holds one winding number and a
//! short list of the segments that touch it. One read answers for an empty cell; the answer equals the
//! sum over all segments bit for bit at every resolution.

pub mod build;
pub mod classify;
pub mod frame;
pub mod layout;
mod leaves;
mod refine;
pub mod slab;
pub mod span;
pub mod update;

pub use build::GridOptions;
pub use classify::{classify, classify_listed};
pub use layout::{GridHeader, GridView};
pub use leaves::GridLeaf;
pub use update::SegmentEdit;

use glam::Vec2;

use super::TrimStructure;
use super::pack::PackedSegments;
use super::segment::SegmentSet;
use super::tally::Counters;

/// A face's grid with its segment records: all that a query reads.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct ParityGrid {
    /// Header, all bases 0.
    pub header: GridHeader,
    /// Cell words.
    pub cells: Vec<u32>,
    /// Entry words.
    pub entries: Vec<u32>,
    /// Segment records, 16-byte units.
    pub data: Vec<[u32; 4]>,
}

impl ParityGrid {
    /// Builds the grid of a face from its segments and their records.
    pub fn new(set: &SegmentSet, packed: &PackedSegments, options: &GridOptions) -> Self {
        Self::of(build::build(set, packed, options), packed)
    }

    /// The grid of an edited face; only rows that changed segments touch are built again. Equals
    /// [`Self::new`] bit for bit.
    pub fn after_edit(
        &self,
        set: &SegmentSet,
        packed: &PackedSegments,
        edit: &SegmentEdit,
        options: &GridOptions,
    ) -> Self {
        let before = (&self.header, &self.cells[..], &self.entries[..]);
        match update::update(before, set, packed, edit, options) {
            Some(built) => Self::of(built, packed),
            None => Self::new(set, packed, options),
        }
    }

    fn of(built: build::Built, packed: &PackedSegments) -> Self {
        Self { header: built.header, cells: built.cells, entries: built.entries, data: packed.data.clone() }
    }

    /// What [`classify()`] reads.
    pub fn view(&self) -> GridView<'_> {
        GridView { header: self.header, cells: &self.cells, entries: &self.entries, data: &self.data }
    }
}

impl TrimStructure for ParityGrid {
    fn classify(&self, uv: Vec2) -> bool {
        classify(&self.view(), uv.x, uv.y, &mut ())
    }

    fn classify_counted(&self, uv: Vec2, counters: &mut Counters) -> bool {
        classify(&self.view(), uv.x, uv.y, counters)
    }

    fn memory_bytes(&self) -> usize {
        size_of::<GridHeader>() + 4 * (self.cells.len() + self.entries.len()) + 16 * self.data.len()
    }
}

impl ParityGrid {
    /// Whether the box of some listed segment meets the rectangle `min..max` (normalised). Segments on
    /// the border of the unit square are in no list.
    pub fn has_segments(&self, min: Vec2, max: Vec2) -> bool {
        let header = &self.header;
        if header.columns == 0 {
            return false;
        }
        let index = |x: f32, scale: f32, count: u32| ((x.max(0.0) * scale) as u32).min(count - 1);
        let (c0, c1) =
            (index(min.x, header.scale_u, header.columns), index(max.x, header.scale_u, header.columns));
        let (r0, r1) = (index(min.y, header.scale_v, header.rows), index(max.y, header.scale_v, header.rows));
        (r0..=r1).any(|row| {
            (c0..=c1).any(|column| self.cell_meets((row * header.columns + column) as usize, min, max))
        })
    }

    fn cell_meets(&self, cell: usize, min: Vec2, max: Vec2) -> bool {
        if self.cells[cell] & layout::CELL_REFINED != 0 {
            return true;
        }
        let (first, end) =
            (self.cells[cell] >> layout::CELL_SHIFT, self.cells[cell + 1] >> layout::CELL_SHIFT);
        self.entries[first as usize..end as usize].iter().any(|entry| {
            let [u0, v0, u1, v1] = super::record::load(&self.data, (entry >> layout::ENTRY_SHIFT) as usize);
            u0.min(u1) <= max.x && u0.max(u1) >= min.x && v0 <= max.y && v1 >= min.y
        })
    }
}
