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
    let mut uniform = uniforms(4);
    for _ in 0..1000 {
        let (wo, wi) = (
            direction(uniform(), TAU * uniform()),
            direction(uniform(), TAU * uniform()),
        );
        let (got, want) = (coat.evaluate(wo, wi, RED), clear.evaluate(wo, wi, RED));
        // Two forms of Fresnel's formulae, each with some ten roundings of differences that keep
        // one digit in ten.
        assert!((got / want - 1.0).abs() < 1e-13, "{got}, not {want}");
        let (got, want) = (coat.pdf(wo, wi), clear.pdf(wo, wi));
        assert!((got / want - 1.0).abs() < 1e-14, "pdf {got}, not {want}");
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
            assert!(
                (total - 1.0).abs() < 3e-4,
                "n = {index}, α = {roughness}, {cosine}: {total}"
            );
        }
    }
}

#[test]
fn a_grey_base_under_a_smooth_coat_returns_what_the_inner_side_lets_out() {
    let (index, base) = (1.5, 0.5);
    let outside = walsh(index);
    assert!(
        (outside - 0.0918).abs() < 5e-5,
        "published for n = 1.5: {outside}"
    );
    let inside = 1.0 - (1.0 - outside) / (index * index);
    assert!(
        (inside - 0.596).abs() < 5e-4,
        "published for n = 1.5: {inside}"
    );
    let returned = base * (1.0 - inside) / (1.0 - base * inside);
    let material = Material::plastic(base, index, 0.01).unwrap();
    // Away from the mirror direction only the base is seen: (κ/π) T T / (1 − R).
    let (wo, wi) = (direction(1.0, 0.0), direction(0.5, 0.0));
    let [t_o, t_i] = [1.0, 0.5].map(|cosine| 1.0 - refraction(cosine, index).reflectance);
    let want = returned / PI * t_o * t_i / (1.0 - outside);
    let got = material.evaluate(wo, wi, RED);
    // The tail of the coat's lobe at 30° facets, F α² / (4π sin⁴θ cos θ cos θ') = 1e-5, and facets
    // of slope 0.01 change mean and directional transmittance by some 1e-3.
    assert!((got / want - 1.0).abs() < 2e-3, "{got}, not {want}");
}

#[test]
fn the_highlight_is_that_of_the_coat() {
    let material = Material::plastic(0.0, 1.5, 0.05).unwrap();
    // F D / 4 at normal incidence: 0.04 / (4 π α²).
    let peak = 0.04 / (4.0 * PI * 0.05 * 0.05);
    let got = material.evaluate(DVec3::Z, DVec3::Z, RED);
    assert!((got / peak - 1.0).abs() < 1e-14, "{got}, not {peak}");
}

#[test]
fn the_table_of_a_coat_is_its_albedo() {
    for (index, roughness) in [(1.5, 0.1), (1.5, 0.5), (3.0, 0.25), (1.5, 1.0)] {
        let facets = Ggx { alpha: roughness };
        let table = Albedo::new(facets, |cosine| refraction(cosine, index).reflectance);
        let coat = Material::plastic(0.0, index, roughness).unwrap();
        for cosine in [0.004, 0.05, 0.11, 0.37, 0.77, 1.0] {
            let wo = direction(cosine, 0.0);
            let want = albedo_of_facets(&coat, wo);
            let got = table.at_cosine(cosine);
            // Interpolation 2e-4, quadrature 1e-4.
            assert!(
                (got - want).abs() < 3e-4,
                "n = {index}, α = {roughness}, {cosine}: {got}, {want}"
            );
        }
        let rings = 20_000;
        let mean: f64 = (0..rings)
            .map(|i| (f64::from(i) + 0.5) / f64::from(rings))
            .map(|cosine| 2.0 * cosine * table.at_cosine(cosine) / f64::from(rings))
            .sum();
        // The midpoint rule meets a derivative of 1/cos^(3/4) at 0.
        assert!(
            (table.mean() - mean).abs() < 1e-7,
            "{} and {mean}",
            table.mean()
        );
    }
}
