//! The directory entry section: two lines of ten 8-column fields for each entity (IGES 5.3, 2.2.4.4).

use super::physical::{Line, Physical};

/// One directory entry. Pointers are directory-entry numbers as in the file (odd, from 1); 0 is none.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(crate) struct Entry {
    /// Entity type.
    pub kind: u32,
    /// Form of the type.
    pub form: i32,
    /// Number of the first parameter line, from 1.
    pub parameter_start: i64,
    /// Number of parameter lines.
    pub parameter_count: i64,
    /// Level: positive, or a pointer to a list of levels when negative.
    pub level: i64,
    /// Transformation matrix.
    pub transform: i64,
    /// Colour number, or minus a pointer to a colour entity.
    pub colour: i64,
    /// Blank status: not to be shown.
    pub blanked: bool,
    /// Subordinate switch: 0 independent, 1 physically dependent, 2 logically dependent, 3 both.
    pub subordinate: u8,
    /// Use flag: 0 geometry, 1 annotation, 2 definition, 5 two-dimensional, ...
    pub usage: u8,
    /// Label with subscript.
    pub label: String,
    /// First line in the file.
    pub line: usize,
}

/// Reads the section. Entry number `n` is at `(n - 1) / 2`.
pub(crate) fn read(file: &Physical<'_>) -> Vec<Entry> {
    file.directory.chunks_exact(2).map(|pair| entry(file, pair[0], pair[1])).collect()
}

fn entry(file: &Physical<'_>, first: Line, second: Line) -> Entry {
    let (a, b) = (file.text(first, 72), file.text(second, 72));
    let status = status(column(a, 8));
    let label = text(column(b, 7));
    let subscript = integer(column(b, 8));
    Entry {
        kind: u32::try_from(integer(column(a, 0))).unwrap_or(0),
        form: i32::try_from(integer(column(b, 4))).unwrap_or(0),
        parameter_start: integer(column(a, 1)),
        parameter_count: integer(column(b, 3)),
        level: integer(column(a, 4)),
        transform: integer(column(a, 6)),
        colour: integer(column(b, 2)),
        blanked: status[0] == 1,
        subordinate: status[1],
        usage: status[2],
        label: if subscript > 0 && !label.is_empty() { format!("{label}({subscript})") } else { label },
        line: first.number,
    }
}

fn column(line: &[u8], index: usize) -> &[u8] {
    let start = (8 * index).min(line.len());
    &line[start..(start + 8).min(line.len())]
}

fn text(field: &[u8]) -> String {
    String::from_utf8_lossy(field).trim().to_string()
}

/// A whole number; blank or unreadable is 0.
fn integer(field: &[u8]) -> i64 {
    std::str::from_utf8(field.trim_ascii()).ok().and_then(|s| s.parse().ok()).unwrap_or(0)
}

/// The four two-digit numbers of the status field; blanks count as zeros on the left.
fn status(field: &[u8]) -> [u8; 4] {
    let mut digits = [0u8; 8];
    let field = field.trim_ascii_end();
    for (digit, c) in digits.iter_mut().rev().zip(field.iter().rev()) {
        *digit = if c.is_ascii_digit() { c - b'0' } else { 0 };
    }
    [0, 2, 4, 6].map(|i| digits[i] * 10 + digits[i + 1])
}
