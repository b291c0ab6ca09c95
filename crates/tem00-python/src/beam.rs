//! Bindings of tem00-beam.

mod abcd;
mod arguments;
mod astigmatic;
mod astigmatic_system;
mod complex_parameter;
mod cross_section;
mod emitter;
mod gaussian;
mod general;
mod lights;
mod line;
mod pickling;
mod placement;
mod profile;
mod records;
mod rows;

use pyo3::prelude::*;

/// Gaussian beams, laser lines, and the lights that a renderer places.
///
/// All lengths are in metres, angles in radians, powers in watts. Light travels along +z of its own
/// frame. A beam radius is where the irradiance has fallen to 1/e² of the axis. Coordinates and all
/// that is computed from them lie within ±1e30: what is larger, or not finite, is refused.
#[pymodule(submodule)]
pub(crate) mod beam {
    #[pymodule_export]
    use super::{
        abcd::{AbcdMatrix, ThickLens},
        astigmatic::AstigmaticBeam,
        astigmatic_system::AstigmaticSystem,
        complex_parameter::ComplexBeamParameter,
        cross_section::CrossSection,
        emitter::Emitter,
        gaussian::{GaussianBeam, LocatedBeam},
        general::{GeneralAstigmaticBeam, SecondMoments},
        lights::{AstigmaticLight, LineLight, SpotLight, TabulatedLineLight},
        line::{FanGeometry, LaserLine},
        placement::{Axis, Ellipse, Placement},
        profile::{AngularProfile, LineProfile},
        records::{Bounds, NextEvent, RayPdf, RaySample, SampledEvent},
    };
}
