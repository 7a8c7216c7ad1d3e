//! `hairline [FILE...]`: opens the editor.

use std::path::PathBuf;

use super::failure::Failure;
use super::source;

/// Opens the editor on `files`, or on the demo scene when there are none.
///
/// # Errors
/// A file does not exist, the build has no editor, or the machine has no display or graphics driver.
pub fn run(files: &[PathBuf], demo: bool) -> Result<(), Failure> {
    files.iter().try_for_each(|path| source::check(path))?;
    open_editor(&source::or_demo(files, demo))
}

#[cfg(feature = "editor")]
fn open_editor(files: &[PathBuf]) -> Result<(), Failure> {
    use crate::editor::{EditorOptions, StartError, run};
    run(EditorOptions { files: files.to_vec() }).map_err(|error| match error {
        StartError::Ended { .. } => Failure::Work { reason: error.to_string() },
        _ => Failure::Lacking { reason: error.to_string() },
    })
}

#[cfg(not(feature = "editor"))]
fn open_editor(_files: &[PathBuf]) -> Result<(), Failure> {
    Err(Failure::Lacking {
        reason: "this program was built without the editor; build it with `cargo build` (feature `editor`), \
                 or use a sub-command: hairline --help"
            .into(),
    })
}
