use tem00_geometry::Shape;
use tem00_tracer::{
    Laser, Light, LightEvents, Method, RenderOptions, Scene, Surface, WHITE_LIGHT_WAVELENGTH,
};

/// Rules for the paths that are followed and for the methods by which they find light.
#[derive(Clone, Copy, Debug)]
pub(crate) struct PathRules {
    /// The maximum number of surfaces between source and camera.
    pub max_depth: u32,
    /// True if the lasers' light is found from the camera at all.
    pub finds_lasers: bool,
    /// True if directions towards lasers are drawn, and rays meet their beams by chance.
    pub samples_beams: bool,
    pub light_events: LightEvents,
    /// True if speckle is looked up for samples without light of a laser, too.
    pub speckle_in_the_dark: bool,
}

impl PathRules {
    /// Returns whether light of lasers over two rough surfaces is found from the first of them,
    /// too.
    pub(super) fn connects_to_lit_points(&self) -> bool {
        self.finds_lasers && !self.samples_beams && self.max_depth > 1
    }
}

impl From<&RenderOptions> for PathRules {
    fn from(options: &RenderOptions) -> Self {
        Self {
            max_depth: options.max_depth.unwrap_or(u32::MAX),
            finds_lasers: options.method == Method::Path,
            samples_beams: options.samples_beams(),
            light_events: options.light_events,
            speckle_in_the_dark: options.speckle_in_the_dark,
        }
    }
}

/// Returns whether a plate is the only surface that light can meet, so that light meets it once.
pub(crate) fn is_plate(scene: &Scene) -> bool {
    matches!(
        scene.surfaces.as_slice(),
        [] | [Surface {
            shape: Shape::Rectangle(_),
            ..
        }]
    )
}

/// The distinct wavelengths of all light, in metres.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Bands {
    pub wavelengths: Vec<f64>,
    /// For each laser, the index of its wavelength.
    pub of_laser: Vec<usize>,
    /// The index of the wavelength for the lights; 0 if there are none.
    pub of_lights: usize,
}

impl Bands {
    pub(super) fn new(lasers: &[Laser], lights: &[Light]) -> Self {
        let mut wavelengths = Vec::new();
        let of_laser = lasers
            .iter()
            .map(|laser| index_of(&mut wavelengths, laser.wavelength()))
            .collect();
        let of_lights = if lights.is_empty() {
            0
        } else {
            index_of(&mut wavelengths, WHITE_LIGHT_WAVELENGTH)
        };
        Self {
            wavelengths,
            of_laser,
            of_lights,
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
