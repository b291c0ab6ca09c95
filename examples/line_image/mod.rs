//! Common to example and test of thin laser lines: images of a line on a rough surface by
//! wave optics, the same by a speckle pattern times an irradiance, and what an engineer reads off.
//!
//! Lengths are in speckle sizes h, on the surface and in the image alike.

use core::f64::consts::{PI, TAU};
use std::error::Error;

use tem00::{
    numerics::{Grid, disc_overlap},
    speckle::PupilField,
    wave::{
        Amplitudes, Arrangement, Camera, DVec2, DVec3, FanDescription, Illumination, ImageSampling,
        ImageWindow, Lens, PatchDescription, RoughSurface, Roughness,
    },
};

/// Samples of the image in a speckle size.
const SAMPLES_PER_SPECKLE: usize = 4;

/// Width and height of an image, in speckle sizes.
const IMAGE: usize = 64;

/// Length of the line that is looked at, in speckle sizes: its ends and their blur stay outside.
const LOOKED_AT: usize = 40;

const WAVELENGTH: f64 = 650e-9;
const DISTANCE: f64 = 0.3;
const LENS: Lens = Lens {
    pupil_diameter: 4e-3,
    focus_distance: DISTANCE,
    pupil_to_image: 0.06,
};

/// A row of an image: irradiances across the line.
pub(crate) type Row = Vec<f64>;

/// Returns where the samples of a row lie, from the middle of the line in speckle sizes.
pub(crate) fn positions() -> impl Iterator<Item = f64> {
    let middle = (IMAGE / 2) as f64;
    (0..IMAGE * SAMPLES_PER_SPECKLE).map(move |x| x as f64 / SAMPLES_PER_SPECKLE as f64 - middle)
}

/// Sums the waves of a rough surface under a line with the 1/e² half-width `width`, and returns the
/// rows of its image.
pub(crate) fn by_wave_optics(width: f64, seed: u64) -> Result<Vec<Row>, Box<dyn Error>> {
    let on_surface = WAVELENGTH * DISTANCE / LENS.pupil_diameter;
    let up = DVec3::Y;
    let eye = DVec3::new(0.0, 0.0, DISTANCE);
    let camera = Camera::look_at([eye, DVec3::ZERO], up, LENS)?;
    let window = ImageWindow::new(
        &camera,
        &ImageSampling {
            wavelength: WAVELENGTH,
            centre: DVec2::ZERO,
            step: WAVELENGTH * LENS.pupil_to_image
                / (LENS.pupil_diameter * SAMPLES_PER_SPECKLE as f64),
            samples: IMAGE * SAMPLES_PER_SPECKLE,
        },
    )?;
    let line = Illumination::fan(&FanDescription {
        wavelength: WAVELENGTH,
        apex: DVec3::Z,
        direction: DVec3::NEG_Z,
        opening: up,
        half_angle: 0.1,
        waist_radius: width * on_surface,
        waist_distance: 1.0,
    })?;
    // Independent scatterers half a line or half a speckle apart, out to 1e-4 of the irradiance.
    let [across, along] = [4.4 * width, 56.0];
    let spacing = 0.5 * width.min(1.0);
    #[expect(
        clippy::cast_possible_truncation,
        clippy::cast_sign_loss,
        reason = "small numbers"
    )]
    let scatterers = [across / spacing, along / 0.5].map(|count| count.ceil() as usize);
    let surface = RoughSurface::patch(&PatchDescription {
        centre: DVec3::ZERO,
        normal: DVec3::Z,
        along: DVec3::X,
        size: [across * on_surface, along * on_surface],
        scatterers,
        arrangement: Arrangement::Lattice,
        roughness: Roughness::FullyDeveloped(Amplitudes::ComplexGaussian),
        seed,
    })?;
    let image = window.image(&surface.lit_by(&line)).intensity();
    Ok(looked_at(&image).collect())
}

/// Multiplies the rows of a speckle pattern by a profile.
pub(crate) fn by_pattern(profile: &[f64], seed: u64) -> Result<Vec<Row>, Box<dyn Error>> {
    let pattern = PupilField::new(IMAGE * SAMPLES_PER_SPECKLE, IMAGE, seed)?.pattern();
    let lit = |row: Row| row.iter().zip(profile).map(|(i, e)| i * e).collect();
    Ok(looked_at(pattern.values()).map(lit).collect())
}

/// Returns the irradiance on the surface across a line, as its geometric image.
pub(crate) fn geometric_profile(width: f64) -> Row {
    positions()
        .map(|x| (-2.0 * (x / width).powi(2)).exp())
        .collect()
}

/// Returns the incoherent image of a line: its irradiance blurred by the lens.
///
/// ```text
/// E(x) ∝ ∫ exp(−π² w² ν² / 2) chat(h ν) cos(2π ν x) dν
/// ```
pub(crate) fn blurred_profile(width: f64) -> Row {
    const STEPS: u32 = 200;
    let at = |x: f64| {
        let term = |i: u32| {
            let frequency = (f64::from(i) + 0.5) / f64::from(STEPS);
            let line = (-0.5 * (PI * width * frequency).powi(2)).exp();
            line * disc_overlap(frequency) * (TAU * frequency * x).cos()
        };
        (0..STEPS).map(term).sum::<f64>()
    };
    positions().map(at).collect()
}

/// What many rows tell of a line.
pub(crate) struct Measured {
    /// Full width of the mean profile at half its maximum.
    pub(crate) width: f64,
    /// Standard deviation of the centroid of a row, where the line is.
    pub(crate) centroid_noise: f64,
    /// Correlation of intensities half a speckle size left and right of the middle.
    pub(crate) across: f64,
    /// Standard deviation of the power in a row, in units of its mean.
    pub(crate) row_contrast: f64,
}

impl Measured {
    /// Reads the rows of a line with the 1/e² half-width `width`.
    pub(crate) fn of(rows: &[Row], width: f64) -> Self {
        // Far from the line a lens leaves rings, whose leverage no detector would allow.
        let near = |x: f64| x.abs() <= 1.5 * width + 1.25;
        let (mut centroids, mut powers) = (Vec::new(), Vec::new());
        for row in rows {
            let lit = || positions().zip(row).filter(|(x, _)| near(*x));
            let power: f64 = lit().map(|(_, i)| i).sum();
            centroids.push(lit().map(|(x, i)| x * i).sum::<f64>() / power);
            powers.push(power);
        }
        let middle = IMAGE * SAMPLES_PER_SPECKLE / 2;
        let beside = [middle - 2, middle + 2].map(|x| rows.iter().map(move |row| row[x]));
        let [left, right] = beside.map(Iterator::collect::<Vec<_>>);
        let spread = |values: &[f64]| covariance(values, values).sqrt();
        Self {
            width: full_width(&mean_profile(rows)),
            centroid_noise: spread(&centroids),
            across: covariance(&left, &right) / (spread(&left) * spread(&right)),
            row_contrast: spread(&powers) / mean(&powers),
        }
    }
}

/// Returns the mean of all rows.
pub(crate) fn mean_profile(rows: &[Row]) -> Row {
    let columns = 0..IMAGE * SAMPLES_PER_SPECKLE;
    let mean = |x: usize| rows.iter().map(|row| row[x]).sum::<f64>() / rows.len() as f64;
    columns.map(mean).collect()
}

/// The rows along which the line is looked at.
fn looked_at(image: &Grid<f32>) -> impl Iterator<Item = Row> {
    let first = (IMAGE - LOOKED_AT) / 2 * SAMPLES_PER_SPECKLE;
    let rows = image
        .rows()
        .skip(first)
        .take(LOOKED_AT * SAMPLES_PER_SPECKLE);
    rows.map(|row| row.iter().copied().map(f64::from).collect())
}

fn mean(values: &[f64]) -> f64 {
    values.iter().sum::<f64>() / values.len() as f64
}

fn covariance(a: &[f64], b: &[f64]) -> f64 {
    let (mean_a, mean_b) = (mean(a), mean(b));
    let products = a.iter().zip(b).map(|(a, b)| (a - mean_a) * (b - mean_b));
    products.sum::<f64>() / a.len() as f64
}

/// Full width at half maximum, with straight lines between the samples.
fn full_width(profile: &[f64]) -> f64 {
    let half = 0.5 * profile.iter().copied().fold(0.0, f64::max);
    let points: Vec<_> = positions().zip(profile.iter().copied()).collect();
    let crossings = points.windows(2).filter_map(|pair| {
        let [(x0, y0), (x1, y1)] = [pair[0], pair[1]];
        ((y0 < half) != (y1 < half)).then(|| x0 + (x1 - x0) * (half - y0) / (y1 - y0))
    });
    let crossings: Vec<_> = crossings.collect();
    match (crossings.first(), crossings.last()) {
        (Some(first), Some(last)) => last - first,
        _ => 0.0,
    }
}
