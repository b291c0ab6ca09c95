use glam::DVec3;
use nalgebra::{SMatrix, SymmetricEigen};
use tem00_decorrelation::RigidMotion;

use tem00_numerics::Refusal;
use tem00_triangulation::TriangulationError;

/// The number of parameters.
pub(super) const COUNT: usize = PARAMETERS.len();

/// Uncertain parameter of a calibration, in the order of the covariance.
///
/// The camera's axes are the axes of its image: to the right, down, and along the view. A tilt is
/// the vector of [`SensorTilt`](tem00_camera::SensorTilt): its angle along the right of the image
/// and along its top. The board is turned and shifted in the axes of the camera about its own
/// origin, where the origin of heights is. The normal of the laser plane changes by a vector across
/// itself, and the plane is shifted along its normal.
pub const PARAMETERS: [Parameter; 18] = [
    Parameter::new("image distance", "m"),
    Parameter::new("principal point x", "pixel"),
    Parameter::new("principal point y", "pixel"),
    Parameter::new("tilt right", "rad"),
    Parameter::new("tilt up", "rad"),
    Parameter::new("k1", ""),
    Parameter::new("k2", ""),
    Parameter::new("k3", ""),
    Parameter::new("rotation right", "rad"),
    Parameter::new("rotation down", "rad"),
    Parameter::new("rotation view", "rad"),
    Parameter::new("shift right", "m"),
    Parameter::new("shift down", "m"),
    Parameter::new("shift view", "m"),
    Parameter::new("plane normal right", ""),
    Parameter::new("plane normal down", ""),
    Parameter::new("plane normal view", ""),
    Parameter::new("plane offset", "m"),
];

/// A parameter of a calibration.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Parameter {
    /// The name.
    pub name: &'static str,
    /// The unit; empty for a pure number.
    pub unit: &'static str,
}

impl Parameter {
    const fn new(name: &'static str, unit: &'static str) -> Self {
        Self { name, unit }
    }
}

/// The covariance of the [`PARAMETERS`] of an estimated calibration.
#[derive(Clone, Debug, PartialEq)]
pub struct CalibrationCovariance {
    origin: DVec3,
    matrix: SMatrix<f64, COUNT, COUNT>,
}

impl CalibrationCovariance {
    /// Creates a covariance from its rows, in the units of the [`PARAMETERS`]. Parameters that are
    /// known have rows and columns of zeros. `origin` is the origin of the first board, in metres.
    ///
    /// # Errors
    ///
    /// Returns an error if a number is not finite, or if this is not a possible covariance: it is
    /// not symmetric, or has a variance that is negative beyond rounding.
    pub fn new(
        origin: DVec3,
        rows: &[[f64; PARAMETERS.len()]; PARAMETERS.len()],
    ) -> Result<Self, TriangulationError> {
        let matrix = SMatrix::<f64, COUNT, COUNT>::from_fn(|i, j| rows[i][j]);
        let allowed = "finite, symmetric and without negative variances";
        let refused = |value: f64| Refusal::new("covariance", value, allowed).into();
        let numbers = matrix.iter().copied().chain(origin.to_array());
        if let Some(value) = numbers.into_iter().find(|value| !value.is_finite()) {
            return Err(refused(value));
        }
        // The parameters differ in size by many orders: only the correlations count.
        let scales = matrix
            .diagonal()
            .map(|v| if v > 0.0 { 1.0 / v.sqrt() } else { 0.0 });
        let scaled = SMatrix::<f64, COUNT, COUNT>::from_fn(|i, j| {
            if i == j && matrix[(i, i)] <= 0.0 {
                matrix[(i, i)]
            } else {
                scales[i] * matrix[(i, j)] * scales[j]
            }
        });
        let unknown = |i: usize| scales[i] == 0.0 && matrix.row(i).amax() > 0.0;
        let asymmetry: f64 = (scaled - scaled.transpose()).amax();
        if asymmetry > ROUNDING || (0..COUNT).any(unknown) {
            return Err(refused(asymmetry));
        }
        let min = SymmetricEigen::new(scaled).eigenvalues.min();
        if min < -ROUNDING {
            return Err(refused(min));
        }
        Ok(Self { origin, matrix })
    }

    /// Returns the origin of the first board, in metres.
    pub const fn origin(&self) -> DVec3 {
        self.origin
    }

    /// Returns the covariance of two parameters, by their positions among the [`PARAMETERS`].
    ///
    /// # Panics
    ///
    /// Panics unless both positions are below the number of parameters.
    pub fn between(&self, one: usize, two: usize) -> f64 {
        self.matrix[(one, two)]
    }

    /// Returns the standard uncertainty of a parameter, by its position among the [`PARAMETERS`].
    ///
    /// # Panics
    ///
    /// Panics unless the position is below the number of parameters.
    pub fn standard_uncertainty(&self, parameter: usize) -> f64 {
        self.matrix[(parameter, parameter)].max(0.0).sqrt()
    }

    pub(super) const fn matrix(&self) -> &SMatrix<f64, COUNT, COUNT> {
        &self.matrix
    }

    /// Returns the covariance after a rigid motion of the set-up: its parameters are in the
    /// camera's axes.
    pub(super) fn moved(&self, motion: &RigidMotion) -> Self {
        Self {
            origin: motion.point(self.origin),
            matrix: self.matrix,
        }
    }
}

/// Tolerance for rounding in the test that correlations are a possible set: they come out of sums
/// of many products and an inversion.
const ROUNDING: f64 = 1e-6;
