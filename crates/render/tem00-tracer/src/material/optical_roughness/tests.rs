use super::*;
use crate::Metal;

const RED: f64 = 650e-9;

fn query() -> OpticalRoughnessQuery {
    OpticalRoughnessQuery {
        wavelength: RED,
        incidence: 0.6,
        viewing: 0.2,
        resolution_cell: 9e-6,
        rms_height: None,
    }
}

fn of(roughness: f64, query: &OpticalRoughnessQuery) -> OpticalRoughness {
    let metal = Material::conductor(Metal::Iron, roughness).unwrap();
    metal.optical_roughness(query).unwrap().unwrap()
}

#[test]
fn a_quarter_wave_of_height_turns_the_phase_by_pi_at_normal_incidence() {
    let query = OpticalRoughnessQuery {
        incidence: 0.0,
        viewing: 0.0,
        rms_height: Some(RED / 4.0),
        ..query()
    };
    let got = of(0.3, &query);
    // Path there and back: half a wave. exp(−π²) = 5.17e−5.
    assert!(
        (got.phase_deviation().unwrap() - PI).abs() < 1e-14,
        "{got:?}"
    );
    assert!(
        (got.coherent_fraction().unwrap() / 5.172_318_62e-5 - 1.0).abs() < 1e-8,
        "{got:?}"
    );
    // A turn takes four quarters' half: λ/2.
    assert!(
        (got.height_of_a_turn() / (RED / 2.0) - 1.0).abs() < 1e-14,
        "{got:?}"
    );
}

/// The mean of exp(iφ) over Gaussian phases, by quadrature over the heights.
#[test]
fn the_coherent_fraction_is_what_gaussian_heights_leave_in_step() {
    for height in [20e-9, 80e-9, 150e-9] {
        let got = of(
            0.3,
            &OpticalRoughnessQuery {
                rms_height: Some(height),
                ..query()
            },
        );
        let per_metre = TAU / RED * (0.6_f64.cos() + 0.2_f64.cos());
        let mean: f64 = (-8000..=8000_i32)
            .map(|i| {
                let x = f64::from(i) * 1e-3;
                let density = (-0.5 * x * x).exp() / TAU.sqrt() * 1e-3;
                density * (per_metre * height * x).cos()
            })
            .sum();
        let fraction = got.coherent_fraction().unwrap();
        // The trapezoidal rule is exact to the cut tails, exp(−32), and 16001 roundings.
        assert!(
            (fraction - mean * mean).abs() < 1e-12,
            "{height}: {fraction}"
        );
    }
}

/// The correlation of light behind a Gaussian phase screen, `exp(−σ_φ² (1 − ρ(r)))`.
#[test]
fn light_behind_a_rough_surface_decorrelates_within_the_correlation_length() {
    for roughness in [0.02, 0.3] {
        let height = 10.0 * of(roughness, &query()).height_of_a_turn();
        let got = of(
            roughness,
            &OpticalRoughnessQuery {
                rms_height: Some(height),
                ..query()
            },
        );
        let deviation = got.phase_deviation().unwrap();
        // The rms slope of a height correlation exp(−r²/ℓ²) is √2 σ_h/ℓ, and Beckmann's α is √2
        // times that.
        let length = 2.0 * height / roughness;
        let heights = (-(got.correlation_length() / length).powi(2)).exp();
        let light = (-deviation * deviation * (1.0 - heights)).exp();
        // The parabola of the correlation errs by 1/(2σ_φ²) of the exponent, 1/7900.
        assert!((light / (-1.0_f64).exp() - 1.0).abs() < 1.3e-4, "{light}");
    }
}

#[test]
fn a_phase_of_a_turn_stretches_the_heights_by_two_pi() {
    let got = of(0.02, &query());
    let ratio = got.height_correlation_length_of_a_turn() / got.correlation_length();
    assert!((ratio / TAU - 1.0).abs() < 1e-14, "{ratio}");
    // The slope of heights of a turn: √2 σ_h/ℓ = α/√2.
    let slope = 2.0_f64.sqrt() * got.height_of_a_turn() / got.height_correlation_length_of_a_turn();
    assert!((slope * 2.0_f64.sqrt() - 0.02).abs() < 1e-16, "{slope}");
}

/// N = A² / ∫∫ |μ|² over a large cell of area A, whose light correlates as `exp(−r²/r_c²)`.
#[test]
fn patches_are_the_area_over_the_area_of_correlation() {
    let got = of(0.3, &query());
    let area = PI / 4.0 * 9e-6 * 9e-6;
    let r_c = got.correlation_length();
    let rings = 4000;
    let step = 5.0 * r_c / f64::from(rings);
    let correlated: f64 = (0..rings)
        .map(|i| {
            let r = (f64::from(i) + 0.5) * step;
            TAU * r * step * (-2.0 * (r / r_c).powi(2)).exp()
        })
        .sum();
    // The midpoint rule errs by (5/4000)² / 24 of derivatives of order 10.
    assert!(
        (got.patches() * correlated / area - 1.0).abs() < 1e-6,
        "{got:?}"
    );
}

#[test]
fn smooth_or_flat_surfaces_are_told_apart() {
    let flat = OpticalRoughnessQuery {
        rms_height: Some(50e-9),
        ..query()
    };
    let high = OpticalRoughnessQuery {
        rms_height: Some(1e-6),
        ..query()
    };
    assert!(of(0.3, &query()).is_fully_developed(), "rough");
    assert!(of(0.3, &high).is_fully_developed(), "rough and high");
    assert!(!of(0.3, &flat).is_fully_developed(), "flat");
    assert!(!of(0.02, &high).is_fully_developed(), "smooth");
    assert!(
        of(0.3, &flat)
            .to_string()
            .ends_with("50 nm leaves 46.70 % of the light in step"),
        "{}",
        of(0.3, &flat)
    );
}

#[test]
fn only_rough_materials_are_judged() {
    let roughness = |material: Material| {
        let judged = material.optical_roughness(&query()).unwrap();
        judged.map(|judged| judged.roughness())
    };
    assert_eq!(roughness(Material::mirror(0.9).unwrap()), None, "mirror");
    assert_eq!(
        roughness(Material::polished(Metal::Gold).unwrap()),
        None,
        "metal"
    );
    assert_eq!(roughness(Material::dielectric(1.5).unwrap()), None, "glass");
    assert_eq!(
        roughness(Material::lambertian(0.5).unwrap()),
        Some(1.0),
        "paper"
    );
    assert_eq!(
        roughness(Material::oren_nayar(0.5, 0.3).unwrap()),
        Some(1.0),
        "plaster"
    );
    assert_eq!(
        roughness(Material::plastic(0.5, 1.5, 0.1).unwrap()),
        Some(0.1),
        "plastic"
    );
}

#[test]
fn impossible_circumstances_are_refused() {
    let material = Material::lambertian(0.5).unwrap();
    for (name, bad) in [
        (
            "wavelength",
            OpticalRoughnessQuery {
                wavelength: 650.0,
                ..query()
            },
        ),
        (
            "incidence",
            OpticalRoughnessQuery {
                incidence: 1.6,
                ..query()
            },
        ),
        (
            "viewing",
            OpticalRoughnessQuery {
                viewing: f64::NAN,
                ..query()
            },
        ),
        (
            "resolution_cell",
            OpticalRoughnessQuery {
                resolution_cell: 0.0,
                ..query()
            },
        ),
        (
            "rms_height",
            OpticalRoughnessQuery {
                rms_height: Some(-1e-6),
                ..query()
            },
        ),
    ] {
        let result = material.optical_roughness(&bad);
        assert!(
            matches!(result, Err(TracerError::OutOfRange { parameter, .. }) if parameter == name),
            "{name}: {result:?}"
        );
    }
}
