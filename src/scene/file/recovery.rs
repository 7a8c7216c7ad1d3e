//! Copies kept while working, to recover from after a crash.
//!
//! Each document in each run of the program has one copy in the user's data folder, named by the document
//! and the process. A copy whose process is gone is recoverable; a document that was saved or closed in
//! order has none.

use std::hash::{DefaultHasher, Hasher};
use std::path::{Path, PathBuf};
use std::time::SystemTime;
use std::{fs, io, process};

use serde::{Deserialize, Serialize};

use super::{Packing, SaveError, SaveOptions, save};
use crate::scene::document::SceneRecord;

/// Ending of the notes beside the copies.
const NOTE: &str = "json";

/// Where copies are kept.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct RecoveryFolder {
    folder: PathBuf,
}

/// What a copy is of.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
pub struct Note {
    /// Name to show.
    pub name: String,
    /// File that the document belongs to, if it has one.
    pub path: Option<PathBuf>,
    /// Process that keeps the copy.
    pub process: u32,
}

/// A copy left by a run that ended without closing its document.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Recoverable {
    /// The copy, a scene file.
    pub file: PathBuf,
    /// What it is of.
    pub note: Note,
    /// When it was written.
    pub modified: Option<SystemTime>,
}

impl RecoveryFolder {
    /// In the user's data folder; `None` where the system names none.
    pub fn of_user() -> Option<Self> {
        let folders = directories::ProjectDirs::from("", "", "hairline")?;
        Some(Self::at(folders.data_local_dir().join("recovery")))
    }

    /// A folder of one's own (tests).
    pub fn at(folder: impl Into<PathBuf>) -> Self {
        Self { folder: folder.into() }
    }

    /// The folder.
    pub fn path(&self) -> &Path {
        &self.folder
    }

    /// The copy of a document in this process. `document` tells documents without a path apart.
    pub fn file_of(&self, path: Option<&Path>, document: u64) -> PathBuf {
        let mut hasher = DefaultHasher::new();
        match path {
            Some(path) => hasher.write(path.as_os_str().as_encoded_bytes()),
            None => hasher.write_u64(document),
        }
        let stem =
            path.and_then(Path::file_stem).map_or("untitled".into(), |s| s.to_string_lossy().into_owned());
        let stem: String = stem.chars().filter(|c| c.is_alphanumeric() || *c == '-').take(40).collect();
        let name = format!("{stem}-{:08x}-{}.{}", hasher.finish() as u32, process::id(), super::EXTENSION);
        self.folder.join(name)
    }

    /// Keeps a copy of a document.
    ///
    /// # Errors
    /// The folder or the file cannot be written.
    pub fn keep(
        &self,
        path: Option<&Path>,
        document: u64,
        scene: &SceneRecord,
    ) -> Result<PathBuf, SaveError> {
        fs::create_dir_all(&self.folder)?;
        let file = self.file_of(path, document);
        let name =
            path.and_then(Path::file_name).map_or("Untitled".into(), |n| n.to_string_lossy().into_owned());
        let note = Note { name, path: path.map(Path::to_owned), process: process::id() };
        let text = serde_json::to_vec(&note).map_err(io::Error::other)?;
        save(&file, scene, &SaveOptions { packing: Packing::Automatic, expected: None })?;
        super::replace::replace(&file.with_extension(NOTE), &text)?;
        Ok(file)
    }

    /// Removes the copy of a document that was saved or closed in order.
    ///
    /// # Errors
    /// A copy is there and cannot be removed.
    pub fn forget(&self, path: Option<&Path>, document: u64) -> io::Result<()> {
        self.remove(&self.file_of(path, document))
    }

    /// Removes a copy.
    ///
    /// # Errors
    /// It is there and cannot be removed.
    pub fn remove(&self, file: &Path) -> io::Result<()> {
        for path in [file.with_extension(NOTE), file.to_owned()] {
            match fs::remove_file(&path) {
                Err(error) if error.kind() != io::ErrorKind::NotFound => return Err(error),
                _ => {}
            }
        }
        Ok(())
    }

    /// Copies whose process is gone, latest first.
    pub fn recoverable(&self) -> Vec<Recoverable> {
        let entries = fs::read_dir(&self.folder).into_iter().flatten().flatten();
        let mut found: Vec<Recoverable> = entries.filter_map(|entry| of_note(&entry.path())).collect();
        found.sort_by(|a, b| b.modified.cmp(&a.modified).then_with(|| a.file.cmp(&b.file)));
        found
    }
}

/// The copy of a note, when both are there and nobody works on it.
fn of_note(path: &Path) -> Option<Recoverable> {
    if path.extension()? != NOTE {
        return None;
    }
    let note: Note = serde_json::from_slice(&fs::read(path).ok()?).ok()?;
    let file = path.with_extension(super::EXTENSION);
    let modified = fs::metadata(&file).ok()?.modified().ok();
    (!is_running(note.process)).then_some(Recoverable { file, note, modified })
}

/// Whether a program of ours runs under this number. Numbers are given again, so the name is looked at too.
fn is_running(pid: u32) -> bool {
    if pid == process::id() {
        return true;
    }
    if cfg!(target_os = "linux") {
        let name = |pid: &str| fs::read_to_string(format!("/proc/{pid}/comm")).ok();
        return name(&pid.to_string()).is_some_and(|other| name("self").is_none_or(|own| own == other));
    }
    // Elsewhere one cannot tell without more: offer the copy.
    false
}
