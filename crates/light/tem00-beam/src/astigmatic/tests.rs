use proptest::prelude::*;
use tem00_testkit::{assert_absolute, assert_relative};

use super::*;

const RED: f64 = 650e-9;

/// An elliptic beam with its waists apart, turned, and with M² in one axis.
fn beam() -> AstigmaticBeam {
    let x = GaussianBeam::from_waist(RED, 40e-6).unwrap();
    let y = GaussianBeam::from_waist(RED, 90e-6)
        .and_then(|beam| beam.with_m_squared(1.6))
        .unwrap();
    let axes = [(x, 0.05), (y, -0.02)].map(|(beam, z)| LocatedBeam::new(beam, z).unwrap());
    AstigmaticBeam::new(axes[0], axes[1])
        .and_then(|beam| beam.with_rotation(0.4))
        .unwrap()
}

#[test]
fn each_axis_follows_its_own_law() {
    let beam = beam();
    for z in [-0.3, 0.0, 0.05, 1.0] {
        let [wu, wv] = beam.radii_at(z);
        let [cu, cv] = beam.curvatures_at(z);
        // w² = w₀² + δ² (z − z₀)² and 1/R = w'/w, written out with numbers.
        let law = |w0: f64, m2: f64, t: f64| {
            let delta = m2 * RED / (PI * w0);
            let square = w0 * w0 + delta * delta * t * t;
            let gouy = (delta * t / w0).atan();
            (square.sqrt(), delta * delta * t / square, gouy)
        };
        let (a, b) = (law(40e-6, 1.0, z - 0.05), law(90e-6, 1.6, z + 0.02));
        // The tolerances cover a few roundings each.
        for (got, want) in [(wu, a.0), (wv, b.0), (cu, a.1), (cv, b.1)] {
            assert_relative(got, want, 1e-14);
        }
        assert_absolute(beam.gouy_phase_at(z), 0.5 * (a.2 + b.2), 1e-14);
        let ratio = (a.0 / b.0).min(b.0 / a.0);
        assert_absolute(beam.ellipticity_at(z), ratio, 1e-14);
    }
}

#[test]
fn a_stigmatic_beam_is_the_circular_beam() {
    let circular = GaussianBeam::from_waist(RED, 50e-6).unwrap();
    let beam = AstigmaticBeam::stigmatic(LocatedBeam::new(circular, 0.1).unwrap())
        .with_rotation(1.1)
        .unwrap();
    let point = DVec3::new(0.2e-3, -0.1e-3, 0.4);
    let from_waist = point - 0.1 * DVec3::Z;
    let deviation = beam.flux_per_watt(point) - circular.flux_per_watt(from_waist);
    // The exponent of about 3 carries a few roundings to the irradiance.
    let scale = circular.flux_per_watt(from_waist).z;
    assert!(deviation.length() < 1e-14 * scale, "{deviation}");
    assert!((beam.ellipticity_at(0.3) - 1.0).abs() < 1e-15, "{beam:?}");
    assert_eq!(beam.circular_planes(), [None, None], "circular everywhere");
}

#[test]
fn rotation_turns_from_x_to_y() {
    let beam = AstigmaticBeam::from_divergences(RED, [1e-3, 9e-3])
        .and_then(|beam| beam.with_rotation(PI / 6.0))
        .unwrap();
    // The first axis diverges less and has the wider waist; it lies 30° above x.
    let along = DVec3::new(0.75_f64.sqrt(), 0.5, 0.0) * 100e-6;
    let across = DVec3::new(-0.5, 0.75_f64.sqrt(), 0.0) * 100e-6;
    let [wu, wv] = beam.radii_at(0.0);
    let peak = beam.peak_irradiance_per_watt(0.0);
    for (point, w) in [(along, wu), (across, wv)] {
        let fall = (beam.irradiance_per_watt(point) / peak).ln();
        let want = -2.0 * (100e-6 / w).powi(2);
        assert!((fall / want - 1.0).abs() < 1e-12, "{point}: {fall}");
    }
}

#[test]
fn the_radii_meet_in_the_circular_planes() {
    let planes = beam().circular_planes();
    for plane in planes {
        let z = plane.expect("two planes");
        assert!((beam().ellipticity_at(z) - 1.0).abs() < 1e-12, "z = {z}");
    }
    assert!(planes[0] < planes[1], "{planes:?}");
    // w² differs by 0 at t where (1e−3)² t² = (2e−3)² (t − 0.3)² with points for waists: 0.2, 0.6.
    let axis = |waist, z| LocatedBeam::new(GaussianBeam::from_waist(1e-12, waist).unwrap(), z);
    let (x, y) = (axis(1e-9 / PI, 0.0), axis(0.5e-9 / PI, 0.3));
    let sharp = AstigmaticBeam::new(x.unwrap(), y.unwrap()).unwrap();
    // Waists of 1e−9 m against radii of 1e−4 m.
    for (plane, z) in sharp.circular_planes().into_iter().zip([0.2, 0.6]) {
        assert_absolute(plane.expect("two planes"), z, 1e-9);
    }
}

#[test]
fn an_axis_that_is_always_wider_never_meets_the_other() {
    let narrow = GaussianBeam::from_waist(RED, 50e-6).unwrap();
    let wide = GaussianBeam::from_waist(RED, 60e-6)
        .and_then(|beam| beam.with_m_squared(4.0))
        .unwrap();
    let axes = [narrow, wide].map(|beam| LocatedBeam::new(beam, 0.0).unwrap());
    let beam = AstigmaticBeam::new(axes[0], axes[1]).unwrap();
    assert_eq!(beam.circular_planes(), [None, None], "{beam:?}");
}

#[test]
fn half_maximum_lies_at_half_the_data_sheets_angle() {
    let fwhm = 10_f64.to_radians();
    let delta = fwhm / (2.0 * core::f64::consts::LN_2).sqrt();
    assert!((2.0 * delta / fwhm - 1.699).abs() < 5e-4, "{delta}");
    let beam = AstigmaticBeam::from_divergences(RED, [delta, 0.2]).unwrap();
    let far = DVec3::new(0.5 * fwhm, 0.0, 1.0) * 10.0;
    let ratio = beam.irradiance_per_watt(far) / beam.peak_irradiance_per_watt(10.0);
    // (z_R / z)² is below 1e−11.
    assert!((ratio - 0.5).abs() < 1e-10, "{ratio}");
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(2_000))]

    #[test]
    fn no_query_leaves_the_numbers(
        exponents in prop::array::uniform8(-30.0..30.0_f64),
        m_squared in 1.0..1e6_f64,
        rotation in -1e3..1e3_f64,
    ) {
        let [wavelength, w0, w1, z0, z1, x, y, z] = exponents.map(|e| 10_f64.powf(e));
        let min = 2.0 * m_squared * wavelength / PI;
        let axis = |waist: f64, z: f64| {
            let waist = waist.max(1.01 * min);
            GaussianBeam::from_waist(wavelength, waist)
                .and_then(|beam| beam.with_m_squared(m_squared))
                .and_then(|beam| LocatedBeam::new(beam, z))
        };
        let (Ok(a), Ok(b)) = (axis(w0, z0), axis(w1, -z1)) else {
            return Ok(());
        };
        let beam = AstigmaticBeam::new(a, b).unwrap().with_rotation(rotation).unwrap();
        let point = DVec3::new(x, -y, z);
        for number in [
            beam.gouy_phase_at(z),
            beam.ellipticity_at(z),
            beam.peak_irradiance_per_watt(z),
            beam.irradiance_per_watt(point),
        ] {
            prop_assert!(number.is_finite(), "{beam:?} at {point}: {number}");
        }
        for point in [point, DVec3::MAX, DVec3::MIN] {
            prop_assert!(beam.irradiance_per_watt(point).is_finite(), "{beam:?} at {point}");
            prop_assert!(beam.flux_per_watt(point).is_finite(), "{beam:?} at {point}");
        }
        for plane in beam.circular_planes().into_iter().flatten() {
            prop_assert!(plane.is_finite(), "{beam:?}: {plane}");
        }
    }
}
