//! The diagrams of a search.

use tem00_report::{
    plot::{
        Bars, Chart, Drawing,
        colours::{BROKEN, COMBINED, FRONT, KEPT, LESS, MORE},
        is_drawn,
    },
    report::units::MICROMETRES,
};
use tem00_triangulation::{
    Candidate, DesignFigure, DesignFigures, Neighbours, SetupQuantity, Spacing, Sweep,
    UncertaintySource,
};

use super::search::Design;
use crate::source_colours;
use crate::units;

/// The maximum number of dots in a diagram.
const MAX_DOTS: usize = 4_000;

/// A drawing with the name of its file and its caption.
pub(super) struct Named {
    pub(super) name: String,
    pub(super) caption: String,
    pub(super) drawing: Drawing,
}

/// Draws all diagrams.
pub(super) fn all(design: &Design<'_>, near: &[Neighbours]) -> Vec<Named> {
    let sweeps = design.search.question().sweeps.iter();
    let curves = sweeps
        .filter(|sweep| sweep.values().len() > 1)
        .map(|sweep| over(design, sweep));
    let mut drawings = vec![trade_off(design)];
    drawings.extend(curves);
    drawings.push(sensitivity(design, near));
    drawings
}

/// Uncertainty against depth of field.
fn trade_off(design: &Design<'_>) -> Named {
    let (objective, depth) = (design.objective(), DesignFigure::DepthOfField);
    let [x, y] = [depth, objective].map(|figure| units::shown(figure.unit()));
    let place = |figures: &DesignFigures| {
        (
            x.of(depth.value_in(figures)),
            y.of(objective.value_in(figures)),
        )
    };
    let dots = |allowed: bool| {
        let candidates = design.outcome.candidates().iter();
        let kind = candidates.filter(move |candidate| candidate.broken.is_empty() == allowed);
        let thinned =
            kind.filter(|candidate| is_drawn(candidate.index, design.search.count(), MAX_DOTS));
        thinned.filter_map(Candidate::possible).map(place)
    };
    let front = design.outcome.front(depth);
    let labels = [
        units::label(depth.unit(), depth.name()),
        units::label(objective.unit(), objective.name()),
    ];
    let chart = Chart::new("Cost of depth of field", [&labels[0], &labels[1]])
        .dots("break a constraint", dots(false))
        .coloured(BROKEN)
        .dots("keep every constraint", dots(true))
        .coloured(KEPT)
        .line(
            "front",
            front
                .iter()
                .filter_map(|candidate| candidate.possible())
                .map(place),
        )
        .coloured(FRONT);
    Named {
        name: "trade_off".into(),
        caption:
            "The set-ups that are possible, 4000 of them at most; on the front, more depth of \
                  field costs more uncertainty."
                .into(),
        drawing: chart.log_x().log_y().draw(),
    }
}

/// The uncertainty over one parameter, by source, the others as in the set-up that is shown.
fn over(design: &Design<'_>, sweep: &Sweep) -> Named {
    let parameter = sweep.parameter();
    let unit = units::shown(parameter.unit());
    let label = units::label(parameter.unit(), parameter.key());
    let slice = slice(design, parameter);
    let curve = |value: &dyn Fn(&DesignFigures) -> f64| -> Vec<(f64, f64)> {
        let height = |figures: &DesignFigures| MICROMETRES.of(value(figures));
        let point = |(x, figures): &(f64, Option<&DesignFigures>)| {
            (unit.of(*x), figures.map_or(f64::NAN, height))
        };
        slice.iter().map(point).collect()
    };
    let mut chart = Chart::new(
        &format!("Uncertainty over {}", units::words(parameter.key())),
        [&label, "standard uncertainty (µm)"],
    )
    .line("combined", curve(&|figures| figures.uncertainty))
    .coloured(COMBINED);
    for source in sources(&slice) {
        chart = chart
            .line(source.name(), curve(&|figures| figures_of(figures, source)))
            .coloured(source_colours::of_source(source));
    }
    let chart = if spacing(sweep) == Spacing::Logarithmic {
        chart.log_x()
    } else {
        chart
    };
    Named {
        name: format!("over_{}", parameter.key()),
        caption: format!(
            "The standard uncertainty of a height over {}, all else as in the set-up shown, and \
             what the sources contribute.",
            units::words(parameter.key())
        ),
        drawing: chart.log_y().draw(),
    }
}

/// Returns the set-ups that differ from the one shown only in this parameter, in its order; set-ups
/// that are not possible have no figures.
fn slice<'a>(
    design: &'a Design<'_>,
    parameter: SetupQuantity,
) -> Vec<(f64, Option<&'a DesignFigures>)> {
    let Some(shown) = design.shown() else {
        return Vec::new();
    };
    let same = |candidate: &&Candidate| {
        let mut same = candidate.description.clone();
        parameter.set(&mut same, parameter.value_in(&shown.description));
        same == shown.description
    };
    let candidates = design.outcome.candidates().iter().filter(same);
    let mut slice: Vec<_> = candidates
        .map(|candidate| {
            (
                parameter.value_in(&candidate.description),
                candidate.possible(),
            )
        })
        .collect();
    slice.sort_by(|a, b| a.0.total_cmp(&b.0));
    slice
}

/// Returns the sources that matter: sources that are somewhere a hundredth of the combined
/// uncertainty.
fn sources(slice: &[(f64, Option<&DesignFigures>)]) -> Vec<UncertaintySource> {
    let possible = || slice.iter().filter_map(|(_, figures)| *figures);
    let Some(first) = possible().next() else {
        return Vec::new();
    };
    let matters = |&source: &UncertaintySource| {
        let share = |figures: &DesignFigures| figures_of(figures, source) / figures.uncertainty;
        possible().any(|figures| share(figures) > 0.01)
    };
    let sources = first.contributions.iter().map(|&(source, _)| source);
    sources.filter(matters).collect()
}

fn figures_of(figures: &DesignFigures, source: UncertaintySource) -> f64 {
    let mut contributions = figures.contributions.iter();
    contributions
        .find(|(name, _)| *name == source)
        .map_or(0.0, |&(_, value)| value)
}

/// Returns which axis suits the values: ratios that are more alike than differences.
fn spacing(sweep: &Sweep) -> Spacing {
    let values = sweep.values();
    let (min, max) = values
        .iter()
        .fold((f64::MAX, 0.0_f64), |(low, high), &value| {
            (low.min(value), high.max(value))
        });
    if max >= 4.0 * min {
        Spacing::Logarithmic
    } else {
        Spacing::Linear
    }
}

/// The change by a tenth more or less of each parameter.
fn sensitivity(design: &Design<'_>, near: &[Neighbours]) -> Named {
    let objective = design.objective();
    let now = design.shown().and_then(Candidate::possible);
    let now = now.map_or(f64::NAN, |figures| objective.value_in(figures));
    let change = |figures: Option<&DesignFigures>| {
        figures.map_or(f64::NAN, |figures| {
            100.0 * (objective.value_in(figures) / now - 1.0)
        })
    };
    let name = units::words(objective.name());
    let mut bars = Bars::new(
        "What 10 % of a parameter changes",
        &format!("change of the {name} (%)"),
        &[("10 % less", LESS), ("10 % more", MORE)],
    );
    for neighbour in near {
        let changes = [&neighbour.less, &neighbour.more].map(|figures| change(figures.as_ref()));
        bars = bars.group(&units::words(neighbour.parameter.key()), &changes);
    }
    Named {
        name: "sensitivity".into(),
        caption: format!(
            "By how much the {name} of the set-up shown changes with 10 % less and 10 % more of \
             each parameter alone; no bar: infeasible, or no effect."
        ),
        drawing: bars.draw(),
    }
}
