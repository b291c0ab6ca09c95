use tem00_testkit::{assert_absolute, assert_relative, refuses};

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

/// The query for a surface of a known rms height.
fn high(rms_height: f64) -> OpticalRoughnessQuery {
    OpticalRoughnessQuery {
        rms_height: Some(rms_height),
        ..query()
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
        ..high(RED / 4.0)
    };
    let got = of(0.3, &query);
    // Path there and back: half a wave. exp(−π²) = 5.17e−5.
    assert_absolute(got.phase_deviation().unwrap(), PI, 1e-14);
    assert_relative(got.coherent_fraction().unwrap(), 5.172_318_62e-5, 1e-8);
}

/// The mean of exp(iφ) over Gaussian phases, by quadrature over the heights.
#[test]
fn the_coherent_fraction_is_what_gaussian_heights_leave_in_step() {
    for height in [20e-9, 80e-9, 150e-9] {
        let got = of(0.3, &high(height));
        let per_metre = TAU / RED * (0.6_f64.cos() + 0.2_f64.cos());
        let mean: f64 = (-8000..=8000_i32)
            .map(|i| {
                let x = f64::from(i) * 1e-3;
                let density = (-0.5 * x * x).exp() / TAU.sqrt() * 1e-3;
                density * (per_metre * height * x).cos()
            })
            .sum();
        // The trapezoidal rule is exact to the cut tails, exp(−32), and 16001 roundings.
        assert_absolute(got.coherent_fraction().unwrap(), mean * mean, 1e-12);
    }
}

/// The correlation of light behind a Gaussian phase screen, `exp(−σ_φ² (1 − ρ(r)))`.
#[test]
fn light_behind_a_rough_surface_decorrelates_within_the_correlation_length() {
    for roughness in [0.02, 0.3] {
        // Ten turns of the phase.
        let height = 10.0 * RED / (0.6_f64.cos() + 0.2_f64.cos());
        let got = of(roughness, &high(height));
        let deviation = got.phase_deviation().unwrap();
        // The rms slope of a height correlation exp(−r²/ℓ²) is √2 σ_h/ℓ, and Beckmann's α is √2
        // times that.
        let length = 2.0 * height / roughness;
        let heights = (-(got.correlation_length() / length).powi(2)).exp();
        let light = (-deviation * deviation * (1.0 - heights)).exp();
        // The parabola of the correlation errs by 1/(2σ_φ²) of the exponent, 1/7900.
        assert_relative(light, (-1.0_f64).exp(), 1.3e-4);
    }
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
    assert_relative(got.patches() * correlated, area, 1e-6);
}

#[test]
fn smooth_or_flat_surfaces_are_told_apart() {
    for (roughness, query, is_developed) in [
        (0.3, query(), true),
        (0.3, high(1e-6), true),
        (0.3, high(50e-9), false),
        (0.02, high(1e-6), false),
    ] {
        let got = of(roughness, &query);
        assert_eq!(got.is_fully_developed(), is_developed, "{got:?}");
    }
    let text = of(0.3, &high(50e-9)).to_string();
    assert!(
        text.ends_with("50 nm leaves 46.70 % of the light in step"),
        "{text}"
    );
}

#[test]
fn only_rough_materials_are_judged() {
    for (material, roughness) in [
        (Material::mirror(0.9), None),
        (Material::polished(Metal::Gold), None),
        (Material::dielectric(1.5), None),
        (Material::lambertian(0.5), Some(1.0)),
        (Material::oren_nayar(0.5, 0.3), Some(1.0)),
        (Material::plastic(0.5, 1.5, 0.1), Some(0.1)),
    ] {
        let material = material.unwrap();
        let judged = material.optical_roughness(&query()).unwrap();
        assert_eq!(
            judged.map(|judged| judged.roughness()),
            roughness,
            "{material:?}"
        );
    }
}

#[test]
fn impossible_circumstances_are_refused() {
    let material = Material::lambertian(0.5).unwrap();
    refuses!(query = query() => material.optical_roughness(&query);
        query.wavelength: [650.0],
        query.incidence: [1.6],
        query.viewing: [f64::NAN],
        query.resolution_cell: [0.0],
        query.rms_height: [Some(-1e-6)],
    );
}
