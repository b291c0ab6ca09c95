//! Bindings of `tem00-beam`, the module `tem00.beam`.

mod abcd;
mod astigmatic;
mod closed_form;
mod cross_section;
mod fit;
mod gaussian;
mod light;
mod line;
mod map;
mod placed;
mod profile;

use pyo3::prelude::*;

pub(crate) use self::{
    light::Light,
    placed::{Placed, named},
    profile::LineProfile,
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
        abcd::AbcdMatrix,
        astigmatic::AstigmaticBeam,
        closed_form::closed_form,
        cross_section::CrossSection,
        fit::{CausticFit, FitError, KnifeEdgeFit},
        gaussian::{GaussianBeam, LocatedBeam},
        light::Light,
        line::{FanGeometry, LaserLine},
        placed::Placement,
        profile::LineProfile,
    };

    #[pymodule_init]
    fn init(module: &Bound<'_, PyModule>) -> PyResult<()> {
        let records = [
            "ApertureHit",
            "Bounds",
            "NextEvent",
            "RayPdf",
            "RaySample",
            "SampledEvent",
        ];
        crate::arrays::add_named(module, &records)?;
        // A subclass of float, which the stable interface cannot make.
        crate::arrays::add_named(module, &["Estimate"])
    }
}
