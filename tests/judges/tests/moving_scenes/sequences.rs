//! Frames of long sequences, and of motions that are not steady.

use core::f64::consts::TAU;
use std::collections::{BTreeMap, BTreeSet};

use tem00::{
    decorrelation::{DVec3, pupil_overlap_correlation},
    geometry::{Rectangle, Shape},
    numerics::Grid,
    tracer::{Keyframe, Scene, Trajectory},
};

use super::setting::{LENS, Setting, assert_correlation, speckle};

/// Behind this pitch a speckle spans 6.8 pixels, and a surface whose image moves by as little as 80
/// pixels has new speckle.
const PITCH: f64 = 3.45e-6 / 2.0;

/// One pixel on the plate, in metres.
const PIXEL: f64 = 11.0 * PITCH;

/// Pixels by which the image moves with the surface while the pupil moves by its diameter over the
/// speckle.
const DIAMETER: f64 = 80.0;

/// Two frames, and the pixels by which the surface has moved between them, to the right and up.
type Pair = ([u32; 2], [i32; 2]);

/// A plate of so many pixels about the middle of the image, in plane light.
fn scene(frames: u32, width: f64, trajectory: Trajectory) -> Scene {
    let mut setting = Setting {
        lens: LENS,
        to_laser: DVec3::Z,
        distance: None,
    };
    setting.lens.pixel_pitch = PITCH;
    setting.lens.f_number = LENS.focal_length / (DIAMETER * PIXEL);
    let mut scene = setting.scene();
    scene.frames = frames;
    let half = 0.5 * width * PIXEL;
    let plate = Rectangle::new(DVec3::ZERO, half * DVec3::X, 0.01 * DVec3::Y);
    scene.surfaces[0].shape = Shape::Rectangle(plate.expect("a plate"));
    scene.surfaces[0].trajectory = trajectory;
    scene
}

/// A plate that is seen in every frame.
fn long(frames: u32, trajectory: Trajectory) -> Scene {
    scene(frames, 4e5, trajectory)
}

fn steady(pixels: f64) -> Trajectory {
    Trajectory::steady(pixels * PIXEL * DVec3::X).expect("a motion")
}

/// A motion through displacements to the right and up, in pixels, at some frames.
fn keyed(poses: impl IntoIterator<Item = (u32, [f64; 2])>) -> Trajectory {
    let keyframes = poses.into_iter().map(|(frame, [x, y])| Keyframe {
        displacement: PIXEL * DVec3::new(x, y, 0.0),
        ..Keyframe::unmoved(f64::from(frame))
    });
    Trajectory::keyframed(DVec3::ZERO, keyframes).expect("a motion")
}

/// Compares the correlation of frames with the overlap of the pupils: where the surface has gone,
/// or at rest where that is far away.
fn judge(name: &str, scene: &Scene, pairs: &[Pair]) {
    let wavelength = scene.lasers[0].wavelength();
    let geometry = scene.camera.imaging_geometry(wavelength).expect("a lens");
    let frames: BTreeSet<u32> = pairs.iter().flat_map(|(pair, _)| *pair).collect();
    let frames: Vec<_> = frames.into_iter().collect();
    let images = frames.iter().copied().zip(speckle(scene, &frames, 31));
    let images: BTreeMap<u32, Grid<f32>> = images.collect();
    for (pair, way) in pairs {
        let near = if way.iter().all(|pixels| pixels.abs() < 160) {
            *way
        } else {
            [0; 2]
        };
        let [x, y] = way.map(f64::from);
        let law = pupil_overlap_correlation(x.hypot(y) / DIAMETER);
        let name = format!("{name}, frames {pair:?}");
        let size = geometry.speckle_size_in_pixels();
        assert_correlation(&name, pair.map(|frame| &images[&frame]), near, (law, size));
    }
}

#[test]
fn frames_of_a_steady_motion_correlate_by_their_distance_in_any_sequence() {
    // Half a pupil diameter a frame, an eighth in little memory, and two.
    let cases = [
        (40, 256, &[4, 20, 65, 1000][..]),
        (10, 2, &[20, 1000]),
        (160, 256, &[65, 1000]),
    ];
    for (pixels, mebibytes, lengths) in cases {
        for &frames in lengths {
            let mut scene = long(frames, steady(f64::from(pixels)));
            scene.speckle.memory = mebibytes << 20;
            let last = frames - 1;
            let pairs = [
                [1, 2],
                [1, 3],
                [0, last],
                [last - 1, last],
                [last - 2, last],
            ];
            let way = |[i, j]: [u32; 2]| pixels * i32::try_from(j - i).expect("few frames");
            let name = format!("{frames} frames of {pixels} pixels");
            judge(&name, &scene, &pairs.map(|pair| (pair, [way(pair), 0])));
        }
    }
}

#[test]
fn frames_of_motions_that_are_not_steady_correlate_by_their_distance() {
    let rests = keyed([(500, [0.0; 2]), (501, [20.0, 0.0])]);
    // A hundred diameters away, for one frame.
    let visits = keyed([(400, [0.0; 2]), (401, [8e3, 0.0]), (402, [0.0; 2])]);
    // Where it began in every 66th frame, which are 16 of 991.
    let swings = keyed((0..=30).map(|i| (33 * i, [if i % 2 == 0 { 0.0 } else { 330.0 }, 0.0])));
    // A part of 600 pixels that fills the image in three frames of a thousand, 250 diameters from
    // where it began.
    let passes = keyed([(0, [-2e4, 0.0]), (1000, [2e4, 0.0])]);
    // To the right, up, and back to the left, by a quarter of the pupil a frame.
    let rows = [
        [0, 0],
        [1, 0],
        [2, 0],
        [2, 1],
        [1, 1],
        [0, 1],
        [0, 2],
        [1, 2],
    ];
    let rows = keyed((0..).zip(rows.map(|place| place.map(|steps| 20.0 * f64::from(steps)))));
    // Rows of a hundred frames, 50 diameters long.
    let ends = |row: u32| {
        let [first, last] = [0.0, 3960.0].map(|x| [x, 20.0 * f64::from(row)]);
        let frames = [100 * row, 100 * row + 99];
        let turned = row % 2 == 1;
        frames
            .into_iter()
            .zip(if turned { [last, first] } else { [first, last] })
    };
    let scan = keyed((0..10).flat_map(ends));
    let turns = |frame: u32| (TAU * f64::from(frame) / 64.0).sin_cos();
    let circle = (0..1000).map(|frame| (frame, turns(frame)));
    let circle = keyed(circle.map(|(frame, (sin, cos))| (frame, [60.0 * cos, 60.0 * sin])));
    let rest: &[Pair] = &[
        ([0, 500], [0, 0]),
        ([500, 501], [20, 0]),
        ([501, 999], [0, 0]),
        ([3, 998], [20, 0]),
    ];
    let visit: &[Pair] = &[
        ([400, 401], [8000, 0]),
        ([400, 402], [0, 0]),
        ([0, 999], [0, 0]),
    ];
    let swing: &[Pair] = &[
        ([32, 34], [0, 0]),
        ([33, 34], [-10, 0]),
        ([33, 66], [-330, 0]),
        ([33, 363], [0, 0]),
    ];
    let part: &[Pair] = &[
        ([499, 500], [40, 0]),
        ([500, 501], [40, 0]),
        ([499, 501], [80, 0]),
    ];
    let row: &[Pair] = &[
        ([0, 1], [20, 0]),
        ([0, 5], [0, 20]),
        ([1, 5], [-20, 20]),
        ([2, 6], [-40, 40]),
        ([1, 4], [0, 20]),
    ];
    let line: &[Pair] = &[
        ([50, 149], [0, 20]),
        ([450, 549], [0, 20]),
        ([450, 451], [40, 0]),
    ];
    let round: &[Pair] = &[
        ([0, 64], [0, 0]),
        ([16, 48], [0, -120]),
        ([16, 32], [-60, -60]),
        ([32, 992], [0, 0]),
    ];
    let cases = [
        ("a rest, and a jump", long(1000, rests), rest),
        ("a visit", long(1000, visits), visit),
        ("a swing", long(991, swings), swing),
        ("a part that passes", scene(1000, 600.0, passes), part),
        ("rows", long(8, rows), row),
        ("a scan", long(1000, scan), line),
        ("a circle", long(1000, circle), round),
    ];
    for (name, scene, pairs) in &cases {
        judge(name, scene, pairs);
    }
}
