//! Parameter lists laid out in 64 (or, in the global section, 72) columns.
//!
//! A number never crosses a line end; a string does only when no line could hold it whole (IGES 5.3,
//! 2.2.3). Strings are Hollerith constants that count bytes; control characters would break the card
//! image and become blanks.

use super::number;

/// One parameter.
#[derive(Debug, Clone, PartialEq)]
pub(crate) enum Field {
    /// A whole number.
    Integer(i64),
    /// A real number.
    Real(f64),
    /// A string; empty ones are left blank.
    Text(String),
    /// A directory entry.
    Pointer(Link),
}

/// A directory entry that a parameter or directory field means.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Link {
    /// Position among the entities made together.
    Local(usize),
    /// Its number in the file.
    Entry(u64),
}

impl Link {
    /// Number in the file, where the entities made together start at `first`.
    pub(crate) fn number(self, first: u64) -> u64 {
        match self {
            Self::Local(position) => first + 2 * position as u64,
            Self::Entry(number) => number,
        }
    }
}

/// Lays `fields` out in lines of `columns`, blank at their ends. Local links start at `first`.
pub(crate) fn lines(fields: &[Field], columns: usize, first: u64) -> Vec<u8> {
    let mut layout = Layout { bytes: Vec::with_capacity(16 * fields.len()), columns };
    let mut token = Vec::with_capacity(32);
    for (k, field) in fields.iter().enumerate() {
        let delimiter = if k + 1 == fields.len() { b';' } else { b',' };
        token.clear();
        match field {
            Field::Integer(value) => token.extend_from_slice(value.to_string().as_bytes()),
            Field::Real(value) => number::real(*value, &mut token),
            Field::Pointer(link) => token.extend_from_slice(link.number(first).to_string().as_bytes()),
            Field::Text(text) => hollerith(text, &mut token),
        }
        token.push(delimiter);
        layout.put(&token);
    }
    layout.fill();
    layout.bytes
}

/// `nHtext`.
fn hollerith(text: &str, token: &mut Vec<u8>) {
    if !text.is_empty() {
        token.extend_from_slice(format!("{}H", text.len()).as_bytes());
        token.extend(text.bytes().map(|c| if c.is_ascii_control() { b' ' } else { c }));
    }
}

struct Layout {
    bytes: Vec<u8>,
    columns: usize,
}

impl Layout {
    fn put(&mut self, token: &[u8]) {
        let used = self.bytes.len() % self.columns;
        if used > 0 && used + token.len() > self.columns {
            self.fill();
        }
        self.bytes.extend_from_slice(token);
    }

    /// Blanks to the end of the line.
    fn fill(&mut self) {
        let used = self.bytes.len() % self.columns;
        if used > 0 {
            self.bytes.resize(self.bytes.len() + self.columns - used, b' ');
        }
    }
}

#[cfg(test)]
mod tests {
    use super::super::super::parameter::{Delimiters, Field as Read, fields};
    use super::*;

    #[test]
    fn long_and_awkward_strings_survive_the_line_ends() {
        let texts = ["", "Ölwanne; 3,5", "a very long name ".repeat(9).trim_end(), "7H,;'", "tab\there"]
            .map(str::to_owned);
        let list: Vec<Field> = std::iter::once(Field::Integer(406))
            .chain(texts.iter().cloned().map(Field::Text))
            .chain([Field::Real(0.1), Field::Pointer(Link::Local(3))])
            .collect();
        let bytes = lines(&list, 64, 11);
        assert_eq!(bytes.len() % 64, 0);
        let (read, ended) = fields(&bytes, Delimiters::default());
        assert!(ended);
        let text = |k: usize| match &read[k] {
            Read::Text(text) => text.clone(),
            Read::Blank => String::new(),
            other => panic!("{other:?}"),
        };
        for k in 0..4 {
            assert_eq!(text(k + 1), texts[k]);
        }
        assert_eq!(text(5), "tab here");
        assert_eq!(read[6..], [Read::Number(0.1), Read::Number(17.0)]);
    }

    #[test]
    fn numbers_do_not_cross_line_ends() {
        let list: Vec<Field> = (0..40).map(|k| Field::Real(-1.0 / 3.0 + f64::from(k) * 1e-9)).collect();
        let bytes = lines(&list, 64, 1);
        for line in bytes.chunks(64) {
            let line = line.trim_ascii_end();
            assert!(line.ends_with(b",") || line.ends_with(b";"));
        }
    }
}
