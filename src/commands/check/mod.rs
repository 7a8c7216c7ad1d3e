//! `hairline check`: pairs trim curves, measures gaps, and says by its exit code whether any is too large.
//!
//! Files are worked on in parallel and told in the order given. A file that cannot be read does not stop the
//! others; the exit code is that of the worst.

mod histogram;
mod html;
mod picture;
mod text;

use std::io::Write;
use std::path::{Path, PathBuf};

use rayon::prelude::*;
use serde::Serialize;

use super::arguments::CheckArguments;
use super::failure::Failure;
use super::progress::Progress;
use super::{output, source};
use crate::exchange::report::Severity;
use crate::inspect::report::{FORMAT, Report, Terms, VERSION, WORST};
use crate::inspect::{EdgeKey, Inspection};
use crate::scene::records::ModelRecord;
use picture::Picture;

/// What became of one file.
pub(super) enum Outcome {
    /// It was checked.
    Checked { report: Box<Report>, pictures: Vec<Picture> },
    /// It could not be.
    Unreadable { file: String, reason: String },
}

/// The line of JSON of a file that could not be read.
#[derive(Serialize)]
struct ErrorLine<'a> {
    format: &'static str,
    version: u32,
    file: &'a str,
    error: &'a str,
}

/// Checks all files and writes what was asked for.
///
/// # Errors
/// [`Failure::Found`] with exit code 1 when something exceeds the tolerance, 2 when a file could not be read
/// or a report not written.
pub fn run(arguments: &CheckArguments) -> Result<(), Failure> {
    let stdout = Path::new("-");
    for path in [&arguments.json, &arguments.html].into_iter().flatten().filter(|p| *p != stdout) {
        output::check_writable(path).map_err(|e| as_usage(&e))?;
    }
    let draw = arguments.html.is_some() || arguments.pictures.is_some();
    let progress = Progress::start("checking");
    let outcomes: Vec<Outcome> =
        arguments.files.par_iter().map(|file| check(file, arguments, draw)).collect();
    drop(progress);
    write_all(arguments, &outcomes).map_err(|e| as_usage(&e))?;
    let code = |outcome: &Outcome| match outcome {
        Outcome::Unreadable { .. } => 2,
        Outcome::Checked { report, .. } => u8::from(!report.passes),
    };
    match outcomes.iter().map(code).max() {
        Some(code) if code > 0 => Err(Failure::Found { code }),
        _ => Ok(()),
    }
}

/// Exit code 1 means a gap here: what cannot be written is told as 2.
fn as_usage(failure: &Failure) -> Failure {
    match failure {
        Failure::Closed => Failure::Closed,
        _ => Failure::Usage { reason: failure.to_string() },
    }
}

fn check(file: &Path, arguments: &CheckArguments, draw: bool) -> Outcome {
    let named = file.display().to_string();
    let opened = match source::open(file, &|_| ()) {
        Ok(opened) => opened,
        Err(Failure::Input { reason, .. }) => return Outcome::Unreadable { file: named, reason },
        Err(failure) => return Outcome::Unreadable { file: named, reason: failure.to_string() },
    };
    let model = &opened.model;
    if model.faces.is_empty() {
        return Outcome::Unreadable { file: named, reason: "it holds no faces".into() };
    }
    let skipped = opened.report.remarks.iter().filter(|r| r.severity == Severity::Error).count();
    let inspection = Inspection::in_unit(&model.faces, model.unit.millimetres);
    let terms = Terms { tolerance_mm: arguments.tolerance.mm, naked_fails: arguments.naked };
    let report = Report::new(named, model, skipped, &inspection, terms);
    let pictures = if draw { pictures(model, &inspection) } else { Vec::new() };
    Outcome::Checked { report: Box::new(report), pictures }
}

/// Pictures of the worst gaps, in the order of the report's findings.
fn pictures(model: &ModelRecord, inspection: &Inspection) -> Vec<Picture> {
    let size =
        |key: &EdgeKey| inspection.edge(key).and_then(|e| e.gap).map_or(f64::NEG_INFINITY, |g| g.maximum);
    let mut keys: Vec<EdgeKey> = inspection.edges().filter(|e| e.1.gap.is_some()).map(|e| *e.0).collect();
    keys.sort_by(|a, b| size(b).total_cmp(&size(a)));
    keys.truncate(WORST);
    keys.iter().filter_map(|key| picture::draw(model, inspection.edge(key)?)).collect()
}

fn write_all(arguments: &CheckArguments, outcomes: &[Outcome]) -> Result<(), Failure> {
    let mut out = std::io::stdout().lock();
    let json = |outcome: &Outcome| match outcome {
        Outcome::Checked { report, .. } => serde_json::to_string(report),
        Outcome::Unreadable { file, reason } => {
            serde_json::to_string(&ErrorLine { format: FORMAT, version: VERSION, file, error: reason })
        }
    };
    let broken = |e: serde_json::Error| Failure::Work { reason: e.to_string() };
    let lines = outcomes.iter().map(|o| json(o).map(|line| line + "\n")).collect::<Result<String, _>>();
    let lines = lines.map_err(broken)?;
    for outcome in outcomes {
        if let Outcome::Unreadable { file, reason } = outcome {
            eprintln!("hairline: error: cannot check {file}: {reason}");
        }
    }
    let to_stdout = arguments.json.as_deref() == Some(Path::new("-"));
    if to_stdout || outcomes.len() > 1 {
        out.write_all(lines.as_bytes()).map_err(|e| Failure::stdout(&e))?;
    } else if let [Outcome::Checked { report, .. }] = outcomes {
        text::write(report, &mut out).map_err(|e| Failure::stdout(&e))?;
    }
    if let Some(path) = arguments.json.as_deref().filter(|_| !to_stdout) {
        output::write_whole(path, lines.as_bytes())?;
    }
    if let Some(path) = &arguments.html {
        output::write_whole(path, html::page(outcomes).as_bytes())?;
    }
    if let Some(folder) = &arguments.pictures {
        outcomes.iter().try_for_each(|outcome| write_pictures(folder, outcome))?;
    }
    Ok(())
}

fn write_pictures(folder: &Path, outcome: &Outcome) -> Result<(), Failure> {
    let Outcome::Checked { report, pictures } = outcome else { return Ok(()) };
    let stem = Path::new(&report.file)
        .file_stem()
        .map_or_else(|| "model".into(), |s| s.to_string_lossy().into_owned());
    let folder = match folder.as_os_str().is_empty() {
        true => PathBuf::from(format!("{stem}-gaps")),
        false => folder.to_owned(),
    };
    let fail =
        |e: std::io::Error| Failure::Output { path: folder.clone(), reason: super::failure::plain(&e) };
    std::fs::create_dir_all(&folder).map_err(fail)?;
    for (k, picture) in pictures.iter().enumerate() {
        output::write_whole(&folder.join(format!("{stem}-{:02}.png", k + 1)), &picture.png)?;
    }
    Ok(())
}
