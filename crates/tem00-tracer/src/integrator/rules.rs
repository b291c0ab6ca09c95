use crate::{Formulas, Lamp, LampEvents, Laser, Method, RenderOptions};

/// The wavelength at which materials are evaluated for lamps, in metres: lamps are white and
/// materials grey under them.
pub(super) const LAMP_WAVELENGTH: f64 = 550e-9;

/// Rules for the paths that are followed and for the ways in which they find light.
#[derive(Clone, Copy, Debug)]
pub(crate) struct PathRules {
    pub formulas: Formulas,
    /// The maximum number of surfaces between source and camera.
    pub max_depth: u32,
    /// True if the lasers' light is found from the camera at all.
    pub finds_lasers: bool,
    /// True if directions towards lasers are drawn, and rays meet their beams by chance.
    pub samples_beams: bool,
    pub lamp_events: LampEvents,
}

impl From<&RenderOptions> for PathRules {
    fn from(options: &RenderOptions) -> Self {
        Self {
            formulas: options.formulas,
            max_depth: options.max_depth.unwrap_or(u32::MAX),
            finds_lasers: options.method == Method::Path,
            samples_beams: options.samples_beams(),
            lamp_events: options.lamp_events,
        }
    }
}

/// The distinct wavelengths of all light, in metres.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Spectrum {
    pub wavelengths: Vec<f64>,
    /// For each laser, which of them is its own.
    pub of_laser: Vec<usize>,
    /// The index of the one for the lamps; 0 if there are none.
    pub of_lamps: usize,
}

impl Spectrum {
    pub(super) fn of(lasers: &[Laser], lamps: &[Lamp]) -> Self {
        let mut wavelengths = Vec::new();
        let of_laser = lasers
            .iter()
            .map(|laser| index_of(&mut wavelengths, laser.wavelength()))
            .collect();
        let of_lamps = if lamps.is_empty() {
            0
        } else {
            index_of(&mut wavelengths, LAMP_WAVELENGTH)
        };
        Self {
            wavelengths,
            of_laser,
            of_lamps,
        }
    }
}

/// Returns the index of a wavelength in the list, to which it is added if it is not there.
fn index_of(wavelengths: &mut Vec<f64>, wavelength: f64) -> usize {
    let bits = wavelength.to_bits();
    let found = wavelengths.iter().position(|other| other.to_bits() == bits);
    found.unwrap_or_else(|| {
        wavelengths.push(wavelength);
        wavelengths.len() - 1
    })
}
