//! Writes segments as packed f32 records (layout: [`grid::layout`](super::grid::layout)).

use glam::DVec2;

use super::fat;
use super::grid::layout::ENTRY_SHIFT;
use super::pieces::PieceList;
use super::record::entry_word;
use super::resume::Splice;
use super::segment::{Segment, SegmentSet};
use crate::kernel::bezier::bernstein::binomial_row;

/// Records of all segments of a face and, for each, its entry word without lo and hi bits.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct PackedSegments {
    /// Records, 16-byte units.
    pub data: Vec<[u32; 4]>,
    /// Entry words, one for each segment.
    pub words: Vec<u32>,
}

/// A face whose records do not fit the 22-bit addresses of entry words.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
#[error("{segments} trim segments need more than 64 MiB of records")]
pub struct TooManySegments {
    /// Number of segments.
    pub segments: usize,
}

impl PackedSegments {
    /// Packs all segments.
    ///
    /// # Errors
    /// When the records take more than 64 MiB.
    pub fn new(list: &PieceList, set: &SegmentSet) -> Result<Self, TooManySegments> {
        let mut packed = Self {
            data: Vec::with_capacity(2 * set.segments.len()),
            words: Vec::with_capacity(set.segments.len()),
        };
        packed.append(list, set, 0..set.segments.len())?;
        Ok(packed)
    }

    /// Packs the segments of an edited face; records of those not in `splices` are copied from `data`, the
    /// records of `before`. Also says where records of `data` went.
    ///
    /// # Errors
    /// When the records take more than 64 MiB.
    pub fn after_edit(
        (list, set): (&PieceList, &SegmentSet),
        (list_before, before, data): (&PieceList, &SegmentSet, &[[u32; 4]]),
        splices: &[Splice],
    ) -> Result<(Self, Vec<Move>), TooManySegments> {
        let mut packed = Self {
            data: Vec::with_capacity(data.len() + data.len() / 8),
            words: Vec::with_capacity(set.segments.len()),
        };
        let (mut done, mut moves) = (0, Vec::with_capacity(splices.len()));
        // Where the next record of `before` is, and the one of its first segment not copied yet.
        let mut from = 0;
        let end = Splice {
            before: before.segments.len()..before.segments.len(),
            after: set.segments.len()..set.segments.len(),
        };
        for splice in splices.iter().chain([&end]) {
            let mut address = packed.data.len();
            let start = from;
            for segment in &set.segments[done..splice.after.start] {
                let (degree, rational) = shape(list, segment);
                if address >= 1 << (32 - ENTRY_SHIFT) {
                    return Err(TooManySegments { segments: set.segments.len() });
                }
                packed.words.push(entry_word(address as u32, degree as u32, rational, segment.down));
                let units = units(degree, rational);
                address += units;
                from += units;
            }
            packed.data.extend_from_slice(&data[start..from]);
            packed.append(list, set, splice.after.clone())?;
            from += before.segments[splice.before.clone()]
                .iter()
                .map(|s| shape(list_before, s))
                .map(|(degree, rational)| units(degree, rational))
                .sum::<usize>();
            moves.push(Move { from: from as u32, by: (packed.data.len() as u32).wrapping_sub(from as u32) });
            done = splice.after.end;
        }
        Ok((packed, moves))
    }

    /// Packs some segments behind the others.
    fn append(
        &mut self,
        list: &PieceList,
        set: &SegmentSet,
        segments: std::ops::Range<usize>,
    ) -> Result<(), TooManySegments> {
        let mut scratch = Scratch::default();
        for segment in &set.segments[segments] {
            let address = self.data.len();
            if address >= 1 << (32 - ENTRY_SHIFT) {
                return Err(TooManySegments { segments: set.segments.len() });
            }
            let word = scratch.record(list, segment, address as u32, &mut self.data);
            self.words.push(word);
        }
        Ok(())
    }
}

/// Where records went: those at `from` and above, up to the next move, are `by` further on (modulo 2^32).
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Move {
    /// Address before.
    pub from: u32,
    /// Added to it.
    pub by: u32,
}

/// Degree of the curve in a segment's record, and whether that is rational.
fn shape(list: &PieceList, segment: &Segment) -> (usize, bool) {
    let piece = &list.pieces()[segment.piece as usize];
    let degree = piece.degree as usize;
    let is_line = degree == 1 || segment.is_horizontal() || segment.ends[0] == segment.ends[2];
    if is_line { (1, false) } else { (degree, piece.rational) }
}

/// Length of a record in units of 16 bytes.
fn units(degree: usize, rational: bool) -> usize {
    match (degree, rational) {
        (1, _) => 1,
        (3, false) => 2,
        _ => 1 + (1 + (degree - 1) * if rational { 3 } else { 2 }).div_ceil(4),
    }
}

#[derive(Default)]
struct Scratch {
    weights: Vec<f64>,
    words: Vec<f32>,
}

impl Scratch {
    /// Appends the record of `segment` to `data`; the result is its entry word.
    fn record(&mut self, list: &PieceList, segment: &Segment, address: u32, data: &mut Vec<[u32; 4]>) -> u32 {
        data.push(segment.ends.map(f32::to_bits));
        let piece = &list.pieces()[segment.piece as usize];
        let (degree, rational) = shape(list, segment);
        if degree == 1 {
            return entry_word(address, 1, false, segment.down);
        }
        let points = list.points(piece);
        let at = |i: usize| if segment.down { degree - i } else { i };
        self.standard_weights(list.weights(piece), segment.down);
        let origin = DVec2::new(f64::from(segment.ends[0]), f64::from(segment.ends[1]));
        let compact = degree == 3 && !rational;
        self.words.clear();
        let binomials = binomial_row(degree);
        for i in 1..degree {
            let w = binomials[i] * self.weights[i];
            let q = (points[at(i)] - origin) * w;
            self.words.extend([q.x as f32, q.y as f32]);
            if rational {
                self.words.push(w as f32);
            }
        }
        let fat = (!compact).then(|| fat::pack(fat::bounds(&self.words, degree, rational, segment.ends)));
        let mut bits = fat.into_iter().chain(self.words.iter().map(|x| x.to_bits())).peekable();
        while bits.peek().is_some() {
            data.push(std::array::from_fn(|_| bits.next().unwrap_or(0)));
        }
        entry_word(address, degree as u32, rational, segment.down)
    }

    /// Weights from the lower end up, changed to 1 at both ends by a rational change of the parameter,
    /// which moves no point of the curve and spreads the parameter more evenly.
    fn standard_weights(&mut self, weights: &[f64], reverse: bool) {
        self.weights.clear();
        self.weights.extend_from_slice(weights);
        if reverse {
            self.weights.reverse();
        }
        let n = weights.len() - 1;
        let first = self.weights[0];
        let factor = (first / self.weights[n]).powf(1.0 / n as f64);
        let mut power = 1.0 / first;
        for w in &mut self.weights {
            *w *= power;
            power *= factor;
        }
    }
}
