//! Cuts a face into cells, and again after an edit.
//!
//! Patches are cut into nearly quadratic tiles, tiles that trims pass through in halves where that frees a part
//! of everything. What a patch's tiles are depends on the patch and the domain only; what a cell holds on its
//! place in that tree. So an edit of trims keeps the tiles of every patch and the packed words of every cell
//! that was there before, recognised by a fingerprint of all that they were made from.

use std::ops::Range;

use glam::{DVec2, DVec3};

use super::cell::{self, Cell};
use super::coverage::{Coverage, coverage};
use super::scene::FaceShape;
use super::subdivision;
use crate::kernel::bezier::BezierPatch;
use crate::kernel::face::UvRect;
use crate::kernel::trim::ParityGrid;
use crate::kernel::view::Bounds;

/// How a face was cut.
#[derive(Debug, Clone, Default)]
pub struct Tiling {
    patches: Vec<PatchTiles>,
    cells: Vec<Place>,
}

/// How a patch was cut.
#[derive(Debug, Clone)]
struct PatchTiles {
    fingerprint: [u64; 2],
    /// Corners in the parameters (0..1) of the part of the patch in the domain.
    tiles: Vec<(DVec2, DVec2)>,
    /// Its cells.
    cells: Range<usize>,
}

/// Where in its patch a cell is.
#[derive(Debug, Clone, Copy)]
struct Place {
    tile: u32,
    path: u32,
    bounds: Bounds,
}

/// A face as it was packed before.
#[derive(Debug, Clone, Copy)]
pub struct Before<'a> {
    /// How it was cut.
    pub tiling: &'a Tiling,
    /// Its cells.
    pub cells: &'a [Cell],
    /// Its control points.
    pub points: &'a [[f32; 4]],
    /// What the cells' `first_point` counts from.
    pub first_point: u32,
}

/// A face cut and packed; `first_point` of the cells counts from the first of `points`.
#[derive(Debug, Clone)]
pub struct PackedCells {
    /// Cells.
    pub cells: Vec<Cell>,
    /// Homogeneous control points.
    pub points: Vec<[f32; 4]>,
    /// Box around the cells.
    pub bounds: Bounds,
    /// How it was cut.
    pub tiling: Tiling,
}

/// Packs the cells of the face in `slot`; equal to packing without `before` bit for bit.
pub fn pack(shape: &FaceShape, slot: u32, before: Option<Before>) -> PackedCells {
    let mut packed = PackedCells {
        cells: Vec::new(),
        points: Vec::new(),
        bounds: Bounds::EMPTY,
        tiling: Tiling::default(),
    };
    let mut known = before.map_or(&[][..], |b| &b.tiling.patches[..]);
    for patch in shape.patches {
        let Some(part) = Part::new(patch, &shape.domain) else { continue };
        let fingerprint = part.fingerprint();
        let same = known.iter().position(|p| p.fingerprint == fingerprint);
        let found = same.map(|k| &known[k]);
        known = &known[same.map_or(0, |k| k + 1)..];
        let reused = before.zip(found);
        part.pack(shape.grid, slot, fingerprint, reused, &mut packed);
    }
    packed
}

/// What lies in the domain of a patch.
struct Part<'a> {
    patch: &'a BezierPatch,
    domain: &'a UvRect,
    min: DVec2,
    max: DVec2,
}

impl<'a> Part<'a> {
    fn new(patch: &'a BezierPatch, domain: &'a UvRect) -> Option<Self> {
        let min = patch.uv_min.max(domain.min);
        let max = patch.uv_max.min(domain.max);
        (min.x < max.x && min.y < max.y).then_some(Self { patch, domain, min, max })
    }

    /// The patch over the part.
    fn geometry(&self) -> BezierPatch {
        let whole = self.min == self.patch.uv_min && self.max == self.patch.uv_max;
        if whole {
            self.patch.clone()
        } else {
            self.patch.restrict(self.patch.local(self.min), self.patch.local(self.max))
        }
    }

    /// Face-normalised parameters of a point of the part, mixed so that corners on the domain's border are exactly 0
    /// or 1.
    fn normalised(&self, p: DVec2) -> DVec2 {
        self.domain.normalise(self.min * (DVec2::ONE - p) + self.max * p)
    }

    /// Stands for everything that cutting and packing the part depends on.
    fn fingerprint(&self) -> [u64; 2] {
        let patch = self.patch;
        let mut state = [0x243f_6a88_85a3_08d3, 0x1319_8a2e_0370_7344];
        let mut add = |x: f64| {
            let bits = x.to_bits();
            state[0] = (state[0] ^ bits).wrapping_mul(0x9e37_79b9_7f4a_7c15).rotate_left(29);
            state[1] = (state[1].rotate_left(31) ^ bits).wrapping_mul(0xd6e8_feb8_6659_fd93);
        };
        add(patch.degree_u as f64);
        add(patch.degree_v as f64);
        let corners = [self.domain.min, self.domain.max, patch.uv_min, patch.uv_max];
        corners.iter().flat_map(|p| p.to_array()).for_each(&mut add);
        patch.points.iter().flat_map(|p| p.to_array()).for_each(&mut add);
        patch.weights.iter().copied().for_each(&mut add);
        state
    }

    fn pack(
        &self,
        grid: Option<&ParityGrid>,
        slot: u32,
        fingerprint: [u64; 2],
        reused: Option<(Before, &PatchTiles)>,
        packed: &mut PackedCells,
    ) {
        let first_cell = packed.cells.len();
        let (tiles, pieces): (Vec<_>, _) = match reused {
            Some((_, known)) => (known.tiles.clone(), Vec::new()),
            None => {
                let pieces = subdivision::pieces(&self.geometry());
                (pieces.iter().map(|(_, low, high)| (*low, *high)).collect(), pieces)
            }
        };
        let mut geometry = None;
        let mut known = reused.map_or(0..0, |(_, known)| known.cells.clone());
        let mut leaves = Vec::new();
        for (number, (low, high)) in tiles.iter().enumerate() {
            let uv = (self.normalised(*low), self.normalised(*high));
            leaves.clear();
            split_by_trims(Leaf { path: 1, uv, coverage: Coverage::Whole }, grid, TRIM_SPLITS, &mut leaves);
            for leaf in &leaves {
                let place = (number as u32, leaf.path);
                if let Some((before, _)) = &reused
                    && let Some(at) = find(&before.tiling.cells, &mut known, place)
                {
                    packed.copy(before, at, leaf);
                    continue;
                }
                let tile = match pieces.get(number) {
                    Some((piece, _, _)) => piece.clone(),
                    None => geometry.get_or_insert_with(|| self.geometry()).restrict(*low, *high),
                };
                packed.add(&along(tile, uv, leaf.path), leaf, slot, number as u32);
            }
        }
        let cells = first_cell..packed.cells.len();
        packed.tiling.patches.push(PatchTiles { fingerprint, tiles, cells });
    }
}

impl PackedCells {
    /// Packs a new cell.
    fn add(&mut self, piece: &BezierPatch, leaf: &Leaf, slot: u32, tile: u32) {
        let bounds = Bounds::of(corner_sample(piece));
        let cell = cell::pack(piece, leaf.uv, slot, &mut self.points);
        self.finish(cell, leaf, Place { tile, path: leaf.path, bounds });
    }

    /// Takes cell number `at` over from before.
    fn copy(&mut self, before: &Before, at: usize, leaf: &Leaf) {
        let mut cell = before.cells[at];
        let count = ((cell.degrees & 0xff) + 1) * ((cell.degrees >> 8) + 1);
        let from = (cell.first_point - before.first_point) as usize;
        cell.first_point = self.points.len() as u32;
        self.points.extend_from_slice(&before.points[from..from + count as usize]);
        self.finish(cell, leaf, before.tiling.cells[at]);
    }

    fn finish(&mut self, mut cell: Cell, leaf: &Leaf, place: Place) {
        cell.flags = if leaf.coverage == Coverage::Whole { Cell::WHOLE } else { 0 };
        self.bounds = self.bounds.union(place.bounds);
        self.cells.push(cell);
        self.tiling.cells.push(place);
    }
}

/// Position of the cell at `place` (tile, path) among `known`, from which all cells of earlier tiles are dropped.
fn find(cells: &[Place], known: &mut Range<usize>, (tile, path): (u32, u32)) -> Option<usize> {
    while known.start < known.end && cells[known.start].tile < tile {
        known.start += 1;
    }
    let of_tile = known.clone().take_while(|k| cells[*k].tile == tile);
    of_tile.into_iter().find(|k| cells[*k].path == path)
}

/// A part of a tile.
#[derive(Debug, Clone, Copy)]
struct Leaf {
    /// The halves taken from the tile on: a leading 1, then a bit for each cut, 1 for the upper half.
    path: u32,
    /// Face-normalised parameters of its corners.
    uv: (DVec2, DVec2),
    coverage: Coverage,
}

/// Halvings of a tile that trims pass through, to leave out more of what is trimmed away.
const TRIM_SPLITS: u32 = 4;

/// Whether a rectangle is cut in u: across its longer side.
fn cuts_u((low, high): (DVec2, DVec2)) -> bool {
    let side = high - low;
    side.x >= side.y
}

/// Lower and upper half of a rectangle.
fn halves((low, high): (DVec2, DVec2)) -> [(DVec2, DVec2); 2] {
    let middle = 0.5 * (low + high);
    if cuts_u((low, high)) {
        [(low, DVec2::new(middle.x, high.y)), (DVec2::new(middle.x, low.y), high)]
    } else {
        [(low, DVec2::new(high.x, middle.y)), (DVec2::new(low.x, middle.y), high)]
    }
}

/// The parts of a tile that show anything. It is cut only where that frees one part entirely.
fn split_by_trims(leaf: Leaf, grid: Option<&ParityGrid>, splits: u32, kept: &mut Vec<Leaf>) -> bool {
    let found = grid.map_or(Coverage::Whole, |grid| coverage(grid, leaf.uv.0, leaf.uv.1));
    match found {
        Coverage::Empty => return true,
        Coverage::Mixed if splits > 0 => {}
        _ => {
            kept.push(Leaf { coverage: found, ..leaf });
            return false;
        }
    }
    let before = kept.len();
    let mut freed = false;
    for (bit, uv) in (0..).zip(halves(leaf.uv)) {
        freed |= split_by_trims(Leaf { path: 2 * leaf.path + bit, uv, ..leaf }, grid, splits - 1, kept);
    }
    if !freed {
        kept.truncate(before);
        kept.push(Leaf { coverage: found, ..leaf });
    }
    freed
}

/// The part of a tile at the end of a path.
fn along(tile: BezierPatch, uv: (DVec2, DVec2), path: u32) -> BezierPatch {
    let cuts = u32::BITS - 1 - path.leading_zeros();
    let (mut piece, mut rect) = (tile, uv);
    for cut in (0..cuts).rev() {
        let upper = path >> cut & 1 == 1;
        piece = match (cuts_u(rect), upper) {
            (true, false) => piece.restrict(DVec2::ZERO, DVec2::new(0.5, 1.0)),
            (true, true) => piece.restrict(DVec2::new(0.5, 0.0), DVec2::ONE),
            (false, false) => piece.restrict(DVec2::ZERO, DVec2::new(1.0, 0.5)),
            (false, true) => piece.restrict(DVec2::new(0.0, 0.5), DVec2::ONE),
        };
        rect = halves(rect)[usize::from(upper)];
    }
    piece
}

/// Points of a piece dense enough to bound it for framing a view.
fn corner_sample(piece: &BezierPatch) -> impl Iterator<Item = DVec3> + '_ {
    (0..9).map(|k| piece.point((k / 3) as f64 * 0.5, (k % 3) as f64 * 0.5))
}
