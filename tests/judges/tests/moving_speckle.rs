//! Speckle moves with the image of the surface and decorrelates as the theory says.

use std::{path::Path, sync::atomic::AtomicBool};

use glam::{DVec2, DVec3};
use tem00::{
    decorrelation::{
        CameraFrame, Configuration, ConfigurationData, Illumination, ImagingGeometry, LensData,
        RigidMotion, RigidMotions, SpeckleMotion, axial_correlation, pupil_overlap_correlation,
    },
    engine::{SpeckleModel, SpecklePlan, render_frame},
    numerics::Grid,
    scene::parse_scene,
    speckle::{PupilField, SlicePath, SpeckleStack},
    statistics::pearson_correlation,
    tracer::RenderOptions,
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
    let before = Configuration::new(ConfigurationData {
        wavelength: LENS.wavelength,
        point: DVec3::ZERO,
        normal: DVec3::Z,
        illumination: Illumination::collimated(DVec3::Z).expect("a direction"),
        camera: CameraFrame::look_at(eye, DVec3::ZERO, DVec3::Y).expect("a camera"),
        pupil: eye,
    });
    let before = before.expect("a visible point");
    let after = before.moved(&RigidMotions {
        surface: RigidMotion::along(surface).expect("a translation"),
        ..RigidMotions::default()
    });
    let geometry = ImagingGeometry::from_lens(LENS).expect("a lens");
    SpeckleMotion::between(&geometry, &before, &after.expect("a visible point"))
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
        let rows_down = DVec2::new(in_pixels.x, -in_pixels.y);
        let after = intensity(pixel + rows_down, displacement);
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

/// A lens behind which a speckle spans 6.6 pixels, so that pixels hardly average over it.
const FINE: LensData = LensData {
    pixel_pitch: LENS.pixel_pitch / 4.0,
    ..LENS
};

/// One pixel of the fine lens on the plate, in metres.
const FINE_PIXEL: f64 = 11.0 * FINE.pixel_pitch;

/// Columns and rows of the images.
const SIDE: usize = 256;

/// The speckle layers of the frames of a plate that moves by `surface` from frame to frame, in metres.
fn frames(lens: LensData, [surface, camera]: [DVec3; 2], count: u32, seed: u64) -> Vec<Grid<f32>> {
    frames_with("", lens, [surface, camera], (count, seed))
}

/// The same with more tables in the scene.
fn frames_with(
    tables: &str,
    lens: LensData,
    [surface, camera]: [DVec3; 2],
    (count, seed): (u32, u64),
) -> Vec<Grid<f32>> {
    let [a, c] = [surface, camera].map(|v| format!("[{}, {}, {}]", v.x, v.y, v.z));
    // The waist lies on the plate, where the wavefront is plane.
    let text = format!(
        r#"
        [render]
        frames = {count}
        [camera]
        position = [0, 0, 0.3]
        look_at = [0, 0, 0]
        focal_length = {focal_length}
        focus_distance = {focus_distance}
        f_number = {f_number}
        pixel_pitch = {pixel_pitch}
        resolution = [{SIDE}, {SIDE}]
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

        {tables}
        "#,
        focal_length = lens.focal_length,
        focus_distance = lens.surface_to_pupil,
        f_number = lens.f_number,
        pixel_pitch = lens.pixel_pitch,
    );
    let scene = parse_scene(&text, Path::new(".")).expect("a valid scene");
    let options = RenderOptions {
        samples_per_pixel: 4,
        seed,
        ..RenderOptions::default()
    };
    let plan = SpecklePlan::new(&scene, seed).expect("a small pattern");
    let model = SpeckleModel::generate(&scene, &plan).expect("a small pattern");
    let cancel = AtomicBool::new(false);
    (0..count)
        .map(|frame| {
            render_frame(&scene, Some(&model), frame, &options, |_| (), &cancel)
                .expect("a render")
                .lasers
                .remove(0)
                .speckle
        })
        .collect()
}

/// The correlation of a frame with a later one moved back by whole pixels.
fn correlation(before: &Grid<f32>, after: &Grid<f32>, [dx, dy]: [usize; 2]) -> f64 {
    let (width, height) = (before.width() - dx, before.height() - dy);
    let a = Grid::from_fn(width, height, |x, y| before[(x, y + dy)]);
    // Up in the scene is up in the image, where rows count downwards.
    let b = Grid::from_fn(width, height, |x, y| after[(x + dx, y)]);
    pearson_correlation(&a, &b).expect("bright frames")
}

/// Four standard errors of the correlation of two images, whose lens has speckles of `size` pixels.
///
/// The variance is 0.585 h²/A for independent patterns of the area A. For correlated ones it is of the
/// same size, at most 1.5² times as large (found for γ = 0.5, where it is largest).
fn tolerance(lens: LensData) -> f64 {
    let geometry = ImagingGeometry::from_lens(lens).expect("a lens");
    let size = geometry.speckle_size_in_pixels();
    4.0 * 1.5 * 0.585_f64.sqrt() * size / SIDE as f64
}

/// The fine lens with the pupil of which `surface` is a number of 32nds, so that the motion ends on a
/// slice and not between two.
fn lens_on_a_slice(surface: f64, slices: f64) -> LensData {
    LensData {
        f_number: FINE.focal_length * slices / (32.0 * surface),
        ..FINE
    }
}

#[test]
fn rendered_speckle_moves_with_the_surface_and_decorrelates() {
    // 3, 8 and 16 slices are 0.09, 0.25 and 0.5 pupil diameters.
    for (pixels, slices, seed) in [([24, 32], 3.0, 1), ([80, 0], 8.0, 2), ([0, 120], 16.0, 3)] {
        let [dx, dy] = pixels.map(|p: usize| p as f64 * FINE_PIXEL);
        let surface = DVec3::new(dx, dy, 0.0);
        let lens = lens_on_a_slice(surface.length(), slices);
        let motion = [surface, DVec3::ZERO];
        let frames = frames(lens, motion, 2, seed);
        let expected = pupil_overlap_correlation(slices / 32.0);
        let measured = correlation(&frames[0], &frames[1], pixels);
        assert!(
            (measured - expected).abs() < tolerance(lens),
            "{pixels:?}: {measured} | {expected}"
        );
        let still = correlation(&frames[0], &frames[1], [0, 0]);
        assert!(
            still.abs() < tolerance(lens),
            "{pixels:?}: {still} without following the motion"
        );
    }
}

#[test]
fn motion_that_ends_between_few_slices_leaves_what_the_pupils_share() {
    const SEEDS: u64 = 4;
    // A tenth of the diameter and a third, four slices to one: 0.14 and 0.05 above the law if the way
    // between two slices were that between their pupils.
    let pixels = [40, 32];
    let [dx, dy] = pixels.map(|p: usize| p as f64 * FINE_PIXEL);
    let surface = DVec3::new(dx, dy, 0.0);
    for part in [0.1, 0.35] {
        let lens = lens_on_a_slice(surface.length(), 32.0 * part);
        let motion = [surface, DVec3::ZERO];
        let tables = "[speckle]\nhalf_period = 4";
        let sum: f64 = (0..SEEDS)
            .map(|seed| frames_with(tables, lens, motion, (2, seed)))
            .map(|frames| correlation(&frames[0], &frames[1], pixels))
            .sum();
        let (measured, expected) = (sum / SEEDS as f64, pupil_overlap_correlation(part));
        let tolerance = tolerance(lens) / (SEEDS as f64).sqrt();
        assert!(
            (measured - expected).abs() < tolerance,
            "{part}: {measured} | {expected} ± {tolerance}"
        );
    }
}

#[test]
fn speckle_out_of_focus_moves_as_if_it_lay_in_the_plane_of_focus() {
    // In collimated light the whole field in front of the lens moves with the surface. So does the
    // part of it in the plane of focus, which is what the sensor sees: by m a, wherever the surface
    // stands, while the image of the surface moves by L/Z times as much.
    for (focus, speckle_moves_by, image_moves_by, seed) in
        [(0.6, [20, 15], [40, 30], 4), (0.2, [90, 0], [60, 0], 5)]
    {
        let focal_length = FINE.focal_length;
        let per_magnification = (focus - focal_length) / focal_length;
        let [dx, dy] =
            speckle_moves_by.map(|p: usize| p as f64 * FINE.pixel_pitch * per_magnification);
        let surface = DVec3::new(dx, dy, 0.0);
        let lens = LensData {
            surface_to_pupil: focus,
            ..lens_on_a_slice(surface.length(), 4.0)
        };
        let motion = [surface, DVec3::ZERO];
        let frames = frames(lens, motion, 2, seed);
        let measured = correlation(&frames[0], &frames[1], speckle_moves_by);
        let expected = pupil_overlap_correlation(4.0 / 32.0);
        assert!(
            (measured - expected).abs() < tolerance(lens),
            "focus at {focus} m: {measured} | {expected}"
        );
        let with_the_image = correlation(&frames[0], &frames[1], image_moves_by);
        assert!(
            with_the_image.abs() < tolerance(lens),
            "focus at {focus} m: {with_the_image} at the image of the surface"
        );
    }
}

#[test]
fn any_two_frames_of_a_steady_motion_correlate_by_their_distance() {
    // Half a pupil diameter per frame: the third frame is new to the first, but not to the second.
    let surface = DVec3::new(40.0 * FINE_PIXEL, 0.0, 0.0);
    let lens = lens_on_a_slice(surface.x, 16.0);
    let frames = frames(lens, [surface, DVec3::ZERO], 4, 9);
    for (i, j) in [(0, 1), (1, 2), (2, 3), (0, 2), (1, 3), (0, 3)] {
        let expected = pupil_overlap_correlation(0.5 * (j - i) as f64);
        let measured = correlation(&frames[i], &frames[j], [40 * (j - i), 0]);
        assert!(
            (measured - expected).abs() < tolerance(lens),
            "frames {i} and {j}: {measured} | {expected}"
        );
    }
}

#[test]
fn a_surface_that_moved_by_two_pupil_diameters_shows_new_speckle() {
    // Two diameters are once round the smallest lattice: the first pattern must not return.
    let pixels = [36, 0];
    let surface = DVec3::new(36.0 * 11.0 * LENS.pixel_pitch, 0.0, 0.0);
    let lens = LensData {
        f_number: LENS.focal_length / (0.5 * surface.x),
        ..LENS
    };
    let motion = [surface, DVec3::ZERO];
    let frames = frames(lens, motion, 2, 11);
    let measured = correlation(&frames[0], &frames[1], pixels);
    assert!(measured.abs() < tolerance(lens), "correlation {measured}");
}

#[test]
fn a_camera_that_moves_along_with_the_surface_sees_the_same_speckle() {
    let motion = DVec3::new(0.5e-3, 0.2e-3, 0.0);
    let frames = frames(FINE, [motion, motion], 2, 5);
    let measured = correlation(&frames[0], &frames[1], [0, 0]);
    // The light stays behind, but its wavefront is nearly plane: only the camera samples differ.
    assert!(measured > 0.99, "correlation {measured}");
}

/// A wide pupil loses correlation before the image grows: by 0.1 % here, 0.16 pixels at the edge.
const WIDE: LensData = LensData {
    f_number: 1.4,
    pixel_pitch: 0.15e-6,
    ..LENS
};

#[test]
fn motion_along_the_line_of_sight_decorrelates_by_defocus() {
    let geometry = ImagingGeometry::from_lens(WIDE).expect("a lens");
    for (part, seed) in [(0.25, 6), (0.5, 7)] {
        let dz = part * geometry.axial_decorrelation_length();
        let motion = [DVec3::new(0.0, 0.0, dz), DVec3::ZERO];
        let frames = frames(WIDE, motion, 2, seed);
        let measured = correlation(&frames[0], &frames[1], [0, 0]);
        let expected = axial_correlation(part);
        assert!(
            (measured - expected).abs() < tolerance(WIDE),
            "{part} of the way to the first zero: {measured} | {expected}"
        );
    }
}

#[test]
fn frames_far_apart_along_the_line_of_sight_have_speckle_of_their_own() {
    let geometry = ImagingGeometry::from_lens(WIDE).expect("a lens");
    let dz = geometry.axial_decorrelation_length();
    let motion = [DVec3::new(0.0, 0.0, dz), DVec3::ZERO];
    let frames = frames(WIDE, motion, 3, 10);
    for (i, j) in [(0, 1), (1, 2), (0, 2)] {
        let measured = correlation(&frames[i], &frames[j], [0, 0]);
        assert!(
            measured.abs() < tolerance(WIDE),
            "frames {i} and {j}: {measured}"
        );
    }
}
