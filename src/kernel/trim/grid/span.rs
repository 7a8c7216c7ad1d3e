//! Which columns of each row a segment may touch.
//!
//! Conservative and without root finding: the curve is cut at evenly spaced parameters until the band
//! around each chord (fat bounds) is narrower than a cell; the band clipped to the row's strip gives
//! the range in u. Margins cover the rounding of cell numbers and of the query's evaluation.

use super::frame::Frame;
use crate::kernel::trim::record::{self, entry_degree};
use crate::kernel::trim::segment::Segment;

/// Rounding of positions and cell numbers, in uv.
pub(super) const MARGIN: f64 = 2e-7;
/// Rounding of the f32 evaluation, as a fraction of the segment's box.
pub(super) const EVALUATION: f64 = 2e-6;

/// Width of a band that is narrow beside a cell, in cells: less lists fewer segments for nothing and costs more to build.
const NARROW: f64 = 0.25;

/// The columns of one row that a segment may touch: left of `first` it is entirely to the right of a
/// cell, right of `last` entirely to the left.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Span {
    /// First column, the number of columns when it is right of all.
    pub first: i32,
    /// Last column, -1 when it is left of all.
    pub last: i32,
}

/// Rows of `frame` that a segment reaches, as first and last; empty when `first > last`.
pub fn rows(frame: &Frame, segment: &Segment) -> (i32, i32) {
    (frame.row(segment.ends[1]).max(0), frame.row(segment.ends[3]).min(frame.rows - 1))
}

/// Appends the spans of `segment` in rows `first..=last` (from [`rows`]) to `spans`.
pub fn append(
    frame: &Frame,
    segment: &Segment,
    word: u32,
    data: &[[u32; 4]],
    (first, last): (i32, i32),
    spans: &mut Vec<Span>,
) {
    let [u0, v0, u1, v1] = segment.ends;
    let (left, right) = (u0.min(u1), u0.max(u1));
    if right == 0.0 {
        // On the left border: never to the right of a point.
        spans.extend((first..=last).map(|_| Span { first: -1, last: -1 }));
        return;
    }
    if first == last || left == right {
        let span = Span { first: frame.column(left), last: frame.column(right) };
        spans.extend((first..=last).map(|_| span));
        return;
    }
    let start = spans.len();
    let empty = Ranges { low: f64::INFINITY, high: f64::NEG_INFINITY };
    let mut ranges = vec![empty; (last - first + 1) as usize];
    let e = [f64::from(u0), f64::from(v0), f64::from(u1), f64::from(v1)];
    let (width, height) = ((e[2] - e[0]).abs(), e[3] - e[1]);
    let mut strip = Strips { frame, first, ranges: &mut ranges, margin_v: MARGIN + EVALUATION * height };
    if entry_degree(word) == 1 {
        strip.part([e[0], e[1]], [e[2], e[3]], 0.0, 0.0);
    } else {
        let curve = record::Curve::new(data, word, segment.ends);
        let (low, high) = curve.bounds();
        let (low, high) = (f64::from(low), f64::from(high));
        let parts = part_count((high - low) / height, width, frame.cell_width());
        let band = 1.0 / f64::from(parts).powi(3);
        let mut a = [e[0], e[1]];
        for k in 1..=parts {
            let b = if k == parts {
                [e[2], e[3]]
            } else {
                let p = curve.point(k as f32 / parts as f32);
                let b = [e[0] + f64::from(p[0]), e[1] + f64::from(p[1])];
                [b[0].clamp(e[0].min(e[2]), e[0].max(e[2])), b[1].clamp(a[1], e[3])]
            };
            strip.part(a, b, low * band, high * band);
            a = b;
        }
    }
    let margin = MARGIN + EVALUATION * width;
    // The ends themselves belong to their rows whatever the clipping above made of them.
    for (row, u) in [(frame.row(v0), u0), (frame.row(v1), u1)] {
        if let Some(range) = usize::try_from(row - first).ok().and_then(|i| ranges.get_mut(i)) {
            range.include(f64::from(u));
        }
    }
    for range in &ranges {
        let low = ((range.low - margin) as f32).max(left);
        let high = ((range.high + margin) as f32).min(right);
        spans.push(Span { first: frame.column(low), last: frame.column(high) });
    }
    debug_assert_eq!(spans.len() - start, ranges.len());
}

/// How many parts make the band (`deviation` wide for the whole curve) narrow beside a cell.
fn part_count(deviation: f64, width: f64, cell: f64) -> u32 {
    let mut parts = 1;
    let mut deviation = deviation.min(2.0 * width);
    while deviation > NARROW * cell && parts < 64 {
        parts *= 2;
        deviation *= 0.25;
    }
    parts
}

#[derive(Clone, Copy)]
struct Ranges {
    low: f64,
    high: f64,
}

impl Ranges {
    fn include(&mut self, u: f64) {
        self.low = self.low.min(u);
        self.high = self.high.max(u);
    }
}

struct Strips<'a> {
    frame: &'a Frame,
    first: i32,
    ranges: &'a mut [Ranges],
    margin_v: f64,
}

impl Strips<'_> {
    /// Enters the part of a curve from `a` to `b` whose cross products with its chord lie in `[low, high]`.
    fn part(&mut self, a: [f64; 2], b: [f64; 2], low: f64, high: f64) {
        let row = |v: f64| self.frame.row(v.max(0.0) as f32) - self.first;
        let from = row(a[1] - self.margin_v).max(0) as usize;
        let to = (row(b[1] + self.margin_v) + 1).clamp(0, self.ranges.len() as i32) as usize;
        let (left, right) = (a[0].min(b[0]), a[0].max(b[0]));
        let height = b[1] - a[1];
        for index in from..to {
            let range = &mut self.ranges[index];
            let (bottom, top) = self.frame.strip(self.first + index as i32);
            let (v0, v1) = ((bottom - self.margin_v).max(a[1]), (top + self.margin_v).min(b[1]));
            if height <= 2.0 * self.margin_v || v0 > v1 {
                range.include(left);
                range.include(right);
                continue;
            }
            let slope = (b[0] - a[0]) / height;
            let (x, y) = (a[0] + (v0 - a[1]) * slope, a[0] + (v1 - a[1]) * slope);
            range.include((x.min(y) + low / height).clamp(left, right));
            range.include((x.max(y) + high / height).clamp(left, right));
        }
    }
}
