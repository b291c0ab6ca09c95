//! Measurements of a pattern, compared with the theory.

use core::fmt::Display;

use tem00_numerics::{
    Grid,
    cast::{to_f32, to_usize},
    parallel::map_pieces,
};
use tem00_report::{failure::Failure, interrupt};
use tem00_speckle::{Phasors, Pupil, PupilField, SpecklePattern};
use tem00_statistics::{
    Contrast, Moments, SpeckleSize, StatisticsError,
    estimate::{Axis, autocovariance_from_spectrum, decorrelated_samples, power_spectrum},
    exponential_cumulative, kolmogorov_smirnov,
    laws::{AIRY_FIRST_ZERO, contrast_of_phasor_sum},
};

use crate::comparison::{Expectation, Row};

/// The significance of the Kolmogorov–Smirnov test in the table.
const SIGNIFICANCE: f64 = 1e-3;

/// The statistic of Kolmogorov and Smirnov times √n that a true hypothesis exceeds once in 1000
/// (Smirnov 1948).
const CRITICAL_DISTANCE: f64 = 1.949;

/// The tolerances in the table, in standard deviations: a correct pattern exceeds one of
/// them once in 16 000.
const SIGMAS: f64 = 4.0;

/// The measurements and the notes on them.
#[derive(Debug, Default)]
pub(super) struct Comparison {
    pub(super) rows: Vec<Row>,
    pub(super) notes: Vec<String>,
}

impl Comparison {
    /// Adds the measured rows, or a note that they could not be measured.
    fn add<R: IntoIterator<Item = Row>>(
        &mut self,
        what: &dyn Display,
        rows: Result<R, StatisticsError>,
    ) {
        match rows {
            Ok(rows) => self.rows.extend(rows),
            Err(error) => self
                .notes
                .push(format!("the {what} could not be measured: {error}")),
        }
    }
}

/// Measures the pattern and lists the predictions of the theory.
///
/// # Errors
///
/// Returns a failure if the user has interrupted the program, which is checked before each pass.
pub(super) fn compare(field: &PupilField, pattern: &SpecklePattern) -> Result<Comparison, Failure> {
    let values = pattern.values();
    let mut found = Comparison::default();
    interrupt::check()?;
    found.add(&"mean", mean_row(field, values).map(Some));
    found.add(&"contrast", contrast_row(field, values).map(Some));
    interrupt::check()?;
    let spectrum = power_spectrum(values);
    interrupt::check()?;
    sizes(&mut found, field, spectrum.as_ref())?;
    interrupt::check()?;
    found.add(&"distribution", distribution_rows(field, values));
    interrupt::check()?;
    let support = spectrum.map(|spectrum| Some(support_row(field, &spectrum)));
    found.add(&"spectrum", support);
    interrupt::check()?;
    if let Some(samples) = field.samples() {
        found
            .notes
            .push("the theory is that of random phases in even light over the pupil".to_owned());
        let [width, height] = [samples.width(), samples.height()];
        let diameter = field.diameter()[0].round();
        if diameter > width.min(height) as f64 {
            found.notes.push(format!(
                "the pupil of {diameter} samples reaches beyond the field of {width} × {height}: \
                 there it is dark"
            ));
        }
    }
    Ok(found)
}

fn mean_row(field: &PupilField, values: &Grid<f32>) -> Result<Row, StatisticsError> {
    let mean = Moments::from_samples(values.values())?.mean();
    // Parseval fixes the mean of unit phasors; the remaining error is the rounding of an f32
    // transform.
    let rounding = 1e-5;
    let spread = match field.phasors() {
        Some(Phasors::Unit) | None => rounding,
        Some(Phasors::Gaussian) => SIGMAS / (field.phasor_count() as f64).sqrt(),
    };
    Ok(Row::new("mean", mean, Expectation::near(1.0, spread)))
}

fn contrast_row(field: &PupilField, values: &Grid<f32>) -> Result<Row, StatisticsError> {
    let contrast = Contrast::from_samples(values.values())?.value();
    let mut tolerance = SIGMAS * 0.5 * contrast_squared_spread(field);
    let theory = match field.phasors() {
        Some(_) => contrast_of_phasor_sum(field.phasor_count()),
        // Between the 1 − 1/N of equal magnitudes and the 1 − 2/N of exponential powers, squared.
        None => {
            tolerance += (field.phasor_count() as f64).recip();
            1.0
        }
    };
    Ok(Row::new(
        "contrast",
        contrast,
        Expectation::near(theory, tolerance),
    ))
}

/// Returns the standard deviation of the squared contrast of one pattern.
///
/// ```text
/// 2 √(Σ A(m)²) / N² = 2 (C / N) √(∬ overlap²)        A(m) = N overlap(m / C)
/// ```
///
/// A rectangle may have few rows, so its sum is not replaced by the integral.
fn contrast_squared_spread(field: &PupilField) -> f64 {
    const STEPS: u32 = 200;
    let (count, [diameter, _]) = (field.phasor_count() as f64, field.diameter());
    if let Pupil::Rectangle { .. } = field.pupil() {
        let columns = 2.0 * (0.5 * diameter).floor() + 1.0;
        // Σ (n − |m|)² over all lags m.
        let squares = |n: f64| n * (2.0 * n * n + 1.0) / 3.0;
        return 2.0 * (squares(columns) * squares(count / columns)).sqrt() / (count * count);
    }
    let position = |step: u32| (f64::from(step) + 0.5) / f64::from(STEPS);
    let squares: f64 = (0..STEPS)
        .flat_map(|y| (0..STEPS).map(move |x| [position(x), position(y)]))
        .map(|shift| field.pupil().overlap(shift).powi(2))
        .sum();
    // Four quadrants of the square of the shifts |x|, |y| < 1.
    let integral = 4.0 * squares / f64::from(STEPS * STEPS);
    2.0 * diameter / count * integral.sqrt()
}

/// Adds the speckle size along both axes, compared with the size by the exact autocovariance of the
/// pupil.
fn sizes(
    found: &mut Comparison,
    field: &PupilField,
    spectrum: Result<&Grid<f32>, &StatisticsError>,
) -> Result<(), Failure> {
    let lags = spectrum.map_err(Clone::clone);
    let measured = match lags.and_then(autocovariance_from_spectrum) {
        Ok(measured) => measured,
        Err(error) => {
            found.add::<Option<Row>>(&"speckle size", Err(error));
            return Ok(());
        }
    };
    interrupt::check()?;
    for axis in [Axis::X, Axis::Y] {
        let row = size_row(field, &measured, axis).map(Some);
        found.add(&format_args!("speckle size along {axis}"), row);
    }
    Ok(())
}

fn size_row(field: &PupilField, lags: &Grid<f32>, axis: Axis) -> Result<Row, StatisticsError> {
    let measured = SpeckleSize::along(axis, lags)?;
    let theory = SpeckleSize::along(axis, &exact_autocovariance(field, axis, measured))?;
    // The relative standard deviation of the size is 0.58 / n in a pattern of n × n speckles.
    let tolerance = SIGMAS * 0.58 / field.effective_diameter() * theory;
    let quantity = format!("speckle size {axis} (samples)");
    Ok(Row::new(
        quantity,
        measured,
        Expectation::near(theory, tolerance),
    ))
}

/// Returns the autocovariance of the pupil at the lags along one axis, up to a multiple of the
/// measured size; the other lags are left 0.
fn exact_autocovariance(field: &PupilField, axis: Axis, size: f64) -> Grid<f32> {
    let lags = (to_usize((8.0 * size).ceil()) + 8).min(field.size()[0]);
    let covariance = |lag: usize| {
        let lag = match axis {
            Axis::X => [lag as f64, 0.0],
            Axis::Y => [0.0, lag as f64],
        };
        to_f32(field.amplitude_correlation(lag).norm_sqr())
    };
    match axis {
        Axis::X => Grid::from_fn(lags, 1, |lag, _| covariance(lag)),
        Axis::Y => Grid::from_fn(1, lags, |_, lag| covariance(lag)),
    }
}

/// Compares the distribution of independent samples with the exponential law.
fn distribution_rows(field: &PupilField, values: &Grid<f32>) -> Result<[Row; 2], StatisticsError> {
    let samples = decorrelated_samples(values, stride(field))?;
    let outcome = kolmogorov_smirnov(&samples, exponential_cumulative)?;
    let critical = CRITICAL_DISTANCE / (samples.len() as f64).sqrt();
    Ok([
        Row::new(
            "KS distance to exponential",
            outcome.statistic,
            Expectation::at_most(critical),
        ),
        Row::new(
            "KS p-value",
            outcome.p_value,
            Expectation::at_least(SIGNIFICANCE),
        ),
    ])
}

/// Returns the distance of practically independent samples: the first zero of the autocovariance of
/// a disc as narrow as the pupil.
fn stride(field: &PupilField) -> usize {
    let narrowest = match field.pupil() {
        Pupil::Rectangle { height } => *height,
        _ => 1.0,
    };
    to_usize((AIRY_FIRST_ZERO * field.speckle_size() / narrowest).ceil())
}

/// Measures the fraction of the power beyond the pupil's cut-off frequency, one period per speckle.
fn support_row(field: &PupilField, spectrum: &Grid<f32>) -> Row {
    let ([size, _], [diameter, _]) = (field.size(), field.diameter());
    let frequency = |index: usize| index.min(size - index) as f64;
    let beyond = |x: f64, y: f64| match field.pupil() {
        Pupil::Rectangle { .. } => x.max(y) > diameter,
        _ => x * x + y * y > diameter * diameter,
    };
    let sums = map_pieces(spectrum.values(), |start, piece| {
        let (mut outside, mut all) = (0.0, 0.0);
        for (index, &power) in (start..).zip(piece) {
            all += f64::from(power);
            if beyond(frequency(index % size), frequency(index / size)) {
                outside += f64::from(power);
            }
        }
        [outside, all]
    });
    let [outside, all] = [0, 1].map(|i| sums.iter().map(|sum| sum[i]).sum::<f64>());
    // Rounding of f32 makes noise of 10⁻¹³ of the power of each frequency.
    let quantity = "power beyond the cut-off frequency";
    let theory = Expectation::at_most(1e-6);
    Row::new(quantity, outside / all, theory)
}

#[cfg(test)]
mod tests {
    use approx::assert_relative_eq;

    use super::*;

    fn rows(pupil: Pupil, seed: u64) -> Vec<Row> {
        let field = PupilField::new(256, 64, seed).and_then(|field| field.with_pupil(pupil));
        let field = field.expect("the pupil is valid");
        let found = compare(&field, &field.pattern()).expect("nobody interrupts");
        assert!(found.notes.is_empty(), "{found:?}");
        found.rows
    }

    fn agrees(row: &Row) -> bool {
        row.verdict
            .as_deref()
            .is_none_or(|verdict| verdict == "agrees")
    }

    #[test]
    fn patterns_of_every_pupil_agree_with_the_table() {
        // 7 lines of 24 patterns at 6e-5 each (1e-3 for the two of the KS test): a correct program
        // fails at these seeds with a probability of 3 %, and it does not.
        for pupil in [
            Pupil::Circle,
            Pupil::Annulus { inner: 0.5 },
            Pupil::Rectangle { height: 0.5 },
        ] {
            for seed in 0..8 {
                for row in rows(pupil.clone(), seed) {
                    assert!(agrees(&row), "{pupil:?}, seed {seed}: {row:?}");
                }
            }
        }
    }

    #[test]
    fn the_spread_of_the_contrast_is_that_of_the_circle() {
        let field = PupilField::new(512, 128, 0).expect("valid");
        let expected = tem00_statistics::laws::contrast_squared_spread(128.0);
        // The counted points of the disc differ from πC²/4 by 0.3 % at most, the sum over 200²
        // midpoints from the integral by less.
        assert_relative_eq!(
            contrast_squared_spread(&field),
            expected,
            max_relative = 4e-3
        );
    }

    #[test]
    fn the_spread_of_the_contrast_counts_the_rows_of_a_rectangle() {
        let field = PupilField::new(64, 32, 0).expect("valid");
        for height in [1e-3, 0.1, 0.5, 1.0] {
            let pupil = Pupil::Rectangle { height };
            let field = field.clone().with_pupil(pupil);
            // One row has 33 phasors, fewer than a pupil needs.
            let Ok(field) = field else { continue };
            let lags = (-40..40_i64).flat_map(|y| (-40..40_i64).map(move |x| [x, y]));
            let squares: f64 = lags.map(|lag| field.overlap(lag).norm_sqr()).sum();
            let exact = 2.0 * squares.sqrt() / field.phasor_count() as f64;
            let spread = contrast_squared_spread(&field);
            assert_relative_eq!(spread, exact, max_relative = 1e-12);
        }
    }

    #[test]
    fn a_pattern_that_is_too_even_does_not_agree() {
        let field = PupilField::new(256, 64, 0).expect("valid");
        let [a, b] = [1, 2].map(|seed| field.clone().with_seed(seed).pattern());
        // The sum of two patterns: Gamma of shape 2 with the contrast 1/√2.
        let at = |place| 0.5 * (a.values()[place] + b.values()[place]);
        let sum = Grid::from_fn(256, 256, |x, y| at((x, y)));
        let contrast = contrast_row(&field, &sum).expect("measured");
        assert!(!agrees(&contrast), "it is 0.71");
        let rows = distribution_rows(&field, &sum).expect("measured");
        assert!(rows.iter().all(|row| !agrees(row)), "{rows:?}");
        let mean = mean_row(&field, &sum).expect("measured");
        assert!(agrees(&mean), "it is 1");
    }

    #[test]
    fn the_wrong_pupil_does_not_agree() {
        let field = PupilField::new(256, 64, 0).expect("valid");
        let other = PupilField::new(256, 96, 0).expect("valid").pattern();
        let mut found = Comparison::default();
        let spectrum = power_spectrum(other.values());
        sizes(&mut found, &field, spectrum.as_ref()).expect("nobody interrupts");
        assert_eq!(found.rows.len(), 2, "{found:?}");
        assert!(found.rows.iter().all(|row| !agrees(row)), "{found:?}");
        let support = support_row(&field, &spectrum.expect("it varies"));
        assert!(!agrees(&support), "{support:?}");
    }

    #[test]
    fn a_size_that_the_pattern_does_not_hold_is_said() {
        let field = PupilField::new(256, 64, 0).expect("valid");
        let thin = field.with_pupil(Pupil::Rectangle { height: 1e-3 });
        let thin = thin.expect("64 phasors in a row");
        let found = compare(&thin, &thin.pattern()).expect("nobody interrupts");
        let [note] = &found.notes[..] else {
            panic!("one axis is not measured: {found:?}");
        };
        assert!(
            note.contains("speckle size along y could not be measured"),
            "{note}"
        );
        let mut rows = found.rows.iter();
        let size = rows
            .find(|row| row.quantity.contains("size"))
            .expect("x is measured");
        assert!(size.quantity.contains("size x") && agrees(size), "{size:?}");
    }

    #[test]
    fn a_random_field_from_outside_agrees_with_the_table() {
        // The amplitude of one pattern, of independent speckles, is the random field of another.
        let random = PupilField::new(512, 256, 5).expect("valid").field();
        let samples = Grid::from_fn(128, 128, |x, y| random.values()[(4 * x, 4 * y)]);
        let field = PupilField::from_samples(samples, [512; 2], 4.0).expect("finite samples");
        let found = compare(&field, &field.pattern()).expect("nobody interrupts");
        assert_eq!(found.notes.len(), 1, "{found:?}");
        for row in &found.rows {
            assert!(agrees(row), "{row:?}");
        }
    }
}
