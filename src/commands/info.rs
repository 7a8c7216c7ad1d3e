//! `hairline info`: what is in a model.

use super::arguments::InfoArguments;
use super::failure::Failure;
use super::progress::Progress;
use super::source;

/// Prints what is in `arguments.file`.
///
/// # Errors
/// The input cannot be read or standard output not written.
pub fn run(arguments: &InfoArguments) -> Result<(), Failure> {
    let progress = Progress::start(format!("reading {}", arguments.file.display()));
    let _opened = source::open(&arguments.file, &|part| progress.set(part))?;
    Err(Failure::Lacking { reason: "models cannot be described yet".into() })
}
