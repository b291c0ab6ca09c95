use proptest::prelude::*;
use tem00_testkit::{assert_absolute, assert_relative};

use super::*;

fn squared(light: MixedLight) -> f64 {
    light.contrast().expect("a contrast").powi(2)
}

#[test]
fn depolarised_multiple_light_adds_to_one_of_two_components() {
    let [single, multiple] = [1.0 / 1.3, 0.3 / 1.3];
    let light = MixedLight {
        multiple,
        within_single: 0.9,
        with_single: 0.4,
        within_multiple: 0.7,
        polarisation: [1.0, 0.0],
    };
    // f₁² c₁₁ + f₁ f₂ c₁₂ + f₂² c₂₂ / 2.
    let expected = 0.9 * single * single + 0.4 * single * multiple + 0.35 * multiple * multiple;
    assert_relative(squared(light), expected, 1e-14);
    let coherent = MixedLight {
        multiple,
        polarisation: [1.0, 0.0],
        ..MixedLight::default()
    };
    assert_absolute(squared(coherent).sqrt(), 0.892, 5e-4);
}

proptest! {
    /// For unpolarised light each of the two components is an independent mixture.
    #[test]
    fn components_add_as_independent_patterns(
        multiple in 0.0..1.0, c in prop::array::uniform3(0.0..1.0),
        degrees in prop::array::uniform2(0.0..1.0)
    ) {
        let light = MixedLight {
            multiple,
            within_single: c[0],
            with_single: c[1],
            within_multiple: c[2],
            polarisation: degrees,
        };
        let of_component = |sign: f64| {
            let [first, second] = degrees.map(|degree| 0.5 * (1.0 + sign * degree));
            let (a, b) = ((1.0 - multiple) * first, multiple * second);
            a * a * c[0] + 2.0 * a * b * c[1] + b * b * c[2]
        };
        let sum = of_component(1.0) + of_component(-1.0);
        prop_assert!((squared(light) - sum).abs() < 1e-14);
    }
}

#[test]
fn speckle_of_speckle_has_the_contrasts_of_its_table() {
    let table = [
        (0.0, 3.0_f64.sqrt()),
        (0.1, 1.667),
        (0.25, 1.573),
        (0.5, 1.435),
        (1.0, 1.237),
        (2.0, 1.086),
        (5.0, 1.017),
        (10.0, 1.004),
        (f64::INFINITY, 1.0),
    ];
    for (r, contrast) in table {
        let variance = cascade_variance(r).expect("a ratio");
        assert_absolute((1.0 + 2.0 * variance).sqrt(), contrast, 6e-4);
    }
}

/// The coherence of two directions of the light is the overlap of two pupils at the same distance.
#[test]
fn speckle_of_speckle_is_a_mean_over_pairs_of_directions() {
    let count = 1000;
    let direction = |i: u32| {
        let radius = ((f64::from(i) + 0.5) / f64::from(count)).sqrt();
        let (sin, cos) = (2.399_963 * f64::from(i)).sin_cos();
        [radius * cos, radius * sin]
    };
    let all: Vec<[f64; 2]> = (0..count).map(direction).collect();
    for r in [0.3, 1.0, 3.0] {
        let shared = |a: &[f64; 2], b: &[f64; 2]| {
            disc_overlap(0.5 * r * (a[0] - b[0]).hypot(a[1] - b[1])).powi(2)
        };
        let pairs = all
            .iter()
            .flat_map(|a| all.iter().map(move |b| shared(a, b)));
        let mean = pairs.sum::<f64>() / f64::from(count).powi(2);
        let variance = cascade_variance(r).expect("a ratio");
        // Each direction is paired with itself, too.
        assert_absolute(variance, mean, 1e-3);
    }
}
