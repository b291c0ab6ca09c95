use approx::assert_relative_eq;
use glam::{DMat2, DMat3};
use proptest::prelude::*;

use super::*;
use crate::{CameraFrame, Focus, LensData, ThickLensData};

fn geometry() -> ImagingGeometry {
    ImagingGeometry::from_lens(LensData {
        wavelength: 650e-9,
        focal_length: 25e-3,
        f_number: 8.0,
        surface_to_pupil: 0.3,
        pixel_pitch: 3.45e-6,
    })
    .unwrap()
}

/// A camera on +z, 0.3 m from a point at the origin.
fn point(normal: DVec3, wavefront: Wavefront) -> SurfacePoint {
    let eye = DVec3::new(0.0, 0.0, 0.3);
    let camera = CameraFrame::look_at(eye, DVec3::ZERO, DVec3::Y).unwrap();
    let sight = LineOfSight::new(&camera, eye).unwrap();
    SurfacePoint::new(sight, normal, wavefront).unwrap()
}

fn collimated() -> Wavefront {
    Wavefront::plane(DVec3::new(1.0, 0.5, 1.0)).unwrap()
}

fn speckle(point: &SurfacePoint, motion: &Motion) -> SpeckleMotion {
    SpeckleMotion::new(&geometry(), point, motion, ImageOrientation::ScreenUpright)
}

/// The 2×2 system as it comes from the stationary phase, T[K + (I − l lᵀ)/d] a =
/// T(I − l lᵀ)A/d with T = (n1, n2), for motions of the surface alone.
fn pupil_displacement_by_solving(point: &SurfacePoint, a: DVec3) -> DVec2 {
    let (l, d) = (point.sight().direction(), point.sight().distance());
    let camera = point.sight().camera();
    let (n1, n2) = point.normal().any_orthonormal_pair();
    let across = |v: DVec3| (v - l * l.dot(v)) / d;
    let tangential = |v: DVec3| DVec2::new(n1.dot(v), n2.dot(v));
    let matrix = DMat2::from_cols(
        tangential(across(camera.right())),
        tangential(across(camera.up())),
    );
    matrix.inverse() * tangential(point.wavefront().curvature() * a + across(a))
}

#[test]
fn motion_of_the_surface_shows_the_right_way_round() {
    let point = point(DVec3::Z, collimated());
    let motion = Motion {
        surface: DVec3::new(0.25e-3, -0.1e-3, 0.0),
        ..Motion::default()
    };
    let screen = speckle(&point, &motion).image_displacement;
    // m = f / (L − f) = 1/11.
    let expected = DVec2::new(0.25e-3, -0.1e-3) / 11.0;
    assert!((screen - expected).length() < 1e-18, "screen {screen}");
    let sensor = point.image_displacement(&geometry(), &motion, ImageOrientation::SensorInverted);
    assert!((sensor + expected).length() < 1e-18, "sensor {sensor}");
}

#[test]
fn a_thick_lens_moves_the_image_by_its_magnification() {
    let thick = ImagingGeometry::from_thick_lens(ThickLensData {
        wavelength: 650e-9,
        focal_length: 50e-3,
        f_number: 4.0,
        pupil_magnification: 0.8,
        focus: Focus::Magnification(0.5),
        pixel_pitch: 3.45e-6,
    })
    .unwrap();
    // In focus at L = f (1/m + 1/m_p) = 162.5 mm, and 10 % nearer, where the image is blurred and as
    // much larger.
    for (depth, magnification) in [(162.5e-3, 0.5), (146.25e-3, 0.5 / 0.9)] {
        let eye = DVec3::new(0.0, 0.0, depth);
        let camera = CameraFrame::look_at(eye, DVec3::ZERO, DVec3::Y).unwrap();
        let sight = LineOfSight::new(&camera, eye).unwrap();
        let point = SurfacePoint::new(sight, DVec3::Z, collimated()).unwrap();
        let motion = Motion {
            surface: DVec3::new(1e-3, 0.0, 0.0),
            ..Motion::default()
        };
        let upright = ImageOrientation::ScreenUpright;
        let moved = SpeckleMotion::new(&thick, &point, &motion, upright);
        let expected = magnification * 1e-3;
        assert_relative_eq!(
            moved.image_displacement.x,
            expected,
            max_relative = 1e-13,
            epsilon = 0.0
        );
        // In collimated light the speckle out of focus moves as in focus: it is the moved surface's
        // own field that is seen, at the distance of focus.
        let speckle = moved.speckle_displacement().x;
        assert_relative_eq!(speckle, 0.5e-3, max_relative = 1e-13, epsilon = 0.0);
    }
}

#[test]
fn camera_motion_is_surface_motion_the_other_way_in_collimated_light() {
    let tilted = point(DVec3::new(0.5, -0.3, 1.0), collimated());
    let step = DVec3::new(0.4e-3, 0.2e-3, -0.3e-3);
    let by_camera = Motion {
        camera: -step,
        ..Motion::default()
    };
    let by_surface = Motion {
        surface: step,
        ..Motion::default()
    };
    let (camera, surface) = (speckle(&tilted, &by_camera), speckle(&tilted, &by_surface));
    assert_eq!(camera, surface, "only a − c counts, exactly");
    assert!(
        surface.correlation < 0.9,
        "the test would see nothing: {surface:?}"
    );
    assert_relative_eq!(surface.axial_displacement, -0.3e-3, max_relative = 1e-14);
}

#[test]
fn camera_in_curved_light_keeps_what_the_surface_does_not() {
    // Moving the camera with the surface leaves the motion of the surface through the wave:
    // d K a, here with d = 0.3 m and 1/R = 5/m.
    let lit = point(DVec3::Z, Wavefront::spherical(DVec3::Z, 5.0).unwrap());
    let step = DVec3::new(0.1e-3, 0.2e-3, 0.0);
    let together = Motion {
        surface: step,
        camera: step,
        ..Motion::default()
    };
    let displacement = lit.pupil_displacement(&together).unwrap();
    let expected = step.truncate() * (0.3 * 5.0);
    assert!(
        (displacement - expected).length() < 1e-18,
        "{displacement} instead of {expected}"
    );
    let moved = speckle(&lit, &together);
    assert_eq!(moved.image_displacement, DVec2::ZERO, "the image stands");
}

#[test]
fn grazing_view_in_curved_light_is_decorrelated() {
    let spherical = Wavefront::spherical(DVec3::new(1.0, 0.2, 1.0), 5.0).unwrap();
    let motion = Motion {
        surface: DVec3::new(1e-6, 1e-6, 0.0),
        ..Motion::default()
    };
    // Edge-on exactly, and closer to it than rounding can tell.
    for normal in [DVec3::Y, DVec3::new(0.0, 1.0, 1e-9)] {
        let moved = speckle(&point(normal, spherical), &motion);
        assert_eq!(moved.pupil_displacement, None, "{normal}: {moved:?}");
        assert!(moved.correlation == 0.0, "{normal}: {moved:?}");
    }
    let edge_on = point(DVec3::Y, spherical);
    // At rest, or in collimated light, there is nothing to amplify.
    let still = speckle(&edge_on, &Motion::default());
    assert!((still.correlation - 1.0).abs() < 1e-15, "{still:?}");
    let plane = speckle(&point(DVec3::Y, collimated()), &motion);
    assert!(plane.correlation > 0.99, "{plane:?}");
}

#[test]
fn results_can_cross_threads() {
    const fn crosses_threads<T: Send + Sync>() {}
    crosses_threads::<SpeckleMotion>();
    crosses_threads::<SurfacePoint>();
    crosses_threads::<ImagingGeometry>();
}

#[test]
fn invalid_normals_are_rejected() {
    let sight = *point(DVec3::Z, collimated()).sight();
    for bad in [
        DVec3::ZERO,
        DVec3::splat(f64::NAN),
        DVec3::splat(f64::INFINITY),
    ] {
        let result = SurfacePoint::new(sight, bad, collimated());
        assert!(
            matches!(
                result,
                Err(DecorrelationError::Vector {
                    parameter: "normal",
                    ..
                })
            ),
            "{bad}: {result:?}"
        );
    }
}

fn vectors(size: f64) -> impl Strategy<Value = DVec3> {
    [-size..size, -size..size, -size..size].prop_map(DVec3::from_array)
}

fn directions() -> impl Strategy<Value = DVec3> {
    vectors(1.0).prop_filter("a direction", |v| v.length() > 1e-3)
}

prop_compose! {
    /// Any camera, a line of sight up to 60° off its axis, any normal and astigmatic light.
    fn points()(
        angles in [-3.0_f64..3.0, -1.5..1.5, -3.0..3.0],
        field in [-1.2_f64..1.2, -1.2..1.2],
        distance in 0.05_f64..5.0,
        normal in directions(),
        to_source in directions(),
        curvatures in [-20.0_f64..20.0, -20.0..20.0],
    ) -> SurfacePoint {
        let [yaw, pitch, roll] = angles;
        let axes = DMat3::from_euler(glam::EulerRot::YXZ, yaw, pitch, roll);
        let camera = CameraFrame::from_axes(axes).unwrap();
        let sight = axes * DVec3::new(field[0], field[1], 1.0) * distance;
        let sight = LineOfSight::new(&camera, sight).unwrap();
        let axis = to_source.any_orthogonal_vector();
        let wave = Wavefront::astigmatic(to_source, axis, curvatures[0], curvatures[1]);
        SurfacePoint::new(sight, normal, wave.unwrap()).unwrap()
    }
}

proptest! {
    #[test]
    fn moving_everything_together_changes_nothing(
        point in points(),
        step in vectors(1e-2),
    ) {
        let motion = Motion { surface: step, camera: step, source: step };
        prop_assert_eq!(speckle(&point, &motion), speckle(&point, &Motion::default()));
        prop_assert!((speckle(&point, &motion).correlation - 1.0).abs() < 1e-15);
    }

    #[test]
    fn closed_form_solves_the_stationary_phase_equations(
        point in points(),
        a in vectors(1e-3),
    ) {
        let cosine = point.normal().dot(point.sight().direction()).abs();
        prop_assume!(cosine > 1e-2);
        let motion = Motion { surface: a, ..Motion::default() };
        let closed = point.pupil_displacement(&motion).unwrap();
        let solved = pupil_displacement_by_solving(&point, a);
        // The matrix has the determinant (n·l)(l·b3)/d² with l·b3 > 0.5; terms up to 100 |a|
        // round at ε and are amplified by its inverse.
        let tolerance = 1e4 * f64::EPSILON * a.length() / (cosine * cosine);
        prop_assert!((closed - solved).length() <= tolerance, "{} vs {}", closed, solved);
    }

    #[test]
    fn normal_may_have_any_length_and_side(point in points(), a in vectors(1e-3)) {
        let cosine = point.normal().dot(point.sight().direction()).abs();
        prop_assume!(cosine > 1e-2);
        let normal = point.normal() * -3.0;
        let other = SurfacePoint::new(*point.sight(), normal, *point.wavefront()).unwrap();
        let motion = Motion { surface: a, ..Motion::default() };
        let one = point.pupil_displacement(&motion).unwrap();
        let two = other.pupil_displacement(&motion).unwrap();
        // The unit normals differ by rounding, which k·n/(n·l) amplifies; terms up to 100 |a|.
        let tolerance = 1e4 * f64::EPSILON * a.length() / (cosine * cosine);
        prop_assert!((one - two).length() <= tolerance, "{} vs {}", one, two);
    }

    #[test]
    fn no_motion_yields_anything_but_numbers(
        point in points(),
        exponent in prop_oneof![-300.0_f64..300.0, 303.0..307.0],
        directions in [vectors(1.0), vectors(1.0), vectors(1.0)],
    ) {
        let size = 10.0_f64.powf(exponent);
        let [surface, camera, source] = directions.map(|v| v * size);
        let moved = speckle(&point, &Motion { surface, camera, source });
        prop_assert!((0.0..=1.0).contains(&moved.correlation), "{:?}", moved);
        prop_assert!(moved.speckle_displacement().is_finite(), "{:?}", moved);
        prop_assert!(moved.pupil_displacement.is_none_or(DVec2::is_finite), "{:?}", moved);
    }

    #[test]
    fn no_scene_yields_anything_but_numbers(
        exponents in [-30.0_f64..30.0, -30.0..30.0, -30.0..30.0, -30.0..30.0, -30.0..30.0, -30.0..30.0],
        directions in [directions(), directions(), directions(), directions()],
        f_number in 0.5_f64..1e3,
    ) {
        let [size, distance, along, across, focal_length, focus] = exponents.map(|x| 10.0_f64.powf(x));
        let [sight, normal, to_source, motion] = directions;
        let camera = CameraFrame::look_at(sight * distance, DVec3::ZERO, DVec3::Y);
        let geometry = ImagingGeometry::from_lens(LensData {
            wavelength: 1e-30,
            focal_length,
            f_number,
            surface_to_pupil: focal_length + focus,
            pixel_pitch: 1e-6,
        });
        let axis = to_source.any_orthogonal_vector();
        let wave = Wavefront::astigmatic(to_source, axis, along, -across).unwrap();
        let (Ok(camera), Ok(geometry)) = (camera, geometry) else {
            return Ok(());
        };
        let to_pupil = (sight + normal * 0.3) * distance;
        let Ok(sight) = LineOfSight::new(&camera, to_pupil) else {
            return Ok(());
        };
        let point = SurfacePoint::new(sight, normal * size, wave).unwrap();
        let motion = Motion { surface: motion * size, camera: normal * along, source: axis * across };
        for orientation in [ImageOrientation::ScreenUpright, ImageOrientation::SensorInverted] {
            let moved = SpeckleMotion::new(&geometry, &point, &motion, orientation);
            prop_assert!((0.0..=1.0).contains(&moved.correlation), "{:?}", moved);
            prop_assert!(moved.speckle_displacement().is_finite(), "{:?}", moved);
            prop_assert!(moved.pupil_displacement.is_none_or(DVec2::is_finite), "{:?}", moved);
        }
    }
}
