use glam::DVec3;
use tem00_beam::GaussianBeam;
use tem00_coherence::{LaserLight, Relief};
use tem00_numerics::{Refusal, check};

use super::Subsurface;
use crate::{DetectorSettings, LaserPlane, SensorDescription, SetupQuantity, TriangulationError};

/// Description of a triangulation set-up by its data sheets.
///
/// The laser plane stands on the reference plane, the camera looks at the line from the side;
/// see [`Setup`](crate::Setup) for the geometry.
#[derive(Clone, Debug, PartialEq)]
pub struct SetupDescription {
    /// The laser and its line.
    pub laser: LaserLineData,
    /// The camera's lens and where it stands; the pixel pitch is part of the sensor.
    pub camera: SetupCamera,
    /// The camera's sensor.
    pub sensor: SensorDescription,
    /// True if the exposure time is chosen such that the light fits the sensor, as
    /// [`Setup::new`](crate::Setup::new) says, and the exposure time of the sensor is not read.
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

impl Default for SetupDescription {
    /// A typical set-up: 650 nm and 5 mW in a line of 0.2 mm, and a lens of 25 mm at f/8 that sees
    /// it from 300 mm at 30°.
    fn default() -> Self {
        Self {
            laser: LaserLineData {
                light: LaserLight::monochromatic(650e-9),
                power: 5e-3,
                line_thickness: 0.2e-3,
                line_length: 50e-3,
                offset: 0.0,
                tilt: 0.0,
            },
            camera: SetupCamera {
                focal_length: 25e-3,
                f_number: 8.0,
                resolution: [640, 480],
                distance: 0.3,
                angle: 30_f64.to_radians(),
                principal_row: None,
                scheimpflug: false,
            },
            sensor: SensorDescription::default(),
            auto_exposure: false,
            surface: SetupSurface {
                reflectance: 0.5,
                patterns: 1,
                polarisation: 1.0,
                relief: Relief::default(),
                subsurface: Subsurface::default(),
            },
            detector: DetectorSettings::default(),
            calibration_uncertainty: 0.0,
            environment: SetupEnvironment::default(),
            average: Averages::default(),
        }
    }
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
    /// The distance of the laser plane from the point that the optical axis meets on the reference
    /// plane, along y, in metres.
    pub offset: f64,
    /// The angle of the laser plane from the upright, in radians: positive if it leans to +y, away
    /// from the camera.
    pub tilt: f64,
}

/// Effect of a temperature change since the calibration on the geometry, to first order.
///
/// The *base* holds camera and laser: as it expands, the laser plane moves away from the camera by
/// the fraction `α ΔT` of their distance L sin θ, and the directions of both stay. The *mount*
/// holds lens and sensor: as it expands, the image distance grows by that fraction.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct SetupEnvironment {
    /// The temperature minus the temperature at which the values of the set-up hold, in kelvins.
    pub temperature_change: f64,
    /// The linear expansion of the base, per kelvin.
    pub base_expansion: f64,
    /// The linear expansion of the mount, per kelvin.
    pub mount_expansion: f64,
}

impl SetupDescription {
    /// Returns the distance of the laser plane from the optical axis on the reference plane, with
    /// the expansion of the base, in metres.
    pub(crate) fn laser_offset(&self) -> f64 {
        let base = self.camera.distance * libm::sin(self.camera.angle);
        let SetupEnvironment {
            temperature_change,
            base_expansion,
            ..
        } = self.environment;
        self.laser.offset + base * base_expansion * temperature_change
    }

    /// Returns the pixel pitch that has the same image at the image distance without the expansion
    /// of the mount, in metres.
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

    /// Returns the laser line across, a Gaussian beam whose waist on the reference plane is as wide
    /// as the line is thick.
    ///
    /// # Errors
    ///
    /// Returns an error if the line is finer than a beam can be.
    pub fn line_beam(&self) -> Result<GaussianBeam, TriangulationError> {
        let laser = &self.laser;
        let beam = GaussianBeam::from_waist(laser.light.wavelength, 0.5 * laser.line_thickness);
        let allowed = "at least 4 λ / π: a finer line is no beam";
        beam.map_err(|_| Refusal::new("line_thickness", laser.line_thickness, allowed).into())
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
    /// The angle θ between the optical axis and the vertical, in radians: the angle to the laser
    /// plane is θ + [`tilt`](LaserLineData::tilt).
    pub angle: f64,
    /// The row of the image that the optical axis meets, in pixels; the middle without one.
    pub principal_row: Option<f64>,
    /// True if the sensor is tilted so that the laser plane is in focus, after Scheimpflug.
    pub scheimpflug: bool,
}

impl SetupCamera {
    /// Returns the magnification on the axis, `m = f / (L − f)`.
    pub(super) fn magnification(&self) -> f64 {
        self.focal_length / (self.distance - self.focal_length)
    }

    /// Returns the row in the middle of the image.
    pub(super) fn middle_row(&self) -> f64 {
        0.5 * self.resolution[1] as f64
    }
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
    /// The relief that is finer than the resolution of the camera; of height zero where it is not
    /// known.
    pub relief: Relief,
    /// Light from below the surface.
    pub subsurface: Subsurface,
}

/// Numbers of columns and frames that a height is averaged over.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Averages {
    /// The number of neighbouring columns.
    pub columns: u32,
    /// The number of frames.
    pub frames: u32,
    /// True if each frame has its own speckle, because the part moves on between them. On a part
    /// that rests, speckle rests too, and does not average out.
    pub independent_speckle: bool,
}

impl Default for Averages {
    /// Averages over one column of one frame.
    fn default() -> Self {
        Self {
            columns: 1,
            frames: 1,
            independent_speckle: false,
        }
    }
}

impl SetupSurface {
    /// Returns the contrast of the speckle in light of one wavelength, before pixels average over
    /// it.
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
    /// Returns the errors of all single numbers, in the order of the sections, or else the error of
    /// the light.
    pub(crate) fn violations(&self) -> Vec<TriangulationError> {
        let quantities = SetupQuantity::ALL.iter();
        let checks = quantities.map(|quantity| quantity.check(self));
        let average = &self.average;
        let [patterns, columns, frames] =
            [self.surface.patterns, average.columns, average.frames].map(f64::from);
        let to_average = "a number from 1 to 10000 to average over";
        let certain = "from 0 to 1 m, the standard uncertainty of the calibration";
        let whole_image = (0.0, self.camera.resolution[0] as f64);
        let of_image = "at most the number of columns of the image";
        let others = [
            within(
                "uncertainty",
                self.calibration_uncertainty,
                (0.0, 1.0),
                certain,
            ),
            within(
                "patterns",
                patterns,
                (1.0, 64.0),
                "from 1 to 64 independent patterns",
            ),
            within("columns", columns, (1.0, 1e4), to_average),
            within("frames", frames, (1.0, 1e4), to_average),
            within("columns", columns, whole_image, of_image),
        ];
        let found: Vec<_> = checks.chain(others).filter_map(Result::err).collect();
        if !found.is_empty() {
            return found;
        }
        let light = &self.laser.light;
        let line = light.spectrum().err().map(Into::into);
        let extent = light.extent().err().map(Into::into);
        let beam = self.line_beam().err();
        line.into_iter().chain(extent).chain(beam).collect()
    }

    /// Checks what can be checked number by number.
    pub(super) fn check(&self) -> Result<(), TriangulationError> {
        self.violations().into_iter().next().map_or(Ok(()), Err)
    }
}

/// Checks that a quantity lies in a closed range.
pub(crate) fn within(
    parameter: &'static str,
    value: f64,
    (min, max): (f64, f64),
    allowed: &'static str,
) -> Result<(), TriangulationError> {
    let holds = (min..=max).contains(&value);
    Ok(check::that(holds, parameter, value, "", allowed)?)
}
