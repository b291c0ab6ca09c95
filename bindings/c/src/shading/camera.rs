use tem00_shading::{DVec2, DVec3, ShadingError};

use super::Camera;
use crate::{
    numbers::read_point,
    pointers::borrow,
    status::{Failure, Status},
};

/// Parameters of a camera: a thin lens, and a sensor behind it. With 0 in the last three fields the
/// axis of the lens meets the middle of the image, without tilt or distortion.
#[repr(C)]
#[derive(Clone, Copy, Debug)]
pub struct CameraDescription {
    /// Centre of the lens, which is its entrance pupil, in metres.
    pub position: [f64; 3],
    /// A point on the axis of the lens, in metres.
    pub look_at: [f64; 3],
    /// A direction that points up in the image.
    pub up: [f64; 3],
    /// Focal length of the lens, in metres.
    pub focal_length: f64,
    /// F-number, at least 0.5: focal length over the diameter of the entrance pupil.
    pub f_number: f64,
    /// Distance along the axis from the lens to what is in focus there, in metres.
    pub focus_distance: f64,
    /// Distance between the centres of neighbouring pixels on the sensor, in metres.
    pub pixel_pitch: f64,
    /// Numbers of pixel columns and rows.
    pub resolution: [usize; 2],
    /// Image point on the axis of the lens, from the middle of the image, in pixels with y down.
    pub principal_offset: [f64; 2],
    /// Angle by which the sensor is tilted, right-handed about a line in it, and the azimuth of
    /// that line, from the right of the image towards its top; both in radians.
    pub tilt: [f64; 2],
    /// Coefficients k1, k2 and k3 of the radial distortion, with the signs of `OpenCV`.
    pub distortion: [f64; 3],
}

impl CameraDescription {
    fn camera(&self) -> Result<Camera, Failure> {
        let [position, look_at, up] = [self.position, self.look_at, self.up].map(DVec3::from_array);
        let [width, height] = self.resolution;
        let middle = DVec2::new(width as f64, height as f64) / 2.0;
        let mut description = tem00_shading::CameraDescription {
            position,
            look_at,
            up,
            focal_length: self.focal_length,
            f_number: self.f_number,
            focus_distance: self.focus_distance,
            pixel_pitch: self.pixel_pitch,
            resolution: self.resolution,
            principal_point: Some(middle + DVec2::from_array(self.principal_offset)),
            ..tem00_shading::CameraDescription::default()
        };
        let (tilt, bent) = (&mut description.tilt, &mut description.distortion);
        [tilt.angle, tilt.azimuth] = self.tilt;
        [bent.k1, bent.k2, bent.k3] = self.distortion;
        let camera = tem00_shading::Camera::new(description).map_err(ShadingError::from);
        camera.map(Camera).map_err(|error| match error.parameter() {
            Some("principal_point") => Failure::argument(
                "principal_offset",
                format!(
                    "principal_offset must be finite, in pixels, got {:?}",
                    self.principal_offset
                ),
            ),
            _ => error.into(),
        })
    }
}

/// Creates a camera.
///
/// On failure `*camera` is null.
///
/// # Safety
///
/// The pointers are null or valid.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn tem00_camera_create(
    description: *const CameraDescription,
    camera: *mut *mut Camera,
) -> Status {
    create!(description: borrow => camera: description.camera())
}

/// Computes where in the image a point is seen, to be compared with where the renderer's own camera
/// sees it.
///
/// `point` holds x, y, z in metres; it is refused where the camera cannot see it. `pixel` receives
/// x and y in pixels, y down, from the upper left corner of the image; it may lie outside.
///
/// # Safety
///
/// The pointers are null or valid, `point` for three numbers and `pixel` for two.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn tem00_camera_project(
    camera: *const Camera,
    point: *const f64,
    pixel: *mut f64,
) -> Status {
    let pixel = pixel.cast::<[f64; 2]>();
    answer!(camera: borrow, point: read_point => pixel: {
        let seen = camera.0.project(DVec3::from_array(point));
        let message = format!("point must be in sight of the camera, got {point:?}");
        seen.ok_or_else(|| Failure::argument("point", message))?.to_array()
    })
}
