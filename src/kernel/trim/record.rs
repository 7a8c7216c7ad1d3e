//! Packed segment records (layout: [`grid::layout`](super::grid::layout)) and the one decision made on
//! them: does the curve pass to the right of a point?
//!
//! The curve is never intersected. Each step knows a part of the curve by its end points and a
//! band around its chord ("fat bounds"); a point outside the part's box or band is decided,
//! otherwise the part is halved at the middle of its parameter interval (P1, section 3.3, sharpened by the band).
//! Every structure uses this same function, so they can only differ in which segments they ask.

use super::grid::layout::{ENTRY_RATIONAL, ENTRY_SHIFT, MAX_STEPS};
use super::tally::Tally;

/// Degree in an entry word.
pub fn entry_degree(entry: u32) -> u32 {
    ((entry >> 4) & 63) + 1
}

/// Entry word of a record without its lo and hi bits.
pub fn entry_word(address: u32, degree: u32, rational: bool, down: bool) -> u32 {
    (address << ENTRY_SHIFT) | ((degree - 1) << 4) | (u32::from(rational) << 3) | (u32::from(down) << 2)
}

/// Four words as floats.
#[inline]
pub fn load(data: &[[u32; 4]], address: usize) -> [f32; 4] {
    data[address].map(f32::from_bits)
}

#[inline]
fn word(data: &[[u32; 4]], address: usize, index: u32) -> f32 {
    f32::from_bits(data[address + (index / 4) as usize][(index % 4) as usize])
}

#[inline]
fn cross(a: [f32; 2], b: [f32; 2]) -> f32 {
    a[0] * b[1] - a[1] * b[0]
}

/// Whether the segment's u at height `v` is larger than `u`. `ends` are words 0..4 of the record and
/// `ends[1] <= v < ends[3]`.
#[inline]
pub fn crossing(
    data: &[[u32; 4]],
    address: usize,
    ends: [f32; 4],
    entry: u32,
    u: f32,
    v: f32,
    tally: &mut impl Tally,
) -> bool {
    if u < least(ends[0], ends[2]) {
        return true;
    }
    if u >= most(ends[0], ends[2]) {
        return false;
    }
    crossing_in_box(data, address, ends, entry, u, v, tally)
}

/// The smaller of two numbers, neither of them NaN.
#[inline]
pub fn least(a: f32, b: f32) -> f32 {
    if a < b { a } else { b }
}

/// The larger of two numbers, neither of them NaN.
#[inline]
pub fn most(a: f32, b: f32) -> f32 {
    if a > b { a } else { b }
}

/// The same as [`crossing`] for a point in the segment's box.
#[inline]
pub fn crossing_in_box(
    data: &[[u32; 4]],
    address: usize,
    ends: [f32; 4],
    entry: u32,
    u: f32,
    v: f32,
    tally: &mut impl Tally,
) -> bool {
    tally.test();
    let p = [u - ends[0], v - ends[1]];
    let d = [ends[2] - ends[0], ends[3] - ends[1]];
    let degree = entry_degree(entry);
    let rational = entry & ENTRY_RATIONAL != 0;
    let side = cross(p, d);
    if degree == 1 {
        return side < 0.0;
    }
    let compact = degree == 3 && !rational;
    let (low, high) =
        if compact { cubic_bounds(load(data, address + 1), d) } else { stored_bounds(data, address) };
    if (side < low) | (side > high) {
        return side < low;
    }
    if compact {
        let q = load(data, address + 1);
        bisect(|t| cubic_point(q, d, t), d, p, low, high, tally)
    } else {
        bisect(|t| curve_point(data, address, d, degree, rational, t), d, p, low, high, tally)
    }
}

/// Halves the parameter interval of a curve from (0, 0) to `d` until the side of `p` is known.
#[inline]
fn bisect(
    point: impl Fn(f32) -> [f32; 2],
    d: [f32; 2],
    p: [f32; 2],
    low: f32,
    high: f32,
    tally: &mut impl Tally,
) -> bool {
    let (mut a, mut b) = ([0.0f32, 0.0f32], d);
    let (mut t, mut dt, mut band) = (0.0f32, 1.0f32, 1.0f32);
    let mut side = 0.0f32;
    for _ in 0..MAX_STEPS {
        dt *= 0.5;
        band *= 0.125;
        let m = point(t + dt);
        tally.evaluation();
        // Rounding must not break the monotony that the tests below stand on.
        let (left, right) = (least(a[0], b[0]), most(a[0], b[0]));
        let m = [least(most(m[0], left), right), least(most(m[1], a[1]), b[1])];
        if p[1] >= m[1] {
            a = m;
            t += dt;
        } else {
            b = m;
        }
        side = cross([p[0] - a[0], p[1] - a[1]], [b[0] - a[0], b[1] - a[1]]);
        // The box is sharper than the band: where rounding makes them disagree it decides.
        let (left, right) = (p[0] < least(a[0], b[0]), p[0] >= most(a[0], b[0]));
        let right_of = left | (!right & (side < low * band));
        let left_of = right | (side > high * band);
        if right_of | left_of {
            return right_of;
        }
    }
    tally.undecided();
    side < 0.0
}

/// A packed curve (degree 2 or more) apart from any query: for building.
#[derive(Debug, Clone, Copy)]
pub struct Curve<'a> {
    data: &'a [[u32; 4]],
    address: usize,
    degree: u32,
    rational: bool,
    d: [f32; 2],
}

impl<'a> Curve<'a> {
    /// The curve of an entry word whose record has the ends `ends`.
    pub fn new(data: &'a [[u32; 4]], word: u32, ends: [f32; 4]) -> Self {
        Self {
            data,
            address: (word >> ENTRY_SHIFT) as usize,
            degree: entry_degree(word),
            rational: word & ENTRY_RATIONAL != 0,
            d: [ends[2] - ends[0], ends[3] - ends[1]],
        }
    }

    /// Fat bounds of the whole curve.
    pub fn bounds(&self) -> (f32, f32) {
        if self.degree == 3 && !self.rational {
            cubic_bounds(load(self.data, self.address + 1), self.d)
        } else {
            stored_bounds(self.data, self.address)
        }
    }

    /// Point at `t`, relative to the lower end.
    pub fn point(&self, t: f32) -> [f32; 2] {
        if self.degree == 3 && !self.rational {
            cubic_point(load(self.data, self.address + 1), self.d, t)
        } else {
            curve_point(self.data, self.address, self.d, self.degree, self.rational, t)
        }
    }
}

/// Fat bounds of a polynomial cubic with scaled inner points `q` = Q1, Q2 from (0, 0) to `d`:
/// extremes of cross(C'', C') / 8 over the control vectors of both derivatives, with 0, negated.
#[inline]
fn cubic_bounds(q: [f32; 4], d: [f32; 2]) -> (f32, f32) {
    let e0 = [q[0], q[1]];
    let e1 = [q[2] - q[0], q[3] - q[1]];
    let e2 = [3.0 * d[0] - q[2], 3.0 * d[1] - q[3]];
    let (a, b, c) = (cross(e1, e0), cross(e2, e1), cross(e2, e0));
    let low = least(least(least(a, b), least(c - a, c - b)), 0.0);
    let high = most(most(most(a, b), most(c - a, c - b)), 0.0);
    // A little more than 1/4, for the rounding of the products.
    (-0.2500005 * high, -0.2500005 * low)
}

#[inline]
fn stored_bounds(data: &[[u32; 4]], address: usize) -> (f32, f32) {
    let fat = data[address + 1][0];
    (f32::from_bits(fat & 0xffff_0000), f32::from_bits(fat << 16))
}

#[inline]
fn cubic_point(q: [f32; 4], d: [f32; 2], t: f32) -> [f32; 2] {
    let s = 1.0 - t;
    let tt = t * t;
    [t * (s * (s * q[0] + t * q[2]) + tt * d[0]), t * (s * (s * q[1] + t * q[3]) + tt * d[1])]
}

/// Horner's scheme in scaled Bernstein form (constant registers; P1, section 3.2).
fn curve_point(
    data: &[[u32; 4]],
    address: usize,
    d: [f32; 2],
    degree: u32,
    rational: bool,
    t: f32,
) -> [f32; 2] {
    let s = 1.0 - t;
    let mut power = 1.0f32;
    let (mut x, mut y, mut w) = (0.0f32, 0.0f32, 1.0f32);
    let mut index = 5;
    for _ in 1..degree {
        power *= t;
        x = x * s + power * word(data, address, index);
        y = y * s + power * word(data, address, index + 1);
        index += 2;
        if rational {
            w = w * s + power * word(data, address, index);
            index += 1;
        }
    }
    power *= t;
    x = x * s + power * d[0];
    y = y * s + power * d[1];
    if rational {
        w = w * s + power;
        return [x / w, y / w];
    }
    [x, y]
}
