//! Placed laser lines.

use pyo3::prelude::*;
use tem00_beam as physics;

use super::{
    emitter::Emitter,
    light::Light,
    line::LaserLine,
    placement::{Axis, Placement},
    profile::AngularProfile,
    rows::{Rows, array_of},
};
use crate::{
    arrays::Table,
    error::OrRaise,
    pickling::{Recipe, by_constructor},
};

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
///     | flat, sigma, variable, mass | half_slope, focus_on_plane, wavelength, 0
#[pyclass(frozen, extends = Emitter, module = "tem00.beam")]
#[derive(Debug)]
pub(crate) struct LineLight(pub(super) physics::LineLight);

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
    #[staticmethod]
    fn from_rows(py: Python<'_>, rows: Table<'_>) -> PyResult<Py<Self>> {
        let rows = Rows::placed(&rows)?;
        rows.check_axis(4)?;
        rows.check_fan()?;
        Self::of(py, physics::LineLight::from_rows(rows.0))
    }

    fn __reduce__<'py>(&self, py: Python<'py>) -> PyResult<Recipe<'py>> {
        let rows = array_of(py, &self.0.to_rows())?;
        by_constructor::<Self>(py, "from_rows", (rows,))
    }
}

methods! {
    impl LineLight as this: this.0;

    unmade "place";

    /// The variable of the profile: 0 for tan θ, 1 for θ, 2 for sin θ, 3 for a table kept elsewhere.
    get variable -> u8 = match this.0.variable {
        // One of four codes, as `Rows::check_fan` and placing make sure.
        v if v < 0.5 => 0,
        v if v < 1.5 => 1,
        v if v < 2.5 => 2,
        _ => 3,
    };

    /// Distance of the virtual apex behind the lens, in metres.
    field apex_offset -> f64;

    /// Radius of the virtual apex, in metres: the diffraction-limited width of the fan's source.
    field source_radius -> f64;

    /// Squared beam radius across the fan; its ``z0`` is the slant distance from the virtual apex to
    /// the waist, on the axis.
    get y -> Axis = Axis(this.0.y);

    /// Half-width of the uniform part of the profile, in its variable; 0 for a Gaussian profile.
    field flat -> f64;

    /// Standard deviation of the Gaussian part of the profile, in its variable; 0 for a top hat.
    field sigma -> f64;

    /// Fraction of the untruncated profile inside ``|θ| < π/2``; 1 in tan θ.
    field mass -> f64;

    /// Slope of the edges of the fan, the tangent of half the fan angle.
    field half_slope -> f64;

    /// True if the waist lies on a plane square to the axis, and not on a circle about the apex.
    get focus_on_plane -> bool = this.0.focus_on_plane > 0.0;
}

impl LineLight {
    pub(super) fn of(py: Python<'_>, light: physics::LineLight) -> PyResult<Py<Self>> {
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
    line: physics::LineLight,
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
    #[staticmethod]
    fn place(
        py: Python<'_>,
        line: &LaserLine,
        placement: &Placement,
        power: f64,
    ) -> PyResult<Py<Self>> {
        let light = physics::TabulatedLineLight::place(&line.0, &placement.0, power).or_raise()?;
        let physics::LineProfile::Tabulated(profile) = line.0.profile() else {
            unreachable!("it was placed as a table")
        };
        Self::of(py, light.line, profile.clone())
    }

    /// The line but for its profile. By itself it is dark.
    #[getter]
    fn line(&self, py: Python<'_>) -> PyResult<Py<LineLight>> {
        LineLight::of(py, self.line)
    }
}

methods! {
    impl TabulatedLineLight as this: this.0;

    unmade "place";

    /// The profile along the fan.
    get profile -> AngularProfile = AngularProfile(this.profile.clone());
}

impl TabulatedLineLight {
    pub(super) fn of(
        py: Python<'_>,
        line: physics::LineLight,
        profile: physics::AngularProfile,
    ) -> PyResult<Py<Self>> {
        let base = PyClassInitializer::from(Emitter(Light::Tabulated(line, profile.clone())));
        Py::new(py, base.add_subclass(Self { line, profile }))
    }
}
