//! Values of options, as text.

use tem00_config::LENGTH;
use tem00_numerics::Crop;

pub fn positive(text: &str) -> Result<f64, String> {
    match text.parse::<f64>() {
        Ok(value) if value > 0.0 && value.is_finite() => Ok(value),
        _ => Err("must be a positive number".into()),
    }
}

/// Reads a grey value.
pub fn black_level(text: &str) -> Result<f64, String> {
    match text.parse::<f64>() {
        Ok(value) if value >= 0.0 && value.is_finite() => Ok(value),
        _ => Err("must be a grey value of 0 or more".into()),
    }
}

/// Reads a length as scene files have it, with its unit: a bare number would be in metres there,
/// and hardly meant so.
pub fn length(text: &str) -> Result<f64, String> {
    const ALLOWED: core::ops::RangeInclusive<f64> = 1e-12..=1e9;
    (LENGTH.parse(text))
        .filter(|length| ALLOWED.contains(length))
        .ok_or_else(|| "must be a positive length with its unit, such as \"5 mm\"".into())
}

pub fn crop(text: &str) -> Result<Crop, String> {
    let numbers: Option<Vec<usize>> = text.split(',').map(|n| n.trim().parse().ok()).collect();
    match numbers.as_deref() {
        Some(&[x, y, width, height]) if width > 0 && height > 0 => Ok(Crop {
            x,
            y,
            width,
            height,
        }),
        _ => Err("must be four numbers of pixels, X,Y,WIDTH,HEIGHT, such as 0,0,64,48".into()),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn lengths_have_a_unit() {
        for (text, expected) in [("5 mm", 5e-3), ("3.45 um", 3.45e-6), ("0.025m", 0.025)] {
            let found = length(text).expect(text);
            assert!((found / expected - 1.0).abs() < 1e-15, "{text}: {found}");
        }
        for bad in [
            "5", "-5 mm", "0 mm", "1e-20 m", "5 parsec", "", "nan", "nan m", "5 mm\"\n",
        ] {
            assert!(length(bad).is_err(), "{bad}");
        }
    }
}
