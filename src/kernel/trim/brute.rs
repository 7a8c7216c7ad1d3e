//! The yardstick: every segment is asked for every point.

use glam::Vec2;

use super::grid::layout::ENTRY_DOWN;
use super::grid::layout::ENTRY_SHIFT;
use super::pack::PackedSegments;
use super::record::{crossing, load};
use super::tally::{Counters, Tally};
use super::{FillRule, TrimStructure, clamp_to_square};

/// Classification without any structure.
#[derive(Debug, Clone, PartialEq)]
pub struct BruteForce {
    packed: PackedSegments,
    rule: FillRule,
}

impl BruteForce {
    /// Takes the records of all segments.
    pub fn new(packed: PackedSegments, rule: FillRule) -> Self {
        Self { packed, rule }
    }

    fn inside(&self, uv: Vec2, tally: &mut impl Tally) -> bool {
        let Some(p) = clamp_to_square(uv) else { return false };
        let mut winding = 0;
        for word in &self.packed.words {
            let address = (word >> ENTRY_SHIFT) as usize;
            let ends = load(&self.packed.data, address);
            if p.y >= ends[1]
                && p.y < ends[3]
                && crossing(&self.packed.data, address, ends, *word, p.x, p.y, tally)
            {
                winding += if word & ENTRY_DOWN != 0 { -1 } else { 1 };
            }
        }
        match self.rule {
            FillRule::EvenOdd => winding & 1 != 0,
            FillRule::NonZero => winding != 0,
        }
    }
}

impl TrimStructure for BruteForce {
    fn classify(&self, uv: Vec2) -> bool {
        self.inside(uv, &mut ())
    }

    fn classify_counted(&self, uv: Vec2, counters: &mut Counters) -> bool {
        self.inside(uv, counters)
    }

    fn memory_bytes(&self) -> usize {
        16 * self.packed.data.len() + 4 * self.packed.words.len()
    }
}
