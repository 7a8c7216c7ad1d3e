//! Classification by the parity grid. The twin in WGSL finds the same values with plain comparisons; here the four
//! comparisons of a point with the ends of a segment are one mask, so that few branches depend on data.
//!
//! Only f32 additions, multiplications, comparisons (and two divisions for rational curves),
//! bounded loops, no dynamic indexing of local arrays.

use glam::Vec4;

use super::layout::*;
use crate::kernel::trim::record::{crossing_in_box, load};
use crate::kernel::trim::tally::Tally;
use crate::kernel::trim::{BELOW_ONE, BORDER};

/// Whether `(u, v)` (normalised) is inside the face of `grid`.
pub fn classify(grid: &GridView, u: f32, v: f32, tally: &mut impl Tally) -> bool {
    classify_listed(grid, u, v, tally).0
}

/// The same, and whether the cell of the point lists any segments: if not, no curve is near.
#[inline]
pub fn classify_listed(grid: &GridView, u: f32, v: f32, tally: &mut impl Tally) -> (bool, bool) {
    let header = &grid.header;
    let (low, high) = (-BORDER, 1.0 + BORDER);
    if header.columns == 0 || !(u >= low && u <= high && v >= low && v <= high) {
        return (false, false);
    }
    let (winding, listed) = winding_number(grid, u.clamp(0.0, BELOW_ONE), v.clamp(0.0, BELOW_ONE), tally);
    let inside = if header.flags & FLAG_NON_ZERO != 0 { winding != 0 } else { winding & 1 != 0 };
    (inside, listed)
}

/// The winding number of `(u, v)`, both in `[0, 1)`, and whether its cell lists segments.
fn winding_number(grid: &GridView, u: f32, v: f32, tally: &mut impl Tally) -> (i32, bool) {
    let header = &grid.header;
    // Position inside the block in units of cells, then inside the cell.
    let (mut x, mut y) = (u * header.scale_u, v * header.scale_v);
    let mut column = (x as u32).min(header.columns - 1);
    let mut row = (y as u32).min(header.rows - 1);
    let mut index = header.cell_base + row * header.columns + column;
    let mut cell = grid.cells[index as usize];
    for _ in 1..MAX_LEVELS {
        if cell & CELL_REFINED == 0 {
            break;
        }
        let child = (header.entry_base + (cell >> CELL_SHIFT)) as usize;
        let k = grid.entries[child + 1];
        x = (x - column as f32) * k as f32;
        y = (y - row as f32) * k as f32;
        column = (x as u32).min(k - 1);
        row = (y as u32).min(k - 1);
        index = header.cell_base + grid.entries[child] + row * k + column;
        cell = grid.cells[index as usize];
    }
    let mut winding = cell_winding(cell);
    let first = cell >> CELL_SHIFT;
    let end = grid.cells[index as usize + 1] >> CELL_SHIFT;
    // Most lists are no longer than one stride. Going through them at a fixed pace, with nothing for what
    // is beyond the end, leaves no branch that depends on the length and goes wrong at every other point.
    let point = Vec4::new(u, v, u, v);
    let mut at = first;
    while at < end {
        for step in 0..STRIDE {
            winding += entry_winding(grid, at + step, end, point, tally);
        }
        at += STRIDE;
    }
    (winding, end > first)
}

/// Entries asked without a branch between them.
const STRIDE: u32 = 2;

/// What entry number `at` adds to the winding number of `point` (u, v, u, v); nothing from `end` on.
#[inline(always)]
fn entry_winding(grid: &GridView, at: u32, end: u32, point: Vec4, tally: &mut impl Tally) -> i32 {
    let header = &grid.header;
    let listed = ((at.wrapping_sub(end) as i32) >> 31) as u32;
    let entry = grid.entries.get((header.entry_base + at) as usize).copied().unwrap_or(0) & listed;
    let address = (header.data_base + (entry >> ENTRY_SHIFT)) as usize;
    let ends = load(grid.data, address);
    // Bits: u < u0, v < v0, u < u1, v < v1.
    let less = point.cmplt(Vec4::from_array(ends)).bitmask();
    if (IN_BOX >> less) & listed & 1 != 0 {
        let value = crossing_in_box(grid.data, address, ends, entry, point.x, point.y, tally);
        return i32::from(value) * sign(entry);
    }
    let values = (entry & (ENTRY_LO | ENTRY_HI)) | ALWAYS;
    let value = (values >> ((CHOICE >> (2 * less)) & 3)) & listed & 1;
    value as i32 * sign(entry)
}

/// Comparisons that put a point into the box of a segment, one bit each: v0 <= v < v1, u between the ends.
const IN_BOX: u32 = 1 << 0b1001 | 1 << 0b1100;
/// Bit 3 of the values that [`CHOICE`] chooses from; bit 2 is 0.
const ALWAYS: u32 = 8;
/// For each outcome of the comparisons two bits that choose a value: 0 `lo`, 1 `hi`, 2 never, 3 always.
const CHOICE: u32 = {
    let (mut choices, mut less) = (0, 0);
    while less < 16 {
        let choice = match (less & 2 != 0, less & 8 != 0) {
            (true, _) => 0,
            (false, false) => 1,
            (false, true) => 2 + (less == 0b1101) as u32,
        };
        choices |= choice << (2 * less);
        less += 1;
    }
    choices
};

/// What crossing an entry counts.
fn sign(entry: u32) -> i32 {
    1 - ((entry & ENTRY_DOWN) >> 1) as i32
}
