use glam::{DMat3, DVec2, DVec3};
use tem00_decorrelation::{ImagingGeometry, LensData};

use crate::{Ray, TracerError};

/// The most pixels an image may have: 2²⁸, which is 16 384 × 16 384.
pub const MAXIMUM_PIXELS: usize = 1 << 28;

/// The sine of the smallest accepted angle between `up` and the viewing direction.
const SMALLEST_SINE: f64 = 1e-6;

/// What determines a [`Camera`].
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct CameraDescription {
    /// The centre of the lens, which is its entrance pupil, in metres.
    pub position: DVec3,
    /// The point that appears in the middle of the image, in metres.
    pub look_at: DVec3,
    /// A direction that points up in the image.
    pub up: DVec3,
    /// The focal length of the lens, in metres.
    pub focal_length: f64,
    /// The f-number: focal length by diameter of the entrance pupil.
    pub f_number: f64,
    /// The distance from the lens, along the axis, to the plane that is in focus, in metres.
    pub focus_distance: f64,
    /// The pixel pitch, in metres.
    pub pixel_pitch: f64,
    /// The numbers of pixel columns and rows.
    pub resolution: [usize; 2],
}

/// A perspective camera with a thin lens and a sensor, from which the speckle size follows.
///
/// Rays start at the centre of the lens: everything is sharp. The lens decides the perspective, by
/// its image distance, and the speckle, by its pupil.
///
/// ```text
/// d_PI = f L / (L − f)      image distance for the focus distance L
/// ```
///
/// Image points are given in pixels, `(0, 0)` at the upper left corner of the image, x to the right
/// and y *down*; the centre of the first pixel is `(0.5, 0.5)`. The image is upright.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Camera {
    description: CameraDescription,
    right: DVec3,
    up: DVec3,
    view: DVec3,
    image_distance: f64,
}

impl Camera {
    /// Creates a camera.
    ///
    /// # Errors
    ///
    /// Returns an error if a length is not positive and finite, if the f-number is below 0.5, if the
    /// focus distance does not exceed the focal length, if the camera looks at itself or along `up`,
    /// or if the image is empty or has more than [`MAXIMUM_PIXELS`] pixels.
    pub fn new(description: CameraDescription) -> Result<Self, TracerError> {
        check_lengths(&description)?;
        let [width, height] = description.resolution;
        if width == 0
            || height == 0
            || width
                .checked_mul(height)
                .is_none_or(|pixels| pixels > MAXIMUM_PIXELS)
        {
            return Err(TracerError::Resolution { width, height });
        }
        let view = (description.look_at - description.position)
            .try_normalize()
            .ok_or(TracerError::Direction {
                parameter: "look_at",
                allowed: "a point other than the camera's position",
            })?;
        let across = view.cross(description.up.normalize_or_zero());
        // Rounding alone makes the product of parallel directions about 1e−16 long.
        let right = (across.length() > SMALLEST_SINE)
            .then(|| across.normalize())
            .ok_or(TracerError::Direction {
                parameter: "up",
                allowed: "a direction across the viewing direction",
            })?;
        let (focal_length, focus_distance) = (description.focal_length, description.focus_distance);
        Ok(Self {
            description,
            right,
            up: right.cross(view),
            view,
            image_distance: focal_length * focus_distance / (focus_distance - focal_length),
        })
    }

    /// Returns what the camera was created from.
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

    /// Returns the distance from the lens to the sensor, in metres.
    pub const fn image_distance(&self) -> f64 {
        self.image_distance
    }

    /// Returns the camera axes as columns: right, up, and from the scene towards the camera.
    pub fn axes(&self) -> DMat3 {
        DMat3::from_cols(self.right, self.up, -self.view)
    }

    /// Returns the imaging geometry for a wavelength in metres, at the plane in focus.
    ///
    /// # Errors
    ///
    /// Returns an error if the wavelength is not positive and finite.
    pub fn imaging_geometry(&self, wavelength: f64) -> Result<ImagingGeometry, TracerError> {
        Ok(ImagingGeometry::from_lens(LensData {
            wavelength,
            focal_length: self.description.focal_length,
            f_number: self.description.f_number,
            surface_to_pupil: self.description.focus_distance,
            pixel_pitch: self.description.pixel_pitch,
        })?)
    }

    /// Returns the ray that arrives at the image point `pixel`.
    pub fn ray(&self, pixel: DVec2) -> Ray {
        let sensor = self.sensor_point(pixel);
        Ray {
            origin: self.description.position,
            direction: (sensor.x * self.right
                + sensor.y * self.up
                + self.image_distance * self.view)
                .normalize(),
        }
    }

    /// Returns the image point of a point in space, or `None` if it lies behind the lens.
    pub fn project(&self, point: DVec3) -> Option<DVec2> {
        let offset = point - self.description.position;
        let depth = offset.dot(self.view);
        if depth <= 0.0 {
            return None;
        }
        let scale = self.image_distance / (depth * self.description.pixel_pitch);
        let centre = self.image_centre();
        Some(DVec2::new(
            centre.x + scale * offset.dot(self.right),
            centre.y - scale * offset.dot(self.up),
        ))
    }

    /// Returns the solid angle, in steradian, that one pixel at the image point `pixel` sees from
    /// the centre of the lens.
    ///
    /// ```text
    /// Ω = pitch² cos³θ / d_PI²      θ the angle to the axis
    /// ```
    pub fn solid_angle_per_pixel(&self, pixel: DVec2) -> f64 {
        let side = self.description.pixel_pitch / self.image_distance;
        let tangent = self.sensor_point(pixel) / self.image_distance;
        let cosine = 1.0 / (1.0 + tangent.length_squared()).sqrt();
        side * side * cosine.powi(3)
    }

    /// Returns the camera moved by `displacement`, in metres, without turning.
    #[must_use]
    pub fn translated(&self, displacement: DVec3) -> Self {
        let mut moved = *self;
        moved.description.position += displacement;
        moved.description.look_at += displacement;
        moved
    }

    /// The point of the upright image plane in metres, right and up from the axis.
    fn sensor_point(&self, pixel: DVec2) -> DVec2 {
        let offset = (pixel - self.image_centre()) * self.description.pixel_pitch;
        DVec2::new(offset.x, -offset.y)
    }

    #[expect(
        clippy::cast_precision_loss,
        reason = "an image has at most 2²⁸ pixels"
    )]
    fn image_centre(&self) -> DVec2 {
        DVec2::new(self.width() as f64, self.height() as f64) / 2.0
    }
}

fn check_lengths(description: &CameraDescription) -> Result<(), TracerError> {
    let lengths = [
        ("focal_length", description.focal_length),
        ("f_number", description.f_number),
        ("focus_distance", description.focus_distance),
        ("pixel_pitch", description.pixel_pitch),
    ];
    for (parameter, value) in lengths {
        if !(value > 0.0 && value.is_finite()) {
            return Err(TracerError::OutOfRange {
                parameter,
                value,
                allowed: "positive and finite",
            });
        }
    }
    if description.f_number < 0.5 {
        return Err(TracerError::OutOfRange {
            parameter: "f_number",
            value: description.f_number,
            allowed: "at least 0.5, the limit of an aplanatic lens",
        });
    }
    if description.focus_distance <= description.focal_length {
        return Err(TracerError::OutOfRange {
            parameter: "focus_distance",
            value: description.focus_distance,
            allowed: "greater than the focal length (in metres)",
        });
    }
    if !description.position.is_finite() || !description.look_at.is_finite() {
        return Err(TracerError::Direction {
            parameter: "look_at",
            allowed: "a finite point seen from a finite position",
        });
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use approx::assert_relative_eq;
    use proptest::prelude::*;

    use super::*;

    fn description() -> CameraDescription {
        CameraDescription {
            position: DVec3::new(0.1, -0.05, 0.3),
            look_at: DVec3::new(0.01, 0.02, 0.0),
            up: DVec3::Y,
            focal_length: 25e-3,
            f_number: 8.0,
            focus_distance: 0.3,
            pixel_pitch: 3.45e-6,
            resolution: [640, 480],
        }
    }

    #[test]
    fn the_axis_meets_the_middle_of_the_image() {
        let camera = Camera::new(description()).unwrap();
        let middle = camera.project(description().look_at).unwrap();
        assert_relative_eq!(middle.x, 320.0, epsilon = 1e-9);
        assert_relative_eq!(middle.y, 240.0, epsilon = 1e-9);
    }

    #[test]
    fn up_in_the_scene_is_up_in_the_image() {
        let camera = Camera::new(description()).unwrap();
        let above = camera
            .project(description().look_at + 1e-3 * DVec3::Y)
            .unwrap();
        assert!(above.y < 240.0, "y grows downwards, got {above}");
        let axes = camera.axes();
        assert_relative_eq!(axes.determinant(), 1.0, epsilon = 1e-12);
    }

    #[test]
    fn pixels_see_the_solid_angle_of_the_sensor() {
        let camera = Camera::new(description()).unwrap();
        // A rectangle of half sides a, b at distance d subtends 4 asin(ab/√((a²+d²)(b²+d²))).
        let (a, b, d) = (320.0 * 3.45e-6, 240.0 * 3.45e-6, camera.image_distance());
        let exact = 4.0 * (a * b / ((a * a + d * d) * (b * b + d * d)).sqrt()).asin();
        let mut sum = 0.0;
        for y in 0..480_u32 {
            for x in 0..640_u32 {
                let centre = DVec2::new(f64::from(x) + 0.5, f64::from(y) + 0.5);
                sum += camera.solid_angle_per_pixel(centre);
            }
        }
        // The midpoint rule errs by (pitch/d)²/24 · ∂²/∂x² cos³ ≈ 1e−9.
        assert_relative_eq!(sum, exact, max_relative = 1e-7);
    }

    #[test]
    fn impossible_cameras_are_rejected() {
        let bad = [
            CameraDescription {
                f_number: 0.0,
                ..description()
            },
            CameraDescription {
                pixel_pitch: f64::NAN,
                ..description()
            },
            CameraDescription {
                focus_distance: 25e-3,
                ..description()
            },
            CameraDescription {
                resolution: [0, 480],
                ..description()
            },
            CameraDescription {
                resolution: [1 << 40, 1 << 40],
                ..description()
            },
            CameraDescription {
                look_at: description().position,
                ..description()
            },
            CameraDescription {
                up: description().look_at - description().position,
                ..description()
            },
        ];
        for description in bad {
            assert!(Camera::new(description).is_err(), "{description:?}");
        }
    }

    #[test]
    fn up_along_the_view_is_rejected_in_spite_of_rounding() {
        let oblique = CameraDescription {
            position: DVec3::new(0.1, 0.2, 0.3),
            look_at: DVec3::new(0.03, 0.0, 0.0),
            up: DVec3::new(0.7, 2.0, 3.0),
            ..description()
        };
        assert!(Camera::new(oblique).is_err(), "{:?}", Camera::new(oblique));
    }

    proptest! {
        #[test]
        fn projection_inverts_the_ray(x in 0.0_f64..640.0, y in 0.0_f64..480.0, depth in 0.01_f64..10.0) {
            let camera = Camera::new(description()).unwrap();
            let ray = camera.ray(DVec2::new(x, y));
            let image = camera.project(ray.origin + depth * ray.direction).unwrap();
            // 1e4 pixels of image distance, times a few roundings.
            prop_assert!(image.distance(DVec2::new(x, y)) < 1e-10, "{image}");
        }
    }
}
