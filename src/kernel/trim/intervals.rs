//! P1's structure (Schollmeyer & Froehlich 2009, section 4), the reference and the baseline.
//!
//! The ends of all segments cut the v-axis into intervals; every segment is clipped to every interval it passes.
//! Inside an interval the boxes of the clipped segments cut the u-axis into intervals that know how many
//! segments lie entirely to the right and which ones have to be asked. A query is two binary searches and
//! P1's bisection with early out (no fat bounds). Memory grows with segments times intervals.

mod cells;

use glam::{DVec2, Vec2};

pub use cells::IntervalCell;

use super::pieces::{Piece, PieceList};
use super::segment::SegmentSet;
use super::tally::{Counters, Tally};
use super::{FillRule, TrimStructure, clamp_to_square, oracle};
use crate::kernel::bezier::BezierCurve2;

/// A segment clipped to a v-interval.
#[derive(Debug, Clone, Copy, PartialEq)]
struct Clipped {
    /// `u0 v0 u1 v1`, lower and upper end.
    ends: [f32; 4],
    /// First of its control values.
    first: u32,
    degree: u16,
    rational: bool,
    down: bool,
}

/// A u-interval: from `start` to the start of the next one.
#[derive(Debug, Clone, Copy, PartialEq)]
struct UInterval {
    start: f32,
    /// Winding of everything entirely to the right.
    definite: i32,
    /// First candidate.
    candidates: u32,
}

/// P1's two-level interval lists.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct IntervalLists {
    /// Borders of the v-intervals.
    heights: Vec<f32>,
    /// First u-interval of each v-interval, one more at the end.
    rows: Vec<u32>,
    intervals: Vec<UInterval>,
    candidates: Vec<u32>,
    clipped: Vec<Clipped>,
    /// Bernstein coefficients (scaled, relative to the lower end): u v, or u v w.
    values: Vec<f32>,
    rule: FillRule,
}

/// More clipped curves than this are not built.
const MOST_CLIPPED: usize = 1 << 25;

impl IntervalLists {
    /// Builds the structure.
    pub fn new(list: &PieceList, set: &SegmentSet, rule: FillRule) -> Self {
        Self::bounded(list, set, rule, MOST_CLIPPED).unwrap_or_default()
    }

    /// Number of curves after clipping to the v-intervals.
    pub fn clipped_count(&self) -> usize {
        self.clipped.len()
    }

    /// The same number without building anything.
    pub fn count_clipped(set: &SegmentSet) -> usize {
        let heights = heights(set);
        let row = |v: f32| heights.partition_point(|h| *h < v);
        set.segments.iter().map(|s| row(s.ends[3]) - row(s.ends[1])).sum()
    }

    /// Builds the structure unless it would hold more than `most` clipped curves.
    pub fn bounded(list: &PieceList, set: &SegmentSet, rule: FillRule, most: usize) -> Option<Self> {
        let mut result = Self { heights: heights(set), rule, ..Self::default() };
        if result.heights.len() < 2 {
            result.heights.clear();
            return Some(result);
        }
        let mut by_row: Vec<Vec<u32>> = vec![Vec::new(); result.heights.len() - 1];
        for segment in set.segments.iter().filter(|s| !s.is_horizontal()) {
            let piece = &list.pieces()[segment.piece as usize];
            let first = result.heights.partition_point(|h| *h < segment.ends[1]);
            let last = result.heights.partition_point(|h| *h < segment.ends[3]);
            if result.clipped.len() + last - first > most {
                return None;
            }
            result.clip(list, piece, segment.ends, segment.down, first..last, &mut by_row);
        }
        for row in &by_row {
            result.rows.push(result.intervals.len() as u32);
            result.add_row(row);
        }
        result.rows.push(result.intervals.len() as u32);
        // Ends the candidates of the last interval.
        result.intervals.push(UInterval {
            start: f32::INFINITY,
            definite: 0,
            candidates: result.candidates.len() as u32,
        });
        Some(result)
    }

    /// Cuts one segment at the heights it passes.
    fn clip(
        &mut self,
        list: &PieceList,
        piece: &Piece,
        ends: [f32; 4],
        down: bool,
        rows: std::ops::Range<usize>,
        by_row: &mut [Vec<u32>],
    ) {
        let curve =
            BezierCurve2 { points: list.points(piece).to_vec(), weights: list.weights(piece).to_vec() };
        let curve = if down { curve.reversed() } else { curve };
        let (mut t, mut from) = (0.0, [ends[0], ends[1]]);
        for row in rows.clone() {
            let (to_t, to) = if row + 1 == rows.end {
                (1.0, [ends[2], ends[3]])
            } else {
                let v = self.heights[row + 1];
                let at = parameter_at(list, piece, down, f64::from(v)).max(t);
                let u = oracle::point(list, piece, if down { 1.0 - at } else { at }).x as f32;
                (at, [u.clamp(ends[0].min(ends[2]), ends[0].max(ends[2])), v])
            };
            by_row[row].push(self.clipped.len() as u32);
            let part = if t == 0.0 && to_t == 1.0 { curve.clone() } else { part_of(&curve, t, to_t) };
            self.add_clipped(&part, [from[0], from[1], to[0], to[1]], piece.rational, down);
            (t, from) = (to_t, to);
        }
    }

    fn add_clipped(&mut self, part: &BezierCurve2, ends: [f32; 4], rational: bool, down: bool) {
        let first = self.values.len() as u32;
        let n = part.degree();
        let origin = DVec2::new(f64::from(ends[0]), f64::from(ends[1]));
        let last = DVec2::new(f64::from(ends[2]), f64::from(ends[3]));
        let mut binomial = 1.0;
        for i in 0..=n {
            let w = part.weights[i] / part.weights[0];
            let p = if i == 0 {
                origin
            } else if i == n {
                last
            } else {
                part.points[i]
            };
            let q = (p - origin) * (binomial * w);
            self.values.extend([q.x as f32, q.y as f32]);
            if rational {
                self.values.push((binomial * w) as f32);
            }
            binomial *= (n - i) as f64 / (i + 1) as f64;
        }
        self.clipped.push(Clipped { ends, first, degree: n as u16, rational, down });
    }

    /// The u-intervals of one v-interval.
    fn add_row(&mut self, row: &[u32]) {
        let range = |c: &Clipped| (c.ends[0].min(c.ends[2]), c.ends[0].max(c.ends[2]));
        let mut starts: Vec<f32> = row
            .iter()
            .flat_map(|i| {
                let (low, high) = range(&self.clipped[*i as usize]);
                [low, high]
            })
            .collect();
        starts.push(f32::NEG_INFINITY);
        starts.sort_unstable_by(f32::total_cmp);
        starts.dedup();
        let sign = |c: &Clipped| if c.down { -1 } else { 1 };
        // Sweep from left to right over sorted boxes.
        let mut by_low: Vec<u32> = row.to_vec();
        by_low.sort_by(|a, b| {
            range(&self.clipped[*a as usize]).0.total_cmp(&range(&self.clipped[*b as usize]).0)
        });
        let mut right: i32 = row.iter().map(|i| sign(&self.clipped[*i as usize])).sum();
        let (mut next, mut active) = (0, Vec::<u32>::new());
        for start in starts {
            while next < by_low.len() && range(&self.clipped[by_low[next] as usize]).0 <= start {
                right -= sign(&self.clipped[by_low[next] as usize]);
                active.push(by_low[next]);
                next += 1;
            }
            active.retain(|i| range(&self.clipped[*i as usize]).1 > start);
            let candidates = self.candidates.len() as u32;
            self.candidates.extend_from_slice(&active);
            self.intervals.push(UInterval { start, definite: right, candidates });
        }
    }

    fn inside(&self, uv: Vec2, tally: &mut impl Tally) -> bool {
        let Some(p) = clamp_to_square(uv) else { return false };
        let row = self.heights.partition_point(|h| *h <= p.y);
        if row == 0 || row >= self.heights.len() {
            return false;
        }
        let (first, end) = (self.rows[row - 1] as usize, self.rows[row] as usize);
        if first == end {
            return false;
        }
        let index = first + self.intervals[first..end].partition_point(|i| i.start <= p.x) - 1;
        let (interval, after) = (self.intervals[index], self.intervals[index + 1].candidates);
        let mut winding = interval.definite;
        for candidate in &self.candidates[interval.candidates as usize..after as usize] {
            let clipped = &self.clipped[*candidate as usize];
            if self.crosses(clipped, p, tally) {
                winding += if clipped.down { -1 } else { 1 };
            }
        }
        match self.rule {
            FillRule::EvenOdd => winding & 1 != 0,
            FillRule::NonZero => winding != 0,
        }
    }

    /// P1's bisection with early out, for a point inside the box.
    fn crosses(&self, c: &Clipped, p: Vec2, tally: &mut impl Tally) -> bool {
        tally.test();
        let q = [p.x - c.ends[0], p.y - c.ends[1]];
        let (mut a, mut b) = ([0.0f32; 2], [c.ends[2] - c.ends[0], c.ends[3] - c.ends[1]]);
        let (mut t, mut dt) = (0.0f32, 1.0f32);
        for _ in 0..24 {
            dt *= 0.5;
            let m = self.point(c, t + dt);
            tally.evaluation();
            if q[1] >= m[1] {
                a = m;
                t += dt;
            } else {
                b = m;
            }
            if q[0] < a[0].min(b[0]) {
                return true;
            }
            if q[0] >= a[0].max(b[0]) {
                return false;
            }
        }
        tally.undecided();
        (q[0] - a[0]) * (b[1] - a[1]) < (q[1] - a[1]) * (b[0] - a[0])
    }

    fn point(&self, c: &Clipped, t: f32) -> [f32; 2] {
        let s = 1.0 - t;
        let stride = if c.rational { 3 } else { 2 };
        let values = &self.values[c.first as usize..c.first as usize + stride * (c.degree as usize + 1)];
        let (mut power, mut x, mut y, mut w) = (1.0f32, 0.0f32, 0.0f32, 0.0f32);
        for value in values.chunks_exact(stride) {
            x = x * s + power * value[0];
            y = y * s + power * value[1];
            if c.rational {
                w = w * s + power * value[2];
            }
            power *= t;
        }
        if c.rational { [x / w, y / w] } else { [x, y] }
    }
}

/// Borders of the v-intervals: the ends of all segments.
fn heights(set: &SegmentSet) -> Vec<f32> {
    let mut heights: Vec<f32> = set.segments.iter().flat_map(|s| [s.ends[1], s.ends[3]]).collect();
    heights.sort_unstable_by(f32::total_cmp);
    heights.dedup();
    heights
}

/// Parameter (from the lower end up) at which a piece has height `v`.
fn parameter_at(list: &PieceList, piece: &Piece, down: bool, v: f64) -> f64 {
    let (mut low, mut high) = (0.0, 1.0);
    for _ in 0..52 {
        let t = 0.5 * (low + high);
        let y = oracle::point(list, piece, if down { 1.0 - t } else { t }).y;
        if y <= v { low = t } else { high = t }
    }
    0.5 * (low + high)
}

fn part_of(curve: &BezierCurve2, a: f64, b: f64) -> BezierCurve2 {
    if b > a { curve.restrict(a, b) } else { BezierCurve2::polynomial(vec![curve.point(a); 2]) }
}

impl TrimStructure for IntervalLists {
    fn classify(&self, uv: Vec2) -> bool {
        self.inside(uv, &mut ())
    }

    fn classify_counted(&self, uv: Vec2, counters: &mut Counters) -> bool {
        self.inside(uv, counters)
    }

    fn memory_bytes(&self) -> usize {
        4 * (self.heights.len() + self.rows.len() + self.candidates.len() + self.values.len())
            + size_of::<UInterval>() * self.intervals.len()
            + size_of::<Clipped>() * self.clipped.len()
    }
}
