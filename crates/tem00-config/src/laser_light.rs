use core::ops::RangeInclusive;

use tem00_coherence::{LaserLight, LineShape, SpectralLine, Spectrum};

use crate::{LENGTH, NUMBER, Problem, Section, Value};

/// Keys of the light of a laser, in scene files and in set-up files: those that [`read_laser_light`] reads.
pub const LASER_LIGHT: &[&str] = &["wavelength", "linewidth", "spectrum", "lines"];

const WAVELENGTHS: RangeInclusive<f64> = 10e-9..=1e-3;
const WAVELENGTH: &str = "from 10 nm to 1 mm";
const PEAKS: &str =
    "a list of pairs [wavelength, power], such as [[\"448 nm\", 1], [\"451 nm\", 2]]";
const SPECTRA: &[(&str, Spectrum)] = &[
    ("gaussian", Spectrum::Peak(LineShape::Gaussian)),
    ("lorentzian", Spectrum::Peak(LineShape::Lorentzian)),
    ("rectangular", Spectrum::Peak(LineShape::Rectangular)),
    // The number of lines is a key of its own.
    ("comb", Spectrum::Comb(0)),
];

/// Reads wavelength, linewidth and spectrum of a laser.
///
/// # Errors
///
/// Returns a problem, placed at a key, if one is missing, beyond its range or contradicts another. Whether the light
/// [has a line](LaserLight::line) is left to the caller.
pub fn read_laser_light(section: &Section<'_>) -> Result<LaserLight, Problem> {
    let linewidth = section.or("linewidth", 0.0, |value| {
        value.within(&LENGTH, 0.0.., "zero or positive")
    })?;
    match section.optional("spectrum") {
        Some(list) if list.is_list() => {
            if section.has("wavelength") {
                return Err(follows(section, "wavelength", "spectrum"));
            }
            let peaks = peaks(&list)?;
            LaserLight::of_peaks(peaks, linewidth).map_err(|error| list.problem(error))
        }
        spectrum => Ok(LaserLight {
            wavelength: section.required("wavelength", "\"650 nm\"")?.within(
                &LENGTH,
                WAVELENGTHS,
                WAVELENGTH,
            )?,
            linewidth,
            spectrum: named_spectrum(section, spectrum.as_ref())?,
        }),
    }
}

fn follows(section: &Section<'_>, key: &str, from: &str) -> Problem {
    let message = format!("`{key}` follows from `{from}`: give one of the two");
    section.problem_with(key, message)
}

/// Reads a spectrum that has a name.
fn named_spectrum(
    section: &Section<'_>,
    spectrum: Option<&Value<'_>>,
) -> Result<Spectrum, Problem> {
    let named = spectrum.map_or(Ok(Spectrum::default()), |value| {
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
        (Spectrum::Comb(_), _) => {
            let lines = section.required("lines", "5")?;
            let most = SpectralLine::MAX_PEAKS as u64;
            let count = u32::try_from(lines.integer(1..=most)?);
            Ok(Spectrum::Comb(count.unwrap_or(u32::MAX)))
        }
        (named, None) => Ok(named),
        (_, Some(lines)) => Err(lines
            .problem("`lines` belongs to the spectrum \"comb\"")
            .with_help("write `spectrum = \"comb\"` as well")),
    }
}

fn peaks(list: &Value<'_>) -> Result<Vec<[f64; 2]>, Problem> {
    let peak = |pair: &Value<'_>| {
        let [wavelength, power] = pair.elements("a pair [wavelength, power]")?;
        Ok([
            wavelength.within(&LENGTH, WAVELENGTHS, WAVELENGTH)?,
            power.positive(&NUMBER)?,
        ])
    };
    list.list(PEAKS)?.iter().map(peak).collect()
}
