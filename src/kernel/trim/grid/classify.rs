//! Classification by the parity grid: the statements that WGSL repeats one for one.
//!
//! Only f32 additions, multiplications, comparisons (and two divisions for rational curves),
//! bounded loops, no dynamic indexing of local arrays.

use super::layout::*;
use crate::kernel::trim::record::{crossing_in_box, least, load, most};
use crate::kernel::trim::tally::Tally;
use crate::kernel::trim::{BELOW_ONE, BORDER};

/// Whether `(u, v)` (normalised) is inside the face of `grid`.
pub fn classify(grid: &GridView, u: f32, v: f32, tally: &mut impl Tally) -> bool {
    let header = &grid.header;
    let (low, high) = (-BORDER, 1.0 + BORDER);
    if header.columns == 0 || !(u >= low && u <= high && v >= low && v <= high) {
        return false;
    }
    let winding = winding_number(grid, u.clamp(0.0, BELOW_ONE), v.clamp(0.0, BELOW_ONE), tally);
    if header.flags & FLAG_NON_ZERO != 0 { winding != 0 } else { winding & 1 != 0 }
}

/// The winding number of `(u, v)`, both in `[0, 1)`.
fn winding_number(grid: &GridView, u: f32, v: f32, tally: &mut impl Tally) -> i32 {
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
    for entry in &grid.entries[(header.entry_base + first) as usize..(header.entry_base + end) as usize] {
        let entry = *entry;
        let address = (header.data_base + (entry >> ENTRY_SHIFT)) as usize;
        let ends = load(grid.data, address);
        // Three comparisons tell all but points in the box; joined, they cost one branch that can go wrong.
        let below = v < ends[1];
        let in_rows = !below & (v < ends[3]);
        let left = u < least(ends[0], ends[2]);
        let in_box = in_rows & !left & (u < most(ends[0], ends[2]));
        let bit = (entry >> u32::from(!below)) & 1;
        let value = if in_box {
            u32::from(crossing_in_box(grid.data, address, ends, entry, u, v, tally))
        } else if in_rows {
            u32::from(left)
        } else {
            bit
        };
        winding += value as i32 * (1 - ((entry & ENTRY_DOWN) >> 1) as i32);
    }
    winding
}
