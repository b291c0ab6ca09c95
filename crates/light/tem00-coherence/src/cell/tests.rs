use core::f64::consts::PI;

use proptest::prelude::*;
use tem00_numerics::{disc_overlap, jinc, quadrature::integrate};
use tem00_testkit::{assert_absolute, assert_relative};

use super::*;
use crate::law::tests::direction;

fn geometry() -> CellGeometry {
    CellGeometry {
        to_source: DVec3::Z,
        to_pupil: DVec3::new(0.5, 0.0, 0.75_f64.sqrt()),
        normal: DVec3::Z,
        sin_aperture: 0.025,
        wavelength: 450e-9,
    }
}

#[test]
fn tilt_and_height_factor_are_those_of_the_plane_of_incidence() {
    for [incidence, observation] in [
        [0.0, 30.0],
        [30.0, 0.0],
        [-30.0, 30.0],
        [20.0, 45.0],
        [-50.0, 10.0],
    ] {
        let cell = ResolutionCell::new(CellGeometry {
            to_source: 3.0 * direction(incidence),
            to_pupil: direction(observation),
            ..geometry()
        });
        let cell = cell.unwrap();
        let [i, o] = [incidence, observation].map(f64::to_radians);
        let tilt = (i.sin() + o.sin()).abs() / o.cos();
        assert_absolute(cell.tilt().length(), tilt, 1e-12);
        let factor = (1.0 + (i - o).cos()) / o.cos();
        assert_relative(cell.height_factor(), factor, 1e-12);
        assert!(cell.tilt().dot(direction(observation)).abs() < 1e-12);
    }
}

/// The sum over powers of the correlation, each a Gaussian about the tilt, by sums over two
/// dimensions. A length of 1 is the reciprocal of the frequencies that the pupil spans, λ / (2 sin
/// u).
#[test]
fn correlated_heights_are_the_sum_of_their_powers() {
    for (angle, length, kappa) in [
        (0.0, 0.7, 2e5),
        (0.0, 3.0, 5e5),
        (30.0, 0.7, 2e5),
        (30.0, 2.0, 1e5),
    ] {
        let cell = ResolutionCell::new(CellGeometry {
            to_pupil: direction(angle),
            ..geometry()
        })
        .unwrap();
        let relief = Relief {
            rms_height: 1.6e-6,
            correlation_length: length * 9e-6,
        };
        let cell = cell.with_relief(relief).unwrap();
        let shift = kappa / cell.tilt_wave_number();
        let a = (kappa * cell.path_spread()).powi(2);
        let mut power = (-a).exp();
        let mut sum = power * disc_overlap(shift).powi(2);
        for n in 1..60 {
            let n = f64::from(n);
            power *= a / n;
            let sharp = (PI * length).powi(2) / n;
            let density = |x: f64, y: f64| {
                let apart = (x - shift).powi(2) + y * y;
                disc_overlap(x.hypot(y)).powi(2) * sharp / PI * (-sharp * apart).exp()
            };
            let row = |y: f64| integrate(|x| density(x, y), [-1.0, 1.0], 0.25);
            sum += power * 2.0 * integrate(row, [0.0, 1.0], 0.25);
        }
        assert_relative(cell.squared_correlation(kappa), sum, 2e-4);
    }
}

#[test]
fn far_out_of_focus_a_tilt_acts_by_the_blur() {
    let cell = ResolutionCell::new(geometry())
        .unwrap()
        .with_defocus(30e-3)
        .unwrap();
    // At some blurs from a speckle the result is a jinc of the paths across the blur.
    for kappa in [2e3, 4e3, 6e3] {
        let x = kappa * cell.tilt().length() * 30e-3 * 0.025;
        let found = cell.field_correlation(kappa).norm();
        assert_absolute(found, jinc(x).abs(), 0.01);
    }
}

proptest! {
    #[test]
    fn correlations_are_one_at_most(
        angles in prop::array::uniform2(-80.0..80.0_f64), height in 0.0..1e-4_f64,
        kappa in -1e6..1e6_f64, defocus in -1e-3..1e-3_f64,
    ) {
        let cell = ResolutionCell::new(CellGeometry {
            to_source: direction(angles[0]),
            to_pupil: direction(angles[1]),
            ..geometry()
        });
        let relief = Relief { rms_height: height, correlation_length: 0.0 };
        let cell = cell.unwrap().with_relief(relief).unwrap();
        for cell in [cell.clone(), cell.with_defocus(defocus).unwrap()] {
            let squared = cell.squared_correlation(kappa);
            prop_assert!((0.0..=1.0 + 1e-9).contains(&squared), "{squared}");
        }
    }
}
