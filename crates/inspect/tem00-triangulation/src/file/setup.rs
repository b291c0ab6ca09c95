use std::path::Path;

use tem00_config::{
    ConfigError, Document, FileAccess, Format, LENGTH, Problem, Reading, Section, Value,
    parse_document, read_document, read_laser_light, read_relief,
};

use super::{read_detector, read_uncertainty, sensor::read_sensor_or_auto};
use tem00_translucence::Material;

use crate::{Averages, Setup, SetupDescription, SetupQuantity, TriangulationError};

/// Set-up files.
///
/// The section `[design]` is for searches among set-ups, `[certificate]` for those who sign a
/// budget, and `title` for its readers: they are not read with the set-up.
const SETUP: Format = Format {
    noun: "set-up",
    keys: &[
        "laser",
        "camera",
        "sensor",
        "surface",
        "detector",
        "calibration",
        "environment",
        "average",
        "budget",
        "certificate",
        "correlation",
        "design",
        "include",
        "title",
    ],
    uncertain: SetupQuantity::KEYS,
    help: "examples/setups/ has some, and docs/setup_file.md tells how to write them",
};
const CALIBRATION: &[&str] = &["uncertainty"];
const AVERAGE: &[&str] = &["columns", "frames", "independent_speckle"];

/// Reads a set-up file.
///
/// The format is that of scene files: TOML, with numbers in SI units or strings with a unit.
///
/// # Errors
///
/// Returns an error if the file cannot be read, is not valid TOML, or does not describe a set-up.
/// The error names key, value and what is allowed, and knows its position in the file.
pub fn read_setup(path: &Path) -> Result<Setup, ConfigError> {
    read_setup_with(path, FileAccess::WithinFolder, |_, _| Ok(())).map(|(setup, ())| setup)
}

/// Reads a set-up file, and with `further` its other section, `[design]`. The path `-` is standard
/// input.
///
/// # Errors
///
/// Returns the errors of [`read_setup`], and the errors of `further`, placed in the file.
pub fn read_setup_with<'a, T>(
    path: &Path,
    reading: impl Into<Reading<'a>>,
    further: impl FnOnce(&Document<'_>, &Setup) -> Result<T, Problem>,
) -> Result<(Setup, T), ConfigError> {
    read_document(path, reading, SETUP, |document| {
        with_further(document, further)
    })
}

/// Reads a set-up from text in the format of set-up files.
///
/// # Errors
///
/// Returns an error if the text is not valid TOML or does not describe a set-up.
///
/// # Examples
///
/// ```
/// let setup = tem00_triangulation::parse_setup(
///     r#"
///     [laser]
///     wavelength = "650 nm"
///     power = "5 mW"
///     line_thickness = "0.2 mm"
///     line_length = "50 mm"
///
///     [camera]
///     focal_length = "25 mm"
///     f_number = 8
///     pixel_pitch = "3.45 um"
///     resolution = [640, 480]
///     distance = "300 mm"
///     angle = "30 deg"
///
///     [sensor]
///     quantum_efficiency = 0.6
///     exposure = "1 ms"
///
///     [surface]
///     reflectance = 0.5
///     "#,
/// )?;
/// // One pixel is p / (m sin θ) in height, with the magnification 1/11.
/// let per_pixel = setup.line().height_per_pixel;
/// assert!((per_pixel - 3.45e-6 * 11.0 / 0.5).abs() < 1e-9);
/// # Ok::<(), tem00_config::ConfigError>(())
/// ```
pub fn parse_setup(text: &str) -> Result<Setup, ConfigError> {
    parse_setup_with(text, |_, _| Ok(())).map(|(setup, ())| setup)
}

/// Reads text as [`read_setup_with`] reads a file.
///
/// # Errors
///
/// Returns the errors of [`read_setup_with`].
pub fn parse_setup_with<T>(
    text: &str,
    further: impl FnOnce(&Document<'_>, &Setup) -> Result<T, Problem>,
) -> Result<(Setup, T), ConfigError> {
    parse_document(text, Path::new("."), SETUP, |document| {
        with_further(document, further)
    })
}

fn with_further<T>(
    document: &Document<'_>,
    further: impl FnOnce(&Document<'_>, &Setup) -> Result<T, Problem>,
) -> Result<(Setup, T), Problem> {
    let setup = setup(document)?;
    read_uncertainty(document, &setup)?;
    let further = further(document, &setup)?;
    Ok((setup, further))
}

fn setup(document: &Document<'_>) -> Result<Setup, Problem> {
    let laser = needed(document, "laser", "wavelength = \"650 nm\"")?;
    let camera = needed(document, "camera", "focal_length = \"25 mm\"")?;
    let surface = needed(document, "surface", "reflectance = 0.5")?;
    let environment = optional(document, "environment")?;
    let calibration = document.table("calibration", CALIBRATION)?;
    let average = document.table("average", AVERAGE)?;
    let mut description = SetupDescription {
        detector: read_detector(document)?,
        ..SetupDescription::default()
    };
    let d = &mut description;
    SetupQuantity::read_all(("camera", &camera), d)?;
    let (sensor, auto) = read_sensor_or_auto(document, d.sensor.pixel_pitch)?;
    (d.sensor, d.auto_exposure) = (sensor, auto.is_some());
    d.laser.light = read_laser_light(&laser, &(100e-9..=100e-6, "from 100 nm to 100 µm"))?;
    SetupQuantity::read_all(("laser", &laser), d)?;
    let resolution = camera.required("resolution", "[640, 480]")?;
    let [width, height] = resolution.elements("two numbers of pixels, such as [640, 480]")?;
    d.camera.resolution = [pixels(&width)?, pixels(&height)?];
    d.camera.scheimpflug = camera.or("scheimpflug", false, Value::boolean)?;
    SetupQuantity::read_all(("surface", &surface), d)?;
    d.surface.patterns = surface.or("patterns", 1, |value| count(value, 64))?;
    d.surface.relief = read_relief(&surface, None)?;
    let body = &mut d.surface.subsurface;
    let material = surface.optional("material");
    let named = material.map(|value| value.one_of(&Material::named()));
    body.material = named.transpose()?;
    if body.transport_length != 0.0 && body.material.is_none() {
        surface.required("absorption", "5")?;
    }
    if let Some(section) = &environment {
        SetupQuantity::read_all(("environment", section), d)?;
    }
    if let Some(section) = &calibration {
        d.calibration_uncertainty = section.or("uncertainty", 0.0, |value| {
            value.within(&LENGTH, 0.0..=1.0, "a length from 0 to 1 m")
        })?;
    }
    if let Some(section) = &average {
        d.average = read_average(section)?;
    }
    let optional = [calibration.as_ref(), environment.as_ref(), average.as_ref()];
    let needed = [&laser, &camera, &surface].into_iter();
    let all: Vec<_> = needed.chain(optional.into_iter().flatten()).collect();
    // A user who corrects the first error wants to know of the others.
    let mut wrong = description.violations().into_iter();
    if let Some(first) = wrong.next() {
        let others: Vec<String> = wrong
            .map(|error| rejected(&error, &all).message())
            .collect();
        let problem = rejected(&first, &all);
        return Err(match &*others {
            [] => problem,
            others => problem.with_help(format!("moreover, {}", others.join("; "))),
        });
    }
    Setup::new(description).map_err(|error| rejected(&error, &all))
}

fn optional<'a>(
    document: &Document<'a>,
    key: &'static str,
) -> Result<Option<Section<'a>>, Problem> {
    document.table(key, SetupQuantity::keys_of_section(key))
}

fn needed<'a>(
    document: &Document<'a>,
    key: &'static str,
    example: &str,
) -> Result<Section<'a>, Problem> {
    optional(document, key)?.ok_or_else(|| {
        let help = format!("for example `{example}` below the line `[{key}]`");
        Problem::new(format!("the set-up needs a section [{key}]")).with_help(help)
    })
}

fn pixels(value: &Value<'_>) -> Result<usize, Problem> {
    let pixels = value.integer(1..=1 << 20)?;
    usize::try_from(pixels).map_err(|_| value.must_be("a number of pixels that can be counted"))
}

fn read_average(section: &Section<'_>) -> Result<Averages, Problem> {
    Ok(Averages {
        columns: section.or("columns", 1, |value| count(value, 10_000))?,
        frames: section.or("frames", 1, |value| count(value, 10_000))?,
        independent_speckle: section.or("independent_speckle", false, Value::boolean)?,
    })
}

fn count(value: &Value<'_>, max: u32) -> Result<u32, Problem> {
    let number = value.integer(1..=u64::from(max))?;
    u32::try_from(number).map_err(|_| value.must_be("a number that can be counted"))
}

/// Positions the error of a set-up that is not possible at the key that it concerns.
fn rejected(error: &TriangulationError, sections: &[&Section<'_>]) -> Problem {
    let key = error.parameter().unwrap_or_default();
    let section = sections.iter().find(|section| section.has(key));
    match section {
        Some(section) => section.problem_with(key, error),
        None => Problem::new(error.to_string()),
    }
}
