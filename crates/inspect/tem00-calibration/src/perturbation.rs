use glam::{DMat3, DVec2, DVec3};
use nalgebra::{SMatrix, Vector3};
use tem00_camera::{Camera, CameraDescription, SensorTilt};

use crate::covariance::{COUNT, CalibrationCovariance};
use tem00_triangulation::{TriangulationError, Triangulator};

/// The number of parameters within the camera, which come first.
pub(super) const INTRINSICS: usize = 8;

/// The fraction of the standard uncertainty of a parameter by which it is changed to find its
/// effect.
///
/// The error of the central difference is in the order of its square, and the rounding error is of
/// the order of 1e−16 divided by it.
const SHARE: f64 = 1e-3;

/// The cameras that differ from a calibrated one in a single parameter.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Perturbations {
    /// For each parameter of the camera that is uncertain: its position, the cameras with less and
    /// more of it, and the difference between them.
    cameras: Vec<(usize, [Camera; 2], f64)>,
}

impl Perturbations {
    pub(super) fn new(
        camera: &Camera,
        covariance: &CalibrationCovariance,
    ) -> Result<Self, TriangulationError> {
        let mut cameras = Vec::new();
        for parameter in 0..INTRINSICS {
            let step = SHARE * covariance.standard_uncertainty(parameter);
            if step > 0.0 {
                let changed = |by| Camera::new(changed(camera, parameter, by));
                cameras.push((parameter, [changed(-step)?, changed(step)?], 2.0 * step));
            }
        }
        Ok(Self { cameras })
    }

    /// Returns by how much the point that `triangulator` sees at an image point moves with each
    /// parameter, or `None` where it or one of the changed cameras sees none.
    ///
    /// ```text
    /// ∂P = −ω × (P − O) − τ                 the board turns by ω about its origin O and moves by τ
    /// ∂P = d (δo − δn·(P − Q)) / (n·d)      the plane's normal changes by δn, the plane moves by
    ///                                       δo
    /// ```
    pub(super) fn of_point(
        &self,
        triangulator: &Triangulator,
        origin: DVec3,
        pixel: DVec2,
    ) -> Option<SMatrix<f64, 3, COUNT>> {
        let point = triangulator.point(pixel)?;
        let mut columns = [DVec3::ZERO; COUNT];
        let plane = triangulator.plane();
        for (parameter, cameras, step) in &self.cameras {
            let [less, more] = cameras.map(|camera| Triangulator::new(camera, *plane).point(pixel));
            columns[*parameter] = (more? - less?) / *step;
        }
        let axes = image_axes(triangulator.camera());
        let direction = triangulator.camera().ray(pixel).direction;
        let slide = direction / plane.normal().dot(direction);
        for (i, axis) in [axes.x_axis, axes.y_axis, axes.z_axis]
            .into_iter()
            .enumerate()
        {
            columns[INTRINSICS + i] = -axis.cross(point - origin);
            columns[INTRINSICS + 3 + i] = -axis;
            columns[INTRINSICS + 6 + i] = -slide * axis.dot(point - plane.point());
        }
        columns[COUNT - 1] = slide;
        let columns = columns.map(|column| Vector3::new(column.x, column.y, column.z));
        Some(SMatrix::<f64, 3, COUNT>::from_columns(&columns))
            .filter(|matrix| matrix.iter().all(|x| x.is_finite()))
    }
}

/// Returns the axes of the image in the world: to the right, down, along the view.
pub(super) fn image_axes(camera: &Camera) -> DMat3 {
    let axes = camera.axes();
    DMat3::from_cols(axes.x_axis, -axes.y_axis, -axes.z_axis)
}

/// Returns the tilt as a vector: its angle along the right of the image and along its top.
pub(super) fn tilt_vector(tilt: SensorTilt) -> DVec2 {
    tilt.angle * DVec2::from_angle(tilt.azimuth)
}

/// Returns the tilt that a vector stands for.
pub(super) fn tilt_of(vector: DVec2) -> SensorTilt {
    SensorTilt {
        angle: vector.length(),
        azimuth: if vector == DVec2::ZERO {
            0.0
        } else {
            vector.to_angle()
        },
    }
}

/// Returns the camera with one of its parameters changed.
fn changed(camera: &Camera, parameter: usize, by: f64) -> CameraDescription {
    let mut description = *camera.description();
    let principal = description.axis_point();
    let tilt = tilt_vector(description.tilt);
    match parameter {
        0 => {
            let image_distance = camera.image_distance() + by;
            description.focal_length = focal_length(image_distance, description.focus_distance);
        }
        1 => description.principal_point = Some(principal + by * DVec2::X),
        2 => description.principal_point = Some(principal + by * DVec2::Y),
        3 => description.tilt = tilt_of(tilt + by * DVec2::X),
        4 => description.tilt = tilt_of(tilt + by * DVec2::Y),
        5 => description.distortion.k1 += by,
        6 => description.distortion.k2 += by,
        _ => description.distortion.k3 += by,
    }
    description
}

/// Returns the focal length, in metres, that images the focus distance at the image distance.
///
/// ```text
/// 1/f = 1/L + 1/d_PI
/// ```
pub(super) fn focal_length(image_distance: f64, focus_distance: f64) -> f64 {
    image_distance * focus_distance / (image_distance + focus_distance)
}
