//! A budget in words and tables.

use tem00_triangulation::{BudgetTerm, LightLevel, UncertaintySource};

use super::{Answer, Findings, Refusal};
use crate::table::number;

/// Writes a length in micrometres, without the unit.
pub(super) fn micrometres(length: f64) -> String {
    number(round(length * 1e6, 4))
}

/// Rounds to significant digits.
fn round(value: f64, digits: i32) -> f64 {
    if value == 0.0 || !value.is_finite() {
        return value;
    }
    #[expect(
        clippy::cast_possible_truncation,
        reason = "the exponent of a number is small"
    )]
    let magnitude = value.abs().log10().floor() as i32;
    let unit = 10_f64.powi(magnitude + 1 - digits);
    (value / unit).round() * unit
}

/// Writes a share in per cent, without the sign.
pub(super) fn percent(share: f64) -> String {
    number(round(100.0 * share, 2))
}

/// Returns what follows from the set-up.
pub(super) fn facts(findings: &Findings<'_>) -> Vec<(&'static str, String)> {
    let setup = &findings.setup;
    let (d, line) = (setup.description(), setup.line());
    let pixels = |value: f64| number(round(value, 4));
    let range = setup.measuring_range();
    let millimetres = |length: f64| number(round(length * 1e3, 4));
    vec![
        ("set-up", findings.file.display().to_string()),
        (
            "line in the image",
            format!(
                "{} pixels wide (1/e²): {} of the line itself, {} of the lens",
                pixels(line.width),
                pixels(line.line_width),
                pixels(line.diffraction_width)
            ),
        ),
        (
            "speckle",
            format!(
                "{} pixels, contrast {} in a pixel",
                pixels(line.speckle_size[1]),
                pixels(setup.contrast())
            ),
        ),
        (
            "light",
            format!(
                "{} electrons in the brightest pixel, {} % of the range: {}",
                pixels(setup.peak_electrons()),
                pixels(100.0 * setup.saturation()),
                setup.light_level().name()
            ),
        ),
        (
            "exposure",
            format!(
                "{} ms{}",
                pixels(1e3 * d.sensor.exposure_time),
                if d.auto_exposure {
                    ", chosen so that bright grains fill nine tenths of the range"
                } else {
                    ""
                }
            ),
        ),
        (
            "height per pixel",
            format!("{} µm", micrometres(line.height_per_pixel.abs())),
        ),
        (
            "measuring range",
            format!(
                "{} mm, from {} to {} mm; field {} mm wide",
                millimetres(range.length()),
                millimetres(range.low),
                millimetres(range.high),
                millimetres(setup.field_width())
            ),
        ),
        ("detector", d.detector.method.name().replace('_', " ")),
        ("averages", averages(findings)),
    ]
}

fn averages(findings: &Findings<'_>) -> String {
    let average = findings.setup.description().average;
    let speckle = match (average.frames, average.independent_speckle) {
        (1, _) => "",
        (_, true) => ", each with its own speckle",
        (_, false) => ", all with the same speckle",
    };
    let plural = |count: u32, what: &str| match count {
        1 => format!("one {what}"),
        _ => format!("{count} {what}s"),
    };
    format!(
        "{} of {}{speckle}",
        plural(average.columns, "column"),
        plural(average.frames, "frame")
    )
}

/// Returns the budget as the lines of a table, headings first.
pub(super) fn table(answer: &Answer) -> Vec<Vec<String>> {
    let mut headings: Vec<String> = [
        "source",
        "type",
        "distribution",
        "standard uncertainty",
        "sensitivity",
        "degrees of freedom",
        "contribution (µm)",
        "share (%)",
    ]
    .map(String::from)
    .into();
    if answer.trials.is_some() {
        headings.push("by trials (µm)".into());
        headings.push("± (µm)".into());
    }
    let mut lines = vec![headings];
    lines.extend(answer.budget.terms().iter().map(|term| cells(answer, term)));
    lines.push(combined(answer));
    lines
}

fn cells(answer: &Answer, term: &BudgetTerm) -> Vec<String> {
    let is_length = term.source == UncertaintySource::Calibration;
    let mut cells = vec![
        term.source.name().to_owned(),
        format!("{:?}", term.evaluation),
        term.distribution.name().to_owned(),
        if is_length {
            format!("{} µm", micrometres(term.uncertainty))
        } else {
            format!("{} px", number(round(term.uncertainty, 4)))
        },
        if is_length {
            "1".to_owned()
        } else {
            format!("{} µm/px", micrometres(term.sensitivity.abs()))
        },
        degrees_of_freedom(term.degrees_of_freedom),
        micrometres(term.contribution()),
        number(round(100.0 * answer.budget.share(term), 3)),
    ];
    if let Some(trials) = &answer.trials {
        let found = trials.term(term.source);
        let text = |length: Option<f64>| length.map_or_else(|| "-".to_owned(), micrometres);
        cells.push(text(found.map(|found| found.uncertainty)));
        cells.push(text(found.map(|found| found.standard_error)));
    }
    cells
}

fn degrees_of_freedom(value: f64) -> String {
    if value.is_finite() {
        number(round(value, 3))
    } else {
        "∞".to_owned()
    }
}

/// Returns the last line of the table.
pub(super) fn combined(answer: &Answer) -> Vec<String> {
    let mut cells: Vec<String> = ["combined", "", "", "", ""].map(String::from).into();
    cells.push(degrees_of_freedom(answer.budget.degrees_of_freedom()));
    cells.push(micrometres(answer.budget.combined()));
    cells.push("100".into());
    if let (Some(trials), Some(combined)) = (&answer.trials, answer.combined_by_trials()) {
        cells.push(micrometres(combined));
        cells.push(
            trials
                .total()
                .map_or_else(|| "-".to_owned(), |total| micrometres(total.standard_error)),
        );
    }
    cells
}

/// Returns what the budget comes to.
pub(super) fn verdicts(answer: &Answer, level: LightLevel) -> Vec<String> {
    let budget = &answer.budget;
    let dominant = budget.dominant();
    let mut lines = vec![
        verdict(answer),
        format!(
            "{} dominates, with {} % of the variance: {}",
            dominant.source,
            number(round(100.0 * budget.share(dominant), 3)),
            dominant.source.remedy()
        ),
        format!(
            "speckle by closed forms: {} µm for the line that a lens images, {} µm for a spot after \
             Dorsch, Häusler and Herrmann",
            micrometres(budget.line_law()),
            micrometres(budget.dorsch())
        ),
    ];
    if level != LightLevel::Good {
        lines.push(format!("the light is not right: {}", level.advice()));
    }
    lines.extend(of_trials(answer));
    lines
}

/// Returns why there is no budget, and what to change.
pub(super) fn refusal(refusal: &Refusal) -> Vec<String> {
    vec![
        format!("nothing can be measured with this set-up: {}", refusal.why),
        refusal.advice.to_owned(),
    ]
}

/// Returns the result, with the expanded uncertainty.
pub(super) fn verdict(answer: &Answer) -> String {
    let budget = &answer.budget;
    let by_trials = answer
        .combined_by_trials()
        .map_or_else(String::new, |found| {
            format!(
                "; by trials {} µm",
                micrometres(budget.coverage_factor() * found)
            )
        });
    format!(
        "expanded uncertainty of a height: U = {} µm (95 %, k = {:.2}){by_trials}",
        micrometres(budget.expanded()),
        budget.coverage_factor()
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
            "trials find {} times the uncertainty of the formulas, which are first order: this \
             detector is not linear under so much noise; go by the trials",
            number(round(ratio, 3))
        ));
    }
    if trials.invalid() > 0.01 {
        lines.push(format!(
            "{} % of the columns have no line that can be trusted; the trials leave them out",
            percent(trials.invalid())
        ));
    }
    lines
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn lengths_have_four_digits() {
        assert_eq!(micrometres(12.345_678e-6), "12.35");
        assert_eq!(micrometres(0.0), "0");
        assert_eq!(micrometres(1.0e-9), "0.001");
        assert_eq!(round(-123_456.0, 3).to_string(), "-123000");
    }
}
