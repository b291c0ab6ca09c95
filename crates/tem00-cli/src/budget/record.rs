//! A budget as JSON.

use serde_json::{Map, Value, json};
use tem00_triangulation::BudgetTerm;

use super::Findings;
use crate::failure::Failure;

/// Returns the budget as text, in SI units.
pub(super) fn text(findings: &Findings<'_>) -> Result<String, Failure> {
    serde_json::to_string_pretty(&value(findings))
        .map_err(|error| Failure::running(format!("cannot write JSON: {error}")))
}

fn value(findings: &Findings<'_>) -> Value {
    let budget = &findings.budget;
    let terms: Vec<Value> = budget
        .terms()
        .iter()
        .map(|term| of_term(findings, term))
        .collect();
    json!({
        "program": concat!("tem00 ", env!("CARGO_PKG_VERSION")),
        "setup": findings.file.display().to_string(),
        "height": budget.height(),
        "terms": terms,
        "combined": budget.combined(),
        "degrees_of_freedom": finite(budget.degrees_of_freedom()),
        "coverage_factor": budget.coverage_factor(),
        "expanded": budget.expanded(),
        "dominant": budget.dominant().source.name(),
        "line_law": budget.line_law(),
        "dorsch": budget.dorsch(),
        "trials": of_trials(findings),
        "over_range": findings.over_range.iter().map(|(height, combined)| {
            json!({ "height": height, "combined": combined })
        }).collect::<Vec<_>>(),
        "image": of_image(findings),
    })
}

/// What is infinite has no number in JSON.
fn finite(value: f64) -> Option<f64> {
    value.is_finite().then_some(value)
}

fn of_term(findings: &Findings<'_>, term: &BudgetTerm) -> Value {
    let found = findings
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
        "share": findings.budget.share(term),
        "degrees_of_freedom": finite(term.degrees_of_freedom),
        "by_trials": found.map(|found| found.uncertainty),
        "by_trials_standard_error": found.map(|found| found.standard_error),
    })
}

fn of_trials(findings: &Findings<'_>) -> Option<Value> {
    let trials = findings.trials.as_ref()?;
    Some(json!({
        "trials": trials.options().trials,
        "seed": trials.options().seed,
        "uncertainty": trials.total().uncertainty,
        "standard_error": trials.total().standard_error,
        "combined": findings.combined_by_trials(),
        "invalid": trials.invalid(),
    }))
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
        ("light", json!(setup.light_level().name())),
        ("measuring_range", json!([range.low, range.high])),
        ("field_width", json!(setup.field_width())),
    ];
    values
        .map(|(key, value)| (key.to_owned(), value))
        .into_iter()
        .collect()
}
