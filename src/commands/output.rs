//! Files are written whole or not at all: into a temporary neighbour, synced, then renamed.

use std::fs;
use std::io::Write;
use std::path::{Path, PathBuf};

use super::failure::{Failure, plain};

/// Checks that `path` can be written, before long work is spent on its content. Leaves nothing behind.
///
/// # Errors
/// The folder is missing or read-only, or `path` is a directory.
pub fn check_writable(path: &Path) -> Result<(), Failure> {
    temporary_beside(path).map(drop)
}

/// Replaces the file at `path` by `bytes`, atomically. A symbolic link is followed; devices and
/// pipes are written directly.
///
/// # Errors
/// Any step fails; the old file is then untouched and no temporary file stays.
pub fn write_whole(path: &Path, bytes: &[u8]) -> Result<(), Failure> {
    let fail = |reason| Failure::Output { path: path.into(), reason };
    if is_special(path) {
        return fs::write(path, bytes).map_err(|e| fail(plain(&e)));
    }
    let mut file = temporary_beside(path)?;
    file.write_all(bytes).and_then(|()| file.as_file().sync_all()).map_err(|e| fail(plain(&e)))?;
    file.persist(resolved(path)).map_err(|e| fail(plain(&e.error)))?;
    Ok(())
}

fn temporary_beside(path: &Path) -> Result<tempfile::NamedTempFile, Failure> {
    let fail = |reason| Failure::Output { path: path.into(), reason };
    let target = resolved(path);
    if target.is_dir() {
        return Err(fail("it is a directory".into()));
    }
    if path.as_os_str().is_empty() || target.file_name().is_none() {
        return Err(fail("it is not a file name".into()));
    }
    if fs::metadata(&target).is_ok_and(|m| m.permissions().readonly()) {
        return Err(fail("the file is read-only".into()));
    }
    let folder = match target.parent() {
        Some(parent) if !parent.as_os_str().is_empty() => parent,
        _ => Path::new("."),
    };
    let mut builder = tempfile::Builder::new();
    builder.prefix(".hairline-").suffix(".part");
    #[cfg(unix)]
    {
        // The usual mode of new files (the process's umask still applies), or that of the old file.
        use std::os::unix::fs::PermissionsExt;
        let mode = fs::metadata(&target).map_or(0o666, |m| m.permissions().mode() & 0o777);
        builder.permissions(fs::Permissions::from_mode(mode));
    }
    builder.tempfile_in(folder).map_err(|e| match folder.is_dir() {
        true => fail(plain(&e)),
        false => fail(format!("there is no folder {}", folder.display())),
    })
}

fn resolved(path: &Path) -> PathBuf {
    fs::canonicalize(path).unwrap_or_else(|_| path.into())
}

fn is_special(path: &Path) -> bool {
    fs::metadata(path).is_ok_and(|m| !m.is_file() && !m.is_dir())
}

#[cfg(test)]
mod tests {
    use super::*;

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
