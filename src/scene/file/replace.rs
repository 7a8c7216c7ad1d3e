//! Replacing a file whole or not at all, whatever happens meanwhile.
//!
//! The new content goes to a hidden neighbour, is forced to disk, and takes the old name in one step of the
//! file system; then the folder is forced to disk too. A process killed on the way leaves the old file or
//! the new one, and at worst a hidden neighbour, which the next save of the same file removes.

use std::io::{self, Write};
use std::path::{Path, PathBuf};
use std::time::Duration;
use std::{fs, process};

/// Ending of the hidden neighbours.
const PART: &str = ".part";
/// Neighbours of other processes are left alone until they are this old, where one cannot tell whether the
/// process is still there.
const STALE: Duration = Duration::from_secs(3600);

/// Checks that [`replace`] could write to `path`, before long work is spent on content. Leaves nothing.
///
/// # Errors
/// As [`replace`].
pub fn check_writable(path: &Path) -> io::Result<()> {
    if is_special(path) { Ok(()) } else { temporary_beside(&resolved(path)).map(drop) }
}

/// Replaces the file at `path` by `bytes`. A symbolic link is followed; devices and pipes are written
/// directly.
///
/// # Errors
/// A step fails; the old file is then as it was.
pub fn replace(path: &Path, bytes: &[u8]) -> io::Result<()> {
    replace_checked(path, bytes, || Ok(()))
}

/// The same; `check` is asked right before the new file takes the old one's place, while no other process
/// is between its own check and replacement.
///
/// # Errors
/// `check` refuses or a step fails; the old file is then as it was.
pub fn replace_checked(path: &Path, bytes: &[u8], check: impl FnOnce() -> io::Result<()>) -> io::Result<()> {
    if is_special(path) {
        check()?;
        return fs::write(path, bytes);
    }
    let target = resolved(path);
    let mut file = temporary_beside(&target)?;
    file.write_all(bytes)?;
    file.as_file().sync_all()?;
    // File systems without locks still get the check.
    let lock = fs::File::open(&target).ok();
    let _ = lock.as_ref().map(fs::File::lock);
    check()?;
    file.persist(&target).map_err(|e| e.error)?;
    sync_folder(folder_of(&target));
    remove_stale(&target);
    Ok(())
}

fn folder_of(target: &Path) -> &Path {
    match target.parent() {
        Some(parent) if !parent.as_os_str().is_empty() => parent,
        _ => Path::new("."),
    }
}

/// Makes the new name last; some file systems cannot, and the content is safe anyway.
fn sync_folder(folder: &Path) {
    if let Ok(folder) = fs::File::open(folder) {
        let _ = folder.sync_all();
    }
}

/// Start of the names of neighbours of `target`.
fn prefix(target: &Path) -> String {
    // Long names are cut: with the rest they must stay below the limit of file systems.
    let name = target.file_name().unwrap_or_default().to_string_lossy();
    let cut = name.char_indices().nth(60).map_or(name.len(), |(at, _)| at);
    format!(".{}.hairline-", &name[..cut])
}

fn temporary_beside(target: &Path) -> io::Result<tempfile::NamedTempFile> {
    if target.is_dir() {
        return Err(io::ErrorKind::IsADirectory.into());
    }
    if target.as_os_str().is_empty() || target.file_name().is_none() {
        return Err(io::Error::new(io::ErrorKind::InvalidInput, "it is not a file name"));
    }
    if fs::metadata(target).is_ok_and(|m| m.permissions().readonly()) {
        return Err(io::Error::new(io::ErrorKind::PermissionDenied, "the file is read-only"));
    }
    let folder = folder_of(target);
    let prefix = format!("{}{}-", prefix(target), process::id());
    let mut builder = tempfile::Builder::new();
    builder.prefix(&prefix).suffix(PART);
    #[cfg(unix)]
    {
        // The usual mode of new files (the process's umask still applies), or that of the old file.
        use std::os::unix::fs::PermissionsExt;
        let mode = fs::metadata(target).map_or(0o666, |m| m.permissions().mode() & 0o777);
        builder.permissions(fs::Permissions::from_mode(mode));
    }
    builder.tempfile_in(folder).map_err(|error| match folder.is_dir() {
        true => error,
        false => {
            let text = format!("there is no folder {}", folder.display());
            io::Error::new(io::ErrorKind::NotFound, text)
        }
    })
}

/// Removes neighbours that killed processes have left.
fn remove_stale(target: &Path) {
    let prefix = prefix(target);
    let Ok(entries) = fs::read_dir(folder_of(target)) else { return };
    for entry in entries.flatten() {
        let name = entry.file_name();
        let Some(rest) = name.to_str().and_then(|n| n.strip_prefix(&prefix)?.strip_suffix(PART)) else {
            continue;
        };
        let owner = rest.split('-').next().and_then(|pid| pid.parse::<u32>().ok());
        if owner.is_some_and(|pid| pid != process::id()) && is_stale(owner, &entry) {
            let _ = fs::remove_file(entry.path());
        }
    }
}

fn is_stale(owner: Option<u32>, entry: &fs::DirEntry) -> bool {
    if cfg!(target_os = "linux")
        && let Some(pid) = owner
    {
        return !PathBuf::from(format!("/proc/{pid}")).exists();
    }
    let age = entry.metadata().and_then(|m| m.modified()).map(|t| t.elapsed().unwrap_or_default());
    age.is_ok_and(|age| age > STALE)
}

fn resolved(path: &Path) -> PathBuf {
    fs::canonicalize(path).unwrap_or_else(|_| path.into())
}

fn is_special(path: &Path) -> bool {
    fs::metadata(path).is_ok_and(|m| !m.is_file() && !m.is_dir())
}
