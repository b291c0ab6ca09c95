//! The report of a search.

use tem00_triangulation::{DesignFigure, DesignFigures, Neighbours};

use super::{
    Design, listing,
    units::{self, MICROMETRES, Unit},
};
use crate::{
    failure::Failure,
    report::{Report, Table},
};

/// Returns the report, with the drawings as SVG and caption, and the set-up that is shown as text.
pub(super) fn report(
    design: &Design<'_>,
    near: &[Neighbours],
    drawings: &[(String, String)],
    best: Option<&str>,
) -> Result<Report, Failure> {
    let mut report = Report::new("Design of a laser-triangulation set-up");
    report.verdict(&listing::verdict(design));
    report.heading(if design.outcome.best(1).is_empty() {
        "The nearest set-up"
    } else {
        "The best set-ups"
    });
    report.table(&best_table(design));
    let shown = design.shown()?;
    if let Some(figures) = shown.possible() {
        report.heading("What makes its heights uncertain");
        report.table(&sources(figures));
        let level = design.shown_setup()?.light_level();
        report.paragraph(&format!("Light: {}; {}.", level.name(), level.advice()));
        report.paragraph(&format!(
            "Most of it is {}: {}.",
            figures.dominant.name(),
            figures.dominant.remedy()
        ));
    }
    report.heading("Trade-offs");
    report.drawings(drawings.iter().map(|(svg, caption)| (&**svg, &**caption)));
    report.table(&sensitivities(design, near));
    report.heading("The search");
    report.facts(&facts(design));
    for line in listing::hindrances(design) {
        report.paragraph(&line);
    }
    report.heading("Files");
    if let Some(best) = best {
        report.file("best.toml", best);
    }
    report.file(&design.file.display().to_string(), &design.text);
    Ok(report)
}

fn facts<'n>(design: &Design<'_>) -> Vec<(&'n str, String)> {
    let question = design.search.question();
    let sweeps = question.sweeps.iter().map(|sweep| {
        let unit = units::of_parameter(sweep.parameter());
        let values: Vec<_> = sweep
            .values()
            .iter()
            .map(|&value| unit.text(value))
            .collect();
        let label = unit.label(sweep.parameter().name());
        format!("{label}: {}", values.join(", "))
    });
    let constraints = question.constraints.iter().map(|constraint| {
        let figure = constraint.figure;
        let bound = units::of_figure(figure).quantity(constraint.bound);
        let sign = if figure.is_gain() {
            "at least"
        } else {
            "at most"
        };
        format!("{} {sign} {bound}", units::words(figure.name()))
    });
    vec![
        ("set-up file", design.file.display().to_string()),
        ("made small", units::words(design.objective().name())),
        ("varied", sweeps.collect::<Vec<_>>().join("; ")),
        ("required", constraints.collect::<Vec<_>>().join("; ")),
        ("tried", format!("{} set-ups", design.search.count())),
    ]
}

fn best_table(design: &Design<'_>) -> Table {
    let headings = listing::headings(design);
    let headings: Vec<_> = headings.iter().map(String::as_str).collect();
    let mut table = Table::new(
        "Standard and expanded (95 %) uncertainty of a height",
        &headings,
    );
    for candidate in listing::listed(design) {
        table.row(listing::cells(design, candidate));
    }
    table
}

fn sources(figures: &DesignFigures) -> Table {
    let mut table = Table::new(
        "Standard uncertainty of a height by source, at the reference plane",
        &["source", "contribution (µm)", "share of the variance (%)"],
    );
    let share = |value: f64| 100.0 * (value / figures.uncertainty).powi(2);
    for &(source, value) in &figures.contributions {
        table.row(vec![
            source.name().to_owned(),
            MICROMETRES.text(value),
            format!("{:.1}", share(value)),
        ]);
    }
    let combined = MICROMETRES.text(figures.uncertainty);
    table.total(vec!["combined".into(), combined, "100.0".into()]);
    table
}

fn sensitivities(design: &Design<'_>, near: &[Neighbours]) -> Table {
    let objective = design.objective();
    let unit: Unit = units::of_figure(objective);
    let depth = DesignFigure::DepthOfField;
    let label = unit.label(objective.name());
    let depth_label = units::of_figure(depth).label(depth.name());
    let headings = [
        "parameter".to_owned(),
        format!("{label}, 10 % less"),
        format!("{label}, 10 % more"),
        format!("{depth_label}, 10 % less"),
        format!("{depth_label}, 10 % more"),
    ];
    let headings: Vec<_> = headings.iter().map(String::as_str).collect();
    let mut table = Table::new("What 10 % of a parameter changes", &headings);
    for neighbour in near {
        let mut cells = vec![units::words(neighbour.parameter.name())];
        for figure in [objective, depth] {
            let text = |figures: &DesignFigures| units::of_figure(figure).text(figure.of(figures));
            for side in [&neighbour.less, &neighbour.more] {
                cells.push(side.as_ref().map_or_else(|| "-".to_owned(), text));
            }
        }
        table.row(cells);
    }
    table
}
