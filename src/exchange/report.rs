//! What became of each entity of an imported file.

use serde::Serialize;

/// How bad a remark is.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Serialize)]
#[serde(rename_all = "lowercase")]
pub enum Severity {
    /// Nothing lost: a note on what was done.
    Note,
    /// Loaded, but something was repaired or guessed.
    Warning,
    /// The entity was skipped.
    Error,
}

/// One remark on one entity.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Remark {
    /// How bad it is.
    pub severity: Severity,
    /// Entity type (`144`), or empty for the file as a whole.
    pub entity: String,
    /// Directory-entry number, 0 for the file as a whole.
    pub id: u64,
    /// Line in the file (from 1), 0 if not known.
    pub line: usize,
    /// What happened.
    pub message: String,
}

/// Everything worth telling about one import.
#[derive(Debug, Clone, Default, PartialEq, Serialize)]
pub struct ImportReport {
    /// Format and sending system as the file names it.
    pub origin: String,
    /// Number of entities in the file by type.
    pub entities: std::collections::BTreeMap<String, usize>,
    /// Remarks in file order.
    pub remarks: Vec<Remark>,
}
