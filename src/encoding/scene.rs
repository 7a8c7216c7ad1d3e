//! A whole scene as flat arrays: what the GPU and its CPU twin read.
//!
//! Each face owns one range per array, so that adding, replacing or removing a face touches nothing else.

use std::collections::BTreeSet;
use std::ops::Range;

use super::arena::Arena;
use super::cell::Cell;
use super::face::FaceHeader;
use super::order::DrawOrder;
use super::tiling::{self, Before, PackedCells, Tiling};
use crate::kernel::bezier::BezierPatch;
use crate::kernel::face::{Face, UvRect};
use crate::kernel::trim::ParityGrid;
use crate::kernel::trim::grid::GridHeader;
use crate::kernel::view::Bounds;

/// Names a face of a [`PackedScene`]; also its slot in the face table.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub struct FaceSlot(pub u32);

/// What is packed of one face.
#[derive(Debug, Clone)]
pub struct FaceShape<'a> {
    /// Rational Bezier patches in native parameters; they may reach beyond the domain.
    pub patches: &'a [BezierPatch],
    /// Native parameters that the trim grid works on.
    pub domain: UvRect,
    /// Trim grid, `None` for an untrimmed face.
    pub grid: Option<&'a ParityGrid>,
    /// Linear RGB.
    pub colour: [f32; 3],
    /// Whether the outside is opposite to `du x dv`.
    pub reversed: bool,
}

#[derive(Debug, Clone)]
struct Entry {
    cells: Range<u32>,
    points: Range<u32>,
    trim_cells: Range<u32>,
    trim_entries: Range<u32>,
    trim_data: Range<u32>,
    bounds: Bounds,
    tiling: Tiling,
}

impl Entry {
    fn empty() -> Self {
        Self {
            cells: 0..0,
            points: 0..0,
            trim_cells: 0..0,
            trim_entries: 0..0,
            trim_data: 0..0,
            bounds: Bounds::EMPTY,
            tiling: Tiling::default(),
        }
    }
}

/// All faces packed for ray casting.
#[derive(Debug, Clone, Default)]
pub struct PackedScene {
    pub(crate) cells: Arena<Cell>,
    pub(crate) points: Arena<[f32; 4]>,
    pub(crate) trim_cells: Arena<u32>,
    pub(crate) trim_entries: Arena<u32>,
    pub(crate) trim_data: Arena<[u32; 4]>,
    pub(crate) faces: Arena<FaceHeader>,
    pub(crate) order: DrawOrder,
    entries: Vec<Option<Entry>>,
    /// Slots of `entries` without a face.
    vacant: BTreeSet<u32>,
    revision: u64,
}

/// Colour of faces whose file gives none.
pub const DEFAULT_COLOUR: [f32; 3] = [0.52, 0.55, 0.60];

impl<'a> FaceShape<'a> {
    /// What is packed of a derived face, in its own or the default colour.
    pub fn of(face: &'a Face, colour: Option<[f32; 3]>, reversed: bool) -> Self {
        let colour = colour.unwrap_or(DEFAULT_COLOUR);
        Self { patches: &face.patches, domain: face.domain, grid: Some(&face.grid), colour, reversed }
    }

    /// Cuts and packs the face: the dear part of adding it to a scene, for any thread. Colour and side do not matter.
    pub fn pack(&self) -> PackedCells {
        tiling::pack(self, 0, None)
    }
}

impl PackedScene {
    /// Packs faces of a model in order; slot `k` is face `k`.
    pub fn from_faces<'a>(shapes: impl IntoIterator<Item = FaceShape<'a>>) -> Self {
        let mut scene = Self::default();
        for shape in shapes {
            scene.add(&shape);
        }
        scene
    }

    /// Adds a face and says where it is.
    pub fn add(&mut self, shape: &FaceShape) -> FaceSlot {
        self.add_packed(shape, shape.pack())
    }

    /// The same for a face that was packed before by [`FaceShape::pack`].
    pub fn add_packed(&mut self, shape: &FaceShape, packed: PackedCells) -> FaceSlot {
        let slot = match self.vacant.pop_first() {
            Some(slot) => slot,
            None => {
                self.entries.push(None);
                self.faces.insert(&[bytemuck::Zeroable::zeroed()]).start
            }
        };
        self.place(slot, shape, FaceHeader::VISIBLE, Entry::empty(), packed);
        FaceSlot(slot)
    }

    /// Packs a face anew, keeping its slot, visibility and selection. What did not change is taken over as it
    /// is packed, and only words that differ count as changed.
    pub fn replace(&mut self, slot: FaceSlot, shape: &FaceShape) {
        let Some(flags) = self.header(slot).map(|h| h.flags) else { return };
        let before = self.entries[slot.0 as usize].take();
        self.fill(slot.0, shape, flags, before);
    }

    /// Takes a face out; its slot may be used again by a later face.
    pub fn remove(&mut self, slot: FaceSlot) {
        if let Some(entry) = self.entries.get_mut(slot.0 as usize).and_then(Option::take) {
            self.cells.remove(entry.cells);
            self.points.remove(entry.points);
            self.trim_cells.remove(entry.trim_cells);
            self.trim_entries.remove(entry.trim_entries);
            self.trim_data.remove(entry.trim_data);
            self.order.set(slot.0, 0..0);
            self.vacant.insert(slot.0);
            self.revision += 1;
        }
    }

    /// What shading knows of a face.
    pub fn header(&self, slot: FaceSlot) -> Option<&FaceHeader> {
        let live = self.entries.get(slot.0 as usize).is_some_and(Option::is_some);
        live.then(|| &self.faces.data()[slot.0 as usize])
    }

    /// Sets or clears bits such as [`FaceHeader::VISIBLE`] of a face.
    pub fn set_flag(&mut self, slot: FaceSlot, flag: u32, on: bool) {
        if let Some(header) = self.header(slot) {
            let mut header = *header;
            header.flags = if on { header.flags | flag } else { header.flags & !flag };
            if header != self.faces.data()[slot.0 as usize] {
                self.faces.set(slot.0, header);
                self.list_cells(slot.0);
                self.revision += 1;
            }
        }
    }

    /// Lists the cells of a face to be drawn, if it is to be.
    fn list_cells(&mut self, slot: u32) {
        let shown = self.faces.data()[slot as usize].flags & FaceHeader::VISIBLE != 0;
        let entry = self.entries[slot as usize].as_ref();
        let cells = entry.filter(|_| shown).map_or(0..0, |e| e.cells.clone());
        self.order.set(slot, cells);
    }

    /// Sets the colour of a face, linear RGB.
    pub fn set_colour(&mut self, slot: FaceSlot, colour: [f32; 3]) {
        if let Some(header) = self.header(slot) {
            self.faces.set(slot.0, FaceHeader { colour, ..*header });
            self.revision += 1;
        }
    }

    /// Slots in use, in order.
    pub fn slots(&self) -> impl Iterator<Item = FaceSlot> + '_ {
        self.entries.iter().enumerate().filter(|(_, e)| e.is_some()).map(|(k, _)| FaceSlot(k as u32))
    }

    /// Box around a face's cells.
    pub fn face_bounds(&self, slot: FaceSlot) -> Option<Bounds> {
        self.entries.get(slot.0 as usize)?.as_ref().map(|e| e.bounds)
    }

    /// Box around all faces.
    pub fn bounds(&self) -> Bounds {
        self.entries.iter().flatten().fold(Bounds::EMPTY, |b, e| b.union(e.bounds))
    }

    /// Cells in use, by position in the cell array, with those of hidden faces left out.
    pub fn visible_cells(&self) -> impl Iterator<Item = u32> + '_ {
        self.entries.iter().enumerate().flat_map(|(k, entry)| {
            let shown = self.faces.data()[k].flags & FaceHeader::VISIBLE != 0;
            entry.as_ref().filter(|_| shown).map_or(0..0, |e| e.cells.clone())
        })
    }

    /// Cells of one face, by position in the cell array; none while it is hidden.
    pub fn cells_of(&self, slot: FaceSlot) -> Range<u32> {
        let shown = self.header(slot).is_some_and(|h| h.flags & FaceHeader::VISIBLE != 0);
        let entry = self.entries.get(slot.0 as usize).and_then(Option::as_ref).filter(|_| shown);
        entry.map_or(0..0, |e| e.cells.clone())
    }

    /// All cells, free ones included.
    pub fn cell_data(&self) -> &[Cell] {
        self.cells.data()
    }

    /// All homogeneous control points, free ones included.
    pub fn point_data(&self) -> &[[f32; 4]] {
        self.points.data()
    }

    /// Number of cells and control points in use.
    pub fn counts(&self) -> (usize, usize) {
        (self.cells.live(), self.points.live())
    }

    /// Bytes in use.
    pub fn bytes(&self) -> usize {
        self.cells.live() * size_of::<Cell>()
            + 16 * (self.points.live() + self.trim_data.live())
            + 4 * (self.trim_cells.live() + self.trim_entries.live())
            + self.entries.len() * size_of::<FaceHeader>()
    }

    /// Marks everything as changed, so that the next upload sends it all: for a second device, or after the
    /// first was lost.
    pub fn touch_all(&mut self) {
        self.cells.touch_all();
        self.points.touch_all();
        self.faces.touch_all();
        self.trim_cells.touch_all();
        self.trim_entries.touch_all();
        self.trim_data.touch_all();
        self.order.words().touch_all();
    }

    /// Bytes that the next upload would send; afterwards nothing counts as changed.
    pub fn take_changed_bytes(&mut self) -> usize {
        fn taken<T: bytemuck::NoUninit>(arena: &mut Arena<T>) -> usize {
            arena.take_dirty().iter().map(|r| r.len() * size_of::<T>()).sum()
        }
        taken(&mut self.cells)
            + taken(&mut self.points)
            + taken(&mut self.faces)
            + taken(&mut self.trim_cells)
            + taken(&mut self.trim_entries)
            + taken(&mut self.trim_data)
            + taken(self.order.words())
    }

    /// Whether two faces, of this scene or of another one, are packed alike, wherever their ranges are.
    pub fn is_packed_like(&self, slot: FaceSlot, other: &Self, other_slot: FaceSlot) -> bool {
        let of = |scene: &Self, slot: FaceSlot| -> Option<Vec<u8>> {
            let e = scene.entries.get(slot.0 as usize)?.as_ref()?;
            fn words<'a, T: bytemuck::NoUninit>(arena: &'a Arena<T>, range: &Range<u32>) -> &'a [u8] {
                bytemuck::cast_slice(&arena.data()[range.start as usize..range.end as usize])
            }
            let mut header = scene.faces.data()[slot.0 as usize];
            header.grid.cell_base -= e.trim_cells.start;
            header.grid.entry_base -= e.trim_entries.start;
            header.grid.data_base -= e.trim_data.start;
            header.number -= slot.0;
            let mut all = bytemuck::bytes_of(&header).to_vec();
            for cell in &scene.cells.data()[e.cells.start as usize..e.cells.end as usize] {
                let (first_point, face) = (cell.first_point - e.points.start, cell.face - slot.0);
                all.extend_from_slice(bytemuck::bytes_of(&Cell { first_point, face, ..*cell }));
            }
            all.extend_from_slice(words(&scene.points, &e.points));
            all.extend_from_slice(words(&scene.trim_cells, &e.trim_cells));
            all.extend_from_slice(words(&scene.trim_entries, &e.trim_entries));
            all.extend_from_slice(words(&scene.trim_data, &e.trim_data));
            Some(all)
        };
        of(self, slot) == of(other, other_slot)
    }

    /// Elements in the arrays, and how many of them no face uses. The ranges of the faces and the free ones
    /// add up to all of it, or this is `None`.
    pub fn room(&self) -> Option<(usize, usize)> {
        fn add<'a, T: bytemuck::NoUninit>(
            arena: &Arena<T>,
            ranges: impl Iterator<Item = &'a Range<u32>>,
            total: (usize, usize),
        ) -> Option<(usize, usize)> {
            let mut all: Vec<Range<u32>> = ranges.filter(|r| !r.is_empty()).cloned().collect();
            all.extend(arena.free_ranges());
            all.sort_by_key(|r| r.start);
            let mut end = 0;
            for range in &all {
                if range.start != end {
                    return None;
                }
                end = range.end;
            }
            let size = arena.data().len();
            (end as usize == size).then(|| (total.0 + size, total.1 + size - arena.live()))
        }
        let live = || self.entries.iter().flatten();
        let total = add(&self.cells, live().map(|e| &e.cells), (0, 0))?;
        let total = add(&self.points, live().map(|e| &e.points), total)?;
        let total = add(&self.trim_cells, live().map(|e| &e.trim_cells), total)?;
        let total = add(&self.trim_entries, live().map(|e| &e.trim_entries), total)?;
        add(&self.trim_data, live().map(|e| &e.trim_data), total)
    }

    /// Grows with every change; equal numbers mean nothing changed.
    pub fn revision(&self) -> u64 {
        self.revision
    }

    fn fill(&mut self, slot: u32, shape: &FaceShape, flags: u32, before: Option<Entry>) {
        let packed = {
            let before = before.as_ref().map(|e| Before {
                tiling: &e.tiling,
                cells: &self.cells.data()[e.cells.start as usize..e.cells.end as usize],
                points: &self.points.data()[e.points.start as usize..e.points.end as usize],
                first_point: e.points.start,
            });
            tiling::pack(shape, slot, before)
        };
        self.place(slot, shape, flags, before.unwrap_or_else(Entry::empty), packed);
    }

    /// Puts the packed cells of a face, of any slot, where those of `old` are.
    fn place(&mut self, slot: u32, shape: &FaceShape, flags: u32, old: Entry, packed: PackedCells) {
        let PackedCells { mut cells, points, bounds, tiling } = packed;
        let points = self.points.replace(old.points, &points);
        cells.iter_mut().for_each(|c| {
            c.first_point += points.start;
            c.face = slot;
        });
        let cells = self.cells.replace(old.cells, &cells);
        let untrimmed = ParityGrid::default();
        let grid = shape.grid.unwrap_or(&untrimmed);
        let trim_cells = self.trim_cells.replace(old.trim_cells, &grid.cells);
        let trim_entries = self.trim_entries.replace(old.trim_entries, &grid.entries);
        let trim_data = self.trim_data.replace(old.trim_data, &grid.data);
        let mut flags = flags & !(FaceHeader::REVERSED | FaceHeader::TRIMMED);
        flags |= if shape.reversed { FaceHeader::REVERSED } else { 0 };
        flags |= if shape.grid.is_some() { FaceHeader::TRIMMED } else { 0 };
        let header = FaceHeader {
            colour: shape.colour,
            flags,
            number: slot,
            pad: [0; 3],
            grid: GridHeader {
                cell_base: grid.header.cell_base + trim_cells.start,
                entry_base: grid.header.entry_base + trim_entries.start,
                data_base: grid.header.data_base + trim_data.start,
                ..grid.header
            },
        };
        if self.faces.data()[slot as usize] != header {
            self.faces.set(slot, header);
        }
        self.entries[slot as usize] =
            Some(Entry { cells, points, trim_cells, trim_entries, trim_data, bounds, tiling });
        self.list_cells(slot);
        self.revision += 1;
    }
}
