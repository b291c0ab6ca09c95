//! The characteristics by name, with their definitions.

use tem00_report::report::{
    Unit,
    units::{MICROMETRES, NUMBER},
};
use tem00_topography::{Characteristics, Estimate, Extreme, Field, GrooveResult, SphereResult};

/// A characteristic.
pub(super) struct CharacteristicRow {
    pub(super) key: &'static str,
    pub(super) name: &'static str,
    pub(super) symbol: &'static str,
    pub(super) definition: &'static str,
    pub(super) found: CharacteristicValue,
}

/// Value of a characteristic.
pub(super) struct CharacteristicValue {
    pub(super) unit: Unit,
    /// Value and standard uncertainty, or the reason why there are none.
    pub(super) estimate: Result<Estimate, String>,
    /// The value that noise alone would give.
    pub(super) by_chance: Option<f64>,
}

/// Key, name, symbol and definition of each characteristic, in the order of a report.
const NAMES: &str = include_str!("characteristics.txt");

const NOT_SEEN: &str = "not measured: too little of the artefact was seen";

/// Returns all characteristics, in the order of a report.
pub(super) fn rows(characteristics: &Characteristics) -> Vec<CharacteristicRow> {
    let found = heights(characteristics).into_iter();
    let found = found
        .chain(laterals(characteristics))
        .chain(probing(characteristics));
    let rows = NAMES.lines().zip(found).map(|(line, found)| {
        let mut texts = line.split(" | ");
        let mut text = || texts.next().unwrap_or_default();
        CharacteristicRow {
            key: text(),
            name: text(),
            symbol: text(),
            definition: text(),
            found,
        }
    });
    rows.collect()
}

fn heights(found: &Characteristics) -> Vec<CharacteristicValue> {
    let (response, flat) = (found.response.as_ref(), found.flat.as_ref());
    vec![
        CharacteristicValue {
            unit: NUMBER,
            ..seen(response.map(|found| found.amplification))
        },
        extreme(seen_at_all(response.map(|found| found.linearity))),
        extreme(seen_at_all(flat.map(|found| found.flatness))),
        seen(flat.map(|found| found.measurement_noise)),
        seen(flat.map(|found| found.instrument_noise)),
    ]
}

fn laterals(found: &Characteristics) -> Vec<CharacteristicValue> {
    let [across_profile, across_scan] = &found.grooves;
    let x = across_profile.as_ref().ok_or_else(|| unseen(&found.field));
    let y = across_scan.as_ref().ok_or_else(|| NOT_SEEN.to_owned());
    let limit = |grooves: &Result<&GrooveResult, String>,
                 of: fn(&GrooveResult) -> Option<Estimate>| {
        let found = grooves.clone();
        estimate(found.and_then(|found| of(found).ok_or_else(|| beyond(found))))
    };
    let mapping = |grooves: &Result<&GrooveResult, String>| {
        let shallow = "not measured: the widest grooves are not seen half as deep as they are";
        let found = grooves.clone();
        extreme(found.and_then(|found| found.mapping.ok_or_else(|| shallow.to_owned())))
    };
    vec![
        limit(&x, |found| found.resolution),
        limit(&y, |found| found.resolution),
        mapping(&x),
        mapping(&y),
        limit(&x, |found| found.fidelity_limit),
        limit(&y, |found| found.fidelity_limit),
    ]
}

fn probing(found: &Characteristics) -> Vec<CharacteristicValue> {
    let (sphere, flat) = (found.sphere.as_ref(), found.flat.as_ref());
    let sphere = |of: fn(&SphereResult) -> Estimate| seen(sphere.map(of));
    let form = |pose: usize| seen(flat.map(|found| found.form[pose]));
    vec![
        sphere(|found| found.size),
        sphere(|found| found.form_of_places),
        sphere(|found| found.form),
        form(0),
        form(1),
        form(2),
    ]
}

fn seen_at_all<T>(found: Option<T>) -> Result<T, String> {
    found.ok_or_else(|| NOT_SEEN.to_owned())
}

fn seen(found: Option<Estimate>) -> CharacteristicValue {
    estimate(seen_at_all(found))
}

const fn estimate(estimate: Result<Estimate, String>) -> CharacteristicValue {
    CharacteristicValue {
        unit: MICROMETRES,
        estimate,
        by_chance: None,
    }
}

fn extreme(found: Result<Extreme, String>) -> CharacteristicValue {
    let by_chance = found.as_ref().ok().map(|found| found.by_chance);
    let value = found.map(|found| Estimate {
        value: found.value,
        uncertainty: found.uncertainty,
    });
    CharacteristicValue {
        by_chance,
        ..estimate(value)
    }
}

/// Says why a comb of grooves across the profile was not seen.
fn unseen(field: &Field) -> String {
    let [needed, points] =
        [field.shortest_for_grooves(), field.width].map(|length| length / field.column);
    if needed <= points {
        return NOT_SEEN.to_owned();
    }
    format!(
        "not measured: the comb of grooves needs {:.0} points along the profile, and there are \
         {points:.0}",
        needed.ceil()
    )
}

/// Says where a limit lies that no two widths of a comb enclose.
fn beyond(grooves: &GrooveResult) -> String {
    let widths = grooves.responses.first().zip(grooves.responses.last());
    let (widest, narrowest) = match widths {
        Some((widest, narrowest)) => (
            MICROMETRES.text(widest.width),
            MICROMETRES.text(narrowest.width),
        ),
        None => return NOT_SEEN.to_owned(),
    };
    format!("not between {narrowest} and {widest}, the widths of the comb")
}
