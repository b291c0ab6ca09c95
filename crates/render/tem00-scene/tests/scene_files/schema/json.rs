//! As much of JSON Schema, draft 2020-12, as the schema of scene files uses.

use regex::Regex;
use serde_json::{Map, Value};
use toml::de::{DeTable, DeValue};

/// Checks a value by a schema, whose definitions are those of `root`.
pub(super) fn check(root: &Value, schema: &Value, value: &Value) -> Result<(), String> {
    let mut words = schema.as_object().unwrap().iter();
    words.try_for_each(|(word, limit)| {
        if fits(root, schema, (word, limit), value)? {
            Ok(())
        } else {
            Err(format!("{value} is against {word}: {limit}"))
        }
    })
}

fn fits(
    root: &Value,
    schema: &Value,
    (word, limit): (&str, &Value),
    value: &Value,
) -> Result<bool, String> {
    let is = |schema: &Value| check(root, schema, value).is_ok();
    let listed = || limit.as_array().unwrap().iter();
    let bound = |fits: fn(&f64, &f64) -> bool, number: Option<f64>| {
        number.is_none_or(|number| fits(&number, &limit.as_f64().unwrap()))
    };
    let number = value.as_f64();
    let length = value.as_array().map(|items| items.len() as f64);
    let mut items = value.as_array().into_iter().flatten();
    let mut entries = value.as_object().into_iter().flatten();
    Ok(match word {
        "$ref" => {
            let place = limit.as_str().unwrap().trim_start_matches('#');
            return check(root, root.pointer(place).unwrap(), value).map(|()| true);
        }
        "type" => match limit.as_str().unwrap() {
            "object" => value.is_object(),
            "array" => value.is_array(),
            "string" => value.is_string(),
            "boolean" => value.is_boolean(),
            "number" => value.is_number(),
            "integer" => number.is_some_and(|number| number.fract() == 0.0),
            other => panic!("{other} is no type"),
        },
        "enum" => listed().any(|allowed| allowed == value),
        "minimum" => bound(f64::ge, number),
        "maximum" => bound(f64::le, number),
        "exclusiveMinimum" => bound(f64::gt, number),
        "minItems" => bound(f64::ge, length),
        "maxItems" => bound(f64::le, length),
        "pattern" => {
            let pattern = Regex::new(limit.as_str().unwrap()).unwrap();
            value.as_str().is_none_or(|text| pattern.is_match(text))
        }
        "required" => {
            !value.is_object() || listed().all(|key| value.get(key.as_str().unwrap()).is_some())
        }
        "items" => {
            items.try_for_each(|item| check(root, limit, item))?;
            true
        }
        "properties" => {
            let mut known = entries.filter_map(|(key, value)| Some((limit.get(key)?, value)));
            known.try_for_each(|(schema, value)| check(root, schema, value))?;
            true
        }
        "additionalProperties" => entries.all(|(key, _)| schema["properties"].get(key).is_some()),
        "allOf" => listed().all(is),
        "anyOf" => listed().any(is),
        "oneOf" => listed().filter(|schema| is(schema)).count() == 1,
        "not" => !is(limit),
        "$defs" | "$schema" | "default" | "description" | "title" => true,
        other => panic!("{other} is not checked"),
    })
}

/// Shows every object within a JSON value.
pub(super) fn each_object(value: &Value, show: &mut impl FnMut(&Map<String, Value>)) {
    match value {
        Value::Object(map) => {
            show(map);
            map.values().for_each(|value| each_object(value, show));
        }
        Value::Array(items) => items.iter().for_each(|item| each_object(item, show)),
        _ => {}
    }
}

/// Turns a TOML document into JSON, as editors do.
pub(super) fn from_toml(text: &str) -> Value {
    from_table(DeTable::parse(text).unwrap().get_ref())
}

fn from_table(table: &DeTable<'_>) -> Value {
    let entries = table.iter();
    let entries = entries.map(|(key, value)| (key.get_ref().to_string(), from(value.get_ref())));
    Value::Object(entries.collect())
}

fn from(value: &DeValue<'_>) -> Value {
    match value {
        DeValue::String(text) => Value::from(text.as_ref()),
        DeValue::Integer(integer) => {
            let number = i128::from_str_radix(integer.as_str(), integer.radix());
            let number = number.unwrap_or(i128::MAX);
            i64::try_from(number).map_or_else(|_| Value::from(number as f64), Value::from)
        }
        DeValue::Float(float) => float
            .as_str()
            .parse::<f64>()
            .map_or(Value::Null, Value::from),
        DeValue::Boolean(boolean) => Value::from(*boolean),
        DeValue::Datetime(datetime) => Value::from(datetime.to_string()),
        DeValue::Array(items) => items.iter().map(|item| from(item.get_ref())).collect(),
        DeValue::Table(table) => from_table(table),
    }
}
