//! Placed beams.

use pyo3::prelude::*;
use tem00_beam as physics;

use super::{
    astigmatic::AstigmaticBeam,
    emitter::Emitter,
    gaussian::GaussianBeam,
    light::Light,
    placement::{Axis, Placement},
    rows::{Rows, array_of},
};
use crate::{
    arrays::Table,
    error::OrRaise,
    pickling::{Recipe, by_constructor},
};

/// A Gaussian beam in a scene, circular or elliptic, prepared for a renderer.
///
/// Made by ``place`` or ``place_astigmatic``, queried as an ``Emitter``. With the coordinates
/// ``(x, y, z)`` of a point in the frame of the light, its irradiance is::
///
///     E = 2 P / (π w_x w_y) · exp(−2 (x²/w_x² + y²/w_y²))     if x²/w_x² + y²/w_y² ≤ cutoff², z ≥ 0
///
/// The rows of ``to_rows`` are::
///
///     origin, power | ex, cutoff | ey, wavelength | ez, 0 | x: w0_sq, theta_sq, z0, 0 | y: likewise
#[pyclass(frozen, extends = Emitter, module = "tem00.beam")]
#[derive(Debug)]
pub(crate) struct SpotLight(pub(super) physics::SpotLight);

#[pymethods]
impl SpotLight {
    /// Place a beam in a scene.
    ///
    /// Parameters
    /// ----------
    /// beam : GaussianBeam
    /// waist_distance : float
    ///     Signed distance from the aperture to the waist along the axis, in metres.
    /// placement : Placement
    /// power : float
    ///     Power in watts, from 0 to 1e100.
    #[staticmethod]
    fn place(
        py: Python<'_>,
        beam: &GaussianBeam,
        waist_distance: f64,
        placement: &Placement,
        power: f64,
    ) -> PyResult<Py<Self>> {
        let light = physics::SpotLight::place(&beam.0, waist_distance, &placement.0, power);
        Self::of(py, light.or_raise()?)
    }

    /// Place an elliptic beam in a scene, with its reference plane as the aperture.
    ///
    /// The local x axis is the first principal axis of the beam: the fan axis of the placement,
    /// turned by the rotation of the beam about the direction of travel.
    ///
    /// Parameters
    /// ----------
    /// beam : AstigmaticBeam
    /// placement : Placement
    /// power : float
    ///     Power in watts, from 0 to 1e100.
    #[staticmethod]
    fn place_astigmatic(
        py: Python<'_>,
        beam: &AstigmaticBeam,
        placement: &Placement,
        power: f64,
    ) -> PyResult<Py<Self>> {
        let light = physics::SpotLight::place_astigmatic(&beam.0, &placement.0, power);
        Self::of(py, light.or_raise()?)
    }

    /// Return the light with the fields that ``to_rows`` returns.
    ///
    /// Parameters
    /// ----------
    /// rows : array_like, shape (6, 4)
    ///     The fields in the order of memory. What no placed light could hold is refused.
    #[staticmethod]
    fn from_rows(py: Python<'_>, rows: Table<'_>) -> PyResult<Py<Self>> {
        let rows = Rows::placed(&rows)?;
        rows.check_wavelength(2, 3)?;
        rows.check_axis(4)?;
        rows.check_axis(5)?;
        Self::of(py, physics::SpotLight::from_rows(rows.0))
    }

    fn __reduce__<'py>(&self, py: Python<'py>) -> PyResult<Recipe<'py>> {
        let rows = array_of(py, &self.0.to_rows())?;
        by_constructor::<Self>(py, "from_rows", (rows,))
    }
}

methods! {
    impl SpotLight as this: this.0;

    unmade "place or place_astigmatic";

    /// Squared beam radius along x; its ``z0`` is the distance from the aperture to the waist.
    get x -> Axis = Axis(this.0.x);

    /// Squared beam radius along y; its ``z0`` is the distance from the aperture to the waist.
    get y -> Axis = Axis(this.0.y);
}

impl SpotLight {
    pub(super) fn of(py: Python<'_>, light: physics::SpotLight) -> PyResult<Py<Self>> {
        let base = PyClassInitializer::from(Emitter(Light::Spot(light)));
        Py::new(py, base.add_subclass(Self(light)))
    }
}
