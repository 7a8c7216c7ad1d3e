//! Writes segments as packed f32 records (layout: [`grid::layout`](super::grid::layout)).

use glam::DVec2;

use super::fat;
use super::grid::layout::ENTRY_SHIFT;
use super::pieces::PieceList;
use super::record::entry_word;
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
        let mut scratch = Scratch::default();
        for segment in &set.segments {
            let address = packed.data.len();
            if address >= 1 << (32 - ENTRY_SHIFT) {
                return Err(TooManySegments { segments: set.segments.len() });
            }
            let word = scratch.record(list, segment, address as u32, &mut packed.data);
            packed.words.push(word);
        }
        Ok(packed)
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
        let degree = piece.degree as usize;
        if degree == 1 || segment.is_horizontal() || segment.ends[0] == segment.ends[2] {
            return entry_word(address, 1, false, segment.down);
        }
        let points = list.points(piece);
        let at = |i: usize| if segment.down { degree - i } else { i };
        self.standard_weights(list.weights(piece), segment.down);
        let origin = DVec2::new(f64::from(segment.ends[0]), f64::from(segment.ends[1]));
        let rational = piece.rational;
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
