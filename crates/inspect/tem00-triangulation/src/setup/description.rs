use glam::DVec3;
use tem00_beam::GaussianBeam;
use tem00_coherence::{LaserLight, Relief};

use crate::{DetectorSettings, LaserPlane, SensorDescription, TriangulationError};

/// Description of a triangulation set-up by its data sheets.
///
/// The laser plane stands on the reference plane, the camera looks at the line from the side;
/// see [`Setup`](crate::Setup) for the geometry.
#[derive(Clone, Debug, PartialEq)]
pub struct SetupDescription {
    /// The laser and its line.
    pub laser: LaserLineData,
    /// The camera's lens and where it stands; the pixel pitch is that of the sensor.
    pub camera: SetupCamera,
    /// The camera's sensor.
    pub sensor: SensorDescription,
    /// True if the exposure time is chosen such that the light fits the sensor, as
    /// [`Setup::new`](crate::Setup::new) says, and that of the sensor is not read.
    pub auto_exposure: bool,
    /// The surface that the line falls on.
    pub surface: SetupSurface,
    /// The settings of the line detector.
    pub detector: DetectorSettings,
    /// The standard uncertainty of a height by the calibration alone, in metres.
    pub calibration_uncertainty: f64,
    /// The temperature and what it expands.
    pub environment: SetupEnvironment,
    /// The averaging of heights.
    pub average: Averages,
}

/// A laser line on the part: of uniform power along the line, of Gaussian profile across it.
#[derive(Clone, Debug, PartialEq)]
pub struct LaserLineData {
    /// The vacuum wavelength and the spectrum about it.
    pub light: LaserLight,
    /// The power in the line, in watts.
    pub power: f64,
    /// The full 1/e² thickness of the line on the part, in metres.
    pub line_thickness: f64,
    /// The length of the line on the part, in metres.
    pub line_length: f64,
    /// The distance of the laser plane from the point that the optical axis meets on the reference plane, along y,
    /// in metres.
    pub offset: f64,
    /// The angle of the laser plane from the upright, in radians: positive if it leans to +y, away from the camera.
    pub tilt: f64,
}

/// What a change of temperature since the calibration does to the geometry, to first order.
///
/// The *base* holds camera and laser: as it expands, the laser plane moves away from the camera by the part
/// `α ΔT` of their distance L sin θ, and the directions of both stay. The *mount* holds lens and sensor: as it expands,
/// the image distance grows by that part.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct SetupEnvironment {
    /// The temperature less that at which the values of the set-up hold, in kelvins.
    pub temperature_change: f64,
    /// The linear expansion of the base, per kelvin.
    pub base_expansion: f64,
    /// The linear expansion of the mount, per kelvin.
    pub mount_expansion: f64,
}

impl SetupDescription {
    /// Returns the distance of the laser plane from the optical axis on the reference plane, with the expansion of
    /// the base, in metres.
    pub(crate) fn laser_offset(&self) -> f64 {
        let base = self.camera.distance * libm::sin(self.camera.angle);
        let SetupEnvironment {
            temperature_change,
            base_expansion,
            ..
        } = self.environment;
        self.laser.offset + base * base_expansion * temperature_change
    }

    /// Returns the pixel pitch that has the same image at the image distance without the expansion of the mount, in
    /// metres.
    pub(crate) fn effective_pixel_pitch(&self) -> f64 {
        let SetupEnvironment {
            temperature_change,
            mount_expansion,
            ..
        } = self.environment;
        self.sensor.pixel_pitch / (1.0 + mount_expansion * temperature_change)
    }

    /// Returns the point of the laser plane at a height, in metres, before the middle of the line.
    pub fn laser_point_at(&self, height: f64) -> DVec3 {
        let beside = height * libm::tan(self.laser.tilt);
        DVec3::new(0.0, self.laser_offset() + beside, height)
    }

    /// Returns the laser line across, a Gaussian beam whose waist on the reference plane is as wide as the line is thick.
    ///
    /// # Errors
    ///
    /// Returns an error if the line is finer than a beam can be.
    pub fn line_beam(&self) -> Result<GaussianBeam, TriangulationError> {
        let laser = &self.laser;
        let beam = GaussianBeam::from_waist(laser.light.wavelength, 0.5 * laser.line_thickness);
        beam.map_err(|_| TriangulationError::OutOfRange {
            parameter: "line_thickness",
            value: laser.line_thickness,
            allowed: "at least 4 λ / π: a finer line is no beam",
        })
    }

    /// Returns the full thickness of the line on a flat part at a height, in metres.
    pub(crate) fn line_thickness_at(&self, height: f64) -> Option<f64> {
        let along = height / libm::cos(self.laser.tilt);
        Some(2.0 * self.line_beam().ok()?.radius_at(along))
    }

    /// Returns the plane of the laser.
    pub(crate) fn laser_plane(&self) -> Result<LaserPlane, TriangulationError> {
        let (sin, cos) = (libm::sin(self.laser.tilt), libm::cos(self.laser.tilt));
        LaserPlane::new(self.laser_point_at(0.0), DVec3::new(0.0, cos, -sin))
    }
}

/// The lens of a camera, and where the camera stands.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SetupCamera {
    /// The focal length, in metres.
    pub focal_length: f64,
    /// The f-number: focal length by diameter of the entrance pupil.
    pub f_number: f64,
    /// The numbers of pixel columns and rows.
    pub resolution: [usize; 2],
    /// The distance from the entrance pupil to the line on the reference plane, in metres.
    pub distance: f64,
    /// The angle θ between the optical axis and the upright, in radians: the angle to the laser plane is
    /// θ + [`tilt`](LaserLineData::tilt).
    pub angle: f64,
    /// The row of the image that the optical axis meets, in pixels; the middle without one.
    pub principal_row: Option<f64>,
    /// True if the sensor is tilted so that the laser plane is in focus, after Scheimpflug.
    pub scheimpflug: bool,
}

/// A surface that scatters evenly and coherently.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SetupSurface {
    /// The Lambertian reflectance at the wavelength of the laser, from 0 to 1.
    pub reflectance: f64,
    /// The number of independent speckle patterns that add in each frame.
    pub patterns: u32,
    /// The degree of polarisation of the scattered light, from 0 to 1.
    pub polarisation: f64,
    /// The relief that is finer than what the camera resolves; of no height where it is not known.
    pub relief: Relief,
}

/// Numbers of columns and frames that a height is averaged over.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Averages {
    /// The number of neighbouring columns.
    pub columns: u32,
    /// The number of frames.
    pub frames: u32,
    /// True if each frame has speckle of its own, because the part moves on between them. On a part
    /// that rests, speckle rests too, and does not average out.
    pub independent_speckle: bool,
}

impl Default for Averages {
    /// One column of one frame.
    fn default() -> Self {
        Self {
            columns: 1,
            frames: 1,
            independent_speckle: false,
        }
    }
}

impl SetupSurface {
    /// Returns the contrast of the speckle in light of one wavelength, before pixels average over it.
    ///
    /// ```text
    /// C = √((1 + P²) / (2 N))      P: degree of polarisation, N: independent patterns
    /// ```
    ///
    /// # References
    ///
    /// - J. W. Goodman, *Speckle Phenomena in Optics*, 2007, ch. 3.
    pub fn contrast(&self) -> f64 {
        let Self {
            patterns,
            polarisation,
            ..
        } = *self;
        ((1.0 + polarisation * polarisation) / (2.0 * f64::from(patterns))).sqrt()
    }
}

impl SetupDescription {
    /// Returns everything that is wrong number by number, in the order of the sections.
    pub(crate) fn violations(&self) -> Vec<TriangulationError> {
        let mut found = Violations(Vec::new());
        self.check_laser(&mut found);
        self.check_camera(&mut found);
        self.check_surface(&mut found);
        self.check_environment(&mut found);
        let uncertainty = self.calibration_uncertainty;
        let allowed = "from 0 to 1 m, the standard uncertainty of the calibration";
        found.within("uncertainty", uncertainty, (0.0, 1.0), allowed);
        let Averages {
            columns, frames, ..
        } = self.average;
        for (parameter, count) in [("columns", columns), ("frames", frames)] {
            let allowed = "a number from 1 to 10000 to average over";
            found.within(parameter, f64::from(count), (1.0, 1e4), allowed);
        }
        let [width, _] = self.camera.resolution;
        let allowed = "at most the number of columns of the image";
        found.within("columns", f64::from(columns), (0.0, width as f64), allowed);
        found.0
    }

    /// Checks what can be checked number by number.
    pub(super) fn check(&self) -> Result<(), TriangulationError> {
        match self.violations().into_iter().next() {
            Some(error) => Err(error),
            None => Ok(()),
        }
    }

    fn check_laser(&self, found: &mut Violations) {
        let LaserLineData {
            ref light,
            power,
            line_thickness,
            line_length,
            offset,
            tilt,
        } = self.laser;
        let allowed = "from 100 nm to 100 µm (in metres)";
        if found.within("wavelength", light.wavelength, (100e-9, 100e-6), allowed) {
            found.add(light.line().map_err(Into::into));
            found.add(light.extent().map_err(Into::into));
        }
        let allowed = "positive, at most 1000 W (in watts)";
        found.within("power", power, (f64::MIN_POSITIVE, 1e3), allowed);
        let allowed = "from 1 µm to 1 m (in metres)";
        if found.within("line_thickness", line_thickness, (1e-6, 1.0), allowed) {
            found.add(self.line_beam());
        }
        let allowed = "from the thickness of the line to 100 m (in metres)";
        found.within("line_length", line_length, (line_thickness, 100.0), allowed);
        found.within(
            "offset",
            offset,
            (-1.0, 1.0),
            "from -1 m to 1 m (in metres)",
        );
        let allowed = "from -45° to 45° (in radians)";
        found.within("tilt", tilt, (-0.786, 0.786), allowed);
        let pitch = self.sensor.pixel_pitch;
        let allowed = "from 0.1 µm to 1 mm (in metres)";
        found.within("pixel_pitch", pitch, (0.1e-6, 1e-3), allowed);
    }

    fn check_camera(&self, found: &mut Violations) {
        let SetupCamera {
            focal_length,
            f_number,
            distance,
            angle,
            principal_row,
            resolution: [_, rows],
            ..
        } = self.camera;
        if let Some(row) = principal_row {
            let allowed = "a row of the image, from 0 to their number";
            found.within("principal_row", row, (0.0, rows as f64), allowed);
        }
        let allowed = "from 0.1 mm to 100 m (in metres)";
        found.within("focal_length", focal_length, (1e-4, 100.0), allowed);
        found.within("f_number", f_number, (0.5, 1e3), "from 0.5 to 1000");
        let allowed = "from 1.001 focal lengths to 1000 m (in metres)";
        found.within("distance", distance, (1.001 * focal_length, 1e3), allowed);
        let degree = core::f64::consts::PI / 180.0;
        // A hair more than that, for what rounding does to the ends.
        let range = (0.999_999 * degree, 89.000_001 * degree);
        found.within("angle", angle, range, "from 1° to 89° (in radians)");
    }

    fn check_environment(&self, found: &mut Violations) {
        let SetupEnvironment {
            temperature_change,
            base_expansion,
            mount_expansion,
        } = self.environment;
        let (change, allowed) = ("temperature_change", "from -200 to 200 K");
        found.within(change, temperature_change, (-200.0, 200.0), allowed);
        let allowed = "from -0.001 to 0.001 per kelvin";
        found.within("base_expansion", base_expansion, (-1e-3, 1e-3), allowed);
        found.within("mount_expansion", mount_expansion, (-1e-3, 1e-3), allowed);
    }

    fn check_surface(&self, found: &mut Violations) {
        let SetupSurface {
            reflectance,
            patterns,
            polarisation,
            relief,
        } = self.surface;
        let allowed = "from 0 to 1 m, of the relief finer than a resolution cell";
        found.within("rms_height", relief.rms_height, (0.0, 1.0), allowed);
        let length = relief.correlation_length;
        found.within("correlation_length", length, (0.0, 1.0), "from 0 to 1 m");
        let (range, allowed) = ((f64::MIN_POSITIVE, 1.0), "positive, at most 1");
        found.within("reflectance", reflectance, range, allowed);
        let allowed = "from 1 to 64 independent patterns";
        found.within("patterns", f64::from(patterns), (1.0, 64.0), allowed);
        found.within("polarisation", polarisation, (0.0, 1.0), "from 0 to 1");
    }
}

/// What is wrong with a description.
struct Violations(Vec<TriangulationError>);

impl Violations {
    /// Keeps the error of a check.
    fn add<T>(&mut self, checked: Result<T, TriangulationError>) {
        self.0.extend(checked.err());
    }

    /// Checks that a quantity lies in a closed range, and returns whether it does.
    fn within(
        &mut self,
        parameter: &'static str,
        value: f64,
        range: (f64, f64),
        allowed: &'static str,
    ) -> bool {
        let checked = within(parameter, value, range, allowed);
        let is_within = checked.is_ok();
        self.add(checked);
        is_within
    }
}

/// Checks that a quantity lies in a closed range.
pub(crate) fn within(
    parameter: &'static str,
    value: f64,
    (least, greatest): (f64, f64),
    allowed: &'static str,
) -> Result<(), TriangulationError> {
    if (least..=greatest).contains(&value) {
        return Ok(());
    }
    Err(TriangulationError::OutOfRange {
        parameter,
        value,
        allowed,
    })
}
