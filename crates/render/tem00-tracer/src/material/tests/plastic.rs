use super::{
    super::{albedo::Albedo, dielectric::refraction},
    *,
};

/// The fraction of diffuse light that a smooth boundary reflects from outside (Walsh 1926).
fn walsh(n: f64) -> f64 {
    let (n2, n4) = (n * n, n.powi(4));
    0.5 + (n - 1.0) * (3.0 * n + 1.0) / (6.0 * (n + 1.0).powi(2))
        + n2 * (n2 - 1.0).powi(2) / (n2 + 1.0).powi(3) * ((n - 1.0) / (n + 1.0)).ln()
        - 2.0 * n.powi(3) * (n2 + 2.0 * n - 1.0) / ((n2 + 1.0) * (n4 - 1.0))
        + 8.0 * n4 * (n4 + 1.0) / ((n2 + 1.0) * (n4 - 1.0).powi(2)) * n.ln()
}

#[test]
fn a_black_base_leaves_the_facets_of_a_clear_coat() {
    let coat = Material::plastic(0.0, 1.5, 0.2).unwrap();
    let clear = Material::conductor(Metal::Custom { n: 1.5, k: 0.0 }, 0.2).unwrap();
    let mut numbers = Numbers::new(4);
    for _ in 0..1000 {
        let mut any = || direction(numbers.unit(), TAU * numbers.unit());
        let (wo, wi) = (any(), any());
        // Two forms of Fresnel's formulae, each with some ten roundings of differences that keep
        // one digit in ten.
        assert_relative(
            coat.evaluate(wo, wi, RED),
            clear.evaluate(wo, wi, RED),
            1e-13,
        );
        assert_relative(coat.pdf(wo, wi), clear.pdf(wo, wi), 1e-14);
    }
}

#[test]
fn a_white_base_under_a_clear_coat_loses_nothing() {
    for (index, roughness) in [(1.5, 0.1), (1.5, 0.4), (2.5, 0.3), (1.5, 1.0), (1.1, 0.3)] {
        let white = Material::plastic(1.0, index, roughness).unwrap();
        let coat = Material::plastic(0.0, index, roughness).unwrap();
        for cosine in [0.003, 0.03, 0.3, 0.7, 1.0] {
            let wo = direction(cosine, 0.4);
            let base = |wi| white.evaluate(wo, wi, RED) - coat.evaluate(wo, wi, RED);
            let total = albedo_of_facets(&coat, wo) + integrate(|wi| base(wi) * wi.z, 300, 4);
            // The table is good to 2e-4, the quadrature over facets to 1e-4.
            assert_absolute(total, 1.0, 3e-4);
        }
    }
}

#[test]
fn a_grey_base_under_a_smooth_coat_returns_what_the_inner_side_lets_out() {
    let (index, base) = (1.5, 0.5);
    let outside = walsh(index);
    let inside = 1.0 - (1.0 - outside) / (index * index);
    // Published for n = 1.5.
    assert_absolute(outside, 0.0918, 5e-5);
    assert_absolute(inside, 0.596, 5e-4);
    let returned = base * (1.0 - inside) / (1.0 - base * inside);
    let material = Material::plastic(base, index, 0.01).unwrap();
    // Away from the mirror direction only the base is seen: (κ/π) T T / (1 − R).
    let (wo, wi) = (direction(1.0, 0.0), direction(0.5, 0.0));
    let [t_o, t_i] = [1.0, 0.5].map(|cosine| 1.0 - refraction(cosine, index).reflectance);
    let want = returned / PI * t_o * t_i / (1.0 - outside);
    // The tail of the coat's lobe at 30° facets, F α² / (4π sin⁴θ cos θ cos θ') = 1e-5, and facets
    // of slope 0.01 change mean and directional transmittance by some 1e-3.
    assert_relative(material.evaluate(wo, wi, RED), want, 2e-3);
}

#[test]
fn the_table_of_a_coat_is_its_albedo() {
    for (index, roughness) in [(1.5, 0.1), (1.5, 0.5), (3.0, 0.25), (1.5, 1.0)] {
        let facets = Ggx { alpha: roughness };
        let table = Albedo::new(facets, |cosine| refraction(cosine, index).reflectance);
        let coat = Material::plastic(0.0, index, roughness).unwrap();
        for cosine in [0.004, 0.05, 0.11, 0.37, 0.77, 1.0] {
            let wo = direction(cosine, 0.0);
            // Interpolation 2e-4, quadrature 1e-4.
            assert_absolute(table.at_cosine(cosine), albedo_of_facets(&coat, wo), 3e-4);
        }
        let rings = 20_000;
        let mean: f64 = (0..rings)
            .map(|i| (f64::from(i) + 0.5) / f64::from(rings))
            .map(|cosine| 2.0 * cosine * table.at_cosine(cosine) / f64::from(rings))
            .sum();
        // The midpoint rule meets a derivative of 1/cos^(3/4) at 0.
        assert_absolute(table.mean(), mean, 1e-7);
    }
}

#[test]
fn an_albedo_is_never_more_than_all() {
    for thousandth in (10..30).chain([40, 80, 160, 320, 640, 1000]) {
        let alpha = f64::from(thousandth) * 1e-3;
        let table = Albedo::new(Ggx { alpha }, |_| 1.0);
        for i in 0..=2000 {
            let albedo = table.at_cosine((f64::from(i) / 2000.0).powi(4));
            assert!((0.0..=1.0).contains(&albedo), "α = {alpha}: {albedo}");
        }
    }
}

#[test]
fn a_white_table_is_that_of_a_perfect_metal() {
    // With α = 1 facets point everywhere alike: the albedo is 1 − μ ln(1 + 1/μ).
    let table = Albedo::new(Ggx { alpha: 1.0 }, |_| 1.0);
    for cosine in [0.001_f64, 0.03, 0.3, 0.71, 1.0] {
        let closed = 1.0 - cosine * cosine.recip().ln_1p();
        assert_absolute(table.at_cosine(cosine), closed, 3e-4);
    }
    // By parts: ∫ 2μ² ln(1 + 1/μ) dμ = ⅔ (ln 2 + ∫ μ²/(1 + μ) dμ) = ⅔ (2 ln 2 − ½).
    let lost = 2.0 / 3.0 * (2.0 * 2.0_f64.ln() - 0.5);
    assert_absolute(table.mean(), 1.0 - lost, 3e-4);
}

/// In even light, light from below is as bright as the diffuse base that stands for it elsewhere.
#[test]
fn light_from_below_is_as_bright_as_the_base_of_the_coat() {
    for roughness in [0.01, 0.3] {
        let jade = jade(roughness);
        for [from, to] in [
            [0.0, 0.0],
            [0.0, 45.0],
            [45.0, 20.0],
            [60.0, 60.0],
            [75.0, 0.0],
        ] {
            let [wi, wo] = [from, to].map(|angle: f64| direction(angle.to_radians().cos(), 0.5));
            let seeds = 0..20_000;
            let count = seeds.end as f64;
            let entries = seeds.map(|seed| jade.entry([wo, wi], 0.0, seed, |_| 1.0));
            let radiance = entries.flatten().map(|(_, radiance)| radiance).sum::<f64>() / count;
            let base = jade.evaluate(wo, wi, RED) - jade.evaluate_boundary(wo, wi, RED);
            assert_relative(radiance, base * wi.z, 0.1);
        }
    }
}
