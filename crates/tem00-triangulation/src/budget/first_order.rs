use tem00_statistics::{PixelAutocovariance, PixelColumn};

use super::{BudgetTerm, ErrorDistribution, Evaluation, UncertaintySource};
use crate::{
    ColumnLight, ColumnSpeckle, ImagedLine, LinePoint, PositionNoise, Setup, SetupDescription,
};

/// The positions of the line within a pixel over which the noise is averaged.
const PHASES: u32 = 8;
/// The positions of the line within a pixel over which the bias of the detector is averaged.
const BIAS_PHASES: u32 = 32;
/// The largest distance of two pixels whose covariance counts, in speckle sizes.
const LONGEST: f64 = 4000.0;
/// The noise, in grey values, from which on rounding is as random as it.
const DITHER: f64 = 0.3;

/// A column of the image around the line, without noise.
#[derive(Clone, Debug)]
pub(super) struct NoiseFreeColumn {
    /// The mean electrons that light frees.
    pub(super) electrons: Vec<f64>,
    /// The grey values.
    pub(super) values: Vec<f32>,
    /// The position of the line, in pixels.
    pub(super) centre: f64,
}

impl NoiseFreeColumn {
    /// Returns the column whose line is `phase` of a pixel behind its middle.
    #[expect(clippy::cast_possible_truncation, reason = "images are f32")]
    pub(super) fn new(setup: &Setup, line: &ImagedLine, phase: f64) -> Self {
        let rows = rows(setup.description(), line);
        let centre = (rows / 2) as f64 + phase;
        let sensor = setup.description().sensor;
        let dark = setup.sensor().dark_electrons();
        let profile = line.profile(rows as f64);
        let electrons: Vec<f64> = (0..rows)
            .map(|y| line.column_electrons * profile.at(y as f64 + 0.5 - centre))
            .collect();
        let grey = |&e: &f64| (sensor.black_level + sensor.gain * (e + dark)) as f32;
        Self {
            values: electrons.iter().map(grey).collect(),
            electrons,
            centre,
        }
    }

    /// Returns the line that the detector finds, if any.
    pub(super) fn found(&self, setup: &Setup) -> Option<LinePoint> {
        brightest(setup.detector().detect_column(&self.values))
    }
}

/// Returns the point of the greatest peak.
pub(super) fn brightest(points: Vec<LinePoint>) -> Option<LinePoint> {
    points
        .into_iter()
        .reduce(|best, next| if next.peak > best.peak { next } else { best })
}

/// Returns the number of rows that a column needs: the line, the window wherever the line is, and as
/// much again for the background; but no more than the image has.
#[expect(
    clippy::cast_possible_truncation,
    clippy::cast_sign_loss,
    reason = "lines are at most a third of an image wide"
)]
pub(super) fn rows(description: &SetupDescription, line: &ImagedLine) -> usize {
    let [_, height] = description.camera.resolution;
    let wide = (3.0 * line.width).ceil() as usize;
    let needed = (2 * description.detector.window).max(description.detector.window + wide) + 16;
    needed.min(height)
}

/// Returns all terms of the budget of a line, or `None` if the detector finds none.
pub(super) fn terms(setup: &Setup, line: &ImagedLine) -> Option<Vec<BudgetTerm>> {
    let noise = position_noise(setup, line)?;
    let bias = detector_bias(setup, line)?;
    let calibration = setup.description().calibration_uncertainty;
    let terms = UncertaintySource::ALL.map(|source| {
        let (distribution, variance) = match source {
            UncertaintySource::Speckle => (ErrorDistribution::Normal, noise.speckle),
            UncertaintySource::ShotNoise => (ErrorDistribution::Normal, noise.shot),
            UncertaintySource::DarkNoise => (ErrorDistribution::Normal, noise.dark),
            UncertaintySource::Quantisation => (ErrorDistribution::Rectangular, noise.quantisation),
            UncertaintySource::Prnu => (ErrorDistribution::Normal, noise.prnu),
            UncertaintySource::Dsnu => (ErrorDistribution::Normal, noise.dsnu),
            UncertaintySource::DetectorBias => (ErrorDistribution::Periodic, bias * bias),
            UncertaintySource::Calibration => {
                (ErrorDistribution::Normal, calibration * calibration)
            }
        };
        BudgetTerm {
            source,
            evaluation: Evaluation::B,
            distribution,
            uncertainty: variance.max(0.0).sqrt(),
            sensitivity: match source {
                UncertaintySource::Calibration => 1.0,
                _ => line.height_per_pixel,
            },
            degrees_of_freedom: f64::INFINITY,
        }
    });
    Some(terms.to_vec())
}

/// Returns the variances of the position of the line after all averages, in square pixels.
fn position_noise(setup: &Setup, line: &ImagedLine) -> Option<PositionNoise> {
    let d = setup.description();
    let (autocovariance, fewer) = autocovariance(d, line)?;
    let speckle = Some(ColumnSpeckle {
        autocovariance: &autocovariance,
        variance: d.surface.contrast().powi(2) * line.bandwidth.line_noise * fewer,
    });
    let mut sum = PositionNoise::default();
    for phase in 0..PHASES {
        // Between them: at an edge or a middle two pixels would be equally bright.
        let phase = (f64::from(phase) + 0.5) / f64::from(PHASES);
        let column = NoiseFreeColumn::new(setup, line, phase);
        let point = column.found(setup)?;
        let light = ColumnLight {
            electrons: &column.electrons,
            coherent: &column.electrons,
            sensitivities: &setup.detector().sensitivities(&column.values, &point),
        };
        let noise = PositionNoise::of_column(&d.sensor, &speckle, &light);
        sum = plus(sum, noise);
    }
    Some(averaged(d, sum.scaled(1.0 / f64::from(PHASES))))
}

fn plus(a: PositionNoise, b: PositionNoise) -> PositionNoise {
    PositionNoise {
        speckle: a.speckle + b.speckle,
        shot: a.shot + b.shot,
        dark: a.dark + b.dark,
        quantisation: a.quantisation + b.quantisation,
        prnu: a.prnu + b.prnu,
        dsnu: a.dsnu + b.dsnu,
    }
}

/// Divides by the numbers of columns and frames that each source is independent in; of the columns,
/// those of speckle are counted already.
fn averaged(d: &SetupDescription, noise: PositionNoise) -> PositionNoise {
    let columns = f64::from(d.average.columns);
    let frames = f64::from(d.average.frames);
    let sensor = &d.sensor;
    let dark = sensor.dark_noise.powi(2) + sensor.dark_current * sensor.exposure_time;
    let dithered = sensor.gain * dark.sqrt() >= DITHER;
    PositionNoise {
        speckle: noise.speckle
            / if d.average.independent_speckle {
                frames
            } else {
                1.0
            },
        shot: noise.shot / (columns * frames),
        dark: noise.dark / (columns * frames),
        quantisation: noise.quantisation / (columns * if dithered { frames } else { 1.0 }),
        prnu: noise.prnu / columns,
        dsnu: noise.dsnu / columns,
    }
}

/// Returns the autocovariance of the mean of the columns that are averaged, and a factor on it: beyond
/// 4000 speckles columns are counted as independent groups.
#[expect(
    clippy::cast_possible_truncation,
    clippy::cast_sign_loss,
    reason = "positive numbers of pixels, at most 64 times 4000"
)]
fn autocovariance(d: &SetupDescription, line: &ImagedLine) -> Option<(PixelAutocovariance, f64)> {
    let [along, across] = line.speckle_size;
    let side = line.sensitive_height;
    let most = |size: f64| (LONGEST * size).floor().max(1.0) as usize;
    // Farther apart, both see little light or hardly the same speckle: 10⁻³ of its variance or less.
    let reach = (2.5 * line.width).ceil() as usize + 2;
    let columns = d.average.columns as usize;
    let together = columns.min(most(along));
    let autocovariance = PixelAutocovariance::new(&PixelColumn {
        size: [side / along, side / across],
        pitch: [1.0 / along, 1.0 / across],
        pixels: rows(d, line).min(reach).min(most(across)),
        averaged_columns: together,
    });
    let fewer = together as f64 / columns as f64;
    autocovariance.ok().map(|found| (found, fewer))
}

/// Returns the root mean square of what the detector errs by on noise-free lines, in pixels.
fn detector_bias(setup: &Setup, line: &ImagedLine) -> Option<f64> {
    let mut squares = 0.0;
    for phase in 0..BIAS_PHASES {
        let phase = (f64::from(phase) + 0.5) / f64::from(BIAS_PHASES);
        let column = NoiseFreeColumn::new(setup, line, phase);
        squares += (column.found(setup)?.position - column.centre).powi(2);
    }
    Some((squares / f64::from(BIAS_PHASES)).sqrt())
}
