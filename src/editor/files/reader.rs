//! Reading one source, away from the window: file -> records -> derived data.

use std::io::Read;
use std::ops::ControlFlow;
use std::path::{Path, PathBuf};
use std::sync::Arc;
use std::sync::atomic::{AtomicUsize, Ordering};

use rayon::prelude::*;

use crate::editor::derive::Derived;
use crate::editor::object::LoadedModel;
use crate::exchange::iges;
use crate::exchange::report::ImportReport;
use crate::scene::file::{self, Fingerprint};
use crate::scene::records::ModelRecord;
use crate::scene::{SceneRecord, demo};

use super::Source;

/// Why a file could not be opened.
#[derive(Debug, thiserror::Error)]
pub enum LoadError {
    /// The user stopped it.
    #[error("cancelled")]
    Cancelled,
    /// It could not be read or makes no sense.
    #[error("{}: {message}", path.display())]
    Read {
        /// The file.
        path: PathBuf,
        /// What is wrong and where.
        message: String,
    },
    /// It was read, but there is nothing to show in it.
    #[error("{}: no surfaces found. {reason}", path.display())]
    Empty {
        /// The file.
        path: PathBuf,
        /// The worst remark of the import report.
        reason: String,
    },
}

/// Share of the progress bar that reading takes; building the structures takes the rest.
const READING: f32 = 0.5;

/// What was read from one source.
#[derive(Debug, Clone, Default)]
pub struct LoadedScene {
    /// Its models: any number in a scene file, else one.
    pub models: Vec<LoadedModel>,
    /// What a scene file says beside the models.
    pub file: Option<SceneFile>,
}

/// A scene file beside its models.
#[derive(Debug, Clone)]
pub struct SceneFile {
    /// The file.
    pub path: PathBuf,
    /// The record without its models.
    pub scene: SceneRecord,
    /// What the file was like.
    pub fingerprint: Fingerprint,
}

/// Reads `source`. `progress` gets the fraction done and says whether to go on.
///
/// # Errors
/// See [`LoadError`]; nothing is left half done.
pub fn read_source(
    source: &Source,
    progress: &(dyn Fn(f32, &'static str) -> bool + Sync),
) -> Result<LoadedScene, LoadError> {
    let (path, record, report) = match source {
        Source::Demo => {
            let report = ImportReport { origin: "built-in demo scene".into(), ..ImportReport::default() };
            (None, demo::model(), report)
        }
        Source::File(path) if is_scene(path) => return read_scene(path, progress),
        Source::File(path) if demo::is_named(path) => {
            let report = ImportReport { origin: "built-in scene".into(), ..ImportReport::default() };
            (None, demo::named(path).unwrap_or_default(), report)
        }
        Source::File(path) => {
            let (record, report) = read_file(path, progress)?;
            (Some(path.clone()), record, report)
        }
    };
    let derived = derive_all(&record, progress)?;
    Ok(LoadedScene { models: vec![LoadedModel { path, record, report, derived }], file: None })
}

/// Whether a file is meant to be a scene file. One that cannot be read is not.
fn is_scene(path: &Path) -> bool {
    let mut head = Vec::new();
    let read = std::fs::File::open(path).and_then(|f| f.take(512).read_to_end(&mut head));
    let named = path.extension().is_some_and(|e| e.eq_ignore_ascii_case(file::EXTENSION));
    named || (read.is_ok() && file::is_scene(&head))
}

fn read_scene(
    path: &Path,
    progress: &(dyn Fn(f32, &'static str) -> bool + Sync),
) -> Result<LoadedScene, LoadError> {
    if !progress(0.0, "Reading") {
        return Err(LoadError::Cancelled);
    }
    let fail = |message: String| LoadError::Read { path: path.to_owned(), message };
    let file::Loaded { mut scene, fingerprint } = file::load(path).map_err(|e| fail(e.to_string()))?;
    let records = std::mem::take(&mut scene.models);
    let faces: usize = records.iter().map(|m| m.faces.len()).sum();
    let mut before = 0;
    let mut models = Vec::with_capacity(records.len());
    for record in records {
        let part = record.faces.len() as f32 / faces.max(1) as f32;
        let start = before as f32 / faces.max(1) as f32;
        let derived = derive_all(&record, &|fraction, stage| {
            let own = (fraction - READING) / (1.0 - READING);
            progress(READING + (1.0 - READING) * (start + part * own), stage)
        })?;
        before += record.faces.len();
        let report = ImportReport { origin: "scene file".into(), ..ImportReport::default() };
        models.push(LoadedModel { path: None, record, report, derived });
    }
    Ok(LoadedScene { models, file: Some(SceneFile { path: path.to_owned(), scene, fingerprint }) })
}

fn derive_all(
    record: &ModelRecord,
    progress: &(dyn Fn(f32, &'static str) -> bool + Sync),
) -> Result<Vec<Option<Arc<Derived>>>, LoadError> {
    let count = record.faces.len();
    let done = AtomicUsize::new(0);
    let derived: Option<Vec<_>> = record
        .faces
        .par_iter()
        .map(|face| {
            let before = done.fetch_add(1, Ordering::Relaxed);
            let fraction = READING + (1.0 - READING) * before as f32 / count as f32;
            progress(fraction, "Building").then(|| {
                let derived = Derived::of(face);
                derived.pack();
                Some(Arc::new(derived))
            })
        })
        .collect();
    derived.ok_or(LoadError::Cancelled)
}

fn read_file(
    path: &Path,
    progress: &(dyn Fn(f32, &'static str) -> bool + Sync),
) -> Result<(ModelRecord, ImportReport), LoadError> {
    let fail = |message: String| LoadError::Read { path: path.to_owned(), message };
    let metadata = std::fs::metadata(path).map_err(|e| fail(e.to_string()))?;
    if !metadata.is_file() {
        return Err(fail("it is not a file".into()));
    }
    let bytes = std::fs::read(path).map_err(|e| fail(e.to_string()))?;
    let mut told = |at: iges::Progress| {
        let fraction = READING * at.done as f32 / at.total.max(1) as f32;
        if progress(fraction, "Reading") { ControlFlow::Continue(()) } else { ControlFlow::Break(()) }
    };
    let (mut record, report) = iges::read_with(&bytes, &mut told).map_err(|error| match error {
        iges::ReadError::Cancelled => LoadError::Cancelled,
        other => fail(other.to_string()),
    })?;
    if record.faces.is_empty() {
        let first = report.remarks.iter().max_by_key(|r| r.severity).map(|r| r.message.clone());
        return Err(LoadError::Empty { path: path.to_owned(), reason: first.unwrap_or_default() });
    }
    if let Some(name) = path.file_name() {
        record.name = name.to_string_lossy().into_owned();
    }
    Ok((record, report))
}
