//! What a search tells on standard output.

use std::io::{self, Write};

use tem00_triangulation::{Candidate, DesignFigure, DesignFigures, Exclusion};

use super::{Design, units};
use crate::{failure::Failure, table::write_columns};

/// The figures of a listing, beside the objective.
const FIGURES: [DesignFigure; 4] = [
    DesignFigure::Range,
    DesignFigure::DepthOfField,
    DesignFigure::Saturation,
    DesignFigure::GrainSaturation,
];

/// Prints the best set-ups, or why there are none.
pub(super) fn print(design: &Design<'_>, out: &mut impl Write) -> Result<(), Failure> {
    write(design, out).map_err(|error| Failure::stdout(&error))
}

fn write(design: &Design<'_>, out: &mut impl Write) -> io::Result<()> {
    writeln!(out, "{}", verdict(design))?;
    for line in hindrances(design) {
        writeln!(out, "{line}")?;
    }
    writeln!(out)?;
    let mut lines = vec![headings(design)];
    lines.extend(
        listed(design)
            .into_iter()
            .map(|candidate| cells(design, candidate)),
    );
    write_columns(&lines, out)?;
    writeln!(out)
}

/// Returns what is listed: the best, or the nearest alone.
pub(super) fn listed<'a>(design: &'a Design<'_>) -> Vec<&'a Candidate> {
    let best = design.outcome.best(design.most);
    if best.is_empty() {
        design.outcome.nearest().into_iter().collect()
    } else {
        best
    }
}

/// Returns what the search comes to, in a sentence.
pub(super) fn verdict(design: &Design<'_>) -> String {
    let (possible, allowed) = design.outcome.counts();
    let tried = design.search.count();
    let counts =
        format!("{tried} set-ups tried, {possible} possible, {allowed} keep every constraint");
    let best = design.outcome.best(1);
    match best.first().and_then(|candidate| candidate.allowed()) {
        Some(figures) => {
            let objective = design.objective();
            let value = units::of_figure(objective).quantity(objective.of(figures));
            let name = units::words(objective.name());
            let dominant = figures.dominant.name();
            format!("{counts}. The best: {name} {value}, most of it by {dominant}.")
        }
        None => format!("{counts}. The nearest to them is shown."),
    }
}

/// Returns what keeps set-ups out: a line for those that are not possible, and one for each constraint
/// that excludes any.
pub(super) fn hindrances(design: &Design<'_>) -> Vec<String> {
    let exclusions = design.outcome.exclusions().into_iter();
    let some = exclusions.filter(|exclusion| exclusion.excluded > 0);
    impossible(design)
        .into_iter()
        .chain(some.map(line))
        .collect()
}

fn line(exclusion: Exclusion) -> String {
    let figure = exclusion.constraint.figure;
    let bound = units::of_figure(figure).quantity(exclusion.constraint.bound);
    let sign = if figure.is_gain() { "≥" } else { "≤" };
    let name = units::words(figure.name());
    format!(
        "{name} {sign} {bound} excludes {}, {} of them alone",
        exclusion.excluded, exclusion.alone
    )
}

/// Returns how many set-ups are not possible, with the reason of the first.
fn impossible(design: &Design<'_>) -> Option<String> {
    let candidates = design.outcome.candidates().iter();
    let mut why =
        candidates.filter_map(|candidate| Some((candidate, candidate.figures.as_ref().err()?)));
    let (first, error) = why.next()?;
    let count = 1 + why.count();
    Some(format!(
        "{count} not possible; the first, number {}: {error}",
        first.index
    ))
}

/// Returns the headings of a listing.
pub(super) fn headings(design: &Design<'_>) -> Vec<String> {
    let sweeps = design.search.question().sweeps.iter();
    let varied = sweeps.map(|sweep| {
        let parameter = sweep.parameter();
        units::of_parameter(parameter).label(parameter.name())
    });
    let figures = [DesignFigure::Uncertainty, DesignFigure::ExpandedUncertainty];
    let figures = figures.into_iter().chain(FIGURES);
    let figures = figures.map(|figure| units::of_figure(figure).label(figure.name()));
    let mut headings: Vec<_> = ["number".to_owned()]
        .into_iter()
        .chain(varied)
        .chain(figures)
        .collect();
    headings.push("dominated by".into());
    headings
}

/// Returns the cells of a set-up in a listing.
pub(super) fn cells(design: &Design<'_>, candidate: &Candidate) -> Vec<String> {
    let sweeps = design.search.question().sweeps.iter();
    let varied = sweeps.map(|sweep| {
        let parameter = sweep.parameter();
        units::of_parameter(parameter).text(parameter.of(&candidate.description))
    });
    let mut cells: Vec<_> = [candidate.index.to_string()]
        .into_iter()
        .chain(varied)
        .collect();
    match &candidate.figures {
        Ok(figures) => cells.extend(figure_cells(figures)),
        Err(why) => cells.push(why.to_string()),
    }
    cells
}

fn figure_cells(figures: &DesignFigures) -> Vec<String> {
    let shown = [DesignFigure::Uncertainty, DesignFigure::ExpandedUncertainty];
    let shown = shown.into_iter().chain(FIGURES);
    let texts = shown.map(|figure| units::of_figure(figure).text(figure.of(figures)));
    texts.chain([figures.dominant.name().to_owned()]).collect()
}
