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

use tem00_beam::{
    AngularKnot, AngularProfile, Emitter, LineLight, Real, Refusal, SpotLight, TabulatedLineLight,
};
use tem00_coherence::SpectralLine;
use tem00_shading::{BeamShape, DVec3, LaserDescription, ShadingError};

use crate::{pointers, status::Failure};

/// A laser in a scene. It never changes: any number of threads may ask it at once.
#[derive(Debug)]
pub struct Light {
    double: Laser<f64>,
    single: Result<Laser<f32>, Refusal>,
    /// As speckle needs it.
    laser: Result<tem00_shading::Laser, Failure>,
}

/// The lights of the library, in one precision.
#[derive(Clone, Debug)]
enum Laser<T> {
    Spot(SpotLight<T>),
    Line(LineLight<T>),
    Tabulated(LineLight<T>, Vec<AngularKnot<T>>),
}

impl<T: Real> Laser<T> {
    /// Asks the light, whichever it is.
    fn ask<R>(&self, question: impl FnOnce(&dyn Emitter<T>) -> R) -> R {
        match self {
            Self::Spot(light) => question(light),
            Self::Line(light) => question(light),
            Self::Tabulated(line, knots) => question(&TabulatedLineLight { line: *line, knots }),
        }
    }
}

impl Light {
    /// A light that is a struct of numbers in either precision.
    fn plain<D, S>(
        light: D,
        to_single: impl Fn(&D) -> Result<S, Refusal>,
        double: impl Fn(D) -> Laser<f64>,
        single: impl Fn(S) -> Laser<f32>,
        laser: Result<tem00_shading::Laser, Failure>,
    ) -> Self {
        Self {
            single: to_single(&light).map(single),
            double: double(light),
            laser,
        }
    }

    fn spot(light: SpotLight<f64>, shape: BeamShape) -> Self {
        let laser = laser(&light, light.ex, shape);
        Self::plain(light, SpotLight::to_f32, Laser::Spot, Laser::Spot, laser)
    }

    fn line(light: LineLight<f64>, shape: BeamShape) -> Self {
        let laser = laser(&light, light.ex, shape);
        Self::plain(light, LineLight::to_f32, Laser::Line, Laser::Line, laser)
    }

    fn tabulated(
        light: TabulatedLineLight<'_, f64>,
        profile: &AngularProfile,
        shape: BeamShape,
    ) -> Self {
        let single = profile.to_f32().and_then(|knots| {
            let line = light.to_f32(&knots)?.line;
            Ok(Laser::Tabulated(line, knots))
        });
        Self {
            double: Laser::Tabulated(light.line, light.knots.to_vec()),
            single,
            laser: laser(&light, light.line.ex, shape),
        }
    }

    /// The light in single precision, if that can carry it.
    fn single(&self) -> Result<&Laser<f32>, Failure> {
        self.single.as_ref().map_err(|error| error.clone().into())
    }

    /// The light as speckle needs it, if it can.
    pub(crate) fn laser(&self) -> Result<&tem00_shading::Laser, Failure> {
        self.laser.as_ref().map_err(Clone::clone)
    }
}

/// Makes of a placed light, whose first axis is `ex`, what speckle needs.
fn laser(
    light: &impl Emitter<f64>,
    ex: [f64; 3],
    shape: BeamShape,
) -> Result<tem00_shading::Laser, Failure> {
    let position = DVec3::from_array(light.origin());
    let line = SpectralLine::monochromatic(light.wavelength()).map_err(ShadingError::from);
    let laser = line.and_then(|line| {
        tem00_shading::Laser::new(LaserDescription {
            line,
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
