//! Lights: made from a description, then asked.
//!
//! A light is a handle and not a plain struct, so that one set of functions serves every kind, that
//! a table has an owner, and that nothing unchecked reaches the laws.

// The order of the header.
mod description;

mod queries;

mod targets;

mod batch;

mod plain;

pub use batch::*;
pub use description::*;
pub use plain::*;
pub use queries::*;
pub use targets::*;

use tem00_beam::{AngularKnot, Emitter, LineLight, SpotLight, TabulatedLineLight};
use tem00_coherence::Spectrum;
use tem00_shading::{BeamShape, DVec3, LaserDescription, ShadingError};

use crate::{pointers, status::Failure};

/// A laser in a scene. It never changes: any number of threads may ask it at once.
#[derive(Debug)]
pub struct Light {
    placed: Placed,
    /// The light as a laser of the shading crate, or why it cannot be one.
    laser: Result<tem00_shading::Laser, Failure>,
}

/// The lights of the library.
#[derive(Clone, Debug)]
enum Placed {
    Spot(SpotLight),
    Line(LineLight),
    Tabulated(LineLight, Vec<AngularKnot>),
}

impl Light {
    /// Asks the light, whichever it is.
    fn ask<R>(&self, question: impl FnOnce(&dyn Emitter) -> R) -> R {
        match &self.placed {
            Placed::Spot(light) => question(light),
            Placed::Line(light) => question(light),
            Placed::Tabulated(line, knots) => question(&TabulatedLineLight { line: *line, knots }),
        }
    }

    fn spot(light: SpotLight, shape: BeamShape) -> Self {
        Self {
            laser: laser(&light, light.ex, shape),
            placed: Placed::Spot(light),
        }
    }

    fn line(light: LineLight, shape: BeamShape) -> Self {
        Self {
            laser: laser(&light, light.ex, shape),
            placed: Placed::Line(light),
        }
    }

    fn tabulated(light: TabulatedLineLight<'_>, shape: BeamShape) -> Self {
        Self {
            laser: laser(&light, light.line.ex, shape),
            placed: Placed::Tabulated(light.line, light.knots.to_vec()),
        }
    }

    /// The light as speckle needs it, if it can.
    pub(crate) fn laser(&self) -> Result<&tem00_shading::Laser, Failure> {
        self.laser.as_ref().map_err(Clone::clone)
    }
}

/// Makes of a placed light, whose first axis is `ex`, what speckle needs.
fn laser(
    light: &impl Emitter,
    ex: [f64; 3],
    shape: BeamShape,
) -> Result<tem00_shading::Laser, Failure> {
    let position = DVec3::from_array(light.origin());
    let spectrum = Spectrum::monochromatic(light.wavelength()).map_err(ShadingError::from);
    let laser = spectrum.and_then(|spectrum| {
        tem00_shading::Laser::new(LaserDescription {
            spectrum,
            power: light.power(),
            position,
            look_at: position + DVec3::from_array(light.axis()),
            line_direction: DVec3::from_array(ex),
            shape,
        })
    });
    laser.map_err(|error| Failure::argument("light", format!("light: {error}")))
}

/// Frees a light; null is allowed. No thread may be using it, and it must not be used again.
///
/// # Safety
///
/// `light` is null, or came from one of the functions that create lights and was not destroyed.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn tem00_light_destroy(light: *mut Light) {
    // SAFETY: by the contract of this function.
    unsafe { pointers::destroy(light) };
}

#[cfg(test)]
mod tests;
