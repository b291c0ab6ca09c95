use glam::DVec3;

use crate::{
    Artefact, Estimate, Extreme, Field, ProfileSensor, Shape, SurfacePoint,
    estimate::{expected_maximum, jackknife, mean},
    fit::linear_fit,
};

/// The number of heights over the range.
pub(crate) const HEIGHTS: u32 = 9;
/// The fraction of the range that is left out, half of it at either end.
const MARGIN: f64 = 0.1;
/// The fraction of the profile that the flat covers.
const PART: f64 = 0.125;

/// Response of a sensor to a level flat that is lifted through its range.
#[derive(Clone, Debug, PartialEq)]
pub struct Response {
    /// The heights of the flat, in metres.
    pub heights: Vec<f64>,
    /// The mean measured heights minus the heights of the flat, in metres.
    pub deviations: Vec<f64>,
    /// The amplification coefficient: the slope of the line of least squares of measured over true
    /// heights.
    pub amplification: Estimate,
    /// The linearity deviation: the largest distance of a mean measured height from that line, in
    /// metres.
    pub linearity: Extreme,
}

impl Response {
    /// Lifts a flat; `None` if it is not seen at each height and place.
    pub(crate) fn measure<S: ProfileSensor>(
        sensor: &mut S,
        repetitions: usize,
    ) -> Result<Option<Self>, S::Error> {
        let field = sensor.field();
        let flat = level_flat(&field, PART * field.width, repetitions);
        let heights = heights(&field);
        let mut deviations = Vec::new();
        for height in &heights {
            let profiles = sensor.measure(&flat, &aside(&field, repetitions, *height))?;
            let means = profiles.iter().map(|points| mean_height(points));
            deviations.push(means.collect::<Vec<_>>());
        }
        Ok(Self::of(heights, &deviations))
    }

    fn of(heights: Vec<f64>, by_height: &[Vec<f64>]) -> Option<Self> {
        let repetitions = by_height.first()?.len();
        let means = |kept: &[usize]| -> Vec<f64> {
            let of_height =
                |all: &Vec<f64>| mean(&kept.iter().map(|&r| all[r]).collect::<Vec<_>>());
            by_height.iter().map(of_height).collect()
        };
        let line = |kept: &[usize]| fitted(&heights, &means(kept));
        let amplification = jackknife(repetitions, |kept| Some(1.0 + line(kept)?[1]))?;
        let largest = |kept: &[usize]| {
            let [offset, slope] = line(kept)?;
            let means = means(kept);
            let residuals = heights
                .iter()
                .zip(&means)
                .map(|(z, d)| (d - offset - slope * z).abs());
            residuals.reduce(f64::max)
        };
        let linearity = jackknife(repetitions, largest)?;
        let one = |index: usize| {
            jackknife(repetitions, |kept| {
                means(kept).get(index).copied().filter(|d| d.is_finite())
            })
        };
        let errors: Vec<f64> = (0..heights.len())
            .map(|index| one(index).map(|found| found.uncertainty.powi(2)))
            .collect::<Option<_>>()?;
        // Two of the residuals' degrees of freedom are in the line.
        let count = heights.len() as f64;
        let residual = (mean(&errors) * (1.0 - 2.0 / count)).sqrt();
        Some(Self {
            deviations: means(&(0..repetitions).collect::<Vec<_>>()),
            amplification,
            linearity: Extreme {
                value: linearity.value,
                uncertainty: linearity.uncertainty,
                by_chance: residual * expected_maximum(heights.len()),
            },
            heights,
        })
    }
}

/// Offset and slope of deviations over heights.
fn fitted(heights: &[f64], deviations: &[f64]) -> Option<[f64; 2]> {
    let pairs: Vec<(f64, f64)> = heights
        .iter()
        .copied()
        .zip(deviations.iter().copied())
        .collect();
    linear_fit(&pairs, |&(height, deviation)| ([1.0, height], deviation))
}

fn heights(field: &Field) -> Vec<f64> {
    let [low, high] = field.heights;
    let at = |k: u32| {
        let part = 0.5 * MARGIN + (1.0 - MARGIN) * f64::from(k) / f64::from(HEIGHTS - 1);
        low + part * (high - low)
    };
    (0..HEIGHTS).map(at).collect()
}

/// A level flat so wide, and so long that it may be moved aside for each repetition.
pub(crate) fn level_flat(field: &Field, width: f64, repetitions: usize) -> Artefact {
    let steps = 2.0 * repetitions as f64 + 4.0;
    Artefact {
        name: "level flat",
        shape: Shape::Flat { slope: [0.0; 2] },
        size: [width, 2.0 * steps * step_aside(field)],
    }
}

/// The places of repetitions at a height, each of which the line finds with new speckle.
pub(crate) fn aside(field: &Field, repetitions: usize, height: f64) -> Vec<DVec3> {
    let step = step_aside(field);
    let middle = 0.5 * (repetitions as f64 - 1.0);
    let place = |index| DVec3::new(0.0, (index as f64 - middle) * step, height);
    (0..repetitions).map(place).collect()
}

/// Returns the step beyond which none of the light falls on the area that was lit before.
fn step_aside(field: &Field) -> f64 {
    2.0 * field.thickness
}

/// The mean height of a profile; NaN without points.
pub(crate) fn mean_height(points: &[SurfacePoint]) -> f64 {
    mean(&points.iter().map(|p| p.position.z).collect::<Vec<_>>())
}
