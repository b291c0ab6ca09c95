//! `tem00 stats`: the speckle in an image of any origin.

use std::{io::Write, path::Path};

use serde::Serialize;
use tem00_numerics::Grid;
use tem00_statistics::{
    AIRY_FIRST_ZERO, Boundary, Contrast, GammaIntensity, Moments, SpeckleSize, StatisticsError,
    TestOutcome, decorrelated_samples, exponential_cumulative, kolmogorov_smirnov,
};

use crate::{
    args::StatsArgs,
    failure::Failure,
    image::{LoadedImage, read_image},
    table::{Expectation, Row, write_table},
};

/// How many standard errors the tolerance of the contrast allows.
const SIGMAS: f64 = 4.0;

/// The fewest independent samples that say something about a distribution.
const FEWEST_SAMPLES: usize = 20;

/// What was found in an image.
#[derive(Debug, Serialize)]
struct Measurement {
    image: String,
    width: usize,
    height: usize,
    interpretation: String,
    rows: Vec<Row>,
    assumptions: Vec<String>,
}

/// Measures an image and prints the table, or JSON.
///
/// # Errors
///
/// Returns a failure if the image cannot be read or holds no speckle to measure.
pub(crate) fn run(args: &StatsArgs, out: &mut impl Write) -> Result<(), Failure> {
    let cannot = |error: &dyn core::fmt::Display, help: &str| {
        Failure::input(format!("{}: {error}", args.image.display()), help)
    };
    let image = read_image(&args.image, args.channel.as_deref(), args.transfer)
        .map_err(|error| cannot(&error, "give a .png, .exr or .npy image of light"))?;
    let measurement = measure(&args.image, &image)
        .map_err(|error| cannot(&error, "give an image that light and speckle fill"))?;
    print(&measurement, args.json, out)
}

fn print(measurement: &Measurement, json: bool, out: &mut impl Write) -> Result<(), Failure> {
    if json {
        let text = serde_json::to_string_pretty(measurement)
            .map_err(|error| Failure::running(format!("cannot write JSON: {error}")))?;
        return writeln!(out, "{text}").map_err(|error| Failure::stdout(&error));
    }
    let mut notes = std::io::stderr().lock();
    // Notes that cannot be shown are no reason to withhold the data.
    let _ = writeln!(
        notes,
        "{}: {}",
        measurement.image, measurement.interpretation
    );
    for assumption in &measurement.assumptions {
        let _ = writeln!(notes, "note: {assumption}");
    }
    write_table(&measurement.rows, out).map_err(|error| Failure::stdout(&error))
}

fn measure(path: &Path, image: &LoadedImage) -> Result<Measurement, StatisticsError> {
    let values = &image.values;
    let moments = Moments::of(values.values())?;
    let contrast = Contrast::of(values.values())?;
    let mut rows = vec![Row::new("mean", moments.mean(), Expectation::Open)];
    let mut assumptions = vec![
        "the light is taken as even over the image: its own shape would count as contrast".into(),
        "contrast 1 and the exponential law are those of one fully developed, polarised pattern, \
         seen through pixels much smaller than a speckle"
            .into(),
    ];
    if let Some(share) = image.saturated {
        rows.push(Row::new(
            "saturated share of pixels",
            share,
            Expectation::AtMost { at_most: 1e-3 },
        ));
    }
    let size = match SpeckleSize::of(values, Boundary::Finite) {
        Ok(size) => Some(size),
        Err(StatisticsError::Unresolved { .. }) => {
            assumptions.push("the speckles are smaller than a pixel: their size is not known and all pixels are taken as independent".into());
            None
        }
        Err(error) => return Err(error),
    };
    rows.push(contrast_row(contrast, size)?);
    if let Some(size) = size {
        assumptions.push(
            "the speckle size is that of a circular pupil, λ d / D, as seen by the pixels, which \
             widen it"
                .into(),
        );
        rows.push(Row::new(
            "speckle size x (pixels)",
            size.x(),
            Expectation::Open,
        ));
        rows.push(Row::new(
            "speckle size y (pixels)",
            size.y(),
            Expectation::Open,
        ));
    }
    let stride = size.map_or(1, |size| first_zero(size.x().max(size.y())));
    rows.extend(distribution_rows(
        values,
        stride,
        moments.mean(),
        contrast.value(),
        &mut assumptions,
    )?);
    Ok(Measurement {
        image: path.display().to_string(),
        width: values.width(),
        height: values.height(),
        interpretation: image.interpretation.clone(),
        rows,
        assumptions,
    })
}

fn contrast_row(contrast: Contrast, size: Option<SpeckleSize>) -> Result<Row, StatisticsError> {
    let contrast = match size {
        Some(size) => contrast.with_speckle_size(size.mean())?,
        None => contrast,
    };
    let theory = Expectation::Near {
        value: 1.0,
        tolerance: SIGMAS * contrast.standard_error(),
    };
    Ok(Row::new("contrast", contrast.value(), theory))
}

/// Compares independent samples with the exponential law and with the Gamma law of the same
/// contrast.
fn distribution_rows(
    values: &Grid<f32>,
    stride: usize,
    mean: f64,
    contrast: f64,
    assumptions: &mut Vec<String>,
) -> Result<Vec<Row>, StatisticsError> {
    let mut samples = decorrelated_samples(values, stride)?;
    if samples.len() < FEWEST_SAMPLES {
        assumptions.push(format!(
            "the image holds only {} independent samples: its distribution is not tested",
            samples.len()
        ));
        return Ok(Vec::new());
    }
    samples.iter_mut().for_each(|sample| *sample /= mean);
    let mut rows = vec![Row::new(
        "independent samples",
        count(samples.len()),
        Expectation::Open,
    )];
    let exponential = kolmogorov_smirnov(&samples, exponential_cumulative)?;
    rows.extend(test_rows("exponential", exponential));
    if let Ok(law) = GammaIntensity::from_contrast(contrast) {
        rows.push(Row::new("shape 1/C²", law.shape(), Expectation::Open));
        let gamma = kolmogorov_smirnov(&samples, |intensity| law.cumulative(intensity))?;
        rows.extend(test_rows("Gamma of shape 1/C²", gamma));
        assumptions
            .push("mean and shape were fitted to the image: p-values are on the high side".into());
    }
    Ok(rows)
}

fn test_rows(law: &str, outcome: TestOutcome) -> [Row; 2] {
    [
        Row::new(
            format!("KS distance to {law}"),
            outcome.statistic,
            Expectation::Open,
        ),
        Row::new(
            format!("KS p-value of {law}"),
            outcome.p_value,
            Expectation::AtLeast { at_least: 1e-3 },
        ),
    ]
}

/// Returns the first zero of the autocovariance of speckles of a size in pixels, rounded up.
#[expect(
    clippy::cast_possible_truncation,
    clippy::cast_sign_loss,
    reason = "speckle sizes are positive and below the size of the image"
)]
fn first_zero(speckle_size: f64) -> usize {
    (AIRY_FIRST_ZERO * speckle_size).ceil() as usize
}

#[expect(clippy::cast_precision_loss, reason = "there are at most 2²⁸ samples")]
fn count(samples: usize) -> f64 {
    samples as f64
}

#[cfg(test)]
mod tests {
    use tem00_speckle::PupilField;

    use super::*;

    fn measured(values: Grid<f32>) -> Measurement {
        let image = LoadedImage {
            values,
            interpretation: "computed".into(),
            saturated: None,
        };
        measure(Path::new("pattern"), &image).expect("the image can be measured")
    }

    fn row<'a>(measurement: &'a Measurement, quantity: &str) -> &'a Row {
        let mut rows = measurement.rows.iter();
        rows.find(|row| row.quantity == quantity)
            .expect("the row is there")
    }

    /// A window out of a pattern with speckles of 4 samples, and a brightness of its own.
    fn window(seed: u64) -> Grid<f32> {
        let pattern = PupilField::new(512, 128, seed).expect("valid").pattern();
        Grid::from_fn(400, 300, |x, y| 7.0 * pattern.values()[(x, y)])
    }

    #[test]
    fn fully_developed_speckle_is_recognised() {
        let found = measured(window(3));
        let Expectation::Near { value, tolerance } = row(&found, "contrast").theory else {
            panic!("the contrast has a theory");
        };
        assert!(
            (row(&found, "contrast").measured - value).abs() < tolerance,
            "{found:?}"
        );
        // The size spreads by 0.58 / n; the window is at least 75 speckles wide: 3 % are 4 σ.
        for axis in ["x", "y"] {
            let size = row(&found, &format!("speckle size {axis} (pixels)")).measured;
            assert!(
                (size / 4.0 - 1.0).abs() < 0.031,
                "speckle size {axis} is {size}"
            );
        }
        assert!(
            row(&found, "KS p-value of exponential").measured > 1e-3,
            "{found:?}"
        );
    }

    #[test]
    fn averaged_speckle_is_gamma_and_not_exponential() {
        let (a, b) = (window(4), window(5));
        let sum = Grid::from_fn(400, 300, |x, y| a[(x, y)] + b[(x, y)]);
        let found = measured(sum);
        assert!(
            row(&found, "KS p-value of exponential").measured < 1e-6,
            "{found:?}"
        );
        assert!(
            row(&found, "KS p-value of Gamma of shape 1/C²").measured > 1e-3,
            "{found:?}"
        );
        // C² spreads by 1.53/n, n about 85, times 1/2 of a sum of two: 4 σ of the shape 2.
        assert!(
            (row(&found, "shape 1/C²").measured - 2.0).abs() < 0.3,
            "{found:?}"
        );
    }

    #[test]
    fn speckle_below_a_pixel_is_measured_without_a_size() {
        let pattern = PupilField::new(512, 256, 6).expect("valid").pattern();
        // Every fifth sample at a speckle size of 2: nothing correlates.
        let sparse = Grid::from_fn(100, 100, |x, y| pattern.values()[(5 * x, 5 * y)]);
        let found = measured(sparse);
        assert!(
            found.rows.iter().all(|row| !row.quantity.contains("size")),
            "{found:?}"
        );
        assert!(
            row(&found, "KS p-value of exponential").measured > 1e-3,
            "{found:?}"
        );
    }

    #[test]
    fn an_even_image_is_no_speckle() {
        let image = LoadedImage {
            values: Grid::filled(20, 20, 1.0),
            interpretation: "computed".into(),
            saturated: None,
        };
        assert!(
            measure(Path::new("grey"), &image).is_err(),
            "nothing varies"
        );
    }
}
