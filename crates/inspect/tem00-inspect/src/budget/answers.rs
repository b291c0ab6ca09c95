//! The report of a height that is measured with a set-up whose quantities are uncertain.

use serde_json::json;
use tem00_report::report::{
    Cell, Column, Section, Table,
    units::{MICROMETRES, MILLIMETRES, NUMBER, PERCENT},
};
use tem00_triangulation::{Budget, MeasurementInput};
use tem00_uncertainty::Input;

use super::measured::{Quoted, ThreeMethods};
use crate::units::shown;

/// Returns the result in sentences.
pub(super) fn verdicts(measured: &ThreeMethods) -> Vec<String> {
    let quoted = measured.quoted();
    let height = MILLIMETRES.text(measured.measurement.height());
    let half = MICROMETRES.text(0.5 * measured.quoted_answer().interval.length());
    let mut lines = vec![format!(
        "Height {height} with the uncertain quantities of the set-up: U = {half} (95 %), by the \
         {}.",
        quoted.name()
    )];
    lines.push(why(measured));
    if !measured.is_stable() {
        lines.push(format!(
            "The propagation of distributions is not stable after {} trials.",
            measured.propagation.values().len()
        ));
    }
    lines
}

/// Says that formulas do not hold for so thin a line, and which result to quote.
pub(super) fn thin(speckles: f64, quote: &str) -> String {
    format!(
        "The line is {} speckles wide: formulas, which are first order, do not hold below {}; \
         quote {quote}.",
        NUMBER.with_digits(3).text(speckles),
        NUMBER.text(Budget::LEAST_SPECKLES)
    )
}

/// Says where the methods differ, and therefore which of them to quote.
fn why(measured: &ThreeMethods) -> String {
    if measured.is_thin() {
        let quote = match measured.quoted() {
            Quoted::VirtualExperiment => "the virtual experiment",
            _ => "a virtual experiment, which was left out",
        };
        return thin(measured.measurement.speckles(), quote);
    }
    let validation = measured.validation();
    let [low, high, tolerance] = [validation.low, validation.high, validation.tolerance]
        .map(|length| MICROMETRES.text(length));
    match measured.quoted() {
        Quoted::FirstOrder => format!(
            "Law of propagation and propagation of distributions agree within the numerical \
             tolerance of {tolerance} (the ends of their intervals differ by {low} and {high}): \
             the first is validated, quote it."
        ),
        Quoted::Propagation => format!(
            "The ends of the law of propagation are off by {low} and {high}, more than the \
             numerical tolerance of {tolerance}: it is not validated, quote the propagation of \
             distributions."
        ),
        Quoted::VirtualExperiment => {
            let ratio = measured.ratio().map_or(f64::NAN, |[ratio, _]| ratio);
            format!(
                "The virtual experiment finds {} times the uncertainty by distributions, whose \
                 noise is first order: this detector is not linear under so much noise; quote the \
                 virtual experiment.",
                NUMBER.with_digits(3).text(ratio)
            )
        }
    }
}

/// Adds the answers and their contributions.
pub(super) fn section(section: &mut Section, measured: &ThreeMethods) {
    let (validation, propagation) = (measured.validation(), &measured.propagation);
    section
        .fact(
            "height",
            "height",
            MILLIMETRES.quantity(measured.measurement.height()),
        )
        .data("quoted", measured.quoted().key())
        .table(answers(measured))
        .paragraph(
            "Each answer in the words of the GUM. The law of propagation of uncertainty (JCGM 100) \
             is first order; the propagation of distributions (JCGM 101) draws the inputs and \
             evaluates the height; the virtual experiment draws the true set-up, exposes frames, \
             finds the line, and evaluates the height with the set-up as it is described. Its \
             standard uncertainty is the root mean square error, ± its standard error.",
        )
        .data("trials", propagation.values().len())
        .data("is_stable", measured.is_stable())
        .data(
            "validation",
            json!({
                "d_low": validation.low,
                "d_high": validation.high,
                "tolerance": validation.tolerance,
                "is_valid": validation.is_valid(),
            }),
        )
        .data(
            "degrees_of_freedom",
            measured.first_order.degrees_of_freedom(),
        )
        .data("correlations", correlations(measured))
        .table(inputs(measured))
        .paragraph(
            "Contributions and their parts of u² are those of the law of propagation; S and S_T \
             are Sobol' indices, the parts of the variance that an input makes alone, and with all \
             others. They need independent inputs.",
        );
}

fn answers(measured: &ThreeMethods) -> Table {
    let columns = [
        Column::data("method"),
        Column::shown("answer"),
        Column::new("estimate", "estimate (mm)"),
        Column::new("uncertainty", "standard uncertainty (µm)"),
        Column::new("standard_error", "± (µm)"),
        Column::new("low", "95 % from (µm)"),
        Column::new("high", "to (µm)"),
    ];
    let mut table = Table::new("The height and its uncertainty", columns).under("answers");
    let height = measured.measurement.height();
    let end = |end: f64| Cell::new(end, MICROMETRES.cell(end - height).text());
    for method in Quoted::ALL {
        let Some(answer) = measured.answer(method) else {
            continue;
        };
        let estimate = format!("{:.4}", MILLIMETRES.of(answer.estimate));
        let error = answer.standard_error.map(|error| MICROMETRES.cell(error));
        table.row([
            method.key().into(),
            method.name().into(),
            Cell::new(answer.estimate, estimate),
            MICROMETRES.cell(answer.uncertainty),
            Cell::or_dash(error),
            end(answer.interval.low),
            end(answer.interval.high),
        ]);
    }
    table
}

fn correlations(measured: &ThreeMethods) -> Vec<serde_json::Value> {
    let named = |(between, coefficient): ([MeasurementInput; 2], f64)| {
        let between = between.map(source);
        json!({ "between": between, "coefficient": coefficient })
    };
    measured.correlations().map(named).collect()
}

/// Returns the name of an input.
pub(super) fn source(input: MeasurementInput) -> String {
    match input {
        MeasurementInput::Quantity(quantity) => quantity.to_string(),
        MeasurementInput::Term(source) => source.name().to_owned(),
    }
}

fn inputs(measured: &ThreeMethods) -> Table {
    let mut columns = vec![
        Column::new("input", "input"),
        Column::new("estimate", "estimate"),
        Column::new("uncertainty", "standard uncertainty"),
        Column::new("distribution", "distribution"),
        Column::new("degrees_of_freedom", "degrees of freedom"),
        Column::new("sensitivity", "sensitivity"),
        Column::new("contribution", "contribution (µm)"),
        Column::new("variance_fraction", "part of u² (%)"),
    ];
    if measured.decomposition.is_some() {
        columns.push(Column::new("first_order_index", "S (%)"));
        columns.push(Column::new("total_index", "S_T (%)"));
    }
    let mut table = Table::new("What makes the height uncertain", columns).under("inputs");
    for (index, (source, input)) in measured.inputs().enumerate() {
        table.row(cells(measured, index, source, input));
    }
    table
}

fn cells(
    measured: &ThreeMethods,
    index: usize,
    input: MeasurementInput,
    known: &Input,
) -> Vec<Cell> {
    let (unit, divisor) = (shown(input.unit()), input.unit().divisor);
    let contribution = &measured.first_order.contributions()[index];
    let per_unit = MICROMETRES.text(contribution.sensitivity / unit.of(1.0));
    let mut cells = vec![
        source(input).into(),
        unit.quantity(known.estimate()),
        unit.quantity(known.uncertainty()),
        known.distribution().name().into(),
        NUMBER.with_digits(3).cell(known.degrees_of_freedom()),
        Cell::new(contribution.sensitivity, format!("{per_unit}/{divisor}")),
        MICROMETRES.cell(contribution.uncertainty),
        PERCENT.with_digits(3).cell(contribution.variance_fraction),
    ];
    if let Some(decomposition) = &measured.decomposition {
        let parts = decomposition.inputs()[index];
        // As many decimals as their standard errors leave.
        let percent = |value: f64| {
            let text = format!("{:.1}", PERCENT.of(value));
            Cell::new(value, text.replace("-0.0", "0.0"))
        };
        cells.extend([parts.first_order, parts.total].map(|part| percent(part.value)));
    }
    cells
}
