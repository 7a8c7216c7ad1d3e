//! What can go wrong: with the file as a whole ([`ReadError`]) and with one entity ([`EntityError`]).

use std::path::PathBuf;

use crate::kernel::nurbs::{KnotError, NurbsError};

/// Why a file could not be read at all.
#[derive(Debug, thiserror::Error)]
pub enum ReadError {
    /// The file could not be opened or read.
    #[error("cannot read {}: {source}", path.display())]
    Io {
        /// The file.
        path: PathBuf,
        /// What the system said.
        source: std::io::Error,
    },
    /// No bytes, or white space only.
    #[error("the file is empty")]
    Empty,
    /// Another format: STEP, a mesh, an archive, ...
    #[error("line {line}: not an IGES file: {reason}")]
    NotIges {
        /// Line, from 1.
        line: usize,
        /// What it looks like instead.
        reason: String,
    },
    /// A form of IGES that is not read.
    #[error("line {line}: IGES in {form} form is not supported; export it again in fixed (ASCII) form")]
    Form {
        /// Line, from 1.
        line: usize,
        /// `"compressed"` or `"binary"`.
        form: &'static str,
    },
    /// A section without which nothing can be found.
    #[error("line {line}: the {section} section is missing; the file seems to be truncated here")]
    Section {
        /// Last line read.
        line: usize,
        /// The section.
        section: &'static str,
    },
    /// The caller asked to stop.
    #[error("reading was cancelled")]
    Cancelled,
}

/// Why one entity could not be used. Becomes a remark in the import report.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum EntityError {
    /// The parameter list ends too early.
    #[error("parameter {index} ({what}) is missing")]
    Missing {
        /// Position in the parameter list, from 1.
        index: usize,
        /// What it should be.
        what: &'static str,
    },
    /// Something else than a finite number where one is needed.
    #[error("parameter {index} ({what}) is `{found}`, not a finite number")]
    NotNumber {
        /// Position in the parameter list, from 1.
        index: usize,
        /// What it should be.
        what: &'static str,
        /// The text found.
        found: String,
    },
    /// A number outside of what makes sense.
    #[error("parameter {index} ({what}) is {value}; expected {expected}")]
    Range {
        /// Position in the parameter list, from 1.
        index: usize,
        /// What it should be.
        what: &'static str,
        /// The number.
        value: f64,
        /// What is accepted.
        expected: &'static str,
    },
    /// A count that calls for more parameters than there are.
    #[error("{what} is {count}, which calls for {needed} more parameters, but only {left} are left")]
    Count {
        /// What is counted.
        what: &'static str,
        /// The count.
        count: f64,
        /// Parameters it calls for.
        needed: f64,
        /// Parameters left.
        left: usize,
    },
    /// A pointer to a directory entry that does not exist.
    #[error("{what} points to directory entry {target}, which does not exist")]
    Pointer {
        /// What the pointer is for.
        what: &'static str,
        /// Where it points.
        target: f64,
    },
    /// A pointer to an entity of a type that cannot stand there.
    #[error("expected {expected}, found entity {kind} (directory entry {target})")]
    Kind {
        /// What was expected.
        expected: &'static str,
        /// Type found.
        kind: u32,
        /// Its directory entry.
        target: u64,
    },
    /// An entity that contains itself.
    #[error("directory entry {target} refers to itself through its parts")]
    Cycle {
        /// The entry met a second time.
        target: u64,
    },
    /// Nested so often that reading would not end in reasonable time.
    #[error("too many nested references")]
    Budget,
    /// The directory entry and the parameter data disagree, or there is no parameter data.
    #[error("no parameter data: {reason}")]
    Data {
        /// What is wrong.
        reason: String,
    },
    /// Numbers that do not make a curve or surface.
    #[error(transparent)]
    Nurbs(#[from] NurbsError),
    /// Geometry without extent, or otherwise without meaning.
    #[error("{0}")]
    Degenerate(String),
    /// A part of the entity is bad.
    #[error("{what} {target}: {source}")]
    Part {
        /// `"surface"`, `"curve"`, ...
        what: &'static str,
        /// Its directory entry.
        target: u64,
        /// What is wrong with it.
        source: Box<EntityError>,
    },
}

impl EntityError {
    /// Names the part that `self` is about.
    pub(crate) fn in_part(self, what: &'static str, target: u64) -> Self {
        match self {
            // One level of naming is enough to find the place.
            Self::Part { .. } => self,
            other => Self::Part { what, target, source: Box::new(other) },
        }
    }

    /// Wraps a knot error with its direction.
    pub(crate) fn knots(direction: &'static str) -> impl Fn(KnotError) -> Self {
        move |source| Self::Nurbs(NurbsError::Knots { direction, source })
    }
}
