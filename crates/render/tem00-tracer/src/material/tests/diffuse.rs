use super::{super::diffuse::choose_first, *};

/// Light reflected once by white facets in Fujii's form, without the factor A, as a BRDF.
fn once(wo: DVec3, wi: DVec3, ratio: f64) -> f64 {
    let s = wo.dot(wi) - wo.z * wi.z;
    let t = if s > 0.0 { wo.z.max(wi.z) } else { 1.0 };
    (1.0 + ratio * s / t) / PI
}

#[test]
fn flat_facets_are_lambertian_to_the_bit() {
    let (flat, lambertian) = (
        Material::oren_nayar(0.37, 0.0).unwrap(),
        Material::lambertian(0.37).unwrap(),
    );
    let mut numbers = Numbers::new(3);
    for _ in 0..1000 {
        let wo = direction(numbers.unit(), TAU * numbers.unit());
        let u = numbers.units();
        let [got, want] = [flat, lambertian].map(|m| m.sample(wo, u, RED).unwrap());
        assert_eq!((got.wi, got.pdf), (want.wi, want.pdf), "samples");
        // The cosine cancels in the weight, but for its two roundings.
        assert_relative(got.weight, want.weight, 4e-16);
        let [got, want] = [flat, lambertian].map(|m| m.evaluate(wo, got.wi, RED));
        assert_absolute(got, want, 0.0);
    }
}

#[test]
fn white_facets_lose_nothing() {
    for sigma in [0.05, 0.35, 1.0, 1.57] {
        let material = Material::oren_nayar(1.0, sigma).unwrap();
        for cosine in [0.02, 0.2, 0.6, 1.0] {
            let wo = direction(cosine, 0.7);
            // The midpoint rule with its kink at the height of wo: (1/500)² of slopes up to 1/cos.
            assert_absolute(albedo(&material, wo, [500, 500]), 1.0, 2e-4);
        }
    }
}

/// The albedo of grey facets is the sum of the light that met one, two, three … of them.
#[test]
fn grey_facets_reflect_the_sum_of_all_orders() {
    let (reflectance, sigma) = (0.6, 0.8_f64);
    // Oren and Nayar 1994, eq. 30.
    let square = sigma * sigma;
    let a = 1.0 - 0.5 * square / (square + 0.33);
    let ratio = 0.45 * square / (square + 0.09) / a;
    // Facets that lose nothing at grazing incidence fix the scale A.
    let grazing = direction(1e-6, 0.0);
    let scale = integrate(|wi| once(grazing, wi, ratio) * wi.z, 400, 400).recip();
    let single = |wo: DVec3| scale * integrate(|wi| once(wo, wi, ratio) * wi.z, 60, 60);
    let material = Material::oren_nayar(reflectance, sigma).unwrap();
    let total = |wo: DVec3| albedo(&material, wo, [60, 60]);
    let mean_of = |albedo: &dyn Fn(DVec3) -> f64| {
        (0..60)
            .map(|i| {
                let cosine = (f64::from(i) + 0.5) / 60.0;
                2.0 * cosine * albedo(direction(cosine, 0.0)) / 60.0
            })
            .sum::<f64>()
    };
    let mean = mean_of(&single);
    let orders: f64 = (0..200)
        .map(|order| reflectance * mean * (reflectance * (1.0 - mean)).powi(order))
        .sum();
    // Both sides share the midpoint rule on 60 points, good to 1/60² / 24 of second derivatives
    // of order 10.
    assert_absolute(mean_of(&total), orders, 2e-4);
}

/// In the limit of dark facets only one reflection is left, and in the half space of the light the
/// ratio to normal incidence is that of Oren and Nayar's qualitative model.
#[test]
fn dark_facets_retro_reflect_as_published() {
    for sigma in [0.1_f64, 0.35, 0.7] {
        let square = sigma * sigma;
        let a = 1.0 - 0.5 * square / (square + 0.33);
        let b = 0.45 * square / (square + 0.09);
        let dark = Material::oren_nayar(1e-12, sigma).unwrap();
        let head_on = dark.evaluate(DVec3::Z, DVec3::Z, RED);
        for (theta_o, theta_i, turn) in [(1.2, 1.2, 0.0), (0.4, 1.3, 0.5), (1.0, 0.3, 1.4_f64)] {
            let (alpha, beta) = (f64::max(theta_o, theta_i), f64::min(theta_o, theta_i));
            let published = (a + b * turn.cos() * alpha.sin() * beta.tan()) / a;
            let (wo, wi) = (
                direction(theta_o.cos(), 1.0),
                direction(theta_i.cos(), 1.0 + turn),
            );
            // More reflections are 1e-12 of one; the rest is some 20 roundings.
            assert_relative(dark.evaluate(wo, wi, RED) / head_on, published, 1e-11);
        }
    }
}

#[test]
fn a_uniform_number_chooses_a_lobe_and_stays_uniform() {
    let cases = [
        (0.0, true, 0.0),
        (0.1, true, 0.4),
        (0.25, false, 0.0),
        (0.7, false, 0.6),
    ];
    for (u, first, rest) in cases {
        let (got, left) = choose_first(0.25, u);
        assert_eq!(got, first, "u = {u}");
        assert_absolute(left, rest, 1e-15);
    }
    let largest = 1.0 - f64::EPSILON / 2.0;
    for probability in [0.0, 0.3, 1.0 - 1e-16, 1.0] {
        for u in [0.0, 0.3, largest] {
            let (_, left) = choose_first(probability, u);
            assert!((0.0..1.0).contains(&left), "{probability}, {u}: {left}");
        }
    }
}
