//! Measured quantities compared with the predictions of the theory.

use serde::Serialize;
use tem00_report::{
    digits::{number, rounded},
    report::{Cell, Column, Table},
};

/// The verdict on a value that the theory predicts.
const AGREES: &str = "agrees";

/// The prediction of the theory for a quantity.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
#[serde(untagged)]
pub(crate) enum Expectation {
    /// Value within `tolerance` of `value`.
    Near {
        /// The value of the theory.
        value: f64,
        /// The largest difference that chance and rounding explain.
        tolerance: f64,
    },
    /// Lower bound.
    AtLeast {
        /// The bound.
        at_least: f64,
    },
    /// Upper bound.
    AtMost {
        /// The bound.
        at_most: f64,
    },
    /// Nothing.
    Open,
}

impl Expectation {
    pub(crate) const fn near(value: f64, tolerance: f64) -> Self {
        Self::Near { value, tolerance }
    }

    pub(crate) const fn at_least(at_least: f64) -> Self {
        Self::AtLeast { at_least }
    }

    pub(crate) const fn at_most(at_most: f64) -> Self {
        Self::AtMost { at_most }
    }

    /// Returns in words whether a measured value agrees with the theory; `None` without a
    /// prediction.
    fn verdict(self, measured: f64) -> Option<String> {
        let agrees = match self {
            Self::Near { value, tolerance } => (measured - value).abs() <= tolerance,
            Self::AtLeast { at_least } => measured >= at_least,
            Self::AtMost { at_most } => measured <= at_most,
            Self::Open => return None,
        };
        Some(match self {
            _ if agrees => AGREES.into(),
            Self::Near { value, .. } => {
                let side = if measured < value { "low" } else { "high" };
                format!("{side} by {}", rounded((measured - value).abs(), 2))
            }
            Self::AtLeast { .. } => "too low".into(),
            _ => "too high".into(),
        })
    }
}

/// Row of the table.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Row {
    /// The name of the quantity, with the unit.
    pub(crate) quantity: String,
    /// The measured value.
    pub(crate) measured: f64,
    /// The prediction of the theory.
    pub(crate) theory: Expectation,
    /// The agreement, in words.
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

    /// Returns whether the measured value agrees with the theory.
    pub(crate) fn agrees(&self) -> bool {
        self.verdict.as_deref() == Some(AGREES)
    }

    fn cells(&self) -> [Cell; 5] {
        let theory = |text: String| Cell::new(self.theory, text);
        let (theory, tolerance) = match self.theory {
            Expectation::Near { value, tolerance } => {
                (theory(number(value)), format!("± {}", number(tolerance)))
            }
            Expectation::AtLeast { at_least: bound } => {
                (theory(format!("≥ {}", number(bound))), "-".into())
            }
            Expectation::AtMost { at_most: bound } => {
                (theory(format!("≤ {}", number(bound))), "-".into())
            }
            Expectation::Open => (Cell::missing("-"), "-".into()),
        };
        [
            self.quantity.as_str().into(),
            self.measured.into(),
            theory,
            tolerance.into(),
            Cell::or_dash(self.verdict.as_deref()),
        ]
    }
}

/// Returns the rows as a table.
pub(crate) fn table(rows: &[Row]) -> Table {
    let columns = [
        Column::new("quantity", "quantity"),
        Column::new("measured", "measured"),
        Column::new("theory", "theory"),
        Column::shown("tolerance"),
        Column::new("verdict", "verdict"),
    ];
    let mut table = Table::new("Measured values and theory", columns).under("rows");
    rows.iter().for_each(|row| table.row(row.cells()));
    table
}

/// Returns the conclusion from all rows, in one sentence.
pub(crate) fn conclusion(rows: &[Row]) -> String {
    let compared = rows
        .iter()
        .filter_map(|row| Some((row, row.verdict.as_deref()?)));
    let (agree, others): (Vec<_>, Vec<_>) = compared.partition(|(row, _)| row.agrees());
    let all = agree.len() + others.len();
    let said = |(row, verdict): &(&Row, &str)| format!("{}, {verdict}", row.quantity);
    match (all, &*others) {
        (0, _) => "No value is compared with theory.".to_owned(),
        (1, []) => "The only compared value agrees with theory.".to_owned(),
        (_, []) => format!("All {all} compared values agree with theory."),
        (_, others) => format!(
            "{} of {all} compared values disagree with theory: {}.",
            others.len(),
            others.iter().map(said).collect::<Vec<_>>().join("; ")
        ),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_rows_come_to_one_sentence() {
        let near = |name: &str, measured| Row::new(name, measured, Expectation::near(1.0, 0.05));
        let open = Row::new("mean", 3.0, Expectation::Open);
        for (rows, expected) in [
            (vec![open.clone()], "No value is compared with theory."),
            (
                vec![near("contrast", 1.01), open.clone(), near("size", 0.99)],
                "All 2 compared values agree with theory.",
            ),
            (
                vec![
                    near("contrast", 0.79),
                    open,
                    near("size", 1.2),
                    near("p", 1.0),
                ],
                "2 of 3 compared values disagree with theory: contrast, low by 0.21; size, high by \
                 0.2.",
            ),
        ] {
            assert_eq!(conclusion(&rows), expected);
        }
    }

    #[test]
    fn theory_is_null_where_there_is_none() {
        let json = |theory| serde_json::to_string(&theory).expect("numbers are JSON");
        assert_eq!(json(Expectation::Open), "null");
        assert_eq!(json(Expectation::at_most(0.5)), r#"{"at_most":0.5}"#);
    }

    #[test]
    fn verdicts_say_on_which_side_a_value_lies() {
        let near = Expectation::near(2.0, 0.1);
        let min = Expectation::at_least(1e-3);
        let max = Expectation::at_most(1e-3);
        for (theory, measured, expected) in [
            (near, 2.09, Some("agrees")),
            (near, 2.25, Some("high by 0.25")),
            (near, 1.666, Some("low by 0.33")),
            (min, 1e-3, Some("agrees")),
            (min, 1e-9, Some("too low")),
            (max, 0.2, Some("too high")),
            (Expectation::Open, 0.2, None),
        ] {
            let row = Row::new("quantity", measured, theory);
            assert_eq!(row.verdict.as_deref(), expected, "{measured} of {theory:?}");
        }
    }
}
