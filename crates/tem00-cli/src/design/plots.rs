//! The diagrams of a search.

use tem00_triangulation::{
    Candidate, DesignFigure, DesignFigures, DesignParameter, Neighbours, Spacing, Sweep,
    UncertaintySource,
};

use super::{
    Design,
    units::{self, MICROMETRES},
};
use crate::plot::{Bars, Chart, Drawing};

/// The most dots in a diagram.
const MOST_DOTS: usize = 4_000;

const FAINT: &str = "#b8bec6";
const ALLOWED: &str = "#1f5fa8";
const FRONT: &str = "#d2701a";

/// A drawing with the name of its file and its caption.
pub(super) struct Named {
    pub(super) name: String,
    pub(super) caption: String,
    pub(super) drawing: Drawing,
}

/// Draws all of them.
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
    let [x, y] = [depth, objective].map(units::of_figure);
    let place = |figures: &DesignFigures| (x.of(depth.of(figures)), y.of(objective.of(figures)));
    let dots = |allowed: bool| {
        let candidates = design.outcome.candidates().iter();
        let kind = candidates.filter(move |candidate| candidate.broken.is_empty() == allowed);
        let thinned = kind.filter(|candidate| is_drawn(candidate.index, design.search.count()));
        thinned.filter_map(Candidate::possible).map(place)
    };
    let front = design.outcome.front(depth);
    let labels = [x.label(depth.name()), y.label(objective.name())];
    let chart = Chart::new("What depth of field costs", [&labels[0], &labels[1]])
        .dots("break a constraint", dots(false))
        .coloured(FAINT)
        .dots("keep every constraint", dots(true))
        .coloured(ALLOWED)
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

/// Returns whether a set-up is among the dots of a diagram: all are if they are few, and of many a part
/// that is even over all parameters, which multiples of the golden ratio are.
#[expect(clippy::cast_precision_loss, reason = "far below 2⁵²")]
fn is_drawn(index: usize, count: usize) -> bool {
    const GOLDEN: f64 = 0.618_033_988_749_894_9;
    (GOLDEN * index as f64).fract() * count as f64 <= MOST_DOTS as f64
}

/// The uncertainty over one parameter, by source, the others as in the set-up that is shown.
fn over(design: &Design<'_>, sweep: &Sweep) -> Named {
    let parameter = sweep.parameter();
    let unit = units::of_parameter(parameter);
    let label = unit.label(parameter.name());
    let slice = slice(design, parameter);
    let curve = |value: &dyn Fn(&DesignFigures) -> f64| -> Vec<(f64, f64)> {
        let point =
            |(x, figures): &(f64, &DesignFigures)| (unit.of(*x), MICROMETRES.of(value(figures)));
        slice.iter().map(point).collect()
    };
    let mut chart = Chart::new(
        &format!("Uncertainty over {}", units::words(parameter.name())),
        [&label, "standard uncertainty (µm)"],
    )
    .line("combined", curve(&|figures| figures.uncertainty))
    .coloured("#202020");
    for source in sources(&slice) {
        chart = chart.line(source.name(), curve(&|figures| figures_of(figures, source)));
    }
    let chart = if spacing(sweep) == Spacing::Logarithmic {
        chart.log_x()
    } else {
        chart
    };
    Named {
        name: format!("over_{}", parameter.name()),
        caption: format!(
            "The standard uncertainty of a height over {}, all else as in the set-up shown, and what \
             the sources contribute.",
            units::words(parameter.name())
        ),
        drawing: chart.log_y().draw(),
    }
}

/// Returns the set-ups that differ from the one shown in this parameter alone, in its order.
fn slice<'a>(design: &'a Design<'_>, parameter: DesignParameter) -> Vec<(f64, &'a DesignFigures)> {
    let Ok(shown) = design.shown() else {
        return Vec::new();
    };
    let same = |candidate: &&Candidate| {
        let value = parameter.of(&shown.description);
        parameter.set(&candidate.description, value) == shown.description
    };
    let candidates = design.outcome.candidates().iter().filter(same);
    let mut slice: Vec<_> = candidates
        .filter_map(|candidate| Some((parameter.of(&candidate.description), candidate.possible()?)))
        .collect();
    slice.sort_by(|a, b| a.0.total_cmp(&b.0));
    slice
}

/// Returns the sources that matter: those that are somewhere a hundredth of the combined uncertainty.
fn sources(slice: &[(f64, &DesignFigures)]) -> Vec<UncertaintySource> {
    let Some((_, first)) = slice.first() else {
        return Vec::new();
    };
    let matters = |&source: &UncertaintySource| {
        let share = |figures: &DesignFigures| figures_of(figures, source) / figures.uncertainty;
        slice.iter().any(|(_, figures)| share(figures) > 0.01)
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
    let (least, most) = values
        .iter()
        .fold((f64::MAX, 0.0_f64), |(low, high), &value| {
            (low.min(value), high.max(value))
        });
    if most >= 4.0 * least {
        Spacing::Logarithmic
    } else {
        Spacing::Linear
    }
}

/// What a tenth more or less of each parameter makes.
fn sensitivity(design: &Design<'_>, near: &[Neighbours]) -> Named {
    let objective = design.objective();
    let now = design.shown().ok().and_then(Candidate::possible);
    let now = now.map_or(f64::NAN, |figures| objective.of(figures));
    let change = |figures: Option<&DesignFigures>| {
        figures.map_or(f64::NAN, |figures| {
            100.0 * (objective.of(figures) / now - 1.0)
        })
    };
    let name = units::words(objective.name());
    let mut bars = Bars::new(
        "What 10 % of a parameter changes",
        &format!("change of the {name} (%)"),
        &["10 % less", "10 % more"],
    );
    for neighbour in near {
        let changes = [&neighbour.less, &neighbour.more].map(|figures| change(figures.as_ref()));
        bars = bars.group(&units::words(neighbour.parameter.name()), &changes);
    }
    Named {
        name: "sensitivity".into(),
        caption: format!(
            "By how much the {name} of the set-up shown changes with 10 % less and 10 % more of each \
             parameter alone; without a bar, that is not possible or nothing changes."
        ),
        drawing: bars.draw(),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn few_set_ups_are_all_drawn_and_of_many_an_even_part() {
        assert!(
            (0..MOST_DOTS).all(|index| is_drawn(index, MOST_DOTS)),
            "few"
        );
        let count = 200_000;
        // Of each tenth, as a parameter of ten values has them, a tenth: to a few by the discrepancy
        // of the golden ratio, 1 + log₂ of the number.
        for remainder in 0..10 {
            let tenth = (0..count).filter(|index| index % 10 == remainder);
            let drawn = tenth.filter(|&index| is_drawn(index, count)).count();
            assert!(drawn.abs_diff(MOST_DOTS / 10) <= 18, "{remainder}: {drawn}");
        }
    }
}
