//! Measured quantities beside what theory says of them.

use std::io::{self, Write};

use serde::Serialize;

/// What theory says of a quantity.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
#[serde(untagged)]
pub(crate) enum Expectation {
    /// It differs from `value` by at most `tolerance`.
    Near {
        /// The value of the theory.
        value: f64,
        /// The largest difference that chance and rounding explain.
        tolerance: f64,
    },
    /// It is at least this.
    AtLeast {
        /// The bound.
        at_least: f64,
    },
    /// It is at most this.
    AtMost {
        /// The bound.
        at_most: f64,
    },
    /// Nothing.
    Open,
}

impl Expectation {
    /// Returns in words whether a measured value is what theory says, if it says anything.
    fn verdict(self, measured: f64) -> Option<String> {
        let agrees = match self {
            Self::Near { value, tolerance } => (measured - value).abs() <= tolerance,
            Self::AtLeast { at_least } => measured >= at_least,
            Self::AtMost { at_most } => measured <= at_most,
            Self::Open => return None,
        };
        Some(match self {
            _ if agrees => "agrees".into(),
            Self::Near { value, .. } => {
                let side = if measured < value { "low" } else { "high" };
                format!("{side} by {}", rounded((measured - value).abs(), 2))
            }
            Self::AtLeast { .. } => "too low".into(),
            _ => "too high".into(),
        })
    }
}

/// One line of the table.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub(crate) struct Row {
    /// What was measured, with the unit.
    pub(crate) quantity: String,
    /// The measured value.
    pub(crate) measured: f64,
    /// What theory says of it.
    pub(crate) theory: Expectation,
    /// Whether that agrees, in words.
    pub(crate) verdict: Option<String>,
}

impl Row {
    pub(crate) fn new(quantity: impl Into<String>, measured: f64, theory: Expectation) -> Self {
        Self {
            quantity: quantity.into(),
            measured,
            theory,
            verdict: theory.verdict(measured),
        }
    }

    fn cells(&self) -> [String; 5] {
        let (theory, tolerance) = match self.theory {
            Expectation::Near { value, tolerance } => {
                (number(value), format!("± {}", number(tolerance)))
            }
            Expectation::AtLeast { at_least: bound } => {
                (format!("≥ {}", number(bound)), "-".into())
            }
            Expectation::AtMost { at_most: bound } => (format!("≤ {}", number(bound)), "-".into()),
            Expectation::Open => ("-".into(), "-".into()),
        };
        [
            self.quantity.clone(),
            number(self.measured),
            theory,
            tolerance,
            self.verdict.clone().unwrap_or_else(|| "-".into()),
        ]
    }
}

/// Writes the rows as columns, two spaces apart, under a line of headings.
pub(crate) fn write_table(rows: &[Row], out: &mut impl Write) -> io::Result<()> {
    let headings = ["quantity", "measured", "theory", "tolerance", "verdict"].map(String::from);
    let rows = rows.iter().map(|row| row.cells().to_vec());
    let lines: Vec<_> = core::iter::once(headings.to_vec()).chain(rows).collect();
    write_columns(&lines, out)
}

/// Writes lines of as many cells each as columns, two spaces apart.
pub(crate) fn write_columns(lines: &[Vec<String>], out: &mut impl Write) -> io::Result<()> {
    let columns = lines.iter().map(Vec::len).max().unwrap_or(0);
    let width = |column: usize| {
        let cells = lines.iter().filter_map(|line| line.get(column));
        cells.map(|cell| cell.chars().count()).max().unwrap_or(0)
    };
    let widths: Vec<_> = (0..columns).map(width).collect();
    for line in lines {
        let padded: Vec<_> = line
            .iter()
            .zip(&widths)
            .map(|(cell, &width)| format!("{cell:width$}"))
            .collect();
        writeln!(out, "{}", padded.join("  ").trim_end())?;
    }
    Ok(())
}

/// Writes a number with five significant digits, without an exponent where that is readable.
pub(crate) fn number(value: f64) -> String {
    rounded(value, 5)
}

/// Writes a number with so many significant digits, without an exponent where that is readable.
pub(crate) fn rounded(value: f64, digits: u8) -> String {
    let magnitude = value.abs();
    let text = if magnitude == 0.0 {
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
        ] {
            assert_eq!(number(value), expected);
        }
    }

    #[test]
    fn theory_is_null_where_there_is_none() {
        let json = |theory| serde_json::to_string(&theory).expect("numbers are JSON");
        assert_eq!(json(Expectation::Open), "null");
        assert_eq!(
            json(Expectation::AtMost { at_most: 0.5 }),
            r#"{"at_most":0.5}"#
        );
    }

    #[test]
    fn verdicts_say_on_which_side_a_value_lies() {
        let near = Expectation::Near {
            value: 2.0,
            tolerance: 0.1,
        };
        let least = Expectation::AtLeast { at_least: 1e-3 };
        let most = Expectation::AtMost { at_most: 1e-3 };
        for (theory, measured, expected) in [
            (near, 2.09, Some("agrees")),
            (near, 2.25, Some("high by 0.25")),
            (near, 1.666, Some("low by 0.33")),
            (least, 1e-3, Some("agrees")),
            (least, 1e-9, Some("too low")),
            (most, 0.2, Some("too high")),
            (Expectation::Open, 0.2, None),
        ] {
            let row = Row::new("quantity", measured, theory);
            assert_eq!(row.verdict.as_deref(), expected, "{measured} of {theory:?}");
        }
    }

    #[test]
    fn columns_line_up() {
        let rows = [
            Row::new(
                "mean",
                1.0,
                Expectation::Near {
                    value: 1.0,
                    tolerance: 1e-5,
                },
            ),
            Row::new("speckle size", 4.05, Expectation::Open),
            Row::new("p-value", 0.37, Expectation::AtLeast { at_least: 0.001 }),
            Row::new("beyond", 0.0, Expectation::AtMost { at_most: 0.01 }),
            Row::new(
                "contrast",
                0.79,
                Expectation::Near {
                    value: 1.0,
                    tolerance: 0.05,
                },
            ),
        ];
        let mut out = Vec::new();
        write_table(&rows, &mut out).expect("memory can be written");
        let expected = "\
quantity      measured  theory   tolerance  verdict
mean          1         1        ± 1.00e-5  agrees
speckle size  4.05      -        -          -
p-value       0.37      ≥ 0.001  -          agrees
beyond        0         ≤ 0.01   -          agrees
contrast      0.79      1        ± 0.05     low by 0.21
";
        assert_eq!(String::from_utf8_lossy(&out), expected);
    }
}
