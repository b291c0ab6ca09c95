//! The drawings of a budget.

use tem00_report::{
    plot::{
        Bars, Chart, Colour, Drawing,
        colours::{FORMULAS, TRIALS},
    },
    report::units::{MICROMETRES, MILLIMETRES},
};

use super::findings::Answer;

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
        let mut values = vec![MICROMETRES.of(term.contribution())];
        if let Some(trials) = trials {
            let found = trials.term(term.source);
            values.push(found.map_or(f64::NAN, |found| MICROMETRES.of(found.uncertainty)));
        }
        bars = bars.group(term.source.name(), &values);
    }
    let mut combined = vec![answer.budget.combined()];
    combined.extend(answer.combined_by_trials());
    let combined: Vec<f64> = combined.into_iter().map(|u| MICROMETRES.of(u)).collect();
    bars.group("combined", &combined).draw()
}

/// The combined uncertainty over the heights that can be measured.
pub(super) fn over_range(answer: &Answer) -> Drawing {
    let heights = answer.over_range.iter();
    let points = heights.map(|&(height, uncertainty)| {
        (
            MILLIMETRES.of(height),
            uncertainty.map_or(f64::NAN, |found| MICROMETRES.of(found)),
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
