//! The physical file: lines and sections.
//!
//! Fixed-form IGES is a deck of 80-column cards: data in columns 1 to 72 (64 in the parameter
//! section), the section letter in column 73, a sequence number behind it (IGES 5.3, section 2.2).
//! Real files end lines in CR, LF, CRLF or not at all, cut or pad them, and lose the terminate
//! section. Lines are kept as ranges of the bytes read; nothing is copied.

use super::error::ReadError;

/// One line: where it is in the file, and its number from 1.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) struct Line {
    start: usize,
    end: usize,
    /// Line number in the file, from 1.
    pub number: usize,
}

/// The lines of each section.
#[derive(Debug)]
pub(crate) struct Physical<'a> {
    bytes: &'a [u8],
    /// Global section.
    pub global: Vec<Line>,
    /// Directory entry section, two lines for an entity.
    pub directory: Vec<Line>,
    /// Parameter data section.
    pub parameters: Vec<Line>,
    /// Whether the terminate section was there.
    pub terminated: bool,
    /// Number of lines of the file.
    pub line_count: usize,
}

impl<'a> Physical<'a> {
    /// Sorts the lines of `bytes` into sections.
    ///
    /// # Errors
    /// Empty files, other formats, compressed and binary IGES, no directory.
    pub(crate) fn split(bytes: &'a [u8]) -> Result<Self, ReadError> {
        let bytes = bytes.strip_prefix(b"\xef\xbb\xbf").unwrap_or(bytes);
        if bytes.iter().all(u8::is_ascii_whitespace) {
            return Err(ReadError::Empty);
        }
        refuse_other_formats(bytes)?;
        let mut file = Physical {
            bytes,
            global: Vec::new(),
            directory: Vec::new(),
            parameters: Vec::new(),
            terminated: false,
            line_count: 0,
        };
        let mut any = false;
        for line in Lines::new(bytes) {
            file.line_count = line.number;
            match section_letter(&bytes[line.start..line.end]) {
                Some(b'S') => any = true,
                Some(b'G') => file.global.push(line),
                Some(b'D') => file.directory.push(line),
                Some(b'P') => file.parameters.push(line),
                Some(b'T') => {
                    file.terminated = true;
                    break;
                }
                Some(b'C') if !any => return Err(ReadError::Form { line: line.number, form: "compressed" }),
                Some(b'B') if !any => return Err(ReadError::Form { line: line.number, form: "binary" }),
                _ => {}
            }
        }
        if !any && file.global.is_empty() && file.directory.is_empty() {
            let reason = "no line has a section letter (S, G, D, P, T) in column 73".to_string();
            return Err(ReadError::NotIges { line: 1, reason });
        }
        let section = if file.directory.len() < 2 { "directory entry" } else { "parameter data" };
        if file.directory.len() < 2 || file.parameters.is_empty() {
            return Err(ReadError::Section { line: file.line_count, section });
        }
        Ok(file)
    }

    /// The data columns of a line: the first `columns` of it.
    pub(crate) fn text(&self, line: Line, columns: usize) -> &'a [u8] {
        &self.bytes[line.start..line.end.min(line.start + columns)]
    }
}

/// The section letter: column 73, or, for a line cut or widened, the letter before the final digits.
fn section_letter(line: &[u8]) -> Option<u8> {
    if let Some(&letter) = line.get(72)
        && letter.is_ascii_uppercase()
        && line[73..].iter().all(|c| c.is_ascii_digit() || c.is_ascii_whitespace())
    {
        return Some(letter);
    }
    let line = line.trim_ascii_end();
    let digits = line.iter().rev().take_while(|c| c.is_ascii_digit()).count();
    if digits == 0 || digits > 7 {
        return None;
    }
    let head = line[..line.len() - digits].trim_ascii_end();
    let letter = *head.last()?;
    // A letter at the end of other text is data, unless a start line (free text) is meant.
    (b"SGDPT".contains(&letter) && line.len() > 8 && line.len() - head.len() < 8).then_some(letter)
}

fn refuse_other_formats(bytes: &[u8]) -> Result<(), ReadError> {
    let head = &bytes[..bytes.len().min(4096)];
    let not = |reason: &str| Err(ReadError::NotIges { line: 1, reason: reason.to_string() });
    let text = head.trim_ascii_start();
    if text.starts_with(b"ISO-10303-21") {
        return not("it is a STEP file (ISO-10303-21)");
    }
    if text.starts_with(b"3D Geometry File Format") {
        return not("it is a Rhino 3dm file");
    }
    if text.starts_with(b"solid ") && head.windows(5).any(|w| w == b"facet") {
        return not("it is an STL mesh");
    }
    if text.starts_with(b"PK\x03\x04") || text.starts_with(b"\x1f\x8b") {
        return not("it is a compressed archive");
    }
    let strange = head.iter().filter(|c| **c == 0 || (**c < 32 && !c.is_ascii_whitespace())).count();
    if strange * 50 > head.len() {
        return not("it is a binary file");
    }
    Ok(())
}

/// Lines ended by CR, LF or CRLF; a file without any line end is cut into cards of 80.
struct Lines<'a> {
    bytes: &'a [u8],
    position: usize,
    number: usize,
    cards: bool,
}

impl<'a> Lines<'a> {
    fn new(bytes: &'a [u8]) -> Self {
        let cards = !bytes[..bytes.len().min(1024)].iter().any(|c| *c == b'\n' || *c == b'\r');
        Self { bytes, position: 0, number: 0, cards }
    }
}

impl Iterator for Lines<'_> {
    type Item = Line;

    fn next(&mut self) -> Option<Line> {
        let rest = self.bytes.get(self.position..).filter(|rest| !rest.is_empty())?;
        let length = if self.cards {
            rest.len().min(80)
        } else {
            rest.iter().position(|c| *c == b'\n' || *c == b'\r').unwrap_or(rest.len())
        };
        let skip = match &rest[length..] {
            _ if self.cards => 0,
            [b'\r', b'\n', ..] => 2,
            [] => 0,
            _ => 1,
        };
        let line = Line { start: self.position, end: self.position + length, number: self.number + 1 };
        self.number += 1;
        self.position += length + skip;
        Some(line)
    }
}
