use proptest::prelude::*;
use tem00_decorrelation::{
    Configuration, ConfigurationData, Focus, Illumination, LensData, RigidMotion, RigidMotions,
    SpeckleMotion, ThickLensData, Wavefront, axial_correlation, pupil_overlap_correlation,
};
use tem00_numerics::circular_path_overlap;
use tem00_testkit::assert_relative;

use super::*;

fn geometry() -> ImagingGeometry {
    ImagingGeometry::from_lens(LensData {
        wavelength: 632.8e-9,
        focal_length: 60e-3,
        f_number: 6.0,
        surface_to_pupil: 0.3,
        pixel_pitch: 3.45e-6,
    })
    .unwrap()
}

/// The law between two states, in the limit of small motions, per metre of a motion of the surface
/// along the unit vector `a`: in the image, upright, and in the pupil.
///
/// The surface axes are world axes; the camera is turned by `angles` and sees the point at
/// `to_pupil` in its own axes. Half the difference of both directions has an error of third order,
/// (1e−6 over the shortest radius)², and the rounding of lengths over 1e−6.
fn law(angles: EulerAngles, emitter: Emitter, to_pupil: DVec3, a: DVec3) -> [DVec2; 2] {
    const STEP: f64 = 1e-6;
    let axes = angles.camera_axes();
    let wave = Wavefront::spherical(emitter.direction, 1.0 / emitter.distance).unwrap();
    let before = Configuration::new(ConfigurationData {
        wavelength: geometry().wavelength(),
        point: DVec3::ZERO,
        normal: DVec3::Z,
        illumination: Illumination::near(DVec3::ZERO, wave).unwrap(),
        camera: CameraFrame::from_axes(axes).unwrap(),
        pupil: axes * to_pupil,
    })
    .unwrap();
    let moved = |step: f64| {
        let surface = RigidMotion::along(a * step).unwrap();
        let still = RigidMotions::default();
        let after = before.moved(&RigidMotions { surface, ..still }).unwrap();
        let speckle = SpeckleMotion::between(&geometry(), &before, &after);
        [
            speckle.image_displacement,
            speckle.pupil_displacement.unwrap(),
        ]
    };
    let [forth, back] = [STEP, -STEP].map(moved);
    [0, 1].map(|i| (forth[i] - back[i]) / (2.0 * STEP))
}

/// Light of a plane wave from the direction of the normal.
const FROM_ABOVE: Emitter = Emitter {
    direction: DVec3::Z,
    distance: f64::INFINITY,
};

/// Correlation of slices `x` half periods apart on a circular stack.
fn stack_correlation(x: f64) -> f64 {
    circular_path_overlap(x).powi(2)
}

#[test]
fn printed_rows_of_equation_5_are_not_orthogonal() {
    let angles = EulerAngles { q1: 0.4, q2: 0.6 };
    let columns = [DVec3::X, DVec3::Y, DVec3::Z].map(|a| image_displacement(1.0, angles, a));
    let product: f64 = columns.iter().map(|c| c.x * c.y).sum();
    assert_relative(product, 0.8_f64.sin() * 0.6_f64.sin(), 1e-14);
}

#[test]
fn equation_5_sends_motion_along_the_normal_the_wrong_way() {
    let angles = EulerAngles {
        q1: 30_f64.to_radians(),
        q2: 0.0,
    };
    let printed = image_displacement(0.25, angles, DVec3::Z * 400e-6);
    let [ours, _] = law(angles, FROM_ABOVE, DVec3::Z * 0.3, DVec3::Z);
    // On the sensor, upside down: m a_z sin 30° = 50 µm, to rounding.
    let ours = -ours * 400e-6;
    assert!(
        (printed - DVec2::new(-50e-6, 0.0)).length() < 1e-17,
        "{printed}"
    );
    assert!((ours - DVec2::new(50e-6, 0.0)).length() < 1e-13, "{ours}");
}

#[test]
fn pattern_is_not_decorrelated_at_the_printed_distance() {
    let shift = axial_decorrelation_length(&geometry()) / geometry().axial_decorrelation_length();
    assert_relative(shift, 0.5, 1e-14);
    // 632.8 nm · [2 · 5 · 6]².
    assert_relative(axial_decorrelation_length(&geometry()), 2.278_08e-3, 1e-14);
}

#[test]
fn printed_slice_coordinate_has_the_stated_errors() {
    let geometry = geometry();
    let in_plane = |s: f64| {
        let shift = DVec2::new(0.0, s * geometry.pupil_diameter());
        let u = slice_coordinate(&geometry, shift, 0.0, 8);
        (stack_correlation(u / 8.0) - pupil_overlap_correlation(s)).abs()
    };
    let axial = |x: f64| {
        let dz = x * axial_decorrelation_length(&geometry);
        let u = slice_coordinate(&geometry, DVec2::ZERO, dz, 8);
        (stack_correlation(u / 8.0) - axial_correlation(0.5 * x)).abs()
    };
    let worst = |error: &dyn Fn(f64) -> f64| {
        (0..=1000_u32)
            .map(|i| f64::from(i) / 1000.0)
            .map(|x| (error(x), x))
            .fold((0.0, 0.0), |a, b| if b.0 > a.0 { b } else { a })
    };
    // The values are stated to the last given digit.
    let (error, s) = worst(&in_plane);
    assert!((error - 0.1949).abs() < 1e-4, "in the plane {error}");
    assert!((s - 0.273).abs() < 1.5e-3, "in the plane at {s}");
    let (error, x) = worst(&axial);
    assert!((error - 0.7896).abs() < 1e-4, "along the axis {error}");
    assert!((x - 0.431).abs() < 1.5e-3, "along the axis at {x}");
    // One value by hand: sinc²(0.1875 π) = 0.8896 against [1 − 0.375 − sin(0.375 π)/π]².
    assert!((axial(0.375) - (0.8896 - 0.1095)).abs() < 1e-4, "at 0.375");
}

#[test]
fn printed_slice_coordinates_bring_an_old_pattern_back() {
    let geometry = geometry();
    let left = |s: f64, x: f64| {
        let shift = DVec2::new(s * geometry.pupil_diameter(), 0.0);
        let dz = x * axial_decorrelation_length(&geometry);
        stack_correlation(slice_coordinate(&geometry, shift, dz, 8) / 8.0)
    };
    // One displacement undoes the other; two pupil diameters are once round the stack. At least one
    // displacement alone leaves a correlation of 15 % or zero. Rounding of u, 1e−15, enters four
    // times.
    for (s, x) in [(0.5, -0.5), (1.0, -1.0), (2.0, 0.0)] {
        assert!((left(s, x) - 1.0).abs() < 1e-14, "s = {s}, x = {x}");
        assert!(pupil_overlap_correlation(s) < 0.16, "s = {s}");
    }
}

#[test]
fn printed_signs_run_backwards() {
    let geometry = geometry();
    let (pixel, shift) = (DVec2::new(10.0, 20.0), DVec2::new(1e-5, -2e-5));
    let printed = pattern_coordinate(&geometry, pixel, shift, 4.0);
    let rows_down = DVec2::new(pixel.x, -pixel.y);
    let ours = geometry.pattern_coordinate(rows_down, -shift, 4.0);
    // Rounding of coordinates of about 60 samples.
    assert!(
        (printed - ours).length() < 1e-13,
        "{printed} against {ours}"
    );
    let along = relative_pupil_displacement(shift, shift);
    assert_eq!(along, shift * 2.0, "a camera moving with the speckle");
}

#[test]
fn printed_pair_misses_what_a_motion_along_the_axis_does_beside_it() {
    let angles = EulerAngles { q1: 0.0, q2: 0.0 };
    let a = DVec3::new(0.0, 0.0, 400e-6);
    let printed = pupil_displacement(angles, FROM_ABOVE, 0.2, a).unwrap();
    let [_, ours] = law(
        angles,
        FROM_ABOVE,
        DVec3::new(0.35, 0.0, 1.0) * 0.2,
        DVec3::Z,
    );
    let ours = ours * 400e-6;
    // −0.35 · 400 µm, to rounding.
    assert!(printed.length() < 1e-18, "{printed}");
    assert!((ours - DVec2::new(-140e-6, 0.0)).length() < 1e-13, "{ours}");
}

#[test]
fn distance_of_the_emitter_is_not_the_radius_of_a_beam() {
    // A helium–neon laser 0.3 m from a surface seen from 0.2 m.
    let angles = EulerAngles { q1: 0.0, q2: 0.0 };
    let emitter = Emitter {
        direction: DVec3::Z,
        distance: 0.3,
    };
    let printed = pupil_displacement(angles, emitter, 0.2, DVec3::X)
        .unwrap()
        .x;
    assert!((printed - 5.0 / 3.0).abs() < 1e-12, "{printed}");
    // 1 + d/R to four digits, with the Rayleigh range π w₀²/λ of a waist of 100 µm.
    let rayleigh = core::f64::consts::PI * 1e-8 / 632.8e-9;
    for (z, expected) in [(50e-3, 3.014), (0.0, 1.0), (-80e-3, -0.8049)] {
        let beam = Emitter {
            distance: z + rayleigh * rayleigh / z,
            ..emitter
        };
        let [_, DVec2 { x: ratio, .. }] = law(angles, beam, DVec3::Z * 0.2, DVec3::X);
        assert!((ratio - expected).abs() < 5e-4, "{z}: {ratio}");
    }
}

#[test]
fn printed_length_is_half_the_true_one_for_a_thin_lens_only() {
    let thick = |pupil_magnification| {
        ImagingGeometry::from_thick_lens(ThickLensData {
            wavelength: 632.8e-9,
            focal_length: 50e-3,
            f_number: 4.0,
            pupil_magnification,
            focus: Focus::Magnification(0.5),
            pixel_pitch: 3.45e-6,
        })
        .unwrap()
    };
    let ratio = |lens| axial_decorrelation_length(&lens) / lens.axial_decorrelation_length();
    assert!((ratio(thick(1.0)) - 0.5).abs() < 1e-14, "thin");
    // Half of [(1 + 2) / (1/0.8 + 2)]².
    let expected = 0.5 * (3.0_f64 / 3.25).powi(2);
    assert!((ratio(thick(0.8)) - expected).abs() < 1e-14, "thick");
}

#[test]
fn printed_pair_has_no_value_in_a_grazing_view() {
    let emitter = Emitter {
        direction: DVec3::Z,
        distance: 0.2,
    };
    let angles = EulerAngles {
        q1: f64::NAN,
        q2: 0.0,
    };
    assert_eq!(
        pupil_displacement(angles, emitter, 0.3, DVec3::X),
        None,
        "not a number"
    );
}

#[test]
fn normals_without_direction_have_no_angles() {
    let camera = CameraFrame::look_at(DVec3::Z, DVec3::ZERO, DVec3::Y).unwrap();
    for bad in [DVec3::ZERO, DVec3::splat(f64::NAN)] {
        assert_eq!(EulerAngles::between(&camera, bad), None, "{bad}");
    }
}

prop_compose! {
    fn emitters()(
        x in -0.9_f64..0.9, y in -0.9_f64..0.9, z in 0.1_f64..1.0, curvature in -20.0_f64..20.0,
    ) -> Emitter {
        Emitter { direction: DVec3::new(x, y, z).normalize(), distance: 1.0 / curvature }
    }
}

proptest! {
    #[test]
    fn sjodahls_pair_is_the_general_law_on_the_axis(
        q1 in -1.2_f64..1.2,
        q2 in -1.2_f64..1.2,
        emitter in emitters(),
        distance in 0.05_f64..5.0,
        a in [-1.0_f64..1.0, -1.0..1.0, -1.0..1.0],
    ) {
        let (angles, a) = (EulerAngles { q1, q2 }, DVec3::from_array(a));
        prop_assume!(a.length() > 0.1);
        let a = a.normalize();
        let [_, ours] = law(angles, emitter, DVec3::Z * distance, a);
        let printed = pupil_displacement(angles, emitter, distance, a).unwrap();
        // Terms up to 1 + d/d_SL ≤ 101 over cos q1 cos q2 ≥ 0.13: their third order, (1e−6 /
        // 0.05)², and the rounding of d over 1e−6.
        let tolerance = 1e-6 * (1.0 + distance * (1.0 + emitter.distance.abs().recip()));
        prop_assert!((ours - printed).length() <= tolerance, "{} vs {}", ours, printed);
    }

    #[test]
    fn equation_5_is_right_for_motion_in_the_surface(
        q1 in -1.2_f64..1.2,
        q2 in -1.2_f64..1.2,
        emitter in emitters(),
        direction in -3.0_f64..3.0,
    ) {
        let (angles, a) = (EulerAngles { q1, q2 }, DVec2::from_angle(direction).extend(0.0));
        let [ours, _] = law(angles, emitter, DVec3::Z * 0.3, a);
        let printed = image_displacement(geometry().magnification(), angles, a);
        // The rounding of tangents over 1e−6; on the sensor all is upside down.
        prop_assert!((ours + printed).length() <= 1e-9);
    }

    #[test]
    fn two_angles_express_any_camera_over_any_surface(
        turn in [-3.0_f64..3.0, -1.5..1.5, -3.0..3.0],
        normal in [-1.0_f64..1.0, -1.0..1.0, -1.0..1.0],
    ) {
        let axes = DMat3::from_euler(glam::EulerRot::YXZ, turn[0], turn[1], turn[2]);
        let camera = CameraFrame::from_axes(axes).unwrap();
        let normal = DVec3::from_array(normal);
        prop_assume!(normal.normalize().cross(axes.x_axis).length() > 1e-3);
        let (surface, angles) = EulerAngles::between(&camera, normal).unwrap();
        prop_assert!(angles.q1.cos() >= 0.0, "q1 = {}", angles.q1);
        let difference = surface * angles.camera_axes() - axes;
        // n2 rounds by ε over the sine between the normal and b1.
        let largest = difference.to_cols_array().iter().fold(0.0_f64, |m, x| m.max(x.abs()));
        prop_assert!(largest < 1e-12, "{}", difference);
    }
}
