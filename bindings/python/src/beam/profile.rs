//! Distribution of the power of a laser line along the fan.

use numpy::PyArray2;
use pyo3::prelude::*;
use tem00_beam::{self as physics, LineProfile as Profile};

use crate::pickling::Value;

class! {
    /// Distribution of the power of a laser line along the fan.
    ///
    /// Each profile is a density in tan θ, in θ itself or in sin θ, where θ is the fan angle. The
    /// edges of the fan are the 1/e² points of a Gaussian, the ends of a uniform profile, the
    /// half-value points of a Powell profile.
    "tem00.beam" LineProfile(Profile)
}

methods! {
    impl LineProfile as this: this.0;

    unmade "gaussian_tan, gaussian_angle, gaussian_sin, uniform_tan, uniform_angle, powell or \
        tabulated";

    /// Return the profile that is Gaussian in tan θ, and so along the line on a plane.
    make gaussian_tan() = PyResult::Ok(Profile::GaussianTan);

    /// Return the profile that is Gaussian in the angle θ.
    make gaussian_angle() = PyResult::Ok(Profile::GaussianAngle);

    /// Return the profile that is Gaussian in sin θ: the far field of a diffracted Gaussian beam.
    make gaussian_sin() = PyResult::Ok(Profile::GaussianSin);

    /// Return the profile with equal power on equal lengths of the line.
    make uniform_tan() = PyResult::Ok(Profile::UniformTan);

    /// Return the profile with equal power in equal angles.
    make uniform_angle() = PyResult::Ok(Profile::UniformAngle);

    /// Return the profile of a Powell lens: uniform in tan θ, with a Gaussian roll-off.
    ///
    /// Parameters
    /// ----------
    /// edge : float
    ///     Standard deviation of the roll-off relative to the half-length of the line, from 1e-6
    ///     (a top hat) to 1. It is checked where a line is made.
    make powell(edge: f64) = PyResult::Ok(Profile::Powell { edge });

    /// Return the profile of a table: a data sheet, or a measurement.
    ///
    /// Between the angles of the table the power per angle is linear, outside them there is none.
    /// Its integral is normalised to 1. It need not end at the edges of the fan.
    ///
    /// Parameters
    /// ----------
    /// angles : array_like, shape (n,)
    ///     Ascending angles from the axis, in radians, in (-π/2, π/2); at least 2.
    /// powers : array_like, shape (n,)
    ///     Power per angle at each of them, in any unit; not negative, and not all 0.
    make tabulated(angles: Vec<f64>, powers: Vec<f64>) =
        physics::AngularProfile::new(&angles, &powers).map(Profile::Tabulated);

    made_as match &this.0 {
        Profile::GaussianTan => ("gaussian_tan", vec![]),
        Profile::GaussianAngle => ("gaussian_angle", vec![]),
        Profile::GaussianSin => ("gaussian_sin", vec![]),
        Profile::UniformTan => ("uniform_tan", vec![]),
        Profile::UniformAngle => ("uniform_angle", vec![]),
        Profile::Powell { edge } => ("powell", vec![Value::Number(*edge)]),
        Profile::Tabulated(table) => {
            let knots = table.knots().iter();
            let (angles, powers) = knots.map(|knot| (knot.angle, knot.density)).unzip();
            ("tabulated", vec![Value::List(angles), Value::List(powers)])
        }
        // The enum may grow; a new profile needs a constructor here.
        _ => ("unknown", vec![]),
    };
}

#[pymethods]
impl LineProfile {
    /// The table of a tabulated profile, shape (n, 3), or None: angle in radians, fraction of the
    /// power per radian there, and fraction of the power below.
    #[getter]
    fn knots<'py>(&self, py: Python<'py>) -> PyResult<Option<Bound<'py, PyArray2<f64>>>> {
        let Profile::Tabulated(table) = &self.0 else {
            return Ok(None);
        };
        let rows = table.knots().iter();
        let rows: Vec<_> = rows
            .map(|k| vec![k.angle, k.density, k.cumulative])
            .collect();
        Ok(Some(PyArray2::from_vec2(py, &rows)?))
    }
}
