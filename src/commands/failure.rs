//! What can go wrong in a sub-command, in words for the user, with its exit code.

use std::io;
use std::path::PathBuf;

/// Why a command stopped.
#[derive(Debug, thiserror::Error)]
pub enum Failure {
    /// A file to read is missing, unreadable or not a model.
    #[error("cannot read {}: {reason}", path.display())]
    Input {
        /// The file.
        path: PathBuf,
        /// What is wrong with it, and where in it.
        reason: String,
    },
    /// A line of standard input is not what was expected.
    #[error("standard input, line {line}: {reason}")]
    Line {
        /// Number of the line, from 1.
        line: usize,
        /// What is wrong with it.
        reason: String,
    },
    /// The command line asks for something that the model does not have.
    #[error("{reason}")]
    Usage {
        /// What, and what there is instead.
        reason: String,
    },
    /// The result cannot be written.
    #[error("cannot write {}: {reason}", path.display())]
    Output {
        /// Where to.
        path: PathBuf,
        /// Why not.
        reason: String,
    },
    /// The work itself failed.
    #[error("{reason}")]
    Work {
        /// What failed.
        reason: String,
    },
    /// This machine or this build lacks something.
    #[error("{reason}")]
    Lacking {
        /// What, and what to do about it.
        reason: String,
    },
    /// The command did its work and what it found is told by this exit code alone.
    #[error("exit code {code}")]
    Found {
        /// The exit code.
        code: u8,
    },
    /// The reader of standard output went away, as `head` does.
    #[error("standard output was closed")]
    Closed,
}

impl Failure {
    /// The exit code of the process: 0 to 3 as documented by `hairline --help`.
    pub fn exit_code(&self) -> u8 {
        match self {
            Self::Closed => 0,
            Self::Found { code } => *code,
            Self::Output { .. } | Self::Work { .. } => 1,
            Self::Input { .. } | Self::Line { .. } | Self::Usage { .. } => 2,
            Self::Lacking { .. } => 3,
        }
    }

    /// A failure to write standard output: a closed pipe is the reader's choice, not an error.
    pub fn stdout(error: &io::Error) -> Self {
        match error.kind() {
            io::ErrorKind::BrokenPipe => Self::Closed,
            _ => Self::Output { path: "standard output".into(), reason: plain(error) },
        }
    }
}

/// An I/O error without the operating system's error number.
pub fn plain(error: &io::Error) -> String {
    match error.kind() {
        io::ErrorKind::NotFound => "no such file or directory".into(),
        io::ErrorKind::PermissionDenied => "permission denied".into(),
        io::ErrorKind::IsADirectory => "it is a directory".into(),
        _ => {
            let text = error.to_string();
            text.split(" (os error").next().unwrap_or(&text).to_lowercase()
        }
    }
}
