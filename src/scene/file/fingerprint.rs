//! What a file was like, to notice that somebody else has written it since.

use std::hash::{DefaultHasher, Hasher};
use std::path::Path;
use std::time::SystemTime;
use std::{fs, io};

/// Size, time and content of a file at one moment, for this run of the program.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Fingerprint {
    length: u64,
    modified: Option<SystemTime>,
    content: u64,
}

impl Fingerprint {
    /// Of a file with these properties and content.
    pub fn of(metadata: &fs::Metadata, bytes: &[u8]) -> Self {
        let mut hasher = DefaultHasher::new();
        hasher.write(bytes);
        Self { length: bytes.len() as u64, modified: metadata.modified().ok(), content: hasher.finish() }
    }

    /// Of the file at `path`.
    ///
    /// # Errors
    /// The file cannot be read.
    pub fn of_file(path: &Path) -> io::Result<Self> {
        let metadata = fs::metadata(path)?;
        Ok(Self::of(&metadata, &fs::read(path)?))
    }

    /// Whether the file at `path` has another content now. A file that is gone has not: saving brings it
    /// back. The content is read only when size or time differ.
    ///
    /// # Errors
    /// The file is there but cannot be read.
    pub fn differs_from(&self, path: &Path) -> io::Result<bool> {
        let metadata = match fs::metadata(path) {
            Err(error) if error.kind() == io::ErrorKind::NotFound => return Ok(false),
            other => other?,
        };
        if metadata.len() != self.length {
            return Ok(true);
        }
        if self.modified.is_some() && metadata.modified().ok() == self.modified {
            return Ok(false);
        }
        Ok(Self::of(&metadata, &fs::read(path)?).content != self.content)
    }
}
