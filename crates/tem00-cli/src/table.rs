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

/// One line of the table.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub(crate) struct Row {
    /// What was measured, with the unit.
    pub(crate) quantity: String,
    /// The measured value.
    pub(crate) measured: f64,
    /// What theory says of it.
    pub(crate) theory: Expectation,
}

impl Row {
    pub(crate) fn new(quantity: impl Into<String>, measured: f64, theory: Expectation) -> Self {
        Self {
            quantity: quantity.into(),
            measured,
            theory,
        }
    }

    fn cells(&self) -> [String; 4] {
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
        ]
    }
}

/// Writes the rows as columns, two spaces apart, under a line of headings.
pub(crate) fn write_table(rows: &[Row], out: &mut impl Write) -> io::Result<()> {
    let headings = ["quantity", "measured", "theory", "tolerance"].map(String::from);
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
        ];
        let mut out = Vec::new();
        write_table(&rows, &mut out).expect("memory can be written");
        let expected = "\
quantity      measured  theory   tolerance
mean          1         1        ± 1.00e-5
speckle size  4.05      -        -
p-value       0.37      ≥ 0.001  -
beyond        0         ≤ 0.01   -
";
        assert_eq!(String::from_utf8_lossy(&out), expected);
    }
}
