use proptest::prelude::*;
use tem00_testkit::assert_relative;

use super::*;
use crate::Focus;

const LENS: LensData = LensData {
    wavelength: 632.8e-9,
    focal_length: 60e-3,
    f_number: 6.0,
    surface_to_pupil: 0.3,
    pixel_pitch: 3.45e-6,
};

const THICK: ThickLensData = ThickLensData {
    wavelength: 632.8e-9,
    focal_length: 60e-3,
    f_number: 6.0,
    pupil_magnification: 1.0,
    focus: Focus::SurfaceToPupil(0.3),
    pixel_pitch: 3.45e-6,
};

/// The image distance of a thin lens.
fn image(object: f64, focal_length: f64) -> f64 {
    1.0 / (1.0 / focal_length - 1.0 / object)
}

#[test]
fn a_lens_of_two_elements_images_as_its_elements_do_one_after_the_other() {
    // f1, the stop `before` mm behind it, f2 another `behind` mm further, in metres.
    let (f1, f2, before, behind) = (0.1, 0.07, 0.008, 0.015);
    let stop_diameter = 6e-3;
    // The pupils are the images of the stop through the elements on either side. Both are virtual:
    // `image` is negative, on the side of the stop.
    let (entrance, exit) = (-image(before, f1), -image(behind, f2));
    let entrance_diameter = stop_diameter * entrance / before;
    let exit_diameter = stop_diameter * exit / behind;
    let separation = before + behind;
    let focal_length = f1 * f2 / (f1 + f2 - separation);
    for object in [0.2, 0.35, 2.0] {
        let first = image(object, f1);
        let second = image(separation - first, f2);
        // Real image before the second element, or a virtual object behind it.
        let magnification = (first / object * second / (separation - first)).abs();

        let geometry = ImagingGeometry::from_thick_lens(ThickLensData {
            focal_length,
            f_number: focal_length / entrance_diameter,
            pupil_magnification: exit_diameter / entrance_diameter,
            focus: Focus::SurfaceToPupil(object + entrance),
            ..THICK
        })
        .unwrap();

        let close = |got: f64, expected: f64| {
            // Rounding of differences of like distances.
            assert_relative(got, expected, 1e-13);
        };
        close(geometry.magnification(), magnification);
        close(geometry.pupil_to_image(), second + exit);
        close(geometry.pupil_diameter(), entrance_diameter);
        close(geometry.exit_pupil_diameter(), exit_diameter);
        close(geometry.working_f_number(), (second + exit) / exit_diameter);
        // The sine condition in its paraxial form: object and image side differ by m.
        let object_side = geometry.object_speckle_size() * magnification;
        close(geometry.speckle_size(), object_side);
    }
}

#[test]
fn depth_of_focus_is_half_a_wave_at_the_edge_of_the_pupil() {
    let geometry = ImagingGeometry::from_lens(LENS).unwrap();
    let (half_wave, radius) = (0.5 * LENS.wavelength, 0.5 * geometry.pupil_diameter());
    let path = |depth: f64| 0.5 * radius * radius * geometry.defocus_at(depth);
    // The path goes as the reciprocal depth: dz/L = 0.76 % either way.
    let depth = geometry.depth_of_focus();
    assert_relative(path(0.3 - depth), half_wave, 8e-3);
    assert_relative(path(0.3 + depth), -half_wave, 8e-3);
    // The same path moves the sensor: behind the lens of 75 mm, r²/2 (1/d − 1/d').
    let depth = geometry.sensor_depth_of_focus();
    let sensor = 0.5 * radius * radius * (1.0 / 75e-3 - 1.0 / (75e-3 + depth));
    assert_relative(sensor, half_wave, 2e-3);
    let left =
        crate::axial_correlation(geometry.depth_of_focus() / geometry.axial_decorrelation_length());
    assert!((left - 0.405_284_734_569_4).abs() < 1e-12, "left {left}");
}

#[test]
fn another_wavelength_changes_the_speckle_and_not_the_lens() {
    let geometry = ImagingGeometry::from_lens(LENS).unwrap();
    let blue = geometry.with_wavelength(316.4e-9).unwrap();
    assert_relative(blue.speckle_size(), 0.5 * geometry.speckle_size(), 1e-15);
    let restored = blue.with_wavelength(LENS.wavelength).unwrap();
    assert_eq!(restored, geometry, "the lens stays");
}

#[test]
fn a_quarter_magnification_lens_has_the_textbook_distances() {
    let geometry = ImagingGeometry::from_lens(LENS).unwrap();
    // L = (1 + 1/m) f and d_PI = (1 + m) f at m = 1/4; rounding only.
    assert_relative(geometry.magnification(), 0.25, 1e-14);
    assert_relative(geometry.pupil_to_image(), 75e-3, 1e-14);
    assert_relative(geometry.pupil_diameter(), 10e-3, 1e-14);
    // h = λ (1 + m) F.
    let speckle_size = 632.8e-9 * 7.5;
    assert_relative(geometry.speckle_size(), speckle_size, 1e-14);
    let in_pixels = speckle_size / 3.45e-6;
    assert_relative(geometry.speckle_size_in_pixels(), in_pixels, 1e-14);
    // 8 λ (1 + 1/m)² F² = 8 · 632.8 nm · 900.
    assert_relative(geometry.axial_decorrelation_length(), 4.556_16e-3, 1e-14);
}

#[test]
fn pattern_follows_the_image_displacement() {
    let geometry = ImagingGeometry::from_lens(LENS).unwrap();
    let shift = DVec2::new(17.0, -5.0);
    let pixel = DVec2::new(101.0, 33.0);
    // Five pixels down are five rows more.
    let there = DVec2::new(118.0, 38.0);
    let moved = geometry.pattern_coordinate(there, shift * geometry.pixel_pitch(), 4.0);
    let before = geometry.pattern_coordinate(pixel, DVec2::ZERO, 4.0);
    // What was at `pixel` is now there; rounding of coordinates near 400.
    assert!(
        (moved - before).length() < 1e-12,
        "{moved} instead of {before}"
    );
    // One speckle of the image, h_I pixels, is one speckle of the pattern, h_p samples.
    let speckle = DVec2::new(geometry.speckle_size_in_pixels(), 0.0);
    let span = geometry.pattern_coordinate(pixel + speckle, DVec2::ZERO, 4.0) - before;
    assert!(
        (span - DVec2::new(4.0, 0.0)).length() < 1e-12,
        "span {span}"
    );
}

proptest! {
    #[test]
    fn every_way_to_focus_a_thick_lens_finds_the_same_plane(
        focal_length in 1e-3_f64..1.0,
        f_number in 1.0_f64..100.0,
        pupil_magnification in 0.2_f64..5.0,
        magnification in 1e-3_f64..0.9,
    ) {
        let (f, m, m_p) = (focal_length, magnification, pupil_magnification);
        let focused = |focus| ImagingGeometry::from_thick_lens(ThickLensData {
            focal_length,
            f_number,
            pupil_magnification,
            focus,
            ..THICK
        });
        let by_magnification = focused(Focus::Magnification(m)).unwrap();
        let others = [
            Focus::SurfaceToPrincipalPlane(f + f / m),
            Focus::SurfaceToPupil(f / m + f / m_p),
        ];
        for focus in others {
            let other = focused(focus).unwrap();
            // The magnification is the difference of terms up to 1/m + 1/m_p of its reciprocal.
            let tolerance = 10.0 * f64::EPSILON * (1.0 + m / m_p);
            let distances = [
                (other.magnification(), m),
                (other.pupil_to_image(), by_magnification.pupil_to_image()),
                (other.surface_to_pupil(), by_magnification.surface_to_pupil()),
                (other.working_f_number(), f_number * (1.0 + m / m_p)),
            ];
            for (got, expected) in distances {
                prop_assert!((got / expected - 1.0).abs() < tolerance, "{:?}: {}", focus, got);
            }
        }
    }

    #[test]
    fn a_geometry_made_of_its_own_distances_is_the_same(
        focal_length in 1e-3_f64..1.0,
        ratio in 1.001_f64..1e3,
        f_number in 0.5_f64..100.0,
    ) {
        let lens = LensData {
            focal_length,
            f_number,
            surface_to_pupil: focal_length * ratio,
            ..LENS
        };
        let by_lens = ImagingGeometry::from_lens(lens).unwrap();
        let by_distances = ImagingGeometry::from_distances(PupilDistances {
            wavelength: lens.wavelength,
            surface_to_pupil: by_lens.surface_to_pupil(),
            pupil_to_image: by_lens.pupil_to_image(),
            pupil_diameter: by_lens.pupil_diameter(),
            pixel_pitch: lens.pixel_pitch,
        })
        .unwrap();
        // The focal length is a sum of reciprocals; all else is passed on and rounds at most twice.
        let pairs = [
            (by_distances.focal_length(), focal_length),
            (by_distances.f_number(), f_number),
            (by_distances.speckle_size(), by_lens.speckle_size()),
            (by_distances.object_speckle_size(), by_lens.object_speckle_size()),
            (by_distances.depth_of_focus(), by_lens.depth_of_focus()),
        ];
        for (got, expected) in pairs {
            prop_assert!((got / expected - 1.0).abs() < 1e-14, "{} instead of {}", got, expected);
        }
    }

    #[test]
    fn geometries_of_any_size_are_made_of_positive_numbers(
        exponents in [-30.0_f64..30.0, -30.0..30.0, -30.0..30.0, -30.0..30.0, -30.0..30.0],
        f_number in 0.5_f64..1e6,
    ) {
        let [wavelength, focal_length, m_p, m, pixel_pitch] = exponents.map(|x| 10.0_f64.powf(x));
        let focuses = [
            Focus::Magnification(m),
            Focus::SurfaceToPrincipalPlane(m),
            Focus::SurfaceToPupil(m),
        ];
        let thick = focuses.map(|focus| ImagingGeometry::from_thick_lens(ThickLensData {
            wavelength,
            focal_length,
            f_number,
            pupil_magnification: m_p,
            focus,
            pixel_pitch,
        }));
        let by_distances = ImagingGeometry::from_distances(PupilDistances {
            wavelength,
            surface_to_pupil: m,
            pupil_to_image: m_p,
            pupil_diameter: focal_length,
            pixel_pitch,
        });
        for geometry in thick.into_iter().chain([by_distances]).flatten() {
            let numbers = [
                geometry.focal_length(),
                geometry.f_number(),
                geometry.working_f_number(),
                geometry.surface_to_pupil(),
                geometry.pupil_to_image(),
                geometry.magnification(),
                geometry.pupil_diameter(),
                geometry.exit_pupil_diameter(),
                geometry.speckle_size_in_pixels(),
                geometry.object_speckle_size(),
                geometry.depth_of_focus(),
                geometry.sensor_depth_of_focus(),
            ];
            for number in numbers {
                prop_assert!(number > 0.0 && number.is_finite(), "{:?}", geometry);
            }
            let c = geometry.pattern_coordinate(DVec2::ZERO, DVec2::splat(m), 4.0);
            prop_assert!(c.is_finite(), "{:?}", geometry);
            prop_assert!(geometry.defocus_at(m).is_finite(), "{:?}", geometry);
        }
    }
}
