use glam::DVec3;
use tem00_camera::Camera;
use tem00_coherence::{
    PeakShape, PolychromaticSpeckle, Relief, ResolutionCell, SourceExtent, Spectrum,
};
use tem00_testkit::{assert_absolute, assert_relative};
use tem00_tracer::{Keyframe, LaserDescription, Scene, Trajectory};

use super::{super::crossing::Waves, *};
use crate::{SpeckleModel, SpecklePlan, testing};

/// A plate under a laser along its normal, seen under 30° about the axis y.
fn scene(spectrum: Spectrum, rms_height: f64) -> Scene {
    let laser = LaserDescription {
        spectrum,
        ..testing::spot(DVec3::new(0.0, 0.0, 3.0), 50e-3)
    };
    let mut plate = testing::plate(DVec3::ZERO, DVec3::Z, [0.05, 0.05]);
    plate.relief = Relief {
        rms_height,
        correlation_length: 0.0,
    };
    let (sin, cos) = 30_f64.to_radians().sin_cos();
    let camera = testing::camera(0.3 * DVec3::new(sin, 0.0, cos), [480, 360]);
    testing::scene(camera, &[laser], plate)
}

fn gaussian(linewidth: f64) -> Spectrum {
    Spectrum::new(650e-9, linewidth, PeakShape::Gaussian).unwrap()
}

/// Means over the line of the speckle factor in a frame, at image points some `offset` from a
/// lattice that is wider than a speckle, in pixels.
fn picture(
    scene: &Scene,
    model: &SpeckleModel,
    frame: u32,
    offset: impl Fn(DVec2) -> DVec2,
) -> Vec<f64> {
    const WAVES: u32 = 24;
    let speckle = model.in_frame(scene, frame).unwrap();
    let camera = scene.camera_at(frame);
    let places = (0..64).flat_map(|i| (0..56).map(move |j| DVec2::new(f64::from(i), f64::from(j))));
    places
        .map(|place| {
            let pixel = DVec2::new(40.0, 40.0) + 4.3 * place;
            let point = seen(&camera, pixel + offset(pixel));
            let waves = (0..WAVES).map(|wave| {
                let wave = (f64::from(wave) + 0.5) / f64::from(WAVES);
                speckle.factor(0, &SpecklePoint { wave, ..point })
            });
            waves.sum::<f64>() / f64::from(WAVES)
        })
        .collect()
}

/// The point of the plate at an image point.
fn seen(camera: &Camera, pixel: DVec2) -> SpecklePoint {
    let ray = camera.ray(pixel);
    SpecklePoint {
        pixel,
        position: ray.origin - ray.direction * (ray.origin.z / ray.direction.z),
        normal: DVec3::Z,
        surface: 0,
        wave: 0.5,
    }
}

/// The picture of a frame.
fn picture_of(scene: &Scene, frame: u32) -> Vec<f64> {
    picture(scene, &model(scene), frame, |_| DVec2::ZERO)
}

fn model(scene: &Scene) -> SpeckleModel {
    testing::speckle(scene, 11)
}

/// The covariance of two pictures over the product of their means.
fn covariance(a: &[f64], b: &[f64]) -> f64 {
    let mean = |values: &[f64]| values.iter().sum::<f64>() / values.len() as f64;
    let products: f64 = a.iter().zip(b).map(|(a, b)| a * b).sum();
    products / a.len() as f64 / (mean(a) * mean(b)) - 1.0
}

/// The resolution cell in the middle of the picture.
fn cell(scene: &Scene) -> ResolutionCell {
    let change = Change::new(scene, 0);
    let geometry = scene.camera.imaging_geometry(650e-9).unwrap();
    let size = [scene.camera.width(), scene.camera.height()].map(|side| side as f64);
    let point = seen(&scene.camera, 0.5 * DVec2::from_array(size));
    let law = change.spectral_law(0, &geometry);
    let cell = law.resolution_cell(&point.seen()).unwrap();
    let cell = cell.with_relief(scene.surfaces[0].relief).unwrap();
    cell.with_source_extent(scene.lasers[0].source_extent().clone())
}

/// The value of the law in the middle of the picture.
fn by_law(scene: &Scene, value: impl Fn(&PolychromaticSpeckle<'_>) -> f64) -> f64 {
    let (spectrum, cell) = (scene.lasers[0].spectrum(), cell(scene));
    value(&PolychromaticSpeckle {
        spectrum,
        cell: &cell,
    })
}

#[track_caller]
fn assert_contrast(scene: &Scene, frame: u32) {
    fn contrast(law: &PolychromaticSpeckle<'_>) -> f64 {
        law.contrast()
    }
    let values = picture_of(scene, frame);
    let found = covariance(&values, &values).sqrt();
    assert_relative(found, by_law(scene, contrast), 0.045);
}

#[test]
fn contrasts_are_those_of_the_law() {
    // The aperture has sin u = 0.0052.
    for (spectrum, height, half_angle) in
        [(gaussian(10e-9), 8e-6, 0.0), (gaussian(5e-9), 2e-6, 0.004)]
    {
        let mut scene = scene(spectrum, height);
        let extent = SourceExtent::disc(half_angle).unwrap();
        scene.lasers[0] = scene.lasers[0].clone().with_source_extent(extent);
        assert_contrast(&scene, 0);
    }
}

#[test]
fn frames_of_motions_along_and_across_the_tilt_are_those_of_the_law() {
    // The motion of the plate that the camera sees in a frame, in diameters of its pupil: along the
    // tilt, and across it.
    for (way, spectrum, height, frame) in [
        ([0.25, 0.0], gaussian(5e-9), 0.0, 4),
        ([0.0, 0.25], gaussian(5e-9), 0.0, 1),
        ([-0.1, 0.2], gaussian(10e-9), 8e-6, 4),
    ] {
        let mut scene = scene(spectrum, height);
        scene.frames = 5;
        scene.reference_frame = 2;
        let step = DVec3::new(way[0] / 30_f64.to_radians().cos(), way[1], 0.0);
        scene.surfaces[0].trajectory = Trajectory::steady(3.125e-3 * step).unwrap();
        let model = model(&scene);
        let geometry = scene.camera.imaging_geometry(650e-9).unwrap();
        let here = picture(&scene, &model, 2, |_| DVec2::ZERO);
        // The same speckle, where it went.
        let (change, camera) = (Change::new(&scene, frame), scene.camera_at(frame));
        let shift = |pixel: DVec2| change.speckle_shift(0, &geometry, &seen(&camera, pixel));
        let there = picture(&scene, &model, frame, |pixel| {
            let near = shift(pixel).displacement;
            shift(pixel + near).displacement
        });
        let way = way.map(|part| part * (f64::from(frame) - 2.0));
        let expected = by_law(&scene, |law| law.covariance(way));
        assert_absolute(covariance(&here, &there), expected, 0.04);
    }
}

#[test]
fn correlations_that_are_noted_are_those_of_the_law() {
    for (spectrum, height) in [(gaussian(5e-9), 0.0), (gaussian(10e-9), 8e-6)] {
        let mut scene = scene(spectrum, height);
        // So few pixels that the tilt is one.
        let camera = testing::camera(scene.camera.position(), [48, 36]);
        scene.camera = Camera::new(camera).unwrap();
        let plan = SpecklePlan::new(&scene, 0).unwrap();
        let bandwidth = plan.patterns()[0].surface_patterns[0].bandwidth.clone();
        let waves = Waves::of(scene.lasers[0].spectrum(), 0, bandwidth.unwrap());
        for way in [[0.25, 0.0], [0.0, 0.25], [0.5, 0.0], [-0.1, 0.2]] {
            // The tilt is along x.
            let found = waves.correlation(DVec2::from_array(way), DVec2::X);
            let law = by_law(&scene, |law| law.covariance(way) / law.covariance([0.0; 2]));
            assert_absolute(found, law, 0.01);
        }
    }
}

#[test]
fn surfaces_that_come_into_view_have_the_contrast_of_the_line() {
    let mut scene = scene(gaussian(5e-9), 0.0);
    scene.frames = 3;
    // Behind the camera at first.
    let away = Keyframe {
        displacement: DVec3::X,
        ..Keyframe::unmoved(0.0)
    };
    let keyframes = [away, Keyframe::unmoved(2.0)];
    scene.surfaces[0].trajectory = Trajectory::keyframed(DVec3::ZERO, keyframes).unwrap();
    assert_contrast(&scene, 2);
}

#[test]
fn grains_are_longer_along_the_tilt() {
    let scene = scene(gaussian(10e-9), 0.0);
    let model = model(&scene);
    let geometry = scene.camera.imaging_geometry(650e-9).unwrap();
    let size = geometry.speckle_size_in_pixels();
    let here = picture(&scene, &model, 0, |_| DVec2::ZERO);
    for lag in [[1.0, 0.0], [0.0, 1.0]] {
        let there = picture(&scene, &model, 0, |_| size * DVec2::from_array(lag));
        let expected = by_law(&scene, |law| law.autocovariance(lag));
        assert_absolute(covariance(&here, &there), expected, 0.02);
    }
}

#[test]
fn more_patterns_than_can_add_up_are_refused_by_their_name() {
    let mut scene = scene(Spectrum::monochromatic(650e-9).unwrap(), 0.0);
    let extent = SourceExtent::disc(0.02).unwrap();
    scene.lasers[0] = scene.lasers[0].clone().with_source_extent(extent);
    scene.surfaces[0].speckle.patterns = 40;
    let refused = SpecklePlan::new(&scene, 0).unwrap_err();
    assert_eq!(refused.parameter(), Some("patterns"), "{refused}");
    assert!(refused.to_string().ends_with("got 40"), "{refused}");
}
