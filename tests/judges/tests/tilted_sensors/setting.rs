use std::sync::atomic::AtomicBool;

use tem00::{
    calibration::CalibrationSettings,
    camera::{Camera, CameraDescription, RadialDistortion, SensorTilt},
    engine::SpeckleModel,
    geometry::{Rectangle, Shape},
    numerics::Grid,
    scan::{MeasuredFrame, Measurement, MeasurementScene, ScanSettings},
    tracer::{RenderOptions, Trajectory},
    triangulation::{DVec2, DVec3, DetectorSettings, SensorDescription},
};

use crate::renders;

/// Columns and rows of the images.
pub(crate) const SIZE: [usize; 2] = [512, 56];

/// A plate under a laser line, and a camera 100 mm away that looks at the plane of the laser, y =
/// 0, at 45°.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Setting {
    pub(crate) name: &'static str,
    pub(crate) tilt: SensorTilt,
    pub(crate) distortion: RadialDistortion,
    /// Where the line is in the middle of the image, on a plate at this height.
    pub(crate) seen: DVec3,
    /// How far the plate moves from frame to frame.
    pub(crate) step: DVec3,
}

/// The plane of the laser is in focus where tan τ = m/tan 45°, at m = 16/84.
const SCHEIMPFLUG: f64 = 16.0 / 84.0;

impl Setting {
    /// A sensor tilted so that all of the plane of the laser is in focus.
    pub(crate) fn scheimpflug(z: f64, step: f64) -> Self {
        Self {
            name: "Scheimpflug",
            tilt: SensorTilt {
                angle: -SCHEIMPFLUG.atan(),
                azimuth: 0.0,
            },
            distortion: RadialDistortion::default(),
            seen: DVec3::new(0.0, 0.0, z),
            step: DVec3::new(0.0, step, 0.0),
        }
    }

    /// The scene, with a sensor that adds next to no noise.
    pub(crate) fn scene(&self, frames: u32, seed: u64) -> MeasurementScene {
        let [width, height] = SIZE;
        let text = format!(
            r#"
            [render]
            frames = {frames}
            samples_per_pixel = 16
            [camera]
            position = [0, "-70.710678 mm", "70.710678 mm"]
            look_at = [0, 0, 0]
            up = [0, 0, 1]
            focal_length = "16 mm"
            f_number = 8
            focus_distance = "100 mm"
            pixel_pitch = "3.45 um"
            resolution = [{width}, {height}]
            [[laser]]
            wavelength = "660 nm"
            power = "5 mW"
            position = [0, 0, "300 mm"]
            look_at = [0, 0, 0]
            line_direction = [1, 0, 0]
            line = {{ fan_angle = "20 deg", thickness = "0.3 mm", profile = "uniform" }}
            [[surface]]
            rectangle.size = ["30 mm", "20 mm"]
            "#
        );
        let mut scene = renders::scene(&text);
        scene.camera = self.camera(scene.camera.description());
        let plate = Rectangle::new(self.seen, 15e-3 * DVec3::X, 10e-3 * DVec3::Y);
        scene.surfaces[0].shape = Shape::Rectangle(plate.expect("a plate"));
        scene.surfaces[0].trajectory = Trajectory::steady(self.step).expect("a motion");
        scene.render.seed = seed;
        MeasurementScene {
            scene,
            sensor: SensorDescription {
                exposure_time: 1e-3,
                full_well: 1e7,
                gain: 1e-2,
                bit_depth: 16,
                ..SensorDescription::default()
            },
            detector: DetectorSettings::default(),
            calibration: CalibrationSettings::default(),
            scan: ScanSettings::default(),
        }
    }

    /// The camera, its sensor moved sideways to where the line is seen.
    fn camera(&self, description: &CameraDescription) -> Camera {
        let description = CameraDescription {
            tilt: self.tilt,
            distortion: self.distortion,
            ..*description
        };
        let middle = 0.5 * DVec2::new(SIZE[0] as f64, SIZE[1] as f64);
        let camera = Camera::new(description).expect("a camera");
        let seen = camera.project(self.seen).expect("a line before the camera");
        Camera::new(CameraDescription {
            principal_point: Some(middle + middle - seen),
            ..description
        })
        .expect("a camera")
    }
}

/// Sums over parts of images that are independent of each other, and what they are divided by.
#[derive(Default)]
pub(crate) struct Ratio {
    parts: Vec<[f64; 2]>,
}

impl Ratio {
    /// Adds an independent part: its sum, and what that is divided by.
    pub(crate) fn add(&mut self, part: [f64; 2]) {
        self.parts.push(part);
    }

    /// Returns the ratio of all sums and its standard error.
    ///
    /// To first order the error is Σ (a − r b) / Σ b, whose terms are independent.
    pub(crate) fn with_error(&self) -> [f64; 2] {
        let sum = |term: &dyn Fn(&[f64; 2]) -> f64| self.parts.iter().map(term).sum::<f64>();
        let divisor = sum(&|[_, b]| *b);
        let ratio = sum(&|[a, _]| *a) / divisor;
        let squares = sum(&|[a, b]| (a - ratio * b).powi(2));
        [ratio, squares.sqrt() / divisor]
    }
}

/// A measurement and its speckle.
pub(crate) struct Prepared {
    pub(crate) measurement: Measurement,
    speckle: SpeckleModel,
}

impl Prepared {
    pub(crate) fn new(scene: MeasurementScene) -> Self {
        Self {
            speckle: renders::speckle(&scene.scene, scene.scene.render.seed),
            measurement: Measurement::new(scene).expect("a scan"),
        }
    }

    /// Measures a frame.
    pub(crate) fn measure(&self, frame: u32) -> MeasuredFrame {
        let cancel = AtomicBool::new(false);
        let measured = self
            .measurement
            .measure(Some(&self.speckle), frame, &|_| (), &cancel);
        measured.expect("a frame")
    }

    /// Renders the speckle factors of a frame.
    pub(crate) fn speckle(&self, frame: u32) -> Grid<f32> {
        let scene = self.measurement.scene();
        let options = RenderOptions {
            samples_per_pixel: 4,
            // The layer is looked at where the line is not, too.
            speckle_in_the_dark: true,
            ..scene.render
        };
        let mut rendered = renders::frame(scene, Some(&self.speckle), frame, &options);
        rendered.lasers.remove(0).speckle
    }
}
