//! Speckle out of focus, along the line of sight, and between few slices.

use tem00::{
    decorrelation::{
        DVec2, DVec3, ImagingGeometry, LensData, axial_correlation, pupil_overlap_correlation,
    },
    speckle::{PupilField, SlicePath, SpeckleStack},
    tracer::Scene,
};

use crate::wave_judges_decorrelation::{finite::surface as moved, scene::Body};

use super::setting::{LENS, SIDE, Setting, assert_correlation, correlation, speckle, tolerance};

/// One pixel on the plate, in metres.
const PIXEL: f64 = 11.0 * LENS.pixel_pitch;

/// A wide pupil loses correlation before the image grows: by 0.1 % here, 0.16 pixels at the edge.
const WIDE: LensData = LensData {
    f_number: 1.4,
    pixel_pitch: 0.15e-6,
    ..LENS
};

/// A plate in plane waves that moves by `surface` from frame to frame, and its speckle size in
/// pixels.
fn moving(lens: LensData, surface: DVec3, frames: u32) -> (Scene, f64) {
    let (to_laser, distance) = (DVec3::Z, None);
    let setting = Setting {
        lens,
        to_laser,
        distance,
    };
    let mut scene = setting.scene();
    scene.frames = frames;
    scene.surfaces[0].trajectory = Body::along(surface).trajectory();
    (scene, setting.geometry().speckle_size_in_pixels())
}

/// The lens with the pupil of which `surface` is so many 32nds.
fn lens_on_a_slice(surface: DVec3, slices: f64) -> LensData {
    LensData {
        f_number: LENS.focal_length * slices / (32.0 * surface.length()),
        ..LENS
    }
}

/// A displacement by so many pixels to the right and up, each of a length in metres.
fn way(pixels: [i32; 2], pixel: f64) -> DVec3 {
    let [x, y] = pixels.map(f64::from);
    pixel * DVec3::new(x, y, 0.0)
}

#[test]
fn motion_that_ends_between_few_slices_leaves_what_the_pupils_share() {
    const SEEDS: u64 = 4;
    // A tenth of the diameter and a third, four slices to one: 0.14 and 0.05 above the law if the
    // way between two slices were that between their pupils.
    let pixels = [40, 32];
    let surface = way(pixels, PIXEL);
    for part in [0.1, 0.35] {
        let (mut scene, size) = moving(lens_on_a_slice(surface, 32.0 * part), surface, 2);
        scene.speckle.half_period = Some(4);
        let of_seed = |seed| {
            let frames = speckle(&scene, &[0, 1], seed);
            correlation([&frames[0], &frames[1]], pixels)
        };
        let found = (0..SEEDS).map(of_seed).sum::<f64>() / SEEDS as f64;
        let expected = pupil_overlap_correlation(part);
        let allowed = tolerance((SIDE * SIDE) as f64, size) / (SEEDS as f64).sqrt();
        let is_close = (found - expected).abs() < allowed;
        assert!(is_close, "{part}: {found} | {expected} ± {allowed}");
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
        let per_magnification = (focus - LENS.focal_length) / LENS.focal_length;
        let surface = way(speckle_moves_by, LENS.pixel_pitch * per_magnification);
        let lens = LensData {
            surface_to_pupil: focus,
            ..lens_on_a_slice(surface, 4.0)
        };
        let (scene, size) = moving(lens, surface, 2);
        let frames = speckle(&scene, &[0, 1], seed);
        let frames = [&frames[0], &frames[1]];
        let name = format!("focus at {focus} m");
        let law = pupil_overlap_correlation(4.0 / 32.0);
        assert_correlation(&name, frames, speckle_moves_by, (law, size));
        assert_correlation("image of the surface", frames, image_moves_by, (0.0, size));
    }
}

#[test]
fn motion_along_the_line_of_sight_decorrelates_by_defocus() {
    let geometry = ImagingGeometry::from_lens(WIDE).expect("a lens");
    // Frames a whole length apart, and farther, have speckle of their own.
    let few: &[[usize; 2]] = &[[0, 1]];
    let apart: &[[usize; 2]] = &[[0, 1], [1, 2], [0, 2]];
    for (part, count, pairs, seed) in [(0.25, 2, few, 6), (0.5, 2, few, 7), (1.0, 3, apart, 10)] {
        let dz = part * geometry.axial_decorrelation_length();
        let (scene, size) = moving(WIDE, dz * DVec3::Z, count);
        let frames: Vec<_> = (0..count).collect();
        let frames = speckle(&scene, &frames, seed);
        for &[i, j] in pairs {
            let name = format!("{part} of the way to the first zero, frames {i} and {j}");
            let law = axial_correlation(part);
            assert_correlation(&name, [&frames[i], &frames[j]], [0, 0], (law, size));
        }
    }
}

#[test]
fn the_pattern_moves_by_exactly_the_image_displacement() {
    let setting = Setting {
        lens: LENS,
        to_laser: DVec3::Z,
        distance: None,
    };
    let geometry = setting.geometry();
    let field = PupilField::new(256, 128, 4).expect("a valid field");
    let stack = SpeckleStack::generate(&field, SlicePath::Still).expect("a small stack");
    let surface = DVec3::new(0.25e-3, -0.11e-3, 0.0);
    let displacement = setting.law(&moved(Body::along(surface)));
    let displacement = displacement.image_displacement;
    let intensity = |pixel: DVec2, displacement: DVec2| {
        let c = geometry.pattern_coordinate(pixel, displacement, stack.speckle_size());
        stack.intensity_at(c.x, c.y, 0.0)
    };
    // The magnification is 1/11.
    let in_pixels = displacement / LENS.pixel_pitch;
    let expected = surface.truncate() / PIXEL;
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
            "it stands still at {pixel}"
        );
    }
}
