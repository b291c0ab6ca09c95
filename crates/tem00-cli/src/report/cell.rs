//! Values as programs get them and as people read them.

use serde::Serialize;
use serde_json::Value;

use super::json;

/// A value: what JSON holds, and the text that a terminal and a page show.
#[derive(Clone, Debug, Default, PartialEq)]
pub(crate) struct Cell {
    pub(super) data: Value,
    pub(super) text: String,
}

impl Cell {
    /// A value with a text of its own; a number that is not finite is `null` in JSON.
    pub(crate) fn new(data: impl Serialize, text: impl Into<String>) -> Self {
        let (data, text) = (json::value(data), text.into());
        Self { data, text }
    }

    /// An unknown value: `null`, with the reason in place of a number.
    pub(crate) fn missing(reason: impl Into<String>) -> Self {
        Self::new(Value::Null, reason)
    }

    /// A value, or a dash where there is none.
    pub(crate) fn or_dash(cell: Option<impl Into<Self>>) -> Self {
        cell.map_or_else(|| Self::missing("-"), Into::into)
    }

    /// Returns the value with words after it.
    pub(crate) fn and(mut self, words: impl AsRef<str>) -> Self {
        self.text += words.as_ref();
        self
    }

    /// Returns the text.
    pub(crate) fn text(&self) -> &str {
        &self.text
    }
}

impl From<String> for Cell {
    fn from(text: String) -> Self {
        Self::new(text.clone(), text)
    }
}

impl From<&str> for Cell {
    fn from(text: &str) -> Self {
        Self::new(text, text)
    }
}

impl From<usize> for Cell {
    fn from(count: usize) -> Self {
        Self::new(count, count.to_string())
    }
}

impl From<u32> for Cell {
    fn from(count: u32) -> Self {
        Self::new(count, count.to_string())
    }
}

impl From<u64> for Cell {
    fn from(count: u64) -> Self {
        Self::new(count, count.to_string())
    }
}

/// A number with five significant digits.
impl From<f64> for Cell {
    fn from(value: f64) -> Self {
        Self::new(value, number(value))
    }
}

/// Writes a number with five significant digits, without an exponent where that is readable.
pub(crate) fn number(value: f64) -> String {
    rounded(value, 5)
}

/// Writes a number with so many significant digits, without an exponent where that is readable.
pub(crate) fn rounded(value: f64, digits: u8) -> String {
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
}
