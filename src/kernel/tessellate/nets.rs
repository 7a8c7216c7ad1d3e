//! Nets of Bernstein coefficients of functions on parts of patches: cut to a box, evaluated, their weights' range.
//!
//! Coefficients of all parts stand in one array, those of a divided triangle behind those of the whole, so that a bound that
//! goes down a few levels allocates nothing.

use std::ops::{Add, Mul};

use glam::{DVec2, DVec3};

use crate::kernel::bezier::bernstein::{self, MAX_COUNT};

/// Bernstein coefficients of functions over a part of a patch: how far the surface is from a plane (or two), times its
/// weight, and last the weight. Taken from the control points before anything is cut: numbers are cheaper to cut than points.
pub(super) trait Height: Copy + Add<Output = Self> + Mul<f64, Output = Self> {
    /// The functions.
    fn heights(self) -> impl AsRef<[f64]>;
    /// The weight.
    fn weight(self) -> f64;
}

impl Height for f64 {
    fn heights(self) -> impl AsRef<[f64]> {
        [self]
    }
    fn weight(self) -> f64 {
        1.0
    }
}

impl Height for DVec2 {
    fn heights(self) -> impl AsRef<[f64]> {
        [self.x]
    }
    fn weight(self) -> f64 {
        self.y
    }
}

impl Height for DVec3 {
    fn heights(self) -> impl AsRef<[f64]> {
        [self.x, self.y]
    }
    fn weight(self) -> f64 {
        self.z
    }
}

/// Part of a patch: its coefficients stand in [`Nets::values`] from `first` on.
#[derive(Clone, Copy)]
pub(super) struct Net {
    pub(super) degrees: [usize; 2],
    pub(super) first: usize,
    /// Native extent.
    pub(super) low: DVec2,
    pub(super) high: DVec2,
}

/// Parts of patches, those of a divided triangle behind those of the whole.
pub(super) struct Nets<V> {
    pub(super) nets: Vec<Net>,
    pub(super) values: Vec<V>,
}

impl<V: Height> Nets<V> {
    /// Adds the part over `low..high` of a net whose coefficients were put in last.
    pub(super) fn cut(
        &mut self,
        degrees: [usize; 2],
        first: usize,
        (from, to): (DVec2, DVec2),
        (low, high): (DVec2, DVec2),
    ) {
        let [m, n] = degrees;
        let values = &mut self.values[first..first + (m + 1) * (n + 1)];
        let size = to - from;
        let a = ((low - from) / size).clamp(DVec2::ZERO, DVec2::ONE);
        let b = ((high - from) / size).clamp(a, DVec2::ONE);
        if a.y > 0.0 || b.y < 1.0 {
            values.chunks_exact_mut(n + 1).for_each(|row| cut_row(row, (a.y, b.y)));
        }
        if a.x > 0.0 || b.x < 1.0 {
            cut_rows(values, n + 1, (a.x, b.x));
        }
        self.nets.push(Net { degrees, first, low, high });
    }

    /// Adds the parts over `low..high` of the nets from number `parent` to `end`.
    pub(super) fn narrow(&mut self, (parent, end): (usize, usize), low: DVec2, high: DVec2) {
        let before = self.nets.len();
        for strict in [true, false] {
            for k in parent..end {
                let net = self.nets[k];
                let (from, to) = (low.max(net.low), high.min(net.high));
                let apart = if strict { to.cmple(from) } else { to.cmplt(from) };
                if apart.any() {
                    continue;
                }
                let count = (net.degrees[0] + 1) * (net.degrees[1] + 1);
                let first = self.values.len();
                self.values.extend_from_within(net.first..net.first + count);
                self.cut(net.degrees, first, (net.low, net.high), (from, to));
            }
            if self.nets.len() > before {
                return;
            }
        }
    }

    /// The functions and the weight at native `uv`, by the nets from number `first` on; times a common factor.
    pub(super) fn at(&self, first: usize, uv: DVec2) -> V {
        let has = |net: &&Net| uv.cmpge(net.low).all() && uv.cmple(net.high).all();
        let off = |net: &Net| uv.clamp(net.low, net.high).distance_squared(uv);
        let nearest = || self.nets[first..].iter().min_by(|a, b| off(a).total_cmp(&off(b)));
        let net = self.nets[first..].iter().find(has).or_else(nearest).copied();
        let net = net.unwrap_or(Net { degrees: [0, 0], first: 0, low: uv, high: uv });
        let [m, n] = net.degrees;
        let size = net.high - net.low;
        let of = |axis: usize| {
            let x = if size[axis] > 0.0 { (uv[axis] - net.low[axis]) / size[axis] } else { 0.0 };
            x.clamp(0.0, 1.0)
        };
        let values = &self.values[net.first..net.first + (m + 1) * (n + 1)];
        if m.max(n) < 8 {
            sum::<V, 8>([m, n], values, of(0), of(1))
        } else {
            sum::<V, MAX_COUNT>([m, n], values, of(0), of(1))
        }
    }

    /// Takes the nets from number `count` on out again.
    pub(super) fn drop_to(&mut self, count: usize) {
        if let Some(net) = self.nets.get(count) {
            self.values.truncate(net.first);
        }
        self.nets.truncate(count);
    }

    /// Least and largest weight over the nets from number `first` on.
    pub(super) fn weights(&self, first: usize) -> (f64, f64) {
        let start = self.nets.get(first).map_or(self.values.len(), |net| net.first);
        let all = self.values[start..].iter().map(|v| v.weight());
        all.fold((f64::INFINITY, 0.0), |(a, b), w| (w.min(a), w.max(b)))
    }
}

/// Coefficients of the part `from..to` of a curve whose coefficients stand in a row.
fn cut_row<V: Height>(row: &mut [V], (from, to): (f64, f64)) {
    let count = row.len();
    if to < 1.0 {
        for r in 1..count {
            let mut before = row[r - 1];
            for value in &mut row[r..] {
                let here = *value;
                *value = before * (1.0 - to) + here * to;
                before = here;
            }
        }
    }
    if from > 0.0 && to > 0.0 {
        let t = from / to;
        for r in 1..count {
            let mut after = row[count - r];
            for value in row[..count - r].iter_mut().rev() {
                let here = *value;
                *value = here * (1.0 - t) + after * t;
                after = here;
            }
        }
    }
}

/// The same for curves side by side: rows of `width` coefficients, one of each.
fn cut_rows<V: Height>(values: &mut [V], width: usize, (from, to): (f64, f64)) {
    let count = values.len() / width;
    let mut mix = |low: usize, target: usize, t: f64| {
        let (a, b) = values[low * width..(low + 2) * width].split_at_mut(width);
        for (a, b) in a.iter_mut().zip(b) {
            let mixed = *a * (1.0 - t) + *b * t;
            *(if target == low { a } else { b }) = mixed;
        }
    };
    if to < 1.0 {
        for r in 1..count {
            for i in (r..count).rev() {
                mix(i - 1, i, to);
            }
        }
    }
    if from > 0.0 && to > 0.0 {
        for r in 1..count {
            for i in 0..count - r {
                mix(i, i, from / to);
            }
        }
    }
}

/// The value at (u, v), 0 to 1, of a net.
fn sum<V: Height, const N: usize>([m, n]: [usize; 2], values: &[V], u: f64, v: f64) -> V {
    let (mut bu, mut bv) = ([0.0; N], [0.0; N]);
    bernstein::values(m, u, &mut bu);
    bernstein::values(n, v, &mut bv);
    let row = |values: &[V]| {
        let mut sum = values[0] * bv[0];
        for (value, b) in values[1..].iter().zip(&bv[1..]) {
            sum = sum + *value * *b;
        }
        sum
    };
    let mut rows = values.chunks(n + 1);
    let mut total = rows.next().map_or(values[0], &row) * bu[0];
    for (values, b) in rows.zip(&bu[1..]) {
        total = total + row(values) * *b;
    }
    total
}
