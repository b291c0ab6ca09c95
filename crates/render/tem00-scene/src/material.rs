use tem00_config::{ANGLE, Choice, LENGTH, NUMBER, Problem, Section, Value, nearest, rejected};
use tem00_tracer::{
    FinishingProcess, Laser, Material, MediumDescription, Metal, NamedMedium, TracerError,
};

/// The materials of a surface, and the keys that each may have.
pub const MATERIALS: &[Choice] = &[
    ("lambertian", &["reflectance"]),
    ("oren_nayar", &["reflectance", "roughness"]),
    (
        "conductor",
        &["metal", "refractive_index", "finish", "roughness"],
    ),
    ("plastic", &["reflectance", "index", "roughness"]),
    (
        "translucent",
        &[
            "material",
            "transport_length",
            "absorption",
            "refractive_index",
            "anisotropy",
            "roughness",
        ],
    ),
    ("mirror", &["reflectance", "metal", "refractive_index"]),
    ("dielectric", &["index"]),
];

const REFLECTANCE: f64 = 0.8;
const ROUGHNESS: f64 = 0.3;
/// The rms slope of plaster, in radians: 20°.
const SLOPE: f64 = core::f64::consts::PI / 9.0;
/// The index of crown glass, and nearly the index of lacquers and plastics.
const INDEX: f64 = 1.5;
/// The roughness of a satin coat.
const COAT_ROUGHNESS: f64 = 0.1;

/// The wavelength in a scene without lasers, in metres.
const WHITE: f64 = 550e-9;

/// A material, and the rms height in metres that its finish usually has.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Finished {
    pub(crate) material: Material,
    pub(crate) rms_height: Option<f64>,
}

/// Reads the material of a surface, which the lasers must be able to light.
pub(crate) fn read(surface: &Section<'_>, lasers: &[Laser]) -> Result<Finished, Problem> {
    let given = surface.at_most_one_of("material", MATERIALS)?;
    let section = given.as_ref().map_or(surface, |(_, section)| section);
    let kind = given.as_ref().map(|(kind, _)| *kind);
    let material = match kind {
        None => Ok(Material::lambertian(REFLECTANCE)),
        Some("translucent") => translucent(section, lasers),
        Some(kind) => of_kind(kind, section),
    }?
    .map_err(|error| rejected(&error, error.parameter(), &[section]))?;
    for laser in lasers {
        material
            .check_wavelength(laser.wavelength())
            .map_err(|error| section.problem_with("metal", error))?;
    }
    let one_sided = surface.or("one_sided", false, Value::boolean)?;
    let finish = (kind == Some("conductor"))
        .then(|| section.or("finish", None, |value| finish(value).map(Some)))
        .transpose()?;
    Ok(Finished {
        material: if one_sided {
            material.one_sided()
        } else {
            material
        },
        rms_height: finish.flatten().map(|(process, _)| process.rms_height()),
    })
}

/// Reads the material of a section. An error of its constructor is not placed yet.
fn of_kind(kind: &str, section: &Section<'_>) -> Result<Result<Material, TracerError>, Problem> {
    Ok(match kind {
        "lambertian" => Material::lambertian(reflectance(section, REFLECTANCE)?),
        "oren_nayar" => Material::oren_nayar(reflectance(section, REFLECTANCE)?, slope(section)?),
        "conductor" => Material::conductor(metal(section)?, roughness(section, ROUGHNESS)?),
        "plastic" => Material::plastic(
            reflectance(section, REFLECTANCE)?,
            index(section)?,
            roughness(section, COAT_ROUGHNESS)?,
        ),
        "mirror" => mirror(section)?,
        _ => Material::dielectric(index(section)?),
    })
}

/// Reads a body that lets light in, in the light of the lasers.
fn translucent(
    section: &Section<'_>,
    lasers: &[Laser],
) -> Result<Result<Material, TracerError>, Problem> {
    let number = |value: &Value<'_>| value.quantity(&NUMBER).map(Some);
    let names = NamedMedium::named();
    let description = MediumDescription {
        material: section.or("material", None, |value| value.one_of(&names).map(Some))?,
        transport_length: section.or("transport_length", None, |value| {
            value.positive(&LENGTH).map(Some)
        })?,
        absorption: section.or("absorption", None, number)?,
        refractive_index: section.or("refractive_index", None, number)?,
        anisotropy: section.or("anisotropy", 0.0, |value| value.quantity(&NUMBER))?,
    };
    if description.material.is_none() {
        section.required("transport_length", "\"0.5 mm\"")?;
        section.required("absorption", "5")?;
    }
    let roughness = roughness(section, COAT_ROUGHNESS)?;
    let mut wavelengths: Vec<_> = lasers.iter().map(Laser::wavelength).collect();
    if wavelengths.is_empty() {
        wavelengths.push(WHITE);
    }
    let media = wavelengths.into_iter();
    let media = media.map(|wavelength| description.medium(wavelength));
    let media = match media.collect::<Result<Vec<_>, _>>() {
        Ok(media) => media,
        Err(refusal) => return Ok(Err(refusal.into())),
    };
    if media.iter().any(|medium| *medium != media[0]) {
        return Err(section.problem_with(
            "material",
            "`material` differs between the wavelengths of the lasers: render their light one by \
             one",
        ));
    }
    Ok(Material::translucent(media[0], roughness))
}

/// Reads a mirror: perfect, of a given reflectance, or of smooth metal.
fn mirror(section: &Section<'_>) -> Result<Result<Material, TracerError>, Problem> {
    let of_metal = ["metal", "refractive_index"]
        .into_iter()
        .find(|key| section.has(key));
    match (of_metal, section.has("reflectance")) {
        (Some(key), true) => Err(section.problem_with(
            "reflectance",
            format_args!("`reflectance` follows from `{key}`: give one of the two"),
        )),
        (Some(_), false) => Ok(Material::polished(metal(section)?)),
        (None, _) => Ok(Material::mirror(reflectance(section, 1.0)?)),
    }
}

fn reflectance(section: &Section<'_>, default: f64) -> Result<f64, Problem> {
    section.or("reflectance", default, |value| {
        value.within(&NUMBER, 0.0..=1.0, "from 0 to 1")
    })
}

fn roughness(section: &Section<'_>, default: f64) -> Result<f64, Problem> {
    section.or("roughness", default, |value| {
        value.within(&NUMBER, 0.01..=1.0, "from 0.01 to 1")
    })
}

fn slope(section: &Section<'_>) -> Result<f64, Problem> {
    section.or("roughness", SLOPE, |value| {
        let right_angle = core::f64::consts::FRAC_PI_2;
        value.within(&ANGLE, 0.0..=right_angle, "an angle from 0° to 90°")
    })
}

fn index(section: &Section<'_>) -> Result<f64, Problem> {
    section.or("index", INDEX, |value| value.quantity(&NUMBER))
}

fn metal(section: &Section<'_>) -> Result<Metal, Problem> {
    let given = ["metal", "refractive_index", "finish"].into_iter();
    match *given.filter(|key| section.has(key)).collect::<Vec<_>>() {
        [] => section
            .required("metal", "\"aluminium\"")?
            .one_of(Metal::NAMED),
        ["metal"] => section.required("metal", "")?.one_of(Metal::NAMED),
        ["finish"] => Ok(finish(&section.required("finish", "")?)?.1),
        [_] => {
            let index = section.required("refractive_index", "")?;
            let [n, k] = index.elements("two numbers [n, k], such as [1.37, 7.6]")?;
            Ok(Metal::Custom {
                n: n.positive(&NUMBER)?,
                k: k.within(&NUMBER, 0.0.., "zero or positive")?,
            })
        }
        [first, second, ..] => Err(section.problem_with(
            second,
            format_args!("`{second}` takes the place of `{first}`: give one of them"),
        )),
    }
}

/// Reads the name of a finished surface, such as "milled steel".
fn finish(value: &Value<'_>) -> Result<(FinishingProcess, Metal), Problem> {
    let name = value.string()?;
    if let Some(found) = FinishingProcess::of_surface(name) {
        return Ok(found);
    }
    let metals = Metal::NAMED.iter().map(|(name, _)| name.replace('_', " "));
    let metals: Vec<_> = metals.chain(["steel".to_owned()]).collect();
    let known = FinishingProcess::ALL.iter().flat_map(|process| {
        let metals = metals.iter();
        metals.map(move |metal| format!("{} {metal}", process.name))
    });
    let known: Vec<_> = known.collect();
    let known: Vec<_> = known.iter().map(String::as_str).collect();
    let problem = value.must_be("a process and a metal, such as \"milled steel\"");
    Err(problem.with_help(match nearest(name, &known) {
        Some(meant) => format!("did you mean \"{meant}\"?"),
        None => format!(
            "processes: {}; metals: {}",
            FinishingProcess::ALL.map(|process| process.name).join(", "),
            metals.join(", ")
        ),
    }))
}
