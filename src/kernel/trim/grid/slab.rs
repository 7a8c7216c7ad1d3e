//! One word for each cell that decides most of its points: a slab that holds all curves of the cell.
//!
//! Left of the slab and right of it nothing changes, so that each side has one answer, taken from the grid
//! itself when the slab is made; only points in the slab ask the list of the cell. The slab is found without
//! root finding: curves are halved until the band around the chord (fat bounds) is thin beside the cell, and of
//! the directions of the chords the one with the narrowest slab is taken. Margins cover what the query's f32
//! evaluation may be off, as in [`super::span`]; so the answers stay those of the grid, bit for bit.
//!
//! **Slab word**, for positions x, y in the cell, from -1/2 to 1/2 cut to [`PARTS`], and `s = a x + b y`:
//!
//! | bits | meaning |
//! |---|---|
//! | 0..8, 8..16 | `a`, `b`, two's complement, together at most 125 |
//! | 16..23, 23..30 | `low`, `high`, two's complement: undecided for `low <= s <= high` |
//! | 30, 31 | whether points with `s < low`, with `s > high`, are inside |

use super::ParityGrid;
use super::classify::classify;
use super::layout::{CELL_REFINED, CELL_SHIFT, ENTRY_SHIFT};
use super::span::{EVALUATION, MARGIN};
use crate::kernel::trim::record::{Curve, entry_degree, load};

/// Most that `a` and `b` come to together, so that `s` stays within 63.
const MOST: f64 = 125.0;
/// Decides nothing.
const UNDECIDED: u32 = word([0, 0], [-64, 63], [false; 2]);
/// Bands thinner than this part of a cell are not halved any more.
const THIN: f64 = 0.01;
/// Halvings of a curve at most.
const DEPTH: u32 = 6;
/// Directions tried at most.
const DIRECTIONS: usize = 6;
/// What positions in a cell lose by being cut to whole parts, and their rounding, in cells.
const ROUNDING: f64 = 2.5e-3;
/// Sides are asked here, a little inside the corner of the cell.
const CORNER: i32 = PARTS / 2 - 3;

const fn word(normal: [i32; 2], [low, high]: [i32; 2], inside: [bool; 2]) -> u32 {
    (normal[0] as u32 & 0xff)
        | (normal[1] as u32 & 0xff) << 8
        | (low as u32 & 0x7f) << 16
        | (high as u32 & 0x7f) << 23
        | (inside[0] as u32) << 30
        | (inside[1] as u32) << 31
}

/// Whether the point at (`x`, `y`) of a cell, in parts of [`PARTS`] from its middle, is inside, if the slab decides.
///
/// All integers, and no branch that depends on the side: that one would go wrong at every other point.
#[inline]
pub fn decide(word: u32, x: i32, y: i32) -> Option<bool> {
    let s = i32::from(word as i8) * x + i32::from((word >> 8) as i8) * y;
    let limit = |left: u32| (((word << left) as i32) >> 25) * PARTS;
    let (below, above) = (((s - limit(9)) >> 31) as u32, ((limit(2) - s) >> 31) as u32);
    let inside = (below & (word >> 30)) | (above & (word >> 31));
    (below | above != 0).then_some(inside & 1 != 0)
}

/// Positions in a cell are counted in this many parts.
pub const PARTS: i32 = 1024;

/// The column (or row) of a coordinate in `[0, 1)` and its position in it, as [`decide`] counts.
#[inline]
pub fn place(x: f32, scale: f32) -> (u32, i32) {
    let parts = (x * scale * PARTS as f32) as i32;
    ((parts >> PARTS.trailing_zeros()) as u32, (parts & (PARTS - 1)) - PARTS / 2)
}

/// Questions that [`unmade`] counts at most: normals of slabs that are made are longer.
pub const MOST_ASKED: i32 = 8;

/// What stands for a slab that is not made yet, in a cell that was asked `times` times, 1 to [`MOST_ASKED`]. It
/// decides nothing, as no position brings `s` to its limits.
pub const fn unmade(times: i32) -> u32 {
    word([times, 0], [-64, 63], [false; 2])
}

/// How often a cell was asked whose slab is not made yet; `None` when it is made.
pub fn asked(word: u32) -> Option<i32> {
    let times = (word & 0xff) as i32;
    ((1..=MOST_ASKED).contains(&times) && word == unmade(times)).then_some(times)
}

/// The slab of cell `[column, row]` of the outer block of `grid`.
pub fn slab(grid: &ParityGrid, cell: [u32; 2]) -> u32 {
    Maker { grid, cell, bands: Vec::new() }.slab()
}

/// Part of a curve in cell coordinates: within `thickness` of the chord from `p` to `q`.
#[derive(Clone, Copy)]
struct Band {
    p: [f64; 2],
    q: [f64; 2],
    thickness: f64,
}

struct Maker<'a> {
    grid: &'a ParityGrid,
    cell: [u32; 2],
    bands: Vec<Band>,
}

impl Maker<'_> {
    fn slab(mut self) -> u32 {
        let grid = self.grid;
        let index = (self.cell[1] * grid.header.columns + self.cell[0]) as usize;
        let cell = grid.cells[index];
        if cell & CELL_REFINED != 0 {
            return UNDECIDED;
        }
        let list = (cell >> CELL_SHIFT) as usize..(grid.cells[index + 1] >> CELL_SHIFT) as usize;
        self.bands.clear();
        for entry in &grid.entries[list] {
            self.enter(*entry);
        }
        if self.bands.is_empty() {
            return self.decided([0, 0], [63, 63]);
        }
        let normals = self.bands.iter().take(DIRECTIONS - 1).map(|b| [b.q[1] - b.p[1], b.p[0] - b.q[0]]);
        let (first, last) = (self.bands[0], self.bands[self.bands.len() - 1]);
        let whole = [last.q[1] - first.p[1], first.p[0] - last.q[0]];
        let slabs = normals.chain([whole]).filter_map(|normal| self.around(normal));
        let narrowest = slabs.min_by(|x, y| x.1.total_cmp(&y.1));
        narrowest.map_or(UNDECIDED, |(normal, _, limits)| self.decided(normal, limits))
    }

    /// The narrowest slab across `normal`: the normal as it is stored, its width in cells, its limits.
    fn around(&self, normal: [f64; 2]) -> Option<([i32; 2], f64, [i32; 2])> {
        let size = normal[0].abs() + normal[1].abs();
        let stored = normal.map(|n| (n * (MOST / size)).trunc());
        let length = stored[0].hypot(stored[1]);
        if !(size > 1e-9) || length == 0.0 {
            return None;
        }
        let (mut low, mut high) = (f64::INFINITY, f64::NEG_INFINITY);
        for band in &self.bands {
            for p in [band.p, band.q] {
                let s = stored[0] * p[0] + stored[1] * p[1];
                low = low.min(s - band.thickness * length);
                high = high.max(s + band.thickness * length);
            }
        }
        let limits = [low.floor().clamp(-64.0, 63.0) as i32, high.ceil().clamp(-64.0, 63.0) as i32];
        Some((stored.map(|n| n as i32), (high - low) / length, limits))
    }

    /// The word of a slab with the answers on both its sides; a side on which no corner of the cell lies is
    /// given to the slab.
    fn decided(&self, normal: [i32; 2], mut limits: [i32; 2]) -> u32 {
        let mut inside = [false; 2];
        for k in 0..2 {
            let sign = if k == 0 { -1 } else { 1 };
            let corner = normal.map(|n| sign * CORNER * if n < 0 { -1 } else { 1 });
            let asked = word(normal, limits, [k == 0, k == 1]);
            match self.ask(corner).filter(|_| decide(asked, corner[0], corner[1]) == Some(true)) {
                Some(answer) => inside[k] = answer,
                None => limits[k] = if k == 0 { -64 } else { 63 },
            }
        }
        word(normal, limits, inside)
    }

    /// The answer of the grid at a point of the cell; `None` where rounding takes it elsewhere.
    fn ask(&self, at: [i32; 2]) -> Option<bool> {
        let header = &self.grid.header;
        let scale = [header.scale_u, header.scale_v];
        let p: [f32; 2] = std::array::from_fn(|k| {
            (self.cell[k] as f32 + 0.5 + (at[k] as f32 + 0.5) / PARTS as f32) / scale[k]
        });
        let is_here = place(p[0], header.scale_u) == (self.cell[0], at[0])
            && place(p[1], header.scale_v) == (self.cell[1], at[1]);
        is_here.then(|| classify(&self.grid.view(), p[0], p[1], &mut ()))
    }

    /// Enters the bands of a listed segment that come into the cell.
    fn enter(&mut self, entry: u32) {
        let (grid, cell) = (self.grid, self.cell);
        let data = &grid.data[..];
        let ends = load(data, (entry >> ENTRY_SHIFT) as usize);
        let scale = [f64::from(grid.header.scale_u), f64::from(grid.header.scale_v)];
        let local = |p: [f64; 2]| [0, 1].map(|k| p[k] * scale[k] - f64::from(cell[k]) - 0.5);
        if ends[3] == 0.0 {
            // Along the lower border: all points are above it.
            return;
        }
        let [u0, v0, u1, v1] = ends.map(f64::from);
        let (p, q) = (local([u0, v0]), local([u1, v1]));
        let size = (u1 - u0).abs().max(v1 - v0);
        let margin = ROUNDING + (MARGIN + EVALUATION * size) * scale[0].max(scale[1]);
        if entry_degree(entry) == 1 {
            self.push(p, q, margin);
            return;
        }
        let curve = Curve::new(data, entry, ends);
        let (low, high) = curve.bounds();
        let bend = f64::from(low.abs().max(high.abs())) * scale[0] * scale[1];
        let mut waiting = [(0.0f32, 1.0f32, p, q); DEPTH as usize + 1];
        let mut count = 1;
        while count > 0 {
            count -= 1;
            let (t, dt, p, q) = waiting[count];
            let reach = 0.5 + margin;
            let misses = |k: usize| p[k].min(q[k]) > reach || p[k].max(q[k]) < -reach;
            if misses(0) || misses(1) {
                continue;
            }
            let chord = (q[0] - p[0]).hypot(q[1] - p[1]);
            // A part stays within the box of its ends.
            let thickness = (bend * f64::from(dt * dt * dt) / chord).min(chord);
            if !(thickness > THIN) || count + 2 > waiting.len() {
                self.push(p, q, margin + if chord > 0.0 { thickness } else { 0.0 });
                continue;
            }
            let [x, y] = curve.point(t + 0.5 * dt);
            let m = local([u0 + f64::from(x), v0 + f64::from(y)]);
            let m = [0, 1].map(|k| m[k].clamp(p[k].min(q[k]), p[k].max(q[k])));
            waiting[count] = (t + 0.5 * dt, 0.5 * dt, m, q);
            waiting[count + 1] = (t, 0.5 * dt, p, m);
            count += 2;
        }
    }

    /// Enters what of the chord comes near the cell (Liang & Barsky 1984).
    fn push(&mut self, p: [f64; 2], q: [f64; 2], thickness: f64) {
        let reach = 0.5 + thickness;
        let (mut from, mut to) = (0.0f64, 1.0f64);
        for k in 0..2 {
            let d = q[k] - p[k];
            if d == 0.0 {
                if p[k].abs() > reach {
                    return;
                }
                continue;
            }
            let (a, b) = ((-reach - p[k]) / d, (reach - p[k]) / d);
            from = from.max(a.min(b));
            to = to.min(a.max(b));
        }
        if from <= to {
            let at = |s: f64| [0, 1].map(|k| p[k] + (q[k] - p[k]) * s);
            self.bands.push(Band { p: at(from), q: at(to), thickness });
        }
    }
}
