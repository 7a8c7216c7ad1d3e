//! A whole scene as flat arrays: what the GPU and its CPU twin read.
//!
//! Each face owns one range per array, so that adding, replacing or removing a face touches nothing else.

use std::ops::Range;

use glam::{DVec2, DVec3};

use super::arena::Arena;
use super::cell::{self, Cell};
use super::coverage::{Coverage, coverage};
use super::face::FaceHeader;
use super::subdivision;
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
    entries: Vec<Option<Entry>>,
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
        let slot = match self.entries.iter().position(Option::is_none) {
            Some(slot) => slot as u32,
            None => {
                self.entries.push(None);
                self.faces.insert(&[bytemuck::Zeroable::zeroed()]).start
            }
        };
        self.fill(slot, shape, FaceHeader::VISIBLE);
        FaceSlot(slot)
    }

    /// Packs a face anew, keeping its slot, visibility and selection.
    pub fn replace(&mut self, slot: FaceSlot, shape: &FaceShape) {
        let flags = self.header(slot).map_or(FaceHeader::VISIBLE, |h| h.flags & !FaceHeader::REVERSED);
        self.release(slot);
        if (slot.0 as usize) < self.entries.len() {
            self.fill(slot.0, shape, flags);
        }
    }

    /// Takes a face out; its slot may be used again by a later face.
    pub fn remove(&mut self, slot: FaceSlot) {
        self.release(slot);
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
                self.revision += 1;
            }
        }
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
    }

    /// Grows with every change; equal numbers mean nothing changed.
    pub fn revision(&self) -> u64 {
        self.revision
    }

    fn fill(&mut self, slot: u32, shape: &FaceShape, flags: u32) {
        let (mut cells, mut points) = (Vec::new(), Vec::new());
        let mut bounds = Bounds::EMPTY;
        for patch in shape.patches {
            pack_patch(patch, shape, slot, &mut cells, &mut points, &mut bounds);
        }
        let points = self.points.insert(&points);
        cells.iter_mut().for_each(|c: &mut Cell| c.first_point += points.start);
        let cells = self.cells.insert(&cells);
        let empty = ParityGrid::default();
        let grid = shape.grid.unwrap_or(&empty);
        let trim_cells = self.trim_cells.insert(&grid.cells);
        let trim_entries = self.trim_entries.insert(&grid.entries);
        let trim_data = self.trim_data.insert(&grid.data);
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
        self.faces.set(slot, header);
        self.entries[slot as usize] =
            Some(Entry { cells, points, trim_cells, trim_entries, trim_data, bounds });
        self.revision += 1;
    }

    fn release(&mut self, slot: FaceSlot) {
        if let Some(entry) = self.entries.get_mut(slot.0 as usize).and_then(Option::take) {
            self.cells.remove(entry.cells);
            self.points.remove(entry.points);
            self.trim_cells.remove(entry.trim_cells);
            self.trim_entries.remove(entry.trim_entries);
            self.trim_data.remove(entry.trim_data);
            self.revision += 1;
        }
    }
}

/// Cuts what lies in `domain` of a patch into cells.
fn pack_patch(
    patch: &BezierPatch,
    shape: &FaceShape,
    slot: u32,
    cells: &mut Vec<Cell>,
    points: &mut Vec<[f32; 4]>,
    bounds: &mut Bounds,
) {
    let domain = shape.domain;
    let min = patch.uv_min.max(domain.min);
    let max = patch.uv_max.min(domain.max);
    if !(min.x < max.x && min.y < max.y) {
        return;
    }
    let whole = min == patch.uv_min && max == patch.uv_max;
    let part = if whole { patch.clone() } else { patch.restrict(patch.local(min), patch.local(max)) };
    // Mixed so that corners on the domain's border are exactly 0 or 1.
    let normalised = |p: DVec2| domain.normalise(min * (DVec2::ONE - p) + max * p);
    for (piece, low, high) in subdivision::pieces(&part) {
        let tile = Tile { piece, uv: (normalised(low), normalised(high)) };
        let mut kept = Vec::new();
        split_by_trims(tile, shape.grid, TRIM_SPLITS, &mut kept);
        for (tile, coverage) in kept {
            *bounds = bounds.union(Bounds::of(corner_sample(&tile.piece)));
            let mut cell = cell::pack(&tile.piece, tile.uv, slot, points);
            cell.flags = if coverage == Coverage::Whole { Cell::WHOLE } else { 0 };
            cells.push(cell);
        }
    }
}

/// A piece of a patch with the face-normalised parameters of its corners.
struct Tile {
    piece: BezierPatch,
    uv: (DVec2, DVec2),
}

/// Halvings of a piece that trims pass through, to leave out more of what is trimmed away.
const TRIM_SPLITS: u32 = 4;

/// Pieces of `tile` that show anything. It is cut only where that frees one part entirely.
fn split_by_trims(
    tile: Tile,
    grid: Option<&ParityGrid>,
    splits: u32,
    kept: &mut Vec<(Tile, Coverage)>,
) -> bool {
    let found = grid.map_or(Coverage::Whole, |grid| coverage(grid, tile.uv.0, tile.uv.1));
    match found {
        Coverage::Empty => return true,
        Coverage::Mixed if splits > 0 => {}
        _ => {
            kept.push((tile, found));
            return false;
        }
    }
    let ((low, high), side) = (tile.uv, tile.uv.1 - tile.uv.0);
    let middle = 0.5 * (low + high);
    let (cut_max, cut_min, local_max, local_min) = if side.x >= side.y {
        let (a, b) = (DVec2::new(middle.x, high.y), DVec2::new(middle.x, low.y));
        (a, b, DVec2::new(0.5, 1.0), DVec2::new(0.5, 0.0))
    } else {
        let (a, b) = (DVec2::new(high.x, middle.y), DVec2::new(low.x, middle.y));
        (a, b, DVec2::new(1.0, 0.5), DVec2::new(0.0, 0.5))
    };
    let before = kept.len();
    let first = Tile { piece: tile.piece.restrict(DVec2::ZERO, local_max), uv: (low, cut_max) };
    let second = Tile { piece: tile.piece.restrict(local_min, DVec2::ONE), uv: (cut_min, high) };
    let freed =
        split_by_trims(first, grid, splits - 1, kept) | split_by_trims(second, grid, splits - 1, kept);
    if !freed {
        kept.truncate(before);
        kept.push((tile, found));
    }
    freed
}

/// Points of a piece dense enough to bound it for framing a view.
fn corner_sample(piece: &BezierPatch) -> impl Iterator<Item = DVec3> + '_ {
    (0..9).map(|k| piece.point((k / 3) as f64 * 0.5, (k % 3) as f64 * 0.5))
}
