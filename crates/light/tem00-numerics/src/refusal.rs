use std::{borrow::Cow, error, fmt};

use crate::Shown;

/// Refused argument: its name, its value, and what is allowed.
///
/// # Examples
///
/// ```
/// use tem00_numerics::check;
///
/// let refusal = check::positive("waist_radius", -2e-6, "m").unwrap_err();
/// assert_eq!(refusal.parameter, "waist_radius");
/// assert_eq!(refusal.to_string(), "waist_radius must be positive and finite, got -2e-6 m");
/// ```
#[derive(Clone, Debug, PartialEq)]
pub struct Refusal {
    /// The name of the argument, field or quantity, as its caller knows it.
    pub parameter: &'static str,
    /// The refused value.
    pub value: RefusedValue,
    /// The position of the value in a list, from 0.
    pub index: Option<usize>,
    /// The unit of the value, empty for a plain number.
    pub unit: &'static str,
    /// The allowed values, worded to follow "must be".
    pub allowed: Cow<'static, str>,
}

/// Value of a refused argument.
#[derive(Clone, Debug, PartialEq)]
pub enum RefusedValue {
    /// A number.
    Number(f64),
    /// The components of a vector, or of a matrix by columns.
    Numbers(Vec<f64>),
    /// Something else, in words.
    Text(&'static str),
}

impl Refusal {
    /// Creates the refusal of a value without a unit.
    pub fn new(
        parameter: &'static str,
        value: impl Into<RefusedValue>,
        allowed: impl Into<Cow<'static, str>>,
    ) -> Self {
        Self {
            parameter,
            value: value.into(),
            index: None,
            unit: "",
            allowed: allowed.into(),
        }
    }

    /// Returns the refusal with the unit of the value.
    #[must_use]
    pub fn in_unit(self, unit: &'static str) -> Self {
        Self { unit, ..self }
    }

    /// Returns the refusal of the value at a position of a list.
    #[must_use]
    pub fn at(self, index: usize) -> Self {
        Self {
            index: Some(index),
            ..self
        }
    }

    /// Returns the refusal with another name of the argument, the one that the caller's own caller
    /// knows.
    #[must_use]
    pub fn named(self, parameter: &'static str) -> Self {
        Self { parameter, ..self }
    }

    /// Returns the name of the refused argument.
    pub const fn parameter(&self) -> &'static str {
        self.parameter
    }
}

impl fmt::Display for Refusal {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self {
            parameter,
            value,
            unit,
            allowed,
            ..
        } = self;
        write!(f, "{parameter} must be {allowed}, got {value}")?;
        if !unit.is_empty() {
            write!(f, " {unit}")?;
        }
        self.index
            .map_or(Ok(()), |index| write!(f, " at index {index}"))
    }
}

impl error::Error for Refusal {}

impl fmt::Display for RefusedValue {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Number(number) => Shown(*number).fmt(f),
            Self::Numbers(numbers) => {
                let shown: Vec<String> = numbers.iter().map(|x| Shown(*x).to_string()).collect();
                write!(f, "[{}]", shown.join(", "))
            }
            Self::Text(text) => f.write_str(text),
        }
    }
}

impl From<f64> for RefusedValue {
    fn from(number: f64) -> Self {
        Self::Number(number)
    }
}

impl From<usize> for RefusedValue {
    fn from(count: usize) -> Self {
        Self::Number(count as f64)
    }
}

impl<const N: usize> From<[f64; N]> for RefusedValue {
    fn from(numbers: [f64; N]) -> Self {
        Self::Numbers(numbers.to_vec())
    }
}

impl From<&'static str> for RefusedValue {
    fn from(text: &'static str) -> Self {
        Self::Text(text)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn messages_say_what_is_allowed_and_what_was_given() {
        let vector = Refusal::new("axis", [1e30, 0.0, f64::NAN], "finite").in_unit("m");
        assert_eq!(
            vector.to_string(),
            "axis must be finite, got [1e30, 0, NaN] m"
        );
        let entry = Refusal::new("powers", -0.5, "not negative")
            .at(3)
            .named("weights");
        assert_eq!(
            entry.to_string(),
            "weights must be not negative, got -0.5 at index 3"
        );
        let count = Refusal::new("peaks", 300_usize, format!("from 1 to {}", 256));
        assert_eq!(count.to_string(), "peaks must be from 1 to 256, got 300");
        let text = Refusal::new("profile", "a table", "a law");
        assert_eq!(text.to_string(), "profile must be a law, got a table");
    }
}
