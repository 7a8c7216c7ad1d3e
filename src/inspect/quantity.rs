//! Lengths as people write them: `31.4 nm`, `2.6 um`, `0.7 mm`, over the nine decades that gaps span.

use std::fmt::{self, Display};
use std::str::FromStr;

/// A length in millimetres, shown with three digits and the unit that fits: pm, nm, um, mm or m.
#[derive(Debug, Clone, Copy, PartialEq, PartialOrd)]
pub struct Length {
    /// Millimetres.
    pub mm: f64,
}

/// Names of units and their millimetres; the first of each size is the one that is written.
const UNITS: [(&str, f64); 9] = [
    ("m", 1e3),
    ("mm", 1.0),
    ("um", 1e-3),
    ("nm", 1e-6),
    ("pm", 1e-9),
    ("cm", 10.0),
    ("\u{b5}m", 1e-3),
    ("in", 25.4),
    ("mil", 0.0254),
];
/// Of those, how many are used for writing.
const WRITTEN: usize = 5;

impl Display for Length {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let size = self.mm.abs();
        if !self.mm.is_finite() {
            return write!(f, "{} mm", self.mm);
        }
        if size < 1e-12 {
            return write!(f, "0 mm");
        }
        // 999.6 nm is written as 1 um, not as 1000 nm; metres only from ten on.
        let fits = |(name, mm): &&(&str, f64)| size >= mm * if *name == "m" { 10.0 } else { 0.9995 };
        let (name, mm) = UNITS[..WRITTEN].iter().find(fits).unwrap_or(&UNITS[WRITTEN - 1]);
        let value = self.mm / mm;
        let digits = match value.abs() {
            v if v >= 99.95 => 0,
            v if v >= 9.995 => 1,
            _ => 2,
        };
        write!(f, "{value:.digits$} {name}")
    }
}

/// Text that is no length.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum LengthError {
    /// Not a number followed by a unit.
    #[error("`{text}` is not a length; expected a number with a unit: 10um, 0.5mm, 250nm")]
    Syntax {
        /// What was given.
        text: String,
    },
    /// Zero, negative or not finite.
    #[error("`{text}` is not positive")]
    NotPositive {
        /// What was given.
        text: String,
    },
}

impl FromStr for Length {
    type Err = LengthError;

    /// A positive length; a number alone is in millimetres.
    fn from_str(text: &str) -> Result<Self, LengthError> {
        let syntax = || LengthError::Syntax { text: text.into() };
        let trimmed = text.trim();
        let at = trimmed.find(|c: char| c.is_alphabetic() && c != 'e' && c != 'E').unwrap_or(trimmed.len());
        let (number, unit) = trimmed.split_at(at);
        let number: f64 = number.trim().parse().map_err(|_| syntax())?;
        let mm = match unit {
            "" => 1.0,
            // The Greek letter beside the micro sign.
            "\u{3bc}m" => 1e-3,
            unit => UNITS.iter().find(|u| u.0 == unit).ok_or_else(syntax)?.1,
        };
        let mm = number * mm;
        if !(mm.is_finite() && mm > 0.0) {
            return Err(LengthError::NotPositive { text: text.into() });
        }
        Ok(Self { mm })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn lengths_are_written_with_three_digits_and_a_fitting_unit() {
        let shown = |mm: f64| Length { mm }.to_string();
        assert_eq!(shown(3.14e-5), "31.4 nm");
        assert_eq!(shown(2.6e-3), "2.60 um");
        assert_eq!(shown(-0.7), "-700 um");
        assert_eq!(shown(9.999e-4), "1.00 um");
        assert_eq!(shown(1234.0), "1234 mm");
        assert_eq!(shown(25_000.0), "25.0 m");
        assert_eq!(shown(4e-11), "0.04 pm");
        assert_eq!(shown(0.0), "0 mm");
        assert_eq!(shown(f64::INFINITY), "inf mm");
    }

    #[test]
    fn lengths_are_read_with_and_without_a_unit() {
        let read = |text: &str| text.parse::<Length>().map(|l| l.mm);
        for (text, mm) in [
            ("10um", 0.01),
            ("10 \u{b5}m", 0.01),
            ("1e-3 mm", 1e-3),
            ("0.5", 0.5),
            ("1in", 25.4),
            ("250nm", 2.5e-4),
        ] {
            assert!((read(text).unwrap() - mm).abs() < 1e-15, "{text}");
        }
        for bad in ["", "um", "10 parsec", "1,5mm", "nan", "10um um"] {
            assert!(matches!(read(bad), Err(LengthError::Syntax { .. })), "{bad}");
        }
        for bad in ["0", "-1um", "1e999mm"] {
            assert!(matches!(read(bad), Err(LengthError::NotPositive { .. })), "{bad}");
        }
    }
}
