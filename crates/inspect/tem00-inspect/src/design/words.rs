//! A search in sentences.

use tem00_report::failure::Failure;
use tem00_triangulation::{Budget, Exclusion};

use super::search::Design;
use crate::units;

/// Returns the conclusion of the search, in a sentence.
pub(super) fn verdict(design: &Design<'_>) -> String {
    let (possible, allowed) = design.outcome.counts();
    let tried = design.search.count();
    let counts =
        format!("{tried} set-ups tried, {possible} possible, {allowed} keep every constraint");
    match design.winner().and_then(|candidate| candidate.allowed()) {
        Some(figures) => {
            let objective = design.objective();
            let value = units::shown(objective.unit()).text(objective.value_in(figures));
            let name = units::words(objective.name());
            let dominant = figures.dominant.name();
            let thin = if figures.speckles < Budget::LEAST_SPECKLES {
                " Its line is below two speckles wide, where formulas do not hold: ask the trials \
                 of `tem00-inspect budget`."
            } else {
                ""
            };
            format!("{counts}. The best: {name} {value}, most of it by {dominant}.{thin}")
        }
        None => format!("{counts}. The nearest to them is shown."),
    }
}

/// Returns what excludes set-ups: a line for set-ups that are not possible, and one for each
/// constraint that excludes any.
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
    let bound = units::shown(figure.unit()).text(exclusion.constraint.bound);
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

/// Returns why the search has no result.
pub(super) fn nothing(design: &Design<'_>) -> Failure {
    let name = design.file.display();
    let why = hindrances(design).join("; ");
    let (possible, _) = design.outcome.counts();
    if possible == 0 {
        return Failure::no_result(
            format!(
                "{name}: none of the {} set-ups is possible: {why}",
                design.search.count()
            ),
            "change the values in [design.vary], or the set-up that the search begins with",
        );
    }
    Failure::no_result(
        format!(
            "{name}: none of the {possible} set-ups that are possible keeps every constraint: {why}"
        ),
        "relax [design.require] or widen [design.vary]; design.html shows the set-up that comes \
         nearest",
    )
}
