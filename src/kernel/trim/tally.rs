//! Counting what a classification costs, at no cost when nobody asks.

/// Told of each step of a classification.
pub trait Tally {
    /// A point lay in the box of a segment, so the segment had to be looked at.
    fn test(&mut self) {}
    /// The curve of a segment was evaluated.
    fn evaluation(&mut self) {}
    /// The steps ran out and the side of the last chord was taken.
    fn undecided(&mut self) {}
}

/// Counts nothing.
impl Tally for () {}

/// Totals over any number of classifications.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq)]
pub struct Counters {
    /// Points found inside a segment's box.
    pub tests: u64,
    /// Curve evaluations.
    pub evaluations: u64,
    /// Points decided by the last chord because the steps ran out.
    pub undecided: u64,
}

impl Tally for Counters {
    fn test(&mut self) {
        self.tests += 1;
    }
    fn evaluation(&mut self) {
        self.evaluations += 1;
    }
    fn undecided(&mut self) {
        self.undecided += 1;
    }
}
