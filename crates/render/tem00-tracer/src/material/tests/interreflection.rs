use super::{super::albedo::Albedo, *};

/// A metal that absorbs nothing.
const PERFECT: Metal = Metal::Custom { n: 1e-6, k: 1e3 };

#[test]
fn facets_that_absorb_nothing_lose_nothing() {
    for roughness in [0.1, 0.3, 0.6, 1.0] {
        let many = Material::interreflecting_conductor(PERFECT, roughness).unwrap();
        let once = perfect(roughness);
        for cosine in [0.02, 0.1, 0.3, 0.7, 1.0] {
            let wo = direction(cosine, 0.4);
            let added = |wi| many.evaluate(wo, wi, RED) - once.evaluate(wo, wi, RED);
            let total = albedo_of_facets(&once, wo) + integrate(|wi| added(wi) * wi.z, 300, 4);
            // The table is good to 3e-4, the quadrature over facets to 1e-4.
            assert!(
                (total - 1.0).abs() < 4e-4,
                "α = {roughness}, cos = {cosine}: {total}"
            );
        }
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

/// The light that meets two, three … facets: each reflects F̄, and a part Ē of it then leaves.
#[test]
fn facets_that_absorb_pass_on_a_geometric_series() {
    let many = Material::interreflecting_conductor(PERFECT, 0.5).unwrap();
    let (wo, wi) = (direction(0.8, 0.4), direction(0.6, 3.0));
    let white = many.evaluate(wo, wi, RED) - perfect(0.5).evaluate(wo, wi, RED);
    let grey = casting(0.5).evaluate(wo, wi, RED) - iron(0.5).evaluate(wo, wi, RED);
    let index = Metal::Iron.refractive_index(RED).unwrap();
    let mean: f64 = (0..1000)
        .map(|i| (f64::from(i) + 0.5) / 1000.0)
        .map(|cosine| 2.0 * cosine * fresnel_reflectance(cosine, index) / 1000.0)
        .sum();
    let kept = Albedo::new(Ggx { alpha: 0.5 }, |_| 1.0).mean();
    let series: f64 = (1..200)
        .map(|order| mean * kept * (mean * (1.0 - kept)).powi(order) / (1.0 - kept))
        .sum();
    // The series of white facets is 1. The mean over three points errs by 2e-3, twice as much of it
    // in the series.
    assert!(
        (grey / white - series).abs() < 4e-3,
        "{} and {series}",
        grey / white
    );
}

#[test]
fn a_white_table_is_that_of_a_perfect_metal() {
    // With α = 1 facets point everywhere alike: the albedo is 1 − μ ln(1 + 1/μ).
    let table = Albedo::new(Ggx { alpha: 1.0 }, |_| 1.0);
    for cosine in [0.001_f64, 0.03, 0.3, 0.71, 1.0] {
        let closed = 1.0 - cosine * cosine.recip().ln_1p();
        let got = table.at_cosine(cosine);
        assert!(
            (got - closed).abs() < 3e-4,
            "cos = {cosine}: {got}, not {closed}"
        );
    }
    // By parts: ∫ 2μ² ln(1 + 1/μ) dμ = ⅔ (ln 2 + ∫ μ²/(1 + μ) dμ) = ⅔ (2 ln 2 − ½).
    let lost = 2.0 / 3.0 * (2.0 * 2.0_f64.ln() - 0.5);
    assert!(
        (table.mean() - (1.0 - lost)).abs() < 3e-4,
        "{}",
        table.mean()
    );
}
