//! Real constants (IGES 5.3, 2.2.2.2): the shortest digits that read back to the same number, always with a
//! decimal point, with a D exponent (double precision) where that is shorter.

use std::io::Write;

/// Writes `value`, which is finite, to the end of `text`; 24 characters at most.
pub(crate) fn real(value: f64, text: &mut Vec<u8>) {
    // Where no exponent could be shorter than the zeros it saves.
    const PLAIN: std::ops::Range<f64> = 1e-2..1e5;
    let start = text.len();
    push(text, format_args!("{value}"));
    if !text[start..].contains(&b'.') {
        text.push(b'.');
    }
    if value == 0.0 || PLAIN.contains(&value.abs()) {
        return;
    }
    let scientific = format!("{value:e}");
    let (mantissa, exponent) = scientific.split_once('e').unwrap_or((&scientific, "0"));
    let point = if mantissa.contains('.') { "" } else { "." };
    if mantissa.len() + point.len() + 1 + exponent.len() < text.len() - start {
        text.truncate(start);
        push(text, format_args!("{mantissa}{point}D{exponent}"));
    }
}

fn push(text: &mut Vec<u8>, what: std::fmt::Arguments<'_>) {
    text.write_fmt(what).expect("invariant: writing to memory does not fail");
}

/// `value` to the nearest multiple of `step`, a power of ten below 1: a number with few digits.
pub(crate) fn rounded(value: f64, step: f64) -> f64 {
    let rounded = (value / step).round() / (1.0 / step).round();
    // Beyond 2^53 steps every number is a multiple.
    if (value / step).abs() < 9e15 { rounded } else { value }
}

/// The shortest number, in percent, that `reads_as` accepts as `wanted`; `exact` when none of up to 17 digits does.
pub(crate) fn shortest(exact: f64, mut reads_as: impl FnMut(f64) -> bool) -> f64 {
    (0..17)
        .filter_map(|digits| format!("{exact:.digits$}").parse::<f64>().ok())
        .find(|rounded| reads_as(*rounded))
        .unwrap_or(exact)
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    fn written(value: f64) -> String {
        let mut text = Vec::new();
        real(value, &mut text);
        String::from_utf8(text).unwrap()
    }

    #[test]
    fn numbers_are_short_and_have_a_point() {
        for (value, text) in [
            (0.0, "0."),
            (-0.0, "-0."),
            (1.0, "1."),
            (-2.5, "-2.5"),
            (1e-7, "1.D-7"),
            (1.5e20, "1.5D20"),
            (100.0, "100."),
            (0.1, "0.1"),
            (1e5, "1.D5"),
            (-1234567.0, "-1234567."),
            (0.001, "0.001"),
            (0.0001, "1.D-4"),
        ] {
            assert_eq!(written(value), text);
        }
    }

    #[test]
    fn rounding_shortens_and_changes_little() {
        assert_eq!(rounded(-12.345_678_912_345, 1e-6), -12.345_679);
        assert_eq!(rounded(1e15 + 0.3, 1e-3), 1e15 + 0.3);
        assert_eq!(rounded(0.000_4, 1e-3), 0.0);
    }

    proptest! {
        #[test]
        fn every_number_reads_back_bit_for_bit(bits in any::<u64>()) {
            let value = f64::from_bits(bits);
            prop_assume!(value.is_finite());
            let text = written(value);
            prop_assert!(text.len() <= 24 && text.contains('.'), "{}", text);
            let back: f64 = text.replace('D', "E").parse().unwrap();
            prop_assert_eq!(back.to_bits(), bits);
        }
    }
}
