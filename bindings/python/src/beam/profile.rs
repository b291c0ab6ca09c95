//! Distribution of the power of a laser line along the fan.

use numpy::PyArray2;
use pyo3::prelude::*;
use tem00_beam as physics;
use tem00_numerics::cast::to_f32;

use super::{
    arguments::{OrRaiseAs, list},
    rows::array_of,
};
use crate::{
    arrays::{Components, Table},
    error::{OrRaise, refused},
    pickling::{Recipe, by_constructor},
};

/// Distribution of the power of a laser line along the fan.
///
/// Each profile is a density in tan θ, in θ itself or in sin θ, where θ is the fan angle. The edges of
/// the fan are the 1/e² points of a Gaussian, the ends of a uniform profile, the half-value points of a
/// Powell profile.
#[pyclass(frozen, eq, module = "tem00.beam")]
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct LineProfile(pub(crate) physics::LineProfile);

#[pymethods]
impl LineProfile {
    /// Return the profile that is Gaussian in tan θ, and so along the line on a plane.
    #[staticmethod]
    fn gaussian_tan() -> Self {
        Self(physics::LineProfile::GaussianTan)
    }

    /// Return the profile that is Gaussian in the angle θ.
    #[staticmethod]
    fn gaussian_angle() -> Self {
        Self(physics::LineProfile::GaussianAngle)
    }

    /// Return the profile that is Gaussian in sin θ: the far field of a diffracted Gaussian beam.
    #[staticmethod]
    fn gaussian_sin() -> Self {
        Self(physics::LineProfile::GaussianSin)
    }

    /// Return the profile with equal power on equal lengths of the line.
    #[staticmethod]
    fn uniform_tan() -> Self {
        Self(physics::LineProfile::UniformTan)
    }

    /// Return the profile with equal power in equal angles.
    #[staticmethod]
    fn uniform_angle() -> Self {
        Self(physics::LineProfile::UniformAngle)
    }

    /// Return the profile of a Powell lens: uniform in tan θ, with a Gaussian roll-off.
    ///
    /// Parameters
    /// ----------
    /// edge : float
    ///     Standard deviation of the roll-off relative to the half-length of the line, from 1e-6
    ///     (a top hat) to 1. It is checked where a line is made.
    #[staticmethod]
    fn powell(edge: f64) -> Self {
        Self(physics::LineProfile::Powell { edge })
    }

    /// Return the profile of a table.
    ///
    /// Parameters
    /// ----------
    /// profile : AngularProfile
    ///     It need not end at the edges of the fan.
    #[staticmethod]
    fn tabulated(profile: &AngularProfile) -> Self {
        Self(physics::LineProfile::Tabulated(profile.0.clone()))
    }

    pub(super) fn __repr__(&self) -> String {
        let (name, arguments) = self.constructor();
        format!("LineProfile.{name}({arguments})")
    }

    fn __reduce__<'py>(&self, py: Python<'py>) -> PyResult<Recipe<'py>> {
        let (name, _) = self.constructor();
        match &self.0 {
            physics::LineProfile::Powell { edge } => by_constructor::<Self>(py, name, (*edge,)),
            physics::LineProfile::Tabulated(profile) => {
                by_constructor::<Self>(py, name, (AngularProfile(profile.clone()),))
            }
            _ => by_constructor::<Self>(py, name, ()),
        }
    }
}

methods! {
    impl LineProfile as this: this.0;

    unmade "gaussian_tan, gaussian_angle, gaussian_sin, uniform_tan, uniform_angle, powell or tabulated";
}

impl LineProfile {
    /// The name of the static method that makes the profile, and its argument as text.
    fn constructor(&self) -> (&'static str, String) {
        match &self.0 {
            physics::LineProfile::GaussianTan => ("gaussian_tan", String::new()),
            physics::LineProfile::GaussianAngle => ("gaussian_angle", String::new()),
            physics::LineProfile::GaussianSin => ("gaussian_sin", String::new()),
            physics::LineProfile::UniformTan => ("uniform_tan", String::new()),
            physics::LineProfile::UniformAngle => ("uniform_angle", String::new()),
            physics::LineProfile::Powell { edge } => ("powell", format!("edge={edge:?}")),
            physics::LineProfile::Tabulated(profile) => {
                ("tabulated", AngularProfile(profile.clone()).__repr__())
            }
            // The enum may grow; a new profile needs a constructor here.
            _ => ("unknown", String::new()),
        }
    }
}

/// The power of a laser line per fan angle, from a table: a data sheet, or a measurement.
///
/// Between the angles of the table the power per angle is linear, outside them there is none. Its
/// integral is normalised to 1.
///
/// Parameters
/// ----------
/// angles : array_like, shape (n,)
///     Ascending angles from the axis, in radians, in (-π/2, π/2); at least 2.
/// powers : array_like, shape (n,)
///     Power per angle at each of them, in any unit; not negative, and not all 0.
#[pyclass(frozen, eq, module = "tem00.beam")]
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct AngularProfile(pub(super) physics::AngularProfile);

#[pymethods]
impl AngularProfile {
    #[new]
    fn new(angles: Components<'_>, powers: Components<'_>) -> PyResult<Self> {
        let (angles, powers) = (list("angles", &angles)?, list("powers", &powers)?);
        let profile = physics::AngularProfile::new(angles, powers);
        Ok(Self(profile.or_raise()?))
    }

    /// Return the profile of pairs of an angle and the power per angle there.
    ///
    /// Parameters
    /// ----------
    /// pairs : array_like, shape (n, 2)
    ///     Ascending angles, in radians, and the power per angle at each, in any unit.
    #[staticmethod]
    fn from_pairs(pairs: Table<'_>) -> PyResult<Self> {
        let [_, 2] = pairs.shape() else {
            let shape = pairs.shape();
            let message = format!("pairs must have the shape [n, 2], got {shape:?}");
            return Err(refused("pairs", message));
        };
        let (rows, _) = pairs.values()?.as_chunks::<2>();
        let pairs: Vec<(f64, f64)> = rows.iter().copied().map(Into::into).collect();
        let names = [("angles", "pairs"), ("powers", "pairs")];
        let profile = physics::AngularProfile::from_pairs(&pairs);
        Ok(Self(profile.or_raise_as(&names)?))
    }

    /// The table, shape (n, 3): angle in radians, fraction of the power per radian there, and
    /// fraction of the power below.
    #[getter]
    fn knots<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyArray2<f64>>> {
        let knots = self.0.knots();
        let rows: Vec<_> = knots
            .iter()
            .map(|k| [k.angle, k.density, k.cumulative])
            .collect();
        array_of(py, &rows)
    }

    /// Return the table in single precision.
    ///
    /// Returns
    /// -------
    /// ndarray, shape (n, 3)
    ///     As ``knots``, in float32.
    fn to_f32<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyArray2<f32>>> {
        let knots = self.0.knots().iter();
        let rows = knots.map(|k| [k.angle, k.density, k.cumulative].map(to_f32));
        array_of(py, &rows.collect::<Vec<_>>())
    }

    pub(super) fn __repr__(&self) -> String {
        let (angles, densities) = self.columns();
        format!("AngularProfile(angles={angles:?}, powers={densities:?})")
    }

    fn __reduce__<'py>(&self, py: Python<'py>) -> PyResult<Recipe<'py>> {
        by_constructor::<Self>(py, "__call__", self.columns())
    }
}

impl AngularProfile {
    /// The angles and the normalised power per angle at each.
    fn columns(&self) -> (Vec<f64>, Vec<f64>) {
        let knots = self.0.knots().iter();
        knots.map(|knot| (knot.angle, knot.density)).unzip()
    }
}
