//! Real constants (IGES 5.3, 2.2.2.2): the shortest digits that read back to the same number, always with a
//! decimal point, with a D exponent (double precision) where that is shorter.

/// Writes `value`, which is finite, to the end of `text`; 24 characters at most.
pub(crate) fn real(value: f64, text: &mut Vec<u8>) {
    let plain = format!("{value}");
    let scientific = format!("{value:e}");
    let (mantissa, exponent) = scientific.split_once('e').unwrap_or((&scientific, "0"));
    let pointed = |digits: &str| if digits.contains('.') { digits.into() } else { format!("{digits}.") };
    let plain = pointed(&plain);
    let scientific = format!("{}D{exponent}", pointed(mantissa));
    let shorter = if plain.len() <= scientific.len() { plain } else { scientific };
    text.extend_from_slice(shorter.as_bytes());
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
        ] {
            assert_eq!(written(value), text);
        }
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
