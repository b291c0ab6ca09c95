use tem00_testkit::assert_relative;

use super::*;
use crate::PeakShape;

const WAVELENGTH: f64 = 450e-9;

fn line(linewidth: f64, shape: PeakShape) -> Spectrum {
    Spectrum::new(WAVELENGTH, linewidth, shape).expect("a spectrum")
}

fn pairs(spectrum: &Spectrum, paths: &[DelayedLight]) -> [f64; 2] {
    let mut pairs = PathPairs::default();
    pairs.add(spectrum, paths, paths);
    [pairs.self_coherence(), pairs.coherence_with_single()].map(|c| c.expect("light"))
}

/// Normally distributed delays, as nodes of the trapezoidal rule.
fn normal(mean: f64, spread: f64) -> Vec<DelayedLight> {
    let node = |i: i32| {
        let z = f64::from(i) / 16.0;
        DelayedLight {
            weight: (-0.5 * z * z).exp(),
            delay: mean + spread * z,
        }
    };
    (-112..=112).map(node).collect()
}

#[test]
fn normal_delays_have_closed_forms() {
    for (linewidth, mean, spread) in [
        (0.05e-9, 0.82e-3, 38e-6),
        (0.2e-9, 0.3e-3, 0.2e-3),
        (1e-9, 0.0, 0.1e-3),
    ] {
        let spectrum = line(linewidth, PeakShape::Gaussian);
        let (s, m) = (
            spectrum.wave_number_spread() * spread,
            spectrum.wave_number_spread() * mean,
        );
        let [c22, c12] = pairs(&spectrum, &normal(mean, spread));
        assert_relative(c22, (1.0 + 4.0 * s * s).powf(-0.5), 1e-9);
        let with_single = (1.0 + 2.0 * s * s).powf(-0.5) * (-m * m / (1.0 + 2.0 * s * s)).exp();
        assert_relative(c12, with_single, 1e-9);
    }
}

#[test]
fn pairs_of_normal_delays_are_the_integral_over_differences_of_wave_numbers() {
    let (mean, spread) = (0.3e-3, 0.1e-3);
    for shape in [PeakShape::Lorentzian, PeakShape::Rectangular] {
        let spectrum = line(0.3e-9, shape);
        let [c22, c12] = pairs(&spectrum, &normal(mean, spread));
        // ∫ R(κ) P₂(κ) P*ⱼ(κ) dκ.
        let by_differences = |common: f64, shift: f64| {
            spectrum.mean_over_pairs(1.0 / mean, |kappa| {
                (-common * (kappa * spread).powi(2)).exp() * (kappa * shift).cos()
            })
        };
        // The cusp of |γ|² of a Lorentzian lies between nodes.
        assert_relative(c22, by_differences(1.0, 0.0), 2e-3);
        assert_relative(c12, by_differences(0.5, mean), 2e-3);
    }
}

#[test]
fn two_paths_have_closed_forms() {
    let shares = [0.3, 0.7];
    let delays = [0.2e-3, 0.9e-3];
    let paths = [0, 1].map(|i| DelayedLight {
        weight: 5.0 * shares[i],
        delay: delays[i],
    });
    for shape in [
        PeakShape::Gaussian,
        PeakShape::Lorentzian,
        PeakShape::Rectangular,
    ] {
        let spectrum = line(0.2e-9, shape);
        let between = spectrum.squared_coherence(0.7e-3);
        let [c22, c12] = pairs(&spectrum, &paths);
        assert_relative(c22, 0.58 + 0.42 * between, 1e-12);
        let single = delays.map(|delay| spectrum.squared_coherence(delay));
        let mean = 0.3 * single[0] + 0.7 * single[1];
        assert_relative(c12, mean, 1e-12);
    }
}

#[test]
fn light_of_one_wavelength_is_coherent_over_all_paths() {
    let spectrum = Spectrum::monochromatic(WAVELENGTH).expect("a spectrum");
    for coherence in pairs(&spectrum, &normal(1.3, 0.7)) {
        assert!((coherence - 1.0).abs() < f64::EPSILON, "{coherence}");
    }
}

#[test]
fn without_light_there_is_no_coherence() {
    let spectrum = line(1e-9, PeakShape::Gaussian);
    let mut none = PathPairs::default();
    let dark = [DelayedLight {
        weight: 0.0,
        delay: 1.0,
    }];
    none.add(&spectrum, &dark, &dark);
    none.add(&spectrum, &[], &dark);
    assert_eq!(none.self_coherence(), None);
    assert_eq!(none.coherence_with_single(), None);
}

#[test]
fn sums_of_neighbours_count_with_their_factors() {
    let spectrum = line(0.5e-9, PeakShape::Gaussian);
    let (near, far) = (normal(0.0, 1e-5), normal(1e-3, 1e-4));
    let mut mixed = PathPairs::default();
    for (paths, factor) in [(&near, 0.25), (&far, 0.75)] {
        let mut pairs = PathPairs::default();
        pairs.add(&spectrum, paths, paths);
        mixed.add_scaled(&pairs, factor);
    }
    let [first, second] = [&near, &far].map(|paths| pairs(&spectrum, paths));
    let mean = |i: usize| 0.25 * first[i] + 0.75 * second[i];
    let c22 = mixed.self_coherence().expect("light");
    assert_relative(c22, mean(0), 1e-12);
    let c12 = mixed.coherence_with_single().expect("light");
    assert_relative(c12, mean(1), 1e-12);
}

#[test]
fn patterns_that_fall_by_the_ratio_have_the_contrast() {
    for squared in [0.05, 0.4, 0.95, 1.0] {
        let t = mode_ratio(squared);
        let shares = (0..400).map(|n| (1.0 - t) * t.powi(n));
        let sum: f64 = shares.map(|share| share * share).sum();
        assert_relative(sum, squared, 1e-12);
    }
}
