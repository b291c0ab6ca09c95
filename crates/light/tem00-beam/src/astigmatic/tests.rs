use proptest::prelude::*;

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
            (
                square.sqrt(),
                delta * delta * t / square,
                (delta * t / w0).atan(),
            )
        };
        let (a, b) = (law(40e-6, 1.0, z - 0.05), law(90e-6, 1.6, z + 0.02));
        // A few roundings each.
        for (got, want) in [(wu, a.0), (wv, b.0)] {
            assert!((got / want - 1.0).abs() < 1e-14, "radius at {z}: {got:e}");
        }
        for (got, want) in [(cu, a.1), (cv, b.1)] {
            assert!(
                (got - want).abs() <= 1e-14 * want.abs(),
                "1/R at {z}: {got}"
            );
        }
        let gouy = 0.5 * (a.2 + b.2);
        assert!((beam.gouy_phase_at(z) - gouy).abs() < 1e-14, "Gouy at {z}");
        let ratio = (a.0 / b.0).min(b.0 / a.0);
        assert!((beam.ellipticity_at(z) - ratio).abs() < 1e-14, "at {z}");
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

/// ∬ f dx dy over a square of the half-side `reach` by the trapezoidal rule, which converges faster
/// than any power for functions that vanish at the edges.
fn integrate(reach: f64, f: impl Fn(f64, f64) -> f64) -> f64 {
    const STEPS: i32 = 120;
    let h = reach / f64::from(STEPS);
    let line = |i: i32| -> f64 {
        let x = f64::from(i) * h;
        (-STEPS..=STEPS).map(|j| f(x, f64::from(j) * h)).sum()
    };
    (-STEPS..=STEPS).map(line).sum::<f64>() * h * h
}

#[test]
fn every_cross_section_carries_the_full_power() {
    let beam = beam();
    for z in [-0.05, 0.0, 0.05, 0.2] {
        let [wu, wv] = beam.radii_at(z);
        // 1 − erf(√2 · 3.5) < 1e−11 of the power lies beyond; the step is at most half the smaller
        // radius, so aliasing is exp(−(π w / h)² / 2) < 1e−8.
        let reach = 3.5 * wu.max(wv);
        assert!(reach / 120.0 < 0.5 * wu.min(wv), "grid too coarse at {z}");
        let power = integrate(reach, |x, y| beam.irradiance_per_watt(DVec3::new(x, y, z)));
        assert!((power - 1.0).abs() < 1e-8, "z = {z}: {power}");
    }
}

#[test]
fn a_tilted_plane_receives_the_full_power() {
    let beam = beam();
    let normal = DVec3::new(0.6, -0.5, -0.7).normalize();
    let (t, b) = normal.any_orthonormal_pair();
    let center = DVec3::new(0.0, 0.0, 0.15);
    let reach = 6.0 * beam.radii_at(0.15).into_iter().fold(0.0, f64::max);
    let power = integrate(reach, |p, q| {
        -beam.flux_per_watt(center + p * t + q * b).dot(normal)
    });
    // Across the plane the beam grows by reach · 1/R ≈ 1 %, the Gaussian is cut at 6 w cos 48°, and
    // the step of w/20 leaves no aliasing.
    assert!((power - 1.0).abs() < 1e-9, "{power}");
}

#[test]
fn flux_has_no_divergence() {
    let beam = beam();
    for (x, y, z) in [(0.3, -0.2, 0.0), (0.5, 0.9, 0.04), (-1.0, 0.4, 0.3)] {
        let [wu, wv] = beam.radii_at(z);
        let point = DVec3::new(x * wu, y * wv, z);
        let step = |axis: DVec3, h: f64| {
            let difference =
                beam.flux_per_watt(point + h * axis) - beam.flux_per_watt(point - h * axis);
            difference.dot(axis) / (2.0 * h)
        };
        let across = 1e-4 * wu.min(wv);
        let parts = [
            step(DVec3::X, across),
            step(DVec3::Y, across),
            step(DVec3::Z, 1e-6),
        ];
        let divergence: f64 = parts.iter().sum();
        let scale = parts.iter().fold(0.0_f64, |max, part| max.max(part.abs()));
        // Step over length scale is 1e−4 at most (z: 1e−6 of the Rayleigh range 7.7e−3 m), squared and
        // times third derivatives of a Gaussian, up to 12; rounding is 2e−16 / 1e−4.
        assert!((divergence / scale).abs() < 2e-7, "{parts:?}");
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
    let [first, second] = sharp
        .circular_planes()
        .map(|plane| plane.expect("two planes"));
    // Waists of 1e−9 m against radii of 1e−4 m.
    assert!(
        (first - 0.2).abs() < 1e-9 && (second - 0.6).abs() < 1e-9,
        "{first}, {second}"
    );
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
        let least = 2.0 * m_squared * wavelength / PI;
        let axis = |waist: f64, z: f64| {
            let waist = waist.max(1.01 * least);
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
