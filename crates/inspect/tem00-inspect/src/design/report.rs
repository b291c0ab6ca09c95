//! The report of a search.

use serde_json::{Map, Value, json};
use tem00_report::{
    failure::Failure,
    report::{
        Cell, Column, Report, Section, Table,
        units::{MICROMETRES, NUMBER, PERCENT},
    },
};
use tem00_triangulation::{BandwidthEffect, Candidate, DesignFigure, DesignFigures, Neighbours};

use super::{search::Design, words};
use crate::bandwidth::bandwidth;
use crate::units;

/// The figures of a listing; programs get all.
const LISTED: [DesignFigure; 6] = [
    DesignFigure::Uncertainty,
    DesignFigure::ExpandedUncertainty,
    DesignFigure::Range,
    DesignFigure::DepthOfField,
    DesignFigure::Saturation,
    DesignFigure::GrainSaturation,
];

/// Returns the report, with the drawings and their captions, and the best set-up as text.
pub(super) fn report(
    design: &Design<'_>,
    near: &[Neighbours],
    drawings: Vec<(String, String)>,
    best: Option<&str>,
) -> Result<Report, Failure> {
    let mut report = Report::new("Design of a laser-triangulation set-up");
    let (possible, allowed) = design.outcome.counts();
    let file = design.file.display().to_string();
    report.data("setup", &file);
    report.data("objective", design.objective().name());
    report.data("tried", design.search.count());
    report.data("possible", possible);
    report.data("allowed", allowed);
    let front = design.outcome.front(DesignFigure::DepthOfField);
    report.data(
        "front",
        front.iter().map(|found| found.index).collect::<Vec<_>>(),
    );
    report.verdict(words::verdict(design));
    words::hindrances(design)
        .into_iter()
        .for_each(|line| report.verdict(line));
    if !design.is_exact {
        report.note(
            "The uncertain values of the set-up are taken at their best estimates: the search \
             knows the noise alone, and best.toml has no uncertainties.",
        );
    }

    list(&mut report, design);
    if let Some((shown, figures)) = design
        .shown()
        .and_then(|shown| Some((shown, shown.possible()?)))
    {
        let setup = Design::setup_of(shown)?;
        let level = setup.light_level();
        let section = report
            .section("What makes its heights uncertain")
            .in_detail()
            .fact(
                "bandwidth",
                "linewidth and extent of the source",
                bandwidth(&setup),
            );
        section.table(sources(figures)).paragraph(format!(
            "Light: {}; {}.",
            level.name(),
            level.advice()
        ));
        section.paragraph(format!(
            "Most of it is {}: {}.",
            figures.dominant.name(),
            figures.dominant.remedy()
        ));
    }
    let section = report.section("Trade-offs").in_detail();
    for (svg, caption) in drawings {
        section.drawing(svg, caption);
    }
    section.table(sensitivities(design, near));
    search(report.section("The search").in_detail(), design);
    let section = report.section("Files").in_detail();
    if let Some(best) = best {
        section.file("best.toml", best);
    }
    section.file(file, &design.text);
    Ok(report)
}

/// Adds the best set-ups, or only the nearest one.
fn list(report: &mut Report, design: &Design<'_>) {
    let best = design.outcome.best(design.listed);
    let (heading, key, others, listed) = if best.is_empty() {
        let nearest = design.outcome.nearest().into_iter().collect();
        ("The nearest set-up", "nearest", "best", nearest)
    } else {
        ("The best set-ups", "best", "nearest", best)
    };
    report.data(others, json!([]));
    let figures = figures(design);
    let columns = columns(design, &figures, &listed);
    let mut table = Table::new(
        "Standard and expanded (95 %) uncertainty of a height at the reference plane",
        columns,
    );
    for candidate in listed {
        table.row(cells(design, &figures, candidate));
    }
    report.section(heading).table(table.under(key));
}

/// Returns the figures, with the figures of a listing first. A varied quantity may be a figure as
/// well, and then has its column already.
fn figures(design: &Design<'_>) -> Vec<DesignFigure> {
    let others = DesignFigure::ALL
        .into_iter()
        .filter(|figure| !LISTED.contains(figure));
    let is_varied = |figure: &DesignFigure| {
        let mut sweeps = design.search.question().sweeps.iter();
        sweeps.any(|sweep| sweep.parameter().key() == figure.name())
    };
    LISTED
        .into_iter()
        .chain(others)
        .filter(|figure| !is_varied(figure))
        .collect()
}

fn columns(design: &Design<'_>, figures: &[DesignFigure], listed: &[&Candidate]) -> Vec<Column> {
    let sweeps = design.search.question().sweeps.iter();
    let varied = sweeps.map(|sweep| {
        let parameter = sweep.parameter();
        let label = units::label(parameter.unit(), parameter.key());
        Column::new(parameter.key(), label)
    });
    let figures = figures.iter().map(|&figure| {
        let label = units::label(figure.unit(), figure.name());
        if LISTED.contains(&figure) {
            Column::new(figure.name(), label)
        } else {
            Column::data(figure.name())
        }
    });
    let is_broad = |found: &&Candidate| {
        let effect = found.possible().map(|figures| figures.bandwidth);
        effect.is_some_and(|effect| effect != BandwidthEffect::NONE)
    };
    let is_broad = listed.iter().any(is_broad);
    let ratio = |key, label: &str| match is_broad {
        true => Column::new(key, label),
        false => Column::data(key),
    };
    let last = [
        ratio("line_noise_ratio", "line noise over one wavelength"),
        ratio("contrast_ratio", "contrast over one wavelength"),
        Column::new("dominant", "dominated by"),
        Column::data("contributions"),
        Column::data("imaged_width_pixels"),
        Column::data("speckle_size_pixels"),
        Column::data("broken"),
    ];
    // Only parts that let light in have the column.
    let subsurface = design
        .lets_light_in()
        .then(|| Column::new("subsurface_height", "height without correction (µm)"));
    [Column::new("number", "number")]
        .into_iter()
        .chain(varied)
        .chain(figures)
        .chain(subsurface)
        .chain(last)
        .collect()
}

fn cells(design: &Design<'_>, figures: &[DesignFigure], candidate: &Candidate) -> Vec<Cell> {
    let sweeps = design.search.question().sweeps.iter();
    let varied = sweeps.map(|sweep| {
        let parameter = sweep.parameter();
        units::shown(parameter.unit()).cell(parameter.value_in(&candidate.description))
    });
    let mut cells: Vec<_> = [candidate.index.into()].into_iter().chain(varied).collect();
    let found = match &candidate.figures {
        Ok(found) => found,
        Err(why) => {
            cells.push(Cell::missing(why.to_string()));
            return cells;
        }
    };
    cells.extend(
        figures
            .iter()
            .map(|figure| units::shown(figure.unit()).cell(figure.value_in(found))),
    );
    let shift = found.subsurface.map(|shift| MICROMETRES.cell(shift.height));
    cells.extend(shift);
    let contributions: Map<String, Value> = found
        .contributions
        .iter()
        .map(|(source, value)| (source.name().to_owned(), json!(value)))
        .collect();
    let broken = candidate
        .broken
        .iter()
        .map(|constraint| constraint.figure.name());
    let ratio = NUMBER.with_digits(3);
    cells.extend([
        ratio.cell(found.bandwidth.line_noise_ratio),
        ratio.cell(found.bandwidth.contrast),
        found.dominant.name().into(),
        Cell::new(contributions, ""),
        Cell::new(found.imaged_width, ""),
        Cell::new(found.speckle_size, ""),
        Cell::new(broken.collect::<Vec<_>>(), ""),
    ]);
    cells
}

fn sources(figures: &DesignFigures) -> Table {
    let columns = [
        Column::new("source", "source"),
        Column::new("contribution", "contribution (µm)"),
        Column::new("variance_fraction", "part of u² (%)"),
    ];
    let caption = "Standard uncertainty of a height by source, at the reference plane";
    let mut table = Table::new(caption, columns).under("contributions");
    let fraction = |value: f64| (value / figures.uncertainty).powi(2);
    for &(source, value) in &figures.contributions {
        table.row([
            source.name().into(),
            MICROMETRES.cell(value),
            PERCENT.with_digits(3).cell(fraction(value)),
        ]);
    }
    table.total([
        "combined".into(),
        MICROMETRES.cell(figures.uncertainty),
        PERCENT.cell(1.0),
    ]);
    table
}

fn sensitivities(design: &Design<'_>, near: &[Neighbours]) -> Table {
    let figures = [design.objective(), DesignFigure::DepthOfField];
    let columns = figures.into_iter().flat_map(|figure| {
        let label = units::label(figure.unit(), figure.name());
        let name = figure.name();
        [("less", "10 % less"), ("more", "10 % more")]
            .map(|(key, words)| Column::new(format!("{name}_{key}"), format!("{label}, {words}")))
    });
    let first = [Column::new("parameter", "parameter")];
    let columns: Vec<_> = first.into_iter().chain(columns).collect();
    let mut table = Table::new("What 10 % of a parameter changes", columns).under("sensitivities");
    for neighbour in near {
        let name = neighbour.parameter.key();
        let mut cells = vec![Cell::new(name, units::words(name))];
        for figure in figures {
            for side in [&neighbour.less, &neighbour.more] {
                let cell = |found: &DesignFigures| {
                    units::shown(figure.unit()).cell(figure.value_in(found))
                };
                cells.push(Cell::or_dash(side.as_ref().map(cell)));
            }
        }
        table.row(cells);
    }
    table
}

/// Adds the searched values, and the number of set-ups that each constraint excludes.
fn search(section: &mut Section, design: &Design<'_>) {
    let sweeps = design.search.question().sweeps.iter();
    let texts = sweeps.clone().map(|sweep| {
        let unit = units::shown(sweep.parameter().unit());
        let values = sweep
            .values()
            .iter()
            .map(|&value| unit.cell(value).text().to_owned());
        let label = units::label(sweep.parameter().unit(), sweep.parameter().key());
        format!("{label}: {}", values.collect::<Vec<_>>().join(", "))
    });
    let text = texts.collect::<Vec<_>>().join("; ");
    let varied: Map<String, Value> = sweeps
        .map(|sweep| (sweep.parameter().key().to_owned(), json!(sweep.values())))
        .collect();
    let columns = [
        Column::new("figure", "figure"),
        Column::new("relation", "required"),
        Column::new("bound", "bound"),
        Column::new("excluded", "set-ups excluded"),
        Column::new("excluded_alone", "by it alone"),
    ];
    let mut table = Table::new("What the constraints exclude", columns).under("constraints");
    for exclusion in design.outcome.exclusions() {
        let figure = exclusion.constraint.figure;
        table.row([
            Cell::new(figure.name(), units::words(figure.name())),
            if figure.is_gain() {
                Cell::new("at_least", "at least")
            } else {
                Cell::new("at_most", "at most")
            },
            units::shown(figure.unit()).quantity(exclusion.constraint.bound),
            exclusion.excluded.into(),
            exclusion.alone.into(),
        ]);
    }
    section
        .fact("varied", "varied", Cell::new(varied, text))
        .table(table);
}
