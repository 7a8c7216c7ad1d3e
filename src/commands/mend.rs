//! `hairline mend`: closes the gaps that moving trims can close, and writes the model.

use std::io::Write;

use super::arguments::MendArguments;
use super::convert::{self, Format};
use super::failure::Failure;
use super::output::check_writable;
use super::progress::Progress;
use super::source;
use crate::exchange::iges::write::WriteOptions;
use crate::inspect::Length;
use crate::inspect::mend::batch::{BatchReport, close_all};
use crate::scene::document::SceneRecord;

/// Reasons listed at most.
const ROWS: usize = 20;

/// Mends `arguments.file` into `arguments.output`.
///
/// # Errors
/// [`Failure::Found`] with exit code 1 when gaps stay open; input that cannot be read, output that cannot be
/// written.
pub fn run(arguments: &MendArguments) -> Result<(), Failure> {
    let format = convert::format_of(&arguments.output)?;
    check_writable(&arguments.output)?;
    let progress = Progress::start(format!("mending {}", arguments.file.display()));
    let opened = source::open(&arguments.file, &|part| progress.set(0.3 * part))?;
    let mm = opened.model.unit.millimetres;
    let mut scene = SceneRecord { models: vec![opened.model], ..SceneRecord::default() };
    let report = close_all(&mut scene, 0, arguments.tolerance.mm / mm)
        .map_err(|e| Failure::Work { reason: e.to_string() })?;
    drop(progress);
    let model = scene.models.swap_remove(0);
    match format {
        Format::Iges => {
            let output = &arguments.output;
            let file_name = output.file_name().map_or_else(String::new, |n| n.to_string_lossy().into_owned());
            convert::iges(&model, output, &WriteOptions { file_name, ..WriteOptions::default() })?;
        }
        Format::Scene => {
            let scene = SceneRecord { models: vec![model], ..SceneRecord::default() };
            convert::scene(&scene, &arguments.output)?;
        }
    }
    tell(&report, arguments, mm).map_err(|e| Failure::stdout(&e))?;
    if report.open.is_empty() { Ok(()) } else { Err(Failure::Found { code: 1 }) }
}

fn tell(report: &BatchReport, arguments: &MendArguments, mm: f64) -> std::io::Result<()> {
    let mut out = std::io::stdout().lock();
    let length = |x: f64| Length { mm: x * mm }.to_string();
    writeln!(
        out,
        "{}: {} gaps closed to {} or less, {} stay open",
        arguments.output.display(),
        report.closed.len(),
        arguments.tolerance,
        report.open.len()
    )?;
    let curve = |k: &crate::inspect::EdgeKey| {
        format!("{}.{}.{}", k.curve.face + 1, k.curve.trim_loop + 1, k.curve.curve + 1)
    };
    for (key, before, after) in report.closed.iter().take(ROWS) {
        writeln!(out, "  closed {:<12} {:>10} -> {}", curve(key), length(*before), length(*after))?;
    }
    for (key, gap, reason) in report.open.iter().take(ROWS) {
        writeln!(out, "  open   {:<12} {:>10}    {reason}", curve(key), length(*gap))?;
    }
    let more = report.closed.len().saturating_sub(ROWS) + report.open.len().saturating_sub(ROWS);
    if more > 0 {
        writeln!(out, "  and {more} more")?;
    }
    Ok(())
}
