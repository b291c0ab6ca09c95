use proptest::prelude::*;
use tem00_speckle::Complex;
use tem00_testkit::{assert_absolute, refuses};

use super::*;

#[test]
fn tables_rise_in_wavelength_and_contain_the_measured_range() {
    let tables = [
        ALUMINIUM, SILVER, GOLD, COPPER, IRON, CHROMIUM, NICKEL, TITANIUM,
    ];
    let more = [TUNGSTEN, PLATINUM, BRASS, STAINLESS_STEEL];
    for Table { nanometres, n, k } in tables.into_iter().chain(more) {
        assert!(nanometres.is_sorted_by(|a, b| a < b), "{nanometres:?}");
        assert!(nanometres[0] <= 368.0, "{nanometres:?}");
        assert!(nanometres[nanometres.len() - 1] >= 1088.0, "{nanometres:?}");
        assert_eq!([n.len(), k.len()], [nanometres.len(); 2], "{nanometres:?}");
    }
}

fn red(metal: Metal) -> f64 {
    metal.normal_reflectance(650e-9).unwrap()
}

#[test]
fn other_laboratories_measured_the_same_reflectance_in_red() {
    // n and k at 650 nm as measured by Cheng et al. 2016 (aluminium), McPeak et al. 2015
    // (silver, gold, copper), Querry 1985 (iron), Rakić et al. 1998 (chromium, nickel, titanium),
    // Weaver et al. 1975 (tungsten) and Tselin et al. 2024 (platinum).
    for (metal, n, k, allowed) in [
        // Films differ: by 1 % of the light for the best mirrors, by 5 % for iron.
        (Metal::Aluminium, 0.917, 6.221, 0.05),
        (Metal::Silver, 0.051, 4.460, 0.02),
        (Metal::Gold, 0.126, 3.792, 0.02),
        (Metal::Copper, 0.105, 3.72, 0.05),
        (Metal::Iron, 2.427, 3.361, 0.05),
        (Metal::Nickel, 2.059, 3.758, 0.06),
        (Metal::Tungsten, 3.671, 2.932, 0.02),
        // These oxidise or depend on the film.
        (Metal::Chromium, 3.427, 4.273, 0.09),
        (Metal::Titanium, 2.090, 3.178, 0.09),
        (Metal::Platinum, 2.231, 5.193, 0.09),
    ] {
        let [got, other] = [metal, Metal::Custom { n, k }].map(red);
        assert!(
            (got - other).abs() < allowed,
            "{metal:?}: {got}, elsewhere {other}"
        );
    }
}

#[test]
fn alloys_reflect_like_their_kind() {
    // Brass reflects red like copper's alloys do, Querry's own Cu 90 % Zn 10 %: n = 0.32, k = 3.396
    // gives 0.903; zinc takes some per cent of it. In blue it keeps more than copper: less yellow.
    let blue = |metal: Metal| metal.normal_reflectance(450e-9).unwrap();
    let bronze = Metal::Custom { n: 0.32, k: 3.396 };
    assert!((red(Metal::Brass) - red(bronze)).abs() < 0.03, "brass");
    assert!(blue(Metal::Brass) < 0.6 * red(Metal::Brass), "yellow");
    // Handbooks give polished stainless steel 0.60 ± 0.05 in the visible, more than iron.
    let steel = red(Metal::StainlessSteel);
    assert!((steel - 0.6).abs() < 0.05, "stainless steel: {steel}");
    assert!(steel > red(Metal::Iron), "stainless steel: {steel}");
}

#[test]
fn index_is_the_measurement_at_a_measured_wavelength_and_the_mean_between_two() {
    let at = |nanometres: f64| Metal::Gold.refractive_index(nanometres * 1e-9).unwrap();
    let rows = [
        (659.5, 0.14, 3.697),
        (638.15, 0.175, 3.4845),
        (1088.0, 0.27, 7.15),
    ];
    for (nanometres, n, k) in rows {
        let got = at(nanometres);
        // Nanometres to metres and back is good to two roundings; the table rises by 1 in 40.
        assert_absolute(got.0, n, 1e-12);
        assert_absolute(got.1, k, 1e-12);
    }
}

#[test]
fn wavelengths_outside_the_tables_and_impossible_indices_are_refused() {
    for (_, metal) in Metal::NAMED {
        refuses!(wavelength = 650e-9 => metal.refractive_index(wavelength);
            wavelength: [-650e-9, 0.0, 367e-9, 1.1e-6, 650.0, f64::NAN]);
    }
    refuses!(n = 1.0, k = 1.0 => Metal::Custom { n, k }.refractive_index(650e-9);
        n: [0.0, f64::NAN, 1e7], k: [-0.1, 1e200, f64::INFINITY]);
}

#[test]
fn normal_incidence_follows_the_closed_form() {
    for (n, k) in [(0.05, 4.5), (1.5, 0.0), (2.9, 3.1), (1.5, 7.7), (1e-3, 1e3)] {
        let closed = ((n - 1.0) * (n - 1.0) + k * k) / ((n + 1.0) * (n + 1.0) + k * k);
        let got = fresnel_reflectance(1.0, (n, k));
        // a = n is a difference of squares as large as k²: its error grows to (k/n)² ε / 4, and
        // R moves by at most 4a/k² times the relative error of a.
        let error_of_a = 1.0 + (k / n) * (k / n);
        let tolerance = 4e-16 * (4.0 + 4.0 * n / (n * n + k * k).max(1.0) * error_of_a);
        assert!(
            (got - closed).abs() < tolerance,
            "n = {n}, k = {k}: {got}, not {closed}"
        );
    }
}

/// Reflectance from the complex amplitudes of both polarisations (Born and Wolf, §1.5).
fn reflectance_from_amplitudes(cosine: f64, (n, k): (f64, f64)) -> f64 {
    let square = Complex::new(n, k) * Complex::new(n, k);
    // n cos θ_t, from Snell's law.
    let transmitted = (square - (1.0 - cosine * cosine)).sqrt();
    let amplitude = |p: Complex<f64>| ((p - transmitted) / (p + transmitted)).norm_sqr();
    0.5 * (amplitude(cosine.into()) + amplitude(square * cosine))
}

proptest! {
    #[test]
    fn fresnel_reflectance_is_that_of_the_complex_amplitudes(
        cosine in 0.0_f64..=1.0, n in 0.05_f64..4.0, k in 0.0_f64..10.0,
    ) {
        let got = fresnel_reflectance(cosine, (n, k));
        let want = reflectance_from_amplitudes(cosine, (n, k));
        // The difference of squares in a² loses (k/n)² ≤ 4e4 roundings of 1.1e−16; R moves by
        // less than the relative error of a.
        prop_assert!((got - want).abs() < 2e-11, "got {got}, want {want}");
        prop_assert!((0.0..=1.0).contains(&got), "R = {got}");
    }
}

#[test]
fn everything_reflects_at_grazing_incidence_and_nothing_gives_nan() {
    for (_, metal) in Metal::NAMED {
        let index = metal.refractive_index(650e-9).unwrap();
        assert_absolute(fresnel_reflectance(0.0, index), 1.0, 1e-15);
    }
    for n in [1e-6, 1.0, 1e6] {
        for k in [0.0, 1e-300, 1.0, 1e6] {
            for cosine in [0.0, 5e-324, 1e-170, 1e-8, 0.5, 1.0] {
                let got = fresnel_reflectance(cosine, (n, k));
                assert!(
                    (0.0..=1.0).contains(&got),
                    "n = {n}, k = {k}, cos {cosine}: {got}"
                );
            }
        }
    }
}
