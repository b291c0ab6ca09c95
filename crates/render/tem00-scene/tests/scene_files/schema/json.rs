//! As much of JSON Schema, draft 2020-12, as the schema of scene files uses.

use std::collections::{BTreeMap, BTreeSet};

use regex::Regex;
use serde_json::{Map, Value};
use toml::de::{DeTable, DeValue};

/// The words that constrain a value.
const CONSTRAINTS: &[&str] = &[
    "$ref",
    "additionalProperties",
    "allOf",
    "anyOf",
    "enum",
    "exclusiveMinimum",
    "items",
    "maxItems",
    "maximum",
    "minItems",
    "minimum",
    "not",
    "oneOf",
    "pattern",
    "properties",
    "required",
    "type",
];
/// The words that do not.
const ANNOTATIONS: &[&str] = &["$defs", "$schema", "default", "description", "title"];

pub(super) struct Schema {
    root: Value,
}

type Verdict = Result<(), String>;

impl Schema {
    pub(super) fn new(root: Value) -> Self {
        Self { root }
    }

    pub(super) fn text(&self) -> String {
        self.root.to_string()
    }

    /// Returns the keys of every table by the name of its definition; the root has none.
    pub(super) fn tables(&self) -> BTreeMap<&str, BTreeSet<String>> {
        let keys = |schema: &Value| -> Option<BTreeSet<String>> {
            let properties = schema.get("properties")?.as_object()?;
            assert_eq!(schema["additionalProperties"], false, "{schema} is open");
            Some(properties.keys().cloned().collect())
        };
        let definitions = self.root["$defs"].as_object().unwrap();
        let named = definitions
            .iter()
            .map(|(name, schema)| (name.as_str(), schema));
        std::iter::once(("", &self.root))
            .chain(named)
            .filter_map(|(name, schema)| Some((name, keys(schema)?)))
            .collect()
    }

    /// Returns the words that the check would pass over.
    pub(super) fn unknown_words(&self) -> BTreeSet<String> {
        let mut unknown = BTreeSet::new();
        self.visit(&mut |schema| {
            let words = schema.keys().filter(|word| {
                !CONSTRAINTS.contains(&word.as_str()) && !ANNOTATIONS.contains(&word.as_str())
            });
            unknown.extend(words.cloned());
        });
        unknown
    }

    /// Returns the defaults that are not allowed where they stand.
    pub(super) fn broken_defaults(&self) -> Vec<Value> {
        let mut broken = Vec::new();
        self.visit(&mut |schema| {
            if let Some(default) = schema.get("default")
                && self.of(&Value::Object(schema.clone()), default).is_err()
            {
                broken.push(default.clone());
            }
        });
        broken
    }

    /// Shows every schema within this one.
    fn visit(&self, show: &mut impl FnMut(&Map<String, Value>)) {
        fn within(schema: &Value, show: &mut impl FnMut(&Map<String, Value>)) {
            let Some(map) = schema.as_object() else {
                return;
            };
            show(map);
            for (word, value) in map {
                match word.as_str() {
                    "properties" | "$defs" => {
                        let schemas = value.as_object().into_iter().flatten();
                        schemas.for_each(|(_, schema)| within(schema, show));
                    }
                    "allOf" | "anyOf" | "oneOf" => {
                        let schemas = value.as_array().into_iter().flatten();
                        schemas.for_each(|schema| within(schema, show));
                    }
                    "items" | "not" => within(value, show),
                    _ => {}
                }
            }
        }
        within(&self.root, show);
    }

    /// Checks a document.
    pub(super) fn check(&self, value: &Value) -> Verdict {
        self.of(&self.root, value)
    }

    fn of(&self, schema: &Value, value: &Value) -> Verdict {
        let Some(words) = schema.as_object() else {
            return Err(format!("{schema} is no schema"));
        };
        words
            .iter()
            .try_for_each(|(word, limit)| self.word(word, limit, schema, value))
    }

    fn word(&self, word: &str, limit: &Value, schema: &Value, value: &Value) -> Verdict {
        let all = |schemas: &Value| -> usize {
            let schemas = schemas.as_array().unwrap().iter();
            schemas
                .filter(|schema| self.of(schema, value).is_ok())
                .count()
        };
        let number = value.as_f64();
        let length = value.as_array().map(Vec::len);
        let bound = || limit.as_f64().unwrap();
        let fine = match word {
            "$ref" => return self.of(self.definition(limit), value),
            "type" => has_type(limit.as_str().unwrap(), value),
            "enum" => limit.as_array().unwrap().contains(value),
            "minimum" => number.is_none_or(|number| number >= bound()),
            "maximum" => number.is_none_or(|number| number <= bound()),
            "exclusiveMinimum" => number.is_none_or(|number| number > bound()),
            "minItems" => length.is_none_or(|length| length as f64 >= bound()),
            "maxItems" => length.is_none_or(|length| length as f64 <= bound()),
            "pattern" => value.as_str().is_none_or(|text| matches(limit, text)),
            "required" => value.as_object().is_none_or(|table| {
                let keys = limit.as_array().unwrap().iter();
                keys.clone()
                    .all(|key| table.contains_key(key.as_str().unwrap()))
            }),
            "items" => return self.items(limit, value),
            "properties" => return self.properties(limit, value),
            "additionalProperties" => return closed(&schema["properties"], value),
            "allOf" => all(limit) == limit.as_array().unwrap().len(),
            "anyOf" => all(limit) > 0,
            "oneOf" => all(limit) == 1,
            "not" => self.of(limit, value).is_err(),
            _ => true,
        };
        if fine {
            Ok(())
        } else {
            Err(format!("{value} is against {word}: {limit}"))
        }
    }

    fn definition(&self, reference: &Value) -> &Value {
        let pointer = reference.as_str().unwrap().trim_start_matches('#');
        let found = self.root.pointer(pointer);
        found.unwrap_or_else(|| panic!("{reference} leads nowhere"))
    }

    fn items(&self, schema: &Value, value: &Value) -> Verdict {
        let items = value.as_array().into_iter().flatten();
        items.into_iter().try_for_each(|item| self.of(schema, item))
    }

    fn properties(&self, schemas: &Value, value: &Value) -> Verdict {
        let properties = value.as_object().into_iter().flatten();
        properties
            .into_iter()
            .try_for_each(|(key, value)| match schemas.get(key) {
                Some(schema) => self
                    .of(schema, value)
                    .map_err(|why| format!("{key}: {why}")),
                None => Ok(()),
            })
    }
}

fn closed(properties: &Value, value: &Value) -> Verdict {
    let mut keys = value.as_object().into_iter().flatten().map(|(key, _)| key);
    match keys.find(|key| properties.get(key).is_none()) {
        Some(key) => Err(format!("{key} is not among the keys")),
        None => Ok(()),
    }
}

fn has_type(name: &str, value: &Value) -> bool {
    match name {
        "object" => value.is_object(),
        "array" => value.is_array(),
        "string" => value.is_string(),
        "boolean" => value.is_boolean(),
        "number" => value.is_number(),
        "integer" => value.as_f64().is_some_and(|number| number.fract() == 0.0),
        other => panic!("{other} is no type"),
    }
}

fn matches(pattern: &Value, text: &str) -> bool {
    Regex::new(pattern.as_str().unwrap())
        .unwrap()
        .is_match(text)
}

/// Turns a TOML document into JSON, as editors do.
pub(super) fn from_toml(table: &DeTable<'_>) -> Value {
    let entries = table.iter().map(|(key, value)| {
        let key = key.get_ref().to_string();
        (key, from_value(value.get_ref()))
    });
    Value::Object(entries.collect())
}

fn from_value(value: &DeValue<'_>) -> Value {
    match value {
        DeValue::String(text) => Value::from(text.as_ref()),
        DeValue::Integer(integer) => {
            let number =
                i128::from_str_radix(integer.as_str(), integer.radix()).unwrap_or(i128::MAX);
            u64::try_from(number).map_or_else(|_| Value::from(number as f64), Value::from)
        }
        DeValue::Float(float) => float
            .as_str()
            .parse::<f64>()
            .map_or(Value::Null, Value::from),
        DeValue::Boolean(boolean) => Value::from(*boolean),
        DeValue::Datetime(datetime) => Value::from(datetime.to_string()),
        DeValue::Array(items) => items
            .iter()
            .map(|item| from_value(item.get_ref()))
            .collect(),
        DeValue::Table(table) => from_toml(table),
    }
}
