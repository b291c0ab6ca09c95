use super::*;

/// The directions that arithmetic finds hard, beside ordinary ones.
fn hard_direction(numbers: &mut Numbers) -> DVec3 {
    const HEIGHTS: [f64; 8] = [0.0, 5e-324, 1e-300, 1e-161, 1e-30, 1e-16, 1e-8, 1.0];
    let azimuth = TAU * numbers.unit();
    let side = if numbers.unit() < 0.5 { -1.0 } else { 1.0 };
    let kind = numbers.unit() * 16.0;
    let hard = HEIGHTS
        .iter()
        .zip(1_i32..)
        .find(|(_, i)| kind < f64::from(*i));
    let z = hard.map_or_else(|| numbers.unit(), |(z, _)| *z);
    let exact = direction(z.min(1.0), azimuth);
    // Directions come from transformations and are of unit length to rounding only.
    let rounding = 1.0 + 8.0 * f64::EPSILON * (numbers.unit() - 0.5);
    rounding * exact.with_z(side * z)
}

#[test]
fn no_direction_gives_nan() {
    let mut numbers = Numbers::new(7);
    let materials = [
        Material::lambertian(1.0).unwrap(),
        plaster(0.0),
        plaster(1.5),
        iron(0.01),
        iron(1.0),
        lacquer(0.01),
        lacquer(1.0),
        Material::mirror(1.0).unwrap(),
        Material::polished(Metal::Custom { n: 1.0, k: 0.0 }).unwrap(),
        jade(0.01),
        jade(0.7),
        Material::dielectric(1.0).unwrap(),
        Material::dielectric(1.5).unwrap(),
        Material::dielectric(1.5).unwrap().one_sided(),
    ];
    for round in 0..1_000_000 / materials.len() {
        let (wo, wi) = (hard_direction(&mut numbers), hard_direction(&mut numbers));
        // Rays that leave the way they came, turned by half a turn, have no half vector but z.
        let wi = if round % 8 == 0 {
            DVec3::new(-wo.x, -wo.y, wo.z)
        } else {
            wi
        };
        let is_proper = |x: f64| x >= 0.0 && x.is_finite();
        for material in &materials {
            let (f, pdf) = (material.evaluate(wo, wi, RED), material.pdf(wo, wi));
            assert!(
                is_proper(f) && is_proper(pdf),
                "{material:?}, {wo}, {wi}: {f}, {pdf}"
            );
            let entry = material.entry([wo, wi], 0.0, round as u64, |_| 1.0);
            let is_place =
                |(offset, radiance): (DVec3, f64)| offset.is_finite() && is_proper(radiance);
            assert!(
                entry.is_none_or(is_place),
                "{material:?}, {wo}, {wi}: {entry:?}"
            );
            let u = numbers.units();
            let Some(s) = material.sample(wo, u, RED) else {
                continue;
            };
            let is_sample = is_proper(s.weight) && is_proper(s.pdf) && s.pdf > 0.0;
            let is_unit = (s.wi.length() - 1.0).abs() < 1e-14;
            assert!(
                is_sample && is_unit,
                "{material:?}, wo = {wo}, u = {u:?}: {s:?}"
            );
            assert_relative(material.reweighted(wo, &s, RED), s.weight, 1e-6);
        }
    }
}

#[test]
fn one_path_serves_every_wavelength() {
    let blue = 450e-9;
    let mut numbers = Numbers::new(8);
    for material in [
        Material::conductor(Metal::Gold, 0.3).unwrap(),
        Material::polished(Metal::Copper).unwrap(),
        plaster(0.5),
        lacquer(0.2),
        Material::dielectric(1.5).unwrap(),
    ] {
        for _ in 0..200 {
            let wo = direction(numbers.unit(), TAU * numbers.unit());
            let wo = if numbers.unit() < 0.5 { -wo } else { wo };
            let u = numbers.units();
            let (red, other) = (material.sample(wo, u, RED), material.sample(wo, u, blue));
            let (Some(red), Some(other)) = (red, other) else {
                assert_eq!(red, other, "both or none");
                continue;
            };
            assert_eq!(red.wi, other.wi, "directions");
            // The facet recomputed from wo + wi: as in `sample_agrees_with_evaluate_and_pdf`.
            assert_relative(material.reweighted(wo, &red, blue), other.weight, 1e-9);
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
        Material::mirror(1.0).unwrap(),
        Material::polished(Metal::Silver).unwrap(),
        Material::dielectric(1.5).unwrap(),
    ] {
        let material = two_sided.one_sided();
        let (wo, wi) = (direction(0.6, 1.0), direction(0.3, 2.0));
        let front = material.evaluate(wo, wi, RED);
        assert_absolute(front, two_sided.evaluate(wo, wi, RED), 0.0);
        assert_absolute(material.evaluate(-wo, -wi, RED), 0.0, 0.0);
        assert_absolute(material.pdf(-wo, -wi), 0.0, 0.0);
        for u in [0.0, 0.3, 0.6, 0.9] {
            assert_eq!(material.sample(-wo, [u, 0.4], RED), None, "{two_sided:?}");
            let drawn = two_sided.sample(wo, [u, 0.4], RED).filter(|s| s.wi.z > 0.0);
            assert_eq!(material.sample(wo, [u, 0.4], RED), drawn, "{two_sided:?}");
        }
    }
}
