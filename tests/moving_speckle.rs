//! Speckle moves with the image of the surface and decorrelates as the theory says.

#![expect(
    clippy::expect_used,
    reason = "a test stops at what it does not expect"
)]

use std::{path::Path, sync::atomic::AtomicBool};

use glam::{DVec2, DVec3};
use tem00::{
    decorrelation::{
        CameraFrame, ImageOrientation, ImagingGeometry, LensData, LineOfSight, Motion,
        SpeckleMotion, SurfacePoint, Wavefront, axial_correlation,
    },
    numerics::{Grid, circular_path_overlap},
    speckle::{PupilField, SlicePath, SpeckleStack},
    statistics::pearson_correlation,
    tracer::{Formulas, RenderOptions, SpeckleModel, SpecklePlan, parse_scene, render_frame},
};

const LENS: LensData = LensData {
    wavelength: 650e-9,
    focal_length: 25e-3,
    f_number: 8.0,
    surface_to_pupil: 0.3,
    pixel_pitch: 3.45e-6,
};

/// The motion of the speckle of a plate under a waist of a beam, seen head-on.
fn speckle_motion(surface: DVec3) -> SpeckleMotion {
    let eye = DVec3::new(0.0, 0.0, LENS.surface_to_pupil);
    let camera = CameraFrame::look_at(eye, DVec3::ZERO, DVec3::Y).expect("a camera");
    let sight = LineOfSight::new(&camera, eye).expect("a visible point");
    let wavefront = Wavefront::plane(DVec3::Z).expect("a direction");
    let point = SurfacePoint::new(sight, DVec3::Z, wavefront).expect("a normal");
    let motion = Motion {
        surface,
        ..Motion::default()
    };
    let geometry = ImagingGeometry::from_lens(LENS).expect("a lens");
    SpeckleMotion::new(&geometry, &point, &motion, ImageOrientation::ScreenUpright)
}

#[test]
fn the_pattern_moves_by_exactly_the_image_displacement() {
    let geometry = ImagingGeometry::from_lens(LENS).expect("a lens");
    let field = PupilField::new(256, 128, 4).expect("a valid field");
    let stack = SpeckleStack::generate(&field, SlicePath::Still).expect("a small stack");
    let displacement = speckle_motion(DVec3::new(0.25e-3, -0.11e-3, 0.0)).image_displacement;
    let intensity = |pixel: DVec2, displacement: DVec2| {
        let c = geometry.pattern_coordinate(pixel, displacement, stack.speckle_size());
        stack.intensity_at(c.x, c.y, 0.0)
    };
    // The magnification is 1/11, so the surface moves by 6.588 and −2.899 pixels.
    let in_pixels = displacement / LENS.pixel_pitch;
    let expected = DVec2::new(0.25e-3, -0.11e-3) / 11.0 / 3.45e-6;
    assert!(
        (in_pixels - expected).length() < 1e-9,
        "{in_pixels} | {expected}"
    );
    for i in 0..50 {
        let pixel = DVec2::new(0.37 * f64::from(i), 100.0 - 1.71 * f64::from(i));
        let before = intensity(pixel, DVec2::ZERO);
        let after = intensity(pixel + in_pixels, displacement);
        // Rounding of the coordinates, 1e−14, and of the single-precision weights.
        assert!(
            (after - before).abs() < 1e-5,
            "at {pixel}: {before}, then {after}"
        );
        let unmoved = intensity(pixel, displacement);
        assert!(
            (unmoved - before).abs() > 1e-5,
            "the pattern stands still at {pixel}"
        );
    }
}

/// The speckle layers of two frames of a plate that moves by `surface`, in metres.
fn frames(surface: DVec3, camera: DVec3, seed: u64) -> [Grid<f32>; 2] {
    frames_through(LENS, Formulas::Derived, surface, camera, seed)
}

/// The same through any lens and by either set of formulas.
fn frames_through(
    lens: LensData,
    formulas: Formulas,
    surface: DVec3,
    camera: DVec3,
    seed: u64,
) -> [Grid<f32>; 2] {
    let [a, c] = [surface, camera].map(|v| format!("[{}, {}, {}]", v.x, v.y, v.z));
    // The waist lies on the plate, where the wavefront is plane.
    let text = format!(
        r#"
        [render]
        frames = 2
        [camera]
        position = [0, 0, 0.3]
        look_at = [0, 0, 0]
        focal_length = {focal_length}
        f_number = {f_number}
        pixel_pitch = {pixel_pitch}
        resolution = [128, 128]
        displacement_per_frame = {c}

        [[laser]]
        wavelength = "650 nm"
        power = "1 mW"
        position = [0, 0, 0.25]
        look_at = [0, 0, 0]
        spot = {{ waist_radius = "2 mm" }}

        [[surface]]
        displacement_per_frame = {a}
        rectangle = {{ centre = [0, 0, 0], normal = [0, 0, 1], size = [0.04, 0.04] }}
        "#,
        focal_length = lens.focal_length,
        f_number = lens.f_number,
        pixel_pitch = lens.pixel_pitch,
    );
    let scene = parse_scene(&text, Path::new(".")).expect("a valid scene");
    let options = RenderOptions {
        samples_per_pixel: 16,
        seed,
        formulas,
    };
    let plan = SpecklePlan::new(&scene, options.formulas, seed).expect("a small pattern");
    let model = SpeckleModel::generate(&scene, &plan).expect("a small pattern");
    let cancel = AtomicBool::new(false);
    [0, 1].map(|frame| {
        render_frame(&scene, Some(&model), frame, &options, |_| (), &cancel)
            .expect("a render")
            .lasers
            .remove(0)
            .speckle
    })
}

/// The correlation of the first frame with the second moved back by whole pixels.
fn correlation([before, after]: &[Grid<f32>; 2], [dx, dy]: [usize; 2]) -> f64 {
    let (width, height) = (before.width() - dx, before.height() - dy);
    let a = Grid::from_fn(width, height, |x, y| before[(x, y + dy)]);
    // Up in the scene is up in the image, where rows count downwards.
    let b = Grid::from_fn(width, height, |x, y| after[(x + dx, y)]);
    pearson_correlation(&a, &b).expect("bright frames")
}

/// Four standard errors: 128² pixels hold (78 speckles)² · π/4 independent cells.
const TOLERANCE: f64 = 4.0 * 1.7 / 69.0;

#[test]
fn rendered_speckle_moves_with_the_surface_and_decorrelates() {
    // One pixel on the plate is 37.95 µm.
    let pixel = 3.45e-6 * 11.0;
    for (pixels, seed) in [([6, 4], 1), ([20, 0], 2), ([0, 40], 3)] {
        let [dx, dy] = pixels.map(|p: usize| p as f64);
        let surface = DVec3::new(dx * pixel, dy * pixel, 0.0);
        let frames = frames(surface, DVec3::ZERO, seed);
        let expected = speckle_motion(surface).correlation;
        let measured = correlation(&frames, pixels);
        assert!(
            (measured - expected).abs() < TOLERANCE,
            "{pixels:?}: {measured} | {expected}"
        );
        let still = correlation(&frames, [0, 0]);
        assert!(
            still.abs() < TOLERANCE,
            "{pixels:?}: {still} without following the motion"
        );
    }
}

#[test]
fn a_camera_that_moves_along_with_the_surface_sees_the_same_speckle() {
    let motion = DVec3::new(0.5e-3, 0.2e-3, 0.0);
    let frames = frames(motion, motion, 5);
    let measured = correlation(&frames, [0, 0]);
    // The light stays behind, but its wavefront is nearly plane: only the camera samples differ.
    assert!(measured > 0.97, "correlation {measured}");
}

#[test]
fn motion_along_the_line_of_sight_decorrelates_by_defocus() {
    // A wide pupil loses correlation before the image grows: by 0.1 % here, 0.08 pixels at the edge.
    let lens = LensData {
        f_number: 1.4,
        pixel_pitch: 0.6e-6,
        ..LENS
    };
    let geometry = ImagingGeometry::from_lens(lens).expect("a lens");
    for (part, seed) in [(0.25, 6), (0.5, 7)] {
        let dz = part * geometry.axial_decorrelation_length();
        let surface = DVec3::new(0.0, 0.0, dz);
        let frames = frames_through(lens, Formulas::Derived, surface, DVec3::ZERO, seed);
        let measured = correlation(&frames, [0, 0]);
        let expected = axial_correlation(part);
        assert!(
            (measured - expected).abs() < TOLERANCE,
            "{part} of the way to the first zero: {measured} | {expected}"
        );
    }
}

#[test]
fn as_printed_speckle_moves_with_the_surface_but_decorrelates_too_fast() {
    // Two signs of the paper cancel for motion in the plane; its linear map of the displacement to
    // the slices does not give the correlation of the overlap.
    let geometry = ImagingGeometry::from_lens(LENS).expect("a lens");
    let pixel = LENS.pixel_pitch * 11.0;
    let pixels = [5, 4];
    let [dx, dy] = pixels.map(|p: usize| p as f64 * pixel);
    let surface = DVec3::new(dx, dy, 0.0);
    let frames = frames_through(LENS, Formulas::AsPrinted, surface, DVec3::ZERO, 8);
    let measured = correlation(&frames, pixels);
    // The printed pair takes the emitter, 0.25 m away, for the centre of the wavefront.
    let shift = surface.length() * (1.0 + 0.3 / 0.25) / geometry.pupil_diameter();
    let printed = circular_path_overlap(shift).powi(2);
    assert!(
        (measured - printed).abs() < TOLERANCE,
        "{measured} | {printed}"
    );
    let theory = speckle_motion(surface).correlation;
    assert!(
        theory - printed > 2.0 * TOLERANCE,
        "{theory} | {printed}: too close to tell"
    );
}
