//! Values as programs get them and as people read them.

use serde::Serialize;
use serde_json::Value;

use crate::digits::number;

/// A value: what JSON holds, and the text that a terminal and a page show.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Cell {
    pub(super) data: Value,
    pub(super) text: String,
}

/// Returns a value as JSON; numbers that are not finite become `null`.
pub(super) fn value(value: impl Serialize) -> Value {
    // Only keys that are not text fail, and there are none.
    serde_json::to_value(value).unwrap_or_default()
}

impl Cell {
    /// A value with its own text; a number that is not finite is `null` in JSON.
    pub fn new(data: impl Serialize, text: impl Into<String>) -> Self {
        let (data, text) = (value(data), text.into());
        Self { data, text }
    }

    /// An unknown value: `null`, with the reason in place of a number.
    pub fn missing(reason: impl Into<String>) -> Self {
        Self::new(Value::Null, reason)
    }

    /// A value, or a dash where there is none.
    pub fn or_dash(cell: Option<impl Into<Self>>) -> Self {
        cell.map_or_else(|| Self::missing("-"), Into::into)
    }

    /// Returns the value with words after it.
    pub fn and(mut self, words: impl AsRef<str>) -> Self {
        self.text += words.as_ref();
        self
    }

    /// Returns the text.
    pub fn text(&self) -> &str {
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

macro_rules! counts {
    ($($count:ty),*) => {$(
        impl From<$count> for Cell {
            fn from(count: $count) -> Self {
                Self::new(count, count.to_string())
            }
        }
    )*};
}

counts!(usize, u32, u64);

/// A number with five significant digits.
impl From<f64> for Cell {
    fn from(value: f64) -> Self {
        Self::new(value, number(value))
    }
}
