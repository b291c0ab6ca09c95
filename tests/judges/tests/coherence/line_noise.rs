//! How far speckle of a broad source moves a laser line.

use std::f64::consts::PI;

use tem00::{
    DVec3,
    coherence::{
        CellGeometry, PeakShape, PolychromaticSpeckle, Relief, ResolutionCell, Rows, Spectrum,
    },
    wave::Estimate,
};

use super::{
    bench::{Bench, BenchSpectrum, View, plane_of_incidence},
    contrast::cell,
    heights::Heights,
    sums::{assert_agrees, assert_refutes, for_surfaces},
};

/// Radius of the line, in speckles, to 1/e² of its intensity.
const WIDTH: f64 = 4.0;
const STEPS: i32 = 9;

/// Mean squares of the first moments of one surface, of all wave numbers together and of single
/// ones.
type Squares = [f64; 2];

/// Returns the moments of the rows of an image about the middle of the line, in pixels.
fn moments(image: &[f64], columns: usize) -> Vec<f64> {
    let place = |x: usize| {
        let is_left = 2 * x >= columns;
        x as f64 - if is_left { columns as f64 } else { 0.0 }
    };
    let moment = |row: &[f64]| row.iter().enumerate().map(|(x, i)| place(x) * i).sum();
    image.chunks_exact(columns).map(moment).collect()
}

fn mean_square(values: &[f64]) -> f64 {
    values.iter().map(|value| value * value).sum::<f64>() / values.len() as f64
}

/// The mean over all rows, as a row has that is much taller than a speckle.
fn tall(moments: &[f64]) -> Vec<f64> {
    vec![moments.iter().sum::<f64>() / moments.len() as f64]
}

/// Returns the root of the ratio of two mean squares, and its error from leaving out one surface at
/// a time.
fn ratio(surfaces: &[Squares]) -> Estimate {
    let sum = |i: usize| surfaces.iter().map(|squares| squares[i]).sum::<f64>();
    let total = [sum(0), sum(1)];
    let without = |squares: &Squares| ((total[0] - squares[0]) / (total[1] - squares[1])).sqrt();
    let partial: Vec<f64> = surfaces.iter().map(without).collect();
    let spread = Estimate::of_repetitions(&partial).expect("surfaces");
    Estimate {
        value: (total[0] / total[1]).sqrt(),
        standard_error: spread.standard_error * (surfaces.len() - 1) as f64,
    }
}

#[test]
fn lines_of_a_broad_source_scatter_as_the_law_says_and_not_as_their_contrast() {
    let view = plane_of_incidence(0.0, 30.0);
    let mut bench = Bench::new(view, [24, 8], Heights::Flat);
    bench.step *= 2.0;
    let spectrum = BenchSpectrum::gaussian(bench.view.wavelength, bench.step, STEPS, 20e-9);
    let columns = bench.pixels()[0];
    let surfaces = for_surfaces(400, 4, |random| {
        let surface = bench.surface(random, |x| (-(x / WIDTH).powi(2)).exp());
        let images = &bench.images(&surface, STEPS, &[View::default()], random)[0];
        let mixed = moments(&spectrum.mix(images), columns);
        let single: Vec<_> = images.iter().map(|image| moments(image, columns)).collect();
        let all_single = |pixel: fn(&[f64]) -> Vec<f64>| {
            single
                .iter()
                .map(|rows| mean_square(&pixel(rows)))
                .sum::<f64>()
                / single.len() as f64
        };
        [
            [mean_square(&mixed), all_single(<[f64]>::to_vec)],
            [mean_square(&tall(&mixed)), all_single(tall)],
        ]
    });
    let cell = cell(view, 0.0, 0.0);
    let law = PolychromaticSpeckle {
        spectrum: &spectrum.line,
        cell: &cell,
    };
    for (i, (rows, tolerance)) in [(Rows::Thin, 0.015), (Rows::Tall, 0.06)]
        .into_iter()
        .enumerate()
    {
        let waves = ratio(&surfaces.iter().map(|s| s[i]).collect::<Vec<_>>());
        let expected = law.line_noise_ratio(rows);
        assert_agrees(&format!("{rows:?}"), waves, expected, tolerance);
        if rows == Rows::Thin {
            assert_refutes("contrast", waves, law.contrast());
        }
    }
}

/// Numbers by the transform of the lens that two discs along the rows share, squared, over all
/// distances of the discs: the kernel of thin rows.
#[test]
fn long_relief_leaves_a_line_its_noise() {
    const WAVELENGTH: f64 = 450e-9;
    const SIN_APERTURE: f64 = 0.025;
    let line = Spectrum::new(WAVELENGTH, 20e-9, PeakShape::Gaussian).expect("a line");
    let sigma = line.wave_number_spread();
    let noise = |[spread, tilt, length]: [f64; 3]| {
        // The tilt is the sine of the incidence, for a camera along the normal.
        let sine = tilt / sigma * 4.0 * PI * SIN_APERTURE / WAVELENGTH;
        let cell = ResolutionCell::new(CellGeometry {
            to_source: DVec3::new(sine, 0.0, (1.0 - sine * sine).sqrt()),
            to_pupil: DVec3::Z,
            normal: DVec3::Z,
            sin_aperture: SIN_APERTURE,
            wavelength: WAVELENGTH,
        });
        let cell = cell.expect("a cell");
        let relief = Relief {
            rms_height: spread / sigma / cell.height_factor(),
            correlation_length: length * cell.speckle_size(),
        };
        let cell = cell.with_relief(relief).expect("a relief");
        let (line, cell) = (&line, &cell);
        PolychromaticSpeckle {
            spectrum: line,
            cell,
        }
        .line_noise_ratio(Rows::Thin)
    };
    for (case, thin, tolerance) in [
        ([0.65, 0.0, 0.5], 0.8288, 5e-3),
        ([0.65, 0.0, 2.0], 0.9328, 5e-3),
        ([1.5, 0.0, 1.0], 0.7194, 5e-3),
        ([1.5, 0.0, 4.0], 0.9011, 5e-3),
        ([0.65, 0.15, 1.0], 0.8129, 1e-2),
        ([0.65, 0.15, 4.0], 0.8626, 1e-2),
        ([2.0, 0.1, 0.5], 0.5518, 1e-2),
        ([2.0, 0.1, 2.0], 0.7540, 1e-2),
        ([1.0, 0.05, 4.0], 0.9211, 1e-2),
    ] {
        let found = noise(case);
        assert!((found - thin).abs() < tolerance, "{case:?}: {found}");
    }
    // Short relief is as none of correlation, long one as none of height.
    for (case, limit) in [
        ([0.65, 0.15, 1e-3], [0.65, 0.15, 0.0]),
        ([0.65, 0.15, 300.0], [0.0, 0.15, 0.0]),
    ] {
        let [found, limit] = [case, limit].map(noise);
        assert!((found - limit).abs() < 2e-3, "{case:?}: {found}, {limit}");
    }
}
