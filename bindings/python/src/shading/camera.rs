use tem00_shading::{self as physics, CameraDescription, DVec2, ShadingError};

use super::{LIMIT, vector};
use crate::{
    arrays::{Array, Components, Floats, Vectors, Whole, map_inner},
    error::OrRaise,
};

class! {
    /// A camera: a thin lens, and a sensor that may be tilted.
    ///
    /// What is left out is that of a lens of 25 mm at f/8 and 640 × 480 pixels of 3.45 µm, 0.3 m
    /// above the origin, which it looks at and has in focus.
    ///
    /// Parameters
    /// ----------
    /// position : array_like, shape (3,), optional
    ///     Centre of the lens, in metres.
    /// look_at : array_like, shape (3,), optional
    ///     A point on the axis of the lens, in metres.
    /// up : array_like, shape (3,), optional
    ///     A direction that points up in the image.
    /// focal_length : float, optional
    ///     Focal length of the lens, in metres.
    /// f_number : float, optional
    ///     Focal length by diameter of the entrance pupil.
    /// focus_distance : float, optional
    ///     Distance from the lens along its axis to what is in focus there, in metres.
    /// pixel_pitch : float, optional
    ///     Distance between the centres of neighbouring pixels, in metres.
    /// resolution : (int, int), optional
    ///     Numbers of pixel columns and rows.
    /// principal_point : array_like, shape (2,), optional
    ///     Image point on the axis of the lens, in pixels; the middle of the image if left out.
    /// tilt : array_like, shape (2,), optional
    ///     Angle between the normal of the sensor and the axis of the lens, and the direction of
    ///     the line about which the sensor turns, from the right of the image towards its top; in
    ///     radians.
    /// distortion : array_like, shape (3,), optional
    ///     Coefficients k₁, k₂ and k₃ of the radial distortion, with the signs of OpenCV.
    /// depth_of_field : bool, optional
    ///     Whether what is out of focus is blurred.
    "tem00.shading" Camera(physics::Camera): Copy
}

fn plain() -> CameraDescription {
    CameraDescription::default()
}

methods! {
    impl Camera as this: this.0;

    #[new]
    #[pyo3(signature = (
        *,
        position = None,
        look_at = None,
        up = None,
        focal_length = plain().focal_length,
        f_number = plain().f_number,
        focus_distance = plain().focus_distance,
        pixel_pitch = plain().pixel_pitch,
        resolution = None,
        principal_point = None,
        tilt = None,
        distortion = None,
        depth_of_field = true,
    ))]
    build new(_py;
        position: Option<Components<'py>>, look_at: Option<Components<'py>>,
        up: Option<Components<'py>>, focal_length: f64, f_number: f64, focus_distance: f64,
        pixel_pitch: f64, resolution: Option<[Whole<'py>; 2]>,
        principal_point: Option<Components<'py>>, tilt: Option<Components<'py>>,
        distortion: Option<Components<'py>>, depth_of_field: bool
    ) = {
        let plain = plain();
        let mut description = CameraDescription {
            position: vector("position", position.as_ref(), plain.position.into())?.into(),
            look_at: vector("look_at", look_at.as_ref(), plain.look_at.into())?.into(),
            up: vector("up", up.as_ref(), plain.up.into())?.into(),
            focal_length,
            f_number,
            focus_distance,
            pixel_pitch,
            depth_of_field,
            ..plain
        };
        if let Some([width, height]) = resolution {
            let name = "resolution";
            description.resolution = [width.unsigned(name)?, height.unsigned(name)?];
        }
        if let Some(point) = principal_point {
            description.principal_point = Some(point.vector("principal_point")?.into());
        }
        [description.tilt.angle, description.tilt.azimuth] =
            vector("tilt", tilt.as_ref(), [0.0; 2])?;
        let coefficients = &mut description.distortion;
        [coefficients.k1, coefficients.k2, coefficients.k3] =
            vector("distortion", distortion.as_ref(), [0.0; 3])?;
        let camera = physics::Camera::new(description).map_err(ShadingError::from);
        Ok(Self(camera.or_raise()?))
    };

    /// Return the rays that arrive at image points through the centre of the lens.
    ///
    /// Parameters
    /// ----------
    /// pixels : array_like, shape (..., 2)
    ///     Image points, in pixels with y down; the centre of the first pixel is (0.5, 0.5).
    ///
    /// Returns
    /// -------
    /// origin : ndarray, shape (3,)
    ///     The centre of the lens, in metres.
    /// direction : ndarray, shape (..., 3)
    ///     Unit vectors into the scene.
    call ray(py; pixels: Vectors<'py>) -> (Floats, Array<'py>) = {
        let pixels = columns!(f64::MAX; pixels: 2);
        let direction = map_inner(py, pixels, &[3], |pixel| {
            this.0.ray(DVec2::from(pixel)).direction.to_array()
        })?;
        Ok((this.0.position().into(), direction))
    };

    /// Return the image points at which points are seen through the centre of the lens.
    ///
    /// Parameters
    /// ----------
    /// points : array_like, shape (..., 3)
    ///     Points, in metres.
    ///
    /// Returns
    /// -------
    /// ndarray, shape (..., 2)
    ///     Image points, in pixels with y down, also beside the image; infinite where the camera
    ///     cannot see.
    over project(points: 3) -> [2] = |point| {
        let seen = this.0.project(point.into()).filter(|pixel| pixel.is_finite());
        seen.unwrap_or(DVec2::INFINITY).to_array()
    };

    /// Centre of the lens, in metres, shape (3,).
    get position -> Floats;

    /// Numbers of pixel columns and rows.
    get resolution -> (usize, usize) = this.0.description().resolution;

    /// Focal length of the lens, in metres.
    get focal_length -> f64 = this.0.description().focal_length;

    /// Focal length by diameter of the entrance pupil.
    get f_number -> f64 = this.0.description().f_number;

    shown resolution, position, focal_length, f_number;
}
