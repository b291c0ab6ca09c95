use core::fmt::Display;
use std::path::PathBuf;

use toml::Spanned;
use toml::de::{DeTable, DeValue};

use crate::error::{Location, Problem};
use crate::format::Format;
use crate::source::Source;
use crate::value::{Value, nearest};

/// A table that a section may have: its key, and the keys that it may have itself.
pub type Choice = (&'static str, &'static [&'static str]);

/// Words for a key that are not spelled like it, each with the key.
const SYNONYMS: [(&str, &str); 3] = [
    ("lamp", "light"),
    ("line_width", "line_thickness"),
    ("roughness", "rms_height"),
];

/// Table of the file.
///
/// A section is opened with its allowed keys. Any other key is an error at once, before a missing
/// key is reported: a typo in a required key is both.
#[derive(Clone, Debug)]
pub struct Section<'a> {
    header: String,
    is_root: bool,
    keys: &'static [&'static str],
    uncertain: &'static [&'static str],
    table: &'a DeTable<'a>,
    location: Location,
    source: &'a Source,
}

/// The keys of an uncertain value, `{ value = "30 deg", uncertainty = "0.05 deg" }`.
pub const UNCERTAIN: &[&str] = &["value", "uncertainty", "distribution", "degrees_of_freedom"];

impl<'a> Section<'a> {
    /// Opens a document itself.
    pub(crate) fn root(
        document: &'a DeTable<'a>,
        source: &'a Source,
        format: &Format,
    ) -> Result<Self, Problem> {
        Self {
            header: format!("the {}", format.noun),
            is_root: true,
            keys: format.keys,
            uncertain: format.uncertain,
            table: document,
            location: source.location(0..0),
            source,
        }
        .checked(None)
    }

    /// Returns the value of a key, if the file gives one; for an uncertain value, the best
    /// estimate.
    pub fn optional(&self, key: &'static str) -> Option<Value<'a>> {
        debug_assert!(self.keys.contains(&key), "{key} is not declared");
        let item = self.best_estimate(key)?;
        Some(Value::new(key, item, self.source))
    }

    /// Returns the item of a key, or the `value` in the table of an uncertain one.
    fn best_estimate(&self, key: &str) -> Option<&'a Spanned<DeValue<'a>>> {
        let item = self.table.get(key)?;
        match item.get_ref() {
            DeValue::Table(table) if self.uncertain.contains(&key) => {
                Some(table.get("value").unwrap_or(item))
            }
            _ => Some(item),
        }
    }

    /// Opens the table of an uncertain value; `None` if the file has no such key, or a bare value.
    ///
    /// # Errors
    ///
    /// Returns a problem, placed in the file, if the table has a key that is not in [`UNCERTAIN`].
    pub fn uncertain(&self, key: &'static str) -> Result<Option<Self>, Problem> {
        match self.table.get(key).map(Spanned::get_ref) {
            Some(DeValue::Table(_)) => self.table(key, UNCERTAIN),
            _ => Ok(None),
        }
    }

    /// Returns the value of a required key; `example` shows a possible value.
    ///
    /// # Errors
    ///
    /// Returns a problem, placed at the section, if it is missing.
    pub fn required(&self, key: &'static str, example: &str) -> Result<Value<'a>, Problem> {
        self.optional(key).ok_or_else(|| {
            self.problem(format_args!("{} needs the key `{key}`", self.header))
                .with_help(format!("for example `{key} = {example}`"))
        })
    }

    /// Returns the result of `read` for the value of a key, or `default` without such a key.
    ///
    /// # Errors
    ///
    /// Returns the problems of `read`.
    pub fn or<T>(
        &self,
        key: &'static str,
        default: T,
        read: impl FnOnce(&Value<'a>) -> Result<T, Problem>,
    ) -> Result<T, Problem> {
        self.optional(key).map_or(Ok(default), |value| read(&value))
    }

    /// Opens the table of a key, if the file has one.
    ///
    /// # Errors
    ///
    /// Returns a problem, placed in the file, if the table is missing, has another form or has a
    /// key that is not allowed.
    pub fn table(
        &self,
        key: &'static str,
        keys: &'static [&'static str],
    ) -> Result<Option<Self>, Problem> {
        let Some(item) = self.table.get(key) else {
            return Ok(None);
        };
        let header = format!("[{}]", self.path_to(key));
        let value = Value::new(key, item, self.source);
        match item.get_ref() {
            DeValue::Table(table) => self.open(header, table, value.location(), keys).map(Some),
            _ => Err(value.must_be(format_args!("a table: write `{header}` and its keys below"))),
        }
    }

    /// Opens every table of a key of which the file may have several.
    ///
    /// # Errors
    ///
    /// Returns a problem, placed in the file, if a table is missing, has another form or has a key
    /// that is not allowed.
    pub fn tables(
        &self,
        key: &'static str,
        keys: &'static [&'static str],
    ) -> Result<Vec<Self>, Problem> {
        let Some(value) = self.optional(key) else {
            return Ok(Vec::new());
        };
        let header = format!("[[{}]]", self.path_to(key));
        let wrong = |value: &Value<'a>| {
            value.must_be(format_args!("written `{header}`, with its keys below"))
        };
        let Some(DeValue::Array(items)) = self.table.get(key).map(Spanned::get_ref) else {
            return Err(wrong(&value));
        };
        items
            .iter()
            .map(|item| match item.get_ref() {
                DeValue::Table(table) => self.open(
                    header.clone(),
                    table,
                    self.source.location(item.span()),
                    keys,
                ),
                _ => Err(wrong(&Value::new(key, item, self.source))),
            })
            .collect()
    }

    /// Opens the one table of `choices` that the file has, or returns `None` without any.
    ///
    /// # Errors
    ///
    /// Returns a problem, placed in the file, if the table is missing, has another form or has a
    /// key that is not allowed.
    pub fn at_most_one_of(
        &self,
        what: &str,
        choices: &[Choice],
    ) -> Result<Option<(&'static str, Self)>, Problem> {
        let mut given: Vec<_> = choices
            .iter()
            .filter_map(|&(key, keys)| Some((self.optional(key)?.location(), key, keys)))
            .collect();
        given.sort_by_key(|(location, ..)| location.span.start);
        match given.as_slice() {
            [] => Ok(None),
            [(_, key, keys)] => Ok(self.table(key, keys)?.map(|section| (*key, section))),
            [(_, first, _), (location, second, _), ..] => {
                let header = &self.header;
                let message =
                    format!("{header} must have one {what}, got `{first}` and `{second}`");
                Err(Problem::new(message)
                    .at(location.clone())
                    .with_help(format!("start another {header} for the second")))
            }
        }
    }

    /// Opens the one table of `choices` that the file has.
    ///
    /// # Errors
    ///
    /// Returns a problem, placed in the file, if the table is missing, has another form or has a
    /// key that is not allowed.
    pub fn one_of(&self, what: &str, choices: &[Choice]) -> Result<(&'static str, Self), Problem> {
        self.at_most_one_of(what, choices)?.ok_or_else(|| {
            let headers = choices
                .iter()
                .map(|(key, _)| format!("[{}]", self.path_to(key)));
            let headers: Vec<String> = headers.collect();
            let (header, headers) = (&self.header, headers.join(" or "));
            self.problem(format_args!("{header} needs a {what}: {headers}"))
        })
    }

    /// Returns the text of the file that the section stands in.
    pub(crate) fn text(&self) -> &'a str {
        self.source.text()
    }

    /// Returns the path of a file that the section names.
    pub fn beside(&self, name: &str) -> PathBuf {
        self.source.beside(name)
    }

    /// Names the location of a key as compilers do.
    pub(crate) fn describe(&self, key: &'static str) -> String {
        let location = self
            .optional(key)
            .map_or(self.location.clone(), |value| value.location());
        self.source.describe(&location)
    }

    /// Returns whether the file gives the key.
    pub fn has(&self, key: &str) -> bool {
        self.table.contains_key(key)
    }

    /// Returns a problem placed at the header of the section.
    pub fn problem(&self, message: impl Display) -> Problem {
        Problem::new(message.to_string()).at(self.location.clone())
    }

    /// Returns a problem that was found when an object was made from the section. It is placed at
    /// the value of `key`, and stated in the unit of that value, if the file gives one.
    pub fn problem_with(&self, key: &str, message: impl Display) -> Problem {
        match self.best_estimate(key) {
            Some(item) => Value::new(key, item, self.source).problem(message),
            None => self.problem(message),
        }
    }

    fn open(
        &self,
        header: String,
        table: &'a DeTable<'a>,
        location: Location,
        keys: &'static [&'static str],
    ) -> Result<Self, Problem> {
        Self {
            header,
            is_root: false,
            keys,
            uncertain: self.uncertain,
            table,
            location,
            source: self.source,
        }
        .checked(Some(self))
    }

    /// The path of a key of this section, as in "laser.spot".
    fn path_to(&self, key: &str) -> String {
        if self.is_root {
            return key.to_owned();
        }
        format!("{}.{key}", self.header.trim_matches(['[', ']']))
    }

    /// Returns the section, or a problem at its first key that is not allowed.
    fn checked(self, parent: Option<&Self>) -> Result<Self, Problem> {
        let mut unknown: Vec<_> = self.table.keys().collect();
        unknown.retain(|key| !self.keys.contains(&key.get_ref().as_ref()));
        unknown.sort_by_key(|key| key.span().start);
        let Some((first, others)) = unknown.split_first() else {
            return Ok(self);
        };
        let location = self.source.location(first.span());
        let (message, mut help) = self.unknown(first.get_ref(), parent);
        if !others.is_empty() {
            let others: Vec<_> = others
                .iter()
                .map(|key| format!("`{}`", key.get_ref()))
                .collect();
            help += &format!("; also unknown: {}", others.join(", "));
        }
        Err(Problem::new(message).at(location).with_help(help))
    }

    /// Returns the message and the help for an unknown key.
    fn unknown(&self, key: &str, parent: Option<&Self>) -> (String, String) {
        let header = &self.header;
        let mut synonyms = SYNONYMS.iter().filter(|(word, _)| *word == key);
        let synonym = synonyms.find_map(|(_, meant)| self.keys.contains(meant).then_some(*meant));
        let hint = match synonym.or_else(|| nearest(key, self.keys)) {
            Some(meant) => format!("; did you mean `{meant}`?"),
            None => String::new(),
        };
        let help = match parent {
            Some(parent) if parent.keys.contains(&key) && !parent.is_root => format!(
                "`{key}` belongs to {}: write it above the line `{header}`",
                parent.header
            ),
            _ => format!("allowed here: {}", self.keys.join(", ")),
        };
        (format!("unknown key `{key}` in {header}{hint}"), help)
    }
}

/// Returns the problem of an object that could not be made, placed at the key of the rejected
/// `parameter` in the first of `sections` that has it, or else at the header of the first.
pub fn rejected(
    error: &impl Display,
    parameter: Option<&str>,
    sections: &[&Section<'_>],
) -> Problem {
    let key = parameter.unwrap_or_default();
    let section = sections.iter().find(|section| section.has(key));
    match section.or(sections.first()) {
        Some(section) => section.problem_with(key, error),
        None => Problem::new(error.to_string()),
    }
}
