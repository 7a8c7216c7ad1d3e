//! `hairline convert`: a model from one file format into another.

use std::path::Path;

use super::arguments::ConvertArguments;
use super::failure::Failure;
use super::output::{check_writable, unwritten, write_whole};
use super::progress::Progress;
use super::source;
use crate::exchange::iges::write::{self, ExportRemark, WriteOptions};
use crate::exchange::report::Severity;
use crate::scene::SceneRecord;
use crate::scene::file::{self, SaveError, SaveOptions};
use crate::scene::records::ModelRecord;

/// A format that can be written.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Format {
    /// An IGES file.
    Iges,
    /// A scene file.
    Scene,
}

/// Reads, converts, and writes whole or not at all.
///
/// # Errors
/// The name of the output says no known format, both are the same file, the input is missing or no
/// model, the output cannot be written, or the format cannot hold the model.
pub fn run(arguments: &ConvertArguments) -> Result<(), Failure> {
    let (input, output) = (&arguments.input, &arguments.output);
    let format = format_of(output)?;
    if same_file(input, output) {
        let reason = format!("{} is both input and output; name another file to write", output.display());
        return Err(Failure::Usage { reason });
    }
    source::check(input)?;
    check_writable(output)?;
    let progress = Progress::start(format!("reading {}", input.display()));
    let opened = source::open_scene(input, &|part| progress.set(part))?;
    drop(progress);
    if let Some(line) = source::remarks_line(input, &opened.report) {
        eprintln!("hairline: {line}");
    }
    let _progress = Progress::start(format!("writing {}", output.display()));
    match format {
        Format::Iges => {
            let file_name = output.file_name().map_or_else(String::new, |n| n.to_string_lossy().into_owned());
            let options = WriteOptions { unit: arguments.unit, file_name, ..WriteOptions::default() };
            iges(&opened.scene.into_model(), output, &options)
        }
        Format::Scene => scene(&opened.scene, output),
    }
}

/// Saves a scene file.
///
/// # Errors
/// It cannot be written; the old file is then untouched.
pub(super) fn scene(scene: &SceneRecord, output: &Path) -> Result<(), Failure> {
    match file::save(output, scene, &SaveOptions::default()) {
        Ok(_) => Ok(()),
        Err(SaveError::Io(error)) => Err(unwritten(output, &error)),
        Err(error) => Err(Failure::Output { path: output.into(), reason: error.to_string() }),
    }
}

pub(super) fn iges(model: &ModelRecord, output: &Path, options: &WriteOptions) -> Result<(), Failure> {
    let (bytes, remarks) = write::write(model, options)
        .map_err(|e| Failure::Work { reason: format!("nothing was written to {}: {e}", output.display()) })?;
    write_whole(output, &bytes)?;
    if let Some(line) = remarks_line(output, &remarks) {
        eprintln!("hairline: {line}");
    }
    Ok(())
}

/// The format that the extension of `path` asks for.
pub(super) fn format_of(path: &Path) -> Result<Format, Failure> {
    let extension = path.extension().map(|e| e.to_string_lossy().to_lowercase());
    match extension.as_deref() {
        Some("igs" | "iges") => Ok(Format::Iges),
        Some(file::EXTENSION) => Ok(Format::Scene),
        other => {
            let what = other.map_or("it has no extension".into(), |e| format!("`.{e}` is not known"));
            let reason = format!(
                "{}: {what}; the extension says what to write: .hairline (scene), .igs or .iges (IGES)",
                path.display()
            );
            Err(Failure::Usage { reason })
        }
    }
}

fn same_file(a: &Path, b: &Path) -> bool {
    matches!((a.canonicalize(), b.canonicalize()), (Ok(a), Ok(b)) if a == b)
}

/// One line for standard error on what the file could not hold.
fn remarks_line(path: &Path, remarks: &[ExportRemark]) -> Option<String> {
    let first = remarks.iter().max_by_key(|r| (r.severity, std::cmp::Reverse(r.face)))?;
    let count = remarks.iter().filter(|r| r.severity == first.severity).count();
    let what = match first.severity {
        Severity::Note => "notes",
        Severity::Warning => "warnings",
        Severity::Error => "errors",
    };
    Some(format!("{}: {count} {what}; the first: face {}: {}", path.display(), first.face, first.message))
}
