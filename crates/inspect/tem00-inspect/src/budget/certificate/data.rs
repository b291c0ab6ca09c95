//! The section `[certificate]` of a set-up file.

use tem00_config::{Document, Problem, Section, Value, is_hazard};

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

/// What a calibration certificate says beside its numbers.
pub(in crate::budget) struct CertificateData {
    pub(super) identifier: String,
    /// The first and last day of the work, as in `2026-11-23`.
    pub(super) performed: [String; 2],
    pub(super) place: &'static str,
    pub(super) issued: String,
    pub(super) responsible: String,
    pub(super) laboratory: Contact,
    /// The country of the laboratory, which is that of the certificate.
    pub(super) country: String,
    pub(super) customer: Contact,
    pub(super) item: Item,
}

/// A laboratory or a customer.
pub(super) struct Contact {
    pub(super) name: String,
    pub(super) street: Option<String>,
    pub(super) post_code: Option<String>,
    pub(super) city: String,
    pub(super) country: Option<String>,
    pub(super) email: Option<String>,
}

/// The set-up as an item.
pub(super) struct Item {
    pub(super) name: String,
    pub(super) manufacturer: Option<String>,
    pub(super) model: Option<String>,
    pub(super) identification: String,
    /// Who gave the identification.
    pub(super) issuer: &'static str,
}

impl CertificateData {
    /// Reads the section; `None` without one.
    ///
    /// # Errors
    ///
    /// Returns a problem, placed in the file, if a key is missing or unknown, a value cannot be, or the set-up has
    /// no measured height that a certificate could state.
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
        let place = section.required("performed_at", "\"laboratory\"")?;
        let [from, to, issued] = dates(&section)?;
        Ok(Some(Self {
            identifier: required(&section, "identifier", "\"LS-2026-07\"")?,
            performed: [from, to],
            place: place.one_of(&PLACES.map(|place| (place, place)))?,
            issued,
            responsible: required(&section, "responsible", "\"A. Example\"")?,
            country: country(&laboratory.required("country", "\"DE\"")?)?,
            laboratory: Contact::read(&laboratory)?,
            customer: Contact::read(&customer)?,
            item: Item::read(&item)?,
        }))
    }
}

impl Contact {
    fn read(section: &Section<'_>) -> Result<Self, Problem> {
        Ok(Self {
            name: required(section, "name", "\"Length laboratory\"")?,
            street: optional(section, "street")?,
            post_code: optional(section, "post_code")?,
            city: required(section, "city", "\"Braunschweig\"")?,
            country: section.or("country", None, |value| country(value).map(Some))?,
            email: optional(section, "email")?,
        })
    }
}

impl Item {
    fn read(section: &Section<'_>) -> Result<Self, Problem> {
        let issuer = section.required("issuer", "\"customer\"")?;
        Ok(Self {
            name: required(section, "name", "\"Line sensor\"")?,
            manufacturer: optional(section, "manufacturer")?,
            model: optional(section, "model")?,
            identification: required(section, "identification", "\"drawing 4711\"")?,
            issuer: issuer.one_of(&ISSUERS.map(|issuer| (issuer, issuer)))?,
        })
    }
}

fn required(section: &Section<'_>, key: &'static str, example: &str) -> Result<String, Problem> {
    words(&section.required(key, example)?)
}

fn optional(section: &Section<'_>, key: &'static str) -> Result<Option<String>, Problem> {
    section.or(key, None, |value| words(value).map(Some))
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

/// Reads the first and last day of the work and that of issue, which follow each other.
fn dates(section: &Section<'_>) -> Result<[String; 3], Problem> {
    let keys = ["performed_from", "performed_to", "issued"];
    let mut dates = [String::new(), String::new(), String::new()];
    for (index, key) in keys.into_iter().enumerate() {
        let value = section.required(key, "2026-11-23")?;
        let date = value.text();
        if !is_date(&date) {
            return Err(value.must_be("a date such as 2026-11-23"));
        }
        if index > 0 && date < dates[index - 1] {
            let before = keys[index - 1];
            return Err(value.must_be(format_args!("`{before}` or later")));
        }
        dates[index] = date;
    }
    Ok(dates)
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
    let number = |range: core::ops::Range<usize>| text[range].parse::<u32>().unwrap_or(0);
    let (year, month, day) = (number(0..4), number(5..7), number(8..10));
    let is_leap = year % 4 == 0 && (year % 100 != 0 || year % 400 == 0);
    let days = match month {
        2 => 28 + u32::from(is_leap),
        4 | 6 | 9 | 11 => 30,
        1..=12 => 31,
        _ => 0,
    };
    year > 0 && (1..=days).contains(&day)
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
