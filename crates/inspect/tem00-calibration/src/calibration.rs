use glam::{DMat3, DVec2, DVec3};
use nalgebra::SMatrix;
use tem00_camera::Camera;
use tem00_decorrelation::RigidMotion;

use crate::{CalibrationCovariance, covariance::COUNT, perturbation::Perturbations};
use tem00_triangulation::{LaserPlane, TriangulationError, Triangulator};

/// A calibrated set-up: its camera and its laser plane, and how well they are known.
///
/// A calibration is [exact](Self::exact), as a simulation knows its own scene, or estimated from
/// images of a checkerboard and of the laser line on it, with the covariance of its
/// [`PARAMETERS`](crate::PARAMETERS).
///
/// The errors of a calibration are common to all points that are measured with it: they do not
/// average out, but they hardly affect the difference of neighbouring heights, see
/// [`step_uncertainty`](Self::step_uncertainty).
#[derive(Clone, Debug, PartialEq)]
pub struct Calibration {
    triangulator: Triangulator,
    uncertainty: Option<Box<Uncertainty>>,
    quality: Option<CalibrationQuality>,
}

/// Data that the uncertainty of points is computed from.
#[derive(Clone, Debug, PartialEq)]
struct Uncertainty {
    covariance: CalibrationCovariance,
    perturbations: Perturbations,
}

/// Residuals of images of a checkerboard and of the line on it, against the calibration that they
/// gave.
#[cfg_attr(feature = "serde", derive(serde::Deserialize, serde::Serialize))]
#[cfg_attr(feature = "serde", serde(deny_unknown_fields))]
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct CalibrationQuality {
    /// The number of boards.
    pub boards: usize,
    /// The number of corners in the images of all boards.
    pub corners: usize,
    /// The root mean square of the distances of the corners from their expected positions, in
    /// pixels.
    pub rms_reprojection: f64,
    /// The number of points of the line from which the plane follows.
    pub line_points: usize,
    /// The number of points of the line that lay too far from the plane and were left out.
    pub outliers: usize,
    /// The root mean square of the distances of the points of the line from the plane, in metres.
    pub rms_plane: f64,
}

impl Calibration {
    /// Creates the calibration of a camera and a laser plane that are known without error.
    pub const fn exact(camera: Camera, plane: LaserPlane) -> Self {
        Self {
            triangulator: Triangulator::new(camera, plane),
            uncertainty: None,
            quality: None,
        }
    }

    /// Returns the calibration with the covariance of its parameters.
    ///
    /// # Errors
    ///
    /// Returns an error if a camera whose parameters differ by a hundred-thousandth of their
    /// estimates is not possible: the calibration stands at the edge of its range.
    pub fn with_covariance(
        self,
        covariance: CalibrationCovariance,
    ) -> Result<Self, TriangulationError> {
        let perturbations = Perturbations::new(self.camera(), &covariance)?;
        let uncertainty = Uncertainty {
            covariance,
            perturbations,
        };
        Ok(Self {
            uncertainty: Some(Box::new(uncertainty)),
            ..self
        })
    }

    /// Returns the calibration with the residuals that show its quality.
    #[must_use]
    pub fn with_quality(self, quality: CalibrationQuality) -> Self {
        Self {
            quality: Some(quality),
            ..self
        }
    }

    /// Returns the geometry that turns image points into points in space.
    pub const fn triangulator(&self) -> &Triangulator {
        &self.triangulator
    }

    /// Returns the camera.
    pub const fn camera(&self) -> &Camera {
        self.triangulator.camera()
    }

    /// Returns the laser plane.
    pub const fn plane(&self) -> &LaserPlane {
        self.triangulator.plane()
    }

    /// Returns the covariance of the parameters, if the calibration was estimated.
    pub fn covariance(&self) -> Option<&CalibrationCovariance> {
        self.uncertainty.as_ref().map(|known| &known.covariance)
    }

    /// Returns the residuals of the images, if the calibration was estimated.
    pub const fn quality(&self) -> Option<&CalibrationQuality> {
        self.quality.as_ref()
    }

    /// Returns the covariance, in m², that the calibration gives to the point seen at an image
    /// point, or `None` where there is no point. It is zero for an exact calibration.
    pub fn point_covariance(&self, pixel: DVec2) -> Option<DMat3> {
        let Some(known) = &self.uncertainty else {
            return self.triangulator.point(pixel).map(|_| DMat3::ZERO);
        };
        let sensitivities = self.sensitivities(known, pixel)?;
        let covariance = sensitivities * known.covariance.matrix() * sensitivities.transpose();
        Some(DMat3::from_cols_array(
            &covariance.data.0.concat().try_into().ok()?,
        ))
    }

    /// Returns the standard uncertainty of the height of a point of the laser plane by the
    /// calibration, in metres, or `None` if the camera does not see the point.
    ///
    /// Heights are along `up`, a direction of any length. They are counted from the world's origin,
    /// which is the origin of the first board for an estimated calibration.
    pub fn height_uncertainty(&self, point: DVec3, up: DVec3) -> Option<f64> {
        let Some(known) = &self.uncertainty else {
            return self.camera().project(point).map(|_| 0.0);
        };
        self.sensitivities(known, self.camera().project(point)?)
            .map(|sensitivities| known.along(sensitivities, up))
    }

    /// Returns the standard uncertainty of the difference of the heights of two points of the laser
    /// plane by the calibration, in metres, or `None` if the camera does not see one of them.
    ///
    /// An error that moves both points alike cancels.
    pub fn step_uncertainty(&self, points: [DVec3; 2], up: DVec3) -> Option<f64> {
        let [one, two] = points.map(|point| self.camera().project(point));
        let Some(known) = &self.uncertainty else {
            return one.and(two).map(|_| 0.0);
        };
        let difference = self.sensitivities(known, two?)? - self.sensitivities(known, one?)?;
        Some(known.along(difference, up))
    }

    /// Returns the calibration of the set-up carried along by a rigid motion.
    ///
    /// # Errors
    ///
    /// Returns an error if the motion takes the laser plane out of the range of numbers.
    pub fn moved(&self, motion: &RigidMotion) -> Result<Self, TriangulationError> {
        let plane = LaserPlane::new(
            motion.point(self.plane().point()),
            motion.direction(self.plane().normal()),
        )?;
        let moved = Self {
            triangulator: Triangulator::new(self.camera().moved(motion), plane),
            uncertainty: None,
            quality: self.quality,
        };
        match self.covariance() {
            Some(covariance) => moved.with_covariance(covariance.moved(motion)),
            None => Ok(moved),
        }
    }

    /// Returns by how much the point seen at an image point moves with each parameter.
    fn sensitivities(&self, known: &Uncertainty, pixel: DVec2) -> Option<SMatrix<f64, 3, COUNT>> {
        known
            .perturbations
            .of_point(&self.triangulator, known.covariance.origin(), pixel)
    }
}

impl Uncertainty {
    /// Returns the standard uncertainty of a quantity that moves with the parameters, along `up`.
    fn along(&self, sensitivities: SMatrix<f64, 3, COUNT>, up: DVec3) -> f64 {
        let up = up.normalize_or_zero();
        let row = SMatrix::<f64, 1, 3>::new(up.x, up.y, up.z) * sensitivities;
        let variance = (row * self.covariance.matrix() * row.transpose())[0];
        // Rounding can take a variance of zero below it.
        variance.max(0.0).sqrt()
    }
}

#[cfg(test)]
mod tests;
