use proptest::prelude::*;
use tem00_testkit::assert_absolute;

use super::*;

fn parameter(distance_from_waist: f64, rayleigh_range: f64) -> ComplexBeamParameter {
    ComplexBeamParameter::new(distance_from_waist, rayleigh_range).unwrap()
}

#[test]
fn the_reciprocal_holds_curvature_and_radius() {
    for m_squared in [1.0, 3.0] {
        let effective = m_squared * 650e-9;
        for (z, z_r) in [
            (-0.4, 0.01),
            (0.0, 0.2),
            (1e-9, 0.2),
            (0.2, 0.2),
            (7.0, 0.3),
        ] {
            let q = parameter(z, z_r);
            let reciprocal = q.to_complex().inv();
            // Few roundings, no cancellation.
            assert_absolute(q.curvature(), reciprocal.re, 4e-16 * reciprocal.re.abs());
            let w = q.radius(effective).unwrap();
            assert_absolute(-reciprocal.im * PI * w * w / effective, 1.0, 2e-15);
        }
    }
}

#[test]
fn radius_and_curvature_determine_the_parameter() {
    for (z, z_r) in [
        (-0.4, 0.01),
        (0.0, 0.2),
        (1e-9, 0.2),
        (0.2, 0.2),
        (7.0, 0.3),
    ] {
        let q = parameter(z, z_r);
        let radius = q.radius(1.2e-6).unwrap();
        let again =
            ComplexBeamParameter::from_radius_and_curvature(radius, q.curvature(), 1.2e-6).unwrap();
        // The errors of 1/q, relative to its modulus, equal the relative errors of q.
        let error = (again.to_complex() - q.to_complex()).norm() / q.to_complex().norm();
        assert!(error < 2e-15, "{q:?}: {error:e}");
    }
}

#[test]
fn a_beam_and_its_parameter_tell_the_same() {
    let beam = GaussianBeam::from_waist(650e-9, 50e-6).unwrap();
    let beam = beam.with_m_squared(1.7).unwrap();
    for distance in [-0.3, 0.0, 0.004, 2.0] {
        let located = LocatedBeam::new(beam, distance).unwrap();
        let q = ComplexBeamParameter::of(&located);
        assert!((q.distance_from_waist() + distance).abs() < 1e-300, "{q:?}");
        let ratio = q.radius(1.7 * 650e-9).unwrap() / located.radius_at(0.0);
        assert!((ratio - 1.0).abs() < 1e-15, "{q:?}: {ratio}");
        assert_absolute(q.gouy_phase(), beam.gouy_phase_at(-distance), 4e-16);

        let again = q.to_located_beam(650e-9, 1.7).unwrap();
        assert_absolute(again.beam().waist_radius() / 50e-6, 1.0, 1e-15);
        assert!((again.waist_distance() - distance).abs() < 1e-300, "{q:?}");
        assert!((again.beam().m_squared() - 1.7).abs() < 1e-300, "{again:?}");
    }
}

#[test]
fn a_parameter_beyond_the_paraxial_limit_makes_no_beam() {
    // δ = √(M² λ / (π z_R)) is 0.5 at z_R = 4 M² λ / π.
    let limit = 4.0 * 2.0 * 1e-6 / PI;
    let above = parameter(0.0, 1.001 * limit).to_located_beam(1e-6, 2.0);
    assert!(above.is_ok(), "{above:?}");
    let below = parameter(0.0, 0.999 * limit).to_located_beam(1e-6, 2.0);
    assert_eq!(below.unwrap_err().parameter, "waist_radius");
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(512))]

    #[test]
    fn no_query_yields_nan(
        z in -30.0..30.0_f64,
        sign in prop::sample::select(vec![-1.0, 0.0, 1.0]),
        z_r in -100.0..100.0_f64,
        wavelength in -30.0..30.0_f64,
    ) {
        let q = parameter(sign * 10_f64.powf(z), 10_f64.powf(z_r));
        let effective = 10_f64.powf(wavelength);
        let queries = [q.curvature(), q.gouy_phase(), q.radius(effective).unwrap()];
        prop_assert!(queries.iter().all(|x| x.is_finite()), "{:?}: {:?}", q, queries);
        prop_assert!(queries[2] > 0.0, "{:?}: {:?}", q, queries);
    }

    #[test]
    fn every_beam_has_a_parameter_in_range(
        wavelength in -30.0..29.0_f64,
        ratio in 0.0..60.0_f64,
        distance in -1e30..1e30_f64,
    ) {
        let wavelength = 10_f64.powf(wavelength);
        let waist = (wavelength * 10_f64.powf(ratio)).min(1e30);
        let beam = GaussianBeam::from_waist(wavelength, waist).unwrap();
        let q = ComplexBeamParameter::of(&LocatedBeam::new(beam, distance).unwrap());
        let checked = ComplexBeamParameter::new(q.distance_from_waist(), q.rayleigh_range());
        prop_assert_eq!(checked, Ok(q));
    }
}
