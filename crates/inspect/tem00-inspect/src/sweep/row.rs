//! The row of a task: its inputs and its outcome.

use std::path::Path;

use serde::{Deserialize, Serialize};
use serde_json::Value;
use tem00_config::{MAX_TEXT_BYTES, printable, read_input};
use tem00_report::{failure::Failure, output};

/// The outcome of a task.
#[derive(Clone, Copy, Debug, Deserialize, PartialEq, Eq, Serialize)]
#[serde(rename_all = "snake_case")]
pub(super) enum Outcome {
    /// The command ended well.
    Done,
    /// The command measured nothing.
    NothingMeasured,
    /// The command refused the values.
    Refused,
}

impl Outcome {
    pub(super) const fn name(self) -> &'static str {
        match self {
            Self::Done => "done",
            Self::NothingMeasured => "nothing measured",
            Self::Refused => "refused",
        }
    }
}

/// The row of a task.
#[derive(Clone, Debug, Deserialize, PartialEq, Serialize)]
pub(super) struct TaskRow {
    pub(super) task: usize,
    /// Distinguishes the inputs of tasks.
    pub(super) fingerprint: String,
    pub(super) outcome: Outcome,
    /// The reason why there is no result.
    pub(super) reason: Option<String>,
    /// The results, null where there is none.
    pub(super) results: Vec<Value>,
}

impl TaskRow {
    /// Reads the row of a task, if there is one of the same inputs.
    pub(super) fn find(path: &Path, fingerprint: &str) -> Option<Self> {
        let text = read_input(path, MAX_TEXT_BYTES).ok()?;
        let row: Self = serde_json::from_slice(&text).ok()?;
        (row.fingerprint == fingerprint).then_some(row)
    }

    /// Writes the row, completely or not at all.
    pub(super) fn write(&self, path: &Path) -> Result<(), Failure> {
        output::save(path, |file| {
            serde_json::to_writer(file, self).map_err(std::io::Error::from)
        })
    }
}

/// Returns the value at a path of keys and indices with dots between: `frames.0.samples`.
///
/// # Errors
///
/// Returns the keys that exist where one is missing.
pub(super) fn result_at<'a>(record: &'a Value, path: &str) -> Result<&'a Value, String> {
    path.split('.').try_fold(record, |value, step| {
        let next = match value {
            Value::Null => Some(value),
            Value::Array(values) => step.parse().ok().and_then(|index: usize| values.get(index)),
            _ => value.get(step),
        };
        next.ok_or_else(|| match value {
            Value::Object(keys) => keys.keys().cloned().collect::<Vec<_>>().join(", "),
            Value::Array(values) => format!("indices below {}", values.len()),
            _ => "no keys".to_owned(),
        })
    })
}

/// Returns a value as a cell of a table of comma-separated values; null is empty.
pub(super) fn cell(value: &Value) -> String {
    match value {
        Value::Null => String::new(),
        Value::String(text) => quoted(text),
        other => quoted(&other.to_string()),
    }
}

/// Returns text as a cell, in quotation marks where it needs them, that controls neither a terminal
/// nor, by an apostrophe in front of a formula, a spreadsheet.
pub(super) fn quoted(text: &str) -> String {
    let shown = printable(text);
    let apostrophe = if is_formula(&shown) { "'" } else { "" };
    if shown.contains([',', '"', '\n']) {
        format!("\"{apostrophe}{}\"", shown.replace('"', "\"\""))
    } else {
        format!("{apostrophe}{shown}")
    }
}

/// Returns whether a spreadsheet would calculate a cell: `=1+1`, but not a number with or without a
/// unit.
fn is_formula(text: &str) -> bool {
    let number = text.trim_end_matches(|c: char| c.is_alphabetic() || " °%".contains(c));
    let is_number = |text: &str| text.parse::<f64>().is_ok();
    text.starts_with(['=', '+', '-', '@', '\t']) && !is_number(text) && !is_number(number)
}

#[cfg(test)]
mod tests {
    use serde_json::json;

    use super::*;

    #[test]
    fn results_are_found_by_keys_and_indices() {
        let record = json!({"a": [{"b": 1.5}, null], "c": null});
        assert_eq!(result_at(&record, "a.0.b"), Ok(&json!(1.5)));
        assert_eq!(result_at(&record, "a.1.b"), Ok(&Value::Null), "of nothing");
        assert_eq!(result_at(&record, "c.d.e"), Ok(&Value::Null), "of nothing");
        assert_eq!(result_at(&record, "x"), Err("a, c".to_owned()));
        assert_eq!(result_at(&record, "a.2"), Err("indices below 2".to_owned()));
        assert_eq!(result_at(&record, "a.0.b.c"), Err("no keys".to_owned()));
    }

    #[test]
    fn cells_are_quoted_where_they_must_be() {
        for (value, expected) in [
            (json!(0.1), "0.1"),
            (json!(null), ""),
            (json!("a b"), "a b"),
            (json!("a, \"b\""), "\"a, \"\"b\"\"\""),
            (json!([1, 2]), "\"[1,2]\""),
            (json!("=1+1"), "'=1+1"),
            (json!("@a,b"), "\"'@a,b\""),
            (json!("-2+cmd|' /C calc'!A0"), "'-2+cmd|' /C calc'!A0"),
            (json!("\t=1"), "'\t=1"),
            (json!("-8 mm"), "-8 mm"),
            (json!("+1.5e-3"), "+1.5e-3"),
            (json!(-3), "-3"),
            (json!("\u{1b}]0;a\u{7}"), "\\u001b]0;a\\u0007"),
            (json!("a\rb"), "a\\u000db"),
            (json!("\u{202e}a"), "\\u202ea"),
        ] {
            assert_eq!(cell(&value), expected);
        }
    }
}
