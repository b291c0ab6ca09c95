//! Parameters of the sensor from the series, after EMVA 1288.

use tem00::triangulation::{PhotonTransferPoint, RawFrame, SensorDescription, TriangulationError};

use super::Series;

/// The fraction of the saturation up to which lines are fitted.
const LINEAR: f64 = 0.7;

/// Measured parameters, in the units of [`SensorDescription`].
pub(crate) struct Measured {
    /// Mean and temporal variance above those of darkness.
    pub(crate) points: Vec<(f64, f64)>,
    pub(crate) gain: f64,
    quantum_efficiency: f64,
    dark_noise: f64,
    dark_current: f64,
    saturation: f64,
    dsnu: f64,
    prnu: f64,
}

impl Measured {
    pub(crate) fn of(series: &Series) -> Result<Self, TriangulationError> {
        let of_pair = |pair: &[RawFrame]| PhotonTransferPoint::of_pair(&pair[0], &pair[1]);
        let (mut points, mut photons, mut dark) = (Vec::new(), Vec::new(), Vec::new());
        for at in &series.pairs {
            let (bright, darkness) = (of_pair(&at.bright)?, of_pair(&at.dark)?);
            points.push((
                bright.mean - darkness.mean,
                bright.variance - darkness.variance,
            ));
            photons.push(at.photons);
            dark.push((at.time, darkness));
        }
        let saturated = points
            .iter()
            .enumerate()
            .max_by(|(_, a), (_, b)| a.1.total_cmp(&b.1));
        let (saturated, end) =
            saturated.map_or((0, 0.0), |(index, point)| (index, LINEAR * point.0));
        let linear = points
            .iter()
            .zip(&photons)
            .filter(|(point, _)| point.0 <= end);
        let gain = slope(linear.clone().map(|(point, _)| *point));
        let quantum_efficiency = slope(linear.map(|(point, &photons)| (photons, point.0))) / gain;
        let variance = |&(time, point): &(f64, PhotonTransferPoint)| (time, point.variance);
        let (_, variance) = line(dark.iter().map(variance));
        let (current, _) = line(dark.iter().map(|(time, point)| (*time, point.mean)));
        let (bright, darkness) = (
            Stack::of(&series.stacks.bright),
            Stack::of(&series.stacks.dark),
        );
        let response = (bright.variance - darkness.variance).sqrt();
        Ok(Self {
            saturation: quantum_efficiency * photons[saturated],
            dark_noise: (variance - 1.0 / 12.0).sqrt() / gain,
            dark_current: current / gain,
            dsnu: darkness.variance.sqrt() / gain,
            prnu: response / (bright.mean - darkness.mean),
            points,
            gain,
            quantum_efficiency,
        })
    }

    /// The ends of the line that was fitted.
    pub(crate) fn line(&self) -> Vec<(f64, f64)> {
        let end = self.points.iter().map(|point| point.0).fold(0.0, f64::max);
        vec![(0.0, 0.0), (end, self.gain * end)]
    }

    /// Name, measured value and what was put in.
    pub(crate) fn rows(&self, d: &SensorDescription) -> [(&'static str, f64, f64); 7] {
        [
            (
                "quantum efficiency",
                self.quantum_efficiency,
                d.quantum_efficiency,
            ),
            ("gain / (DN/e⁻)", self.gain, d.gain),
            ("dark noise / e⁻", self.dark_noise, d.dark_noise),
            ("dark current / (e⁻/s)", self.dark_current, d.dark_current),
            // The variance is largest at the last exposure of which no well is full.
            ("largest variance at / e⁻", self.saturation, d.full_well),
            ("PRNU", self.prnu, d.prnu),
            ("DSNU / e⁻", self.dsnu, d.dsnu),
        ]
    }
}

/// The slope of the line through the origin that fits best.
fn slope(points: impl Iterator<Item = (f64, f64)>) -> f64 {
    let (xy, xx) = points.fold((0.0, 0.0), |(xy, xx), (x, y)| (xy + x * y, xx + x * x));
    xy / xx
}

/// Slope and offset of the line that fits best.
fn line(points: impl Iterator<Item = (f64, f64)> + Clone) -> (f64, f64) {
    let (n, x, y) = points.clone().fold((0.0, 0.0, 0.0), |(n, sx, sy), (x, y)| {
        (n + 1.0, sx + x, sy + y)
    });
    let slope = slope(points.map(|(px, py)| (px - x / n, py - y / n)));
    (slope, (y - slope * x) / n)
}

/// The mean image of a stack: its mean and its variance without what is left of the temporal noise.
struct Stack {
    mean: f64,
    variance: f64,
}

impl Stack {
    fn of(frames: &[RawFrame]) -> Self {
        let count = frames.len() as f64;
        let pixels = frames
            .first()
            .map_or(0, |frame| frame.values.values().len());
        let of_pixel = |pixel: usize| {
            let values = || {
                frames
                    .iter()
                    .map(|frame| f64::from(frame.values.values()[pixel]))
            };
            moments(values())
        };
        let (means, noise): (Vec<f64>, Vec<f64>) = (0..pixels).map(of_pixel).unzip();
        let (mean, variance) = moments(means.into_iter());
        let (left, _) = moments(noise.into_iter());
        Self {
            mean,
            variance: variance - left / count,
        }
    }
}

/// Mean and variance.
fn moments(values: impl Iterator<Item = f64>) -> (f64, f64) {
    let (mut n, mut mean, mut squares) = (0.0, 0.0, 0.0);
    for value in values {
        // Welford 1962.
        n += 1.0;
        let apart = value - mean;
        mean += apart / n;
        squares += apart * (value - mean);
    }
    (mean, squares / (n - 1.0))
}
