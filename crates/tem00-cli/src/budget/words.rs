//! A budget in sentences.

use tem00_triangulation::{LightLevel, Setup};

use super::{
    answers,
    findings::{Answer, Refusal},
};
use crate::report::units::{MICROMETRES, NUMBER, PERCENT};

/// Returns what the budget comes to.
pub(super) fn verdicts(answer: &Answer, setup: &Setup) -> Vec<String> {
    let level = setup.light_level();
    let budget = &answer.budget;
    let dominant = budget.dominant();
    let mut lines = answer
        .measured
        .as_ref()
        .map_or_else(Vec::new, answers::verdicts);
    lines.extend([
        result(answer),
        format!(
            "{} dominates, with {} of the variance: {}.",
            capitalised(dominant.source.name()),
            PERCENT
                .with_digits(3)
                .text(budget.variance_fraction(dominant)),
            dominant.source.remedy()
        ),
        format!(
            "Speckle by closed forms: {} for the line that a lens images, {} for a spot after Dorsch, Häusler \
             and Herrmann.",
            MICROMETRES.text(budget.line_law()),
            MICROMETRES.text(budget.dorsch())
        ),
    ]);
    if level != LightLevel::Good {
        lines.push(format!("The light is not right: {}.", level.advice()));
    }
    lines.extend(of_trials(answer));
    lines
}

/// Returns why there is no budget, and what to change.
pub(super) fn refusal(refusal: &Refusal) -> [String; 2] {
    [
        format!("Nothing can be measured with this set-up: {}.", refusal.why),
        format!("{}.", capitalised(refusal.advice)),
    ]
}

/// Returns the result, with the expanded uncertainty.
fn result(answer: &Answer) -> String {
    let budget = &answer.budget;
    let by_trials = answer.combined_by_trials().map(|found| {
        let expanded = budget.coverage_factor() * found;
        format!(" By trials {}.", MICROMETRES.text(expanded))
    });
    let exact = match answer.measured {
        Some(_) => " at the reference plane, of a set-up that is known exactly",
        None => "",
    };
    format!(
        "Expanded uncertainty of a height{exact}: U = {} (95 %, k = {:.2}).{}",
        MICROMETRES.text(budget.expanded()),
        budget.coverage_factor(),
        by_trials.unwrap_or_default()
    )
}

/// Returns what trials tell that formulas do not.
fn of_trials(answer: &Answer) -> Vec<String> {
    let Some((trials, combined)) = answer.trials.as_ref().zip(answer.combined_by_trials()) else {
        return Vec::new();
    };
    let mut lines = Vec::new();
    let ratio = combined / answer.budget.combined();
    if !(0.9..=1.1).contains(&ratio) {
        lines.push(format!(
            "Trials find {} times the uncertainty of the formulas, which are first order: this detector is not \
             linear under so much noise; go by the trials.",
            NUMBER.with_digits(3).text(ratio)
        ));
    }
    if trials.invalid() > 0.01 {
        lines.push(format!(
            "{} of the columns have no line that can be trusted; the trials leave them out.",
            PERCENT.with_digits(2).text(trials.invalid())
        ));
    }
    lines
}

/// Begins text as a sentence.
fn capitalised(text: &str) -> String {
    let mut letters = text.chars();
    let first = letters.next().map(char::to_uppercase);
    first.into_iter().flatten().chain(letters).collect()
}
