//! Opens a model for a command: a file on disk or the built-in demo scene.

use std::fs;
use std::ops::ControlFlow;
use std::path::{Path, PathBuf};

use super::failure::{Failure, plain};
use crate::exchange::iges;
use crate::exchange::report::{ImportReport, Severity};
use crate::scene::records::ModelRecord;
use crate::scene::{SceneRecord, demo, file};

/// A model with the report of its import.
#[derive(Debug, Clone)]
pub struct Opened {
    /// The model.
    pub model: ModelRecord,
    /// What became of the entities of its file.
    pub report: ImportReport,
}

/// A scene with the report of its import.
#[derive(Debug, Clone)]
pub struct OpenedScene {
    /// The scene.
    pub scene: SceneRecord,
    /// What became of the entities of its file; empty for scene files.
    pub report: ImportReport,
}

/// Reads the model at `path`; the paths `demo` and `demo:N` are built-in scenes. `progress` is told the part done, 0 to 1.
///
/// # Errors
/// The file is missing, unreadable, or no model in a format that is understood.
pub fn open(path: &Path, progress: &dyn Fn(f64)) -> Result<Opened, Failure> {
    let OpenedScene { scene, report } = open_scene(path, progress)?;
    Ok(Opened { model: scene.into_model(), report })
}

/// Reads the scene at `path`, or the model there as a scene of its own. What a file is, its content says.
///
/// # Errors
/// As [`open`].
pub fn open_scene(path: &Path, progress: &dyn Fn(f64)) -> Result<OpenedScene, Failure> {
    if let Some(model) = demo::named(path) {
        let report = ImportReport { origin: "built-in demo scene".into(), ..ImportReport::default() };
        return Ok(OpenedScene { scene: SceneRecord::of_model(model), report });
    }
    check(path)?;
    let fail = |reason: String| Failure::Input { path: path.into(), reason };
    let bytes = fs::read(path).map_err(|e| fail(plain(&e)))?;
    if bytes.is_empty() {
        return Err(fail("the file is empty (0 bytes)".into()));
    }
    if file::is_scene(&bytes) {
        let scene = file::from_bytes(&bytes).map_err(|e| fail(e.to_string()))?;
        let origin = format!("Hairline scene, format {}", file::FORMAT);
        return Ok(OpenedScene { scene, report: ImportReport { origin, ..ImportReport::default() } });
    }
    let mut told = |at: iges::Progress| {
        progress(at.done as f64 / at.total.max(1) as f64);
        ControlFlow::Continue(())
    };
    let (mut model, report) = iges::read_with(&bytes, &mut told).map_err(|e| fail(e.to_string()))?;
    if let Some(stem) = path.file_stem() {
        model.name = stem.to_string_lossy().into_owned();
    }
    Ok(OpenedScene { scene: SceneRecord::of_model(model), report })
}

/// Checks that there is a file at `path` without reading it; built-in scenes always pass.
///
/// # Errors
/// Nothing is there, or a directory.
pub fn check(path: &Path) -> Result<(), Failure> {
    let fail = |reason: String| Failure::Input { path: path.into(), reason };
    match fs::metadata(path) {
        _ if demo::is_named(path) => Ok(()),
        Ok(metadata) if metadata.is_dir() => Err(fail("it is a directory".into())),
        Ok(_) => Ok(()),
        Err(error) => Err(fail(plain(&error))),
    }
}

/// One line for standard error on what an import lost or repaired; `None` when there is nothing to say.
pub fn remarks_line(path: &Path, report: &ImportReport) -> Option<String> {
    let count = |severity| report.remarks.iter().filter(|r| r.severity == severity).count();
    let (errors, warnings) = (count(Severity::Error), count(Severity::Warning));
    let first = report.remarks.iter().max_by_key(|r| (r.severity, std::cmp::Reverse(r.line)))?;
    (errors + warnings > 0).then(|| {
        let place = match (first.entity.is_empty(), first.line) {
            (true, 0) => String::new(),
            (true, line) => format!("line {line}: "),
            (false, _) => format!("entity {} at D{}: ", first.entity, first.id),
        };
        format!(
            "{}: {errors} entities skipped, {warnings} repaired; the first: {place}{}",
            path.display(),
            first.message
        )
    })
}

/// Replaces the flag `--demo` and an empty list of files by the demo scene.
pub fn or_demo(files: &[PathBuf], demo: bool) -> Vec<PathBuf> {
    if demo || files.is_empty() {
        return std::iter::once(PathBuf::from("demo")).chain(files.iter().cloned()).collect();
    }
    files.to_vec()
}
