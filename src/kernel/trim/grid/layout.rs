//! The parity grid as plain words: what the CPU twin and the WGSL read.
//!
//! Four pieces: one [`GridHeader`], then `cells`, `entries` (`u32` each) and `data` (16-byte units).
//! All indices are local to the face; packing many faces into shared buffers is a copy plus the
//! three `*_base` fields, which every access adds.
//!
//! **Cell word**, cell `(column, row)` of a block of `k_u x k_v` is number `row * k_u + column`:
//!
//! | bits | meaning |
//! |---|---|
//! | 0..7 | winding number of the cell, 7-bit two's complement; bit 0 is its parity |
//! | 7 | refined: `entries[first]` = index of the child block's first cell, `entries[first + 1]` = its k (k x k cells) |
//! | 8..32 | `first`: index of the cell's first entry. One word more than cells stands behind each block: the end of the last list is the next word's `first` |
//!
//! **Entry word**, one segment that may pass through the cell:
//!
//! | bits | meaning |
//! |---|---|
//! | 0 | `lo`: its value for points below its lower end (`v < v0`) |
//! | 1 | `hi`: its value for points at or above its upper end (`v >= v1`) |
//! | 2 | `down`: it runs downwards along its loop; its value counts -1 instead of +1 |
//! | 3 | rational |
//! | 4..10 | degree - 1 (0: a straight line) |
//! | 10..32 | address of its record in `data`, in units of 16 bytes |
//!
//! **Record** (f32 bit patterns): words 0..4 = `u0 v0 u1 v1`, the lower and the upper end
//! (`v0 <= v1`, absolute, shared bit for bit with the neighbours). A line ends here. A polynomial
//! cubic goes on with words 4..8 = `Q1.u Q1.v Q2.u Q2.v`. Every other curve has word 4 = `fat`, then
//! for i in 1..degree `Qi.u Qi.v` (and `Wi` if rational), padded to 16 bytes. `Qi` = binomial(n, i)
//! times weight times (control point - lower end), `Wi` = binomial(n, i) times weight, in the standard form
//! where both end weights are 1. `fat` holds two numbers rounded away from 0 to the upper 16 bits of an f32:
//! lower bound in bits 16..32 (<= 0), upper bound in bits 0..16 (>= 0).
//!
//! **Fat bounds** `lo <= hi`: for any part of the curve between parameters `a < b` with end points
//! A, B, every point C of the part has `lo (b-a)^3 <= cross(C - A, B - A) <= hi (b-a)^3`, where
//! `cross(p, d) = p.u d.v - p.v d.u`. A point beyond the band is on a known side of the curve.
//!
//! **Value** of an entry at p: `v < v0 ? lo : v >= v1 ? hi : (u_s(v) > u)`. Winding at p = cell's number
//! + sum over entries of (down ? -value : value). Inside: odd (even-odd) or not zero (non-zero rule).

use bytemuck::{Pod, Zeroable};

/// Set in [`GridHeader::flags`] for the non-zero rule.
pub const FLAG_NON_ZERO: u32 = 1;
/// Bit of a cell word that says the cell has a child block.
pub const CELL_REFINED: u32 = 1 << 7;
/// Shift of `first` in a cell word.
pub const CELL_SHIFT: u32 = 8;
/// Shift of the address in an entry word.
pub const ENTRY_SHIFT: u32 = 10;
/// Bit of an entry word: value below the lower end.
pub const ENTRY_LO: u32 = 1;
/// Bit of an entry word: value above the upper end.
pub const ENTRY_HI: u32 = 2;
/// Bit of an entry word: the segment runs downwards.
pub const ENTRY_DOWN: u32 = 4;
/// Bit of an entry word: the segment is rational.
pub const ENTRY_RATIONAL: u32 = 8;
/// Deepest nesting of blocks, the outermost included.
pub const MAX_LEVELS: u32 = 4;
/// Most halvings of one segment before the side of the chord is taken.
pub const MAX_STEPS: u32 = 20;

/// Where a grid's pieces are and how large its outer block is. 32 bytes.
#[repr(C)]
#[derive(Debug, Clone, Copy, Default, PartialEq, Pod, Zeroable)]
pub struct GridHeader {
    /// Columns of the outer block; 0: nothing is inside.
    pub columns: u32,
    /// Rows of the outer block.
    pub rows: u32,
    /// `columns` as a float: `column = floor(u * scale_u)`.
    pub scale_u: f32,
    /// `rows` as a float.
    pub scale_v: f32,
    /// Added to every index into `cells`.
    pub cell_base: u32,
    /// Added to every index into `entries`.
    pub entry_base: u32,
    /// Added to every address in `data`, 16-byte units.
    pub data_base: u32,
    /// [`FLAG_NON_ZERO`].
    pub flags: u32,
}

/// A grid to read: header and slices (a face's own, or shared buffers of many faces).
#[derive(Debug, Clone, Copy)]
pub struct GridView<'a> {
    /// Header.
    pub header: GridHeader,
    /// Cell words.
    pub cells: &'a [u32],
    /// Entry words.
    pub entries: &'a [u32],
    /// Segment records.
    pub data: &'a [[u32; 4]],
}

/// The winding number in a cell word.
pub fn cell_winding(cell: u32) -> i32 {
    // Shift the 7 bits to the top and back with the sign.
    ((cell << 25) as i32) >> 25
}

/// A cell word.
pub fn cell_word(first: u32, refined: bool, winding: i32) -> u32 {
    let kept = if (-64..64).contains(&winding) {
        winding
    } else {
        // Saturate without losing the parity.
        let edge = if winding < 0 { -64 } else { 62 };
        edge | (winding & 1)
    };
    (first << CELL_SHIFT) | if refined { CELL_REFINED } else { 0 } | (kept as u32 & 0x7f)
}
