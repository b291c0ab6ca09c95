use tem00_numerics::cast::{to_f32, to_usize};
use tem00_statistics::laws::{PixelAutocovariance, PixelColumn};

use super::{BudgetTerm, ErrorDistribution, Evaluation, UncertaintySource};
use crate::{
    ColumnLight, ImagedLine, LinePoint, PositionNoise, Setup, SetupDescription, setup::LineProfile,
    speckle_covariance,
};

/// The positions of the line within a pixel over which the noise is averaged.
const PHASES: u32 = 8;
/// The positions of the line within a pixel over which the bias of the detector is averaged.
const BIAS_PHASES: u32 = 32;
/// The largest distance of two pixels whose covariance counts, in speckle sizes.
const LONGEST: f64 = 4000.0;
/// The noise, in grey values, from which on rounding is as random as the noise.
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
    pub(super) fn new(setup: &Setup, line: &ColumnProfile, phase: f64) -> Self {
        let centre = (line.rows / 2) as f64 + phase;
        let sensor = setup.description().sensor;
        let dark = setup.sensor().dark_electrons();
        let electrons: Vec<f64> = (0..line.rows)
            .map(|y| line.electrons * line.profile.at(y as f64 + 0.5 - centre))
            .collect();
        let grey = |&e: &f64| to_f32(sensor.black_level + sensor.gain * (e + dark));
        Self {
            values: electrons.iter().map(grey).collect(),
            electrons,
            centre,
        }
    }

    /// Returns the light of the column, all of it speckled, for a position with these
    /// sensitivities.
    fn light<'a>(&'a self, sensitivities: &'a [f64]) -> ColumnLight<'a> {
        ColumnLight {
            electrons: &self.electrons,
            coherent: &self.electrons,
            sensitivities,
        }
    }

    /// Returns the sensitivities of the centre of gravity of the whole column.
    fn centroid_sensitivities(&self, gain: f64) -> Vec<f64> {
        let all = gain * self.electrons.iter().sum::<f64>();
        let rows = 0..self.electrons.len();
        rows.map(|y| (y as f64 + 0.5 - self.centre) / all).collect()
    }

    /// Returns the line that the detector finds, if any.
    pub(super) fn found(&self, setup: &Setup) -> Option<LinePoint> {
        brightest(setup.detector().detect_column(&self.values))
    }
}

/// The image of a line in columns of `rows` rows.
#[derive(Clone, Debug)]
pub(super) struct ColumnProfile {
    rows: usize,
    /// The mean electrons that light frees in a column.
    electrons: f64,
    profile: LineProfile,
}

impl ColumnProfile {
    pub(super) fn new(setup: &Setup, line: &ImagedLine) -> Self {
        let rows = rows(setup.description(), line);
        Self {
            rows,
            electrons: line.column_electrons,
            profile: line.profile(rows as f64),
        }
    }
}

/// Returns the point of the greatest peak.
pub(super) fn brightest(points: Vec<LinePoint>) -> Option<LinePoint> {
    points
        .into_iter()
        .reduce(|best, next| if next.peak > best.peak { next } else { best })
}

/// Returns the number of rows that a column needs: the line, the window wherever the line is, and
/// as much again for the background; but no more than the image has.
pub(super) fn rows(description: &SetupDescription, line: &ImagedLine) -> usize {
    let [_, height] = description.camera.resolution;
    let wide = to_usize((3.0 * line.width).ceil());
    let needed = (2 * description.detector.window).max(description.detector.window + wide) + 16;
    needed.min(height)
}

/// Returns all terms of the budget of a line, or `None` if the detector finds none.
///
/// `law` is the standard deviation, in pixels, that speckle gives the centre of gravity of all
/// light in the columns that are averaged, before the linewidth counts.
pub(super) fn terms(setup: &Setup, line: &ImagedLine, law: f64) -> Option<Vec<BudgetTerm>> {
    let profile = ColumnProfile::new(setup, line);
    let noise = position_noise(setup, line, (&profile, law))?;
    let bias = detector_bias(setup, &profile)?[1];
    let calibration = setup.description().calibration_uncertainty;
    let terms = UncertaintySource::ALL.map(|source| {
        let variance = match source {
            UncertaintySource::Speckle => noise.speckle,
            UncertaintySource::ShotNoise => noise.shot,
            UncertaintySource::DarkNoise => noise.dark,
            UncertaintySource::Quantisation => noise.quantisation,
            UncertaintySource::Prnu => noise.prnu,
            UncertaintySource::Dsnu => noise.dsnu,
            UncertaintySource::DetectorBias => bias * bias,
            UncertaintySource::Calibration => calibration * calibration,
        };
        let distribution = match source {
            UncertaintySource::Quantisation => ErrorDistribution::Rectangular,
            UncertaintySource::DetectorBias => ErrorDistribution::Periodic,
            _ => ErrorDistribution::Normal,
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
///
/// A speckle pattern times the image of the line shows how detector and window weigh the light; the
/// law of a line that a lens images gives how much speckle moves all of the light.
fn position_noise(
    setup: &Setup,
    line: &ImagedLine,
    (profile, law): (&ColumnProfile, f64),
) -> Option<PositionNoise> {
    let d = setup.description();
    let autocovariance = autocovariance(d, line)?;
    let speckle = |[_, rows]: [f64; 2]| autocovariance.covariance(to_usize(rows.abs().round()));
    let mut sum = PositionNoise::default();
    let mut of_all_light = 0.0;
    for phase in 0..PHASES {
        // Between them: at an edge or a middle two pixels would be equally bright.
        let phase = (f64::from(phase) + 0.5) / f64::from(PHASES);
        let column = NoiseFreeColumn::new(setup, profile, phase);
        let point = column.found(setup)?;
        let by_detector = setup.detector().sensitivities(&column.values, &point);
        let light = column.light(&by_detector);
        let noise = PositionNoise::of_column(&d.sensor, speckle, &light);
        sum = sum.with(noise, |sum, term| sum + term);
        let by_centroid = column.centroid_sensitivities(d.sensor.gain);
        let light = column.light(&by_centroid);
        of_all_light += speckle_covariance(&d.sensor, speckle, [&light; 2], [0.0; 2]);
    }
    let mean = sum.scaled(1.0 / f64::from(PHASES));
    // The law is that of a Gaussian line.
    let speckle = match line.is_spread() {
        true => d.surface.contrast().powi(2) * mean.speckle,
        false => law.powi(2) * sum.speckle / of_all_light,
    };
    let mean = PositionNoise {
        speckle: line.bandwidth.line_noise_ratio.powi(2) * speckle,
        ..mean
    };
    Some(averaged(d, mean))
}

/// Divides by the numbers of columns and frames that each source is independent in; for speckle,
/// the columns are counted already.
fn averaged(d: &SetupDescription, noise: PositionNoise) -> PositionNoise {
    let columns = f64::from(d.average.columns);
    let frames = f64::from(d.average.frames);
    let sensor = &d.sensor;
    let dark = sensor.dark_noise.powi(2) + sensor.dark_current * sensor.exposure_time;
    let dithered = sensor.gain * dark.sqrt() >= DITHER;
    let frames_if = |averages: bool| if averages { frames } else { 1.0 };
    let counts = PositionNoise {
        speckle: frames_if(d.average.independent_speckle),
        shot: columns * frames,
        dark: columns * frames,
        quantisation: columns * frames_if(dithered),
        prnu: columns,
        dsnu: columns,
    };
    noise.with(counts, |variance, count| variance / count)
}

/// Returns the autocovariance of speckle in the mean of the columns that are averaged, of the first
/// 4000 speckles of them.
fn autocovariance(d: &SetupDescription, line: &ImagedLine) -> Option<PixelAutocovariance> {
    let [along, across] = line.speckle_size;
    let side = line.sensitive_height;
    let within = |size: f64| to_usize((LONGEST * size).floor().max(1.0));
    // Farther apart, both see little light or hardly the same speckle: 10⁻³ of its variance or
    // less.
    let reach = to_usize((2.5 * line.width).ceil()) + 2;
    PixelAutocovariance::new(&PixelColumn {
        size: [side / along, side / across],
        pitch: [1.0 / along, 1.0 / across],
        pixels: rows(d, line).min(reach).min(within(across)),
        averaged_columns: (d.average.columns as usize).min(within(along)),
    })
    .ok()
}

/// Returns the shift of a line by light from below the surface, as the detector finds it, in
/// pixels: 0 without such light, and `None` if the detector finds no line.
pub(super) fn subsurface_shift(setup: &Setup, line: &ImagedLine) -> Option<f64> {
    if !line.is_spread() {
        return Some(0.0);
    }
    let [shift, _] = detector_bias(setup, &ColumnProfile::new(setup, line))?;
    Some(shift)
}

/// Returns the shift of noise-free lines by light from below the surface, and the root mean square
/// error of the detector about it, in pixels.
fn detector_bias(setup: &Setup, profile: &ColumnProfile) -> Option<[f64; 2]> {
    let errors = (0..BIAS_PHASES).map(|phase| {
        let phase = (f64::from(phase) + 0.5) / f64::from(BIAS_PHASES);
        let column = NoiseFreeColumn::new(setup, profile, phase);
        Some(column.found(setup)?.position - column.centre)
    });
    let errors: Vec<f64> = errors.collect::<Option<_>>()?;
    let count = f64::from(BIAS_PHASES);
    let shift = match setup.line().is_spread() {
        true => errors.iter().sum::<f64>() / count,
        false => 0.0,
    };
    let squares: f64 = errors.iter().map(|error| (error - shift).powi(2)).sum();
    Some([shift, (squares / count).sqrt()])
}
