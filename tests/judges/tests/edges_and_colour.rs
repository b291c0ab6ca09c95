//! Artefacts of edges and colour: how far a rendered scanner errs at a step of reflectance, at a
//! corner and at the end of a strip, by the centre of gravity of each profile and by space–time
//! analysis (Curless & Levoy 1995).
//!
//! Line and pixels are those of their scanner. Each case moves under the line by one pixel per
//! frame, its edge at a slant, so that 32 columns see it at 32 positions between two rows.

use core::f64::consts::PI;
use std::sync::atomic::AtomicBool;

use tem00::{
    calibration::CalibrationSettings,
    geometry::{Rectangle, Shape},
    numerics::Grid,
    scan::{Measurement, MeasurementScene, ScanSettings},
    tracer::{Material, Scene, Surface, Trajectory},
    triangulation::{DVec2, DVec3, DetectorSettings, SensorDescription},
};

use crate::renders;

/// The angle between the axis of the camera and the plane of the laser, in radians.
const ANGLE: f64 = PI / 6.0;
/// The standard deviation of the line, in metres: a quarter of its full width of 0.9 mm.
const SIGMA: f64 = 0.9e-3 / 4.0;
/// The height that a pixel sees of the plane of the laser, in metres.
const HEIGHT_PER_PIXEL: f64 = 0.5e-3;
/// Columns and rows of the images.
const SIZE: [usize; 2] = [32, 32];
/// The frames of a scan; in the middle one the edge crosses the line.
const FRAMES: u32 = 25;
const MIDDLE: f64 = 12.0;
/// The frames at either end that hold no whole pulse: 5 are 6 standard deviations of it.
const MARGIN: f64 = 5.0;

/// What a pixel sees across the axis of the camera, in metres.
fn footprint() -> f64 {
    HEIGHT_PER_PIXEL * ANGLE.sin()
}

/// What a pixel sees of a card, in metres: by so much a part moves from frame to frame.
fn step() -> f64 {
    footprint() / ANGLE.cos()
}

/// The tangent of the angle between edge and line: over all columns the edge goes on by one step.
fn slant() -> f64 {
    step() / (SIZE[0] as f64 * footprint())
}

/// A part with a straight edge.
#[derive(Clone, Copy, Debug)]
struct Part {
    /// The reflectances of what lies before and behind the edge; 0 where there is nothing.
    reflectance: [f64; 2],
    /// How far each side reaches, in metres.
    width: f64,
    /// The slope by which both sides fall from the edge.
    slope: f64,
}

impl Part {
    const fn card(ratio: f64) -> Self {
        Self {
            reflectance: [0.8 / ratio, 0.8],
            width: 10e-3,
            slope: 0.0,
        }
    }

    const STRIP: Self = Self {
        reflectance: [0.8, 0.0],
        width: 4e-3,
        slope: 0.0,
    };

    /// A roof of 120°.
    fn roof() -> Self {
        Self {
            reflectance: [0.8; 2],
            width: 8e-3,
            slope: (PI / 6.0).tan(),
        }
    }

    fn surfaces(&self) -> Vec<Surface> {
        let along = DVec3::new(1.0, slant(), 0.0).normalize();
        let start = -MIDDLE * step() * DVec3::Y;
        let motion = Trajectory::steady(step() * DVec3::Y).expect("a motion");
        let side = |sign: f64, reflectance: f64| {
            let outwards = sign * DVec3::Z.cross(along) - self.slope * DVec3::Z;
            let half = 0.5 * self.width * outwards.normalize();
            let shape = Rectangle::new(start + half, 20e-3 * along, half).expect("a side");
            let material = Material::lambertian(reflectance).expect("a colour");
            let mut surface = Surface::new("side", Shape::Rectangle(shape), material);
            surface.trajectory = motion.clone();
            surface
        };
        [-1.0, 1.0]
            .into_iter()
            .zip(self.reflectance)
            .filter(|(_, reflectance)| *reflectance > 0.0)
            .map(|(sign, reflectance)| side(sign, reflectance))
            .collect()
    }

    /// The height of the part under the line where the edge is `edge` beyond it, in metres.
    fn height(&self, edge: f64) -> f64 {
        -self.slope * edge.abs()
    }
}

fn scene(part: &Part) -> Scene {
    let mut scene = renders::scene(&format!(
        r#"
        [render]
        frames = {FRAMES}
        samples_per_pixel = 1024
        max_depth = 1
        [camera]
        position = [0, {}, {}]
        look_at = [0, 0, 0]
        up = [0, 0, 1]
        focal_length = {}
        f_number = 22
        focus_distance = "1 m"
        pixel_pitch = "10 um"
        resolution = [{}, {}]
        [[laser]]
        wavelength = "660 nm"
        power = "5 mW"
        position = [0, 0, "500 mm"]
        look_at = [0, 0, 0]
        line_direction = [1, 0, 0]
        line = {{ fan_angle = "5 deg", thickness = {}, profile = "uniform" }}
        [[surface]]
        rectangle.size = ["1 mm", "1 mm"]
        "#,
        -ANGLE.sin(),
        ANGLE.cos(),
        10e-6 / (10e-6 + footprint()),
        SIZE[0],
        SIZE[1],
        4.0 * SIGMA,
    ));
    scene.surfaces = part.surfaces();
    scene
}

/// A point of a scan.
#[derive(Clone, Copy, Debug)]
struct Point {
    /// The frame in which the line goes through it.
    frame: f64,
    /// The sum of the light by which it was found.
    light: f64,
    position: DVec3,
}

impl Point {
    /// How far the point is above the part, in metres.
    fn error(&self, part: &Part) -> f64 {
        let edge = (self.frame - MIDDLE) * step() + slant() * self.position.x;
        self.position.z - part.height(edge)
    }
}

/// The points by the centre of gravity of each profile, and those by space–time analysis.
fn scan(part: &Part) -> [Vec<Point>; 2] {
    let measurement = Measurement::new(MeasurementScene {
        scene: scene(part),
        sensor: SensorDescription::default(),
        detector: DetectorSettings {
            min_peak: 1e-3,
            window: 21,
            ..DetectorSettings::default()
        },
        calibration: CalibrationSettings::default(),
        scan: ScanSettings::default(),
    });
    let measurement = measurement.expect("a measurement");
    let frames: Vec<Grid<f32>> = (0..FRAMES)
        .map(|frame| {
            let measured = measurement.measure(None, frame, &|_| (), &AtomicBool::new(false));
            measured.expect("a frame").exposure.electrons
        })
        .collect();
    [
        means(&measurement, &frames),
        passages(&measurement, &frames),
    ]
}

fn means(measurement: &Measurement, frames: &[Grid<f32>]) -> Vec<Point> {
    let triangulator = measurement.calibration().triangulator();
    let numbered = frames.iter().enumerate();
    numbered
        .flat_map(|(frame, image)| {
            let lines = measurement.detector().detect(image);
            triangulator
                .profile(&lines, |_, _| 0.0)
                .into_iter()
                .map(move |point| Point {
                    frame: frame as f64,
                    light: point.reflectance,
                    position: point.point.position,
                })
        })
        .filter(is_whole)
        .collect()
}

/// Follows points of the part up the image, by one row per frame, to the mean time of their pulse.
fn passages(measurement: &Measurement, frames: &[Grid<f32>]) -> Vec<Point> {
    let triangulator = measurement.calibration().triangulator();
    let [width, height] = SIZE;
    let mut points = Vec::new();
    for column in 0..width {
        for row in 0..height + frames.len() {
            let seen = frames.iter().enumerate().filter_map(|(frame, image)| {
                let row = row.checked_sub(frame).filter(|row| *row < height)?;
                Some((frame as f64, f64::from(image[(column, row)])))
            });
            let (light, moment) = seen.fold((0.0, 0.0), |(light, moment), (frame, grey)| {
                (light + grey, moment + grey * frame)
            });
            let frame = moment / light;
            let pixel = DVec2::new(column as f64 + 0.5, row as f64 + 0.5 - frame);
            points.extend(triangulator.point(pixel).map(|position| Point {
                frame,
                light,
                position,
            }));
        }
    }
    points.retain(is_whole);
    points
}

/// Whether the whole pulse of a point lies within the scan.
fn is_whole(point: &Point) -> bool {
    (MARGIN..f64::from(FRAMES) - MARGIN).contains(&point.frame)
}

/// The greatest error in height of the points with at least a part of the light of the brightest,
/// in metres.
fn greatest_error(points: &[Point], part: &Part, least_light: f64) -> f64 {
    let brightest = points.iter().map(|point| point.light).fold(0.0, f64::max);
    points
        .iter()
        .filter(|point| point.light >= least_light * brightest)
        .map(|point| point.error(part).abs())
        .fold(0.0, f64::max)
}

/// The height at which a profile's centre of gravity puts a part whose edge is at `edge`, in
/// metres: a sum over the light of the line, each bit of which is seen at `seen` of its place in
/// the image.
fn profile_height(part: &Part, edge: f64, seen: impl Fn(f64) -> f64) -> f64 {
    const INTERVALS: u32 = 20_000;
    const REACH: f64 = 8.0 * SIGMA;
    let light = |i: u32| {
        let y = REACH * ((2.0 * f64::from(i) + 1.0) / f64::from(INTERVALS) - 1.0);
        let [reflectance, slope] = if y < edge {
            [part.reflectance[0], part.slope]
        } else {
            [part.reflectance[1], -part.slope]
        };
        let stretch = ANGLE.cos() + slope * ANGLE.sin();
        let place = y * ANGLE.cos() + part.height(y - edge) * ANGLE.sin();
        let light = reflectance * stretch * (-0.5 * (y / SIGMA).powi(2)).exp();
        [light, light * seen(place)]
    };
    let [light, moment] = (0..INTERVALS)
        .map(light)
        .fold([0.0; 2], |sum, bit| [sum[0] + bit[0], sum[1] + bit[1]]);
    moment / light / ANGLE.sin()
}

/// The greatest error in height of such profiles, in metres, over the edges that the columns of a
/// scan see.
fn greatest_profile_error(part: &Part, seen: impl Fn(f64) -> f64) -> f64 {
    let edges = (-200..200).map(|i| (f64::from(i) + 0.5) / SIZE[0] as f64 * step());
    // The line's middle must be on the part.
    edges
        .filter(|&edge| edge < 0.0 || part.reflectance[0] > 0.0)
        .filter(|&edge| edge > 0.0 || part.reflectance[1] > 0.0)
        .map(|edge| (profile_height(part, edge, &seen) - part.height(edge)).abs())
        .fold(0.0, f64::max)
}

/// The middle of the row in which a place is seen, the line being between two rows.
fn row(place: f64) -> f64 {
    ((place / footprint()).floor() + 0.5) * footprint()
}

/// Noise and perspective of rendered heights, in metres: three times the greatest error on an even
/// card, 0.34 µm.
const NOISE: f64 = 1e-6;

/// By how much the edges that the columns see may miss the worst case of space–time analysis, in
/// metres. Their distance from it is at most 1/64 of a pixel, and no error near its maximum changes
/// by more than half of a pixel per pixel: that is the law of the strip.
const BETWEEN_EDGES: f64 = HEIGHT_PER_PIXEL / 128.0;

/// Compares the greatest errors of both ways, in metres, with the model and with the law of
/// space–time analysis.
fn compare(part: &Part, least_light: f64, law: f64) {
    let [profiles, passages] = scan(part).map(|points| {
        assert!(points.len() > 200, "{} points of {part:?}", points.len());
        greatest_error(&points, part, least_light)
    });
    let model = greatest_profile_error(part, row);
    assert!(
        (profiles - model).abs() < NOISE,
        "profiles of {part:?}: {profiles:e} m, the model has {model:e} m"
    );
    assert!(
        (law - BETWEEN_EDGES - NOISE..law + NOISE).contains(&passages),
        "space–time analysis of {part:?}: {passages:e} m, its law has {law:e} m"
    );
}

#[test]
fn cards_err_by_the_line_in_profiles_and_by_the_pixel_in_space_and_time() {
    for ratio in [1.0, 2.0, 5.0, 10.0_f64] {
        let root = ratio.sqrt();
        let law = 0.5 * HEIGHT_PER_PIXEL * (root - 1.0) / (root + 1.0);
        compare(&Part::card(ratio), 0.0, law);
    }
}

#[test]
fn a_corner_errs_by_the_line_in_profiles_and_by_the_pixel_in_space_and_time() {
    let roof = Part::roof();
    let [cos, rise] = [ANGLE.cos(), roof.slope * ANGLE.sin()];
    let roots = (cos - rise).sqrt() + (cos + rise).sqrt();
    compare(&roof, 0.0, roof.slope * footprint() / (roots * roots));
}

#[test]
fn the_end_of_a_strip_errs_by_the_line_in_profiles_and_by_the_pixel_in_space_and_time() {
    // At the end of the strip a profile, as well as a pixel in space and time, has half of its
    // light.
    compare(&Part::STRIP, 0.5, 0.25 * HEIGHT_PER_PIXEL);
}

/// Steps of reflectance, and where the centre of gravity lies on the edge itself, in standard
/// deviations of the line: the root t of t (Φ(t) + r Φ(−t)) = (r − 1) φ(t), by bisection.
const EDGES: [[f64; 2]; 3] = [[2.0, 0.276_030], [5.0, 0.636_027], [10.0, 0.901_462]];

#[test]
fn profiles_in_fine_pixels_err_by_their_closed_forms() {
    let fine = |place| place;
    let check = |name: &str, found: f64, expected: f64| {
        // The sum's intervals are 0.0008 σ wide, and an edge lies anywhere in one.
        let difference = (found - expected).abs();
        assert!(difference < 1e-3 * SIGMA, "{name}: {found:e}, {expected:e}");
    };
    for [ratio, edge] in EDGES {
        let card = Part::card(ratio);
        let height = |edge| profile_height(&card, edge * SIGMA, fine);
        let expected = edge * SIGMA / ANGLE.tan();
        check("on the edge", height(edge), expected);
        let greatest = (-40..40).map(|i| height(0.05 * f64::from(i)));
        assert!(
            greatest.fold(0.0, f64::max) < expected + 1e-3 * SIGMA,
            "{ratio}"
        );
    }
    let peak = 1.0 / (2.0 * PI).sqrt();
    let strip = -profile_height(&Part::STRIP, 0.0, fine);
    check("strip", strip, 2.0 * peak * SIGMA / ANGLE.tan());
    let roof = Part::roof();
    let corner = -profile_height(&roof, 0.0, fine);
    check("corner", corner, 4.0 * peak * roof.slope * SIGMA);
}
