use core::fmt::Display;
use core::ops::{RangeBounds, RangeInclusive};

use glam::DVec3;
use toml::Spanned;
use toml::de::DeValue;

use crate::error::{Location, Problem};
use crate::quantity::{DIMENSIONS, Dimension, LENGTH, NUMBER};
use crate::source::Source;

/// A value of the file, with its name, its text and its location for messages about it.
#[derive(Clone, Debug)]
pub struct Value<'a> {
    name: String,
    item: &'a Spanned<DeValue<'a>>,
    source: &'a Source,
}

impl<'a> Value<'a> {
    pub(crate) fn new(key: &str, item: &'a Spanned<DeValue<'a>>, source: &'a Source) -> Self {
        Self {
            name: format!("`{key}`"),
            item,
            source,
        }
    }

    /// Returns the location of the value.
    pub(crate) fn location(&self) -> Location {
        self.source.location(self.item.span())
    }

    /// Returns the problem that the value is not `allowed`.
    pub fn must_be(&self, allowed: impl Display) -> Problem {
        let (name, got) = (&self.name, self.as_written());
        Problem::new(format!("{name} must be {allowed}, got {got}")).at(self.location())
    }

    /// The value as the file has it, on one line and not too long.
    fn as_written(&self) -> String {
        const LONGEST: usize = 60;
        let text = self.source.text().get(self.item.span()).unwrap_or_default();
        let words: Vec<&str> = text.split_whitespace().collect();
        let line = words.join(" ");
        match line.char_indices().nth(LONGEST) {
            Some((cut, _)) => format!("{}…", &line[..cut]),
            None => line,
        }
    }

    /// Returns the value as the file has it; a string without its quotation marks.
    pub fn text(&self) -> String {
        let written = self.source.text().get(self.item.span());
        let string = self.item.get_ref().as_str().or(written);
        string.unwrap_or_default().to_owned()
    }

    /// Returns the value in SI units: a bare number, or a string with a unit.
    ///
    /// # Errors
    ///
    /// Returns a problem, placed at the value, if it is anything else.
    pub fn quantity(&self, dimension: &Dimension) -> Result<f64, Problem> {
        let value = match self.item.get_ref() {
            DeValue::Integer(integer) => decimal(integer.as_str(), integer.radix()),
            DeValue::Float(float) => float.as_str().parse().ok(),
            DeValue::String(text) => dimension.parse(text),
            _ => None,
        };
        let value = value.ok_or_else(|| self.not_a(dimension))?;
        let (_, greatest) = dimension.magnitudes;
        if value.abs() <= greatest {
            return Ok(value);
        }
        let greatest = self.in_its_unit(greatest, dimension);
        Err(self.must_be(format_args!("a finite number of at most {greatest}")))
    }

    fn not_a(&self, dimension: &Dimension) -> Problem {
        let (noun, units) = (dimension.noun, dimension.units());
        if units.is_empty() {
            return self.must_be(noun);
        }
        self.must_be(format_args!("{noun} in {units}"))
            .with_help(dimension.how_to_write())
    }

    /// Returns a quantity that is greater than zero.
    ///
    /// # Errors
    ///
    /// Returns a problem, placed at the value, if it is anything else.
    pub fn positive(&self, dimension: &Dimension) -> Result<f64, Problem> {
        let (min, _) = dimension.magnitudes;
        let allowed = self.in_its_unit(min, dimension);
        self.within(dimension, min.., &format!("positive, at least {allowed}"))
    }

    /// Writes a quantity in SI units in the unit of this value.
    fn in_its_unit(&self, quantity: f64, dimension: &Dimension) -> String {
        let typed = self.item.get_ref().as_str();
        typed
            .and_then(|typed| dimension.written_as(quantity, typed))
            .unwrap_or_else(|| {
                let text = format!("{quantity:e} {}", dimension.si_unit);
                text.trim_end().to_owned()
            })
    }

    /// Returns a problem placed at the value, whose quantities are stated in the unit of the value.
    /// For a bare number that lacks the unit of the message, it says how to write one.
    pub fn problem(&self, message: impl Display) -> Problem {
        let message = message.to_string();
        let problem = Problem::new(self.retyped(&message)).at(self.location());
        let is_named = |unit: &str| message.contains(&format!("(in {unit})"));
        let dimension = DIMENSIONS
            .iter()
            .find(|dimension| is_named(dimension.si_unit));
        match dimension.filter(|_| self.is_bare()) {
            Some(dimension) => problem.with_help(dimension.how_to_write()),
            None => problem,
        }
    }

    /// Returns whether it is a number without a unit.
    fn is_bare(&self) -> bool {
        matches!(self.item.get_ref(), DeValue::Integer(_) | DeValue::Float(_))
    }

    /// Returns a message about this value with its quantities in the unit of this value.
    pub(crate) fn retyped(&self, message: &str) -> String {
        let typed = self.item.get_ref().as_str();
        typed
            .and_then(|typed| {
                DIMENSIONS
                    .iter()
                    .find_map(|dimension| dimension.retyped(message, typed))
            })
            .unwrap_or_else(|| message.to_owned())
    }

    /// Returns a quantity in `range`, which `allowed` describes.
    ///
    /// # Errors
    ///
    /// Returns a problem, placed at the value, if it is anything else.
    pub fn within(
        &self,
        dimension: &Dimension,
        range: impl RangeBounds<f64>,
        allowed: &str,
    ) -> Result<f64, Problem> {
        let value = self.quantity(dimension)?;
        if range.contains(&value) {
            return Ok(value);
        }
        let problem = self.must_be(allowed);
        Err(match self.is_bare() && !dimension.si_unit.is_empty() {
            true => problem.with_help(dimension.how_to_write()),
            false => problem,
        })
    }

    /// Returns the size, in metres, of a unit of length: "mm", "25.4 mm" or a bare number.
    ///
    /// # Errors
    ///
    /// Returns a problem, placed at the value, if it is anything else.
    pub fn unit_of_length(&self) -> Result<f64, Problem> {
        match self
            .item
            .get_ref()
            .as_str()
            .and_then(|text| LENGTH.size_of(text))
        {
            Some(size) => Ok(size),
            None => self.positive(&LENGTH),
        }
    }

    /// Returns a whole number in `range`.
    ///
    /// # Errors
    ///
    /// Returns a problem, placed at the value, if it is anything else.
    pub fn integer(&self, range: RangeInclusive<u64>) -> Result<u64, Problem> {
        let value = match self.item.get_ref() {
            DeValue::Integer(integer) => {
                u64::from_str_radix(integer.as_str(), integer.radix()).ok()
            }
            _ => None,
        };
        value.filter(|value| range.contains(value)).ok_or_else(|| {
            let (min, max) = range.into_inner();
            self.must_be(format_args!("a whole number from {min} to {max}"))
        })
    }

    /// Returns whether the value is true or false.
    ///
    /// # Errors
    ///
    /// Returns a problem, placed at the value, if it is anything else.
    pub fn boolean(&self) -> Result<bool, Problem> {
        let value = self.item.get_ref().as_bool();
        value.ok_or_else(|| self.must_be("true or false"))
    }

    /// Returns a string.
    ///
    /// # Errors
    ///
    /// Returns a problem, placed at the value, if it is anything else.
    pub fn string(&self) -> Result<&'a str, Problem> {
        self.item
            .get_ref()
            .as_str()
            .ok_or_else(|| self.must_be("a string in quotation marks"))
    }

    /// Returns the one of `choices` that the string names.
    ///
    /// # Errors
    ///
    /// Returns a problem, placed at the value, if it is anything else.
    pub fn one_of<T: Clone>(&self, choices: &[(&'static str, T)]) -> Result<T, Problem> {
        let text = self.string()?;
        if let Some((_, chosen)) = choices.iter().find(|(name, _)| *name == text) {
            return Ok(chosen.clone());
        }
        let names: Vec<&str> = choices.iter().map(|(name, _)| *name).collect();
        let problem = self.must_be(format_args!("one of \"{}\"", names.join("\", \"")));
        Err(match nearest(text, &names) {
            Some(meant) => problem.with_help(format!("did you mean \"{meant}\"?")),
            None => problem,
        })
    }

    /// Returns whether the value is a table.
    pub fn is_table(&self) -> bool {
        self.item.get_ref().is_table()
    }

    /// Returns whether the value is an array.
    pub fn is_list(&self) -> bool {
        self.item.get_ref().is_array()
    }

    /// Returns the elements of an array that has exactly `N` elements.
    ///
    /// # Errors
    ///
    /// Returns a problem, placed at the value, if it is anything else.
    pub fn elements<const N: usize>(&self, allowed: &str) -> Result<[Self; N], Problem> {
        let elements = self.list(allowed)?;
        elements.try_into().map_err(|_| self.must_be(allowed))
    }

    /// Returns the elements of an array of any length.
    ///
    /// # Errors
    ///
    /// Returns a problem, placed at the value, if it is anything else.
    pub fn list(&self, allowed: &str) -> Result<Vec<Self>, Problem> {
        let array = self.item.get_ref().as_array();
        let items = array.ok_or_else(|| self.must_be(allowed))?.iter();
        let element = |(index, item)| Self {
            name: format!("element {} of {}", index + 1, self.name),
            item,
            source: self.source,
        };
        Ok(items.enumerate().map(element).collect())
    }

    /// Returns a vector of three lengths, in metres.
    ///
    /// # Errors
    ///
    /// Returns a problem, placed at the value, if it is anything else.
    pub fn lengths(&self) -> Result<DVec3, Problem> {
        self.vector(&LENGTH, "three lengths, such as [0, \"5 mm\", \"0.3 m\"]")
    }

    /// Returns a vector in the direction of a vector that is not zero, of length 1.
    ///
    /// # Errors
    ///
    /// Returns a problem, placed at the value, if it is anything else.
    pub fn direction(&self) -> Result<DVec3, Problem> {
        const ALLOWED: &str = "three numbers that are not all zero, such as [0, 0, 1]";
        let vector = self.vector(&NUMBER, ALLOWED)?;
        // Divides by the largest component first, so that no square leaves the range of numbers.
        let largest = vector.abs().max_element();
        (vector / largest)
            .try_normalize()
            .ok_or_else(|| self.must_be(ALLOWED))
    }

    fn vector(&self, dimension: &Dimension, allowed: &str) -> Result<DVec3, Problem> {
        let [x, y, z] = self.elements(allowed)?;
        Ok(DVec3::new(
            x.quantity(dimension)?,
            y.quantity(dimension)?,
            z.quantity(dimension)?,
        ))
    }
}

/// Returns the number that an integer spells; digits beyond the precision of `f64` are rounded.
fn decimal(digits: &str, radix: u32) -> Option<f64> {
    if radix == 10 {
        return digits.parse().ok();
    }
    let value = u32::from_str_radix(digits, radix).ok()?;
    Some(f64::from(value))
}

/// Returns the word of `words` that `word` is most likely a misspelling or a part of, if any is
/// close.
pub fn nearest<'w>(word: &str, words: &[&'w str]) -> Option<&'w str> {
    // The Jaro–Winkler similarity of unrelated words is around a half, of a typo above nine tenths.
    const CLOSE: f64 = 0.8;
    let word = word.to_lowercase().replace([' ', '-'], "_");
    let is_part = |candidate: &str| candidate.split('_').any(|part| part == word);
    words
        .iter()
        .map(|&candidate| (strsim::jaro_winkler(&word, candidate), candidate))
        .filter(|(similarity, candidate)| *similarity >= CLOSE || is_part(candidate))
        .max_by(|(a, _), (b, _)| a.total_cmp(b))
        .map(|(_, candidate)| candidate)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_part_of_a_name_means_it() {
        let metals = ["aluminium", "iron", "brass", "stainless_steel"];
        let methods = [
            "parabola",
            "centre_of_gravity",
            "log_gaussian",
            "blais_rioux",
        ];
        for (word, words, meant) in [
            ("steel", &metals[..], Some("stainless_steel")),
            ("Steel", &metals, Some("stainless_steel")),
            ("stainless steel", &metals, Some("stainless_steel")),
            ("aluminum", &metals, Some("aluminium")),
            ("lead", &metals, None),
            ("gravity", &methods, Some("centre_of_gravity")),
            ("blais-rioux", &methods, Some("blais_rioux")),
            ("rioux", &methods, Some("blais_rioux")),
            ("gauss", &methods, Some("log_gaussian")),
        ] {
            assert_eq!(nearest(word, words), meant, "{word}");
        }
    }
}
