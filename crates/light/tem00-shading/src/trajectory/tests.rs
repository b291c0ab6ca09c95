use core::f64::consts::{FRAC_PI_2, TAU};

use proptest::prelude::*;

use tem00_testkit::refuses;

use super::*;

fn turn(axis: DVec3, angle: f64) -> Rotation {
    Rotation { axis, angle }
}

/// The largest difference between two motions over a few points about a metre from the origin.
fn difference(a: &RigidMotion, b: &RigidMotion) -> f64 {
    [DVec3::ZERO, DVec3::X, DVec3::Y, DVec3::Z]
        .map(|point| (a.point(point) - b.point(point)).length())
        .into_iter()
        .fold(0.0, f64::max)
}

#[test]
fn what_does_not_move_has_the_same_pose_in_every_frame() {
    let still = [
        Trajectory::default(),
        Trajectory::steady(DVec3::ZERO).unwrap(),
        Trajectory::turning(DVec3::ONE, turn(DVec3::X, 0.0), DVec3::ZERO).unwrap(),
        Trajectory::keyframed(DVec3::ONE, [Keyframe::unmoved(0.0), Keyframe::unmoved(3.5)])
            .unwrap(),
    ];
    for trajectory in still {
        assert!(trajectory.is_still(), "{trajectory:?}");
        for frame in [0, 1, 1000, u32::MAX] {
            assert_eq!(trajectory.pose_at(frame), RigidMotion::IDENTITY);
        }
    }
    // An object at a position other than in the scene description is at rest, too.
    let elsewhere = Keyframe {
        displacement: DVec3::X,
        rotation: turn(DVec3::Y, 1.0),
        ..Keyframe::unmoved(0.0)
    };
    let elsewhere = Trajectory::keyframed(DVec3::ZERO, [elsewhere]).unwrap();
    assert!(elsewhere.is_still(), "{elsewhere:?}");
    assert_eq!(elsewhere.pose_at(0), elsewhere.pose_at(7));
}

#[test]
fn steady_motions_turn_about_their_pivot_and_go_on_from_there() {
    let (pivot, axis, step) = (
        DVec3::new(0.3, -0.2, 0.1),
        DVec3::new(1.0, 2.0, -0.5),
        DVec3::new(1e-3, 0.0, -2e-3),
    );
    let trajectory = Trajectory::turning(pivot, turn(axis, 0.01), step).unwrap();
    assert!(!trajectory.is_still(), "{trajectory:?}");
    for frame in [0, 1, 40, 999] {
        let time = f64::from(frame);
        // An independent construction of the rotation, by the theory's rigid bodies.
        let expected = RigidMotion::about(pivot, axis, 0.01 * time)
            .unwrap()
            .then(&RigidMotion::along(step * time).unwrap());
        let error = difference(&trajectory.pose_at(frame), &expected);
        // Ten roundings of numbers up to 3.
        assert!(error < 1e-14, "frame {frame}: {error:e}");
    }
}

#[test]
fn whole_turns_between_keyframes_are_made() {
    let twice = Keyframe {
        rotation: turn(-DVec3::Z, -2.0 * TAU),
        ..Keyframe::unmoved(16.0)
    };
    let start = Keyframe {
        rotation: turn(DVec3::Z, FRAC_PI_2),
        ..Keyframe::unmoved(0.0)
    };
    let trajectory = Trajectory::keyframed(DVec3::X, [start, twice]).unwrap();
    for frame in 0..=16 {
        let angle = FRAC_PI_2 + (2.0 * TAU - FRAC_PI_2) * f64::from(frame) / 16.0;
        let expected = RigidMotion::about(DVec3::X, DVec3::Z, angle).unwrap();
        let error = difference(&trajectory.pose_at(frame), &expected);
        // Rounding of an angle of 13 radians.
        assert!(error < 1e-14, "frame {frame}: {error:e}");
    }
}

#[test]
fn between_rotations_about_different_axes_the_shortest_way_is_taken() {
    // From 10° short of a turn to 10° beyond, about axes a milliradian apart.
    let ends = [
        turn(DVec3::Z, TAU - 0.2),
        turn(DVec3::new(1e-3, 0.0, 1.0), 0.2),
    ];
    for [from, to] in [ends, [ends[1], ends[0]]] {
        let keyframes = [(0.0, from), (2.0, to)].map(|(frame, rotation)| Keyframe {
            rotation,
            ..Keyframe::unmoved(frame)
        });
        let trajectory = Trajectory::keyframed(DVec3::ZERO, keyframes).unwrap();
        let half = difference(&trajectory.pose_at(1), &RigidMotion::IDENTITY);
        assert!(half < 1e-3, "half way it has turned by {half}");
    }
}

#[test]
fn half_a_turn_about_any_axis_is_made_at_a_constant_rate() {
    // Two axes whose rotations differ by just half a turn.
    let (a, b) = (turn(DVec3::X, FRAC_PI_2), turn(DVec3::X, -FRAC_PI_2));
    let tilted = turn(DVec3::new(1.0, 1.0, 0.0), 2.0 * FRAC_PI_2);
    for (from, to) in [(a, b), (Rotation::NONE, tilted), (tilted, a)] {
        let keyframes = [(0.0, from), (8.0, to)].map(|(frame, rotation)| Keyframe {
            rotation,
            ..Keyframe::unmoved(frame)
        });
        let trajectory = Trajectory::keyframed(DVec3::ZERO, keyframes).unwrap();
        let angle = |i: u32| {
            let step = trajectory
                .pose_at(i)
                .inverse()
                .then(&trajectory.pose_at(i + 1));
            let m = step.rotation();
            0.5 * (m.x_axis.x + m.y_axis.y + m.z_axis.z - 1.0)
        };
        for i in 1..8 {
            let error = (angle(i) - angle(0)).abs();
            assert!(error < 1e-14, "{from:?} to {to:?}: step {i} by {error:e}");
        }
        let end = RigidMotion::about(DVec3::ZERO, to.axis, to.angle).unwrap();
        let error = difference(&trajectory.pose_at(8), &end);
        assert!(error < 1e-14, "{from:?} to {to:?}: {error:e}");
    }
}

fn vectors(size: f64) -> impl Strategy<Value = DVec3> {
    [-size..size, -size..size, -size..size].prop_map(DVec3::from_array)
}

prop_compose! {
    fn rotations()(
        axis in vectors(1.0).prop_filter("an axis", |v| v.length() > 1e-3),
        angle in -7.0_f64..7.0,
    ) -> Rotation {
        Rotation { axis, angle }
    }
}

prop_compose! {
    /// Three to six keyframes, one to a few frames apart.
    fn keyframes()(
        start in -5.0_f64..5.0,
        poses in prop::collection::vec((0.5_f64..4.0, vectors(0.5), rotations()), 3..6),
    ) -> Vec<Keyframe> {
        let mut time = start;
        poses.into_iter().map(|(step, displacement, rotation)| {
            time += step;
            Keyframe { frame: time, displacement, rotation }
        }).collect()
    }
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(200))]

    #[test]
    fn poses_pass_through_the_keyframes(keyframes in keyframes(), pivot in vectors(1.0)) {
        let trajectory = Trajectory::keyframed(pivot, keyframes.clone()).unwrap();
        for (i, keyframe) in keyframes.iter().enumerate() {
            let Rotation { axis, angle } = keyframe.rotation;
            let expected = RigidMotion::about(pivot, axis, angle).unwrap()
                .then(&RigidMotion::along(keyframe.displacement).unwrap());
            let error = difference(&trajectory.pose(keyframe.frame), &expected);
            prop_assert!(error < 1e-14, "keyframe {i}: {error:e}");
            // From before it is reached as well: the pose has no jump. Half a turn apart the
            // relative axis is found from products of 1e−16 over sines of some 1e−3.
            let before = trajectory.pose(keyframe.frame - 1e-9);
            let speed = if i == 0 { 0.0 } else { 60.0 };
            let error = difference(&before, &expected);
            prop_assert!(error < 1e-12 + speed * 1e-9, "before keyframe {i}: {error:e}");
        }
        let last = keyframes[keyframes.len() - 1].frame;
        prop_assert_eq!(trajectory.pose(last), trajectory.pose(last + 100.0));
        prop_assert_eq!(trajectory.pose(keyframes[0].frame), trajectory.pose(-100.0));
    }

    #[test]
    fn between_keyframes_the_velocities_are_constant(
        keyframes in keyframes(),
        pivot in vectors(1.0),
        part in 0.01_f64..0.8,
    ) {
        let trajectory = Trajectory::keyframed(pivot, keyframes.clone()).unwrap();
        let (start, end) = (keyframes[0].frame, keyframes[1].frame);
        let step = 0.1 * (end - start);
        // Displacement of the pivot and rotation from one time to a later one.
        let moved = |time: f64| {
            let (a, b) = (trajectory.pose(time), trajectory.pose(time + step));
            let velocity = b.point(pivot) - a.point(pivot);
            (velocity, a.inverse().then(&b).rotation())
        };
        let (v0, r0) = moved(start);
        let (v1, r1) = moved(start + part * (end - start));
        prop_assert!((v1 - v0).length() < 1e-14, "{v0} and {v1}");
        // Steps about one fixed axis of the world: in the frame of the body it is fixed, too.
        prop_assert!((r1 - r0).abs_diff_eq(DMat3::ZERO, 1e-13), "{r0} and {r1}");
        let whole = (keyframes[1].displacement - keyframes[0].displacement) * 0.1;
        prop_assert!((v0 - whole).length() < 1e-14, "{v0} and {whole}");
    }
}

#[test]
fn impossible_motions_are_refused() {
    let good = turn(DVec3::X, 0.1);
    refuses!(displacement_per_frame = DVec3::ZERO => Trajectory::steady(displacement_per_frame);
        displacement_per_frame: [DVec3::NAN, DVec3::X * 1e300]);
    refuses!(pivot = DVec3::ZERO, rotation = good
        => Trajectory::turning(pivot, rotation, DVec3::ZERO);
        pivot: [DVec3::INFINITY],
        rotation as "axis": [turn(DVec3::ZERO, 0.1), turn(DVec3::NAN, 0.1)],
        rotation as "angle": [turn(DVec3::X, f64::NAN), turn(DVec3::X, 1e300)],
    );
    refuses!(pivot = DVec3::ZERO, keyframe = Keyframe::unmoved(2.0)
        => Trajectory::keyframed(pivot, [Keyframe::unmoved(1.0), keyframe]);
        pivot: [DVec3::NAN],
        keyframe.frame: [1.0, f64::NAN, f64::INFINITY],
        keyframe.displacement: [DVec3::NEG_INFINITY],
        keyframe.rotation as "axis": [turn(DVec3::ZERO, 0.1)],
    );
    let none = Trajectory::keyframed(DVec3::ZERO, []);
    assert!(matches!(none, Err(ShadingError::Missing(_))), "{none:?}");
}
