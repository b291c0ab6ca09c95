//! The placed lights.

use numpy::PyArray2;
use pyo3::prelude::*;
use tem00_beam as physics;

use super::{
    astigmatic::AstigmaticBeam,
    emitter::{Emitter, Light},
    gaussian::GaussianBeam,
    general::GeneralAstigmaticBeam,
    line::LaserLine,
    pickling::Reduced,
    placement::{Axis, Ellipse, Placement},
    profile::AngularProfile,
    rows::{Rows, array_of},
};
use crate::{arrays::Numbers, error::OrRaise};

/// A Gaussian beam in a scene, circular or elliptic, prepared for a renderer.
///
/// Made by ``place`` or ``place_astigmatic``, queried as an ``Emitter``. With the coordinates
/// ``(x, y, z)`` of a point in the frame of the light, its irradiance is::
///
///     E = 2 P / (π w_x w_y) · exp(−2 (x²/w_x² + y²/w_y²))     if x²/w_x² + y²/w_y² ≤ cutoff², z ≥ 0
///
/// The rows of ``to_rows`` are::
///
///     origin, power | ex, cutoff | ey, 0 | ez, 0 | x: w0_sq, theta_sq, z0, 0 | y: likewise
#[pyclass(frozen, extends = Emitter, module = "tem00.beam")]
#[derive(Debug)]
pub(crate) struct SpotLight(pub(super) physics::SpotLight<f64>);

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
    ///
    /// Returns
    /// -------
    /// SpotLight
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
    ///
    /// Returns
    /// -------
    /// SpotLight
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
    ///
    /// Returns
    /// -------
    /// SpotLight
    #[staticmethod]
    fn from_rows(py: Python<'_>, rows: Numbers<'_>) -> PyResult<Py<Self>> {
        let rows = Rows::placed(&rows)?;
        rows.check_axis(4)?;
        rows.check_axis(5)?;
        Self::of(py, physics::SpotLight::from_rows(rows.0))
    }

    /// Squared beam radius along x; its ``z0`` is the distance from the aperture to the waist.
    #[getter]
    fn x(&self) -> Axis {
        Axis(self.0.x)
    }

    /// Squared beam radius along y; its ``z0`` is the distance from the aperture to the waist.
    #[getter]
    fn y(&self) -> Axis {
        Axis(self.0.y)
    }

    fn __reduce__<'py>(slf: &Bound<'py, Self>) -> PyResult<Reduced<'py, (Bound<'py, PyAny>,)>> {
        reduced(slf.as_any())
    }
}

impl SpotLight {
    fn of(py: Python<'_>, light: physics::SpotLight<f64>) -> PyResult<Py<Self>> {
        let base = PyClassInitializer::from(Emitter(Light::Spot(light)));
        Py::new(py, base.add_subclass(Self(light)))
    }
}

/// A beam with general astigmatism in a scene, prepared for a renderer.
///
/// Made by ``place``, queried as an ``Emitter``. Its ellipse may turn on the way, and its rays may be
/// twisted about the axis. A ray has the slope ``s ~ N(0, S/4)`` and crosses the aperture plane at
/// ``K s + e``, with an independent ``e ~ N(0, W/4)``. The rows of ``to_rows`` are::
///
///     origin, power | ex, cutoff | ey, 0 | ez, 0 | W: xx, xy, yy, 0 | S: likewise | K: xx, xy, yx, yy
#[pyclass(frozen, extends = Emitter, module = "tem00.beam")]
#[derive(Debug)]
pub(crate) struct AstigmaticLight(physics::AstigmaticLight<f64>);

#[pymethods]
impl AstigmaticLight {
    /// Place a beam in a scene, with its reference plane as the aperture.
    ///
    /// Parameters
    /// ----------
    /// beam : GeneralAstigmaticBeam
    /// placement : Placement
    /// power : float
    ///     Power in watts, from 0 to 1e100.
    ///
    /// Returns
    /// -------
    /// AstigmaticLight
    #[staticmethod]
    fn place(
        py: Python<'_>,
        beam: &GeneralAstigmaticBeam,
        placement: &Placement,
        power: f64,
    ) -> PyResult<Py<Self>> {
        let light = physics::AstigmaticLight::place(&beam.0, &placement.0, power);
        Self::of(py, light.or_raise()?)
    }

    /// Return the light with the fields that ``to_rows`` returns.
    ///
    /// Parameters
    /// ----------
    /// rows : array_like, shape (7, 4)
    ///     The fields in the order of memory. What no placed light could hold is refused.
    ///
    /// Returns
    /// -------
    /// AstigmaticLight
    #[staticmethod]
    fn from_rows(py: Python<'_>, rows: Numbers<'_>) -> PyResult<Py<Self>> {
        let rows = Rows::placed(&rows)?;
        rows.check_ellipse(4)?;
        rows.check_ellipse(5)?;
        Self::of(py, physics::AstigmaticLight::from_rows(rows.0))
    }

    /// W: squared radii of the position on the aperture plane of rays with a given slope, in m².
    #[getter]
    fn position(&self) -> Ellipse {
        Ellipse(self.0.position)
    }

    /// S: squared radii of the slope, in rad².
    #[getter]
    fn slope(&self) -> Ellipse {
        Ellipse(self.0.slope)
    }

    /// K: mean position on the aperture plane per slope, in metres, shape (2, 2).
    #[getter]
    fn position_per_slope<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyArray2<f64>>> {
        array_of(py, &self.0.position_per_slope)
    }

    fn __reduce__<'py>(slf: &Bound<'py, Self>) -> PyResult<Reduced<'py, (Bound<'py, PyAny>,)>> {
        reduced(slf.as_any())
    }
}

impl AstigmaticLight {
    fn of(py: Python<'_>, light: physics::AstigmaticLight<f64>) -> PyResult<Py<Self>> {
        let base = PyClassInitializer::from(Emitter(Light::Astigmatic(light)));
        Py::new(py, base.add_subclass(Self(light)))
    }
}

/// A laser line in a scene, prepared for a renderer.
///
/// Made by ``place``, queried as an ``Emitter``. With the coordinates ``(x, y, z)`` of a point in the
/// frame of the light, ``Z = z + apex_offset``, ``u = x / Z`` and ``r = √(x² + Z²)``::
///
///     E = P g(u) / Z · √(2/π) / w · exp(−2 y² / w²)     with w = w(r)
///
/// The waist lies at ``r = y.z0``, or at ``r = y.z0 √(1 + u²)`` if ``focus_on_plane`` is true. The
/// density along the fan is uniform on ±``flat`` in the variable ``v``, convolved with a normal
/// density of standard deviation ``sigma`` and divided by ``mass``; ``variable`` is 0 for
/// ``v = tan θ``, 1 for ``θ``, 2 for ``sin θ`` and 3 for a table kept elsewhere. The cut-off is
/// ``|y| ≤ cutoff · w`` and ``|v| ≤ flat + 2 cutoff · sigma``. The rows of ``to_rows`` are::
///
///     origin, power | ex, cutoff | ey, apex_offset | ez, source_radius | y: w0_sq, theta_sq, z0, 0
///     | flat, sigma, variable, mass | half_slope, focus_on_plane, 0, 0
#[pyclass(frozen, extends = Emitter, module = "tem00.beam")]
#[derive(Debug)]
pub(crate) struct LineLight(pub(super) physics::LineLight<f64>);

#[pymethods]
impl LineLight {
    /// Place a laser line in a scene, with the lens at the placement's origin.
    ///
    /// Parameters
    /// ----------
    /// line : LaserLine
    ///     With any profile but a table, which a ``TabulatedLineLight`` holds.
    /// placement : Placement
    /// power : float
    ///     Power in watts, from 0 to 1e100.
    ///
    /// Returns
    /// -------
    /// LineLight
    #[staticmethod]
    fn place(
        py: Python<'_>,
        line: &LaserLine,
        placement: &Placement,
        power: f64,
    ) -> PyResult<Py<Self>> {
        let light = physics::LineLight::place(&line.0, &placement.0, power).or_raise()?;
        Self::of(py, light)
    }

    /// Return the light with the fields that ``to_rows`` returns.
    ///
    /// Parameters
    /// ----------
    /// rows : array_like, shape (7, 4)
    ///     The fields in the order of memory. What no placed light could hold is refused.
    ///
    /// Returns
    /// -------
    /// LineLight
    #[staticmethod]
    fn from_rows(py: Python<'_>, rows: Numbers<'_>) -> PyResult<Py<Self>> {
        let rows = Rows::placed(&rows)?;
        rows.check_axis(4)?;
        rows.check_fan()?;
        Self::of(py, physics::LineLight::from_rows(rows.0))
    }

    /// Distance of the virtual apex behind the lens, in metres.
    #[getter]
    fn apex_offset(&self) -> f64 {
        self.0.apex_offset
    }

    /// Radius of the virtual apex, in metres: the diffraction-limited width of the fan's source.
    #[getter]
    fn source_radius(&self) -> f64 {
        self.0.source_radius
    }

    /// Squared beam radius across the fan; its ``z0`` is the slant distance from the virtual apex to
    /// the waist, on the axis.
    #[getter]
    fn y(&self) -> Axis {
        Axis(self.0.y)
    }

    /// Half-width of the uniform part of the profile, in its variable; 0 for a Gaussian profile.
    #[getter]
    fn flat(&self) -> f64 {
        self.0.flat
    }

    /// Standard deviation of the Gaussian part of the profile, in its variable; 0 for a top hat.
    #[getter]
    fn sigma(&self) -> f64 {
        self.0.sigma
    }

    /// The variable of the profile: 0 for tan θ, 1 for θ, 2 for sin θ, 3 for a table kept elsewhere.
    #[getter]
    fn variable(&self) -> u8 {
        // One of four codes, as `Rows::check_fan` and placing make sure.
        match self.0.variable {
            v if v < 0.5 => 0,
            v if v < 1.5 => 1,
            v if v < 2.5 => 2,
            _ => 3,
        }
    }

    /// Share of the untruncated profile inside ``|θ| < π/2``; 1 in tan θ.
    #[getter]
    fn mass(&self) -> f64 {
        self.0.mass
    }

    /// Slope of the edges of the fan, the tangent of half the fan angle.
    #[getter]
    fn half_slope(&self) -> f64 {
        self.0.half_slope
    }

    /// Whether the waist lies on a plane square to the axis, and not on a circle about the apex.
    #[getter]
    fn focus_on_plane(&self) -> bool {
        self.0.focus_on_plane > 0.0
    }

    fn __reduce__<'py>(slf: &Bound<'py, Self>) -> PyResult<Reduced<'py, (Bound<'py, PyAny>,)>> {
        reduced(slf.as_any())
    }
}

impl LineLight {
    pub(super) fn of(py: Python<'_>, light: physics::LineLight<f64>) -> PyResult<Py<Self>> {
        let base = PyClassInitializer::from(Emitter(Light::Line(light)));
        Py::new(py, base.add_subclass(Self(light)))
    }
}

/// A laser line in a scene whose power along the fan is a table.
///
/// Made by ``place``, queried as an ``Emitter``. A ``LineLight`` but for the profile: the power per
/// angle is linear between the neighbouring angles of the table and 0 outside them. The cut-off acts
/// across the fan only.
#[pyclass(frozen, extends = Emitter, module = "tem00.beam")]
#[derive(Debug)]
pub(crate) struct TabulatedLineLight {
    line: physics::LineLight<f64>,
    profile: physics::AngularProfile,
}

#[pymethods]
impl TabulatedLineLight {
    /// Place a laser line in a scene, with the lens at the placement's origin.
    ///
    /// Parameters
    /// ----------
    /// line : LaserLine
    ///     With a table as its profile.
    /// placement : Placement
    /// power : float
    ///     Power in watts, from 0 to 1e100.
    ///
    /// Returns
    /// -------
    /// TabulatedLineLight
    #[staticmethod]
    fn place(
        py: Python<'_>,
        line: &LaserLine,
        placement: &Placement,
        power: f64,
    ) -> PyResult<Py<Self>> {
        let light = physics::TabulatedLineLight::place(&line.0, &placement.0, power).or_raise()?;
        let physics::LineProfile::Tabulated(profile) = line.0.profile() else {
            return Err(physics::BeamError::NotTabulated).or_raise();
        };
        let (line, profile) = (light.line, profile.clone());
        let base = Emitter(Light::Tabulated(line, profile.clone()));
        let light = PyClassInitializer::from(base).add_subclass(Self { line, profile });
        Py::new(py, light)
    }

    /// The line but for its profile. By itself it is dark.
    #[getter]
    fn line(&self, py: Python<'_>) -> PyResult<Py<LineLight>> {
        LineLight::of(py, self.line)
    }

    /// The profile along the fan.
    #[getter]
    fn profile(&self) -> AngularProfile {
        AngularProfile(self.profile.clone())
    }
}

fn reduced<'py>(light: &Bound<'py, PyAny>) -> PyResult<Reduced<'py, (Bound<'py, PyAny>,)>> {
    let restore = light.get_type().getattr("from_rows")?;
    Ok((restore, (light.call_method0("to_rows")?,)))
}
