//! A host that calls the factor of a hit, and the tracer, show the same speckle: contrast, mean,
//! and what two frames share.

use tem00::{
    Camera, CameraDescription, DVec2, DVec3, Laser, Pose, Speckle, SpeckleFrame,
    decorrelation::pupil_overlap_correlation,
    numerics::{Grid, cast::to_f32},
    statistics::{Moments, pearson_correlation},
};

use crate::renders::{self, options};

const SIZE: [usize; 2] = [160, 120];
/// Samples along each side of a pixel.
const SIDE: u32 = 3;
/// The turn of the plate between the frames, in radians.
const TURN: f64 = 1.2e-3;

/// The speckle factors of two frames, averaged over the pixels, and the radiance of the first.
struct Shown {
    factors: [Grid<f32>; 2],
    radiance: Grid<f32>,
}

fn by_tracer() -> Shown {
    let scene = renders::scene(&format!(
        r#"
        [render]
        frames = 2
        [camera]
        position = [0, -0.1, 0.28]
        look_at = [0, 0, 0]
        focal_length = 25e-3
        f_number = 8
        focus_distance = 0.3
        pixel_pitch = "3.45 um"
        depth_of_field = false
        resolution = {SIZE:?}
        [[laser]]
        wavelength = "650 nm"
        power = 5e-3
        position = [0.2, 0, 0.4]
        look_at = [0, 0, 0]
        spot = {{ waist_radius = 3e-3 }}
        [[surface]]
        rotation_per_frame = {{ axis = [0, 1, 0], angle = {TURN} }}
        rectangle = {{ centre = [0, 0, 0], normal = [0, 0, 1], size = [0.1, 0.1] }}
        lambertian = {{ reflectance = 0.8 }}
        "#
    ));
    let (options, model) = (options(SIDE * SIDE, 0), renders::speckle(&scene, 1));
    let render = |frame| {
        renders::frame(&scene, Some(&model), frame, &options)
            .lasers
            .swap_remove(0)
    };
    let [first, second] = [render(0), render(1)];
    Shown {
        factors: [first.speckle, second.speckle],
        radiance: first.single,
    }
}

fn camera() -> Camera {
    Camera::new(CameraDescription {
        position: DVec3::new(0.0, -0.1, 0.28),
        resolution: SIZE,
        ..CameraDescription::default()
    })
    .expect("a camera")
}

fn by_host(laser: &Laser, frames: &[SpeckleFrame; 2], poses: [Pose; 2]) -> Shown {
    let camera = camera();
    let mean = |pose: &Pose, value: &dyn Fn(DVec2, DVec3, DVec3) -> f64| {
        let normal = pose.direction(DVec3::Z);
        let at = |pixel| {
            let ray = camera.ray(pixel);
            let distance = -ray.origin.dot(normal) / ray.direction.dot(normal);
            value(pixel, ray.origin + distance * ray.direction, normal)
        };
        Grid::from_fn(SIZE[0], SIZE[1], |x, y| {
            let within = |i: u32| (f64::from(i) + 0.5) / f64::from(SIDE);
            let pixels = (0..SIDE * SIDE)
                .map(|i| DVec2::new(x as f64 + within(i % SIDE), y as f64 + within(i / SIDE)));
            to_f32(pixels.map(at).sum::<f64>() / f64::from(SIDE * SIDE))
        })
    };
    let factors = [0, 1].map(|i| mean(&poses[i], &|pixel, p, n| frames[i].factor_at(pixel, p, n)));
    let radiance = mean(&poses[0], &|_, p, n| {
        let event = laser.next_event(p);
        event.map_or(0.0, |event| {
            0.8 / std::f64::consts::PI * event.e_perp * event.wi.dot(n)
        })
    });
    Shown { factors, radiance }
}

#[test]
fn host_and_tracer_show_the_same_speckle() {
    let laser = Laser::spot(650e-9, 3e-3).power(5e-3);
    let laser = laser
        .placed(DVec3::new(0.2, 0.0, 0.4), DVec3::ZERO, DVec3::X)
        .expect("a laser");
    let turned = Pose::about(DVec3::ZERO, DVec3::Y, TURN).expect("a pose");
    let speckle = Speckle::new(&camera(), &laser, 2).for_poses(&[turned]);
    let speckle = speckle.prepare().expect("a small pattern");
    let poses = [Pose::IDENTITY, turned];
    let frames = poses.map(|pose| speckle.frame(&pose.into()).expect("a frame"));
    let (host, tracer) = (by_host(&laser, &frames, poses), by_tracer());

    // Independent speckles in the image, and the errors that they leave, of two runs.
    let size = speckle.geometry().speckle_size_in_pixels();
    let count = (SIZE[0] * SIZE[1]) as f64 / (size * size);
    let error = (2.0 / count).sqrt();
    let moments = |shown: &Shown| {
        let of = |grid: &Grid<f32>| Moments::from_samples(grid.values()).expect("a pattern");
        shown.factors.each_ref().map(of)
    };
    for (host, tracer) in moments(&host).iter().zip(moments(&tracer)) {
        let means = host.mean() - tracer.mean();
        let spreads = host.standard_deviation() - tracer.standard_deviation();
        let close = means.abs().max(spreads.abs()) < 4.0 * error;
        assert!(close, "{host:?}, by the tracer {tracer:?}");
    }
    let shared = |shown: &Shown| {
        let [before, after] = &shown.factors;
        pearson_correlation(before, after).expect("two patterns")
    };
    let [by_host, by_tracer] = [shared(&host), shared(&tracer)];
    assert!(
        (by_host - by_tracer).abs() < 4.0 * error,
        "{by_host}, {by_tracer}"
    );
    // The image moves by less than a tenth of a speckle.
    let shift = frames[1]
        .shift(DVec3::ZERO, DVec3::Z)
        .expect("a point in sight");
    let law = pupil_overlap_correlation(shift.pupil);
    assert!((0.2..0.8).contains(&law), "{law} tells nothing");
    assert!((by_host - law).abs() < 0.1, "{by_host}, by the law {law}");
    // Before speckle the light is the same but for where a pixel was sampled.
    for (a, b) in host.radiance.values().iter().zip(tracer.radiance.values()) {
        assert!((a / b - 1.0).abs() < 0.02, "{a}, by the tracer {b}");
    }
}
