use glam::EulerRot;
use proptest::prelude::*;
use tem00_testkit::assert_absolute;

use super::*;
use crate::{
    CameraFrame, ConfigurationData, DMat3, Focus, Illumination, LensData, RigidMotion,
    RigidMotions, ThickLensData, Wavefront,
};

/// In focus at 0.3 m.
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

/// A camera on +z above the origin at `depth`, in collimated light from 45°.
fn upright(depth: f64) -> ConfigurationData {
    let pupil = DVec3::new(0.0, 0.0, depth);
    ConfigurationData {
        wavelength: 650e-9,
        point: DVec3::ZERO,
        normal: DVec3::Z,
        illumination: Illumination::collimated(DVec3::new(1.0, 0.0, 1.0)).unwrap(),
        camera: CameraFrame::look_at(pupil, DVec3::ZERO, DVec3::Y).unwrap(),
        pupil,
    }
}

fn after_surface(before: &Configuration, surface: RigidMotion) -> Configuration {
    let still = RigidMotions::default();
    before.moved(&RigidMotions { surface, ..still }).unwrap()
}

fn turned(degrees: f64) -> RigidMotion {
    RigidMotion::about(DVec3::ZERO, DVec3::Y, degrees.to_radians()).unwrap()
}

#[test]
fn speckle_that_leaves_elsewhere_is_decorrelated() {
    let before = Configuration::new(upright(0.3)).unwrap();
    let other_side = Illumination::collimated(DVec3::new(-1.0, 0.0, 1.0)).unwrap();
    // Lit from 45° and seen from 0°, the sines sum to 1/√2.
    let changes = [
        // Lit from −5° to the normal, the speckle leaves at 53°, which is 103° to the axis.
        ("turned away", after_surface(&before, turned(50.0))),
        ("lit from behind", after_surface(&before, turned(-50.0))),
        // A sine of √2.
        ("evanescent", before.with_illumination(other_side).unwrap()),
    ];
    for (name, after) in changes {
        let found = before.pupil_point_after(&after, DVec2::ZERO);
        assert_eq!(found, None, "{name}");
        let speckle = SpeckleMotion::between(&geometry(), &before, &after);
        assert_eq!(speckle.pupil_displacement, None, "{name}");
        assert!(speckle.correlation == 0.0, "{name}: {speckle:?}");
        assert_eq!(speckle.defocus_displacement, DVec2::ZERO, "{name}");
    }
    // Less far, there is speckle at the edge of the world.
    let found = before.pupil_point_after(&after_surface(&before, turned(40.0)), DVec2::ZERO);
    assert!(found.is_some_and(|p| p.x > 0.5), "{found:?}");
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
    let slid = RigidMotion::along(DVec3::new(1e-3, 0.0, 0.0)).unwrap();
    // In focus at L = f (1/m + 1/m_p) = 162.5 mm, and 10 % nearer, where the image is blurred and
    // as much larger.
    for (depth, magnification) in [(162.5e-3, 0.5), (146.25e-3, 0.5 / 0.9)] {
        let before = Configuration::new(upright(depth)).unwrap();
        let moved = SpeckleMotion::between(&thick, &before, &after_surface(&before, slid));
        // Rounding of directions, 1e−16, over a principal distance of 81 mm.
        assert_absolute(moved.image_displacement.x, magnification * 1e-3, 1e-16);
        // In collimated light the speckle out of focus moves as in focus: the camera sees the field
        // of the moved surface itself, at the distance of focus.
        assert_absolute(moved.speckle_displacement().x, 0.5e-3, 1e-16);
    }
}

#[test]
fn an_edge_on_surface_is_decorrelated() {
    for normal in [DVec3::Y, DVec3::new(0.0, 1.0, 1e-9)] {
        let before = Configuration::new(ConfigurationData {
            normal,
            ..upright(0.3)
        })
        .unwrap();
        let step = RigidMotion::along(DVec3::new(1e-6, 1e-6, 0.0)).unwrap();
        let after = after_surface(&before, step);
        let speckle = SpeckleMotion::between(&geometry(), &before, &after);
        assert_eq!(speckle.pupil_displacement, None, "{normal}");
        assert!(speckle.correlation == 0.0, "{normal}: {speckle:?}");
    }
}

#[test]
fn a_far_focus_sees_the_directions_of_the_light() {
    // Focused at infinity, a picture shows where light comes from. In collimated light the speckle
    // of a surface that slides is at rest, and the speckle of a surface that tilts by θ turns by
    // 2θ, away.
    let far = ImagingGeometry::from_lens(LensData {
        wavelength: 650e-9,
        focal_length: 25e-3,
        f_number: 8.0,
        surface_to_pupil: 1e9,
        pixel_pitch: 3.45e-6,
    })
    .unwrap();
    let before = Configuration::new(upright(0.3)).unwrap();
    let slid = RigidMotion::along(DVec3::new(0.2e-3, -0.1e-3, 0.0)).unwrap();
    let sensed = |surface| {
        let after = after_surface(&before, surface);
        SpeckleMotion::between(&far, &before, &after).speckle_displacement()
    };
    // f · |a| / L, the rest of the distance that is not infinite.
    assert!(sensed(slid).length() < 1e-14, "{}", sensed(slid));

    let along = Illumination::collimated(DVec3::Z).unwrap();
    let before = before.with_illumination(along).unwrap();
    let after = after_surface(&before, turned(1e-3_f64.to_degrees()));
    let tilted = SpeckleMotion::between(&far, &before, &after).speckle_displacement();
    // tan 2θ differs from 2θ by 4θ²/3.
    assert!((tilted.x + 25e-3 * 2e-3).abs() < 1e-10, "{tilted}");
}

/// The squared correlation of the amplitudes in a pupil of `geometry` for two waves whose paths
/// over the pupil point p differ by `W p²/2`, by a sum over rings of equal area.
fn left_by_defocus(geometry: &ImagingGeometry, [w0, w1]: [f64; 2], wavelengths: [f64; 2]) -> f64 {
    const RINGS: u32 = 2000;
    let (mut re, mut im) = (0.0, 0.0);
    for ring in 0..RINGS {
        let p =
            0.5 * geometry.pupil_diameter() * ((f64::from(ring) + 0.5) / f64::from(RINGS)).sqrt();
        let phase = TAU * 0.5 * p * p * (w1 / wavelengths[1] - w0 / wavelengths[0]);
        re += phase.cos() / f64::from(RINGS);
        im += phase.sin() / f64::from(RINGS);
    }
    re * re + im * im
}

#[test]
fn defocus_costs_what_the_pupil_integral_says() {
    let geometry = geometry();
    let along = Illumination::collimated(DVec3::Z).unwrap();
    for (depth, dz, wavelength) in [
        (0.3, 12e-3, 650e-9),
        (0.32, -30e-3, 650e-9),
        (0.22, 0.0, 600e-9),
    ] {
        let before = Configuration::new(ConfigurationData {
            illumination: along,
            ..upright(depth)
        })
        .unwrap();
        let nearer = RigidMotion::along(DVec3::new(0.0, 0.0, dz)).unwrap();
        let after = after_surface(&before, nearer)
            .with_wavelength(wavelength)
            .unwrap();
        let speckle = SpeckleMotion::between(&geometry, &before, &after);
        let w = [depth, depth - dz].map(|z| 1.0 / z - 1.0 / 0.3);
        let left = left_by_defocus(&geometry, w, [650e-9, wavelength]);
        // Midpoints of 2000 rings, up to two turns of phase: 1e−6.
        assert_absolute(speckle.correlation, left, 1e-5);
        assert!(left < 0.96, "the test would see nothing: {left}");
    }
}

fn vectors(size: f64) -> impl Strategy<Value = DVec3> {
    [-size..size, -size..size, -size..size].prop_map(DVec3::from_array)
}

fn directions() -> impl Strategy<Value = DVec3> {
    vectors(1.0).prop_filter("a direction", |v| v.length() > 1e-2)
}

prop_compose! {
    /// Any camera with sight lines up to 50° off its axis, over a surface seen from above 20° that
    /// is lit by an astigmatic wave.
    fn scenes()(
        angles in [-3.0_f64..3.0, -1.5..1.5, -3.0..3.0],
        field in [-0.8_f64..0.8, -0.8..0.8],
        distance in 0.1_f64..2.0,
        normal in directions(),
        to_source in directions(),
        curvatures in [-3.0_f64..3.0, -3.0..3.0],
        point in vectors(1.0),
    ) -> ConfigurationData {
        let [yaw, pitch, roll] = angles;
        let axes = DMat3::from_euler(EulerRot::YXZ, yaw, pitch, roll);
        let to_pupil = axes * DVec3::new(field[0], field[1], 1.0) * distance;
        // Turned towards the camera, if need be.
        let normal = normal.normalize() + to_pupil.normalize() * 1.2;
        let axis = to_source.any_orthogonal_vector();
        let [along, across] = curvatures;
        let wavefront = Wavefront::astigmatic(to_source, axis, along, across).unwrap();
        ConfigurationData {
            wavelength: 650e-9,
            point,
            normal,
            illumination: Illumination::near(point, wavefront).unwrap(),
            camera: CameraFrame::from_axes(axes).unwrap(),
            pupil: point + to_pupil,
        }
    }
}

prop_compose! {
    fn small_turns(size: f64)(
        axis in directions(),
        angle in -size..size,
        pivot in vectors(1.0),
        translation in vectors(size),
    ) -> RigidMotion {
        let turn = RigidMotion::about(pivot, axis, angle).unwrap();
        turn.then(&RigidMotion::along(translation).unwrap())
    }
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(200))]

    #[test]
    fn moving_everything_as_one_body_changes_nothing(
        data in scenes(),
        motion in small_turns(3.0),
        q in [-0.01_f64..0.01, -0.01..0.01],
    ) {
        let before = Configuration::new(data).unwrap();
        let after = before
            .moved(&RigidMotions { surface: motion, camera: motion, source: motion })
            .unwrap();
        let q = DVec2::from_array(q);
        // Lengths of a few metres, amplified by the inverse cosines of surface and pupil.
        let moved = before.pupil_point_after(&after, q).unwrap();
        prop_assert!((moved - q).length() < 1e-12, "{}", moved - q);
        let speckle = SpeckleMotion::between(&geometry(), &before, &after);
        prop_assert!(speckle.image_displacement.length() < 1e-14, "{:?}", speckle);
        prop_assert!((speckle.correlation - 1.0).abs() < 1e-9, "{:?}", speckle);
        let phase = before.height_phase_change(&after).unwrap();
        // Of 2π/λ = 1e7.
        prop_assert!(phase.abs() < 1e-6, "{}", phase);
    }

    #[test]
    fn the_normal_may_point_to_either_side(
        data in scenes(),
        surface in small_turns(0.02),
    ) {
        let found = |normal| {
            let before = Configuration::new(ConfigurationData { normal, ..data }).unwrap();
            let after = after_surface(&before, surface);
            let point = before.pupil_point_after(&after, DVec2::ZERO);
            Some((point?, before.height_phase_change(&after)?))
        };
        let (one, other) = (found(data.normal), found(-3.0 * data.normal));
        prop_assert_eq!(one.is_some(), other.is_some());
        if let (Some((p, change)), Some((q, opposite))) = (one, other) {
            // Rounding of lengths of a few metres and of 2π/λ = 1e7, amplified by the slopes.
            let tolerance = 1e-12 * (1.0 + p.length_squared());
            prop_assert!((p - q).length() < tolerance, "{} or {}", p, q);
            prop_assert!((change + opposite).abs() < 1e-6, "{} or {}", change, opposite);
        }
    }

    #[test]
    fn motions_in_turn_and_back_are_as_one_at_a_time(
        data in scenes(),
        motions in [small_turns(0.02), small_turns(0.02), small_turns(0.02)],
        wavelengths in [600e-9_f64..700e-9, 600e-9..700e-9],
        q in [-0.01_f64..0.01, -0.01..0.01],
    ) {
        let [surface, camera, source] = motions;
        let first = Configuration::new(data).unwrap();
        let moved = first.moved(&RigidMotions { surface, camera, source });
        let second = moved.and_then(|state| state.with_wavelength(wavelengths[0]));
        prop_assume!(second.is_ok());
        let second = second.unwrap();
        let moved = second.moved(&RigidMotions {
            surface: camera,
            camera: source,
            source: surface,
        });
        let third = moved.and_then(|state| state.with_wavelength(wavelengths[1]));
        prop_assume!(third.is_ok());
        let third = third.unwrap();
        let q = DVec2::from_array(q);
        let in_turn = first
            .pupil_point_after(&second, q)
            .and_then(|p| Some((p, second.pupil_point_after(&third, p)?)));
        prop_assume!(in_turn.is_some());
        let (p, end) = in_turn.unwrap();
        // Rounding of lengths of a few metres, amplified by the slopes of the lines it goes along.
        let tolerance = 1e-12 * (1.0 + p.length_squared() + end.length_squared());
        let direct = first.pupil_point_after(&third, q).unwrap();
        prop_assert!((direct - end).length() < tolerance, "{} or {}", direct, end);
        let back = second.pupil_point_after(&first, p).unwrap();
        prop_assert!((back - q).length() < tolerance, "{} or {}", back, q);
    }

    #[test]
    fn no_change_yields_anything_but_numbers(
        data in scenes(),
        exponents in [
            -30.0_f64..30.0, -30.0..30.0, -30.0..30.0, -30.0..30.0, -30.0..30.0, -30.0..30.0,
        ],
        f_number in 0.5_f64..1e3,
        units in [vectors(1.0), vectors(1.0), vectors(1.0)],
        axis in directions(),
        angle in -4.0_f64..4.0,
    ) {
        let [size, wavelength, pivot, curvature, focal_length, focus] =
            exponents.map(|x| 10.0_f64.powf(x));
        let Ok(geometry) = ImagingGeometry::from_lens(LensData {
            wavelength: 1e-30,
            focal_length,
            f_number,
            surface_to_pupil: focal_length + focus,
            pixel_pitch: 1e-6,
        }) else {
            return Ok(());
        };
        let step = |v: DVec3| RigidMotion::along(v * size).unwrap();
        let surface = RigidMotion::about(axis * pivot, axis.any_orthogonal_vector(), angle);
        let wavefront = Wavefront::spherical(axis, curvature).unwrap();
        let before = Configuration::new(ConfigurationData {
            illumination: Illumination::near(data.point, wavefront).unwrap(),
            ..data
        })
        .unwrap();
        let after = before.moved(&RigidMotions {
            surface: surface.unwrap().then(&step(units[0])),
            camera: step(units[1]),
            source: step(units[2]),
        });
        let Ok(after) = after.and_then(|state| state.with_wavelength(wavelength)) else {
            return Ok(());
        };
        let moved = SpeckleMotion::between(&geometry, &before, &after);
        prop_assert!((0.0..=1.0).contains(&moved.correlation), "{:?}", moved);
        prop_assert!(moved.speckle_displacement().is_finite(), "{:?}", moved);
        prop_assert!(moved.axial_displacement.is_finite(), "{:?}", moved);
        prop_assert!(moved.pupil_displacement.is_none_or(DVec2::is_finite), "{:?}", moved);
        let far = before.pupil_point_after(&after, DVec2::new(size, -pivot));
        prop_assert!(far.is_none_or(DVec2::is_finite), "{:?}", far);
        prop_assert!(before.height_phase_change(&after).is_none_or(f64::is_finite));
    }
}
