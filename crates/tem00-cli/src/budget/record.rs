//! A budget as JSON.

use serde_json::{Map, Value, json};
use tem00_triangulation::{BudgetTerm, Simulation};

use super::{Answer, Findings, Refusal};
use crate::failure::Failure;

/// Returns the budget as text, in SI units.
pub(super) fn text(findings: &Findings<'_>) -> Result<String, Failure> {
    serde_json::to_string_pretty(&value(findings))
        .map_err(|error| Failure::running(format!("cannot write JSON: {error}")))
}

fn value(findings: &Findings<'_>) -> Value {
    let mut value = match &findings.answer {
        Ok(answer) => of_answer(answer),
        Err(refusal) => of_refusal(refusal),
    };
    let common = [
        (
            "program",
            json!(concat!("tem00 ", env!("CARGO_PKG_VERSION"))),
        ),
        ("setup", json!(findings.file.display().to_string())),
        ("image", of_image(findings).into()),
    ];
    value.extend(common.map(|(key, value)| (key.to_owned(), value)));
    value.into()
}

fn of_answer(answer: &Answer) -> Map<String, Value> {
    let budget = &answer.budget;
    let terms = budget.terms().iter();
    let terms: Vec<Value> = terms.map(|term| of_term(answer, term)).collect();
    let over_range = answer.over_range.iter();
    let over_range =
        over_range.map(|(height, combined)| json!({ "height": height, "combined": combined }));
    let values = [
        ("reason", Value::Null),
        ("height", json!(budget.height())),
        ("terms", json!(terms)),
        ("combined", json!(budget.combined())),
        (
            "degrees_of_freedom",
            json!(finite(budget.degrees_of_freedom())),
        ),
        ("coverage_factor", json!(budget.coverage_factor())),
        ("expanded", json!(budget.expanded())),
        ("dominant", json!(budget.dominant().source.name())),
        ("line_law", json!(budget.line_law())),
        ("dorsch", json!(budget.dorsch())),
        (
            "trials",
            json!(
                answer
                    .trials
                    .as_ref()
                    .map(|trials| of_trials(trials, answer.combined_by_trials()))
            ),
        ),
        ("over_range", over_range.collect()),
    ];
    keyed(values)
}

/// The record of a set-up that measures nothing: the same keys, without numbers.
fn of_refusal(refusal: &Refusal) -> Map<String, Value> {
    let trials = refusal.trials.as_ref();
    let trials = trials.map(|trials| of_trials(trials, None));
    let values = [
        ("reason", json!(refusal.why)),
        ("height", Value::Null),
        ("terms", json!([])),
        ("combined", Value::Null),
        ("degrees_of_freedom", Value::Null),
        ("coverage_factor", Value::Null),
        ("expanded", Value::Null),
        ("dominant", Value::Null),
        ("line_law", Value::Null),
        ("dorsch", Value::Null),
        ("trials", json!(trials)),
        ("over_range", json!([])),
    ];
    keyed(values)
}

fn keyed<const N: usize>(values: [(&str, Value); N]) -> Map<String, Value> {
    let values = values.map(|(key, value)| (key.to_owned(), value));
    values.into_iter().collect()
}

/// What is infinite has no number in JSON.
fn finite(value: f64) -> Option<f64> {
    value.is_finite().then_some(value)
}

fn of_term(answer: &Answer, term: &BudgetTerm) -> Value {
    let found = answer
        .trials
        .as_ref()
        .and_then(|trials| trials.term(term.source));
    json!({
        "source": term.source.name(),
        "evaluation": format!("{:?}", term.evaluation),
        "distribution": term.distribution.name(),
        "uncertainty": term.uncertainty,
        "unit": term.unit(),
        "sensitivity": term.sensitivity,
        "contribution": term.contribution(),
        "share": answer.budget.share(term),
        "degrees_of_freedom": finite(term.degrees_of_freedom),
        "by_trials": found.map(|found| found.uncertainty),
        "by_trials_standard_error": found.map(|found| found.standard_error),
    })
}

/// What trials found, and the combined uncertainty by them; without an uncertainty, how many columns have no
/// line that can be trusted.
fn of_trials(trials: &Simulation, combined: Option<f64>) -> Value {
    let total = trials.total();
    json!({
        "trials": trials.options().trials,
        "seed": trials.options().seed,
        "uncertainty": total.map(|total| total.uncertainty),
        "standard_error": total.map(|total| total.standard_error),
        "combined": combined,
        "invalid": trials.invalid(),
    })
}

fn of_image(findings: &Findings<'_>) -> Map<String, Value> {
    let (setup, range) = (&findings.setup, findings.setup.measuring_range());
    let line = setup.line();
    let values = [
        ("magnification", json!(setup.magnification())),
        ("height_per_pixel", json!(line.height_per_pixel)),
        ("line_width_pixels", json!(line.width)),
        ("speckle_size_pixels", json!(line.speckle_size)),
        ("contrast", json!(setup.contrast())),
        ("peak_electrons", json!(setup.peak_electrons())),
        ("column_electrons", json!(line.column_electrons)),
        ("saturation", json!(setup.saturation())),
        ("grain_saturation", json!(setup.grain_saturation())),
        ("exposure", json!(setup.description().sensor.exposure_time)),
        ("light", json!(setup.light_level().name())),
        ("measuring_range", json!([range.low, range.high])),
        ("field_width", json!(setup.field_width())),
    ];
    keyed(values)
}
