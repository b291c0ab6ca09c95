use std::sync::atomic::AtomicBool;

use tem00_calibration::{BoardView, Calibration, CameraModel, calibrate};
use tem00_engine::{SpeckleModel, SpecklePlan, render_frame};
use tem00_numerics::{
    Grid,
    cast::{to_f32, to_usize},
};
use tem00_tracer::{Filter, RenderOptions, Scene};
use tem00_triangulation::{LineDetector, RawFrame, Sensor};

use super::BoardPlan;
use crate::Exposure;
use crate::ScanError;

/// The fraction of the pixels that may be brighter than the target grey value.
const BRIGHTER: f64 = 1e-3;

/// The fraction of the full scale at which the exposure aims.
const AIM: f64 = 0.7;

impl BoardPlan {
    /// Renders the images of a board, as a camera gives them: under a white light, and in the light
    /// of the laser, with its speckle. Each is exposed so that a thousandth of its pixels exceeds
    /// 70 % of the full scale.
    ///
    /// # Errors
    ///
    /// Returns an error if the images cannot be rendered or if `cancel` was set.
    ///
    /// # Panics
    ///
    /// Panics unless there is such a pose.
    pub fn frames(
        &self,
        pose: usize,
        sensor: &Sensor,
        progress: &(dyn Fn(u64) + Sync),
        cancel: &AtomicBool,
    ) -> Result<[RawFrame; 2], ScanError> {
        let scenes = self.scenes(pose)?;
        let seed = |image: u64| {
            self.scene
                .render
                .seed
                .wrapping_add(2 * pose as u64 + image + 1)
        };
        let frame = |scene: &Scene, seed: u64| {
            let electrons = electrons(scene, sensor, seed, (progress, cancel))?;
            Ok::<_, ScanError>(sensor.expose(&scaled(&electrons, sensor), seed)?)
        };
        Ok([frame(&scenes[0], seed(0))?, frame(&scenes[1], seed(1))?])
    }

    /// Returns how many camera samples the images of all boards take.
    pub fn samples(&self) -> u64 {
        let camera = &self.scene.camera;
        let pixels = camera.width() as u64 * camera.height() as u64;
        2 * self.poses.len() as u64 * pixels * u64::from(self.scene.render.samples_per_pixel)
    }

    /// Calibrates with the images of all boards, in the order of the poses, as with photographs:
    /// corners and lines are found in the raw frames. Camera and laser plane are those of the
    /// scene, within the errors of the calibration.
    ///
    /// The tilt of the sensor is estimated where the camera of the scene has one, and as many
    /// coefficients of distortion as it has.
    ///
    /// # Errors
    ///
    /// Returns an error if an image does not show its board or leaves the calibration open.
    pub fn calibration(
        &self,
        frames: &[[RawFrame; 2]],
        detector: &LineDetector,
    ) -> Result<Calibration, ScanError> {
        let view = |[lit, line]: &[RawFrame; 2]| {
            let (lit, line) = (lit.grey_values(), line.grey_values());
            BoardView::find(&lit, &detector.detect(&line), &self.board)
        };
        let views: Vec<_> = frames.iter().map(view).collect::<Result<_, _>>()?;
        let calibration = calibrate(&self.board, &views, &self.model())?;
        Ok(calibration.moved(&self.poses[0])?)
    }

    fn model(&self) -> CameraModel {
        let camera = self.scene.camera.description();
        let distortion = [
            camera.distortion.k3,
            camera.distortion.k2,
            camera.distortion.k1,
        ];
        let without = distortion.iter().take_while(|k| **k == 0.0).count();
        CameraModel {
            pixel_pitch: camera.pixel_pitch,
            resolution: camera.resolution,
            focal_length: Some(camera.focal_length),
            f_number: camera.f_number,
            tilted: camera.tilt.angle != 0.0,
            radial: distortion.len() - without,
        }
    }
}

/// Renders a scene and returns the mean electrons of its pixels.
fn electrons(
    scene: &Scene,
    sensor: &Sensor,
    seed: u64,
    (progress, cancel): (&(dyn Fn(u64) + Sync), &AtomicBool),
) -> Result<Grid<f32>, ScanError> {
    let options = RenderOptions {
        seed,
        filter: Filter::Box {
            radius: sensor.sensitive_half_width(),
        },
        ..scene.render
    };
    let plan = SpecklePlan::new(scene, seed)?;
    let speckle = SpeckleModel::generate(scene, &plan)?;
    let frame = render_frame(scene, Some(&speckle), 0, &options, progress, cancel)?;
    Ok(Exposure::of_frame(&frame, &scene.camera, sensor).electrons)
}

/// Returns the electrons for the exposure at which the image is bright without being saturated.
fn scaled(electrons: &Grid<f32>, sensor: &Sensor) -> Grid<f32> {
    let mut values = electrons.values().to_vec();
    let brighter = to_usize(BRIGHTER * values.len() as f64);
    let (_, bright, _) = values.select_nth_unstable_by(brighter, |a, b| b.total_cmp(a));
    let description = sensor.description();
    let scale = description.largest_value() - description.black_level;
    let full = description.full_well.min(scale / description.gain);
    let factor = to_f32(AIM * full / f64::from(bright.max(f32::MIN_POSITIVE)));
    electrons.map(|value| value * factor)
}
