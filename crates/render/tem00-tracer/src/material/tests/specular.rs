use super::{super::dielectric::refraction, *};

fn glass() -> Material {
    Material::dielectric(1.5).unwrap()
}

/// Both things that can happen to light on glass.
fn outcomes(material: &Material, wo: DVec3) -> Vec<BsdfSample> {
    let first = material.sample(wo, [0.0, 0.5], RED).unwrap();
    let last = material.sample(wo, [1.0 - f64::EPSILON, 0.5], RED).unwrap();
    if first == last {
        vec![first]
    } else {
        vec![first, last]
    }
}

#[test]
fn mirrors_turn_the_direction_over_the_normal() {
    let (silvered, gold) = (
        Material::mirror(0.9).unwrap(),
        Material::polished(Metal::Gold).unwrap(),
    );
    let index = Metal::Gold.refractive_index(RED).unwrap();
    for wo in [direction(0.3, 1.0), -direction(0.8, 2.0)] {
        let fresnel = fresnel_reflectance(wo.z.abs(), index);
        for (material, reflectance) in [(silvered, 0.9), (gold, fresnel)] {
            let s = material.sample(wo, [0.2, 0.7], RED).unwrap();
            // The law of reflection: wo + wi is along the normal, with twice the height.
            let is_mirrored = (wo + s.wi).abs_diff_eq(2.0 * wo.z * DVec3::Z, 1e-15);
            assert!(is_mirrored && s.specular, "{wo}: {s:?}");
            assert_absolute(s.weight, reflectance, 1e-15);
            assert_eq!((s.pdf, s.eta_squared), (1.0, 1.0), "{s:?}");
        }
    }
    let head_on = gold.sample(DVec3::Z, [0.5, 0.5], RED).unwrap().weight;
    assert_absolute(head_on, Metal::Gold.normal_reflectance(RED).unwrap(), 1e-15);
}

#[test]
fn specular_materials_have_no_density() {
    let wo = direction(0.6, 0.0);
    let (mirror, metal) = (Material::mirror(1.0), Material::polished(Metal::Iron));
    for material in [glass(), mirror.unwrap(), metal.unwrap()] {
        assert!(material.is_specular(), "{material:?}");
        for s in outcomes(&material, wo) {
            assert_absolute(material.evaluate(wo, s.wi, RED), 0.0, 0.0);
            assert_absolute(material.pdf(wo, s.wi), 0.0, 0.0);
        }
    }
    for rough in rough_materials(0.01) {
        assert!(!rough.is_specular(), "{rough:?}");
    }
}

#[test]
fn window_glass_reflects_four_per_cent() {
    for wo in [DVec3::Z, -DVec3::Z] {
        let [reflected, refracted] = outcomes(&glass(), wo)[..] else {
            panic!("two things can happen");
        };
        assert_absolute(reflected.pdf, 0.04, 1e-15);
        assert_eq!(reflected.wi, wo, "straight back");
        assert_absolute(refracted.pdf, 0.96, 1e-15);
        assert_eq!(refracted.wi, -wo, "straight through");
    }
}

#[test]
fn only_one_polarisation_is_reflected_at_the_brewster_angle() {
    for n in [1.33_f64, 1.5, 2.4] {
        // tan θ = n: r_p = 0 and r_s = (1 − n²)/(1 + n²).
        let r_s = (1.0 - n * n) / (1.0 + n * n);
        let got = refraction(1.0 / (1.0 + n * n).sqrt(), n).reflectance;
        assert_absolute(got, 0.5 * r_s * r_s, 1e-15);
    }
}

#[test]
fn light_in_glass_is_reflected_totally_beyond_the_critical_angle() {
    let critical = (1.0_f64 - (1.0 / 1.5_f64).powi(2)).sqrt();
    for cosine in [critical - 1e-9, 0.5, 0.01, 1e-300] {
        let wo = direction(cosine, 0.3) * DVec3::new(1.0, 1.0, -1.0);
        let [s] = outcomes(&glass(), wo)[..] else {
            panic!("only reflection can happen at cos θ = {cosine}");
        };
        assert!((s.pdf - 1.0).abs() < f64::EPSILON && s.wi.z < 0.0, "{s:?}");
    }
    let within = direction(critical + 1e-9, 0.3) * DVec3::new(1.0, 1.0, -1.0);
    assert_eq!(outcomes(&glass(), within).len(), 2, "a little light leaves");
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(512))]

    /// Snell's law in vectors: `n wo × z` is the same on both sides, but for its sign.
    #[test]
    fn refraction_keeps_the_tangential_wave_vector(
        index in 1.0_f64..=4.0, cosine in 1e-6_f64..=1.0, azimuth in 0.0_f64..6.3,
        below in any::<bool>(),
    ) {
        let wo = direction(cosine, azimuth) * if below { -1.0 } else { 1.0 };
        let material = Material::dielectric(index).unwrap();
        let (n_o, n_i) = if below { (index, 1.0) } else { (1.0, index) };
        for s in outcomes(&material, wo) {
            let beyond = if s.wi.z * wo.z < 0.0 { n_i } else { n_o };
            let kept = n_o * wo.cross(DVec3::Z) + beyond * s.wi.cross(DVec3::Z);
            prop_assert!(kept.length() < 1e-14, "{s:?}: {kept}");
            prop_assert!((s.wi.length() - 1.0).abs() < 1e-14, "|wi| = {}", s.wi.length());
        }
    }

    /// The powers of both outcomes sum to 1, and so do radiances in a furnace, where radiance in
    /// glass is n² times that outside.
    #[test]
    fn glass_loses_nothing(
        index in 1.0_f64..=4.0, cosine in 1e-6_f64..=1.0, below in any::<bool>(),
    ) {
        let wo = direction(cosine, 0.0) * if below { -1.0 } else { 1.0 };
        let material = Material::dielectric(index).unwrap();
        let furnace = |w: DVec3| if w.z < 0.0 { index * index } else { 1.0 };
        let (mut power, mut radiance) = (0.0, 0.0);
        for s in outcomes(&material, wo) {
            power += s.pdf * s.weight * s.eta_squared;
            radiance += s.pdf * s.weight * furnace(s.wi);
        }
        prop_assert!((power - 1.0).abs() < 4e-15, "power {power}");
        prop_assert!((radiance / furnace(wo) - 1.0).abs() < 4e-15, "radiance {radiance}");
    }

    /// Light that is sent back the way it came meets the same reflectance, and its transmission
    /// obeys `f(wo, wi) / n_o² = f(wi, wo) / n_i²`.
    #[test]
    fn light_may_travel_backwards_through_glass(
        index in 1.0_f64..=4.0, cosine in 1e-3_f64..=1.0, azimuth in 0.0_f64..6.3,
    ) {
        let wo = direction(cosine, azimuth);
        let material = Material::dielectric(index).unwrap();
        let last = [1.0 - f64::EPSILON, 0.5];
        let there = material.sample(wo, last, RED).unwrap();
        let back = material.sample(there.wi, last, RED).unwrap();
        prop_assert!(back.wi.abs_diff_eq(wo, 1e-9), "{wo} came back as {}", back.wi);
        // What is carried per projected solid angle; n² dω |cos θ| is the same on both sides.
        let (f_there, f_back) = (there.pdf * there.weight, back.pdf * back.weight / index.powi(4));
        prop_assert!((f_there / f_back - 1.0).abs() < 1e-9, "{there:?}, {back:?}");
    }

    /// The formulae for metals, with another square root, at k = 0.
    #[test]
    fn glass_reflects_like_a_metal_that_absorbs_nothing(
        index in 1.01_f64..=4.0, cosine in 0.0_f64..=1.0,
    ) {
        let got = refraction(cosine, index).reflectance;
        let want = fresnel_reflectance(cosine, (index, 0.0));
        prop_assert!((got - want).abs() < 1e-12, "{got}, not {want}");
    }
}

#[test]
fn glass_reflects_as_often_as_it_should() {
    let wo = direction(0.2, 0.0);
    let reflectance = refraction(0.2, 1.5).reflectance;
    for (u, reflects) in [
        (0.0, true),
        (reflectance - 1e-9, true),
        (reflectance + 1e-9, false),
    ] {
        let s = glass().sample(wo, [u, 0.5], RED).unwrap();
        assert_eq!(s.wi.z > 0.0, reflects, "u = {u}: {s:?}");
    }
}

#[test]
fn glass_of_index_one_is_not_there() {
    let air = Material::dielectric(1.0).unwrap();
    for cosine in [1e-6, 0.3, 1.0] {
        let wo = direction(cosine, 1.0);
        let s = air.sample(wo, [1e-300, 0.5], RED).unwrap();
        assert!(s.wi.abs_diff_eq(-wo, 1e-15), "{wo}: {s:?}");
        assert_absolute(s.weight, 1.0, 1e-15);
        assert_absolute(s.pdf, 1.0, 1e-15);
    }
}
