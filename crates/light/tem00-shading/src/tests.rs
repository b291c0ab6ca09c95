//! Guarantees to a host for any query.

use proptest::prelude::*;
use tem00_decorrelation::pupil_overlap_correlation;
use tem00_speckle::SpeckleError;
use tem00_statistics::{exponential_cumulative, kolmogorov_smirnov, pixel_contrast};
use tem00_testkit::{assert_absolute, correlation};

use crate::{
    Camera, CameraDescription, DVec2, DVec3, Illumination, Laser, Motion, Pose, PreparedSpeckle,
    ShadingError, Speckle, SpeckleFrame, Wavefront,
};

fn camera(position: DVec3) -> Camera {
    Camera::new(CameraDescription {
        position,
        focus_distance: position.length(),
        resolution: [96, 64],
        ..CameraDescription::default()
    })
    .unwrap()
}

fn laser() -> Laser {
    let origin = DVec3::new(0.05, 0.02, 0.4);
    Laser::spot(650e-9, 5e-3)
        .placed(origin, DVec3::ZERO, DVec3::X)
        .unwrap()
}

/// A body that slides and turns about an axis through the origin.
fn pose(slide: DVec3, axis: DVec3, angle: f64) -> Pose {
    let turn = Pose::about(DVec3::ZERO, axis, angle).unwrap();
    turn.then(&Pose::along(slide).unwrap())
}

fn prepared(seed: u64, poses: &[Pose]) -> PreparedSpeckle {
    let camera = camera(DVec3::new(-0.05, 0.01, 0.3));
    Speckle::new(&camera, &laser(), seed)
        .for_poses(poses)
        .prepare()
        .unwrap()
}

/// Points of the plane z = 0 in the image that are independent: nearly two speckles of 65 µm apart.
fn places(count: u32) -> Vec<DVec3> {
    let place =
        |i: u32| DVec3::new(f64::from(i % 30) - 14.5, f64::from(i / 30) - 9.5, 0.0) * 120e-6;
    (0..count).map(place).collect()
}

/// The factors at the points that the body carries along.
fn factors(frame: &SpeckleFrame, pose: &Pose, points: &[DVec3]) -> Vec<f64> {
    let normal = pose.direction(DVec3::Z);
    points
        .iter()
        .map(|&point| frame.factor(pose.point(point), normal))
        .collect()
}

fn mean(values: impl Iterator<Item = f64>) -> f64 {
    let (count, sum) = values.fold((0.0, 0.0), |(count, sum), value| (count + 1.0, sum + value));
    sum / count
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(24))]

    /// Factors are finite and not negative for any query, have mean 1, and are exponential.
    #[test]
    fn factors_are_speckle_for_any_pose(
        seed: u64,
        slide in [-3e-4..3e-4, -3e-4..3e-4, -2e-3..2e-3].prop_map(DVec3::from_array),
        axis in [-1.0..1.0, -1.0..1.0, 0.1..1.0].prop_map(DVec3::from_array),
        angle in -4e-3..4e-3,
    ) {
        let pose = pose(slide, axis.normalize(), angle);
        let speckle = prepared(seed, &[pose]);
        let frame = speckle.frame(&pose.into()).unwrap();
        let found = factors(&frame, &pose, &places(600));
        prop_assert!(found.iter().all(|factor| factor.is_finite() && *factor >= 0.0));
        // Five standard errors of the mean of 600.
        prop_assert!((mean(found.iter().copied()) - 1.0).abs() < 5.0 / 600_f64.sqrt());
        let outcome = kolmogorov_smirnov(&found, exponential_cumulative).unwrap();
        prop_assert!(outcome.p_value > 1e-5, "{outcome:?}");
    }

    #[test]
    fn nothing_that_is_asked_gives_nan(
        point in [-10.0..10.0, -10.0..10.0, -10.0..10.0].prop_map(DVec3::from_array),
        normal in [-1.0..1.0, -1.0..1.0, -1.0..1.0].prop_map(DVec3::from_array),
    ) {
        let pose = Pose::along(DVec3::new(2e-4, 0.0, 1e-4)).unwrap();
        let speckle = prepared(1, &[pose]);
        let frame = speckle.frame(&pose.into()).unwrap();
        for point in [point, 1e-3 * point, DVec3::splat(f64::NAN), DVec3::X * f64::INFINITY] {
            for normal in [normal, DVec3::ZERO, DVec3::splat(f64::NAN)] {
                let factor = frame.factor(point, normal);
                prop_assert!(factor.is_finite() && factor >= 0.0, "{factor} at {point}");
                prop_assert!(frame.average(point, normal).is_finite());
                prop_assert!(
                    frame.amplitude(point, normal).is_none_or(|u| u.norm_sqr().is_finite())
                );
            }
        }
    }
}

/// The correlation of the speckle of points that the body carries along follows the law, for
/// motions across, along the line of sight, about axes, and of camera and laser.
#[test]
fn factors_of_two_frames_correlate_by_the_law() {
    let motions = [
        Pose::along(DVec3::new(6e-4, -2e-4, 0.0)).unwrap().into(),
        Pose::along(DVec3::new(4e-4, 0.0, 3e-3)).unwrap().into(),
        pose(DVec3::X * 1e-4, DVec3::Y, 1.5e-3).into(),
        Motion {
            camera: Pose::along(DVec3::Y * 7e-4).unwrap(),
            ..Motion::default()
        },
        Motion {
            laser: Pose::about(DVec3::new(0.05, 0.02, 0.4), DVec3::Y, 2e-3).unwrap(),
            ..Motion::default()
        },
    ];
    let camera = camera(DVec3::new(-0.05, 0.01, 0.3));
    for motion in motions {
        let speckle = Speckle::new(&camera, &laser(), 7)
            .for_motions([motion])
            .prepare()
            .unwrap();
        let [reference, frame] = [Motion::default(), motion].map(|m| speckle.frame(&m).unwrap());
        let points = places(600);
        let carried = |point: DVec3| motion.surface.point(point);
        // The displacement of the peak relative to the image of the point: the factor follows the
        // body, its speckle the peak.
        let normal = motion.surface.direction(DVec3::Z);
        let shift = frame.shift(carried(DVec3::ZERO), normal).unwrap();
        let seen = camera.moved(&motion.camera);
        let beside =
            seen.project(carried(DVec3::ZERO)).unwrap() - camera.project(DVec3::ZERO).unwrap();
        let beside = shift.displacement - beside;
        let before: Vec<_> = points
            .iter()
            .map(|&point| {
                reference.factor_at(camera.project(point).unwrap() - beside, point, DVec3::Z)
            })
            .collect();
        let after = factors(&frame, &motion.surface, &points);
        let law = pupil_overlap_correlation(shift.pupil);
        let found = correlation(&before, &after);
        assert!((0.05..0.95).contains(&law), "{law} tells nothing");
        // Three standard errors of a correlation of exponentials from 600 points, and the excess of
        // the blend.
        let tolerance = 3.0 * (1.0 + law) / 600_f64.sqrt() + 0.02;
        assert!((found - law).abs() < tolerance, "{found}, by the law {law}");
    }
}

#[test]
fn a_body_that_returns_finds_its_old_speckle() {
    let away = pose(DVec3::new(5e-4, 0.0, 1e-3), DVec3::X, 1e-3);
    let speckle = prepared(3, &[away]);
    let points = places(50);
    let at_first = factors(
        &speckle.frame(&Motion::default()).unwrap(),
        &Pose::IDENTITY,
        &points,
    );
    let gone = factors(&speckle.frame(&away.into()).unwrap(), &away, &points);
    let back = factors(
        &speckle.frame(&Pose::IDENTITY.into()).unwrap(),
        &Pose::IDENTITY,
        &points,
    );
    assert_eq!(at_first, back);
    assert_ne!(at_first, gone);
}

#[test]
#[expect(clippy::float_cmp, reason = "the same bits")]
fn batches_have_the_bits_of_single_calls() {
    let pose = pose(DVec3::new(3e-4, 1e-4, 2e-3), DVec3::Y, 1e-3);
    let speckle = prepared(5, &[pose]);
    let frame = speckle.frame(&pose.into()).unwrap();
    let mut points: Vec<_> = places(200)
        .into_iter()
        .map(|point| pose.point(point))
        .collect();
    points[70] = DVec3::splat(f64::NAN);
    points[140] = DVec3::Z;
    let normals = vec![pose.direction(DVec3::Z); points.len()];
    let mut together = vec![0.0; points.len()];
    frame.factors(&points, &normals, &mut together);
    let alone: Vec<_> = points
        .iter()
        .zip(&normals)
        .map(|(&p, &n)| frame.factor(p, n))
        .collect();
    assert_eq!(together, alone);
    assert_eq!([together[70], together[140]], [1.0; 2], "out of sight");
}

#[test]
#[expect(clippy::float_cmp, reason = "the same bits")]
fn normals_may_have_any_length() {
    let moved = pose(DVec3::new(40e-6, 20e-6, 0.0), DVec3::Z, 0.0);
    let frame = prepared(3, &[moved]).frame(&moved.into()).unwrap();
    for point in places(20) {
        let of_length = |length: f64| frame.factor(point, length * DVec3::Z);
        assert_eq!([0.5, 2.0].map(of_length), [of_length(1.0); 2], "{point}");
    }
}

/// Two bodies and the background in the buffers of an image; steps of powers of two are exact.
#[test]
fn buffers_have_the_bits_of_hits() {
    let steps = [
        DVec3::ZERO,
        DVec3::new(2_f64.powi(-12), -(2_f64.powi(-13)), 2_f64.powi(-11)),
    ];
    let poses = steps.map(|step| Pose::along(step).unwrap());
    let speckle = prepared(17, &poses);
    let grid = |i: u32| {
        DVec3::new(f64::from(i % 16) - 8.0, f64::from(i / 16) - 6.0, 0.0) * 2_f64.powi(-13)
    };
    let previous: Vec<_> = (0..192).map(grid).collect();
    let body = |index: usize| index / 70 % 2;
    let mut points: Vec<_> = previous
        .iter()
        .enumerate()
        .map(|(i, &p)| p + steps[body(i)])
        .collect();
    points[100] = DVec3::splat(f64::NAN);
    let normals = vec![DVec3::Z; points.len()];
    let mut found = vec![0.0; points.len()];
    speckle.factors_since(&previous, &points, &normals, &mut found);
    let frames = poses.map(|pose| speckle.frame(&pose.into()).unwrap());
    let hits = points
        .iter()
        .enumerate()
        .map(|(i, &point)| frames[body(i)].factor(point, DVec3::Z));
    assert_eq!(found, hits.collect::<Vec<_>>());
}

#[test]
fn looks_polarisation_and_pixels_lower_the_contrast_by_their_laws() {
    let camera = camera(DVec3::new(-0.05, 0.01, 0.3));
    let speckle = Speckle::new(&camera, &laser(), 11);
    let contrast = |values: &[f64]| {
        let middle = mean(values.iter().copied());
        mean(values.iter().map(|value| (value - middle).powi(2))).sqrt() / middle
    };
    let points = places(600);
    // An error of a contrast from 600 points, three times.
    let tolerance = |contrast: f64| 3.0 * contrast / 600_f64.sqrt() * 1.2;
    for (speckle, law) in [
        (speckle.clone(), 1.0),
        (speckle.clone().looks(4), 0.5),
        (speckle.clone().polarisation(0.0), 0.5_f64.sqrt()),
        (
            speckle.clone().looks(2).polarisation(0.6),
            (0.5 * 0.5 * (1.0 + 0.36_f64)).sqrt(),
        ),
    ] {
        let speckle = speckle.prepare().unwrap();
        let frame = speckle.frame(&Motion::default()).unwrap();
        let found = contrast(&factors(&frame, &Pose::IDENTITY, &points));
        assert_absolute(found, law, tolerance(law));
    }
    let speckle = speckle.prepare().unwrap();
    let frame = speckle.frame(&Motion::default()).unwrap();
    let averages: Vec<_> = points
        .iter()
        .map(|&point| frame.average(point, DVec3::Z))
        .collect();
    let law = pixel_contrast(1.0 / speckle.geometry().speckle_size_in_pixels());
    assert_absolute(contrast(&averages), law, tolerance(law));
}

#[test]
fn bodies_have_speckle_of_their_own() {
    let speckle = prepared(13, &[]);
    let of_body = |body| {
        let frame = speckle
            .frame(&Motion {
                body,
                ..Motion::default()
            })
            .unwrap();
        factors(&frame, &Pose::IDENTITY, &places(600))
    };
    let [first, second] = [0, 1].map(of_body);
    assert!(correlation(&first, &second).abs() < 4.0 / 600_f64.sqrt());
}

/// For any position of a body's patterns in the stack, its field is continuous from slice to slice.
#[test]
fn amplitudes_of_all_bodies_go_on_from_slice_to_slice() {
    const STEPS: u32 = 400;
    let far = Pose::along(DVec3::X * 1e-3).unwrap();
    let largest_step = |speckle: &PreparedSpeckle, body: usize| {
        let amplitude = |step: u32| {
            let surface = Pose::along(DVec3::X * 1e-3 * f64::from(step) / f64::from(STEPS));
            let motion = Motion {
                body,
                surface: surface.unwrap(),
                ..Motion::default()
            };
            let point = motion.surface.point(DVec3::ZERO);
            speckle.frame(&motion).unwrap().amplitude(point, DVec3::Z)
        };
        let amplitudes: Vec<_> = (0..=STEPS).map(|step| amplitude(step).unwrap()).collect();
        let steps = amplitudes.windows(2).map(|pair| (pair[1] - pair[0]).norm());
        steps.fold(0.0, f64::max)
    };
    // Around a circle and along a line.
    for frames in [1, 3] {
        let speckle = prepared(5, &vec![far; frames]);
        let slices = speckle.plan().path().slice_count();
        assert!(slices > 8, "{slices} slices tell nothing");
        for body in 0..4 {
            let step = largest_step(&speckle, body);
            assert!(step < 0.2, "body {body} of {frames} frames: {step}");
        }
    }
}

#[test]
fn what_does_not_fit_is_refused_by_name() {
    let pose = Pose::along(DVec3::X * 5e-3).unwrap();
    let camera = camera(DVec3::new(-0.05, 0.01, 0.3));
    let speckle = Speckle::new(&camera, &laser(), 1);
    let short = speckle
        .clone()
        .for_poses(&[Pose::along(DVec3::X * 1e-4).unwrap(); 3]);
    let short = short.prepare().unwrap();
    assert!(matches!(
        short.frame(&pose.into()),
        Err(ShadingError::BeyondPoses { .. })
    ));
    let far = Pose::along(DVec3::X * 50e-3).unwrap();
    let single = speckle.clone().for_poses(&[far]).prepare().unwrap();
    assert!(
        single.frame(&far.into()).is_ok(),
        "the pose that was prepared"
    );
    let farther = single.frame(&Pose::along(DVec3::X * 60e-3).unwrap().into());
    assert!(
        matches!(farther, Err(ShadingError::BeyondPoses { .. })),
        "{farther:?}"
    );
    let film: Vec<_> = (1..9_u8)
        .map(|step| Pose::along(DVec3::X * 1e-3 * f64::from(step)).unwrap())
        .collect();
    for poses in [&[][..], &film] {
        let speckle = speckle.clone().for_poses(poses);
        let refused = speckle.clone().within(1000).prepare().map(drop);
        let Err(ShadingError::Speckle(SpeckleError::MemoryLimit {
            needed,
            limit: 1000,
        })) = refused
        else {
            panic!("{refused:?}");
        };
        assert!(
            speckle.within(2 * needed).prepare().is_ok(),
            "{needed} bytes"
        );
    }
    let aside = speckle.clone().for_poses(&[pose]);
    let aside = aside.at_points([(DVec3::X, DVec3::Z)]).prepare();
    assert!(matches!(aside, Err(ShadingError::Missing(_))), "{aside:?}");
    let none = speckle.clone().looks(0).prepare().unwrap_err();
    assert_eq!(none.to_string(), "looks must be at least 1, got 0");
    assert!(speckle.polarisation(1.5).prepare().is_err(), "polarisation");
}

#[test]
fn speckle_is_new_where_the_law_has_no_value() {
    let camera = camera(DVec3::new(-0.05, 0.01, 0.3));
    let turned = Pose::about(DVec3::ZERO, DVec3::X, 1.0).unwrap();
    let speckle = Speckle::new(&camera, &laser(), 1).for_poses(&[turned]);
    let speckle = speckle.prepare().unwrap();
    let summary = speckle.to_string();
    assert!(
        summary.contains("farther than the law reaches"),
        "{summary}"
    );
    let frame = |pose: Pose| speckle.frame(&pose.into()).unwrap();
    let (before, after) = (frame(Pose::default()), frame(turned));
    let shift = after.shift(DVec3::ZERO, turned.direction(DVec3::Z));
    assert!(
        shift.is_none_or(|shift| shift.pupil.is_infinite()),
        "{shift:?}"
    );
    let pairs = (0..2000).map(|index| {
        let point = DVec3::X * (1e-5 * f64::from(index) - 1e-2);
        let now = (turned.point(point), turned.direction(DVec3::Z));
        [before.factor(point, DVec3::Z), after.factor(now.0, now.1)]
    });
    let (a, b): (Vec<_>, Vec<_>) = pairs.map(|[a, b]| (a, b)).unzip();
    let found = correlation(&a, &b);
    assert!(found.abs() < 0.2, "correlation {found}");
}

/// Of a line that is a hundred times as wide as the image, few rays are seen, if any.
#[test]
fn shifts_are_found_under_a_line_much_wider_than_the_image() {
    let camera = camera(DVec3::new(0.0, -0.1, 0.28));
    let line = Laser::line(650e-9, 0.1e-3, 1.2);
    let line = line.placed(0.5 * DVec3::Z, DVec3::ZERO, DVec3::X).unwrap();
    let pose = Pose::along(DVec3::X * 5e-3).unwrap();
    let speckle = Speckle::new(&camera, &line, 1)
        .for_poses(&[pose; 3])
        .prepare();
    let speckle = speckle.unwrap();
    let frame = speckle.frame(&pose.into()).unwrap();
    let shift = frame.shift(DVec3::ZERO, DVec3::Z).unwrap();
    // The path is longer than for an invisible motion.
    assert!(shift.pupil > 1.0, "{shift:?} tells nothing");
    let reach = speckle.plan().reach();
    assert!(reach >= shift.pupil, "{reach} for {shift:?}");
}

#[test]
fn the_plan_says_what_it_chose() {
    let pose = Pose::along(DVec3::X * 1e-3).unwrap();
    let text = prepared(1, &[pose, pose]).to_string();
    assert!(text.starts_with("1 pattern of "), "{text}");
    for part in ["samples in", "MiB", "px repeats nothing", "in 3 frames"] {
        assert!(text.contains(part), "{text}: {part}");
    }
}

#[test]
#[expect(clippy::float_cmp, reason = "the same bits")]
fn a_sample_out_of_focus_is_looked_up_where_it_is_seen() {
    let speckle = prepared(1, &[]);
    let frame = speckle.frame(&Motion::default()).unwrap();
    let (point, normal) = (DVec3::new(1e-4, 0.0, 0.0), DVec3::Z);
    let camera = camera(DVec3::new(-0.05, 0.01, 0.3));
    let pixel = camera.project(point).unwrap();
    assert_eq!(
        frame.factor_at(pixel, point, normal),
        frame.factor(point, normal)
    );
    assert_ne!(
        frame.factor_at(pixel + DVec2::X, point, normal),
        frame.factor(point, normal)
    );
}

/// Light of the laser over a flat mirror equals the light of its image behind the mirror.
#[test]
fn light_over_a_mirror_is_that_of_the_mirrored_laser() {
    let camera = camera(DVec3::new(-0.05, 0.01, 0.3));
    let spot = |origin: DVec3| {
        // A tenth of a millimetre wide and out of focus: nearly a point source.
        let laser = Laser::spot(650e-9, 20e-6).focused_at(0.0);
        laser.placed(origin, DVec3::ZERO, DVec3::X).unwrap()
    };
    let (real, mirrored) = (DVec3::new(0.6, 0.02, 0.4), DVec3::new(-0.1, 0.02, 0.4));
    let motion = Motion {
        surface: pose(DVec3::new(1e-4, 5e-5, 2e-4), DVec3::Y, 1e-3),
        laser: Pose::along(DVec3::Y * 1e-4).unwrap(),
        ..Motion::default()
    };
    let [over_mirror, direct] = [real, mirrored].map(|origin| {
        let speckle = Speckle::new(&camera, &spot(origin), 9).for_motions([motion]);
        let points = [(DVec3::ZERO, DVec3::Z)];
        let speckle = speckle.at_points(points).prepare().unwrap();
        speckle.frame(&motion).unwrap()
    });
    let normal = motion.surface.direction(DVec3::Z);
    // The wave near the spot, as traced rays give it: it leaves the axis at the position of the
    // spot.
    let rays = |point: DVec3| (mirrored - point).normalize();
    let step = 1e-5;
    let along = |axis: DVec3| (rays(step * axis) - rays(-step * axis)) / (2.0 * step);
    let wave = Wavefront::from_differentials(
        rays(DVec3::ZERO),
        [DVec3::X, DVec3::Y],
        [DVec3::X, DVec3::Y].map(along),
    )
    .unwrap();
    let light = Illumination::near(DVec3::ZERO, wave).unwrap();
    let mut differences = Vec::new();
    for point in places(600)
        .into_iter()
        .filter(|point| point.length() < 1.5e-3)
    {
        let now = motion.surface.point(point);
        let [found, expected] = [
            over_mirror.factor_under(&light, now, normal),
            direct.factor(now, normal),
        ];
        differences.push(found - expected);
    }
    let rms = mean(differences.iter().map(|d| d * d)).sqrt();
    assert!(rms < 0.01, "{rms}");
}
