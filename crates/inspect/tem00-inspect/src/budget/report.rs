//! The report of a budget.

use serde_json::json;
use tem00_report::report::{
    Cell, Column, Report, Section, Table,
    units::{MICROMETRES, MILLIMETRES, MILLISECONDS, NUMBER, PERCENT, PIXELS},
};
use tem00_triangulation::{BudgetTerm, Setup, SimulationOptions, UncertaintySource};

use super::{
    answers,
    findings::{Answer, Findings},
    words,
};
use crate::bandwidth::bandwidth;

/// Returns the report of a day; the numbers of a set-up that measures nothing are `null`.
///
/// The day stands on the page alone: the same set-up and seed give the same JSON.
pub(super) fn report(findings: &Findings<'_>, drawings: Vec<String>, day: &str) -> Report {
    let title = findings.file.title.as_deref();
    let mut report = Report::new(format!(
        "Uncertainty budget of {}",
        title.unwrap_or("a laser-triangulation set-up")
    ));
    let (file, setup) = (findings.file.path.display().to_string(), &findings.setup);
    let checksum = format!("{:x}", md5::compute(&findings.file.text));
    report.data("title", title);
    report.data("setup_md5", &checksum);
    let (answer, refusal) = (
        findings.answer.as_ref().ok(),
        findings.answer.as_ref().err(),
    );
    report.data("setup", &file);
    report.data("reason", refusal.map(|refusal| &refusal.why));
    words::without_effect(setup).for_each(|note| report.note(note));
    let verdicts = match &findings.answer {
        Ok(answer) => words::verdicts(answer, setup),
        Err(refusal) => words::refusal(refusal).into(),
    };
    verdicts.into_iter().for_each(|line| report.verdict(line));
    numbers(&mut report, answer);
    report.data("trials", trials(findings));
    if let Some(measured) = answer.and_then(|answer| answer.measured.as_ref()) {
        answers::section(
            report.section("The measured height").under("measurement"),
            measured,
        );
    }
    match answer {
        Some(answer) => terms(report.section("The budget"), answer, drawings),
        None => report.data("terms", json!([])),
    }
    image(report.section("The set-up").under("image"), setup);
    report
        .section("The inputs")
        .in_detail()
        .table(inputs(setup))
        .paragraph(origin(findings, &checksum, day));
    report.section("Files").file(file, &findings.file.text);
    report
}

/// Says what the budget was computed from.
fn origin(findings: &Findings<'_>, checksum: &str, day: &str) -> String {
    let file = &findings.file;
    let changed = match std::fs::read_to_string(file.path) {
        Ok(text) if text == file.text => "",
        _ => ", with the files that it includes and the changes of the command line",
    };
    let trials = findings
        .trials()
        .map(|trials| trials.options)
        .map_or_else(String::new, |SimulationOptions { trials, seed }| {
            format!(" Trials: {trials}, with the seed {seed}.")
        });
    format!(
        "Computed on {day} from {}{changed}. The text below has the MD5 checksum {checksum}.{trials}",
        file.path.display()
    )
}

/// Returns the values that the budget depends on, given or by default. Calibration, environment and
/// averages are left out where they are the defaults.
fn inputs(setup: &Setup) -> Table {
    let columns = [
        Column::new("key", "key"),
        Column::new("value", "value"),
        Column::new("note", "note"),
    ];
    let mut table = Table::new("Values of the set-up", columns).under("inputs");
    let text = setup.description().to_toml();
    let mut section = "";
    for line in text.lines() {
        if let Some(name) = line.strip_prefix('[') {
            section = name.trim_end_matches(']');
        } else if let Some((key, value)) = line.split_once(" = ") {
            let (value, note) = value.split_once(" # ").unwrap_or((value, ""));
            table.row([
                format!("{section}.{key}").into(),
                value.trim_matches('"').into(),
                note.into(),
            ]);
        }
    }
    table
}

/// Adds the numbers that the verdicts state in words.
fn numbers(report: &mut Report, answer: Option<&Answer>) {
    type Value = fn(&Answer) -> f64;
    let values: [(&str, Value); 8] = [
        ("height", |answer| answer.budget.height()),
        ("combined", |answer| answer.quoted()[0]),
        ("degrees_of_freedom", |answer| {
            answer.budget.degrees_of_freedom()
        }),
        ("coverage_factor", |answer| {
            let [combined, expanded] = answer.quoted();
            expanded / combined
        }),
        ("expanded", |answer| answer.quoted()[1]),
        ("speckles", |answer| answer.budget.speckles()),
        ("line_law", |answer| answer.budget.line_law()),
        ("dorsch", |answer| answer.budget.dorsch()),
    ];
    for (key, value) in values {
        report.data(key, answer.map(value));
    }
    let quoted = |answer: &Answer| match answer.quoted_trials() {
        Some(_) => "trials",
        None => "formulas",
    };
    report.data("quoted", answer.map(quoted));
    let shift = answer.and_then(|answer| answer.budget.subsurface());
    let shift = shift.map(|shift| json!({ "position": shift.position, "height": shift.height }));
    report.data("subsurface", shift);
    report.data(
        "formulas",
        answer.map(|Answer { budget, .. }| {
            json!({ "combined": budget.combined(), "expanded": budget.expanded() })
        }),
    );
    report.data(
        "dominant",
        answer.map(|answer| answers::source(answer.dominant().0)),
    );
    let over_range = answer.map_or(&[][..], |answer| &answer.over_range);
    let over_range = over_range.iter();
    let over_range =
        over_range.map(|(height, combined)| json!({ "height": height, "combined": combined }));
    report.data("over_range", over_range.collect::<Vec<_>>());
}

/// Returns the results of trials, and the combined uncertainty by them; without an uncertainty, how
/// many columns have no line that can be trusted.
fn trials(findings: &Findings<'_>) -> serde_json::Value {
    let Some(trials) = findings.trials() else {
        return serde_json::Value::Null;
    };
    let answer = findings.answer.as_ref().ok();
    let combined = answer.and_then(Answer::combined_by_trials);
    let total = trials.total;
    json!({
        "trials": trials.options.trials,
        "seed": trials.options.seed,
        "uncertainty": total.map(|total| total.uncertainty),
        "standard_error": total.map(|total| total.standard_error),
        "combined": combined,
        "expanded": trials.expanded,
        "invalid": trials.invalid,
    })
}

/// Adds the table of the terms and the drawings.
fn terms(section: &mut Section, answer: &Answer, drawings: Vec<String>) {
    const CAPTIONS: [&str; 2] = [
        "The standard uncertainty of a height by each source alone, and by all.",
        "The combined standard uncertainty, by formulas, over the heights that are in the image \
         and in the depth of field.",
    ];
    let mut columns: Vec<Column> = [
        Column::new("source", "source"),
        Column::new("evaluation", "type"),
        Column::new("distribution", "distribution"),
        Column::new("uncertainty", "standard uncertainty"),
        Column::data("unit"),
        Column::new("sensitivity", "sensitivity"),
        Column::new("degrees_of_freedom", "degrees of freedom"),
        Column::new("contribution", "contribution (µm)"),
        Column::new("variance_fraction", "part of u² (%)"),
    ]
    .into();
    if answer.trials.is_some() {
        columns.push(Column::new("by_trials", "by trials (µm)"));
        columns.push(Column::new("by_trials_standard_error", "± (µm)"));
    }
    let mut table = Table::new("Standard uncertainties of a height", columns).under("terms");
    for term in answer.budget.terms() {
        table.row(cells(answer, term));
    }
    table.total(combined(answer));
    section.table(table).paragraph(
        "Types after the GUM: A by statistics, B by models and data sheets. Formulas are first \
         order in the noise. Trials expose simulated frames and find the line in them: errors of a \
         single source against the position without noise, those of all at once against the true \
         position; ± is a standard error.",
    );
    for (drawing, caption) in drawings.into_iter().zip(CAPTIONS) {
        section.drawing(drawing, caption);
    }
}

fn cells(answer: &Answer, term: &BudgetTerm) -> Vec<Cell> {
    let is_length = term.source == UncertaintySource::Calibration;
    let uncertainty = if is_length { MICROMETRES } else { PIXELS };
    let sensitivity = if is_length {
        Cell::new(term.sensitivity, "1")
    } else {
        let text = MICROMETRES.text(term.sensitivity.abs());
        Cell::new(term.sensitivity, format!("{text}/px"))
    };
    let mut cells = vec![
        term.source.name().into(),
        format!("{:?}", term.evaluation).into(),
        term.distribution.name().into(),
        uncertainty.quantity(term.uncertainty),
        term.unit().into(),
        sensitivity,
        NUMBER.with_digits(3).cell(term.degrees_of_freedom),
        MICROMETRES.cell(term.contribution()),
        PERCENT
            .with_digits(3)
            .cell(answer.budget.variance_fraction(term)),
    ];
    if let Some(trials) = &answer.trials {
        let found = trials.term(term.source);
        let length = |value: Option<f64>| Cell::or_dash(value.map(|value| MICROMETRES.cell(value)));
        cells.push(length(found.map(|found| found.uncertainty)));
        cells.push(length(found.map(|found| found.standard_error)));
    }
    cells
}

/// Returns the last line of the table.
fn combined(answer: &Answer) -> Vec<Cell> {
    let budget = &answer.budget;
    let mut cells = vec![Cell::from("combined")];
    cells.resize(6, Cell::default());
    cells.push(NUMBER.with_digits(3).cell(budget.degrees_of_freedom()));
    cells.push(MICROMETRES.cell(budget.combined()));
    cells.push(PERCENT.cell(1.0));
    let total = answer.trials.as_ref().and_then(|trials| trials.total);
    if let (Some(total), Some(combined)) = (total, answer.combined_by_trials()) {
        cells.push(MICROMETRES.cell(combined));
        cells.push(MICROMETRES.cell(total.standard_error));
    }
    cells
}

/// Returns the part of a width by light from below the surface, in words.
fn below_surface(width: f64) -> String {
    match width > 0.0 {
        true => format!(", {} by light from below the surface", PIXELS.text(width)),
        false => String::new(),
    }
}

/// Adds what follows from the set-up.
fn image(section: &mut Section, setup: &Setup) {
    let (description, line, range) = (setup.description(), setup.line(), setup.measuring_range());
    let [low, high] = [range.low, range.high].map(|height| MILLIMETRES.text(height));
    let exposure = MILLISECONDS.quantity(description.sensor.exposure_time);
    let detector = description.detector.method.name();
    section
        .fact(
            "imaged_width_pixels",
            "width of the line in the image (1/e²)",
            PIXELS.quantity(line.width).and(format!(
                ", {} of the line itself{} and {} of the lens",
                PIXELS.text(line.projected_thickness),
                below_surface(line.subsurface_width),
                PIXELS.text(line.diffraction_width)
            )),
        )
        .fact(
            "speckle_size_pixels",
            "speckle size in the image",
            Cell::new(line.speckle_size, PIXELS.text(line.speckle_size[1])),
        )
        .fact(
            "contrast",
            "speckle contrast in a pixel",
            NUMBER.quantity(setup.contrast()),
        )
        .fact(
            "bandwidth",
            "linewidth and extent of the source",
            bandwidth(setup),
        )
        .fact(
            "saturation",
            "light",
            PERCENT.quantity(setup.saturation()).and(format!(
                " of the range, {} electrons in the brightest pixel: {}",
                NUMBER.text(setup.peak_electrons()),
                setup.light_level().name()
            )),
        )
        .fact(
            "exposure",
            "exposure",
            if description.auto_exposure {
                exposure.and(", chosen so that bright grains fill nine tenths of the range")
            } else {
                exposure
            },
        )
        .fact(
            "height_per_pixel",
            "height per pixel",
            Cell::new(
                line.height_per_pixel,
                MICROMETRES.text(line.height_per_pixel.abs()),
            ),
        )
        .fact(
            "measuring_range",
            "measuring range",
            Cell::new(
                [range.low, range.high],
                format!("{}, from {low} to {high}", MILLIMETRES.text(range.length())),
            ),
        )
        .fact(
            "field_width",
            "field width",
            MILLIMETRES.quantity(setup.field_width()),
        )
        .fact(
            "detector",
            "detector",
            Cell::new(detector, detector.replace('_', " ")),
        )
        .fact("averages", "averages", averages(setup))
        .data("magnification", setup.magnification())
        .data("imaged_width_of_line_pixels", line.projected_thickness)
        .data("imaged_width_of_lens_pixels", line.diffraction_width)
        .data("peak_electrons", setup.peak_electrons())
        .data("column_electrons", line.column_electrons)
        .data("grain_saturation", setup.grain_saturation())
        .data("light", setup.light_level().name());
}

fn averages(setup: &Setup) -> Cell {
    let average = setup.description().average;
    let speckle = match (average.frames, average.independent_speckle) {
        (1, _) => "",
        (_, true) => ", each with its own speckle",
        (_, false) => ", all with the same speckle",
    };
    let plural = |count: u32, what: &str| match count {
        1 => format!("one {what}"),
        _ => format!("{count} {what}s"),
    };
    Cell::new(
        json!({
            "columns": average.columns,
            "frames": average.frames,
            "independent_speckle": average.independent_speckle,
        }),
        format!(
            "{} of {}{speckle}",
            plural(average.columns, "column"),
            plural(average.frames, "frame")
        ),
    )
}
