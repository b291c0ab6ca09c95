use core::f64::consts::PI;
use libm::{erf, erfc};
use num_complex::Complex;
use tem00_numerics::jinc;
use tem00_testkit::{assert_absolute, assert_relative};

use super::*;
use crate::{CellGeometry, DVec3, PeakShape, Relief};

/// A direction in the plane of incidence, by its angle to the normal in degrees.
pub(crate) fn direction(degrees: f64) -> DVec3 {
    let (sin, cos) = degrees.to_radians().sin_cos();
    DVec3::new(sin, 0.0, cos)
}

/// A camera of sin u = 0.025 and a source in one plane, by their angles in degrees.
pub(crate) fn cell(
    wavelength: f64,
    incidence: f64,
    observation: f64,
    rms_height: f64,
) -> ResolutionCell {
    let geometry = CellGeometry {
        to_source: direction(incidence),
        to_pupil: direction(observation),
        normal: DVec3::Z,
        sin_aperture: 0.025,
        wavelength,
    };
    let relief = Relief {
        rms_height,
        correlation_length: 0.0,
    };
    ResolutionCell::new(geometry)
        .unwrap()
        .with_relief(relief)
        .unwrap()
}

pub(crate) fn gaussian(wavelength: f64, linewidth: f64) -> Spectrum {
    Spectrum::new(wavelength, linewidth, PeakShape::Gaussian).unwrap()
}

pub(crate) const fn of<'a>(
    spectrum: &'a Spectrum,
    cell: &'a ResolutionCell,
) -> PolychromaticSpeckle<'a> {
    PolychromaticSpeckle { spectrum, cell }
}

fn contrast(spectrum: &Spectrum, cell: &ResolutionCell) -> f64 {
    of(spectrum, cell).contrast()
}

#[test]
fn without_a_tilt_contrasts_have_closed_forms() {
    let cell = cell(450e-9, -30.0, 30.0, 1.6e-6);
    let r = cell.path_spread();
    let lines = |shape| Spectrum::new(450e-9, 7e-9, shape).unwrap();
    let full = 2.0 * PI * 7e-9 / 450e-9_f64.powi(2);
    let squares = [
        (PeakShape::Gaussian, {
            let sigma = full / (8.0 * core::f64::consts::LN_2).sqrt();
            (1.0 + (2.0 * sigma * r).powi(2)).sqrt().recip()
        }),
        (
            PeakShape::Lorentzian,
            (full * r).powi(2).exp() * erfc(full * r),
        ),
        (PeakShape::Rectangular, {
            let b = full * r;
            PI.sqrt() * erf(b) / b - (1.0 - (-b * b).exp()) / (b * b)
        }),
    ];
    for (shape, squared) in squares {
        let spectrum = &lines(shape);
        let found = contrast(spectrum, &cell);
        assert_relative(found * found, squared, 1e-8);
        // The speckles are as in one wavelength, and their covariance is the Airy pattern.
        let speckle = of(spectrum, &cell);
        for (lag, airy) in [([0.0, 0.0], 1.0), ([0.5, 0.0], jinc(0.5 * PI).powi(2))] {
            let found = speckle.autocovariance(lag);
            assert_relative(found, squared * airy, 1e-7);
        }
    }
    let two = Spectrum::from_peaks(&[[450e-9, 2.0], [453e-9, 1.0]]).unwrap();
    let kappa = 2.0 * PI * (1.0 / 450e-9 - 1.0 / 453e-9);
    let squared = (4.0 + 1.0 + 4.0 * (-(kappa * r).powi(2)).exp()) / 9.0;
    assert_relative(contrast(&two, &cell).powi(2), squared, 1e-12);
}

#[test]
fn a_table_of_contrasts_and_line_noise_is_met() {
    // λ in nm, height in µm; then C and σ_x over one wavelength at 1, 5, 20 and 40 nm.
    let table = [
        (
            450.0,
            0.4,
            [0.984, 0.921, 0.716, 0.551],
            [0.991, 0.950, 0.788, 0.625],
        ),
        (
            450.0,
            1.6,
            [0.982, 0.888, 0.595, 0.435],
            [0.989, 0.913, 0.631, 0.463],
        ),
        (
            450.0,
            6.0,
            [0.959, 0.684, 0.364, 0.258],
            [0.964, 0.695, 0.371, 0.263],
        ),
        (
            660.0,
            0.4,
            [0.989, 0.947, 0.800, 0.652],
            [0.994, 0.967, 0.863, 0.733],
        ),
        (
            660.0,
            6.0,
            [0.983, 0.849, 0.514, 0.369],
            [0.988, 0.863, 0.528, 0.379],
        ),
    ];
    for (wavelength, height, contrasts, noises) in table {
        let cell = cell(wavelength * 1e-9, 0.0, 30.0, height * 1e-6);
        for (i, linewidth) in [1e-9, 5e-9, 20e-9, 40e-9].into_iter().enumerate() {
            let spectrum = gaussian(wavelength * 1e-9, linewidth);
            let speckle = of(&spectrum, &cell);
            assert_absolute(speckle.contrast(), contrasts[i], 1.1e-3);
            assert_absolute(speckle.line_noise_ratio(Rows::Thin), noises[i], 1.1e-3);
        }
    }
}

#[test]
fn shapes_of_one_width_differ() {
    let cell = cell(450e-9, 0.0, 30.0, 1.6e-6);
    let shaped = |shape| Spectrum::new(450e-9, 10e-9, shape).unwrap();
    let lines = [
        (shaped(PeakShape::Lorentzian), 0.556),
        (
            Spectrum::from_peaks(&[[445e-9, 1.0], [455e-9, 1.0]]).unwrap(),
            0.757,
        ),
        (shaped(PeakShape::Gaussian), 0.765),
        (Spectrum::comb(450e-9, 10e-9, 5).unwrap(), 0.798),
        (shaped(PeakShape::Rectangular), 0.835),
    ];
    for (spectrum, expected) in lines {
        assert_absolute(contrast(&spectrum, &cell), expected, 6e-4);
    }
}

#[test]
fn a_gaussian_line_has_an_approximate_closed_form() {
    for (incidence, observation, height, linewidth) in [
        (0.0, 30.0, 0.4e-6, 20e-9),
        (0.0, 30.0, 1.6e-6, 5e-9),
        (20.0, 45.0, 2.5e-6, 15e-9),
        (30.0, 0.0, 6e-6, 10e-9),
    ] {
        let (cell, spectrum) = (
            cell(450e-9, incidence, observation, height),
            gaussian(450e-9, linewidth),
        );
        let (sigma, tilt) = (spectrum.wave_number_spread(), cell.tilt_wave_number());
        let speckle = of(&spectrum, &cell);
        let approximate = |linear: f64, square: f64| {
            let q =
                1.0 + 4.0 * sigma.powi(2) * (cell.path_spread().powi(2) + square / tilt.powi(2));
            let x = linear * sigma / (tilt * q.sqrt());
            ((x * x).exp() * erfc(x) / q.sqrt()).sqrt()
        };
        assert_absolute(speckle.contrast(), approximate(2.40, 2.80), 3e-3);
        assert_absolute(
            speckle.line_noise_ratio(Rows::Thin),
            approximate(1.30, 2.31),
            4e-3,
        );
        assert_absolute(
            speckle.line_noise_ratio(Rows::Tall),
            approximate(1.05, 1.97),
            4e-3,
        );
    }
}

/// Sums over a lattice of wave numbers and of points of two displaced pupils, which do not use
/// chat.
#[test]
fn frames_and_grains_of_a_tilted_cell() {
    let cell = cell(450e-9, 0.0, 30.0, 0.0);
    let spread = 0.15 * cell.tilt_wave_number();
    let linewidth =
        spread * (8.0 * core::f64::consts::LN_2).sqrt() * 450e-9_f64.powi(2) / (2.0 * PI);
    let spectrum = gaussian(450e-9, linewidth);
    let speckle = of(&spectrum, &cell);
    let lattice = |shift: [f64; 2], lag: [f64; 2]| {
        let (mut sum, mut count) = (Complex::ZERO, 0.0);
        let places = || (-60..=60).map(|i| f64::from(i) / 60.25);
        for (x, y) in places().flat_map(|x| places().map(move |y| (x, y))) {
            let is_first = x.hypot(y) < 1.0;
            let is_second = (x + 2.0 * shift[0]).hypot(y + 2.0 * shift[1]) < 1.0;
            count += f64::from(u8::from(is_first));
            if is_first && is_second {
                sum += Complex::cis(PI * (lag[0] * x + lag[1] * y));
            }
        }
        (sum / count).norm_sqr()
    };
    let mean = |displacement: [f64; 2], lag: [f64; 2]| {
        let steps = (-60..=60).map(|i| f64::from(i) / 15.0);
        let weight = |x: f64| (-0.25 * x * x).exp();
        let total: f64 = steps.clone().map(weight).sum();
        let values =
            steps.map(|x| weight(x) * lattice([displacement[0] + 0.15 * x, displacement[1]], lag));
        values.sum::<f64>() / total
    };
    for displacement in [[0.0, 0.0], [0.25, 0.0], [0.0, 0.25], [0.5, 0.0], [0.0, 0.5]] {
        let expected = mean(displacement, [0.0, 0.0]);
        assert_absolute(speckle.covariance(displacement), expected, 4e-3);
    }
    for lag in [[1.0, 0.0], [0.0, 1.0], [0.4, 0.3]] {
        let expected = mean([0.0, 0.0], lag);
        assert_absolute(speckle.autocovariance(lag), expected, 3e-3);
    }
    assert_relative(
        speckle.covariance([0.0, 0.0]),
        speckle.contrast().powi(2),
        1e-12,
    );
}

#[test]
fn long_relief_spreads_no_paths() {
    let (spectrum, cell) = (gaussian(450e-9, 20e-9), cell(450e-9, 0.0, 0.0, 1.6e-6));
    let long = |length: f64| {
        let relief = Relief {
            rms_height: 1.6e-6,
            correlation_length: length * cell.speckle_size(),
        };
        contrast(&spectrum, &cell.clone().with_relief(relief).unwrap())
    };
    assert_absolute(long(1e-3), contrast(&spectrum, &cell), 1e-3);
    // Waves over scatterers, whose errors are 0.006, 0.007, 0.005 and 0.004.
    for (length, waves) in [(0.5, 0.757), (1.0, 0.815), (2.0, 0.885), (4.0, 0.937)] {
        assert_absolute(long(length), waves, 3e-3);
    }
    assert!(long(300.0) > 0.999);
}

#[test]
fn a_defocused_cell_mixes_the_paths_of_its_blur() {
    let (spectrum, cell) = (gaussian(450e-9, 20e-9), cell(450e-9, 0.0, 30.0, 0.0));
    for defocus in [1.5e-3, -1.5e-3] {
        let cell = cell.clone().with_defocus(defocus).unwrap();
        assert_absolute(contrast(&spectrum, &cell), 0.401, 1e-3);
    }
}

#[test]
fn a_table_of_displacements_has_the_closed_forms_until_the_pupils_part() {
    let (thin, tall) = (Rows::Thin.tabulated(), Rows::Tall.tabulated());
    for distance in [0.0, 0.1, 0.375, 0.8, 0.995, 1.0, 1.2, 7.0] {
        let shared = f64::min(distance, 1.0);
        // Nodes are 1/96 apart, and f″ is 3 at most; of discs that part it grows, in the last cell,
        // by a root.
        let along = 1.0 - 1.5 * shared + 0.5 * shared.powi(3);
        for side in [-distance, distance] {
            assert_absolute(thin(DVec2::new(side, 0.0)), along, 5e-5);
        }
        let overlap = 2.0 / PI * (shared.acos() - shared * (1.0 - shared * shared).sqrt());
        for turn in [0.0, 0.7, 1.571, 2.4, -1.0] {
            let found = tall(distance * DVec2::from_angle(turn));
            assert_absolute(found, overlap, 2e-4);
        }
    }
}

#[test]
fn rows_lie_between_thin_and_tall_ones() {
    let (spectrum, cell) = (gaussian(450e-9, 20e-9), cell(450e-9, 0.0, 30.0, 0.0));
    let speckle = of(&spectrum, &cell);
    let deviation = |rows| speckle.line_noise_ratio(rows);
    let [thin, tall] = [Rows::Thin, Rows::Tall].map(deviation);
    for none in [0.0, -1.0, f64::NAN] {
        assert_absolute(deviation(Rows::Height(none)), thin, 1e-5);
    }
    assert_absolute(deviation(Rows::Height(0.01)), thin, 1e-4);
    assert_absolute(deviation(Rows::Height(39.0)), tall, 3e-3);
    assert_absolute(deviation(Rows::Height(41.0)), tall, 1e-5);
    let heights = [0.01, 0.3, 1.0, 3.0, 8.0, 39.0];
    let between = heights.map(|height| deviation(Rows::Height(height)));
    assert!(between.is_sorted(), "{between:?}");
    // Waves: 0.831 ± 0.019.
    assert_absolute(between[4], 0.831, 4e-3);
}

#[test]
fn the_wings_of_a_lorentzian_end_on_a_long_relief() {
    let relief = Relief {
        rms_height: 1.6e-6,
        correlation_length: 2e-6,
    };
    let cell = cell(450e-9, 0.0, 30.0, 0.0).with_relief(relief).unwrap();
    let spectrum = Spectrum::new(450e-9, 1e-9, PeakShape::Lorentzian).unwrap();
    let speckle = of(&spectrum, &cell);
    let noise = speckle.line_noise_ratio(Rows::Thin);
    assert!(speckle.contrast() < noise && noise < 1.0, "{noise}");
}

#[test]
fn lines_too_narrow_for_a_reciprocal_are_of_one_wavelength() {
    let cell = cell(450e-9, 0.0, 30.0, 1.6e-6);
    for shape in [
        PeakShape::Gaussian,
        PeakShape::Lorentzian,
        PeakShape::Rectangular,
    ] {
        for linewidth in [5e-324, 1e-300, 1e-30] {
            let spectrum = Spectrum::new(450e-9, linewidth, shape).unwrap();
            assert_absolute(contrast(&spectrum, &cell), 1.0, 1e-9);
        }
    }
}
