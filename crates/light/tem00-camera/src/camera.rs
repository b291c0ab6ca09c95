mod distortion;
mod lens;
mod sensor;

use glam::{DMat3, DVec2, DVec3};
use tem00_decorrelation::{ImagingGeometry, LensData, RigidMotion};
use tem00_numerics::check;

use self::{distortion::Distortion, sensor::Sensor};
use crate::{CameraDescription, Ray, Refusal};

pub use self::lens::{CameraConnection, CameraRay};

/// The sine of the smallest accepted angle between `up` and the viewing direction.
const MIN_SINE: f64 = 1e-6;

/// Margin around the image, in pixels, within which image points are accepted: the largest radius
/// of a reconstruction filter.
pub const IMAGE_MARGIN: f64 = 16.0;

/// A perspective camera with a thin lens and a sensor, from which the speckle size follows.
///
/// Rays start at points of the lens, which is the entrance pupil, and all rays of one image point
/// meet again in the plane in focus. The image distance of the lens determines the perspective; its
/// diameter determines the blur and the speckle.
///
/// ```text
/// d_PI = f L / (L − f)      image distance for the focus distance L
/// D    = f / F              diameter of the pupil, F the f-number
/// ```
///
/// Image points are given in pixels, `(0, 0)` at the upper left corner of the image, x to the right
/// and y *down*; the centre of the first pixel is `(0.5, 0.5)`. The image is upright. The sensor
/// may be decentred, by its principal point, and [tilted](crate::SensorTilt); the lens may
/// [distort](crate::RadialDistortion) the image. Without tilt the axis is normal to the sensor.
///
/// The value of a pixel is the mean radiance, over its area and over the pupil: a scene of uniform
/// radiance L has the value L in every pixel. The irradiance on the sensor is a different quantity,
/// see [`irradiance_per_radiance`](Self::irradiance_per_radiance).
///
/// # Validity
///
/// The lens is ideal except for its distortion: all rays of an image point meet in one point, at
/// the distance along the axis that the lens equation gives for the depth of the image point. There
/// is no vignetting, and the pupil is a disc across the axis. Image points may lie up to 16 pixels
/// beyond the edges of the image.
///
/// The [front page](crate) has an example.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Camera {
    description: CameraDescription,
    right: DVec3,
    up: DVec3,
    view: DVec3,
    sensor: Sensor,
    distortion: Distortion,
}

impl Camera {
    /// Creates a camera.
    ///
    /// # Errors
    ///
    /// Returns an error if a length is not positive and finite, if the f-number is below 0.5, if
    /// the focus distance does not exceed the focal length, if the camera looks at itself or along
    /// `up`, if the image is empty or has more than [`MAXIMUM_PIXELS`](crate::MAXIMUM_PIXELS)
    /// pixels, if the tilt is so large that a part of the pupil sees the back of the sensor or a
    /// part of the image lies before the lens, or if the distortion folds a part of the image back.
    pub fn new(description: CameraDescription) -> Result<Self, Refusal> {
        description.check()?;
        let view = (description.look_at - description.position)
            .try_normalize()
            .ok_or_else(|| {
                let allowed = "a point other than the camera's position";
                Refusal::new("look_at", description.look_at.to_array(), allowed).in_unit("m")
            })?;
        let across = view.cross(description.up.normalize_or_zero());
        // For parallel directions, rounding leaves a product of about 1e−16.
        let right = (across.length() > MIN_SINE)
            .then(|| across.normalize())
            .ok_or_else(|| {
                let allowed = "a direction across the viewing direction";
                Refusal::new("up", description.up.to_array(), allowed)
            })?;
        let camera = Self {
            description,
            right,
            up: right.cross(view),
            view,
            sensor: Sensor::new(&description),
            distortion: Distortion::new(description.distortion),
        };
        camera.check_sensor()?;
        Ok(camera)
    }

    /// Returns the description from which the camera was created.
    pub const fn description(&self) -> &CameraDescription {
        &self.description
    }

    /// Returns the number of pixel columns.
    pub const fn width(&self) -> usize {
        self.description.resolution[0]
    }

    /// Returns the number of pixel rows.
    pub const fn height(&self) -> usize {
        self.description.resolution[1]
    }

    /// Returns the centre of the entrance pupil, in metres.
    pub const fn position(&self) -> DVec3 {
        self.description.position
    }

    /// Returns the distance from the lens to the sensor along the axis, in metres.
    pub const fn image_distance(&self) -> f64 {
        self.sensor.distance
    }

    /// Returns the diameter of the entrance pupil, in metres.
    pub const fn pupil_diameter(&self) -> f64 {
        self.description.focal_length / self.description.f_number
    }

    /// Returns the camera axes as columns: right, up, and from the scene towards the camera.
    pub fn axes(&self) -> DMat3 {
        DMat3::from_cols(self.right, self.up, -self.view)
    }

    /// Returns the plane that is in focus: where the axis meets it, in metres, and its unit normal
    /// towards the camera.
    ///
    /// It meets the planes of the lens and of the sensor in one line (Scheimpflug's rule). If the
    /// lens distorts and the sensor is tilted, the surface in focus is curved.
    pub fn plane_in_focus(&self) -> (DVec3, DVec3) {
        let focus_distance = self.description.focus_distance;
        let DVec3 { x, y, z } = self.sensor.normal;
        let normal = DVec3::new(x, y, -z * self.sensor.distance / focus_distance);
        (
            self.position() + focus_distance * self.view,
            self.world(normal.normalize()),
        )
    }

    /// Returns the imaging geometry for a wavelength in metres, on the axis.
    ///
    /// # Errors
    ///
    /// Returns an error if the wavelength is not positive and finite or exceeds the pupil.
    pub fn imaging_geometry(&self, wavelength: f64) -> Result<ImagingGeometry, Refusal> {
        self.geometry_for(wavelength, self.description.focus_distance)
    }

    /// Returns the imaging geometry at an image point, for a wavelength in metres. On a tilted
    /// sensor it varies over the image.
    ///
    /// ```text
    /// h = λ s / D      speckle size, s the depth of the image point behind the lens
    /// ```
    ///
    /// # Validity
    ///
    /// Distances are measured along the axis. On a sensor tilted by τ the speckle is stretched by
    /// 1/cos τ across the line about which it is tilted; that stretch is not part of the geometry.
    ///
    /// # Errors
    ///
    /// Returns an error if the wavelength is not positive and finite or exceeds the pupil, or if no
    /// real point is in focus at the image point, as above the horizon of the plane in focus.
    pub fn imaging_geometry_at(
        &self,
        pixel: DVec2,
        wavelength: f64,
    ) -> Result<ImagingGeometry, Refusal> {
        let depth = self.sensor.point(pixel).z;
        let CameraDescription {
            focal_length,
            focus_distance,
            ..
        } = self.description;
        // On the axis the lens equation would give the focus distance only up to rounding.
        let offset = depth - self.sensor.distance;
        let beyond_focus = self.sensor.distance * focal_length / focus_distance + offset;
        let in_focus = focus_distance - (focus_distance - focal_length) * offset / beyond_focus;
        self.geometry_for(wavelength, in_focus)
    }

    /// Returns the vergence 1/L at an image point, in 1/m, of the object point in focus at the
    /// distance L along the axis. It is not positive where no real point is in focus.
    pub fn focus_vergence_at(&self, pixel: DVec2) -> f64 {
        self.description.focal_length.recip() - self.sensor.point(pixel).z.recip()
    }

    /// Returns the tangents of the viewing angle at an image point, horizontally to the right and
    /// vertically up.
    pub fn tangents_at(&self, pixel: DVec2) -> DVec2 {
        let chief = self.chief(pixel);
        chief.truncate() / chief.z
    }

    /// Returns the ray that arrives at the image point `pixel` through the centre of the lens.
    pub fn ray(&self, pixel: DVec2) -> Ray {
        Ray {
            origin: self.position(),
            direction: self.world(self.chief(pixel)).normalize(),
        }
    }

    /// Returns the direction of the ray through the centre of the lens that arrives at an image
    /// point, one metre along the axis, and its derivatives with respect to the image point, per
    /// pixel to the right and per pixel down; all in world axes.
    ///
    /// Returns `None` for an image point that no ray reaches.
    pub fn sight(&self, pixel: DVec2) -> Option<(DVec3, [DVec3; 2])> {
        let (depth, tangent) = self.seen_by(pixel)?;
        let position = self.sensor.point(pixel);
        let undo = self.distortion.jacobian(tangent).inverse();
        // The tangent of the image point is position.xy / position.z.
        let derivative = |step: DVec3| {
            let image = (step.truncate() - step.z / depth * position.truncate()) / depth;
            self.world((undo * image).extend(0.0))
        };
        let direction = self.world(tangent.extend(1.0));
        Some((direction, self.sensor.steps().map(derivative)))
    }

    /// Returns the image point of a point in space, by the ray through the centre of the lens.
    ///
    /// It may lie outside of the image. Returns `None` if the point lies behind the lens, if its
    /// ray misses the sensor, or if the distortion would fold it back into the image.
    pub fn project(&self, point: DVec3) -> Option<DVec2> {
        let offset = self.local(point - self.position());
        if offset.z <= 0.0 {
            return None;
        }
        let tangent = self.distortion.distorted(offset.truncate() / offset.z)?;
        self.sensor.pixel(tangent)
    }

    /// Returns the solid angle, in steradian, that one pixel at the image point `pixel` sees from
    /// the centre of the lens.
    ///
    /// ```text
    /// Ω = pitch² cos³θ / d_PI²                              θ the angle to the axis
    /// Ω = pitch² cos³θ d_PI cos τ / (s³ det ∂t_image/∂t)    tilted by τ, with distortion
    /// ```
    pub fn solid_angle_per_pixel(&self, pixel: DVec2) -> f64 {
        let Some((depth, tangent)) = self.seen_by(pixel) else {
            return 0.0;
        };
        let cosine = 1.0 / (1.0 + tangent.length_squared()).sqrt();
        let stretch = self.distortion.jacobian(tangent).determinant();
        self.sensor.tangents_per_pixel(depth) * cosine.powi(3) / stretch
    }

    /// Returns the irradiance on the sensor, in W/m², per radiance of the surface that the pixel
    /// sees, in W/(m² sr).
    ///
    /// ```text
    /// E/L = π D²/4 · cos θ Ω / pitch²                in general: what enters the pupil arrives
    /// E/L = π/4 (D/d_PI)² cos⁴θ                      the cos⁴ law, without tilt and distortion
    /// E/L = π D²/4 · cos θ cos θ_sensor / distance²  with tilt, without distortion
    /// ```
    ///
    /// # Validity
    ///
    /// The pupil is small against its distance to the sensor: the error is of the order of the
    /// square of the pupil radius over this distance, 0.3 % at f/8. No light is lost in the lens.
    ///
    /// # Examples
    ///
    /// On the axis only the working f-number N matters: E/L is π / (4 N²).
    ///
    /// ```
    /// # use glam::{DVec2, DVec3};
    /// # use tem00_camera::{Camera, CameraDescription, RadialDistortion, SensorTilt};
    /// # let camera = Camera::new(CameraDescription {
    /// #     position: DVec3::new(0.0, 0.0, 0.3),
    /// #     look_at: DVec3::ZERO,
    /// #     up: DVec3::Y,
    /// #     focal_length: 25e-3,
    /// #     f_number: 8.0,
    /// #     focus_distance: 0.3,
    /// #     pixel_pitch: 3.45e-6,
    /// #     resolution: [640, 480],
    /// #     principal_point: None,
    /// #     tilt: SensorTilt::default(),
    /// #     distortion: RadialDistortion::default(),
    /// #     depth_of_field: true,
    /// # })?;
    /// let working_f_number = camera.imaging_geometry(650e-9)?.working_f_number();
    /// assert!((working_f_number - 8.727).abs() < 0.001);
    ///
    /// let on_axis = camera.irradiance_per_radiance(DVec2::new(320.0, 240.0));
    /// assert!((on_axis - 0.010_312).abs() < 0.000_001); // sr
    /// # Ok::<(), tem00_camera::Refusal>(())
    /// ```
    pub fn irradiance_per_radiance(&self, pixel: DVec2) -> f64 {
        let radius = 0.5 * self.pupil_diameter();
        let chief = self.chief(pixel);
        let cosine = chief.z / chief.length();
        let pitch = self.description.pixel_pitch;
        let pupil_area = core::f64::consts::PI * radius * radius;
        pupil_area * cosine * self.solid_angle_per_pixel(pixel) / (pitch * pitch)
    }

    /// Returns the camera moved as a rigid body.
    #[must_use]
    pub fn moved(&self, motion: &RigidMotion) -> Self {
        let mut moved = *self;
        moved.description.position = motion.point(self.description.position);
        moved.description.look_at = motion.point(self.description.look_at);
        moved.description.up = motion.direction(self.description.up);
        moved.right = motion.direction(self.right);
        moved.up = motion.direction(self.up);
        moved.view = motion.direction(self.view);
        moved
    }

    /// Returns the direction of the chief ray in the axes of the camera, of any length.
    fn chief(&self, pixel: DVec2) -> DVec3 {
        let position = self.sensor.point(pixel);
        if self.distortion.is_none() || position.z <= 0.0 {
            return position;
        }
        let tangent = self
            .distortion
            .undistorted(position.truncate() / position.z);
        (position.z * tangent).extend(position.z)
    }

    /// Returns the depth of an image point and the tangent of its chief ray, or `None` before the
    /// lens and where distortion has no ray.
    fn seen_by(&self, pixel: DVec2) -> Option<(f64, DVec2)> {
        let position = self.sensor.point(pixel);
        let image = position.truncate() / position.z;
        (position.z > 0.0 && image.length() < self.distortion.reach())
            .then(|| (position.z, self.distortion.undistorted(image)))
    }

    fn geometry_for(
        &self,
        wavelength: f64,
        surface_to_pupil: f64,
    ) -> Result<ImagingGeometry, Refusal> {
        ImagingGeometry::from_lens(LensData {
            wavelength,
            focal_length: self.description.focal_length,
            f_number: self.description.f_number,
            surface_to_pupil,
            pixel_pitch: self.description.pixel_pitch,
        })
    }

    /// Checks that each image point lies behind the lens, on the front of the sensor, and has one
    /// ray.
    fn check_sensor(&self) -> Result<(), Refusal> {
        let tilt = self.description.tilt.angle;
        let steepest = self.sensor.slope().length() * 0.5 * self.pupil_diameter();
        let allowed = "small enough for the whole pupil to see the front of the sensor";
        check::that(steepest < 1.0, "tilt", tilt, "rad", allowed)?;
        let size = self.description.size() + IMAGE_MARGIN;
        let corners = [
            DVec2::splat(-IMAGE_MARGIN),
            DVec2::new(size.x, -IMAGE_MARGIN),
            DVec2::new(-IMAGE_MARGIN, size.y),
            size,
        ];
        for position in corners.map(|corner| self.sensor.point(corner)) {
            let allowed = "small enough for the whole image to lie behind the lens";
            check::that(position.z > 0.0, "tilt", tilt, "rad", allowed)?;
            let radius = position.truncate().length() / position.z;
            let reach = self.distortion.reach();
            let holds = self.distortion.is_none() || radius < reach;
            let allowed = "monotonic up to the corners of the image";
            check::that(holds, "distortion", reach, "", allowed)?;
        }
        Ok(())
    }

    /// Returns the world components of a vector in the axes right, up and along the view.
    #[inline(always)]
    fn world(&self, local: DVec3) -> DVec3 {
        local.x * self.right + local.y * self.up + local.z * self.view
    }

    /// Returns the components right, up and along the view of a vector in world components.
    fn local(&self, world: DVec3) -> DVec3 {
        DVec3::new(
            world.dot(self.right),
            world.dot(self.up),
            world.dot(self.view),
        )
    }
}

#[cfg(test)]
mod tests;
