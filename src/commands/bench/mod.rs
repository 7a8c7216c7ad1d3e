//! `hairline bench`: tables of speed, one file per table.
//!
//! Every table takes its rivals and its floor in the same run, so that the ratios hold on any machine.

pub mod build;
pub mod classify;
pub mod edit;
pub mod gaps;
pub mod misses;
pub mod raycast;
pub mod rivals;
pub mod scene;
pub mod shapes;
pub mod sheet;
pub mod tessellate;
pub mod walk;

use std::io;
use std::path::PathBuf;

use super::arguments::{BenchArguments, Table};
use super::failure::Failure;
use crate::scene::records::ModelRecord;

/// Prints the tables asked for, all of them without a name.
///
/// # Errors
/// A model cannot be read or standard output not written.
pub fn run(arguments: &BenchArguments) -> Result<(), Failure> {
    let tables = match arguments.table {
        Some(table) => vec![table],
        None => vec![
            Table::Classify,
            Table::Build,
            Table::Edit,
            Table::Walk,
            Table::Raycast,
            Table::Misses,
            Table::Scene,
            Table::Gaps,
        ],
    };
    let models = models(&arguments.files)?;
    let mut out = std::io::stdout().lock();
    tables.into_iter().try_for_each(|table| match table {
        Table::Classify => classify::run(&models, &mut out).map_err(unwritable),
        Table::Build => build::run(&models, &mut out).map_err(unwritable),
        Table::Edit => edit::run(&mut out).map_err(unwritable),
        Table::Walk => walk::run(&mut out).map_err(unwritable),
        Table::Raycast => raycast::run(&models, &mut out).map_err(unwritable),
        Table::Misses => misses::run(&models, &mut out).map_err(unwritable),
        Table::Scene => scene::run(&mut out).map_err(unwritable),
        Table::Gaps => gaps::run(&models, &mut out).map_err(unwritable),
        Table::Tessellate => tessellate::run(&models, arguments.samples, &mut out).map_err(unwritable),
    })
}

fn models(files: &[PathBuf]) -> Result<Vec<ModelRecord>, Failure> {
    files.iter().map(|file| super::source::open(file, &|_| ()).map(|opened| opened.model)).collect()
}

fn unwritable(error: io::Error) -> Failure {
    if error.kind() == io::ErrorKind::BrokenPipe {
        return Failure::Closed;
    }
    Failure::Output { path: "standard output".into(), reason: error.to_string() }
}
