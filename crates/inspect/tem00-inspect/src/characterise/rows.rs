//! The characteristics by name, with their definitions.

use tem00_report::report::{
    Unit,
    units::{MICROMETRES, NUMBER},
};
use tem00_topography::{Characteristics, Estimate, Extreme, Field, GrooveResult};

/// A characteristic.
pub(super) struct Row {
    pub(super) key: &'static str,
    pub(super) name: &'static str,
    pub(super) symbol: &'static str,
    pub(super) definition: &'static str,
    pub(super) unit: Unit,
    /// Value and standard uncertainty, or the reason why there are none.
    pub(super) found: Result<Estimate, String>,
    /// The value that noise alone would give.
    pub(super) by_chance: Option<f64>,
}

const NOT_SEEN: &str = "not measured: too little of the artefact was seen";

/// Returns all characteristics, in the order of a report.
pub(super) fn rows(found: &Characteristics) -> Vec<Row> {
    let mut rows = heights(found);
    rows.extend(laterals(found));
    rows.extend(probing(found));
    rows
}

fn heights(found: &Characteristics) -> Vec<Row> {
    let (response, flat) = (found.response.as_ref(), found.flat.as_ref());
    vec![
        Row {
            unit: NUMBER,
            ..row(
                [
                    "amplification_coefficient",
                    "amplification coefficient",
                    "α_z",
                ],
                "Slope of the line of least squares of measured over true heights; a level flat at nine heights over nine \
                 tenths of the measuring range, each the mean of all repetitions.",
                response.map(|found| found.amplification),
            )
        },
        extreme(
            ["linearity_deviation", "linearity deviation", "l_z"],
            "Largest distance, in height, of a mean measured height of that flat from the line.",
            response.map(|found| found.linearity),
        ),
        extreme(
            ["flatness_deviation", "flatness deviation", "z_FLT"],
            "Range of the mean heights at 64 places along the profile of a level flat, over all repetitions, less the line \
             of least squares through them.",
            flat.map(|found| found.flatness),
        ),
        row(
            ["measurement_noise", "measurement noise", "N_M"],
            "Standard deviation of a height of a level flat, each repetition on another piece of it: with speckle.",
            flat.map(|found| found.measurement_noise),
        ),
        row(
            ["instrument_noise", "instrument noise", "N_I"],
            "Standard deviation of a height where nothing moves, from differences of two frames by √2: without speckle, \
             which rests with the surface.",
            flat.map(|found| found.instrument_noise),
        ),
    ]
}

fn laterals(found: &Characteristics) -> Vec<Row> {
    let [across_profile, across_scan] = &found.grooves;
    let x = &across_profile.as_ref().ok_or_else(|| unseen(&found.field));
    let y = &across_scan.as_ref().ok_or_else(|| NOT_SEEN.to_owned());
    let resolution = "Width of a groove with upright walls that is measured with half of its depth in its middle, from a comb \
         of twelve widths in steps of √2.";
    let fidelity = "Width of a groove down to which the depth in the middle is right within a tenth, of the same comb.";
    vec![
        of_grooves(
            [
                "resolution_along_profile",
                "topographic spatial resolution along the profile",
                "W_R,x",
            ],
            resolution,
            x,
            |grooves| grooves.resolution,
        ),
        of_grooves(
            [
                "resolution_along_scan",
                "topographic spatial resolution along the scan",
                "W_R,y",
            ],
            resolution,
            y,
            |grooves| grooves.resolution,
        ),
        mapping(
            [
                "mapping_deviation_along_profile",
                "x-y mapping deviation along the profile",
                "Δ_x",
            ],
            "Largest error of the place of the widest grooves, which lie side by side over nine tenths of the profile: \
             half-way between the places at which the mean profile is half as deep as they are.",
            x,
        ),
        mapping(
            [
                "mapping_deviation_along_scan",
                "x-y mapping deviation along the scan",
                "Δ_y",
            ],
            "Error of the place of the widest groove across the scan, found in the same way.",
            y,
        ),
        of_grooves(
            [
                "fidelity_limit_along_profile",
                "topography fidelity limit along the profile",
                "T_FI,x",
            ],
            fidelity,
            x,
            |grooves| grooves.fidelity_limit,
        ),
        of_grooves(
            [
                "fidelity_limit_along_scan",
                "topography fidelity limit along the scan",
                "T_FI,y",
            ],
            fidelity,
            y,
            |grooves| grooves.fidelity_limit,
        ),
    ]
}

fn probing(found: &Characteristics) -> Vec<Row> {
    let (sphere, flat) = (found.sphere.as_ref(), found.flat.as_ref());
    let form = "Distance of the planes, parallel to that of least squares, that enclose 95 % of the points of all repetitions.";
    vec![
        row(
            ["probing_size_error", "probing size error", "P_Size.Sph.All"],
            "Diameter of the sphere of least squares through all points of a cap of 45° half-angle, less the true one.",
            sphere.map(|found| found.size),
        ),
        row(
            [
                "probing_form_error_25",
                "probing form error of 25 places",
                "P_Form.Sph.1x25",
            ],
            "Range of the distances of 25 places on the cap, each the mean of the points within 4.5° of it, from the sphere \
             of least squares through them.",
            sphere.map(|found| found.form_of_places),
        ),
        row(
            [
                "probing_form_error_95",
                "probing form error of 95 % of the points",
                "P_Form.Sph.D95%",
            ],
            "Least distance of two spheres, about the centre of that of least squares, that enclose 95 % of the points of the cap.",
            sphere.map(|found| found.form),
        ),
        row(
            ["flat_form_level", "flat form, level", "E_Form.Pla.D95%"],
            form,
            flat.map(|found| found.form[0]),
        ),
        row(
            [
                "flat_form_tilted_along_profile",
                "flat form, tilted along the profile",
                "E_Form.Pla.D95%",
            ],
            form,
            flat.map(|found| found.form[1]),
        ),
        row(
            [
                "flat_form_tilted_along_scan",
                "flat form, tilted along the scan",
                "E_Form.Pla.D95%",
            ],
            form,
            flat.map(|found| found.form[2]),
        ),
    ]
}

fn row(
    [key, name, symbol]: [&'static str; 3],
    definition: &'static str,
    found: Option<Estimate>,
) -> Row {
    Row {
        key,
        name,
        symbol,
        definition,
        unit: MICROMETRES,
        found: found.ok_or_else(|| NOT_SEEN.to_owned()),
        by_chance: None,
    }
}

fn extreme(names: [&'static str; 3], definition: &'static str, found: Option<Extreme>) -> Row {
    let estimate = found.map(|found| Estimate {
        value: found.value,
        uncertainty: found.uncertainty,
    });
    Row {
        by_chance: found.map(|found| found.by_chance),
        ..row(names, definition, estimate)
    }
}

fn of_grooves(
    names: [&'static str; 3],
    definition: &'static str,
    grooves: &Result<&GrooveResult, String>,
    found: fn(&GrooveResult) -> Option<Estimate>,
) -> Row {
    let found = grooves
        .clone()
        .and_then(|grooves| found(grooves).ok_or_else(|| beyond(grooves)));
    Row {
        found,
        ..row(names, definition, None)
    }
}

fn mapping(
    names: [&'static str; 3],
    definition: &'static str,
    grooves: &Result<&GrooveResult, String>,
) -> Row {
    let shallow = "not measured: the widest grooves are not seen half as deep as they are";
    let found = grooves
        .clone()
        .and_then(|grooves| grooves.mapping.ok_or_else(|| shallow.to_owned()));
    match found {
        Ok(mapping) => extreme(names, definition, Some(mapping)),
        Err(reason) => Row {
            found: Err(reason),
            ..row(names, definition, None)
        },
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
        "not measured: the comb of grooves needs {:.0} points along the profile, and there are {points:.0}",
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
