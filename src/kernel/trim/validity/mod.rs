//! What is wrong with the trim loops of a face, and where: for marks and lists while somebody edits.
//!
//! Loops are cut to monotone pieces once; then ends are compared, pieces that may meet are intersected
//! (`crossing`), and loops are nested by points of theirs (`nesting`). Nothing is repaired here: drawing goes
//! on as trimming closes and nests things. Problems are ordered by loop and curve.
//!
//! Loops of a closed surface that lie periods apart are compared where they come to lie beside the largest one;
//! nesting is not judged when loops run round the surface.

mod crossing;
mod loops;
mod nesting;

use glam::DVec2;

use super::domain::UvRect;
use super::loop_record::LoopRecord;
use crate::kernel::nurbs::NurbsSurface;
use loops::CutLoop;

/// Ends further apart than this fraction of the domain are a gap: what trimming remarks on.
pub const GAP: f64 = 1e-6;
/// Reaching out by less than this fraction of the domain is rounding.
const BEYOND: f64 = 1e-6;
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

impl LoopProblem {
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
    let domain = UvRect::of_surface(surface);
    let mut problems = Vec::new();
    let cut = loops::cut(surface, &domain, loops, &mut problems);
    ends(&domain, loops, &mut problems);
    leaving(&domain, &cut, &mut problems);
    let size = domain.size().max_element();
    let crossings = crossing::find(&cut.loops, size);
    let crossed = |index: usize| {
        crossings.iter().any(|c: &LoopProblem| match c.kind {
            ProblemKind::Crosses { other } => c.at.trim_loop == index || other.trim_loop == index,
            _ => c.at.trim_loop == index,
        })
    };
    if !cut.rings {
        nesting::check(&cut.loops, loops, crossed, &mut problems);
    }
    problems.extend(crossings);
    problems.sort_by(|a, b| a.at.cmp(&b.at).then(b.severity().cmp(&a.severity())));
    problems
}

/// Curves without length or without direction at an end.
fn ends(domain: &UvRect, loops: &[&LoopRecord], problems: &mut Vec<LoopProblem>) {
    const SAME: f64 = 1e-12;
    let size = domain.size();
    let same = |a: DVec2, b: DVec2| ((a - b) / size).abs().max_element() <= SAME;
    for (trim_loop, record) in loops.iter().enumerate() {
        for (curve, nurbs) in record.curves.iter().enumerate() {
            let (points, at) = (nurbs.points(), At { trim_loop, curve });
            let uv = points[0];
            if points.iter().all(|p| same(*p, uv)) {
                problems.push(LoopProblem { at, uv, kind: ProblemKind::ZeroLength });
                continue;
            }
            let last = points.len() - 2;
            let firsts = if last == 0 { vec![] } else { vec![0, last] };
            for point in firsts {
                if same(points[point], points[point + 1]) {
                    let kind = ProblemKind::NoDirection { point };
                    problems.push(LoopProblem { at, uv: points[point], kind });
                }
            }
        }
    }
}

/// One problem for each curve that leaves the domain in a direction in which the surface is not closed.
fn leaving(domain: &UvRect, cut: &loops::Cut, problems: &mut Vec<LoopProblem>) {
    let size = domain.size();
    for CutLoop { index, pieces, .. } in &cut.loops {
        let mut worst: Option<LoopProblem> = None;
        for piece in pieces {
            for uv in [piece.start(), piece.end()] {
                let mut out = (domain.min - uv).max(uv - domain.max).max(DVec2::ZERO);
                for axis in 0..2 {
                    if cut.periods[axis] > 0.0 || out[axis] <= BEYOND * size[axis] {
                        out[axis] = 0.0;
                    }
                }
                let by = out.max_element();
                if by == 0.0 {
                    continue;
                }
                let at = At { trim_loop: *index, curve: piece.curve };
                let found = LoopProblem { at, uv, kind: ProblemKind::LeavesDomain { by } };
                match &mut worst {
                    Some(worst) if worst.at == at => {
                        if matches!(worst.kind, ProblemKind::LeavesDomain { by: most } if by > most) {
                            *worst = found;
                        }
                    }
                    _ => problems.extend(worst.replace(found)),
                }
            }
        }
        problems.extend(worst);
    }
}

#[cfg(test)]
mod tests;
