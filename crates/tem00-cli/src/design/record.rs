//! A search as JSON.

use std::io::Write;

use serde::Serialize;
use serde_json::{Map, Value, json};
use tem00_triangulation::{Candidate, DesignFigure, DesignFigures};

use super::Design;
use crate::failure::Failure;

/// What a search comes to, in SI units.
#[derive(Debug, Serialize)]
pub(super) struct Record {
    setup: String,
    objective: &'static str,
    varied: Map<String, Value>,
    constraints: Vec<Value>,
    tried: usize,
    possible: usize,
    allowed: usize,
    /// The best set-ups that keep every constraint, the best first.
    best: Vec<Value>,
    /// The set-up that misses the constraints by least, where none keeps them all.
    nearest: Option<Value>,
    /// The numbers of the set-ups that trade uncertainty for depth of field.
    front: Vec<usize>,
}

impl Record {
    pub(super) fn of(design: &Design<'_>) -> Self {
        let question = design.search.question();
        let (possible, allowed) = design.outcome.counts();
        let best = design.outcome.best(design.most);
        let nearest = design.outcome.nearest().filter(|_| best.is_empty());
        let front = design.outcome.front(DesignFigure::DepthOfField);
        let sweeps = question.sweeps.iter();
        Self {
            setup: design.file.display().to_string(),
            objective: design.objective().name(),
            varied: sweeps
                .map(|sweep| (sweep.parameter().name().to_owned(), json!(sweep.values())))
                .collect(),
            constraints: constraints(design),
            tried: design.search.count(),
            possible,
            allowed,
            best: best
                .into_iter()
                .map(|found| candidate(design, found))
                .collect(),
            nearest: nearest.map(|found| candidate(design, found)),
            front: front.iter().map(|candidate| candidate.index).collect(),
        }
    }

    /// Returns the record as text.
    pub(super) fn text(&self) -> Result<String, Failure> {
        let text = serde_json::to_string_pretty(self);
        text.map_err(|error| Failure::running(format!("cannot write JSON: {error}")))
    }
}

/// Prints the record.
pub(super) fn print(design: &Design<'_>, out: &mut impl Write) -> Result<(), Failure> {
    let text = Record::of(design).text()?;
    writeln!(out, "{text}").map_err(|error| Failure::stdout(&error))
}

fn constraints(design: &Design<'_>) -> Vec<Value> {
    let exclusions = design.outcome.exclusions().into_iter();
    let value = exclusions.map(|exclusion| {
        let figure = exclusion.constraint.figure;
        let bound = if figure.is_gain() {
            "at_least"
        } else {
            "at_most"
        };
        json!({
            "figure": figure.name(),
            bound: exclusion.constraint.bound,
            "excluded": exclusion.excluded,
            "excluded_alone": exclusion.alone,
        })
    });
    value.collect()
}

fn candidate(design: &Design<'_>, candidate: &Candidate) -> Value {
    let sweeps = design.search.question().sweeps.iter();
    let values: Map<_, _> = sweeps
        .map(|sweep| {
            let parameter = sweep.parameter();
            (
                parameter.name().to_owned(),
                json!(parameter.of(&candidate.description)),
            )
        })
        .collect();
    let broken = candidate
        .broken
        .iter()
        .map(|constraint| constraint.figure.name());
    json!({
        "number": candidate.index,
        "values": values,
        "figures": candidate.possible().map(figures),
        "broken": broken.collect::<Vec<_>>(),
    })
}

fn figures(figures: &DesignFigures) -> Value {
    let mut map: Map<_, _> = DesignFigure::ALL
        .into_iter()
        .map(|figure| (figure.name().to_owned(), json!(figure.of(figures))))
        .collect();
    let contributions: Map<_, _> = figures
        .contributions
        .iter()
        .map(|(source, value)| (source.name().to_owned(), json!(value)))
        .collect();
    map.insert("contributions".into(), contributions.into());
    map.insert("dominant".into(), figures.dominant.name().into());
    map.insert("line_width_pixels".into(), json!(figures.line_width));
    map.insert("speckle_size_pixels".into(), json!(figures.speckle_size));
    map.into()
}
