use tem00_numerics::cast::to_signed;
use tem00_statistics::laws::{LitArea, ObjectiveSpeckle};
use tem00_testkit::assert_absolute;

use super::*;

fn fields(size: usize, diameter: usize, seeds: u64) -> Vec<PupilField> {
    (0..seeds)
        .map(|seed| PupilField::new(size, diameter, seed).unwrap())
        .collect()
}

fn mean(values: impl ExactSizeIterator<Item = f64>) -> f64 {
    let count = values.len() as f64;
    values.sum::<f64>() / count
}

#[test]
fn airy_pattern_is_the_correlation_with_the_effective_diameter() {
    let field = PupilField::new(256, 32, 0).unwrap();
    for lag in [1.0, 2.5, 4.0, 8.0, 11.0, 16.0] {
        let argument = PI * lag * field.effective_diameter() / 256.0;
        let airy = tem00_numerics::jinc(argument).powi(2);
        let exact = field.amplitude_correlation([lag, 0.0]).norm_sqr();
        // The lattice disc is not quite round: at most 1.2e−3 along the axes at C = 32.
        assert_absolute(exact, airy, 1.3e-3);
    }
}

#[test]
fn speckles_of_a_pattern_that_is_not_square_are_round() {
    let field = PupilField::from_speckle_size([300, 200], 3.2, 0).unwrap();
    for lag in [0.5, 1.0, 2.0, 3.0, 5.0, 8.0] {
        let along = |lag| field.amplitude_correlation(lag).re;
        let round = tem00_numerics::jinc(PI * lag / 3.2);
        for (x, y) in [(1.0, 0.0), (0.0, 1.0), (0.6, 0.8), (-0.8, 0.6)] {
            let exact = along([x * lag, y * lag]);
            // The lattice disc is not quite round: 2e−3 of amplitude at C = 63.
            assert_absolute(exact, round, 4e-3);
        }
    }
}

#[test]
fn displaced_pupils_share_the_phasors_of_their_overlap() {
    let slanted = Grid::from_fn(10, 10, |x, y| {
        Complex::from_polar(1.0 / (1.0 + 0.1 * y as f32), 0.2 * x as f32)
    });
    let slanted = crate::Transmission::from_complex(slanted).unwrap();
    for pupil in [Pupil::Circle, Pupil::Sampled(slanted)] {
        let field = PupilField::new(48, 20, 11).unwrap();
        let field = field.with_pupil(pupil).unwrap();
        let here = field.speckle([0.0; 2], 0.0);
        for shift in [[3, 0], [-4, 9], [20, 0], [24, -11]] {
            let there = field.speckle(shift.map(|s| s as f64 / 20.0), 0.0);
            let mut sum = Complex::new(0.0, 0.0);
            for y in 0..48 {
                for x in 0..48 {
                    let turns = (shift[0] * to_signed(x) + shift[1] * to_signed(y)) as f64 / 48.0;
                    let frame = Complex::cis(-2.0 * PI * turns);
                    let (a, b) = (here.values()[(x, y)], there.values()[(x, y)]);
                    let product = a * b.conj();
                    sum +=
                        Complex::new(f64::from(product.re), f64::from(product.im)) * frame.conj();
                }
            }
            // Parseval: the mean of U₁ U₂* in the common frame is the sum over shared phasors.
            let correlation = sum / 2_304.0;
            let error = (correlation - field.overlap(shift)).norm();
            assert!(error < 1e-6, "{shift:?}: {correlation}");
        }
    }
}

#[test]
fn gaussian_phasors_let_the_mean_of_a_tile_fluctuate() {
    const TILES: u32 = 200;
    let variance = mean(fields(32, 16, u64::from(TILES)).into_iter().map(|field| {
        let pattern = field.with_phasors(Phasors::Gaussian).pattern();
        (mean(pattern.values().values().iter().map(|&i| f64::from(i))) - 1.0).powi(2)
    }));
    // The mean of N = 197 exponentials has the variance 1/N. The estimate from n tiles deviates
    // by √((2 + 6/N)/n) of it: 3.3 standard deviations, α = 1e−3.
    let ratio = variance * 197.0;
    let tolerance = 3.3 * (2.03 / f64::from(TILES)).sqrt();
    assert!((ratio - 1.0).abs() < tolerance, "variance · N = {ratio}");
}

#[test]
fn without_a_lens_the_field_is_correlated_as_the_lit_area_demands() {
    let (wavelength, distance) = (532e-9, 0.8);
    let (width, height, radius) = (1.5e-3, 0.9e-3, 0.3e-3);
    let pitch = wavelength * distance / width / 2.5;
    let areas = [
        (Pupil::Circle, LitArea::Disc { diameter: width }, 2e-3),
        // 161 by 73 lattice points for 160 by 72 have speckles finer by 1/160 and 1/72, and the
        // correlation a slope of 1.1 per logarithm of the lag at most.
        (
            Pupil::Rectangle {
                height: height / width,
            },
            LitArea::Rectangle { width, height },
            1.1 / 72.0,
        ),
        // Cut off at 2.5 radii, which leaves √4e−6 of the amplitude.
        (
            Pupil::Gaussian {
                radius: radius / width,
            },
            LitArea::GaussianSpot { radius },
            2e-3,
        ),
    ];
    for (pupil, area, tolerance) in areas {
        let law = ObjectiveSpeckle::new(wavelength, distance, area).unwrap();
        let field = PupilField::from_speckle_size([400, 300], 2.5, 1).unwrap();
        let field = field.with_pupil(pupil).unwrap();
        for lag in [
            [0.0, 0.0],
            [1.0, 0.0],
            [0.0, 1.5],
            [2.0, 2.5],
            [-4.0, 3.0],
            [6.5, 0.0],
        ] {
            let exact = field.amplitude_correlation(lag).norm_sqr();
            let expected = law.autocovariance(lag.map(|samples| samples * pitch));
            assert_absolute(exact, expected, tolerance);
        }
    }
}
