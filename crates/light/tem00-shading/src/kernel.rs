//! The speckle factor at a hit, for kernels on a graphics card.

use std::sync::Arc;

use glam::{DQuat, DVec2};
use tem00_camera::Camera;
use tem00_numerics::Refusal;
use tem00_speckle::{PupilField, SlicePath, StackPlan};

use crate::{Laser, Motion, PreparedSpeckle, ShadingError, Speckle, patterns::Patterns};

/// The function `tem00_factor` in WGSL, which is
/// [`SpeckleFrame::factor`](crate::SpeckleFrame::factor) in single precision: functions and structs
/// without bindings.
///
/// Its first comment states how to call it and how exact it is. It needs the texts of
/// [`tem00_decorrelation::closed_form`] and [`tem00_speckle::closed_form`] in the same shader. A
/// frame is a uniform, [`KernelSpeckle::rows`].
///
/// # Examples
///
/// ```
/// let kernel = "
///     @group(0) @binding(0) var<uniform> frame: Tem00SpeckleFrame;
///     // … radiance += f * abs(dot(n, event.wi)) * event.e_perp * tem00_factor(frame, p, n);
/// ";
/// let functions = [
///     tem00_decorrelation::closed_form::WGSL,
///     tem00_speckle::closed_form::WGSL,
///     tem00_shading::WGSL,
/// ];
/// let module = functions.concat() + kernel;
/// assert!(module.contains("fn tem00_factor("));
/// ```
pub const WGSL: &str = include_str!("../shaders/tem00_shading.wgsl");

/// The speckle of a laser in the image of a camera for a kernel whose host generates the stack
/// itself: on the card, or by [`SpeckleStack`](tem00_speckle::SpeckleStack).
///
/// It is the same speckle as from [`Speckle::prepare`].
#[derive(Clone, Debug)]
pub struct KernelSpeckle {
    /// Patterns without stacks.
    speckle: PreparedSpeckle,
    field: PupilField,
}

impl Speckle {
    /// Chooses sizes, slices and the seed of a stack that a kernel reads.
    ///
    /// # Errors
    ///
    /// Returns the errors of [`prepare`](Self::prepare), and an error if the linewidth of the light
    /// affects the speckle or if more than one pattern is needed: for several looks prepare several
    /// stacks, each with its own seed, and let the kernel average their factors.
    pub fn for_kernel(self) -> Result<KernelSpeckle, ShadingError> {
        let (patterns, mut fields) = self.planned()?;
        one_pattern(&patterns)?;
        let field = fields.pop().ok_or(ShadingError::Missing("a pattern"))?;
        Ok(KernelSpeckle {
            speckle: PreparedSpeckle(Arc::new(patterns)),
            field,
        })
    }
}

impl KernelSpeckle {
    /// Returns the field of the stack.
    pub const fn field(&self) -> &PupilField {
        &self.field
    }

    /// Returns the path of its slices.
    pub fn path(&self) -> SlicePath {
        self.speckle.plan().path()
    }

    /// Returns the speckle of a body in a frame as the struct `Tem00SpeckleFrame` of [`WGSL`].
    ///
    /// # Errors
    ///
    /// Returns the errors of [`PreparedSpeckle::frame`] and [`KernelFrame::to_rows`].
    pub fn rows(&self, motion: &Motion) -> Result<[[f32; 4]; 14], ShadingError> {
        let frame = self.speckle.frame(motion)?;
        KernelFrame {
            camera: &frame.speckle.camera,
            laser: &frame.speckle.laser,
            motion,
            plan: &frame.speckle.plan,
            reach: frame.side * frame.reach,
        }
        .to_rows()
    }
}

/// The speckle of one body in one frame, for a kernel and a stack of the host's own: the parts of a
/// [`SpeckleFrame`](crate::SpeckleFrame).
#[derive(Clone, Copy, Debug)]
pub struct KernelFrame<'a> {
    /// The camera in the reference state.
    pub camera: &'a Camera,
    /// The laser in the reference state.
    pub laser: &'a Laser,
    /// Motion since the reference state.
    pub motion: &'a Motion,
    /// The sizes of the stack.
    pub plan: &'a StackPlan,
    /// The largest shift of the pupil that the slices hold on this side of the reference state, in
    /// pupil diameters; it is negative on one of the two sides.
    pub reach: f64,
}

impl KernelFrame<'_> {
    /// Returns the frame as the struct `Tem00SpeckleFrame` of [`WGSL`], byte for byte.
    ///
    /// # Errors
    ///
    /// Returns an error if the sensor is tilted, if the lens distorts, or if a number overflows in
    /// single precision.
    pub fn to_rows(&self) -> Result<[[f32; 4]; 14], ShadingError> {
        let description = self.camera.description();
        let (tilt, distortion) = (&description.tilt, &description.distortion);
        let bends = [
            ("tilt", tilt.angle),
            ("distortion.k1", distortion.k1),
            ("distortion.k2", distortion.k2),
            ("distortion.k3", distortion.k3),
        ];
        if let Some(&(parameter, value)) = bends.iter().find(|(_, value)| *value != 0.0) {
            return Err(refused(parameter, value, "0 for a kernel"));
        }
        // The motions relative to the camera, in its axes and from its pupil.
        let (axes, pupil) = (self.camera.axes(), self.camera.position());
        let to_camera = axes.transpose();
        let Motion {
            body,
            surface,
            camera,
            laser,
        } = self.motion;
        let relative = [surface, laser].map(|pose| pose.then(&camera.inverse()));
        let [[surface_turn, surface_step], [laser_turn, laser_step]] = relative.map(|pose| {
            let step = to_camera * (pose.point(pupil) - pupil);
            [
                DQuat::from_mat3(&(to_camera * pose.rotation() * axes)).into(),
                step.extend(0.0),
            ]
        });
        let (wave, stands) = (self.laser.wave_shape().numbers(), self.laser.wave_frame());
        let aperture = to_camera * (relative[1].point(stands.origin) - pupil);
        let [ex, ey, ez] = stands
            .axes
            .map(|axis| to_camera * relative[1].direction(axis));

        let geometry = self.camera.imaging_geometry(self.laser.wavelength())?;
        let size = DVec2::from_array(self.plan.size().map(|samples| samples as f64));
        let speckle_size = size.x / self.plan.diameter()[0] as f64;
        let per_pixel = geometry.pattern_coordinate(DVec2::ONE, DVec2::ZERO, speckle_size);
        let [width, height] = description.resolution.map(|pixels| 0.5 * pixels as f64);
        let on_axis = description
            .principal_point
            .unwrap_or(DVec2::new(width, height));
        let place = DVec2::from_array(StackPlan::place(*body)) * size;
        let on_axis = (on_axis * per_pixel + place).rem_euclid(size);
        let pixels = geometry.principal_distance() / geometry.pixel_pitch();
        let diameter = geometry.pupil_diameter();
        // Bodies that have not moved keep the first slice at any position.
        let reach = if self.motion.is_still() {
            0.0
        } else {
            self.reach
        };
        let now = camera.rotation() * axes;
        let [x, across, growth] = wave.centres;
        let rows = [
            camera.point(pupil).extend(diameter.recip()),
            now.x_axis.extend(geometry.surface_to_pupil().recip()),
            now.y_axis
                .extend(0.125 * diameter * diameter / self.laser.wavelength()),
            now.z_axis.extend(per_pixel.x * pixels),
            surface_turn,
            surface_step.with_w(self.plan.slices_per_diameter()),
            laser_turn,
            laser_step.with_w(reach),
            aperture.extend(x),
            ex.extend(across),
            ey.extend(growth),
            ez.extend(f64::from(u8::from(wave.is_line))),
            DVec2::from_array(wave.rayleigh_range_squared)
                .extend(on_axis.x)
                .extend(on_axis.y),
            size.extend(self.plan.path().slice_count() as f64)
                .extend(0.0),
        ]
        .map(|row| row.as_vec4().to_array());
        match rows
            .as_flattened()
            .iter()
            .find(|number| !number.is_finite())
        {
            Some(&value) => Err(refused("frame", value.into(), "of numbers that f32 holds")),
            None => Ok(rows),
        }
    }
}

fn one_pattern(patterns: &Patterns) -> Result<(), ShadingError> {
    if patterns.bandwidth.is_some() {
        let length = patterns.laser.spectrum().coherence_length();
        return Err(refused(
            "coherence_length",
            length,
            "infinite for a kernel, in metres",
        ));
    }
    match patterns.parts.len() {
        1 => Ok(()),
        count => Err(refused("patterns", count as f64, "1 for a kernel")),
    }
}

fn refused(parameter: &'static str, value: f64, allowed: &'static str) -> ShadingError {
    Refusal::new(parameter, value, allowed).into()
}

#[cfg(test)]
mod tests {
    use tem00_camera::{CameraDescription, RadialDistortion, SensorTilt};
    use tem00_coherence::{PeakShape, Spectrum};

    use super::*;
    use crate::{DVec3, LaserDescription, testing::spot};

    #[test]
    fn what_a_kernel_cannot_show_is_refused_by_name() {
        let camera = CameraDescription {
            position: DVec3::new(0.02, 0.0, 0.3),
            resolution: [32, 24],
            ..CameraDescription::default()
        };
        let bend = |k1| RadialDistortion {
            k1,
            ..camera.distortion
        };
        let tilt = SensorTilt {
            angle: 0.1,
            azimuth: 0.0,
        };
        let refused = |camera: CameraDescription, looks| {
            let camera = Camera::new(camera).unwrap();
            let laser = Laser::new(spot(DVec3::Z, 1e-3)).unwrap();
            let speckle = Speckle::new(&camera, &laser, 1)
                .looks(looks)
                .within(16 << 20);
            let rows = speckle
                .for_kernel()
                .and_then(|kernel| kernel.rows(&Motion::default()));
            rows.err()
                .map(|error| error.parameter().unwrap().to_owned())
        };
        assert_eq!(refused(camera, 1), None);
        assert_eq!(refused(camera, 2).as_deref(), Some("patterns"));
        let tilted = CameraDescription { tilt, ..camera };
        assert_eq!(refused(tilted, 1).as_deref(), Some("tilt"));
        let bent = CameraDescription {
            distortion: bend(0.1),
            ..camera
        };
        assert_eq!(refused(bent, 1).as_deref(), Some("distortion.k1"));
        let spectrum = Spectrum::new(650e-9, 5e-9, PeakShape::Gaussian).unwrap();
        let broad = Laser::new(LaserDescription {
            spectrum,
            ..spot(DVec3::Z, 1e-3)
        });
        let broad = Speckle::new(&Camera::new(camera).unwrap(), &broad.unwrap(), 1)
            .at_points([(DVec3::ZERO, DVec3::new(0.6, 0.0, 0.8))])
            .for_kernel();
        assert_eq!(broad.unwrap_err().parameter(), Some("coherence_length"));
    }
}
