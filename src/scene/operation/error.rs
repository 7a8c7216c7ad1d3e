//! Why an operation is refused: what is wrong, and at which face, loop, curve or point, as users count them.

use crate::kernel::nurbs::NurbsError;
use crate::scene::edit::FaceId;

/// What an operation was about when it was refused.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq)]
pub struct Place {
    /// Face.
    pub face: Option<FaceId>,
    /// Position of the loop.
    pub trim_loop: Option<usize>,
    /// Position of the curve in its loop.
    pub curve: Option<usize>,
    /// Position of the control point in its curve.
    pub point: Option<usize>,
    /// Position of a surface control point along u and v.
    pub net: Option<(usize, usize)>,
}

/// A refused operation.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
#[error("{place}{problem}")]
pub struct OperationError {
    /// Where.
    pub place: Place,
    /// What is wrong.
    pub problem: Problem,
}

/// What is wrong with an operation.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum Problem {
    /// There is no such thing.
    #[error("there is no {what}; there are {count}")]
    Missing {
        /// `face 7`, `loop 2`, ...
        what: String,
        /// How many there are.
        count: usize,
    },
    /// The list of things to change is empty.
    #[error("nothing is named that could change ({what} is empty)")]
    Nothing {
        /// Name of the empty list.
        what: &'static str,
    },
    /// A weight that is not positive and finite.
    #[error("weight {value} is not positive and finite")]
    Weight {
        /// The weight.
        value: f64,
    },
    /// A number that must be finite or positive is not.
    #[error("{what} is {value}; it must be {expected}")]
    Number {
        /// Name of the number.
        what: &'static str,
        /// Its value.
        value: f64,
        /// What it should be.
        expected: &'static str,
    },
    /// A coordinate too far away to mean anything.
    #[error("{what} would be {value}, beyond the limit of {limit:.3e}")]
    Absurd {
        /// Name of the coordinate.
        what: &'static str,
        /// Its value.
        value: f64,
        /// Largest size allowed.
        limit: f64,
    },
    /// A point outside the domain of the surface, where none may be.
    #[error("({u}, {v}) is outside the surface's domain: u from {} to {}, v from {} to {}", .domain[0], .domain[1], .domain[2], .domain[3])]
    OutsideDomain {
        /// First parameter.
        u: f64,
        /// Second parameter.
        v: f64,
        /// Smallest and largest u, smallest and largest v.
        domain: [f64; 4],
    },
    /// The curve or surface refuses.
    #[error("{0}")]
    Nurbs(#[from] NurbsError),
    /// The shape would change by more than allowed.
    #[error("{what} would change the shape by {deviation:.3e}, more than the tolerance of {tolerance:.3e}")]
    Deviation {
        /// What was to be done.
        what: &'static str,
        /// Largest change found.
        deviation: f64,
        /// Largest change allowed.
        tolerance: f64,
    },
    /// Anything else, in words.
    #[error("{reason}")]
    Refused {
        /// Why.
        reason: String,
    },
}

impl Place {
    /// A face.
    pub fn face(face: FaceId) -> Self {
        Self { face: Some(face), ..Self::default() }
    }

    /// A loop of a face.
    pub fn trim_loop(face: FaceId, trim_loop: usize) -> Self {
        Self { trim_loop: Some(trim_loop), ..Self::face(face) }
    }

    /// A curve of a loop.
    pub fn curve(face: FaceId, trim_loop: usize, curve: usize) -> Self {
        Self { curve: Some(curve), ..Self::trim_loop(face, trim_loop) }
    }

    /// A control point of a curve.
    pub fn point(face: FaceId, trim_loop: usize, curve: usize, point: usize) -> Self {
        Self { point: Some(point), ..Self::curve(face, trim_loop, curve) }
    }

    /// A control point of the surface of a face.
    pub fn net(face: FaceId, i: usize, j: usize) -> Self {
        Self { net: Some((i, j)), ..Self::face(face) }
    }

    /// The error of `problem` here.
    pub fn error(self, problem: impl Into<Problem>) -> OperationError {
        OperationError { place: self, problem: problem.into() }
    }

    /// The error that something does not exist here.
    pub fn missing(self, what: impl Into<String>, count: usize) -> OperationError {
        self.error(Problem::Missing { what: what.into(), count })
    }

    /// The error for `reason`.
    pub fn refused(self, reason: impl Into<String>) -> OperationError {
        self.error(Problem::Refused { reason: reason.into() })
    }
}

impl std::fmt::Display for Place {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        let Some(face) = self.face else { return Ok(()) };
        write!(f, "{face}")?;
        for (name, at) in [("loop", self.trim_loop), ("curve", self.curve), ("point", self.point)] {
            if let Some(at) = at {
                write!(f, ", {name} {}", at + 1)?;
            }
        }
        if let Some((i, j)) = self.net {
            write!(f, ", surface point {} {}", i + 1, j + 1)?;
        }
        write!(f, ": ")
    }
}
