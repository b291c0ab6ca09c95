//! The report of characteristics.

use tem00_report::report::{
    Cell, Column, Report, Section, Table,
    units::{DEGREES, MICROMETRES, MILLIMETRES},
};
use tem00_topography::{Characteristics, Estimate};
use tem00_triangulation::Setup;

use super::rows::{CharacteristicRow, rows};
use crate::args::CharacteriseArgs;

pub(super) fn report(
    args: &CharacteriseArgs,
    (setup, text): (&Setup, &str),
    found: &Characteristics,
    drawings: Vec<(String, &'static str)>,
) -> Report {
    let mut report = Report::new("Metrological characteristics of a laser-triangulation set-up");
    let file = args.common.setup.display().to_string();
    report.data("setup", &file);
    let rows = rows(found);
    report.verdict(verdict(&rows));
    if let Some(grooves) = &found.grooves[0] {
        let widths = [
            ("W_R,x", grooves.resolution),
            ("T_FI,x", grooves.fidelity_limit),
        ];
        let said = widths
            .map(|(symbol, width)| finer_than_columns(symbol, width?.value, found.field.column));
        said.into_iter()
            .flatten()
            .for_each(|line| report.warning(line));
    }
    report.note(
        "Rendered, not measured: camera, laser plane and stage are known exactly, and the \
         artefacts are of the surface of the set-up. A profile is one frame, imaged as waves: with \
         diffraction, defocus and speckle.",
    );
    let section = report.section("Characteristics");
    section.table(table(&rows)).paragraph(
        "± is a standard uncertainty, by the spread between repetitions. Where a characteristic is \
         the largest of several deviations, noise alone would give what stands under \"by \
         chance\": only what is clearly larger is one of the sensor.",
    );
    for (drawing, caption) in drawings {
        section.drawing(drawing, caption);
    }
    let definitions = report.section("Definitions").in_detail();
    definitions.table(defined(&rows)).paragraph(
        "Terms and symbols are those of ISO 25178-600 and ISO 10360-8; the definitions are those \
         of this program, in full.",
    );
    artefacts(
        report
            .section("The artefacts")
            .under("artefacts")
            .in_detail(),
        args,
        (setup, found),
    );
    report.section("Files").file(file, text);
    report
}

/// Returns noise and resolution in words.
fn verdict(rows: &[CharacteristicRow]) -> String {
    let said = |key: &str| {
        let row = rows.iter().find(|row| row.key == key)?;
        let found = row.found.estimate.as_ref().ok()?;
        Some(row.found.unit.with_digits(2).text(found.value))
    };
    let noise = said("measurement_noise").zip(said("instrument_noise"));
    let noise = noise.map_or_else(
        || "The noise of a height is not known: too little of the level flat was seen.".to_owned(),
        |(all, instrument)| {
            format!("A height has a noise of {all}, of which {instrument} without speckle.")
        },
    );
    let widths = said("resolution_along_profile").zip(said("resolution_along_scan"));
    let widths = widths.map(|(x, y)| {
        format!(
            " Grooves of {x} along the profile and of {y} along the scan are seen half as deep \
            as they are."
        )
    });
    noise + &widths.unwrap_or_default()
}

/// Returns the remark on a width along the profile that is less than two columns.
fn finer_than_columns(symbol: &str, width: f64, column: f64) -> Option<String> {
    let two = 2.0 * column;
    let text = |length| MICROMETRES.with_digits(3).text(length);
    (width < two).then(|| {
        format!(
            "{symbol} = {} is less than two columns, {}: whether so narrow a groove is seen hangs \
             on where a column stands in it. Quote two columns.",
            text(width),
            text(two)
        )
    })
}

fn table(rows: &[CharacteristicRow]) -> Table {
    let mut table = Table::new(
        "Values and standard uncertainties",
        [
            Column::new("key", "characteristic"),
            Column::new("symbol", "symbol"),
            Column::new("value", "value"),
            Column::new("uncertainty", "±"),
            Column::new("by_chance", "by chance"),
            Column::data("definition"),
        ],
    )
    .under("characteristics");
    for row in rows {
        let unit = row.found.unit;
        let in_two_digits = |value| unit.with_digits(2).quantity(value);
        let [value, uncertainty] = match &row.found.estimate {
            Ok(Estimate { value, uncertainty }) => [
                unit.with_digits_known(*value, *uncertainty)
                    .quantity(*value),
                in_two_digits(*uncertainty),
            ],
            Err(reason) => [Cell::missing(reason.clone()), Cell::missing("-")],
        };
        table.row([
            Cell::new(row.key, row.name),
            row.symbol.into(),
            value,
            uncertainty,
            Cell::or_dash(row.found.by_chance.map(in_two_digits)),
            row.definition.into(),
        ]);
    }
    table
}

fn defined(rows: &[CharacteristicRow]) -> Table {
    let columns = [Column::shown("characteristic"), Column::shown("definition")];
    let mut table = Table::new("How each is found", columns);
    for row in rows {
        table.row([row.name.into(), row.definition.into()]);
    }
    table
}

fn artefacts(
    section: &mut Section,
    args: &CharacteriseArgs,
    (setup, found): (&Setup, &Characteristics),
) {
    let field = &found.field;
    let [low, high] = field.heights.map(|height| MILLIMETRES.text(height));
    section
        .fact(
            "heights",
            "measuring range",
            Cell::new(field.heights, format!("from {low} to {high}")),
        )
        .fact(
            "width",
            "length of a profile",
            MILLIMETRES.quantity(field.width),
        )
        .fact(
            "column",
            "distance of its points",
            MICROMETRES.quantity(field.column),
        )
        .fact(
            "groove_depth",
            "depth of the grooves",
            MICROMETRES.quantity(field.groove_depth),
        )
        .fact(
            "sphere_diameter",
            "diameter of the sphere",
            Cell::or_dash(
                found
                    .sphere
                    .map(|sphere| MILLIMETRES.quantity(sphere.diameter)),
            ),
        )
        .fact(
            "tilts",
            "tilts of the flat, along profile and scan",
            Cell::or_dash(found.flat.map(|flat| {
                let tilts = flat.slopes.map(f64::atan);
                let [x, y] = tilts.map(|tilt| DEGREES.with_digits(3).text(tilt));
                Cell::new(tilts, format!("{x}, {y}"))
            })),
        )
        .fact(
            "averaged_columns",
            "columns averaged",
            setup.description().average.columns,
        )
        .data("repetitions", args.repetitions)
        .data("samples_per_pixel", args.spp)
        .data("seed", args.seed);
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_width_below_two_columns_is_not_quoted_without_a_word() {
        for (width, said) in [
            (19.9e-6, true),
            (20.1e-6, false),
            (35e-6, false),
            (1e-6, true),
        ] {
            let found = finer_than_columns("W_R,x", width, 10e-6);
            assert_eq!(found.is_some(), said, "{width}");
            assert!(
                found.is_none_or(|line| line.contains("two columns, 20 µm")),
                "{width}"
            );
        }
    }
}
