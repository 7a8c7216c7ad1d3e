//! What is wrong with the trim loops of a face, and where: for marks and lists while somebody edits.
//!
//! Loops are cut to monotone pieces once; then ends are compared, pieces that may meet are intersected
//! (`crossing`), and loops are nested by points of theirs (`nesting`). Nothing is repaired here: drawing goes
//! on as trimming closes and nests things. Problems are ordered by loop and curve.
//!
//! Loops of a closed surface that lie periods apart are compared where they come to lie beside the largest one;
//! nesting is not judged when loops run round the surface.

mod crossing;
mod curves;
mod loops;
mod memory;
mod nesting;

use glam::DVec2;

use super::loop_record::LoopRecord;
use crate::kernel::nurbs::NurbsSurface;
use memory::State;

pub use memory::Memory;

/// Ends further apart than this fraction of the domain are a gap: what trimming remarks on.
pub const GAP: f64 = 1e-6;
/// Most problems of one kind reported for one face.
pub const MOST: usize = 1000;

/// How bad a problem is.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub enum Severity {
    /// Nothing is drawn wrong.
    Note,
    /// Drawn by a rule that may not be meant.
    Warning,
    /// The face is not what its loops say.
    Error,
}

/// A curve of a loop, by position.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub struct At {
    /// Loop.
    pub trim_loop: usize,
    /// Curve in the loop.
    pub curve: usize,
}

/// One problem and where it is.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct LoopProblem {
    /// The curve concerned (the first one, where it is about a whole loop).
    pub at: At,
    /// Place in native parameters.
    pub uv: DVec2,
    /// What is wrong.
    pub kind: ProblemKind,
}

/// What is wrong.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum ProblemKind {
    /// The loop has no curves, or all of it is one point.
    Empty,
    /// The curve's end is this far from the next one's start, in native parameters.
    Open {
        /// Length of the gap.
        gap: f64,
    },
    /// The curve crosses or touches another part of its own loop.
    CrossesItself {
        /// The other curve; the same one for a curve with a loop of its own.
        curve: usize,
    },
    /// The curve crosses or touches another loop.
    Crosses {
        /// The other curve.
        other: At,
    },
    /// The curve leaves the domain of the surface by this much, in native parameters.
    LeavesDomain {
        /// Largest distance beyond.
        by: f64,
    },
    /// An outer loop inside another one, where it is drawn as the border of a hole.
    OuterInside {
        /// Loop around it.
        around: usize,
    },
    /// A hole that is in no outer loop, so that it is drawn as a face.
    HoleOutside,
    /// The curve is one point.
    ZeroLength,
    /// Control points at this end of the curve coincide, so that it has no direction there.
    NoDirection {
        /// Position of the first of them.
        point: usize,
    },
}

impl ProblemKind {
    /// Tells kinds and what they name apart.
    fn rank(&self) -> (u8, usize, usize) {
        match *self {
            Self::Empty => (0, 0, 0),
            Self::Open { .. } => (1, 0, 0),
            Self::CrossesItself { curve } => (2, curve, 0),
            Self::Crosses { other } => (3, other.trim_loop, other.curve),
            Self::LeavesDomain { .. } => (4, 0, 0),
            Self::OuterInside { around } => (5, around, 0),
            Self::HoleOutside => (6, 0, 0),
            Self::ZeroLength => (7, 0, 0),
            Self::NoDirection { point } => (8, point, 0),
        }
    }
}

impl LoopProblem {
    /// Whether something is drawn wrong or may be, so that it is worth a mark in a picture.
    pub fn is_serious(&self) -> bool {
        self.severity() > Severity::Note
    }

    /// By loop and curve, the worst first; a total order of all there can be.
    fn order(a: &Self, b: &Self) -> std::cmp::Ordering {
        let uv = a.uv.x.total_cmp(&b.uv.x).then(a.uv.y.total_cmp(&b.uv.y));
        a.at.cmp(&b.at).then(b.severity().cmp(&a.severity())).then(a.kind.rank().cmp(&b.kind.rank())).then(uv)
    }

    /// How bad it is.
    pub fn severity(&self) -> Severity {
        match self.kind {
            ProblemKind::Empty | ProblemKind::ZeroLength | ProblemKind::NoDirection { .. } => Severity::Note,
            ProblemKind::LeavesDomain { .. } | ProblemKind::OuterInside { .. } | ProblemKind::HoleOutside => {
                Severity::Warning
            }
            ProblemKind::Open { .. } | ProblemKind::CrossesItself { .. } | ProblemKind::Crosses { .. } => {
                Severity::Error
            }
        }
    }
}

impl std::fmt::Display for LoopProblem {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        let At { trim_loop, curve } = self.at;
        let (number, curve) = (trim_loop + 1, curve + 1);
        match self.kind {
            ProblemKind::Empty => write!(f, "loop {number} has no extent"),
            ProblemKind::Open { gap } => {
                write!(f, "loop {number} is open: a gap of {gap:.3e} in uv after curve {curve}")
            }
            ProblemKind::CrossesItself { curve: other } if other + 1 == curve => {
                write!(f, "loop {number}, curve {curve} crosses itself")
            }
            ProblemKind::CrossesItself { curve: other } => {
                write!(f, "loop {number} crosses itself: curve {curve} meets curve {}", other + 1)
            }
            ProblemKind::Crosses { other } => write!(
                f,
                "loop {number}, curve {curve} meets loop {}, curve {}",
                other.trim_loop + 1,
                other.curve + 1
            ),
            ProblemKind::LeavesDomain { by } => {
                write!(f, "loop {number}, curve {curve} leaves the surface by {by:.3e} in uv")
            }
            ProblemKind::OuterInside { around } => {
                write!(f, "outer loop {number} lies inside loop {} and is drawn as a hole", around + 1)
            }
            ProblemKind::HoleOutside => {
                write!(f, "hole {number} lies in no outer loop and is drawn as a face")
            }
            ProblemKind::ZeroLength => write!(f, "loop {number}, curve {curve} has no length"),
            ProblemKind::NoDirection { point } => write!(
                f,
                "loop {number}, curve {curve}: control points {} and {} coincide",
                point + 1,
                point + 2
            ),
        }
    }
}

/// The problems of a face's loops.
pub fn check(surface: &NurbsSurface, loops: &[&LoopRecord]) -> Vec<LoopProblem> {
    State::of(surface, loops).problems(loops)
}

#[cfg(test)]
mod tests;
