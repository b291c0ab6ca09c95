//! A triangulation set-up as data sheets describe it, and what follows from its geometry.

mod description;
mod imaged_line;
mod light_level;
mod line_profile;
mod quantity;
mod range;
mod row;
mod subsurface;
pub(crate) mod unit;

use glam::{DVec2, DVec3};
use tem00_camera::{Camera, CameraDescription, RadialDistortion, SensorTilt};
use tem00_coherence::ResolutionCell;

use self::subsurface::SpreadLight;
use crate::{DetectorSettings, LineDetector, Sensor, TriangulationError, Triangulator};

pub(crate) use self::{
    description::within,
    light_level::{MAX_GRAIN_SATURATION, MIN_SIGNAL},
    line_profile::{LensedLine, LineProfile, transfer},
    subsurface::PixelSpread,
};
pub use self::{
    description::{
        Averages, LaserLineData, SetupCamera, SetupDescription, SetupEnvironment, SetupSurface,
    },
    imaged_line::{BandwidthEffect, ImagedLine},
    light_level::LightLevel,
    quantity::SetupQuantity,
    range::HeightRange,
    subsurface::Subsurface,
    unit::QuantityUnit,
};

/// The speckle sizes, in pixels, whose patterns and covariances can be computed in reasonable time.
pub(crate) const SPECKLE_SIZES: (f64, f64) = (1.0 / 16.0, 64.0);

/// A laser-triangulation set-up: a laser line on a flat part, and a camera that looks from the
/// side.
///
/// ```text
///            z
///    camera  |  laser, from above, in the plane y = 0
///        \θ  |          θ: angle between optical axis and z, that is the laser plane if it
///         \  |          stands upright
///   L      \ |          camera at (0, −L sin θ, L cos θ), looking at the origin
///           \|
///   ---------+--------> y      the reference plane z = 0; the line runs along x
/// ```
///
/// x is to the right in the image. A height z moves the line *up* in the image, to first order by
/// `m z sin θ`; all of the geometry is taken from the camera's projection, not from this first
/// order. The plane of the laser may stand beside y = 0, or lean; see [`LaserLineData`]. With the
/// tilt τ it is at the angle θ + τ to the optical axis.
///
/// # Validity
///
/// The light falls straight down on a surface that lies flat, Lambertian and rough enough for fully
/// developed speckle; the line has the same width all over the measuring range. The lens has no
/// distortion and loses no light.
#[derive(Clone, Debug, PartialEq)]
pub struct Setup {
    description: SetupDescription,
    triangulator: Triangulator,
    sensor: Sensor,
    detector: LineDetector,
    line: ImagedLine,
    spread: Option<SpreadLight>,
}

impl Setup {
    /// Creates a set-up.
    ///
    /// With [`auto_exposure`](SetupDescription::auto_exposure) the exposure time is the longest of
    /// two digits with which bright grains of speckle, at three standard deviations above the mean
    /// of the brightest pixel, fill at most 0.9 of what the sensor can hold;
    /// [`description`](Self::description) has it.
    ///
    /// # Errors
    ///
    /// Returns an error if a quantity is outside its range; if camera, sensor or detector are not
    /// possible; if the line is narrower in the image than a tenth of a pixel or wider than a third
    /// of the image; or if a speckle is smaller than 1/16 of a pixel or larger than 64 pixels.
    pub fn new(mut description: SetupDescription) -> Result<Self, TriangulationError> {
        if description.auto_exposure {
            description.sensor.exposure_time = 1.0;
            let exposed = Self::exposed(description.clone())?;
            description.sensor.exposure_time = exposed.grain_exposure()?;
        }
        Self::exposed(description)
    }

    /// Creates a set-up with the exposure time of its description.
    fn exposed(description: SetupDescription) -> Result<Self, TriangulationError> {
        description.check()?;
        let camera = camera(&description)?;
        let sensor = Sensor::new(description.sensor)?;
        let detector = LineDetector::new(description.detector)?;
        let detector = LineDetector::new(DetectorSettings {
            saturation: detector.settings().saturation.min(saturation(&sensor)),
            ..*detector.settings()
        })?;
        let spread = SpreadLight::new(&description)?;
        let line = ImagedLine::at(&description, &camera, spread.as_ref(), 0.0).ok_or(NOT_SEEN)?;
        let plane = description.laser_plane()?;
        let setup = Self {
            description,
            triangulator: Triangulator::new(camera, plane),
            sensor,
            detector,
            line,
            spread,
        };
        setup.check_image()?;
        Ok(setup)
    }

    /// Returns the description that the set-up was created from.
    pub const fn description(&self) -> &SetupDescription {
        &self.description
    }

    /// Returns the description with the exposure time that it has: other values do not change it.
    pub(crate) fn exposed_description(&self) -> SetupDescription {
        SetupDescription {
            auto_exposure: false,
            ..self.description.clone()
        }
    }

    /// Returns the resolution cell of the camera on the reference plane, or `None` if its paths
    /// have no law.
    pub(crate) fn resolution_cell(&self) -> Option<ResolutionCell> {
        let (camera, wavelength) = (self.camera(), self.description.laser.light.wavelength);
        let geometry = camera.imaging_geometry_at(
            camera.project(self.description.laser_point_at(0.0))?,
            wavelength,
        );
        imaged_line::resolution_cell(&self.description, camera, 0.0, &geometry.ok()?)
    }

    /// Returns the camera.
    pub const fn camera(&self) -> &Camera {
        self.triangulator.camera()
    }

    /// Returns the sensor.
    pub const fn sensor(&self) -> &Sensor {
        &self.sensor
    }

    /// Returns the detector. It takes a pixel for saturated at the sensor's largest grey value, or
    /// at the grey value of its full well if that is less.
    pub const fn detector(&self) -> &LineDetector {
        &self.detector
    }

    /// Returns the geometry that turns positions in the image into points: the camera and the plane
    /// of the laser.
    pub const fn triangulator(&self) -> &Triangulator {
        &self.triangulator
    }

    /// Returns the image of the line on the reference plane.
    pub const fn line(&self) -> &ImagedLine {
        &self.line
    }

    /// Returns the image of the line on a flat surface at a height, in metres, or `None` where the
    /// camera does not see it. It may lie outside of the image.
    pub fn line_at(&self, height: f64) -> Option<ImagedLine> {
        ImagedLine::at(
            &self.description,
            self.camera(),
            self.spread.as_ref(),
            height,
        )
    }

    /// Returns the height, in metres, of a line that is seen in the middle column at a position `y`
    /// along it, in pixels, or `None` if the line of sight does not meet the laser plane.
    pub fn height_at(&self, y: f64) -> Option<f64> {
        let [width, _] = self.description.camera.resolution;
        let middle = 0.5 * width as f64;
        let point = self.triangulator.point(DVec2::new(middle, y));
        point.map(|point| point.z)
    }

    /// Returns the magnification on the axis, `m = f / (L − f)`.
    pub fn magnification(&self) -> f64 {
        self.description.camera.magnification()
    }

    /// Returns the width of the field, in metres: the length of the part of the reference line that
    /// is in the image.
    pub fn field_width(&self) -> f64 {
        let [width, _] = self.description.camera.resolution;
        width as f64 * self.description.sensor.pixel_pitch / self.magnification()
    }

    fn check_image(&self) -> Result<(), TriangulationError> {
        let [width, height] = self.description.camera.resolution;
        let rows = height as f64;
        let allowed = "at least 8 columns and 16 rows";
        within("resolution", width as f64, (8.0, f64::MAX), allowed)?;
        within("resolution", rows, (16.0, f64::MAX), allowed)?;
        let per_pixel = self.line.speckle_size;
        let allowed = "such that the speckle size λ F (1 + m) is from 1/16 to 64 pixels";
        within("f_number", per_pixel[0], SPECKLE_SIZES, allowed)?;
        within("f_number", per_pixel[1], SPECKLE_SIZES, allowed)?;
        let allowed = "such that the width of its image, in pixels, is from 0.1 to a third of the \
                       rows in `resolution`";
        let widest = match self.line.subsurface_width > self.line.projected_thickness {
            true => "transport_length",
            false => "line_thickness",
        };
        within(widest, self.line.width, (0.1, rows / 3.0), allowed)?;
        let window = self.description.detector.window as f64;
        let allowed = "at most the number of rows of the image";
        within("window", window, (1.0, rows), allowed)
    }
}

const NOT_SEEN: TriangulationError = TriangulationError::Direction {
    parameter: "angle",
    allowed: "such that the camera sees the line",
};

/// Returns the grey value from which on a pixel of the sensor is saturated.
fn saturation(sensor: &Sensor) -> f64 {
    let d = sensor.description();
    let full = d.largest_value();
    full.min((d.black_level + d.gain * d.full_well).floor())
}

/// Returns the camera of a set-up.
///
/// The plane in focus of a sensor tilted by τ is turned by τ′ the other way,
/// `tan τ′ = (L/d) tan τ`; the laser plane, which leans by ε, is a right angle less θ + ε away from
/// the plane across the axis, and higher points in the image are nearer:
///
/// ```text
/// tan τ = −m / tan(θ + ε)
/// ```
pub(crate) fn camera(description: &SetupDescription) -> Result<Camera, TriangulationError> {
    let SetupCamera {
        focal_length,
        f_number,
        resolution,
        distance,
        angle,
        principal_row,
        scheimpflug,
    } = description.camera;
    let (sin, cos) = angle.sin_cos();
    let magnification = description.camera.magnification();
    let tilt = if scheimpflug {
        let (sin, cos) = (angle + description.laser.tilt).sin_cos();
        -libm::atan(magnification * cos / sin)
    } else {
        0.0
    };
    Ok(Camera::new(CameraDescription {
        position: distance * DVec3::new(0.0, -sin, cos),
        look_at: DVec3::ZERO,
        up: DVec3::Z,
        focal_length,
        f_number,
        focus_distance: distance,
        pixel_pitch: description.effective_pixel_pitch(),
        resolution,
        principal_point: principal_row.map(|row| DVec2::new(0.5 * resolution[0] as f64, row)),
        tilt: SensorTilt {
            angle: tilt,
            azimuth: 0.0,
        },
        distortion: RadialDistortion::default(),
        depth_of_field: true,
    })?)
}

#[cfg(test)]
pub(crate) mod tests;
