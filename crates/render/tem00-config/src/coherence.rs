use core::ops::RangeInclusive;

use tem00_coherence::{LaserLight, PeakShape, Relief, Spectrum, SpectrumForm};

use crate::{ANGLE, LENGTH, NUMBER, Problem, Section, Value};

/// Allowed wavelengths in metres, and in words.
pub type Wavelengths = (RangeInclusive<f64>, &'static str);

const PEAKS: &str =
    "a list of pairs [wavelength, power], such as [[\"448 nm\", 1], [\"451 nm\", 2]]";
const SPECTRA: &[(&str, SpectrumForm)] = &[
    ("gaussian", SpectrumForm::Peak(PeakShape::Gaussian)),
    ("lorentzian", SpectrumForm::Peak(PeakShape::Lorentzian)),
    ("rectangular", SpectrumForm::Peak(PeakShape::Rectangular)),
    // The number of lines has its own key.
    ("comb", SpectrumForm::Comb(0)),
];

/// Reads the keys of the light of a laser, in scene files and in set-up files: `wavelength`,
/// `linewidth`, `spectrum`, `lines` and `source_half_angle`.
///
/// # Errors
///
/// Returns a problem, placed at a key, if one is missing, beyond its range or contradicts another.
/// Whether these values make a [spectrum](LaserLight::spectrum) is left to the caller.
pub fn read_laser_light(
    section: &Section<'_>,
    wavelengths: &Wavelengths,
) -> Result<LaserLight, Problem> {
    let wavelength =
        |value: &Value<'_>| value.within(&LENGTH, wavelengths.0.clone(), wavelengths.1);
    let linewidth = section.or("linewidth", 0.0, |value| {
        value.within(&LENGTH, 0.0.., "zero or positive")
    })?;
    let source_half_angle = section.or("source_half_angle", 0.0, |value| {
        value.within(&ANGLE, 0.0..=0.3, "from 0 to 0.3 rad")
    })?;
    let light = match section.optional("spectrum") {
        Some(list) if list.is_list() => {
            if section.has("wavelength") {
                return Err(follows(section, "wavelength", "spectrum"));
            }
            let peaks = peaks(&list, wavelength)?;
            LaserLight::of_peaks(peaks, linewidth).map_err(|error| list.problem(error))?
        }
        spectrum => LaserLight {
            linewidth,
            form: named_spectrum(section, spectrum.as_ref())?,
            ..LaserLight::monochromatic(wavelength(&section.required("wavelength", "\"650 nm\"")?)?)
        },
    };
    Ok(LaserLight {
        source_half_angle,
        ..light
    })
}

fn follows(section: &Section<'_>, key: &str, from: &str) -> Problem {
    let message = format!("`{key}` follows from `{from}`: give one of the two");
    section.problem_with(key, message)
}

/// Reads a spectrum that has a name.
fn named_spectrum(
    section: &Section<'_>,
    spectrum: Option<&Value<'_>>,
) -> Result<SpectrumForm, Problem> {
    let named = spectrum.map_or(Ok(SpectrumForm::default()), |value| {
        value
            .one_of(SPECTRA)
            .map_err(|problem| match value.string() {
                Ok(_) => problem,
                Err(_) => value.must_be(format_args!(
                    "the name of a spectrum, such as \"gaussian\", or {PEAKS}"
                )),
            })
    })?;
    if let Some(value) = spectrum
        && !section.has("linewidth")
    {
        let help =
            "for example `linewidth = \"2 nm\"`; without both keys all light is of one wavelength";
        return Err(value
            .problem("a `spectrum` needs a `linewidth`")
            .with_help(help));
    }
    match (named, section.optional("lines")) {
        (SpectrumForm::Comb(_), _) => {
            let lines = section.required("lines", "5")?;
            let max = Spectrum::MAX_PEAKS as u64;
            let count = u32::try_from(lines.integer(1..=max)?);
            Ok(SpectrumForm::Comb(count.unwrap_or(u32::MAX)))
        }
        (named, None) => Ok(named),
        (_, Some(lines)) => Err(lines
            .problem("`lines` belongs to the spectrum \"comb\"")
            .with_help("write `spectrum = \"comb\"` as well")),
    }
}

fn peaks(
    list: &Value<'_>,
    wavelength: impl Fn(&Value<'_>) -> Result<f64, Problem>,
) -> Result<Vec<[f64; 2]>, Problem> {
    let peak = |pair: &Value<'_>| {
        let [of_peak, power] = pair.elements("a pair [wavelength, power]")?;
        Ok([wavelength(&of_peak)?, power.positive(&NUMBER)?])
    };
    list.list(PEAKS)?.iter().map(peak).collect()
}

/// Reads the keys of the relief of a surface, in scene files and in set-up files: `rms_height`,
/// with a `usual` value, and `correlation_length`.
///
/// # Errors
///
/// Returns a problem, placed at a key, if one is beyond its range, or a correlation length without
/// a height.
pub fn read_relief(section: &Section<'_>, usual: Option<f64>) -> Result<Relief, Problem> {
    let height = section.or("rms_height", usual, |value| {
        value.positive(&LENGTH).map(Some)
    })?;
    match (height, section.optional("correlation_length")) {
        (None, None) => Ok(Relief::default()),
        (Some(rms_height), length) => Ok(Relief {
            rms_height,
            correlation_length: length.map_or(Ok(0.0), |value| {
                value.within(&LENGTH, 0.0.., "zero or positive")
            })?,
        }),
        (None, Some(length)) => Err(length
            .problem("`correlation_length` belongs to a relief of a known height")
            .with_help("write `rms_height` as well")),
    }
}
