//! The start and global sections: who wrote the file, with which numbers, in which unit.

use super::list::{Field, lines};
use super::{WriteError, WriteOptions};
use crate::scene::records::ModelRecord;

/// Distance below which receivers may take points as one, in millimetres. Far below any gap that
/// matters, so that nobody mends what Hairline shows; far above the rounding of large models.
const RESOLUTION: f64 = 1e-6;

/// Start section, in lines of 72 columns.
pub(crate) fn start() -> Vec<u8> {
    let mut text = format!("Written by Hairline {}", env!("CARGO_PKG_VERSION")).into_bytes();
    text.resize(72, b' ');
    text
}

/// Global section, in lines of 72 columns.
///
/// # Errors
/// [`WriteError::Empty`] for a model without control points.
pub(crate) fn global(model: &ModelRecord, options: &WriteOptions) -> Result<Vec<u8>, WriteError> {
    let largest = largest(model).ok_or(WriteError::Empty)? / options.unit.millimetres;
    let resolution = RESOLUTION.max(1e-12 * largest * options.unit.millimetres) / options.unit.millimetres;
    let system = format!("Hairline {}", env!("CARGO_PKG_VERSION"));
    let text = |text: &str| Field::Text(text.to_owned());
    let fields = [
        text(","),
        text(";"),
        text(&model.name),
        text(&options.file_name),
        text(&system),
        text(&system),
        Field::Integer(32), // bits of an integer
        Field::Integer(308),
        Field::Integer(15),
        Field::Integer(308),
        Field::Integer(15),
        text(&model.name),
        Field::Real(1.0), // scale
        Field::Integer(options.unit.flag),
        text(options.unit.file_name()),
        Field::Integer(1), // line weights
        Field::Real(1.0),
        text(&options.date),
        Field::Real(resolution),
        Field::Real(largest),
        text(&options.author),
        text(""),
        Field::Integer(11), // version 5.3
        Field::Integer(0),
        text(&options.date),
    ];
    Ok(lines(&fields, 72, 1))
}

/// Largest coordinate.
fn largest(model: &ModelRecord) -> Option<f64> {
    model.faces.iter().flat_map(|f| f.surface.points()).map(|p| p.abs().max_element()).reduce(f64::max)
}
