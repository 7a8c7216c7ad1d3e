//! Reading IGES (versions 4 to 5.3, fixed ASCII form) into [`ModelRecord`]s, and writing it ([`mod@write`]).
//!
//! The file is cut into lines and sections (`physical`), the directory is read (`directory`), and
//! every face-like entity that is not a part of another one becomes a face, in file order. Geometry
//! is converted without loss wherever NURBS can hold it; lengths become millimetres; parameters are
//! those that OpenCASCADE gives the same surfaces. A bad or unknown entity is skipped and remarked on
//! with its directory-entry number and line; the rest loads.
//!
//! Source: "Initial Graphics Exchange Specification IGES 5.3", US PRO 1996.

mod analytic190;
mod appearance;
mod arc100;
mod boundary141;
mod brep;
mod composite102;
mod conic104;
mod copious106;
mod curve;
mod curve_on_surface142;
mod directory;
mod error;
mod faces;
mod generatrix;
mod global;
mod line110;
mod offset140;
mod parameter;
mod physical;
mod plane108;
mod point116;
mod revolution120;
mod ruled118;
mod segment;
mod spline112;
mod spline114;
mod spline126;
mod store;
mod structure;
mod surface;
mod surface128;
mod tabulated122;
mod transform124;
mod trimmed144;
pub mod unit;
pub mod write;

use std::ops::ControlFlow;
use std::path::Path;

pub use error::ReadError;

use super::report::{ImportReport, Remark, Severity};
use crate::scene::records::ModelRecord;
use store::Store;

/// How far reading has come.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Progress {
    /// Faces read so far.
    pub done: usize,
    /// Faces that the file has, as far as the directory tells.
    pub total: usize,
}

/// Reads the file at `path`.
///
/// # Errors
/// When nothing at all can be read; everything milder is in the report.
pub fn read(path: &Path) -> Result<(ModelRecord, ImportReport), ReadError> {
    let bytes = std::fs::read(path).map_err(|source| ReadError::Io { path: path.to_path_buf(), source })?;
    let (mut model, report) = read_bytes(&bytes)?;
    if let Some(stem) = path.file_stem() {
        model.name = stem.to_string_lossy().into_owned();
    }
    Ok((model, report))
}

/// Reads the contents of a file.
///
/// # Errors
/// As [`read`].
pub fn read_bytes(bytes: &[u8]) -> Result<(ModelRecord, ImportReport), ReadError> {
    read_with(bytes, &mut |_| ControlFlow::Continue(()))
}

/// Reads the contents of a file, telling `progress` now and then, which may stop it.
///
/// # Errors
/// As [`read`], and [`ReadError::Cancelled`].
pub fn read_with(
    bytes: &[u8],
    progress: &mut dyn FnMut(Progress) -> ControlFlow<()>,
) -> Result<(ModelRecord, ImportReport), ReadError> {
    let store = Store::open(bytes)?;
    let mut report = ImportReport { origin: origin(&store), ..ImportReport::default() };
    for entry in &store.entries {
        *report.entities.entry(entry.kind.to_string()).or_insert(0) += 1;
    }
    report.remarks.extend(file_remarks(&store));
    report.remarks.extend(unread_kinds(&store));
    let model = faces::read(&store, &mut report, progress)?;
    Ok((model, report))
}

fn origin(store: &Store<'_>) -> String {
    match store.global.system.as_str() {
        "" => "IGES".to_string(),
        system => format!("IGES, {system}"),
    }
}

/// Remarks on the file as a whole.
fn file_remarks(store: &Store<'_>) -> Vec<Remark> {
    let mut remarks = Vec::new();
    let mut remark = |severity, line, message: String| {
        remarks.push(Remark { severity, entity: String::new(), id: 0, line, message });
    };
    let (terminated, lines) = store.ending();
    if !terminated {
        remark(
            Severity::Warning,
            lines,
            "the terminate section is missing; the file may be truncated".into(),
        );
    }
    if let Some(line) = store.half_entry() {
        remark(Severity::Warning, line, "the directory section ends in half an entry".into());
    }
    if let Some(problem) = &store.global.unit_problem {
        remark(Severity::Warning, 0, problem.clone());
    }
    let unit = &store.global.unit;
    if unit.millimetres != 1.0 {
        let message = format!("lengths converted from {} to mm (x {})", unit.name, unit.millimetres);
        remark(Severity::Note, 0, message);
    }
    if store.global.scale != 1.0 {
        let message =
            format!("model space scale {} is a drawing scale and is not applied", store.global.scale);
        remark(Severity::Note, 0, message);
    }
    remarks
}

/// One note for each entity type that this reader does not look at, from the first entity of the type.
fn unread_kinds(store: &Store<'_>) -> Vec<Remark> {
    let mut first: std::collections::BTreeMap<u32, (usize, usize)> = std::collections::BTreeMap::new();
    for (index, entry) in store.entries.iter().enumerate() {
        if !is_expected(entry.kind) {
            first.entry(entry.kind).or_insert((index, 0)).1 += 1;
        }
    }
    let mut remarks: Vec<Remark> = first
        .into_iter()
        .map(|(kind, (index, count))| Remark {
            severity: Severity::Note,
            entity: kind.to_string(),
            id: Store::number(index),
            line: store.entries[index].line,
            message: format!("entities of type {kind} are not read ({count} in the file, this is the first)"),
        })
        .collect();
    remarks.sort_by_key(|r| r.id);
    remarks
}

/// Types that are read, and those that never hold part of a face: points, annotation, drawings,
/// attributes and properties.
fn is_expected(kind: u32) -> bool {
    matches!(kind,
        0 | 100 | 102 | 104 | 106 | 108 | 110 | 112 | 114 | 116 | 118 | 120 | 122 | 123 | 124 | 126 | 128
        | 140..=144 | 184 | 186 | 190 | 192 | 194 | 196 | 198 | 308 | 314 | 402 | 406 | 408 | 430
        | 502 | 504 | 508 | 510 | 514 // read
        | 132 | 202..=230 | 302 | 304 | 306 | 310 | 312 | 316 | 320 | 322 | 404 | 410 | 412 | 414 | 416 | 420 | 422)
}
