//! The row of a task: what it was given, and what came of it.

use std::path::Path;

use serde::{Deserialize, Serialize};
use serde_json::Value;

use crate::{atomic::write_atomically, failure::Failure};

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
pub(super) struct Row {
    pub(super) task: usize,
    /// Distinguishes the inputs of tasks.
    pub(super) fingerprint: String,
    pub(super) outcome: Outcome,
    /// The reason why there is no result.
    pub(super) reason: Option<String>,
    /// The results, null where there is none.
    pub(super) results: Vec<Value>,
}

impl Row {
    /// Reads the row of a task, if there is one of the same inputs.
    pub(super) fn find(path: &Path, fingerprint: &str) -> Option<Self> {
        let text = std::fs::read_to_string(path).ok()?;
        let row: Self = serde_json::from_str(&text).ok()?;
        (row.fingerprint == fingerprint).then_some(row)
    }

    /// Writes the row, whole or not at all.
    pub(super) fn write(&self, path: &Path) -> Result<(), Failure> {
        write_atomically(path, |file| {
            serde_json::to_writer(file, self).map_err(std::io::Error::from)
        })
        .map_err(|error| Failure::writing(path, error))
    }
}

/// Returns the value at a path of keys and indices with dots between: `frames.0.samples`.
///
/// # Errors
///
/// Returns the keys that there are where one is missing.
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

/// Returns text as a cell, in quotation marks where it needs them.
pub(super) fn quoted(text: &str) -> String {
    if text.contains([',', '"', '\n', '\r']) {
        format!("\"{}\"", text.replace('"', "\"\""))
    } else {
        text.to_owned()
    }
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
        ] {
            assert_eq!(cell(&value), expected);
        }
    }
}
