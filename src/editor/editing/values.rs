//! Values typed into a prompt, read with errors that name the field.

use glam::{DVec2, DVec3};

/// Values and the names of their fields.
#[derive(Debug, Clone, Copy)]
pub(super) struct Values<'a> {
    fields: &'a [&'a str],
    values: &'a [String],
}

impl<'a> Values<'a> {
    pub fn new(fields: &'a [&'a str], values: &'a [String]) -> Self {
        Self { fields, values }
    }

    fn get(&self, index: usize) -> &'a str {
        self.values.get(index).map_or("", |v| v.trim())
    }

    fn name(&self, index: usize) -> &'a str {
        self.fields.get(index).copied().unwrap_or("value")
    }

    pub fn number(&self, index: usize) -> Result<f64, String> {
        number(self.get(index)).map_err(|e| format!("{}: {e}", self.name(index)))
    }

    /// None when nothing was typed.
    pub fn optional(&self, index: usize) -> Result<Option<f64>, String> {
        if self.get(index).is_empty() { Ok(None) } else { self.number(index).map(Some) }
    }

    pub fn uv(&self, index: usize) -> Result<DVec2, String> {
        Ok(DVec2::new(self.number(index)?, self.number(index + 1)?))
    }

    pub fn xyz(&self, index: usize) -> Result<DVec3, String> {
        Ok(DVec3::new(self.number(index)?, self.number(index + 1)?, self.number(index + 2)?))
    }

    /// Pairs of numbers; anything but digits, signs and points between them parts them.
    pub fn points(&self, index: usize) -> Result<Vec<DVec2>, String> {
        let words = self.get(index).split(|c: char| c.is_whitespace() || ",;()[]".contains(c));
        let numbers: Vec<f64> = words
            .filter(|w| !w.is_empty())
            .map(number)
            .collect::<Result<_, _>>()
            .map_err(|e| e.to_string())?;
        if numbers.len() % 2 != 0 {
            return Err(format!("{} numbers are no pairs of u and v", numbers.len()));
        }
        Ok(numbers.chunks_exact(2).map(|p| DVec2::new(p[0], p[1])).collect())
    }

    /// Something must have been typed.
    pub fn required(&self, index: usize) -> Result<String, String> {
        self.text(index).ok_or_else(|| format!("{}: nothing was typed", self.name(index)))
    }

    /// None when nothing was typed.
    pub fn text(&self, index: usize) -> Option<String> {
        Some(self.get(index).to_owned()).filter(|t| !t.is_empty())
    }

    pub fn layer(&self, index: usize) -> Result<Option<i32>, String> {
        let text = self.get(index);
        let read = |text: &str| text.parse().map_err(|_| format!("Layer: `{text}` is no whole number"));
        if text.is_empty() { Ok(None) } else { read(text).map(Some) }
    }

    /// `#rrggbb` as linear RGB.
    pub fn colour(&self, index: usize) -> Result<Option<[f32; 3]>, String> {
        let text = self.get(index).trim_start_matches('#');
        if text.is_empty() {
            return Ok(None);
        }
        let wrong = || format!("Colour: `{text}` is not six hexadecimal digits");
        if text.len() != 6 {
            return Err(wrong());
        }
        let value = u32::from_str_radix(text, 16).map_err(|_| wrong())?;
        let linear = |shift: u32| {
            let x = ((value >> shift) & 255) as f32 / 255.0;
            if x <= 0.04045 { x / 12.92 } else { ((x + 0.055) / 1.055).powf(2.4) }
        };
        Ok(Some([linear(16), linear(8), linear(0)]))
    }
}

fn number(text: &str) -> Result<f64, String> {
    match text.replace(',', ".").parse::<f64>() {
        Ok(value) if value.is_finite() => Ok(value),
        _ if text.is_empty() => Err("a number is missing".into()),
        _ => Err(format!("`{text}` is no number")),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn values(list: &[&str]) -> Vec<String> {
        list.iter().map(|s| (*s).to_owned()).collect()
    }

    #[test]
    fn numbers_are_read_or_refused_by_name() {
        let list = values(&[" 1.5 ", "-2e-3", "", "x", "inf", "1 2, 3 4;5 6", "1 2 3", "#ff0000", "red"]);
        let v = Values::new(&["a", "b", "c", "d", "e"], &list);
        assert_eq!(v.uv(0), Ok(DVec2::new(1.5, -2e-3)));
        assert_eq!(v.optional(2), Ok(None));
        assert!(v.number(2).is_err_and(|e| e.starts_with("c:")));
        assert!(v.number(3).is_err_and(|e| e.contains("`x`")));
        assert!(v.number(4).is_err());
        assert_eq!(v.points(5).map(|p| p.len()), Ok(3));
        assert!(v.points(6).is_err());
        assert_eq!(v.colour(7), Ok(Some([1.0, 0.0, 0.0])));
        assert!(v.colour(8).is_err());
        assert_eq!(v.colour(2), Ok(None));
    }
}
