//! The section `[certificate]` of a set-up file.

use tem00_config::{Document, Problem, Section, Value, is_hazard};

use crate::date::month_lengths;

const CERTIFICATE: &[&str] = &[
    "identifier",
    "performed_from",
    "performed_to",
    "performed_at",
    "issued",
    "responsible",
    "laboratory",
    "customer",
    "item",
];
const CONTACT: &[&str] = &["name", "street", "post_code", "city", "country", "email"];
const ITEM: &[&str] = &["name", "manufacturer", "model", "identification", "issuer"];
const PLACES: [&str; 5] = [
    "laboratory",
    "customer",
    "laboratoryBranch",
    "customerBranch",
    "other",
];
const ISSUERS: [&str; 5] = [
    "manufacturer",
    "calibrationLaboratory",
    "customer",
    "owner",
    "other",
];

/// Administrative data of a calibration certificate.
pub(in crate::budget) struct CertificateData {
    pub(super) own: Texts,
    pub(super) laboratory: Texts,
    pub(super) customer: Texts,
    /// The set-up as an item.
    pub(super) item: Texts,
}

/// The texts of a section, by their keys.
pub(super) struct Texts(Vec<(&'static str, String)>);

/// Kinds of text in a certificate.
#[derive(Clone, Copy)]
enum Kind {
    Words,
    Country,
    /// A day that is not before another day of the same section.
    Date,
    OneOf([&'static str; 5]),
}
use Kind::{Country, Date, OneOf, Words};

/// A key with an example if it is required, and with an empty example if it may be left out.
type Key = (&'static str, Kind, &'static str);

impl CertificateData {
    /// Reads the section; `None` without one.
    ///
    /// # Errors
    ///
    /// Returns a problem, placed in the file, if a key is missing or unknown, a value is not
    /// possible, or the set-up has no measured height that a certificate could state.
    pub(in crate::budget) fn read(
        document: &Document<'_>,
        measures_height: bool,
    ) -> Result<Option<Self>, Problem> {
        let Some(section) = document.table("certificate", CERTIFICATE)? else {
            return Ok(None);
        };
        if !measures_height {
            let problem = section.problem("[certificate] needs a height that is measured");
            return Err(problem.with_help("state an uncertain value, or `height` in [budget]"));
        }
        let part = |key, keys, example: &str| {
            section.table(key, keys)?.ok_or_else(|| {
                let problem = section.problem(format_args!(
                    "[certificate] needs a section [certificate.{key}]"
                ));
                problem.with_help(format!(
                    "for example `{example}` below the line `[certificate.{key}]`"
                ))
            })
        };
        let laboratory = part("laboratory", CONTACT, "name = \"Length laboratory\"")?;
        let customer = part("customer", CONTACT, "name = \"Rolling mill\"")?;
        let item = part("item", ITEM, "name = \"Line sensor\"")?;
        let own = [
            ("performed_at", OneOf(PLACES), "\"laboratory\""),
            ("performed_from", Date, "2026-11-23"),
            ("performed_to", Date, "2026-11-23"),
            ("issued", Date, "2026-11-23"),
            ("identifier", Words, "\"LS-2026-07\""),
            ("responsible", Words, "\"A. Example\""),
        ];
        let of_item = [
            ("issuer", OneOf(ISSUERS), "\"customer\""),
            ("name", Words, "\"Line sensor\""),
            ("manufacturer", Words, ""),
            ("model", Words, ""),
            ("identification", Words, "\"drawing 4711\""),
        ];
        Ok(Some(Self {
            own: Texts::read(&section, &own)?,
            laboratory: Texts::read(&laboratory, &contact("\"DE\""))?,
            customer: Texts::read(&customer, &contact(""))?,
            item: Texts::read(&item, &of_item)?,
        }))
    }
}

/// The keys of a laboratory or a customer.
const fn contact(country: &'static str) -> [Key; 6] {
    [
        ("country", Country, country),
        ("name", Words, "\"Length laboratory\""),
        ("street", Words, ""),
        ("post_code", Words, ""),
        ("city", Words, "\"Braunschweig\""),
        ("email", Words, ""),
    ]
}

impl Texts {
    fn read(section: &Section<'_>, keys: &[Key]) -> Result<Self, Problem> {
        let mut texts: Vec<(&str, String)> = Vec::new();
        let mut day: Option<(&str, String)> = None;
        for &(key, kind, example) in keys {
            let value = match section.optional(key) {
                None if example.is_empty() => continue,
                None => section.required(key, example)?,
                Some(value) => value,
            };
            let text = match kind {
                Words => words(&value)?,
                Country => country(&value)?,
                Date => date(&value, day.as_ref())?,
                OneOf(names) => value.one_of(&names.map(|name| (name, name)))?.to_owned(),
            };
            if matches!(kind, Date) {
                day = Some((key, text.clone()));
            }
            texts.push((key, text));
        }
        Ok(Self(texts))
    }

    /// Returns the text of a key, if the section has it.
    pub(super) fn get(&self, key: &str) -> Option<&str> {
        let mut texts = self.0.iter();
        texts
            .find(|(name, _)| *name == key)
            .map(|(_, text)| &**text)
    }
}

/// Reads text that the schema calls not empty.
fn words(value: &Value<'_>) -> Result<String, Problem> {
    let text = value.string()?;
    if text.is_empty() || text.trim() != text || text.contains(is_hazard) {
        return Err(value.must_be("text without spaces at its ends and without control characters"));
    }
    Ok(text.to_owned())
}

fn country(value: &Value<'_>) -> Result<String, Problem> {
    let code = value.string()?;
    if code.len() == 2 && code.bytes().all(|letter| letter.is_ascii_uppercase()) {
        return Ok(code.to_owned());
    }
    Err(value.must_be("a country code of two capital letters (ISO 3166-1)"))
}

/// Reads a day that is not before another.
fn date(value: &Value<'_>, before: Option<&(&str, String)>) -> Result<String, Problem> {
    let date = value.text();
    if !is_date(&date) {
        return Err(value.must_be("a date such as 2026-11-23"));
    }
    match before {
        Some((key, day)) if date < *day => Err(value.must_be(format_args!("`{key}` or later"))),
        _ => Ok(date),
    }
}

/// Returns whether text is a day of the calendar, as `2026-11-23`.
fn is_date(text: &str) -> bool {
    let is_digit = |(place, byte): (usize, u8)| match place {
        4 | 7 => byte == b'-',
        _ => byte.is_ascii_digit(),
    };
    if text.len() != 10 || !text.bytes().enumerate().all(is_digit) {
        return false;
    }
    let number = |range: core::ops::Range<usize>| text[range].parse::<u64>().unwrap_or(0);
    let (year, month, day) = (number(0..4), number(5..7), number(8..10));
    let mut months = (1..).zip(month_lengths(year));
    year > 0 && months.any(|(found, days)| found == month && (1..=days).contains(&day))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn dates_are_those_of_the_calendar() {
        for good in ["2026-11-23", "2024-02-29", "2000-02-29", "2026-12-31"] {
            assert!(is_date(good), "{good}");
        }
        for bad in [
            "2026-02-29",
            "1900-02-29",
            "2026-13-01",
            "2026-00-10",
            "2026-04-31",
            "2026-4-01",
            "26-04-01",
            "2026-11-23T10:00:00",
            "2026/11/23",
            "0000-01-01",
            "",
            "2026-11-2é",
        ] {
            assert!(!is_date(bad), "{bad}");
        }
    }
}
