//! Scene files: one JSON object, readable, versioned, one face to a line; packed with Zstandard when large.
//!
//! Every number comes back bit for bit. Saving replaces the old file whole or not at all ([`replace`]) and
//! can refuse to run over somebody else's newer version ([`Fingerprint`]); loading says where a file is
//! damaged, by line, column and path, and never writes. Older formats are brought up to date by
//! [`migration`], newer ones are refused with their number.

pub mod fingerprint;
pub mod migration;
mod read;
pub mod recovery;
pub mod replace;
pub mod spans;
mod write;

use std::path::Path;
use std::{fs, io};

pub use fingerprint::Fingerprint;
pub use read::ReadError;
pub use write::WriteError;

use super::document::SceneRecord;

/// Format that this program writes.
pub const FORMAT: u64 = 1;
/// Extension of scene files, without the dot.
pub const EXTENSION: &str = "hairline";
/// Bytes of text from which on files are packed when nothing else is said.
const LARGE: usize = 1 << 20;
/// What a Zstandard frame begins with.
const ZSTANDARD: [u8; 4] = [0x28, 0xb5, 0x2f, 0xfd];

/// Whether a file is packed.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq)]
pub enum Packing {
    /// From 1 MiB of text on.
    #[default]
    Automatic,
    /// Plain text.
    Plain,
    /// Zstandard.
    Packed,
}

/// A scene as read from a file.
#[derive(Debug, Clone, PartialEq)]
pub struct Loaded {
    /// The scene.
    pub scene: SceneRecord,
    /// What the file was like, for [`save`] to notice that it changed.
    pub fingerprint: Fingerprint,
}

/// Why a scene file cannot be loaded.
#[derive(Debug, thiserror::Error)]
pub enum LoadError {
    /// The file cannot be read.
    #[error(transparent)]
    Io(#[from] io::Error),
    /// It is no scene file, or a damaged or newer one.
    #[error(transparent)]
    Read(#[from] ReadError),
}

/// Why a scene cannot be saved. The old file is untouched.
#[derive(Debug, thiserror::Error)]
pub enum SaveError {
    /// The file cannot be written.
    #[error(transparent)]
    Io(#[from] io::Error),
    /// The scene holds something that cannot be written.
    #[error(transparent)]
    Write(#[from] WriteError),
    /// Somebody else has saved to the file since it was loaded or last saved from here.
    #[error("the file was changed by another program since it was opened here")]
    ChangedOnDisk,
}

/// How to save.
#[derive(Debug, Clone, Default)]
pub struct SaveOptions {
    /// Whether to pack.
    pub packing: Packing,
    /// What the file was like when last seen; when it is different now, saving is refused. `None`
    /// replaces whatever is there.
    pub expected: Option<Fingerprint>,
}

/// Whether a file that begins with `bytes` (some hundred are enough) is meant to be a scene file.
pub fn is_scene(bytes: &[u8]) -> bool {
    if bytes.starts_with(&ZSTANDARD) {
        return true;
    }
    let text = bytes.strip_prefix(b"\xef\xbb\xbf").unwrap_or(bytes).trim_ascii_start();
    let head = &text[..text.len().min(256)];
    head.starts_with(b"{") && head.windows(10).any(|w| w == b"\"hairline\"")
}

/// The bytes of a scene file.
///
/// # Errors
/// See [`WriteError`].
pub fn to_bytes(scene: &SceneRecord, packing: Packing) -> Result<Vec<u8>, WriteError> {
    write::to_bytes(scene, packing)
}

/// The scene of a file with content `bytes`.
///
/// # Errors
/// See [`ReadError`].
pub fn from_bytes(bytes: &[u8]) -> Result<SceneRecord, ReadError> {
    read::from_bytes(bytes)
}

/// Loads the scene file at `path`.
///
/// # Errors
/// See [`LoadError`].
pub fn load(path: &Path) -> Result<Loaded, LoadError> {
    // What is known of the file is taken before its content: a change in between shows as one.
    let metadata = fs::metadata(path)?;
    let bytes = fs::read(path)?;
    let fingerprint = Fingerprint::of(&metadata, &bytes);
    Ok(Loaded { scene: from_bytes(&bytes)?, fingerprint })
}

/// Saves to `path`: the file there is replaced whole, or stays as it is.
///
/// # Errors
/// See [`SaveError`].
pub fn save(path: &Path, scene: &SceneRecord, options: &SaveOptions) -> Result<Fingerprint, SaveError> {
    let bytes = to_bytes(scene, options.packing)?;
    let mut changed = false;
    let check = || -> io::Result<()> {
        changed = match &options.expected {
            Some(expected) => expected.differs_from(path)?,
            None => false,
        };
        if changed { Err(io::Error::other("changed on disk")) } else { Ok(()) }
    };
    let written = replace::replace_checked(path, &bytes, check);
    if changed {
        return Err(SaveError::ChangedOnDisk);
    }
    written?;
    Ok(Fingerprint::of(&fs::metadata(path)?, &bytes))
}

#[cfg(test)]
mod tests;
