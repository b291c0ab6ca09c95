use core::sync::atomic::AtomicBool;

use glam::DMat3;
use glam::{DVec2, DVec3};
use tem00_calibration::Calibration;
use tem00_camera::Camera;
use tem00_engine::{FollowedPoint, SpeckleChange, SpeckleModel, render_frame};
use tem00_numerics::{
    cast::to_usize,
    check,
    seed::{Purpose, derived},
};
use tem00_tracer::{BeamShape, Filter, Frame, Laser, Method, Scene, SurfaceSpeckle};
use tem00_triangulation::{DetectorSettings, LineDetector, Sensor, SensorDescription};

use crate::{ScanError, laser_plane::plane_of};
use crate::{
    exposure::Exposure,
    frame::{FrameContext, MeasuredFrame, middle},
    frame_correlation::FrameCorrelation,
    image_speckle::ImageSpeckle,
    motion::ScanMotion,
    scene::MeasurementScene,
    sensor_speckle::SensorSpeckle,
    settings::ScanSettings,
};

/// A scene that is measured frame by frame.
#[derive(Clone, Debug)]
pub struct Measurement {
    scene: Scene,
    sensor: Sensor,
    detector: LineDetector,
    calibration: Calibration,
    height_uncertainty: f64,
    motion: ScanMotion,
    scan: ScanSettings,
    speckle: ImageSpeckle,
}

impl Measurement {
    /// Prepares to measure a scene, with the camera and the laser plane known exactly; for a
    /// calibration that is estimated see [`with_calibration`](Self::with_calibration).
    ///
    /// The render integrates over the sensitive part of each pixel. The first laser draws the line
    /// that is triangulated; others only add their light.
    ///
    /// # Errors
    ///
    /// Returns an error if the first laser is missing or draws no line, if the line runs up and
    /// down in the image, if the scene asks for a part of the image, another filter than the pixel
    /// or light followed from the lasers, if a sensor, a detector or the settings of the scan are
    /// not possible, or if parts move in a way that no scan does.
    pub fn new(measured: MeasurementScene) -> Result<Self, ScanError> {
        let MeasurementScene {
            mut scene,
            sensor,
            detector,
            calibration: settings,
            scan,
        } = measured;
        scan.check()?;
        let motion = ScanMotion::of_scene(&scene, scan.surface.as_deref())?;
        let laser = line_laser(&scene)?;
        check_direction(&scene.camera, laser)?;
        check_render(&scene)?;
        let calibration = Calibration::exact(scene.camera, plane_of(laser)?);
        let sensor = Sensor::new(sensor)?;
        let speckle = speckle(&scene, laser, &motion, &sensor)?;
        scene.render.filter = Filter::Box {
            radius: sensor.sensitive_half_width(),
        };
        scene.render.speckle_in_the_dark = false;
        Ok(Self {
            detector: LineDetector::new(DetectorSettings {
                saturation: saturation(sensor.description()),
                ..*LineDetector::new(detector)?.settings()
            })?,
            scene,
            sensor,
            calibration,
            height_uncertainty: check::not_negative("uncertainty", settings.uncertainty, "m")?,
            motion,
            scan,
            speckle,
        })
    }

    /// Returns the same measurement with camera and laser plane as a calibration found them.
    ///
    /// They are given before anything moves, in the coordinates of the scene.
    #[must_use]
    pub fn with_calibration(self, calibration: Calibration) -> Self {
        Self {
            calibration,
            ..self
        }
    }

    /// Returns the scene as it is rendered.
    pub const fn scene(&self) -> &Scene {
        &self.scene
    }

    /// Returns the sensor.
    pub const fn sensor(&self) -> &Sensor {
        &self.sensor
    }

    /// Returns the detector.
    pub const fn detector(&self) -> &LineDetector {
        &self.detector
    }

    /// Returns the camera and the laser plane that points are computed with, as they stand before
    /// anything moves.
    pub const fn calibration(&self) -> &Calibration {
        &self.calibration
    }

    /// Returns how the frames are put together.
    pub const fn settings(&self) -> &ScanSettings {
        &self.scan
    }

    /// Returns the speckle as the pixels in the middle of the image see it.
    pub const fn speckle(&self) -> &SensorSpeckle {
        self.speckle.middle()
    }

    /// Returns the directions across the line of sight's column, along the scan and of height:
    /// along the line to the right in the image, onwards, and up.
    pub fn axes(&self) -> [DVec3; 3] {
        let height = self.scan.height;
        let line =
            line_laser(&self.scene).map_or(DVec3::X, |laser| laser.description().line_direction);
        let right = self.scene.camera.axes().x_axis;
        let line = line * line.dot(right).signum();
        let across = (line - line.dot(height) * height).try_normalize();
        let across = across.unwrap_or_else(|| height.any_orthonormal_vector());
        [across, height.cross(across), height]
    }

    /// Renders a frame, exposes the sensor, finds the line and places its points.
    ///
    /// Without a `speckle` model the light carries no speckle. The noise of the sensor is drawn
    /// from the seed of the scene and the number of the frame. `progress` and `cancel` work as in
    /// [`render_frame`]; the result has the same bits for any number of threads.
    ///
    /// # Errors
    ///
    /// Returns an error if the frame cannot be rendered or if `cancel` was set.
    ///
    /// # Panics
    ///
    /// Panics unless `frame < scene.frames` and `speckle` belongs to the scene.
    pub fn measure(
        &self,
        speckle: Option<&SpeckleModel>,
        frame: u32,
        progress: &(dyn Fn(u64) + Sync),
        cancel: &AtomicBool,
    ) -> Result<MeasuredFrame, ScanError> {
        let options = &self.scene.render;
        let rendered = render_frame(&self.scene, speckle, frame, options, progress, cancel)?;
        let exposure = Exposure::of_frame(&rendered, &self.scene.camera, &self.sensor);
        let mut measured = self.measure_light(exposure, frame, speckle.is_some())?;
        measured.reference_point = speckle.and_then(|_| self.reference_point(&measured, &rendered));
        Ok(measured)
    }

    /// Measures light that falls on the sensor in a frame.
    pub(crate) fn measure_light(
        &self,
        exposure: Exposure,
        frame: u32,
        speckled: bool,
    ) -> Result<MeasuredFrame, ScanError> {
        let seed = derived(self.scene.render.seed, Purpose::Frame, u64::from(frame));
        let context = self.context(frame, speckled);
        context.measure(exposure, frame, seed)
    }

    /// Measures a frame once more, where nothing has moved since: the light is the same, and the
    /// noise of the sensor is drawn anew, from the seed of the scene and the `number` of the
    /// repetition.
    ///
    /// # Errors
    ///
    /// Returns an error if the light cannot be exposed.
    pub fn repeat(&self, frame: &MeasuredFrame, number: u32) -> Result<MeasuredFrame, ScanError> {
        let seed = derived(
            self.scene.render.seed,
            Purpose::Frame,
            u64::from(u32::MAX - number),
        );
        let context = self.context(frame.frame, frame.reference_point.is_some());
        let mut repeated = context.measure(frame.exposure.clone(), frame.frame, seed)?;
        repeated.reference_point = frame.reference_point;
        Ok(repeated)
    }

    /// Returns how speckle correlates the positions of the line between a frame and the frames that
    /// follow, up to `frames` of them together, by the law of its motion and decorrelation.
    pub fn frame_correlation(&self, first: &MeasuredFrame, frames: u32) -> FrameCorrelation {
        let context = self.context(first.frame, first.reference_point.is_some());
        let table = |later: u32| match self.speckle_change(first, later) {
            Some(change) => context.correlation(&first.exposure, &first.points, &change),
            None if later == 0 => vec![1.0],
            None => vec![0.0],
        };
        FrameCorrelation::new((0..frames).map(table).collect())
    }

    /// Returns the change of the speckle of the line a number of frames later, by the law with
    /// which frames are rendered; `None` without speckle and where that law has no value, so that
    /// each frame has its own speckle.
    ///
    /// The point in the middle of the profile represents all points.
    pub fn speckle_change(&self, first: &MeasuredFrame, later: u32) -> Option<SpeckleChange> {
        /// The laser of the line.
        const LASER: usize = 0;
        let point = first.reference_point.as_ref()?;
        let frames = [first.frame, first.frame.saturating_add(later)];
        SpeckleChange::between(&self.scene, LASER, point, frames)
    }

    fn context(&self, frame: u32, speckled: bool) -> FrameContext<'_> {
        FrameContext {
            sensor: &self.sensor,
            detector: &self.detector,
            calibration: &self.calibration,
            further: self.further_covariance(),
            speckle: speckled.then_some(&self.speckle),
            to_part: self.motion.to_part(frame),
        }
    }

    /// The covariance of a further uncertainty of heights.
    fn further_covariance(&self) -> DMat3 {
        let height = self.height_uncertainty * self.scan.height;
        DMat3::from_cols(height.x * height, height.y * height, height.z * height)
    }

    /// The middle point of the profile in the world, with the normal that the render has seen
    /// there.
    fn reference_point(&self, measured: &MeasuredFrame, rendered: &Frame) -> Option<FollowedPoint> {
        let middle = middle(&measured.points)?;
        let row = to_usize(middle.seen.pixel.y).min(rendered.lights.height() - 1);
        let at = (middle.seen.column, row);
        let [x, y, z] = [0, 1, 2].map(|axis| f64::from(rendered.normal[axis][at]));
        let world = self.motion.head_at(measured.frame);
        Some(FollowedPoint {
            surface: *self.motion.surfaces().first()?,
            position: world.point(middle.seen.point.position),
            normal: DVec3::new(x, y, z).try_normalize()?,
        })
    }
}

/// The laser that draws the line.
fn line_laser(scene: &Scene) -> Result<&Laser, ScanError> {
    let laser = scene.lasers.first();
    laser
        .filter(|laser| matches!(laser.description().shape, BeamShape::Line { .. }))
        .ok_or_else(|| {
            let why = "the first [[laser]] of the scene must draw a line: [laser.line]";
            ScanError::Scene(why.to_owned())
        })
}

/// Checks that the line crosses columns.
fn check_direction(camera: &Camera, laser: &Laser) -> Result<(), ScanError> {
    /// A step along the line, in metres, small against anything that is triangulated.
    const STEP: f64 = 1e-5;
    let description = laser.description();
    let along = STEP * description.line_direction.normalize_or_zero();
    let ends = [-along, along].map(|step| camera.project(description.look_at + step));
    let [Some(left), Some(right)] = ends else {
        return Err(ScanError::Scene(
            "the camera must see the point that the laser looks at".to_owned(),
        ));
    };
    let DVec2 { x, y } = (right - left).abs();
    if x > y {
        return Ok(());
    }
    Err(ScanError::Scene(
        "the laser line must run from left to right in the image: turn the camera by its `up`, or \
         the line by its `line_direction`"
            .to_owned(),
    ))
}

/// Checks that the image is what the pixels of a sensor see.
fn check_render(scene: &Scene) -> Result<(), ScanError> {
    let render = &scene.render;
    let wrong = if render.filter != Filter::default() {
        "`filter` in [render] must be left out: a sensor sees the mean over the sensitive part of \
         a pixel"
    } else if render.crop.is_some() {
        "`crop` in [render] must be left out: a sensor exposes all of its pixels"
    } else if render.method != Method::Path {
        "`method` in [render] must be \"path\", which integrates over the sensitive part of a pixel"
    } else {
        return Ok(());
    };
    Err(ScanError::Scene(wrong.to_owned()))
}

/// The speckle on the sensor; for several surfaces of the part, the speckle of the greatest
/// contrast.
fn speckle(
    scene: &Scene,
    laser: &Laser,
    motion: &ScanMotion,
    sensor: &Sensor,
) -> Result<ImageSpeckle, ScanError> {
    let surfaces = motion.surfaces().iter();
    let variances = surfaces.map(|&index| variance(&scene.surfaces[index].speckle));
    let sensitive_side = 2.0 * sensor.sensitive_half_width();
    let variance = variances.fold(0.0, f64::max);
    ImageSpeckle::new(scene.camera, laser.wavelength(), (sensitive_side, variance))
}

/// The square of the contrast of the speckle of a surface: (1 + P²)/2 by the number of patterns.
fn variance(speckle: &SurfaceSpeckle) -> f64 {
    0.5 * (1.0 + speckle.polarisation * speckle.polarisation) / f64::from(speckle.patterns)
}

/// The grey value at which a pixel may be saturated, four standard deviations of its noise in the
/// dark below a full well.
fn saturation(sensor: &SensorDescription) -> f64 {
    let noise = 4.0 * sensor.dark_noise.hypot(sensor.dsnu);
    let full = sensor.black_level + sensor.gain * (sensor.full_well - noise);
    // A well that holds no more than its noise cannot be told from a full one.
    sensor.largest_value().min(full.max(1.0))
}
