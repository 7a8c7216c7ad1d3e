//! `hairline bench`: tables of speed, one file per table.
//!
//! Every table takes its rivals and its floor in the same run, so that the ratios hold on any machine.

pub mod shapes;

use super::arguments::{BenchArguments, Table};
use super::failure::Failure;

/// Prints the tables asked for, all of them without a name.
///
/// # Errors
/// A model cannot be read or standard output not written.
pub fn run(arguments: &BenchArguments) -> Result<(), Failure> {
    let tables = match arguments.table {
        Some(table) => vec![table],
        None => vec![Table::Classify, Table::Build, Table::Raycast, Table::Misses],
    };
    tables.into_iter().try_for_each(|table| match table {
        Table::Classify | Table::Build | Table::Raycast | Table::Misses => {
            Err(Failure::Lacking { reason: format!("the table {table:?} is not there yet") })
        }
    })
}
