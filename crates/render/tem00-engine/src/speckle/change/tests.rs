use tem00_decorrelation::{
    Configuration, ConfigurationData, Illumination, SpeckleMotion, equivalent_pupil_shift,
};
use tem00_testkit::assert_absolute;
use tem00_tracer::{BeamShape, Keyframe, Rotation, Scene, Trajectory};

use super::*;
use crate::testing;

/// Turns an image vector with y down, in pixels, into one with y up, and back.
fn upright(pixel: DVec2) -> DVec2 {
    DVec2::new(pixel.x, -pixel.y)
}

/// A plate under a spot that diverges, from the side, a little out of focus.
fn scene() -> Scene {
    let mut camera = testing::camera(DVec3::new(0.02, 0.0, 0.3), [640, 480]);
    camera.focus_distance = 0.29;
    let mut laser = testing::spot(DVec3::new(0.1, 0.0, 0.25), 20e-6);
    laser.shape = BeamShape::Spot {
        waist_radius: [20e-6; 2],
        waist_distance: [0.0; 2],
        m_squared: [1.0; 2],
    };
    let normal = DVec3::new(0.3, 0.1, 1.0).normalize();
    let plate = testing::plate(DVec3::ZERO, normal, [0.04, 0.04]);
    let mut scene = testing::scene(camera, &[laser], plate);
    scene.frames = 8;
    scene
}

fn steady(axis: DVec3, angle: f64, displacement: DVec3) -> Trajectory {
    let pivot = DVec3::new(0.01, -0.02, 0.05);
    Trajectory::turning(pivot, Rotation { axis, angle }, displacement).unwrap()
}

/// A scene in which the plate, the camera and the laser each have their own motion.
fn moving() -> Scene {
    let mut scene = scene();
    scene.surfaces[0].trajectory = steady(DVec3::Y, 2e-3, DVec3::new(1e-4, 2e-4, 3e-4));
    scene.camera_trajectory = steady(DVec3::new(1.0, 0.5, 0.2), 1e-3, DVec3::X * 2e-4);
    let laser = steady(DVec3::Z, -3e-3, DVec3::new(0.0, 1e-4, 0.0));
    scene.lasers[0] = scene.lasers[0].clone().with_trajectory(laser);
    scene
}

/// The point of the plate at `fractions` of its half edges, as the camera sees it in `frame`.
fn point(scene: &Scene, frame: u32, fractions: [f64; 2]) -> SpecklePoint {
    let tem00_geometry::Shape::Rectangle(plate) = &scene.shapes_at(frame)[0] else {
        panic!("the plate is a rectangle");
    };
    let [u, v] = fractions;
    let position = plate.centre() + u * plate.half_u() + v * plate.half_v();
    SpecklePoint {
        wave: 0.5,
        pixel: scene.camera_at(frame).project(position).unwrap(),
        position,
        normal: plate.normal(),
        surface: 0,
    }
}

fn speckle_shift(scene: &Scene, frame: u32, fractions: [f64; 2]) -> SpeckleShift {
    let geometry = scene.camera.imaging_geometry(650e-9).unwrap();
    let change = Change::new(scene, frame);
    change.speckle_shift(0, &geometry, &point(scene, frame, fractions))
}

const PLACES: [[f64; 2]; 4] = [[0.0, 0.0], [0.1, -0.05], [-0.15, 0.1], [0.05, 0.2]];

#[test]
fn speckle_stays_where_all_moves_as_one() {
    let mut scene = scene();
    let way = DVec3::new(0.01, 0.02, -0.03);
    let motion = steady(DVec3::new(0.2, 1.0, -0.4), 0.1, way);
    scene.surfaces[0].trajectory = motion.clone();
    scene.camera_trajectory = motion.clone();
    scene.lasers[0] = scene.lasers[0].clone().with_trajectory(motion);
    for place in PLACES {
        let speckle_shift = speckle_shift(&scene, 7, place);
        // Positions of a metre are rounded to 1e−16, a pixel is 4e−5 m and the pupil 3e−3 m wide.
        // The equivalent shift is a square root of what rounding takes from γ = 1.
        assert_absolute(speckle_shift.displacement.length(), 0.0, 1e-9);
        assert_absolute(speckle_shift.pupil, 0.0, 1e-9);
    }
}

#[test]
fn speckle_shifts_are_those_of_the_theory_between_two_states() {
    let mut scene = moving();
    scene.reference_frame = 2;
    let geometry = scene.camera.imaging_geometry(650e-9).unwrap();
    let (reference, frame) = (2, 5);
    for place in PLACES {
        // The states put together from the scene's poses, each described anew, without the motion
        // between them: only the tangents of the surface must be carried along.
        let [before, now] = [reference, frame].map(|at| point(&scene, at, place));
        let pose = |at: u32| scene.surfaces[0].trajectory.pose_at(at);
        let carried = pose(reference).inverse().then(&pose(frame));
        let light = |at: u32, point: &SpecklePoint| {
            let wave = scene.laser_at(0, at).next_event(point.position).unwrap();
            Illumination::collimated(wave.wi).unwrap()
        };
        let axes = |at: u32| CameraFrame::from_axes(scene.camera_at(at).axes()).unwrap();
        let state = |at: u32, point: &SpecklePoint| ConfigurationData {
            wavelength: 650e-9,
            point: point.position,
            normal: point.normal,
            illumination: light(at, point),
            camera: axes(at),
            pupil: scene.camera_at(at).position(),
        };
        let old = Configuration::new(state(reference, &before)).unwrap();
        // The camera at rest and the plate turned against it: the same relative motion.
        let home = scene.camera_trajectory.pose_at(frame).inverse();
        let home = home.then(&scene.camera_trajectory.pose_at(reference));
        let relative = RigidMotions {
            surface: carried.then(&home),
            ..RigidMotions::default()
        };
        let wave = scene.laser_at(0, frame).next_event(now.position).unwrap();
        let lit = Illumination::collimated(home.direction(wave.wi));
        let new = old.moved(&relative).unwrap();
        let new = new.with_illumination(lit.unwrap()).unwrap();
        let law = SpeckleMotion::between(&geometry, &old, &new);

        let speckle_shift = speckle_shift(&scene, frame, place);
        let expected = upright(law.speckle_displacement() / geometry.pixel_pitch());
        assert_absolute((speckle_shift.displacement - expected).length(), 0.0, 1e-8);
        // The image of the point itself moves by the difference of its projections.
        let image = upright(law.image_displacement / geometry.pixel_pitch());
        assert_absolute((now.pixel - before.pixel - image).length(), 0.0, 1e-8);
        let lateral = law.pupil_displacement.unwrap().length() / geometry.pupil_diameter();
        let shift = equivalent_pupil_shift(law.correlation).unwrap();
        assert_absolute(speckle_shift.pupil, shift.max(lateral), 1e-9);
        assert!(speckle_shift.pupil > 0.1, "{speckle_shift:?} tells nothing");
    }
}

#[test]
fn time_backwards_moves_the_speckle_back() {
    let mut scene = moving();
    for place in PLACES {
        scene.reference_frame = 1;
        let forth = speckle_shift(&scene, 6, place);
        scene.reference_frame = 6;
        let back = speckle_shift(&scene, 1, place);
        let sum = (forth.displacement + back.displacement).length();
        let size = forth.displacement.length();
        // The stretching by the displacement of the pupil differs in second order between the two
        // directions.
        assert!(sum < 0.01 * size, "{place:?}: {forth:?} {back:?}");
        assert_absolute(forth.pupil / back.pupil, 1.0, 0.02);
    }
}

#[test]
fn points_that_the_theory_does_not_know_have_speckle_of_their_own() {
    let mut scene = scene();
    // Behind the camera at first.
    let mut keyframes = [Keyframe::unmoved(0.0), Keyframe::unmoved(3.0)];
    keyframes[0].displacement = 0.5 * DVec3::Z;
    scene.surfaces[0].trajectory = Trajectory::keyframed(DVec3::ZERO, keyframes).unwrap();
    let expected = SpeckleShift {
        pupil: 3.0,
        ..SpeckleShift::default()
    };
    assert_eq!(speckle_shift(&scene, 3, [0.0, 0.0]), expected);
}

/// A block of many points has the same values as each of them alone.
#[test]
fn a_point_does_not_depend_on_the_points_beside_it() {
    let scene = moving();
    let geometry = scene.camera.imaging_geometry(650e-9).unwrap();
    let change = Change::new(&scene, 5);
    let places = (0..13).map(|i| [0.01 * f64::from(i), 0.02 - 0.015 * f64::from(i)]);
    let points: Vec<_> = places.map(|place| point(&scene, 5, place)).collect();
    for path in [LightPath::Direct, LightPath::Carried] {
        let mut together = vec![None; points.len()];
        change.known_shifts((0, path), &geometry, &points, &mut together);
        for (point, shift) in points.iter().zip(together) {
            let alone = change.known_shift(0, &geometry, point, path);
            assert!(alone.is_some() && shift == alone, "{shift:?} {alone:?}");
        }
    }
}
