//! The drawings of a budget.

use tem00_report::plot::{
    Bars, Chart, Colour, Drawing,
    colours::{FORMULAS, TRIALS},
};

use super::findings::Answer;

const METRES_TO_MICROMETRES: f64 = 1e6;
const METRES_TO_MILLIMETRES: f64 = 1e3;

/// The contribution of each source, by formulas and, unless they were left out, by trials.
pub(super) fn contributions(answer: &Answer) -> Drawing {
    let series: &[(&str, Colour)] = match answer.trials {
        Some(_) => &[("formulas", FORMULAS), ("trials", TRIALS)],
        None => &[("formulas", FORMULAS)],
    };
    let label = "standard uncertainty of a height (µm)";
    let mut bars = Bars::new("Sources of height uncertainty", label, series);
    let trials = answer.trials.as_ref();
    for term in answer.budget.terms() {
        let mut values = vec![term.contribution() * METRES_TO_MICROMETRES];
        if let Some(trials) = trials {
            let found = trials.term(term.source);
            values.push(found.map_or(f64::NAN, |found| found.uncertainty * METRES_TO_MICROMETRES));
        }
        bars = bars.group(term.source.name(), &values);
    }
    let mut combined = vec![answer.budget.combined() * METRES_TO_MICROMETRES];
    combined.extend(
        answer
            .combined_by_trials()
            .map(|found| found * METRES_TO_MICROMETRES),
    );
    bars.group("combined", &combined).draw()
}

/// The combined uncertainty over the heights that can be measured.
pub(super) fn over_range(answer: &Answer) -> Drawing {
    let heights = answer.over_range.iter();
    let points = heights.map(|&(height, uncertainty)| {
        (
            height * METRES_TO_MILLIMETRES,
            uncertainty.map_or(f64::NAN, |found| found * METRES_TO_MICROMETRES),
        )
    });
    Chart::new(
        "Uncertainty over the measuring range",
        ["height (mm)", "standard uncertainty (µm)"],
    )
    .line("", points.collect::<Vec<_>>())
    .coloured(FORMULAS)
    .draw()
}
