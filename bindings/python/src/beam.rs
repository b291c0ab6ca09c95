//! Bindings of tem00-beam.

mod abcd;
mod arguments;
mod astigmatic;
mod closed_form;
mod complex_parameter;
mod cross_section;
mod emitter;
mod fit;
mod gaussian;
mod laser;
mod light;
mod lights;
mod line;
mod line_lights;
mod located;
mod placement;
mod profile;
pub(crate) mod records;
mod rows;

use pyo3::prelude::*;

pub(crate) use self::{
    emitter::Emitter, laser::light_of, profile::LineProfile, records::NextEvent,
};

/// Gaussian beams, laser lines, and the lights that a renderer places.
///
/// All lengths are in metres, angles in radians, powers in watts. Light travels along +z of its own
/// frame. A beam radius is where the irradiance has fallen to 1/e² of the axis. Coordinates beyond
/// ±1e30, or not finite, are refused.
#[pymodule(submodule)]
pub(crate) mod beam {
    use pyo3::prelude::*;

    #[pymodule_export]
    use super::{
        abcd::{AbcdMatrix, ThickLens},
        astigmatic::AstigmaticBeam,
        closed_form::closed_form,
        complex_parameter::ComplexBeamParameter,
        cross_section::CrossSection,
        emitter::Emitter,
        fit::{CausticFit, FitError, KnifeEdgeFit},
        gaussian::GaussianBeam,
        lights::SpotLight,
        line::{FanGeometry, LaserLine},
        line_lights::{LineLight, TabulatedLineLight},
        located::LocatedBeam,
        placement::{Axis, Placement},
        profile::{AngularProfile, LineProfile},
        records::{ApertureHit, Bounds, NextEvent, RayPdf, RaySample, SampledEvent},
    };

    #[pymodule_init]
    fn init(module: &Bound<'_, PyModule>) -> PyResult<()> {
        // A subclass of float, which the stable interface cannot make.
        module.add("Estimate", super::fit::estimate_class(module.py())?)
    }
}
