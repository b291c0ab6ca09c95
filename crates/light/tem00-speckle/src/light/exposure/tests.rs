use proptest::prelude::*;
use tem00_numerics::{cast::to_signed, disc_overlap};
use tem00_statistics::{
    laws::{boiling_contrast, translation_contrast},
    t_test_mean,
};
use tem00_testkit::{assert_absolute, assert_relative};

use super::*;
use crate::Phasors;

fn exposure(image_drift: [f64; 2], pupil_drift: [f64; 2]) -> Exposure {
    let exposure = Exposure::default().with_image_drift(image_drift).unwrap();
    exposure.with_pupil_drift(pupil_drift).unwrap()
}

fn mean(pattern: &SpecklePattern, of: impl Fn(f64) -> f64) -> f64 {
    let values = pattern.values().values();
    values.iter().map(|&i| of(f64::from(i))).sum::<f64>() / values.len() as f64
}

/// The intensity at any point, by the sum over the lattice points of the displaced circle.
fn direct_intensity(field: &PupilField, offset: [f64; 2], r: [f64; 2]) -> f64 {
    let (mut sum, mut count) = (Complex::new(0.0, 0.0), 0.0);
    let [c_x, c_y] = field.diameter();
    let reach = to_signed(field.size()[0]);
    for (kx, ky) in (-reach..=reach).flat_map(|kx| (-reach..=reach).map(move |ky| (kx, ky))) {
        let [x, y] = [kx as f64 / c_x - offset[0], ky as f64 / c_y - offset[1]];
        if x.hypot(y) > 0.5 {
            continue;
        }
        let [width, height] = field.size().map(|n| n as f64);
        let phasor = field.phasor([kx, ky]);
        let phasor = Complex::new(f64::from(phasor.re), f64::from(phasor.im));
        sum += phasor * wave(-(kx as f64 * r[0] / width + ky as f64 * r[1] / height));
        count += 1.0;
    }
    sum.norm_sqr() / count
}

#[test]
fn an_exposure_without_motion_is_the_pattern() {
    let field = PupilField::new(32, 16, 3).unwrap();
    let still = Exposure::default();
    assert_eq!(still.pattern(&field), field.pattern(), "bit for bit");
    let (offset, defocus) = ([0.4, -0.2], 1.5);
    let pattern = field.pattern_at(offset, defocus);
    assert_eq!(
        still.pattern_at(&field, offset, defocus),
        pattern,
        "bit for bit"
    );
}

#[test]
fn exposures_are_the_integral_of_the_moving_intensity() {
    const STEPS: usize = 60;
    let field = PupilField::from_speckle_size([20, 24], 2.3, 5).unwrap();
    let offset = [0.13, -0.21];
    for (image_drift, pupil_drift) in [
        ([1.7, 0.0], [0.0, 0.0]),
        ([-0.6, 1.1], [0.0, 0.0]),
        ([1.3, -0.8], [0.031, 0.017]),
        ([0.0, 0.0], [-0.029, 0.041]),
    ] {
        let exposure = exposure(image_drift, pupil_drift);
        let pattern = exposure.pattern_at(&field, offset, 0.0);
        for r in [[3, 4], [19, 0]] {
            let mut sum = 0.0;
            let count = exposure.moments() as f64;
            for moment in 0..exposure.moments() {
                // The middles of equal parts of the time, and the middle of all at 0.
                let time = (2.0 * moment as f64 + 1.0 - count) / (2.0 * count);
                let place = [0, 1].map(|axis| offset[axis] + pupil_drift[axis] * time);
                for step in 0..STEPS {
                    let part = (step as f64 + 0.5) / STEPS as f64 - 0.5;
                    let moment = time + part / count;
                    let at = [0, 1].map(|axis| {
                        r[axis] as f64 - image_drift[axis] * field.speckle_size() * moment
                    });
                    sum += direct_intensity(&field, place, at);
                }
            }
            let expected = sum / (STEPS as f64 * count);
            let got = f64::from(pattern.values()[(r[0], r[1])]);
            // The midpoint rule: (2π T/STEPS)²/24 = 1.3e−3 of the parts of highest frequency, which
            // hold a hundredth of the intensity.
            assert_absolute(got, expected, 2e-4);
        }
    }
}

#[test]
fn contrasts_follow_the_laws_of_drift() {
    // Behind a circle only the length of a drift matters.
    let diagonal = |drift: f64| [0.6 * drift, -0.8 * drift];
    for (exposure, contrast) in [
        (exposure([1.0, 0.0], [0.0; 2]), translation_contrast(1.0)),
        (exposure(diagonal(3.0), [0.0; 2]), translation_contrast(3.0)),
        (exposure([0.0; 2], [0.3, 0.0]), boiling_contrast(0.3)),
        (exposure([0.0; 2], diagonal(1.0)), boiling_contrast(1.0)),
    ] {
        // Gaussian phasors have the covariance |μ|² without bias, about the expected mean.
        let squares = (0..24).map(|seed| {
            let field = PupilField::new(64, 32, seed).unwrap();
            let field = field.with_phasors(Phasors::Gaussian);
            mean(&exposure.pattern(&field), |i| (i - 1.0).powi(2))
        });
        let squares: Vec<f64> = squares.collect();
        // α = 1e−4 each; the tiles are independent. The excess of the quadrature, below 1e−3, is a
        // tenth of the standard error.
        let outcome = t_test_mean(&squares, contrast * contrast).unwrap();
        assert!(outcome.p_value > 1e-4, "{outcome:?} of {exposure:?}");
    }
}

#[test]
fn the_quadrature_exceeds_the_law_of_boiling_as_stated() {
    for drift in [1e-6, 1e-3, 0.02, 0.1, 0.3, 0.9, 1.0, 2.5, 10.0] {
        let exposure = exposure([0.0; 2], [drift, 0.0]);
        let times: Vec<f64> = exposure.times().collect();
        let count = times.len() as f64;
        let pairs = times.iter().flat_map(|a| times.iter().map(move |b| a - b));
        let squared: f64 = pairs.map(|t| disc_overlap(t * drift).powi(2)).sum();
        let excess = squared / (count * count) - boiling_contrast(drift).powi(2);
        let left = 1.0 - disc_overlap(drift).powi(2);
        let stated = (4.0 * drift / (3.0 * PI) + left / 6.0) / (count * count);
        // The next order is of the drift per moment, a 30th.
        assert_relative(excess, stated, 0.08);
        assert!(excess < 1e-3, "{excess:e} at {drift}");
    }
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(48))]

    #[test]
    fn any_exposure_has_the_mean_one_and_no_negative_intensity(
        seed: u64, angle in -4.0..4.0_f64, size in -30.0..6.0_f64, pupil in -30.0..0.3_f64,
    ) {
        let direction = [0.99 * angle.cos(), 0.99 * angle.sin()];
        let image = direction.map(|x| x * 10.0_f64.powf(size));
        let pupil = direction.map(|x| x * 10.0_f64.powf(pupil));
        let field = PupilField::from_speckle_size([18, 20], 2.1, seed).unwrap();
        let pattern = exposure(image, pupil).pattern(&field);
        prop_assert!((mean(&pattern, |i| i) - 1.0).abs() < 3e-6);
        // A root may fall a rounding of the transform below zero.
        prop_assert!(pattern.values().values().iter().all(|&i| i > -1e-5));
    }
}
