//! Rendered frames of laser lines on a plate under speckle, and the scatter of their columns.

use tem00::{
    tracer::{Crop, RenderOptions, Scene},
    triangulation::{
        DVec2, DVec3, DetectorSettings, LaserPlane, LineDetector, LineMethod, Triangulator,
    },
};

use crate::renders;

const WAVELENGTH: f64 = 650e-9;
const DISTANCE: f64 = 0.3;

/// A line and a camera that looks at it.
#[derive(Clone, Copy, Debug)]
pub(crate) struct LineFrames {
    /// Full 1/e² thickness of the line on the plate, in metres.
    pub(crate) thickness: f64,
    pub(crate) f_number: f64,
    /// Side of a pixel, in metres: the height of a row that is read across the line.
    pub(crate) pixel_pitch: f64,
    /// Between the axis of the camera and the laser, which shines squarely onto the plate, in
    /// degrees.
    pub(crate) angle: f64,
    pub(crate) samples_per_pixel: u32,
    /// Length of the lines in the image, in speckle sizes: no more than the speckle pattern is
    /// wide.
    pub(crate) length: usize,
    /// Lines at different places of one speckle pattern.
    pub(crate) lines: usize,
    pub(crate) seed: u64,
}

/// What the columns of the frames tell. Lengths are in speckle sizes h in the image.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Noise {
    /// The 1/e² half-width of the line in the image.
    pub(crate) radius: f64,
    /// The extent of a pixel along the line.
    pub(crate) row_height: f64,
    /// Standard deviation of the centroids.
    pub(crate) deviation: f64,
    /// Relative standard error of that.
    pub(crate) error: f64,
}

impl LineFrames {
    /// Returns the scene with the laser square above a place `y` of the plate, and an image of
    /// `resolution`.
    fn scene(&self, y: f64, resolution: [usize; 2]) -> Scene {
        let (sin, cos) = self.angle.to_radians().sin_cos();
        renders::scene(&format!(
            r#"
            [camera]
            position = [0, {camera_y}, {camera_z}]
            look_at = [0, 0, 0]
            focal_length = 25e-3
            f_number = {f_number}
            pixel_pitch = {pitch}
            resolution = {resolution:?}

            [speckle]
            size = {size}
            diameter = {diameter}

            [[laser]]
            wavelength = {WAVELENGTH}
            power = 5e-3
            position = [0, {y}, 0.25]
            look_at = [0, {y}, 0]
            [laser.line]
            fan_angle = "60 deg"
            thickness = {thickness}
            focus_curve = "plane"
            profile = "uniform"

            [[surface]]
            rectangle = {{ centre = [0, 0, 0], normal = [0, 0, 1], size = [0.4, 0.4] }}
            lambertian = {{ reflectance = 0.5 }}
            "#,
            camera_y = -DISTANCE * sin,
            camera_z = DISTANCE * cos,
            f_number = self.f_number,
            pitch = self.pixel_pitch,
            size = 2 * self.length,
            diameter = self.length,
            thickness = self.thickness,
        ))
    }

    /// Renders the lines and finds them in all columns by their wide centres of gravity.
    pub(crate) fn noise(&self) -> Noise {
        self.noise_by(&[LineMethod::CentreOfGravity]).remove(0)
    }

    /// Renders the lines and finds them in all columns by each of the methods.
    pub(crate) fn noise_by(&self, methods: &[LineMethod]) -> Vec<Noise> {
        let camera = self.scene(0.0, [1, 1]).camera;
        let geometry = camera.imaging_geometry(WAVELENGTH).expect("a lens");
        let speckle_size = geometry.speckle_size_in_pixels();
        let scale = camera.image_distance() / DISTANCE / self.pixel_pitch;
        let radius = 0.5 * self.thickness * scale * self.angle.to_radians().cos();
        #[expect(
            clippy::cast_possible_truncation,
            clippy::cast_sign_loss,
            reason = "a few hundred pixels"
        )]
        let [columns, rows] =
            [self.length as f64 * speckle_size, 4.0 * radius].map(|length| length.ceil() as usize);
        // Columns hold what is independent at distances of 0.76 h, ∫ of the squared correlation of
        // points of rows, or of the pixels themselves.
        let row_height = speckle_size.recip();
        let independent = (self.lines * self.length) as f64 / row_height.hypot(0.76);
        let places = self.places([columns, rows], methods);
        let noise = |places: &Vec<f64>| {
            let squares: f64 = places.iter().map(|place| place * place).sum();
            Noise {
                radius: radius / speckle_size,
                row_height,
                deviation: (squares / places.len() as f64).sqrt() / speckle_size,
                error: (2.0 * independent).sqrt().recip(),
            }
        };
        places.iter().map(noise).collect()
    }

    /// Returns, for each method, how far each column of each line seems from where it is without
    /// speckle, in pixels.
    fn places(&self, [columns, rows]: [usize; 2], methods: &[LineMethod]) -> Vec<Vec<f64>> {
        let detectors = methods.iter().map(|&method| {
            // So wide that the window holds the whole line wherever its brightest speckle is.
            let detector = LineDetector::new(DetectorSettings {
                method,
                window: 2 * rows - 1,
                min_peak: 0.0,
                ..DetectorSettings::default()
            });
            detector.expect("a detector")
        });
        let detectors: Vec<_> = detectors.collect();
        let resolution = [columns, rows * self.lines];
        let scene = self.scene(0.0, resolution);
        let plate = LaserPlane::new(DVec3::ZERO, DVec3::Z).expect("a plane");
        let on_plate = Triangulator::new(scene.camera, plate);
        let options = RenderOptions {
            samples_per_pixel: self.samples_per_pixel,
            seed: self.seed,
            ..RenderOptions::default()
        };
        let model = renders::speckle(&scene, self.seed);
        let mut places = vec![Vec::new(); methods.len()];
        for line in 0..self.lines {
            let middle = (line as f64 + 0.5) * rows as f64;
            let point = on_plate.point(DVec2::new(0.5 * columns as f64, middle));
            let y = point.expect("the camera sees the plate").y;
            let options = RenderOptions {
                crop: Some(Crop {
                    x: 0,
                    y: line * rows,
                    width: columns,
                    height: rows,
                }),
                ..options
            };
            let frame = renders::frame(&self.scene(y, resolution), Some(&model), 0, &options);
            let layers = &frame.lasers[0];
            let [speckled, even] = [&layers.radiance, &layers.single];
            for x in 0..columns {
                let [speckled, even] =
                    [speckled, even].map(|image| between_dark((0..rows).map(|y| image[(x, y)])));
                for (detector, places) in detectors.iter().zip(&mut places) {
                    places.push(place(detector, &speckled) - place(detector, &even));
                }
            }
        }
        places
    }
}

/// Returns a column with as many dark pixels before it and after it.
fn between_dark(column: impl ExactSizeIterator<Item = f32>) -> Vec<f32> {
    let rows = column.len();
    let dark = || core::iter::repeat_n(0.0, rows);
    dark().chain(column).chain(dark()).collect()
}

fn place(detector: &LineDetector, column: &[f32]) -> f64 {
    let points = detector.detect_column(column);
    points.first().expect("a column with a line").position
}
