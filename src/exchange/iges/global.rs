//! The global section: delimiters, sender, units, resolution (IGES 5.3, 2.2.4.3).

use super::parameter::{Args, Delimiters, Field, fields};
use super::physical::Physical;
use super::unit;
use crate::scene::records::LengthUnit;

/// What the global section says, with defaults for what it leaves out.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Global {
    pub delimiters: Delimiters,
    /// Product name as given by the sender.
    pub product: String,
    /// Sending system and its version.
    pub system: String,
    /// Model space scale (a drawing scale; not applied to geometry).
    pub scale: f64,
    /// Unit of the numbers in the file.
    pub unit: LengthUnit,
    /// Smallest distance the sender tells apart, in file units.
    pub resolution: f64,
    /// Unit flag and name disagree, or are unknown.
    pub unit_problem: Option<String>,
}

impl Global {
    /// Reads the section; whatever cannot be read takes its default.
    pub(crate) fn read(file: &Physical<'_>) -> Self {
        let mut text = Vec::new();
        for line in &file.global {
            let part = file.text(*line, 72);
            text.extend_from_slice(part);
            text.resize(text.len() + 72 - part.len(), b' ');
        }
        let (delimiters, start) = delimiters(&text);
        let (list, _) = fields(&text[start.min(text.len())..], delimiters);
        // The list now starts with field 3 of the section; `Args` passes over the first, so put one there.
        let mut args = Args::new(std::iter::once(Field::Blank).chain(list).collect());
        let product = args.text();
        let file_name = args.text();
        let (system, version) = (args.text(), args.text());
        args.skip(5); // sizes of the sender's numbers
        args.skip(1); // product name for the receiver
        let scale = args.real_or("scale", 1.0).unwrap_or(1.0);
        let flag = args.integer_or("unit flag", 0).unwrap_or(0);
        let name = args.text();
        args.skip(3); // line weights, date
        let resolution = args.real_or("resolution", 0.0).unwrap_or(0.0);
        let (unit, unit_problem) = unit::choose(flag, &name);
        let system = match (system.is_empty(), version.is_empty() || version == system) {
            (true, _) => version,
            (false, true) => system,
            (false, false) => format!("{system}, {version}"),
        };
        let product = if product.is_empty() { file_name } else { product };
        Self { delimiters, product, system, scale, unit, resolution: resolution.max(0.0), unit_problem }
    }
}

/// The two delimiters, each given as `1Hc` or left out, and where the third field starts.
fn delimiters(text: &[u8]) -> (Delimiters, usize) {
    let mut result = Delimiters::default();
    let blank = |from: usize| from + text[from.min(text.len())..].iter().take_while(|c| **c == b' ').count();
    let mut position = blank(0);
    if text[position.min(text.len())..].starts_with(b"1H") && text.len() > position + 2 {
        result.field = text[position + 2];
        position = blank(position + 3);
    }
    if text.get(position) == Some(&result.field) {
        position = blank(position + 1);
    }
    if text[position.min(text.len())..].starts_with(b"1H") && text.len() > position + 2 {
        result.record = text[position + 2];
        position = blank(position + 3);
    }
    if text.get(position) == Some(&result.field) {
        position += 1;
    }
    let sound = |c: u8| c.is_ascii_graphic() && !c.is_ascii_alphanumeric() && !b"+-.".contains(&c);
    if !sound(result.field) || !sound(result.record) || result.field == result.record {
        result = Delimiters::default();
    }
    (result, position)
}
