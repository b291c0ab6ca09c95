mod diffuse;
mod draws;
mod every_material;
mod plastic;
mod specular;

use core::f64::consts::{PI, TAU};
use std::sync::LazyLock;

use proptest::prelude::*;
use tem00_testkit::{Numbers, assert_absolute, assert_relative, refuses};

use super::{ggx::Ggx, *};

const RED: f64 = 650e-9;

fn iron(roughness: f64) -> Material {
    Material::conductor(Metal::Iron, roughness).unwrap()
}

/// A metal that reflects everything but 4n/(k² + 1) = 4e−12 of the light.
fn perfect(roughness: f64) -> Material {
    Material::conductor(Metal::Custom { n: 1e-6, k: 1e3 }, roughness).unwrap()
}

fn plaster(sigma: f64) -> Material {
    Material::oren_nayar(0.7, sigma).unwrap()
}

fn lacquer(roughness: f64) -> Material {
    Material::plastic(0.6, 1.5, roughness).unwrap()
}

fn jade(roughness: f64) -> Material {
    let medium = Medium::new(1.6, 2e3, 100.0).unwrap();
    Material::translucent(medium, roughness).unwrap()
}

fn direction(cosine: f64, azimuth: f64) -> DVec3 {
    let radius = ((1.0 - cosine) * (1.0 + cosine)).sqrt();
    DVec3::new(radius * azimuth.cos(), radius * azimuth.sin(), cosine)
}

/// ∫ f dω over the upper hemisphere, by the midpoint rule in u = (θ/(π/2))^(1/2) and azimuth.
///
/// The substitution puts points where lobes around the normal are narrow.
fn integrate(f: impl Fn(DVec3) -> f64, rings: u32, sectors: u32) -> f64 {
    let mut sum = 0.0;
    for i in 0..rings {
        let u = (f64::from(i) + 0.5) / f64::from(rings);
        let theta = 0.5 * PI * u * u;
        let weight = theta.sin() * PI * u;
        for j in 0..sectors {
            let azimuth = TAU * (f64::from(j) + 0.5) / f64::from(sectors);
            sum += weight * f(direction(theta.cos(), azimuth));
        }
    }
    sum * TAU / (f64::from(rings) * f64::from(sectors))
}

/// The fraction of the light that a material reflects, by the midpoint rule.
fn albedo(material: &Material, wo: DVec3, [rings, sectors]: [u32; 2]) -> f64 {
    integrate(|wi| material.evaluate(wo, wi, RED) * wi.z, rings, sectors)
}

/// Albedo of the facets of a coat or metal: ∫ f cos θi dωi over facets, dωi = 4 (wo·h) dh.
///
/// Facets resolve lobes of any width and angle.
fn albedo_of_facets(material: &Material, wo: DVec3) -> f64 {
    integrate(
        |facet| {
            let cosine = wo.dot(facet);
            let wi = 2.0 * cosine * facet - wo;
            if cosine <= 0.0 || wi.z <= 0.0 {
                return 0.0;
            }
            4.0 * cosine * wi.z * material.evaluate(wo, wi, RED)
        },
        500,
        200,
    )
}

#[test]
fn lambertian_reflects_its_reflectance() {
    let material = Material::lambertian(0.37).unwrap();
    let wo = direction(0.3, 1.0);
    // The midpoint rule errs by h²/24 times the change of the derivative, (1/200)² · π/24 · 4.
    assert_absolute(albedo(&material, wo, [200, 4]), 0.37, 1e-5);
}

#[test]
fn nothing_reflects_more_than_it_receives() {
    for roughness in [0.1, 0.3, 0.6, 1.0] {
        for cosine in [0.05, 0.3, 0.7, 1.0] {
            let wo = direction(cosine, 0.4);
            let albedo = albedo(&perfect(roughness), wo, [400, 400]);
            // The quadrature of lobes as narrow as α = 0.1 is good to 1e−4 on this grid.
            assert!(
                albedo < 1.0 + 1e-4,
                "α = {roughness}, cos = {cosine}: {albedo}"
            );
        }
    }
}

#[test]
fn the_roughest_perfect_metal_is_a_lommel_seeliger_surface() {
    // With α = 1 facets point everywhere alike, D = 1/π and r = 1:
    // f = 1 / (2π (o + i)), whose albedo is 1 − o ln(1 + 1/o).
    let material = perfect(1.0);
    for cosine in [0.1, 0.3, 0.7, 1.0] {
        let wo = direction(cosine, 0.4);
        let wi = direction(0.6, 2.5);
        let closed = 1.0 / (TAU * (cosine + 0.6));
        assert_relative(material.evaluate(wo, wi, RED), closed, 1e-11);
        let closed = 1.0 - cosine * (1.0 / cosine).ln_1p();
        // The midpoint rule on 400 rings: (1/400)² / 24 · f'' with f'' up to some 30.
        assert_absolute(albedo(&material, wo, [2000, 4]), closed, 1e-5);
    }
}

#[test]
fn a_nearly_smooth_perfect_metal_reflects_nearly_everything() {
    let albedo = albedo(&perfect(0.1), direction(1.0, 0.0), [400, 4]);
    // At normal incidence G₂ ≥ 1 / (1 + α² tan²θ / 4): facets at 10 α lose 20 % and are 1 %.
    assert!((0.98..1.0 + 1e-4).contains(&albedo), "albedo = {albedo}");
}

/// Masking alone loses nothing (Heitz 2014, the weak white furnace): drawn from all visible
/// facets, directions above and below the surface have a total density of 1.
#[test]
fn pdf_is_normalised_over_all_that_visible_facets_reflect() {
    for (roughness, cosine) in [(0.1, 0.9), (0.3, 0.2), (0.6, 0.5), (1.0, 0.1), (1.0, 1.0)] {
        let wo = direction(cosine, 0.0);
        let material = iron(roughness);
        let facets = Ggx { alpha: roughness };
        let above = integrate(|wi| material.pdf(wo, wi), 500, 500);
        // The other directions, integrated over the facets: dω = 4 (wo·h) dh.
        let below = integrate(
            |facet| {
                let cosine = wo.dot(facet);
                let wi = 2.0 * cosine * facet - wo;
                if cosine <= 0.0 || wi.z > 0.0 {
                    return 0.0;
                }
                4.0 * cosine * facets.reflected_pdf(wo, facet)
            },
            500,
            500,
        );
        // The second integrand ends at a jump, which costs up to one cell in 500.
        assert_absolute(above + below, 1.0, 2e-3);
    }
    for material in [Material::lambertian(0.5).unwrap(), plaster(0.8)] {
        for cosine in [0.05, 1.0] {
            let total = integrate(|wi| material.pdf(direction(cosine, 0.3), wi), 400, 4);
            assert_absolute(total, 1.0, 1e-4);
        }
    }
}

/// A lacquer of about this roughness: tabulating it takes too long for every case.
fn tabulated(roughness: f64) -> Material {
    static TABULATED: LazyLock<[Material; 4]> =
        LazyLock::new(|| [0.01, 0.05, 0.3, 1.0].map(lacquer));
    let [glossy, satin, matt, rough] = *TABULATED;
    match roughness {
        ..0.02 => glossy,
        ..0.1 => satin,
        ..0.5 => matt,
        _ => rough,
    }
}

fn rough_materials(roughness: f64) -> [Material; 4] {
    let paper = Material::lambertian(0.5).unwrap();
    [
        iron(roughness),
        paper,
        plaster(1.5 * roughness),
        tabulated(roughness),
    ]
}

proptest! {
    #[test]
    fn light_may_travel_backwards(
        roughness in 0.01_f64..=1.0,
        (cos_o, cos_i) in (0.001_f64..=1.0, 0.001_f64..=1.0),
        (azimuth_o, azimuth_i) in (0.0_f64..6.3, 0.0_f64..6.3),
        below in any::<bool>(),
    ) {
        let side = if below { -1.0 } else { 1.0 };
        let wo = side * direction(cos_o, azimuth_o);
        let wi = side * direction(cos_i, azimuth_i);
        for material in rough_materials(roughness) {
            let (there, back) = (material.evaluate(wo, wi, RED), material.evaluate(wi, wo, RED));
            // The half vector is the same to the bit; cosines with it differ in rounding.
            prop_assert!((there - back).abs() <= 1e-13 * there, "{there} and {back}");
            prop_assert!(there > 0.0 && there.is_finite(), "f = {there}");
        }
    }

    #[test]
    fn sample_agrees_with_evaluate_and_pdf(
        roughness in 0.01_f64..=1.0,
        cosine in 0.001_f64..=1.0,
        azimuth in 0.0_f64..6.3,
        u in 0.0_f64..1.0,
        v in 0.0_f64..1.0,
        below in any::<bool>(),
    ) {
        let wo = direction(cosine, azimuth) * if below { -1.0 } else { 1.0 };
        for material in rough_materials(roughness) {
            let Some(sample) = material.sample(wo, [u, v], RED) else { continue };
            let BsdfSample { wi, weight, pdf, specular, eta_squared } = sample;
            prop_assert!((wi.length() - 1.0).abs() < 1e-13, "|wi| = {}", wi.length());
            prop_assert!(wi.z * wo.z > 0.0, "wi = {wi}");
            // Metals and Lambertian surfaces draw so well that no weight exceeds the reflectance.
            // The others draw from two lobes: plaster's weights stay below 4, and a coat's below
            // the sum of both lobes' own, 1 each.
            let largest = match material.scattering {
                Scattering::OrenNayar(_) => 4.0,
                Scattering::Plastic(_) => 2.0,
                _ => 1.0,
            };
            prop_assert!(weight > 0.0 && weight <= largest, "weight = {weight}");
            prop_assert!(!specular && (eta_squared - 1.0).abs() < f64::EPSILON, "{sample:?}");
            // The facet recomputed from wo + wi is off by 1e−16 / (wo·h), and the density
            // changes by 1/α of that relatively: 1e−14 / α·(wo·h), with both at 1e−3 … 1e−2.
            let tolerance = 1e-9;
            let want = material.evaluate(wo, wi, RED) * wi.z.abs() / pdf;
            prop_assert!((weight / want - 1.0).abs() < tolerance, "{weight}, not {want}");
            let again = material.pdf(wo, wi);
            prop_assert!((pdf / again - 1.0).abs() < tolerance, "pdf {pdf}, not {again}");
        }
    }
}

#[test]
fn mirror_direction_is_brightest_for_smooth_metal() {
    let material = iron(0.01);
    let wo = direction(0.8, 0.3);
    let mirror = DVec3::new(-wo.x, -wo.y, wo.z);
    // D(0) = 1/(π α²), V = 1/(4 cos²θ) except for α², and the facet sees the light at cos θ.
    let reflectance = fresnel_reflectance(0.8, Metal::Iron.refractive_index(RED).unwrap());
    let peak = reflectance / (PI * 1e-4) / (4.0 * 0.64);
    // Masking at α² tan²θ / 4 = 1.4e−5 for each direction is left out above.
    assert_relative(material.evaluate(wo, mirror, RED), peak, 4e-5);
}

#[test]
fn no_light_passes_through_or_along_the_surface() {
    let along = DVec3::X;
    for material in rough_materials(0.3) {
        for (wo, wi) in [(DVec3::Z, -DVec3::Z), (along, DVec3::Z), (DVec3::Z, along)] {
            assert_absolute(material.evaluate(wo, wi, RED), 0.0, 0.0);
            assert_absolute(material.pdf(wo, wi), 0.0, 0.0);
        }
        assert_eq!(
            material.sample(along, [0.5, 0.5], RED),
            None,
            "{material:?}"
        );
    }
}

#[test]
fn extreme_uniforms_give_proper_directions() {
    let largest = 1.0 - f64::EPSILON / 2.0;
    let glass = Material::dielectric(1.5).unwrap();
    for material in [rough_materials(0.01), rough_materials(1.0), [glass; 4]].as_flattened() {
        for wo in [DVec3::Z, direction(1e-9, 0.0), -direction(1e-9, 2.0)] {
            for u in [0.0, largest] {
                let samples = [0.0, 0.25, largest].map(|v| material.sample(wo, [u, v], RED));
                for s in samples.into_iter().flatten() {
                    let is_proper = s.wi.is_finite() && s.weight.is_finite() && s.pdf > 0.0;
                    assert!(is_proper, "{material:?}, wo = {wo}, u = {u}: {s:?}");
                }
            }
        }
    }
}

#[test]
fn impossible_materials_are_refused() {
    refuses!(reflectance = 0.5 => Material::lambertian(reflectance);
        reflectance: [-0.1, 1.1, f64::NAN]);
    refuses!(roughness = 0.3, metal = Metal::Gold => Material::conductor(metal, roughness);
        roughness: [0.0, 0.0099, 1.01, f64::NAN],
        metal as "n": [Metal::Custom { n: -1.0, k: 1.0 }]);
    refuses!(metal = Metal::Gold => Material::polished(metal);
        metal as "k": [Metal::Custom { n: 1.0, k: -1.0 }]);
    refuses!(reflectance = 0.5 => Material::mirror(reflectance); reflectance: [1.01]);
    refuses!(reflectance = 0.5, sigma = 0.3 => Material::oren_nayar(reflectance, sigma);
        reflectance: [1.01], sigma: [1.6, f64::NAN]);
    refuses!(reflectance = 0.5, index = 1.5, roughness = 0.1
        => Material::plastic(reflectance, index, roughness);
        reflectance: [-0.1], index: [1.0], roughness: [0.001]);
    refuses!(index = 1.5 => Material::dielectric(index);
        index: [0.99, 4.1, f64::INFINITY, f64::NAN]);
}

#[test]
fn metals_say_which_wavelengths_they_know() {
    refuses!(wavelength = RED => iron(0.3).check_wavelength(wavelength); wavelength: [10.6e-6]);
    let anything = Material::lambertian(0.5).unwrap();
    assert!(anything.check_wavelength(10.6e-6).is_ok(), "grey is grey");
}
