//! `hairline render`: a picture of a model as a PNG file.

use super::arguments::RenderArguments;
use super::failure::Failure;
use super::progress::Progress;
use super::{output, source};

/// Draws `arguments.file` into `arguments.output`.
///
/// # Errors
/// The input cannot be read, the output not written, or the graphics driver asked for is missing.
pub fn run(arguments: &RenderArguments) -> Result<(), Failure> {
    output::check_writable(&arguments.output)?;
    let progress = Progress::start(format!("reading {}", arguments.file.display()));
    let _opened = source::open(&arguments.file, &|part| progress.set(part))?;
    Err(Failure::Lacking { reason: "pictures cannot be drawn yet".into() })
}
