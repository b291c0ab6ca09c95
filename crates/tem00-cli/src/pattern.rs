//! `tem00 pattern`: one speckle pattern beside the theory.

use std::{
    io::{self, Write},
    path::Path,
};

use num_complex::Complex;
use tem00_numerics::Grid;
use tem00_speckle::{Phasors, Pupil, PupilField, SpeckleError, SpecklePattern};
use tem00_statistics::{
    AIRY_FIRST_ZERO, Boundary, Contrast, Moments, SpeckleSize, StatisticsError,
    contrast_of_phasor_sum, decorrelated_samples, exponential_cumulative, kolmogorov_smirnov,
    power_spectrum,
};

use crate::{
    args::PatternArgs,
    atomic::{probe_writable, write_atomically},
    failure::Failure,
    image::{
        Format, ImageError, Layer, write_exr, write_grey_png, write_npy_complex, write_npy_f32,
    },
    interrupt,
    table::{Expectation, Row, write_table},
};

/// The largest size Q: 2²⁸ samples, the most that [`read_image`](crate::image::read_image) takes.
const MAXIMUM_SIZE: usize = 1 << 14;

/// The significance of the Kolmogorov–Smirnov test in the table.
const SIGNIFICANCE: f64 = 1e-3;

/// The statistic of Kolmogorov and Smirnov times √n that a true hypothesis exceeds once in 1000
/// (Smirnov 1948).
const CRITICAL_DISTANCE: f64 = 1.949;

/// How many standard deviations the tolerances in the table allow: a correct pattern exceeds one of
/// them once in 16 000.
const SIGMAS: f64 = 4.0;

/// Generates a pattern, writes it to the file asked for and prints the table.
///
/// # Errors
///
/// Returns a failure if the input is not valid or the file cannot be written.
pub(crate) fn run(args: &PatternArgs, out: &mut impl Write) -> Result<(), Failure> {
    let format = output_format(&args.output, args.amplitude)?;
    if args.size > MAXIMUM_SIZE {
        return Err(Failure::input(
            format!(
                "the pattern size must be at most {MAXIMUM_SIZE} samples, got {}",
                args.size
            ),
            "choose a smaller --size: the pattern repeats without a seam",
        ));
    }
    let field = pupil_field(args)?;
    probe_writable(&args.output).map_err(|error| cannot_write(&args.output, &error))?;

    let (pattern, amplitude) = if args.amplitude {
        let field = field.field();
        (field.to_pattern(), Some(field))
    } else {
        (field.pattern(), None)
    };
    let rows = check(&field, &pattern)
        .map_err(|error| Failure::running(format!("the pattern cannot be measured: {error}")))?;
    interrupt::check()?;
    let values = match &amplitude {
        Some(amplitude) => Values::Amplitude(amplitude.values()),
        None => Values::Intensity(pattern.values()),
    };
    write_atomically(&args.output, |file| {
        write(file, format, &values, &description(args, &field))
    })
    .map_err(|error| Failure::writing(&args.output, error))?;
    write_table(&rows, out).map_err(|error| Failure::stdout(&error))
}

fn output_format(path: &Path, amplitude: bool) -> Result<Format, Failure> {
    match Format::of_path(path) {
        None => Err(Failure::input(
            format!("{} names no known image format", path.display()),
            "end the name in .png, .exr or .npy",
        )),
        Some(Format::Png) if amplitude => Err(Failure::input(
            format!("{} cannot hold complex amplitudes", path.display()),
            "end the name in .npy or .exr, or leave --amplitude out",
        )),
        Some(format) => Ok(format),
    }
}

fn pupil_field(args: &PatternArgs) -> Result<PupilField, Failure> {
    let diameter = args.diameter.unwrap_or(args.size / 4);
    PupilField::new(args.size, diameter, args.seed)
        .and_then(|field| field.with_pupil(args.pupil.clone()))
        .map_err(|error: SpeckleError| {
            Failure::input(
                error.to_string(),
                "the size Q is --size, the diameter C is --diameter: 8 ≤ C ≤ Q / 2",
            )
        })
}

/// Returns the failure to write where the user asked to: found before the work, it is bad input.
fn cannot_write(path: &Path, error: &io::Error) -> Failure {
    Failure::input(
        format!("cannot write {}: {error}", path.display()),
        "name a file in a folder that exists and may be written",
    )
}

fn description(args: &PatternArgs, field: &PupilField) -> String {
    format!(
        "speckle pattern of mean 1: Q = {}, C = {}, pupil {:?}, {} phasors, seed {}",
        field.size()[0],
        field.diameter()[0],
        args.pupil,
        field.phasor_count(),
        args.seed
    )
}

/// What is written: the intensity or the complex amplitude.
enum Values<'a> {
    Intensity(&'a Grid<f32>),
    Amplitude(&'a Grid<Complex<f32>>),
}

fn write(
    file: &mut (impl Write + io::Seek),
    format: Format,
    values: &Values<'_>,
    description: &str,
) -> Result<(), ImageError> {
    match (format, values) {
        (Format::Npy, Values::Intensity(values)) => write_npy_f32(file, values),
        (Format::Npy, Values::Amplitude(values)) => write_npy_complex(file, values),
        (Format::Exr, Values::Intensity(values)) => {
            write_layer(file, description, vec![("intensity", *values)])
        }
        (Format::Exr, Values::Amplitude(values)) => {
            let (real, imaginary) = (values.map(|u| u.re), values.map(|u| u.im));
            write_layer(
                file,
                description,
                vec![("real", &real), ("imaginary", &imaginary)],
            )
        }
        (Format::Png, Values::Intensity(values)) => write_scaled_png(file, values, description),
        (Format::Png, Values::Amplitude(values)) => {
            write_scaled_png(file, &values.map(Complex::norm_sqr), description)
        }
    }
}

fn write_layer(
    file: &mut (impl Write + io::Seek),
    description: &str,
    channels: Vec<(&'static str, &Grid<f32>)>,
) -> Result<(), ImageError> {
    let layer = Layer {
        name: "pattern".into(),
        wavelength: None,
        comments: description.into(),
        channels,
    };
    write_exr(file, &[layer])
}

fn write_scaled_png(
    file: &mut impl Write,
    values: &Grid<f32>,
    description: &str,
) -> Result<(), ImageError> {
    let white = values
        .values()
        .iter()
        .copied()
        .fold(f32::MIN_POSITIVE, f32::max);
    let text = [
        ("Description", description.to_owned()),
        ("Scale", format!("white is the intensity {white}, linear")),
    ];
    write_grey_png(file, values, white, &text)
}

/// Measures the pattern and lists what theory says.
fn check(field: &PupilField, pattern: &SpecklePattern) -> Result<Vec<Row>, StatisticsError> {
    let values = pattern.values();
    let mut rows = vec![mean_row(field, values)?, contrast_row(field, values)?];
    rows.extend(size_rows(field, values)?);
    rows.extend(distribution_rows(field, values)?);
    rows.push(support_row(field, values)?);
    Ok(rows)
}

fn mean_row(field: &PupilField, values: &Grid<f32>) -> Result<Row, StatisticsError> {
    let mean = Moments::of(values.values())?.mean();
    // Parseval fixes the mean of unit phasors; what is left is the rounding of an f32 transform.
    let rounding = 1e-5;
    let spread = match field.phasors() {
        Some(Phasors::Unit) | None => rounding,
        Some(Phasors::Gaussian) => SIGMAS / to_f64(field.phasor_count()).sqrt(),
    };
    Ok(Row::new("mean", mean, near(1.0, spread)))
}

fn contrast_row(field: &PupilField, values: &Grid<f32>) -> Result<Row, StatisticsError> {
    let contrast = Contrast::of(values.values())?.value();
    let theory = contrast_of_phasor_sum(field.phasor_count());
    let tolerance = SIGMAS * 0.5 * contrast_squared_spread(field);
    Ok(Row::new("contrast", contrast, near(theory, tolerance)))
}

/// Returns the standard deviation of the squared contrast of one pattern.
///
/// ```text
/// 2 √(Σ A(m)²) / N² = 2 (C / N) √(∬ overlap²)        A(m) = N overlap(m / C)
/// ```
fn contrast_squared_spread(field: &PupilField) -> f64 {
    const STEPS: u32 = 200;
    let position = |step: u32| (f64::from(step) + 0.5) / f64::from(STEPS);
    let squares: f64 = (0..STEPS)
        .flat_map(|y| (0..STEPS).map(move |x| [position(x), position(y)]))
        .map(|shift| field.pupil().overlap(shift).powi(2))
        .sum();
    // Four quadrants of the square of the shifts |x|, |y| < 1.
    let integral = 4.0 * squares / f64::from(STEPS * STEPS);
    2.0 * field.diameter()[0] / to_f64(field.phasor_count()) * integral.sqrt()
}

/// Returns the speckle size along both axes, beside that of the pupil's exact autocovariance.
fn size_rows(field: &PupilField, values: &Grid<f32>) -> Result<[Row; 2], StatisticsError> {
    let measured = SpeckleSize::of(values, Boundary::Periodic)?;
    let theory = SpeckleSize::from_autocovariance(&exact_autocovariance(field))?;
    // The size spreads by the share 0.58 / n in a pattern of n × n speckles.
    let spread = SIGMAS * 0.58 / field.effective_diameter();
    let row = |axis, measured: f64, theory: f64| {
        let quantity = format!("speckle size {axis} (samples)");
        Row::new(quantity, measured, near(theory, spread * theory))
    };
    Ok([
        row("x", measured.x(), theory.x()),
        row("y", measured.y(), theory.y()),
    ])
}

/// Returns the autocovariance of the pupil at the lags along both axes; the rest is left 0.
#[expect(
    clippy::cast_possible_truncation,
    reason = "images are stored in single precision"
)]
fn exact_autocovariance(field: &PupilField) -> Grid<f32> {
    let [size, _] = field.size();
    let squared = |lag: [f64; 2]| field.amplitude_correlation(lag).norm_sqr() as f32;
    let mut lags = Grid::filled(size, size, 0.0);
    for lag in 0..size {
        lags[(lag, 0)] = squared([to_f64(lag), 0.0]);
        lags[(0, lag)] = squared([0.0, to_f64(lag)]);
    }
    lags
}

/// Compares the distribution of independent samples with the exponential law.
fn distribution_rows(field: &PupilField, values: &Grid<f32>) -> Result<[Row; 2], StatisticsError> {
    let samples = decorrelated_samples(values, stride(field))?;
    let outcome = kolmogorov_smirnov(&samples, exponential_cumulative)?;
    let critical = CRITICAL_DISTANCE / to_f64(samples.len()).sqrt();
    Ok([
        Row::new(
            "KS distance to exponential",
            outcome.statistic,
            Expectation::AtMost { at_most: critical },
        ),
        Row::new(
            "KS p-value",
            outcome.p_value,
            Expectation::AtLeast {
                at_least: SIGNIFICANCE,
            },
        ),
    ])
}

/// Returns the distance of practically independent samples: the first zero of the autocovariance of
/// the disc as narrow as the pupil.
#[expect(
    clippy::cast_possible_truncation,
    clippy::cast_sign_loss,
    reason = "the stride is positive and far below 2³²"
)]
fn stride(field: &PupilField) -> usize {
    let narrowest = match field.pupil() {
        Pupil::Rectangle { height } => *height,
        _ => 1.0,
    };
    (AIRY_FIRST_ZERO * field.speckle_size() / narrowest).ceil() as usize
}

/// Measures the share of the power beyond the pupil's cut-off frequency, one period per speckle.
fn support_row(field: &PupilField, values: &Grid<f32>) -> Result<Row, StatisticsError> {
    let spectrum = power_spectrum(values)?;
    let ([size, _], [diameter, _]) = (field.size(), field.diameter());
    let frequency = |index: usize| to_f64(index.min(size - index));
    let beyond = |x: f64, y: f64| match field.pupil() {
        Pupil::Rectangle { .. } => x.max(y) > diameter,
        _ => x.hypot(y) > diameter,
    };
    let (mut outside, mut all) = (0.0, 0.0);
    for (y, row) in spectrum.rows().enumerate() {
        for (x, &power) in row.iter().enumerate() {
            all += f64::from(power);
            if beyond(frequency(x), frequency(y)) {
                outside += f64::from(power);
            }
        }
    }
    // Rounding of f32 makes noise of 10⁻¹³ of the power of each frequency.
    let quantity = "power beyond the cut-off frequency";
    Ok(Row::new(
        quantity,
        outside / all,
        Expectation::AtMost { at_most: 1e-6 },
    ))
}

const fn near(value: f64, tolerance: f64) -> Expectation {
    Expectation::Near { value, tolerance }
}

#[expect(clippy::cast_precision_loss, reason = "counts here are far below 2⁵²")]
const fn to_f64(count: usize) -> f64 {
    count as f64
}

#[cfg(test)]
mod tests {
    use approx::assert_relative_eq;

    use super::*;

    fn rows(pupil: Pupil, seed: u64) -> Vec<Row> {
        let field = PupilField::new(256, 64, seed).and_then(|field| field.with_pupil(pupil));
        let field = field.expect("the pupil is valid");
        check(&field, &field.pattern()).expect("the pattern can be measured")
    }

    fn agrees(row: &Row) -> bool {
        match row.theory {
            Expectation::Near { value, tolerance } => (row.measured - value).abs() <= tolerance,
            Expectation::AtLeast { at_least: bound } => row.measured >= bound,
            Expectation::AtMost { at_most: bound } => row.measured <= bound,
            Expectation::Open => true,
        }
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
        let expected = tem00_statistics::contrast_squared_spread(128.0);
        // The counted points of the disc differ from πC²/4 by 0.3 % at most, the sum over 200²
        // midpoints from the integral by less.
        assert_relative_eq!(
            contrast_squared_spread(&field),
            expected,
            max_relative = 4e-3
        );
    }

    #[test]
    fn a_pattern_that_is_too_even_does_not_agree() {
        let field = PupilField::new(256, 64, 0).expect("valid");
        let [a, b] = [1, 2].map(|seed| field.clone().with_seed(seed).pattern());
        // The sum of two patterns: Gamma of shape 2 with the contrast 1/√2.
        let sum = Grid::from_fn(256, 256, |x, y| {
            0.5 * (a.values()[(x, y)] + b.values()[(x, y)])
        });
        assert!(
            !agrees(&contrast_row(&field, &sum).expect("measured")),
            "the contrast is 0.71"
        );
        let rows = distribution_rows(&field, &sum).expect("measured");
        assert!(rows.iter().all(|row| !agrees(row)), "{rows:?}");
        assert!(
            agrees(&mean_row(&field, &sum).expect("measured")),
            "the mean is 1"
        );
    }

    #[test]
    fn the_wrong_pupil_does_not_agree() {
        let field = PupilField::new(256, 64, 0).expect("valid");
        let other = PupilField::new(256, 96, 0).expect("valid").pattern();
        let sizes = size_rows(&field, other.values()).expect("measured");
        assert!(sizes.iter().all(|row| !agrees(row)), "{sizes:?}");
        let support = support_row(&field, other.values()).expect("measured");
        assert!(!agrees(&support), "{support:?}");
    }
}
