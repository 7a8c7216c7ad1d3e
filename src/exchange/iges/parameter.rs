//! Free-form parameter lists: numbers, Hollerith strings, blanks; and a cursor that reads them typed.
//!
//! Fields end at the parameter delimiter, the list at the record delimiter (IGES 5.3, 2.2.3).
//! Exponents may be written with D. A blank field takes its default.

use glam::DVec3;

use super::error::EntityError;

/// One field.
#[derive(Debug, Clone, PartialEq)]
pub(crate) enum Field {
    /// Nothing written: the default is meant.
    Blank,
    /// A number, possibly not finite (`NaN`, `1E999`).
    Number(f64),
    /// A Hollerith string.
    Text(String),
    /// Neither.
    Other(String),
}

/// As a message quotes it.
impl std::fmt::Display for Field {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        match self {
            Self::Blank => f.write_str("a blank field"),
            Self::Number(x) => write!(f, "{x}"),
            Self::Text(text) | Self::Other(text) => {
                write!(f, "`{}`", text.chars().take(20).collect::<String>())
            }
        }
    }
}

/// The delimiters that the global section sets.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) struct Delimiters {
    /// Between fields; `,` by default.
    pub field: u8,
    /// At the end of a list; `;` by default.
    pub record: u8,
}

impl Default for Delimiters {
    fn default() -> Self {
        Self { field: b',', record: b';' }
    }
}

/// Cuts `text` into fields; also whether the record delimiter was met.
pub(crate) fn fields(text: &[u8], delimiters: Delimiters) -> (Vec<Field>, bool) {
    let mut result = Vec::with_capacity(text.len() / 12 + 1);
    let mut position = 0;
    loop {
        while text.get(position).is_some_and(|c| c.is_ascii_whitespace()) {
            position += 1;
        }
        let (field, end) = match hollerith(text, position) {
            Some((string, end)) => {
                // Whatever stands between the string and the delimiter is not ours.
                let skip = text[end..].iter().position(|c| *c == delimiters.field || *c == delimiters.record);
                (Field::Text(string), skip.map_or(text.len(), |s| end + s))
            }
            None => {
                let rest = &text[position.min(text.len())..];
                let length = rest
                    .iter()
                    .position(|c| *c == delimiters.field || *c == delimiters.record)
                    .unwrap_or(rest.len());
                (number(&rest[..length]), position + length)
            }
        };
        result.push(field);
        match text.get(end) {
            Some(c) if *c == delimiters.record => return (result, true),
            Some(_) => position = end + 1,
            None => return (result, false),
        }
    }
}

/// `nHtext` at `position`: the text and where it ends.
fn hollerith(text: &[u8], position: usize) -> Option<(String, usize)> {
    let digits = text[position.min(text.len())..].iter().take_while(|c| c.is_ascii_digit()).count();
    if digits == 0 || digits > 9 || text.get(position + digits) != Some(&b'H') {
        return None;
    }
    let count: usize = std::str::from_utf8(&text[position..position + digits]).ok()?.parse().ok()?;
    let start = position + digits + 1;
    let end = start.checked_add(count)?.min(text.len());
    Some((String::from_utf8_lossy(&text[start..end]).into_owned(), end))
}

fn number(text: &[u8]) -> Field {
    let text = text.trim_ascii();
    if text.is_empty() {
        return Field::Blank;
    }
    let parsed = std::str::from_utf8(text).ok().and_then(|s| s.parse::<f64>().ok());
    if let Some(value) = parsed {
        return Field::Number(value);
    }
    // Fortran exponents (1.5D-3), and blanks inside a number that was wrapped.
    let cleaned: String = text
        .iter()
        .filter(|c| !c.is_ascii_whitespace())
        .map(|c| if matches!(c, b'D' | b'd') { 'E' } else { *c as char })
        .collect();
    match cleaned.parse::<f64>() {
        Ok(value) => Field::Number(value),
        Err(_) => Field::Other(cleaned),
    }
}

/// Reads the fields of one entity in order. The first field (the entity type) is already taken.
#[derive(Debug)]
pub(crate) struct Args {
    fields: Vec<Field>,
    next: usize,
}

impl Args {
    /// A cursor on `fields`, whose first is the entity type.
    pub(crate) fn new(fields: Vec<Field>) -> Self {
        Self { fields, next: 1 }
    }

    /// Number of fields not yet read.
    pub(crate) fn left(&self) -> usize {
        self.fields.len().saturating_sub(self.next)
    }

    fn take(&mut self) -> (usize, Option<&Field>) {
        let index = self.next;
        self.next += 1;
        (index, self.fields.get(index))
    }

    /// A finite number; blank fields give `default`, or an error without one.
    fn number(&mut self, what: &'static str, default: Option<f64>) -> Result<f64, EntityError> {
        let (index, field) = self.take();
        let found = match field {
            Some(Field::Number(value)) if value.is_finite() => return Ok(*value),
            None | Some(Field::Blank) => return default.ok_or(EntityError::Missing { index, what }),
            Some(Field::Number(value)) => value.to_string(),
            Some(Field::Text(text) | Field::Other(text)) => text.chars().take(40).collect(),
        };
        Err(EntityError::NotNumber { index, what, found })
    }

    /// A finite number. Blank means 0, as IGES has it.
    pub(crate) fn real(&mut self, what: &'static str) -> Result<f64, EntityError> {
        if self.next >= self.fields.len() {
            return Err(EntityError::Missing { index: self.next, what });
        }
        self.number(what, Some(0.0))
    }

    /// A finite number, or `default` when blank or absent.
    pub(crate) fn real_or(&mut self, what: &'static str, default: f64) -> Result<f64, EntityError> {
        self.number(what, Some(default))
    }

    /// A whole number, or `default` when blank or absent.
    pub(crate) fn integer_or(&mut self, what: &'static str, default: i64) -> Result<i64, EntityError> {
        let index = self.next;
        let value = self.number(what, Some(default as f64))?;
        if value.fract() != 0.0 || value.abs() > 1e15 {
            return Err(EntityError::Range { index, what, value, expected: "a whole number" });
        }
        Ok(value as i64)
    }

    /// A count of things that take `each` fields or more; checked against the fields left, so that
    /// nothing is ever allocated for a count that cannot be true.
    pub(crate) fn count(&mut self, what: &'static str, each: usize) -> Result<usize, EntityError> {
        let index = self.next;
        let value = self.number(what, None)?;
        if value.fract() != 0.0 || value < 0.0 {
            return Err(EntityError::Range { index, what, value, expected: "a count" });
        }
        let (needed, left) = (value * each as f64, self.left());
        if needed > left as f64 || value > 1e9 {
            return Err(EntityError::Count { what, count: value, needed, left });
        }
        Ok(value as usize)
    }

    /// A pointer to a directory entry (its number); 0 or blank is `None`.
    pub(crate) fn pointer(&mut self, what: &'static str) -> Result<Option<i64>, EntityError> {
        let value = self.number(what, Some(0.0))?;
        if value.fract() != 0.0 || value.abs() > 1e15 {
            return Err(EntityError::Pointer { what, target: value });
        }
        Ok((value != 0.0).then_some(value as i64))
    }

    /// A pointer that must be there.
    pub(crate) fn required(&mut self, what: &'static str) -> Result<i64, EntityError> {
        let index = self.next;
        self.pointer(what)?.ok_or(EntityError::Missing { index, what })
    }

    /// Three numbers, times `scale`.
    pub(crate) fn point(&mut self, what: &'static str, scale: f64) -> Result<DVec3, EntityError> {
        Ok(DVec3::new(self.real(what)?, self.real(what)?, self.real(what)?) * scale)
    }

    /// `count` numbers; the caller has checked the count.
    pub(crate) fn reals(&mut self, what: &'static str, count: usize) -> Result<Vec<f64>, EntityError> {
        if count > self.left() {
            let (count, left) = (count as f64, self.left());
            return Err(EntityError::Count { what, count, needed: count, left });
        }
        (0..count).map(|_| self.real(what)).collect()
    }

    /// Knots: like [`Self::reals`], but one that falls behind its neighbour by rounding alone (programs that
    /// compute repeated knots differently) is lifted to it.
    pub(crate) fn knots(&mut self, what: &'static str, count: usize) -> Result<Vec<f64>, EntityError> {
        const ROUNDING: f64 = 1e-12;
        let mut knots = self.reals(what, count)?;
        let slack = ROUNDING * knots.iter().fold(0.0_f64, |most, k| most.max(k.abs()));
        for i in 1..knots.len() {
            if knots[i] < knots[i - 1] && knots[i - 1] - knots[i] <= slack {
                knots[i] = knots[i - 1];
            }
        }
        Ok(knots)
    }

    /// A string; numbers are taken as written, blanks are empty.
    pub(crate) fn text(&mut self) -> String {
        match self.take().1 {
            Some(Field::Text(text) | Field::Other(text)) => text.trim().to_string(),
            Some(Field::Number(value)) => value.to_string(),
            None | Some(Field::Blank) => String::new(),
        }
    }

    /// Leaves out `count` fields.
    pub(crate) fn skip(&mut self, count: usize) {
        self.next = self.next.saturating_add(count);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn knots_that_fall_behind_by_rounding_are_lifted_and_others_left() {
        let read = |text: &str| {
            let (fields, _) = fields(text.as_bytes(), Delimiters::default());
            Args::new(fields).knots("knot", 5).unwrap()
        };
        let third = 0.1 + 0.2;
        assert_eq!(read(&format!("126,0.,{third:?},0.3,0.5,1.;")), [0.0, third, third, 0.5, 1.0]);
        // An error elsewhere: nothing is invented.
        assert_eq!(read("126,0.,0.31,0.3,0.5,1.;"), [0.0, 0.31, 0.3, 0.5, 1.0]);
    }
}
