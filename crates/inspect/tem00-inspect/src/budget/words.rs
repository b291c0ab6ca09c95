//! A budget in sentences.

use tem00_report::report::units::{MICROMETRES, MILLIMETRES, NUMBER, PERCENT, PIXELS};
use tem00_triangulation::{BandwidthEffect, LightLevel, LineMethod, MeasurementInput, Setup};

use super::{
    answers,
    findings::{Answer, Refusal},
    measured::{ThreeMethods, differs},
};

/// Returns the conclusions of the budget.
pub(super) fn verdicts(answer: &Answer, setup: &Setup) -> Vec<String> {
    let level = setup.light_level();
    let budget = &answer.budget;
    let (dominant, part) = answer.dominant();
    let name = match dominant {
        MeasurementInput::Quantity(quantity) => quantity.to_string(),
        MeasurementInput::Term(source) => capitalised(source.name()),
    };
    let dominates = format!(
        "{name} dominates, with {} of the variance: {}.",
        PERCENT.with_digits(3).text(part),
        dominant.remedy()
    );
    let mut lines = answer
        .measured
        .as_ref()
        .map_or_else(Vec::new, answers::verdicts);
    // It follows the answer that it belongs to.
    lines.extend(match answer.measured {
        Some(_) => [dominates, result(answer)],
        None => [result(answer), dominates],
    });
    lines.extend(of_trials(answer, setup));
    lines.extend(narrow_window(setup));
    // The closed forms are those of a line that stays where it enters.
    lines.push(subsurface(answer, setup).unwrap_or_else(|| {
        format!(
            "Speckle by closed forms: {} for the line that a lens images, {} for a spot after \
             Dorsch, Häusler and Herrmann.",
            MICROMETRES.text(budget.line_law()),
            MICROMETRES.text(budget.dorsch())
        )
    }));
    if level != LightLevel::Good {
        lines.push(format!("The light is not right: {}.", level.advice()));
    }
    lines
}

/// Returns the correction of heights on a part that lets light in.
fn subsurface(answer: &Answer, setup: &Setup) -> Option<String> {
    let shift = answer.budget.subsurface()?;
    let uncertain = answer.measured.as_ref().map(ThreeMethods::subsurface);
    let height = shift.height.abs();
    let height = match uncertain.filter(|uncertainty| *uncertainty > 0.0) {
        Some(uncertainty) => format!(
            "{} ± {}",
            MICROMETRES
                .with_digits_known(height, uncertainty)
                .text(height),
            MICROMETRES.with_digits(2).text(uncertainty)
        ),
        None => MICROMETRES.text(height),
    };
    let side = if shift.height < 0.0 { "low" } else { "high" };
    let contrast = setup.line().bandwidth.contrast;
    let contrast = match contrast < 1.0 {
        true => format!(
            " The speckle has {} of the contrast of light of one wavelength.",
            NUMBER.with_digits(2).text(contrast)
        ),
        false => String::new(),
    };
    Some(format!(
        "Light from below the surface leaves the part beside the line: with this detector the part \
         reads {height} {side}. Heights are corrected by that.{contrast} On a part that moves, \
         light from below the surface has new speckle in every frame."
    ))
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
    let length = |length: f64| MICROMETRES.text(length);
    let exact = match answer.measured {
        Some(_) => " at the reference plane, of a set-up that is known exactly",
        None => "",
    };
    let [_, expanded] = answer.quoted();
    let by_trials = answer.trials.as_ref().and_then(|trials| trials.expanded);
    let (how, other) = match answer.quoted_trials() {
        Some(_) => (
            "by trials".to_owned(),
            Some(("formulas", budget.expanded())),
        ),
        None => (
            format!("k = {:.2}", budget.coverage_factor()),
            by_trials.map(|found| ("trials", found)),
        ),
    };
    let other = other.map(|(method, found)| format!(" By {method} {}.", length(found)));
    format!(
        "Expanded uncertainty of a height{exact}: U = {} (95 %, {how}).{}{}{}",
        length(expanded),
        other.unwrap_or_default(),
        away_from_the_reference_plane(answer, expanded).unwrap_or_default(),
        without_a_line(answer).unwrap_or_default()
    )
}

/// Returns the largest uncertainty within the measuring range, if it is more than a tenth above the
/// value at the reference plane.
fn away_from_the_reference_plane(answer: &Answer, expanded: f64) -> Option<String> {
    let heights = answer.over_range.iter();
    let known = heights.filter_map(|&(height, combined)| Some((height, combined?)));
    let (height, combined) = known.max_by(|(_, a), (_, b)| a.total_cmp(b))?;
    let ratio = combined / answer.budget.combined();
    (ratio > 1.1).then(|| {
        format!(
            " This is its value at the reference plane; within the measuring range it reaches {}, \
             at {}.",
            MICROMETRES.text(ratio * expanded),
            MILLIMETRES.text(height)
        )
    })
}

/// Returns how much of the measuring range has no line, if any.
fn without_a_line(answer: &Answer) -> Option<String> {
    let heights = &answer.over_range;
    let lost = heights.iter().filter(|(_, found)| found.is_none()).count();
    (lost > 0).then(|| {
        format!(
            " In {} of the measuring range the detector finds no line.",
            PERCENT
                .with_digits(2)
                .text(lost as f64 / heights.len() as f64)
        )
    })
}

/// Returns the results of trials that formulas do not give.
fn of_trials(answer: &Answer, setup: &Setup) -> Vec<String> {
    let mut lines = Vec::new();
    let trials = answer.trials.as_ref();
    if answer.is_thin() {
        let quote = match trials {
            Some(_) => "the trials",
            None => "trials, which were left out",
        };
        lines.push(answers::thin(answer.budget.speckles(), quote));
    } else if let Some([ratio, _]) = answer.ratio().filter(|ratio| differs(*ratio)) {
        let why = match setup.description().detector.method {
            LineMethod::Steger { .. } => {
                "do not know that this detector also averages neighbouring columns"
            }
            _ => "are first order: this detector is not linear under so much noise",
        };
        lines.push(format!(
            "Trials find {} times the uncertainty of the formulas, which {why}; quote the trials.",
            NUMBER.with_digits(3).text(ratio)
        ));
    }
    if let Some(joint) = answer.joint_part().filter(|joint| *joint > 0.1) {
        lines.push(format!(
            "Another {} of the variance has several sources: where speckle is dark, the noise of \
             the sensor moves the line farther. More light lowers this part.",
            PERCENT.with_digits(2).text(joint)
        ));
    }
    if let Some(invalid) = trials
        .map(|trials| trials.invalid)
        .filter(|invalid| *invalid > 0.01)
    {
        lines.push(format!(
            "{} of the columns have no line that can be trusted; the trials leave them out.",
            PERCENT.with_digits(2).text(invalid)
        ));
    }
    lines
}

/// Notes a window that cuts off flanks of the line, whose light a centre of gravity needs: in a
/// window of one and a half widths of the line, speckle moves it a sixth farther than in a wide one.
fn narrow_window(setup: &Setup) -> Option<String> {
    let detector = setup.description().detector;
    let needs_flanks = matches!(
        detector.method,
        LineMethod::CentreOfGravity | LineMethod::IteratedCentreOfGravity
    );
    let width = setup.line().width;
    (needs_flanks && (detector.window as f64) < 1.5 * width).then(|| {
        format!(
            "The window of {} pixels cuts off flanks of the line, which is {} wide: speckle then \
             moves the centre of gravity farther. Set `window` in [detector] to {} or more.",
            detector.window,
            PIXELS.text(width),
            (2.0 * width).ceil()
        )
    })
}

/// Names the keys that say something and change nothing.
pub(super) fn without_effect(setup: &Setup) -> impl Iterator<Item = &'static str> {
    let (d, environment) = (setup.description(), setup.description().environment);
    let is_rigid = environment.base_expansion == 0.0 && environment.mount_expansion == 0.0;
    [
        (
            d.surface.relief.rms_height > 0.0 && setup.line().bandwidth == BandwidthEffect::NONE,
            "`rms_height` in [surface] has no effect on light of one wavelength: give [laser] its \
             `linewidth`",
        ),
        (
            d.average.independent_speckle && d.average.frames == 1,
            "`independent_speckle` in [average] has no effect on one frame: set `frames`",
        ),
        (
            environment.temperature_change != 0.0 && is_rigid,
            "`temperature_change` in [environment] has no effect without `base_expansion` and \
             `mount_expansion`",
        ),
    ]
    .into_iter()
    .filter_map(|(holds, note)| holds.then_some(note))
}

/// Begins text as a sentence.
fn capitalised(text: &str) -> String {
    let mut letters = text.chars();
    let first = letters.next().map(char::to_uppercase);
    first.into_iter().flatten().chain(letters).collect()
}
