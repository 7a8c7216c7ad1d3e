//! Reading one source, away from the window: file -> records -> derived data.

use std::path::{Path, PathBuf};
use std::sync::Arc;

use crate::editor::derive::Derived;
use crate::editor::object::LoadedModel;
use crate::exchange::report::ImportReport;
use crate::scene::records::ModelRecord;

use super::Source;

/// Why a file could not be opened.
#[derive(Debug, thiserror::Error)]
pub enum LoadError {
    /// The user stopped it.
    #[error("cancelled")]
    Cancelled,
    /// It is a kind of file that Hairline does not read.
    #[error("{}: not an IGES file (expected .igs or .iges)", path.display())]
    Kind {
        /// The file.
        path: PathBuf,
    },
    /// It could not be read or makes no sense.
    #[error("{}: {message}", path.display())]
    Read {
        /// The file.
        path: PathBuf,
        /// What is wrong and where.
        message: String,
    },
    /// It was read, but there is nothing to show in it.
    #[error("{}: no surfaces found", path.display())]
    Empty {
        /// The file.
        path: PathBuf,
    },
}

/// Reads `source`. `progress` gets the fraction done and says whether to go on.
///
/// # Errors
/// See [`LoadError`]; nothing is left half done.
pub fn read_model(
    source: &Source,
    progress: &(dyn Fn(f32, &'static str) -> bool + Sync),
) -> Result<LoadedModel, LoadError> {
    let (path, record, report) = match source {
        Source::Demo => (None, demo(), ImportReport::default()),
        Source::File(path) => {
            let (record, report) = read_file(path, &|f| progress(0.5 * f, "Reading"))?;
            (Some(path.clone()), record, report)
        }
    };
    let count = record.faces.len();
    let mut derived = Vec::with_capacity(count);
    for (index, face) in record.faces.iter().enumerate() {
        if !progress(0.5 + 0.5 * index as f32 / count as f32, "Building") {
            return Err(LoadError::Cancelled);
        }
        derived.push(Some(Arc::new(Derived::of(face))));
    }
    Ok(LoadedModel { path, record, report, derived })
}

fn demo() -> ModelRecord {
    ModelRecord { name: "Demo".into(), ..ModelRecord::default() }
}

fn read_file(
    path: &Path,
    _progress: &(dyn Fn(f32) -> bool + Sync),
) -> Result<(ModelRecord, ImportReport), LoadError> {
    Err(LoadError::Read { path: path.to_owned(), message: "the reader is not there yet".into() })
}
