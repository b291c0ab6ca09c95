//! Numbers as people read them.

/// Writes a number with five significant digits, without an exponent where that is readable.
pub fn number(value: f64) -> String {
    rounded(value, 5)
}

/// Writes a number with `digits` significant digits, without an exponent where that is readable.
pub fn rounded(value: f64, digits: u8) -> String {
    let magnitude = value.abs();
    let text = if value.is_nan() {
        return "-".into();
    } else if value.is_infinite() {
        return if value > 0.0 { "∞" } else { "-∞" }.into();
    } else if magnitude == 0.0 {
        return "0".into();
    } else if (1e-3..1e6).contains(&magnitude) {
        let decimals = f64::from(digits) - 1.0 - magnitude.log10().floor();
        #[expect(
            clippy::cast_possible_truncation,
            clippy::cast_sign_loss,
            reason = "the number of digits lies in [0, 9]"
        )]
        let decimals = decimals.clamp(0.0, 9.0) as usize;
        format!("{value:.decimals$}")
    } else {
        return format!("{value:.2e}");
    };
    if text.contains('.') {
        text.trim_end_matches('0').trim_end_matches('.').to_owned()
    } else {
        text
    }
}

/// Writes a positive number with three digits and an SI prefix.
pub fn si_prefixed(value: f64) -> String {
    let (scale, prefix) = match value {
        v if v >= 1e9 => (1e9, " G"),
        v if v >= 1e6 => (1e6, " M"),
        v if v >= 1e3 => (1e3, " k"),
        _ => (1.0, " "),
    };
    let scaled = value / scale;
    let digits = if scaled >= 100.0 {
        0
    } else if scaled >= 10.0 {
        1
    } else {
        2
    };
    format!("{scaled:.digits$}{prefix}")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_have_five_digits() {
        for (value, expected) in [
            (0.0, "0"),
            (1.0, "1"),
            (0.999_384, "0.99938"),
            (512.0, "512"),
            (123_456.7, "123457"),
            (-4.05, "-4.05"),
            (0.012_345_67, "0.012346"),
            (1e-9, "1.00e-9"),
            (2.5e7, "2.50e7"),
            (f64::INFINITY, "∞"),
            (f64::NAN, "-"),
        ] {
            assert_eq!(number(value), expected);
        }
    }

    #[test]
    fn rates_have_three_digits_and_a_prefix() {
        assert_eq!(si_prefixed(3.456), "3.46 ");
        assert_eq!(si_prefixed(12_345.0), "12.3 k");
        assert_eq!(si_prefixed(234_567_890.0), "235 M");
        assert_eq!(si_prefixed(1e9), "1.00 G");
    }
}
