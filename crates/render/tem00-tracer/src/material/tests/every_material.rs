use super::*;

/// The directions that arithmetic finds hard, beside ordinary ones.
fn hard_direction(uniform: &mut impl FnMut() -> f64) -> DVec3 {
    const HEIGHTS: [f64; 8] = [0.0, 5e-324, 1e-300, 1e-161, 1e-30, 1e-16, 1e-8, 1.0];
    let azimuth = TAU * uniform();
    let side = if uniform() < 0.5 { -1.0 } else { 1.0 };
    let kind = uniform() * 16.0;
    let hard = HEIGHTS
        .iter()
        .zip(1_i32..)
        .find(|(_, i)| kind < f64::from(*i));
    let z = hard.map_or_else(&mut *uniform, |(z, _)| *z);
    let exact = direction(z.min(1.0), azimuth);
    // Directions come from transformations and are of unit length to rounding only.
    let rounding = 1.0 + 8.0 * f64::EPSILON * (uniform() - 0.5);
    rounding * exact.with_z(side * z)
}

#[test]
fn no_direction_gives_nan() {
    let mut uniform = uniforms(7);
    let materials = [
        Material::lambertian(1.0).unwrap(),
        plaster(0.0),
        plaster(1.5),
        iron(0.01),
        iron(1.0),
        lacquer(0.01),
        lacquer(1.0),
        casting(0.01),
        casting(1.0),
        Material::mirror(1.0).unwrap(),
        Material::polished(Metal::Custom { n: 1.0, k: 0.0 }).unwrap(),
        Material::dielectric(1.0).unwrap(),
        Material::dielectric(1.5).unwrap(),
        Material::dielectric(1.5).unwrap().one_sided(),
    ];
    for round in 0..1_000_000 / materials.len() {
        let (wo, wi) = (hard_direction(&mut uniform), hard_direction(&mut uniform));
        // Rays that leave the way they came, turned by half a turn, have no half vector but z.
        let wi = if round % 8 == 0 {
            DVec3::new(-wo.x, -wo.y, wo.z)
        } else {
            wi
        };
        for material in &materials {
            let (f, pdf) = (material.evaluate(wo, wi, RED), material.pdf(wo, wi));
            assert!(
                f >= 0.0 && f.is_finite(),
                "{material:?}, {wo}, {wi}: f = {f}"
            );
            assert!(
                pdf >= 0.0 && pdf.is_finite(),
                "{material:?}, {wo}, {wi}: pdf = {pdf}"
            );
            let u = [uniform(), uniform()];
            let Some(s) = material.sample(wo, u, RED) else {
                continue;
            };
            let again = material.reweighted(wo, &s, RED);
            assert!(
                s.weight >= 0.0 && s.weight.is_finite() && s.pdf > 0.0 && s.pdf.is_finite(),
                "{material:?}, wo = {wo}, u = {u:?}: {s:?}"
            );
            assert!(
                (s.wi.length() - 1.0).abs() < 1e-14,
                "{material:?}, wo = {wo}: {s:?}"
            );
            assert!(
                (again - s.weight).abs() <= 1e-6 * s.weight,
                "{material:?}, {wo}: {again}, {s:?}"
            );
        }
    }
}

#[test]
fn one_path_serves_every_wavelength() {
    let blue = 450e-9;
    let mut uniform = uniforms(8);
    for material in [
        Material::conductor(Metal::Gold, 0.3).unwrap(),
        Material::polished(Metal::Copper).unwrap(),
        plaster(0.5),
        lacquer(0.2),
        casting(0.2),
        Material::dielectric(1.5).unwrap(),
    ] {
        for _ in 0..200 {
            let wo = direction(uniform(), TAU * uniform());
            let wo = if uniform() < 0.5 { -wo } else { wo };
            let u = [uniform(), uniform()];
            let (red, other) = (material.sample(wo, u, RED), material.sample(wo, u, blue));
            let (Some(red), Some(other)) = (red, other) else {
                assert_eq!(red, other, "both or none");
                continue;
            };
            assert_eq!(red.wi, other.wi, "directions");
            let got = material.reweighted(wo, &red, blue);
            // The facet recomputed from wo + wi: as in `sample_agrees_with_evaluate_and_pdf`.
            assert!(
                (got / other.weight - 1.0).abs() < 1e-9,
                "{material:?}: {got}, {other:?}"
            );
        }
    }
}

#[test]
fn the_back_of_a_one_sided_material_is_black() {
    for two_sided in [
        Material::lambertian(0.5).unwrap(),
        plaster(0.5),
        iron(0.3),
        lacquer(0.3),
        casting(0.3),
        Material::mirror(1.0).unwrap(),
        Material::polished(Metal::Silver).unwrap(),
        Material::dielectric(1.5).unwrap(),
    ] {
        let material = two_sided.one_sided();
        let (wo, wi) = (direction(0.6, 1.0), direction(0.3, 2.0));
        let front = material.evaluate(wo, wi, RED) - two_sided.evaluate(wo, wi, RED);
        assert!(front.abs() < f64::MIN_POSITIVE, "{two_sided:?}: {front}");
        assert!(
            material.evaluate(-wo, -wi, RED) < f64::MIN_POSITIVE,
            "{two_sided:?}"
        );
        assert!(material.pdf(-wo, -wi) < f64::MIN_POSITIVE, "{two_sided:?}");
        for u in [0.0, 0.3, 0.6, 0.9] {
            assert_eq!(material.sample(-wo, [u, 0.4], RED), None, "{two_sided:?}");
            let drawn = two_sided.sample(wo, [u, 0.4], RED).filter(|s| s.wi.z > 0.0);
            assert_eq!(material.sample(wo, [u, 0.4], RED), drawn, "{two_sided:?}");
        }
    }
}
