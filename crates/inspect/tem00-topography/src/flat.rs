use glam::DVec3;
use tem00_numerics::cast::to_usize;

use crate::{
    Artefact, Estimate, Extreme, Field, ProfileSensor, Shape, SurfacePoint,
    estimate::{expected_range, jackknife, mean, shortest_interval},
    fit::{linear_fit, plane_residuals},
    response::{aside, level_flat},
};

/// The profiles of each repetition: the level flat twice, and two that are tilted.
pub(crate) const PROFILES: usize = 4;
/// The number of places along a profile at which flatness is evaluated.
const PLACES: usize = 64;
/// The fraction of the profile, and of the range of heights, that a flat covers.
const PART: f64 = 0.9;
/// The steepest tilt, as a slope: the slope of 20°.
const STEEPEST: f64 = 0.364;

/// Results of a flat: level, and tilted along and across the profile.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct FlatResult {
    /// The flatness deviation, in metres: the range of the mean heights at 64 places along the
    /// profile, minus the least-squares line through them.
    pub flatness: Extreme,
    /// The measurement noise, in metres: the standard deviation of a height, each repetition on
    /// another piece of the flat. Speckle belongs to it.
    pub measurement_noise: Estimate,
    /// The instrument noise, in metres: the standard deviation of a height where nothing moves,
    /// from the differences of pairs divided by √2. Speckle stays the same and does not show.
    pub instrument_noise: Estimate,
    /// The flat form, in metres, level and tilted along x and y: the distance of the planes,
    /// parallel to the least-squares plane, that enclose 95 % of the points.
    pub form: [Estimate; 3],
    /// The slopes of the tilted flats, along x and y.
    pub slopes: [f64; 2],
}

impl FlatResult {
    /// Measures the flats; `None` if they are not seen.
    pub(crate) fn measure<S: ProfileSensor>(
        sensor: &mut S,
        repetitions: usize,
    ) -> Result<Option<Self>, S::Error> {
        let field = sensor.field();
        let level = level_flat(&field, PART * field.width, repetitions);
        let places = aside(&field, repetitions, 0.0).into_iter();
        let twice: Vec<DVec3> = places.flat_map(|place| [place, place]).collect();
        let pairs = sensor.measure(&level, &twice)?;
        let first: Vec<Vec<SurfacePoint>> = pairs.iter().step_by(2).cloned().collect();
        let slopes = slopes(&field, &level);
        let mut form = vec![form(&first)];
        for slope in [[slopes[0], 0.0], [0.0, slopes[1]]] {
            let tilted = Artefact {
                name: "tilted flat",
                shape: Shape::Flat { slope },
                ..level.clone()
            };
            let middle = 0.5 * (field.heights[0] + field.heights[1]);
            let places = aside(&field, repetitions, middle);
            form.push(self::form(&sensor.measure(&tilted, &places)?));
        }
        let of = || {
            Some(Self {
                flatness: flatness(&first, &field)?,
                measurement_noise: measurement_noise(&first)?,
                instrument_noise: instrument_noise(&pairs)?,
                form: form
                    .into_iter()
                    .collect::<Option<Vec<_>>>()?
                    .try_into()
                    .ok()?,
                slopes,
            })
        };
        Ok(of())
    }
}

/// The tilts along x and y: as steep as allowed, or as steep as the range of heights has room for.
fn slopes(field: &Field, flat: &Artefact) -> [f64; 2] {
    let room = PART * (field.heights[1] - field.heights[0]);
    flat.size.map(|side| STEEPEST.min(room / side))
}

/// The mean heights of a profile at the places along it; NaN where there is no point.
fn at_places(points: &[SurfacePoint], field: &Field) -> [f64; PLACES] {
    let mut sums = [[0.0; 2]; PLACES];
    for point in points {
        let part = (point.position.x / (PART * field.width) + 0.5) * PLACES as f64;
        if (0.0..PLACES as f64).contains(&part) {
            let [sum, count] = &mut sums[to_usize(part)];
            *sum += point.position.z;
            *count += 1.0;
        }
    }
    sums.map(|[sum, count]| sum / count)
}

fn flatness(profiles: &[Vec<SurfacePoint>], field: &Field) -> Option<Extreme> {
    let all: Vec<[f64; PLACES]> = profiles.iter().map(|p| at_places(p, field)).collect();
    let means = |kept: &[usize]| -> Vec<(f64, f64)> {
        let at = |place: usize| mean(&kept.iter().map(|&r| all[r][place]).collect::<Vec<_>>());
        (0..PLACES).map(|place| (place as f64, at(place))).collect()
    };
    let range = |kept: &[usize]| {
        let means = means(kept);
        let [offset, slope] = linear_fit(&means, |&(x, z)| ([1.0, x], z))?;
        let residuals = means.iter().map(|(x, z)| z - offset - slope * x);
        shortest_interval(residuals.collect(), 1.0)
    };
    let found = jackknife(profiles.len(), range)?;
    let variance = |place: usize| {
        let of_place = |kept: &[usize]| Some(means(kept)[place].1);
        jackknife(profiles.len(), of_place).map(|mean| mean.uncertainty.powi(2))
    };
    let variances: Vec<f64> = (0..PLACES).map(variance).collect::<Option<_>>()?;
    Some(Extreme {
        value: found.value,
        uncertainty: found.uncertainty,
        by_chance: mean(&variances).sqrt() * expected_range(PLACES),
    })
}

/// The heights of one column over the repetitions, of each column that all have.
fn by_column(profiles: &[Vec<SurfacePoint>]) -> Vec<Vec<f64>> {
    let columns = profiles
        .iter()
        .flatten()
        .map(|point| point.column + 1)
        .max();
    let mut heights = vec![Vec::new(); columns.unwrap_or(0)];
    for point in profiles.iter().flatten() {
        heights[point.column].push(point.position.z);
    }
    heights.retain(|of_column| of_column.len() == profiles.len());
    heights
}

fn measurement_noise(profiles: &[Vec<SurfacePoint>]) -> Option<Estimate> {
    let heights = by_column(profiles);
    jackknife(profiles.len(), |kept| {
        let variance = |of_column: &Vec<f64>| {
            let values: Vec<f64> = kept.iter().map(|&r| of_column[r]).collect();
            let centre = mean(&values);
            let squares: f64 = values.iter().map(|z| (z - centre).powi(2)).sum();
            squares / (values.len() as f64 - 1.0)
        };
        let variances: Vec<f64> = heights.iter().map(variance).collect();
        (!variances.is_empty()).then(|| mean(&variances).sqrt())
    })
}

fn instrument_noise(pairs: &[Vec<SurfacePoint>]) -> Option<Estimate> {
    let squares = |pair: &[Vec<SurfacePoint>]| -> Vec<f64> {
        let heights = by_column(pair);
        heights.iter().map(|z| (z[1] - z[0]).powi(2)).collect()
    };
    let by_pair: Vec<Vec<f64>> = pairs.chunks_exact(2).map(squares).collect();
    jackknife(by_pair.len(), |kept| {
        let all: Vec<f64> = kept.iter().flat_map(|&r| by_pair[r].clone()).collect();
        (!all.is_empty()).then(|| (0.5 * mean(&all)).sqrt())
    })
}

fn form(profiles: &[Vec<SurfacePoint>]) -> Option<Estimate> {
    jackknife(profiles.len(), |kept| {
        let points: Vec<DVec3> = kept
            .iter()
            .flat_map(|&r| &profiles[r])
            .map(|point| point.position)
            .collect();
        shortest_interval(plane_residuals(&points)?, 0.95)
    })
}
