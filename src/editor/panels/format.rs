//! How numbers are written in panels.

/// A length or coordinate: six significant digits, no exponent for ordinary sizes, no `-0`.
pub(super) fn number(x: f64) -> String {
    if !x.is_finite() {
        return x.to_string();
    }
    let size = x.abs();
    if size == 0.0 {
        return "0".into();
    }
    if !(1e-4..1e9).contains(&size) {
        return format!("{x:.4e}");
    }
    let before = (size.log10().floor() as i32 + 1).max(1);
    let digits = (6 - before).clamp(0, 8) as usize;
    let text = format!("{x:.digits$}");
    let text = if text.contains('.') { text.trim_end_matches('0').trim_end_matches('.') } else { &text };
    if text == "-0" { "0".into() } else { text.into() }
}

/// A coordinate in a column: three decimals, so that columns line up.
pub(super) fn coordinate(x: f64) -> String {
    if x.abs() >= 1e8 { format!("{x:.3e}") } else { format!("{x:.3}") }
}

/// A count with thin spaces between thousands.
pub(super) fn count(n: usize) -> String {
    let digits = n.to_string();
    let mut text = String::new();
    for (i, c) in digits.chars().enumerate() {
        if i > 0 && (digits.len() - i).is_multiple_of(3) {
            text.push('\u{2009}');
        }
        text.push(c);
    }
    text
}

/// Bytes in the largest fitting unit.
pub(super) fn bytes(n: u64) -> String {
    const UNITS: [&str; 4] = ["B", "kB", "MB", "GB"];
    let mut value = n as f64;
    let mut unit = 0;
    while value >= 1000.0 && unit < 3 {
        value /= 1000.0;
        unit += 1;
    }
    if value < 10.0 && unit > 0 {
        format!("{value:.1} {}", UNITS[unit])
    } else {
        format!("{value:.0} {}", UNITS[unit])
    }
}

/// `1 face`, `2 faces`.
pub(in crate::editor) fn plural(n: usize, one: &str) -> String {
    if n == 1 { format!("1 {one}") } else { format!("{} {one}s", count(n)) }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_are_short_and_keep_six_digits() {
        for (x, text) in [
            (0.0, "0"),
            (-0.0, "0"),
            (1.0, "1"),
            (921.4567891, "921.457"),
            (-12.5, "-12.5"),
            (123456789.0, "123456789"),
            (1e-9, "1.0000e-9"),
            (0.00123456, "0.00123"),
            (f64::NAN, "NaN"),
        ] {
            assert_eq!(number(x), text, "{x:?}");
        }
        assert_eq!(count(1234567), "1\u{2009}234\u{2009}567");
        assert_eq!(bytes(1_400_000), "1.4 MB");
        assert_eq!(plural(1, "face"), "1 face");
        assert_eq!(plural(2, "face"), "2 faces");
    }
}
