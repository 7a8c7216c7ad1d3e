//! Files are written whole or not at all, see [`replace`].

use std::io;
use std::path::Path;

use super::failure::{Failure, plain};
use crate::scene::file::replace;

/// Checks that `path` can be written, before long work is spent on its content. Leaves nothing behind.
///
/// # Errors
/// The folder is missing or read-only, or `path` is a directory.
pub fn check_writable(path: &Path) -> Result<(), Failure> {
    replace::check_writable(path).map_err(|e| unwritten(path, &e))
}

/// Replaces the file at `path` by `bytes`, atomically. A symbolic link is followed; devices and
/// pipes are written directly.
///
/// # Errors
/// Any step fails; the old file is then untouched and no temporary file stays.
pub fn write_whole(path: &Path, bytes: &[u8]) -> Result<(), Failure> {
    replace::replace(path, bytes).map_err(|e| unwritten(path, &e))
}

/// The failure to write `path`.
pub fn unwritten(path: &Path, error: &io::Error) -> Failure {
    // An error of our own says it best, one of the system in its usual words.
    let reason = error.get_ref().map_or_else(|| plain(error), ToString::to_string);
    Failure::Output { path: path.into(), reason }
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::fs;

    #[test]
    fn replaces_whole_files_and_leaves_no_others() {
        let folder = tempfile::tempdir().expect("a temporary folder");
        let path = folder.path().join("a.txt");
        write_whole(&path, b"one").expect("new file");
        write_whole(&path, b"two").expect("old file");
        check_writable(&path).expect("still writable");
        assert_eq!(fs::read(&path).expect("readable"), b"two");
        assert_eq!(fs::read_dir(folder.path()).expect("listable").count(), 1);
    }

    #[test]
    fn names_what_is_wrong_with_the_place() {
        let folder = tempfile::tempdir().expect("a temporary folder");
        let message = |path: &Path| check_writable(path).expect_err("not writable").to_string();
        assert!(message(folder.path()).contains("it is a directory"));
        assert!(message(&folder.path().join("no/such/a.png")).contains("there is no folder"));
        assert!(message(Path::new("")).contains("not a file name"));
    }
}
