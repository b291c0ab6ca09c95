use core::f64::consts::{FRAC_PI_2, FRAC_PI_4};

use proptest::prelude::*;

use super::*;
use crate::{GaussianBeam, LocatedBeam};

const RED: f64 = 650e-9;

/// An elliptic beam with its waists apart, turned by 0.4, and with M² = 1.6 in one axis.
fn simple() -> AstigmaticBeam {
    let x = GaussianBeam::from_waist(RED, 40e-6).unwrap();
    let y = GaussianBeam::from_waist(RED, 90e-6)
        .and_then(|beam| beam.with_m_squared(1.6))
        .unwrap();
    let axes = [(x, 0.05), (y, -0.02)].map(|(beam, z)| LocatedBeam::new(beam, z).unwrap());
    AstigmaticBeam::new(axes[0], axes[1])
        .and_then(|beam| beam.with_rotation(0.4))
        .unwrap()
}

/// A partially coherent beam that turns on its way.
fn turning() -> GeneralAstigmaticBeam {
    let lens = AstigmaticSystem::cylinder_lens(0.08, 1.3).unwrap();
    GeneralAstigmaticBeam::from(simple())
        .through(&lens)
        .unwrap()
}

/// A beam whose energy flows in a spiral: a Gaussian Schell-model beam of M² = 3 whose mixed moments
/// are antisymmetric.
fn twisted() -> GeneralAstigmaticBeam {
    let moments = SecondMoments {
        position: DMat2::IDENTITY * 1e-8,
        mixed: DMat2::from_cols_array(&[0.0, -1e-7, 1e-7, 0.0]),
        slope: DMat2::IDENTITY * 4e-6,
    };
    GeneralAstigmaticBeam::from_moments(RED, &moments).unwrap()
}

fn distance(one: DMat2, other: DMat2) -> f64 {
    (one - other)
        .to_cols_array()
        .into_iter()
        .fold(0.0, |max, entry| max.max(entry.abs()))
}

#[test]
fn a_simple_beam_stays_two_beams_of_one_dimension() {
    let (axes, beam) = (simple(), GeneralAstigmaticBeam::from(simple()));
    for z in [-0.3, 0.0, 0.05, 1.0] {
        let [wu, wv] = axes.radii_at(z);
        let [larger, smaller] = beam.radii_at(z);
        // Radii differ by less than 10 times; a dozen roundings are squared and rooted.
        assert!((larger / wu.max(wv) - 1.0).abs() < 1e-14, "z = {z}");
        assert!((smaller / wu.min(wv) - 1.0).abs() < 1e-14, "z = {z}");
        let major = if wu > wv { 0.4 } else { 0.4 - FRAC_PI_2 };
        let orientation = beam.orientation_at(z);
        assert!(
            (orientation - major).abs() < 1e-13,
            "z = {z}: {orientation}"
        );
        let turn = DMat2::from_angle(0.4);
        let curvatures = DMat2::from_diagonal(axes.curvatures_at(z).into());
        let difference = distance(
            beam.curvature_tensor_at(z),
            turn * curvatures * turn.transpose(),
        );
        // Curvatures of up to 1/(2 z_R) = 65 m⁻¹; the ratio of the radii enters squared.
        assert!(difference < 1e-12 * 65.0, "z = {z}: {difference:e}");
        for (x, y) in [(0.0, 0.0), (1.0, 0.3), (-0.4, 1.2)] {
            let point = DVec3::new(x * wu, y * wv, z);
            let deviation = beam.flux_per_watt(point) - axes.flux_per_watt(point);
            let scale = axes.irradiance_per_watt(point);
            assert!(deviation.length() < 1e-12 * scale, "{point}: {deviation}");
        }
    }
    let [smaller, larger] = beam.beam_quality();
    assert!((smaller - 1.0).abs() < 1e-14 && (larger / 1.6 - 1.0).abs() < 1e-14);
    assert!(beam.twist().abs() < 1e-22, "no twist: {:e}", beam.twist());
    assert!((beam.divergences()[0] / (RED / (PI * 40e-6)) - 1.0).abs() < 1e-14);
}

#[test]
fn aligned_lenses_act_on_each_axis_alone() {
    // Axis by axis, with real numbers: a lens adds −1/f to 1/R and leaves w; a waist of curvature
    // 1/R, radius w lies at −R / (1 + (λ M² R / π w²)²).
    let focal = [0.15, -0.3];
    let mut system = AstigmaticSystem::free_space(0.2).unwrap();
    for (f, rotation) in focal.into_iter().zip([0.4, 0.4 + FRAC_PI_2]) {
        system = system.then(AstigmaticSystem::cylinder_lens(f, rotation).unwrap());
    }
    let beam = GeneralAstigmaticBeam::from(simple())
        .through(&system)
        .unwrap();
    let radius = |axis: usize, z: f64| {
        let before = simple();
        let (w, m2) = (before.radii_at(0.2)[axis], [1.0, 1.6][axis]);
        let curvature = before.curvatures_at(0.2)[axis] - 1.0 / focal[axis];
        let (growth, spread) = (1.0 + z * curvature, RED * m2 * z / (PI * w * w));
        w * growth.hypot(spread)
    };
    for z in [0.0, 0.1, 0.15, 0.17, 0.6] {
        let [a, b] = [radius(0, z), radius(1, z)];
        let [larger, smaller] = beam.radii_at(z);
        // The ratio of the radii is up to 30 near the focus, and 1 + z/R cancels to 1/30.
        assert!(
            (larger / a.max(b) - 1.0).abs() < 1e-12,
            "z = {z}: {larger:e}"
        );
        assert!(
            (smaller / a.min(b) - 1.0).abs() < 1e-12,
            "z = {z}: {smaller:e}"
        );
    }
}

#[test]
fn moments_make_the_beam_they_came_from() {
    for beam in [simple().into(), turning(), twisted()] {
        let moments = beam.moments_at(0.0);
        let again = GeneralAstigmaticBeam::from_moments(RED, &moments).unwrap();
        for z in [-0.2, 0.0, 0.07, 0.5] {
            let (one, other) = (again.moments_at(z), beam.moments_at(z));
            // (w / w₀)² of up to 70 times a few roundings.
            let scale = other.position.x_axis.x.max(other.position.y_axis.y);
            let off = distance(one.position, other.position);
            assert!(off < 1e-13 * scale, "{beam:?} at {z}: {off:e}");
            assert!(
                distance(one.mixed, other.mixed) < 1e-13 * scale.sqrt(),
                "at {z}"
            );
            assert!(distance(one.slope, other.slope) < 1e-18, "at {z}");
        }
    }
}

#[test]
fn moments_split_into_what_spreads_and_what_follows_the_slope() {
    for beam in [turning(), twisted()] {
        for z in [0.0, 0.3] {
            let SecondMoments {
                position,
                mixed,
                slope,
            } = beam.moments_at(z);
            let along = beam.position_per_slope() + DMat2::IDENTITY * z;
            let scale = position.x_axis.x.max(position.y_axis.y);
            let sum = beam.position_spread() + along * slope * along.transpose();
            assert!(distance(sum, position) < 1e-14 * scale, "z = {z}");
            let product = along * slope;
            assert!(distance(product, mixed) < 1e-14 * scale.sqrt(), "z = {z}");
            let tensor = mixed.transpose() * position.inverse();
            let off = distance(tensor, beam.curvature_tensor_at(z));
            // Curvatures of 10 m⁻¹, determinants of radii in a ratio of 5.
            assert!(off < 1e-11, "z = {z}: {off:e}");
        }
    }
}

#[test]
fn the_spot_turns_by_half_a_revolution() {
    let elliptic = AstigmaticBeam::from_divergences(RED, [0.5e-3, 1e-3]).unwrap();
    for (rotation, turn) in [(FRAC_PI_4, -PI), (0.3, -PI), (-0.5, PI)] {
        let lens = AstigmaticSystem::cylinder_lens(0.1, rotation).unwrap();
        let beam = GeneralAstigmaticBeam::from(elliptic)
            .through(&lens)
            .unwrap();
        let exponent = |i: i32| f64::from(i) * 1e-3;
        let behind = (-6_000..6_000).map(|i| 10_f64.powf(exponent(i)));
        let ahead = (-6_000..6_000).map(|i| -10_f64.powf(exponent(-i)));
        let angles: Vec<f64> = ahead
            .chain(behind)
            .map(|z| beam.orientation_at(z))
            .collect();
        // The angle is known up to π: steps are the smaller of the two.
        let step = |pair: &[f64]| {
            let step = pair[1] - pair[0];
            step - PI * (step / PI).round()
        };
        let total: f64 = angles.windows(2).map(step).sum();
        // What is left to turn beyond 1e6 m is of the order of z_R / z = 1e−6.
        assert!((total - turn).abs() < 1e-5, "lens at {rotation}: {total}");
    }
}

#[test]
fn a_lens_at_45_degrees_exchanges_the_axes_at_twice_its_focal_length() {
    // Rays of a collimated beam arrive at 2f mirrored at the axis of the cylinder, which exchanges
    // x and y.
    let elliptic = AstigmaticBeam::from_divergences(RED, [0.5e-3, 1e-3]).unwrap();
    let lens = AstigmaticSystem::cylinder_lens(0.1, FRAC_PI_4).unwrap();
    let beam = GeneralAstigmaticBeam::from(elliptic)
        .through(&lens)
        .unwrap();
    let position = beam.moments_at(0.2).position;
    for (variance, waist, slope) in [
        (position.x_axis.x, RED / (PI * 1e-3), 0.5e-3),
        (position.y_axis.y, RED / (PI * 0.5e-3), 1e-3),
    ] {
        let radius = f64::hypot(waist, 0.2 * slope);
        let want = 0.25 * radius * radius;
        assert!(
            (variance / want - 1.0).abs() < 1e-13,
            "{variance:e}, {want:e}"
        );
    }
    assert!(position.x_axis.y.abs() < 1e-22, "{position}");
}

/// ∬ f dx dy over a square of the half-side `reach` by the trapezoidal rule.
fn integrate(reach: f64, f: impl Fn(f64, f64) -> f64) -> f64 {
    const STEPS: i32 = 100;
    let h = reach / f64::from(STEPS);
    let line = |i: i32| -> f64 {
        let x = f64::from(i) * h;
        (-STEPS..=STEPS).map(|j| f(x, f64::from(j) * h)).sum()
    };
    (-STEPS..=STEPS).map(line).sum::<f64>() * h * h
}

#[test]
fn every_plane_receives_the_full_power() {
    for beam in [turning(), twisted()] {
        for z in [0.0, 0.08, 0.3] {
            let [larger, smaller] = beam.radii_at(z);
            // Cut at 3.5 radii (1e−11 of the power); the step must resolve the smaller radius.
            let reach = 3.5 * larger;
            assert!(reach / 100.0 < 0.5 * smaller, "grid too coarse at {z}");
            let upright = integrate(reach, |x, y| beam.irradiance_per_watt(DVec3::new(x, y, z)));
            assert!((upright - 1.0).abs() < 1e-8, "z = {z}: {upright}");
            let normal = DVec3::new(0.5, -0.4, -0.8).normalize();
            let (t, b) = normal.any_orthonormal_pair();
            let tilted = integrate(1.5 * reach, |p, q| {
                let point = DVec3::new(0.0, 0.0, z) + p * t + q * b;
                -beam.flux_per_watt(point).dot(normal)
            });
            assert!((tilted - 1.0).abs() < 1e-8, "z = {z}, tilted: {tilted}");
        }
    }
}

#[test]
fn flux_has_no_divergence() {
    for beam in [turning(), twisted()] {
        for (x, y, z) in [(0.3, -0.2, 0.0), (0.5, 0.6, 0.05), (-0.7, 0.4, 0.3)] {
            let [larger, smaller] = beam.radii_at(z);
            let point = DVec3::new(x * larger, y * smaller, z);
            let slope = |axis: DVec3, h: f64| {
                let [ahead, behind] = [h, -h].map(|h| beam.flux_per_watt(point + h * axis));
                (ahead - behind).dot(axis) / (2.0 * h)
            };
            let parts = [
                slope(DVec3::X, 1e-4 * smaller),
                slope(DVec3::Y, 1e-4 * smaller),
                slope(DVec3::Z, 1e-6),
            ];
            let divergence: f64 = parts.iter().sum();
            let scale = parts.iter().fold(0.0_f64, |max, part| max.max(part.abs()));
            // Steps are 1e−4 of the lengths on which the flux changes (Rayleigh ranges above 7 mm):
            // squared, times third derivatives up to 12, plus rounding of 2e−16 / 1e−4.
            assert!((divergence / scale).abs() < 2e-7, "{parts:?}");
        }
    }
}

#[test]
fn twist_drives_the_energy_around_the_axis() {
    let beam = twisted();
    let point = DVec3::new(1e-4, 0.0, 0.0);
    let flux = beam.flux_per_watt(point) / beam.irradiance_per_watt(point);
    // ⟨x s_y⟩ / ⟨x²⟩ = 10 m⁻¹ at x = 0.1 mm.
    assert!(
        (flux - DVec3::new(0.0, 1e-3, 1.0)).length() < 1e-15,
        "{flux}"
    );
    assert!(
        (beam.twist() / 2e-7 - 1.0).abs() < 1e-14,
        "{:e}",
        beam.twist()
    );
    for element in [
        AstigmaticSystem::free_space(0.7),
        AstigmaticSystem::thin_lens(0.2),
        AstigmaticSystem::image_rotation(0.9),
    ] {
        let behind = beam.through(&element.unwrap()).unwrap();
        assert!((behind.twist() / 2e-7 - 1.0).abs() < 1e-12, "{element:?}");
    }
    // Two roots of ν⁴ − Δ ν² + det = 0: ν = √(⟨x²⟩⟨s²⟩) ± ⟨x s_y⟩ = 2e−7 ± 1e−7 m.
    let quantum = RED / (4.0 * PI);
    let [smaller, larger] = beam.beam_quality();
    assert!((smaller * quantum / 1e-7 - 1.0).abs() < 1e-14, "{smaller}");
    assert!((larger * quantum / 3e-7 - 1.0).abs() < 1e-14, "{larger}");
}

#[test]
fn a_distance_and_a_system_of_that_distance_agree() {
    for beam in [turning(), twisted()] {
        let moved = beam.propagated(0.4).unwrap();
        let path = AstigmaticSystem::free_space(0.4).unwrap();
        let through = beam.through(&path).unwrap();
        for z in [-0.4, 0.0, 0.2] {
            let want = beam.moments_at(z + 0.4);
            for other in [moved.moments_at(z), through.moments_at(z)] {
                let scale = want.position.x_axis.x + want.position.y_axis.y;
                let off = distance(other.position, want.position);
                assert!(off < 1e-14 * scale, "z = {z}: {off:e}");
            }
        }
    }
}

#[test]
fn a_focus_far_from_the_reference_plane_keeps_its_digits() {
    // Waists of 1.3 µm, 1 km from the reference plane, where the beam is 160 m wide: squares
    // 1.5e16 times that of the waist would leave nothing of it.
    let beam = AstigmaticBeam::from_divergences(RED, [0.16, 0.10])
        .and_then(|beam| beam.with_waist_distances([1e3, 1e3]))
        .and_then(|beam| beam.with_rotation(0.7))
        .unwrap();
    let [larger, smaller] = GeneralAstigmaticBeam::from(beam).radii_at(1e3);
    // The position of the waist is exact; slopes of 0.1 times a rounding of 1 km are 1e−14 m.
    assert!(
        (larger / (RED / (PI * 0.10)) - 1.0).abs() < 1e-12,
        "{larger:e}"
    );
    assert!(
        (smaller / (RED / (PI * 0.16)) - 1.0).abs() < 1e-12,
        "{smaller:e}"
    );
}

#[test]
fn the_index_of_refraction_shortens_wavelength_and_slopes() {
    let one = DMat2::IDENTITY;
    let surface = AstigmaticSystem::new([[one, DMat2::ZERO], [DMat2::ZERO, one / 1.5]]).unwrap();
    let beam = turning().through(&surface).unwrap();
    assert!(
        (beam.wavelength() / RED * 1.5 - 1.0).abs() < 1e-15,
        "{beam:?}"
    );
    for (before, behind) in turning()
        .beam_quality()
        .into_iter()
        .zip(beam.beam_quality())
    {
        assert!((before / behind - 1.0).abs() < 1e-14, "{before}, {behind}");
    }
}

#[test]
fn diffraction_limited_moments_pass_and_better_ones_do_not() {
    let quantum = RED / (4.0 * PI);
    let ideal = |m_squared: f64, z: f64| {
        let (position, slope) = (1e-10, (quantum * m_squared).powi(2) / 1e-10);
        SecondMoments {
            position: DMat2::IDENTITY * (position + slope * z * z),
            mixed: DMat2::IDENTITY * (slope * z),
            slope: DMat2::IDENTITY * slope,
        }
    };
    // The Rayleigh range is 2 mm: at 0.2 m the waist is in the last 12 digits.
    for z in [0.0, 0.2] {
        let beam = GeneralAstigmaticBeam::from_moments(RED, &ideal(1.0, z));
        let [smaller, _] = beam.unwrap().beam_quality();
        assert!((smaller - 1.0).abs() < 1e-11, "z = {z}: {smaller}");
        let better = GeneralAstigmaticBeam::from_moments(RED, &ideal(1.0 - 2e-6, z));
        assert!(
            matches!(better, Err(e) if e.parameter() == "m_squared"),
            "{better:?}"
        );
    }
}

/// The product of two complex 2×2 matrices.
fn product(a: [[Complex64; 2]; 2], b: [[Complex64; 2]; 2]) -> [[Complex64; 2]; 2] {
    let entry = |i: usize, j: usize| a[i][0] * b[0][j] + a[i][1] * b[1][j];
    [[entry(0, 0), entry(0, 1)], [entry(1, 0), entry(1, 1)]]
}

fn inverse([[a, b], [c, d]]: [[Complex64; 2]; 2]) -> [[Complex64; 2]; 2] {
    let determinant = a * d - b * c;
    [[d, -b], [-c, a]].map(|row| row.map(|entry| entry / determinant))
}

/// `p + m q` for real p and m.
fn affine(p: DMat2, m: DMat2, q: [[Complex64; 2]; 2]) -> [[Complex64; 2]; 2] {
    let complex = |m: DMat2| {
        m.transpose()
            .to_cols_array_2d()
            .map(|row| row.map(Complex64::from))
    };
    let (p, mq) = (complex(p), product(complex(m), q));
    [0, 1].map(|i| [0, 1].map(|j| p[i][j] + mq[i][j]))
}

#[test]
fn a_coherent_beam_obeys_the_law_of_complex_curvature() {
    // An oblique elliptic beam of radii 0.3 and 0.8 mm with a wavefront along other axes.
    let q = [
        [Complex64::new(2.0, -1.9), Complex64::new(-0.7, 0.8)],
        [Complex64::new(-0.7, 0.8), Complex64::new(-1.0, -0.9)],
    ];
    let beam = GeneralAstigmaticBeam::from_complex_curvature(RED, q).unwrap();
    for quality in beam.beam_quality() {
        assert!((quality - 1.0).abs() < 1e-13, "M² = {quality}");
    }
    let mut system = AstigmaticSystem::free_space(0.3).unwrap();
    for element in [
        AstigmaticSystem::cylinder_lens(0.2, FRAC_PI_4),
        AstigmaticSystem::free_space(0.15),
        AstigmaticSystem::cylinder_lens(-0.5, 1.2),
        AstigmaticSystem::image_rotation(0.6),
        AstigmaticSystem::free_space(0.2),
    ] {
        system = system.then(element.unwrap());
        let [[a, b], [c, d]] = system.blocks();
        let want = product(affine(c, d, q), inverse(affine(a, b, q)));
        let got = beam.through(&system).unwrap().complex_curvature_at(0.0);
        let scale = want
            .as_flattened()
            .iter()
            .fold(0.0, |max, w| w.norm().max(max));
        for (got, want) in got.as_flattened().iter().zip(want.as_flattened()) {
            // Six products of matrices with entries up to 10, and two inverses of ratio 10.
            let off = (got - want).norm() / scale;
            assert!(off < 1e-12, "{got}, {want}: {off:e}");
        }
    }
}

#[test]
fn complex_curvature_holds_radii_and_wavefront() {
    let (w, curvature) = ([0.3e-3, 0.8e-3], [2.0, -0.5]);
    let entry = |i: usize| Complex64::new(curvature[i], -RED / (PI * w[i] * w[i]));
    let zero = Complex64::ZERO;
    let q = [[entry(0), zero], [zero, entry(1)]];
    let beam = GeneralAstigmaticBeam::from_complex_curvature(RED, q).unwrap();
    let [larger, smaller] = beam.radii_at(0.0);
    assert!((larger / w[1] - 1.0).abs() < 1e-14, "{larger:e}");
    assert!((smaller / w[0] - 1.0).abs() < 1e-14, "{smaller:e}");
    let tensor = DMat2::from_diagonal(curvature.into());
    let off = distance(beam.curvature_tensor_at(0.0), tensor);
    // The ratio of the radii enters squared.
    assert!(off < 1e-14, "{off:e}");
}

#[test]
fn impossible_complex_curvatures_are_rejected() {
    let c = |re: f64, im: f64| Complex64::new(re, im);
    let good = c(1.0, -1.0);
    for bad in [
        [[good, c(0.1, 0.0)], [c(0.0, 0.0), good]],
        [[good, c(0.0, 1.1)], [c(0.0, 1.1), good]],
        [[good, c(0.0, 0.0)], [c(0.0, 0.0), c(1.0, 1.0)]],
        [[good, c(0.0, 0.0)], [c(0.0, 0.0), c(f64::NAN, -1.0)]],
        [[c(0.0, 0.0); 2]; 2],
    ] {
        let result = GeneralAstigmaticBeam::from_complex_curvature(RED, bad);
        assert!(
            matches!(result, Err(e) if e.parameter() == "curvature"),
            "{bad:?}: {result:?}"
        );
    }
    let plain = [[good, c(0.0, 0.0)], [c(0.0, 0.0), good]];
    let result = GeneralAstigmaticBeam::from_complex_curvature(0.0, plain);
    assert!(
        matches!(result, Err(e) if e.parameter() == "wavelength"),
        "{result:?}"
    );
}

#[test]
fn impossible_moments_are_rejected() {
    let good = SecondMoments {
        position: DMat2::IDENTITY * 1e-8,
        mixed: DMat2::ZERO,
        slope: DMat2::IDENTITY * 4e-6,
    };
    let result = |moments: SecondMoments| GeneralAstigmaticBeam::from_moments(RED, &moments);
    assert!(result(good).is_ok(), "{good:?}");
    let skew = DMat2::from_cols_array(&[1.0, 0.1, 0.0, 1.0]);
    let indefinite = DMat2::from_cols_array(&[1.0, 2.0, 2.0, 1.0]);
    let mirrored = DMat2::from_diagonal(DVec2::new(-1.0, 1.0));
    let nan = DMat2::IDENTITY * f64::NAN;
    for factor in [skew, indefinite, mirrored, DMat2::ZERO, nan] {
        let position = result(SecondMoments {
            position: factor * 1e-8,
            ..good
        });
        assert!(
            matches!(position, Err(e) if e.parameter() == "position"),
            "{position:?}"
        );
        let slope = result(SecondMoments {
            slope: factor * 4e-6,
            ..good
        });
        assert!(
            matches!(slope, Err(e) if e.parameter() == "slope"),
            "{slope:?}"
        );
    }
    let mixed = result(SecondMoments { mixed: nan, ..good });
    assert!(
        matches!(mixed, Err(e) if e.parameter() == "mixed"),
        "{mixed:?}"
    );
    // ⟨x s⟩² above ⟨x²⟩⟨s²⟩ = 4e−14.
    let correlated = result(SecondMoments {
        mixed: DMat2::IDENTITY * 2.1e-7,
        ..good
    });
    assert!(
        matches!(correlated, Err(e) if e.parameter() == "position"),
        "{correlated:?}"
    );
    // √(1e−8 · 2.6e−7) = 5.1e−8 is below λ/4π = 5.17e−8.
    let dark = result(SecondMoments {
        slope: DMat2::IDENTITY * 2.6e-7,
        ..good
    });
    assert!(
        matches!(dark, Err(e) if e.parameter() == "m_squared"),
        "{dark:?}"
    );
    // Either entry of a diagonal alone, and a twist beyond what the rest allows.
    let one_mode = DMat2::from_diagonal(DVec2::new(4e-6, 2.6e-7));
    let one_mode = result(SecondMoments {
        slope: one_mode,
        ..good
    });
    assert!(
        matches!(one_mode, Err(e) if e.parameter() == "m_squared"),
        "{one_mode:?}"
    );
    let spiral = DMat2::from_cols_array(&[0.0, -1.6e-7, 1.6e-7, 0.0]);
    let spiral = result(SecondMoments {
        mixed: spiral,
        ..good
    });
    assert!(
        matches!(spiral, Err(e) if e.parameter() == "m_squared"),
        "{spiral:?}"
    );
    let wide = result(SecondMoments {
        slope: DMat2::IDENTITY * 0.07,
        ..good
    });
    assert!(
        matches!(wide, Err(e) if e.parameter() == "divergence"),
        "{wide:?}"
    );
    let wavelength = GeneralAstigmaticBeam::from_moments(-1.0, &good);
    assert!(
        matches!(wavelength, Err(e) if e.parameter() == "wavelength"),
        "{wavelength:?}"
    );
    let far = turning().propagated(1e35);
    assert!(
        matches!(far, Err(e) if e.parameter() == "radius"),
        "{far:?}"
    );
    let lens = AstigmaticSystem::thin_lens(1e-6).unwrap();
    let sharp = turning().through(&lens);
    assert!(
        matches!(sharp, Err(e) if e.parameter() == "divergence"),
        "{sharp:?}"
    );
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(2_000))]

    #[test]
    fn no_query_leaves_the_numbers(
        exponents in prop::array::uniform9(-30.0..30.0_f64),
        m_squared in 1.0..1e6_f64,
        rotations in prop::array::uniform2(-1e3..1e3_f64),
    ) {
        let [wavelength, w0, w1, z0, z1, x, y, z, f] = exponents.map(|e| 10_f64.powf(e));
        let least = 2.0 * m_squared * wavelength / PI;
        let axis = |waist: f64, z: f64| {
            GaussianBeam::from_waist(wavelength, waist.max(1.01 * least))
                .and_then(|beam| beam.with_m_squared(m_squared))
                .and_then(|beam| LocatedBeam::new(beam, z))
        };
        let (Ok(a), Ok(b)) = (axis(w0, z0), axis(w1, -z1)) else {
            return Ok(());
        };
        let simple = AstigmaticBeam::new(a, b).unwrap().with_rotation(rotations[0]).unwrap();
        let beam = GeneralAstigmaticBeam::from(simple);
        let lens = AstigmaticSystem::cylinder_lens(f, rotations[1]).unwrap();
        let moments = beam.moments_at(z);
        let built = GeneralAstigmaticBeam::from_moments(wavelength, &moments);
        let all = [Ok(beam), beam.through(&lens), beam.propagated(z), built];
        for beam in all.into_iter().flatten() {
            for z in [0.0, z, -z, f64::MAX] {
                let point = DVec3::new(x, -y, z);
                let numbers = [
                    beam.orientation_at(z),
                    beam.irradiance_per_watt(point),
                    beam.peak_irradiance_per_watt(z),
                    beam.twist(),
                ];
                let arrays = [beam.beam_quality(), beam.divergences(), beam.radii_at(z)];
                prop_assert!(numbers.iter().all(|v| !v.is_nan()), "{beam:?}, {point}: {numbers:?}");
                prop_assert!(arrays.as_flattened().iter().all(|v| !v.is_nan()), "{beam:?}: {arrays:?}");
                for point in [point, point.with_x(f64::MAX), DVec3::MIN] {
                    prop_assert!(!beam.irradiance_per_watt(point).is_nan(), "{beam:?}: {point}");
                    prop_assert!(!beam.flux_per_watt(point).is_nan(), "{beam:?}: {point}");
                }
                prop_assert!(!beam.curvature_tensor_at(z).is_nan(), "{beam:?}: {z}");
                let tensor = beam.complex_curvature_at(z);
                let number = tensor.as_flattened().iter().sum::<Complex64>();
                prop_assert!(!number.is_nan(), "{beam:?}: {z}");
                prop_assert!(!beam.position_per_slope().is_nan(), "{beam:?}");
            }
        }
    }
}
