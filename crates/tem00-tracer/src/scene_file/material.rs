use super::error::Problem;
use super::placement::rejected;
use super::quantity::NUMBER;
use super::section::{Choice, Section};
use crate::{Laser, Material, Metal};

pub(super) const MATERIALS: &[Choice] = &[
    ("lambertian", &["reflectance"]),
    ("conductor", &["metal", "refractive_index", "roughness"]),
];

/// The names of the metals, as files have them.
pub(super) const METALS: &[(&str, Metal)] = &[
    ("aluminium", Metal::Aluminium),
    ("silver", Metal::Silver),
    ("gold", Metal::Gold),
    ("copper", Metal::Copper),
    ("iron", Metal::Iron),
    ("chromium", Metal::Chromium),
    ("nickel", Metal::Nickel),
    ("titanium", Metal::Titanium),
    ("tungsten", Metal::Tungsten),
    ("platinum", Metal::Platinum),
    ("brass", Metal::Brass),
    ("stainless_steel", Metal::StainlessSteel),
];

const REFLECTANCE: f64 = 0.8;
const ROUGHNESS: f64 = 0.3;

/// Reads the material of a surface, which the lasers must be able to light.
pub(super) fn read(surface: &Section<'_>, lasers: &[Laser]) -> Result<Material, Problem> {
    match surface.at_most_one_of("material", MATERIALS)? {
        None => Material::lambertian(REFLECTANCE).map_err(|error| rejected(&error, &[surface])),
        Some(("lambertian", section)) => lambertian(&section),
        Some((_, section)) => conductor(&section, lasers),
    }
}

fn lambertian(section: &Section<'_>) -> Result<Material, Problem> {
    let reflectance = section.or("reflectance", REFLECTANCE, |value| {
        value.within(&NUMBER, 0.0..=1.0, "from 0 to 1")
    })?;
    Material::lambertian(reflectance).map_err(|error| rejected(&error, &[section]))
}

fn conductor(section: &Section<'_>, lasers: &[Laser]) -> Result<Material, Problem> {
    let metal = metal(section)?;
    let roughness = section.or("roughness", ROUGHNESS, |value| {
        value.within(&NUMBER, 0.01..=1.0, "from 0.01 to 1")
    })?;
    let material =
        Material::conductor(metal, roughness).map_err(|error| rejected(&error, &[section]))?;
    for laser in lasers {
        material
            .check_wavelength(laser.wavelength())
            .map_err(|error| section.problem_with("metal", error))?;
    }
    Ok(material)
}

fn metal(section: &Section<'_>) -> Result<Metal, Problem> {
    match (
        section.optional("metal"),
        section.optional("refractive_index"),
    ) {
        (Some(name), None) => name.one_of(METALS),
        (None, Some(index)) => {
            let [n, k] = index.elements("two numbers [n, k], such as [1.37, 7.6]")?;
            Ok(Metal::Custom {
                n: n.positive(&NUMBER)?,
                k: k.within(&NUMBER, 0.0.., "zero or positive")?,
            })
        }
        (None, None) => section.required("metal", "\"aluminium\"")?.one_of(METALS),
        (Some(_), Some(_)) => Err(section.problem_with(
            "refractive_index",
            "`refractive_index` takes the place of `metal`: give one of them",
        )),
    }
}
