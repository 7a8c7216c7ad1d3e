//! `hairline info`: what is in a model, for people and as JSON.
//!
//! [`summarise`] works the numbers out, `text` lays them out for reading.

mod summary;
mod text;

use std::io::{self, Write};

pub use summary::{Counts, FaceInfo, Info, Memory, summarise};
pub use text::write_text;

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
    let opened = source::open(&arguments.file, &|part| progress.set(0.5 * part))?;
    let info = summarise(&opened.model, &opened.report, &|part| progress.set(0.5 + 0.5 * part));
    drop(progress);
    let mut out = io::BufWriter::new(io::stdout().lock());
    let written = if arguments.json {
        serde_json::to_writer_pretty(&mut out, &info).map_err(io::Error::from).and_then(|()| writeln!(out))
    } else {
        write_text(&info, &mut out)
    };
    written.and_then(|()| out.flush()).map_err(|e| Failure::stdout(&e))
}
