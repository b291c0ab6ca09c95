use super::*;

fn with_distortion(k1: f64, k2: f64, k3: f64) -> CameraDescription {
    CameraDescription {
        distortion: RadialDistortion { k1, k2, k3 },
        ..description()
    }
}

/// The point at a tangent to the right and up, 0.4 m before the camera.
fn at_tangent(camera: &Camera, tangent: DVec2) -> DVec3 {
    let axes = camera.axes();
    let direction = tangent.x * axes.x_axis + tangent.y * axes.y_axis - axes.z_axis;
    camera.position() + 0.4 * direction
}

#[test]
fn distortion_is_that_of_brown() {
    let camera = Camera::new(with_distortion(-4.0, 300.0, -2e4)).unwrap();
    let t = DVec2::new(0.03, -0.02);
    let s = 0.03_f64.powi(2) + 0.02_f64.powi(2);
    let distorted = t * (1.0 - 4.0 * s + 300.0 * s * s - 2e4 * s * s * s);
    let to_pixels = 25e-3 * 0.3 / 0.275 / 3.45e-6;
    let expected = DVec2::new(320.0, 240.0) + to_pixels * distorted * DVec2::new(1.0, -1.0);
    let got = camera.project(at_tangent(&camera, t)).unwrap();
    // 1e4 pixels times some roundings.
    assert!(got.distance(expected) < 1e-10, "{got}, not {expected}");
}

#[test]
fn a_barrel_does_not_fold_the_surroundings_into_the_image() {
    let camera = Camera::new(with_distortion(-10.0, 0.0, 0.0)).unwrap();
    // 0.3 (1 − 10 · 0.09) = 0.03 would be in the image, which ends at 0.05. The distorted radius
    // stops growing at 1/√30 = 0.1826.
    let image = |radius| camera.project(at_tangent(&camera, DVec2::new(radius, 0.0)));
    assert_eq!(image(0.3), None, "folded");
    assert_eq!(image(0.1826), None, "just behind the turning point");
    assert!(image(0.1825).is_some(), "just before the turning point");
    let lens = camera.connect(at_tangent(&camera, DVec2::new(0.3, 0.0)), [0.5, 0.5]);
    assert_eq!(lens, None, "folded");
}

#[test]
fn an_image_may_turn_back_behind_the_farthest_of_its_corners_alone() {
    let to_tangent = 3.45e-6 * 0.275 / (25e-3 * 0.3);
    let centre = DVec2::new(320.0, 240.0);
    // The corners lie 16 pixels beyond the image.
    for corner in [
        [-16.0, -16.0],
        [656.0, -16.0],
        [-16.0, 496.0],
        [656.0, 496.0],
    ] {
        let corner = DVec2::from_array(corner);
        let axis = centre + 0.25 * (centre - corner);
        let radius = corner.distance(axis) * to_tangent;
        for (part, is_possible) in [(0.999, false), (1.001, true)] {
            // r (1 + k₁ r²) is largest at r² = −1/3k₁, where it is 2r/3.
            let k1 = -4.0 / 27.0 / (part * radius).powi(2);
            let camera = Camera::new(CameraDescription {
                principal_point: Some(axis),
                ..with_distortion(k1, 0.0, 0.0)
            });
            assert_eq!(camera.is_ok(), is_possible, "{corner}: {camera:?}");
        }
    }
}

/// Rays meet the sensor above its horizon, where their tangent is −cot τ.
#[test]
fn tilted_sensors_have_a_horizon() {
    let camera = Camera::new(CameraDescription {
        tilt: SensorTilt {
            angle: 1.5,
            azimuth: 0.0,
        },
        ..description()
    });
    let camera = camera.unwrap();
    let horizon = 1.5_f64.tan().recip();
    for (tangent, is_met) in [(-0.99, true), (-1.01, false), (1.01, true)] {
        let point = at_tangent(&camera, DVec2::new(0.0, tangent * horizon));
        assert_eq!(camera.project(point).is_some(), is_met, "{tangent}");
    }
}

#[test]
fn the_axis_meets_the_principal_point() {
    let middle = DVec2::new(320.0, 240.0);
    for (described, point) in [
        (description(), middle),
        (crooked(), DVec2::new(300.0, 260.0)),
    ] {
        let camera = Camera::new(described).unwrap();
        let image = camera.project(described.look_at).unwrap();
        assert!(image.distance(point) < 1e-9, "{image}");
        let view = (described.look_at - described.position).normalize();
        let direction = camera.ray(point).direction;
        assert!(direction.distance(view) < 1e-15, "{direction}");
    }
    let nowhere = Camera::new(CameraDescription {
        principal_point: Some(DVec2::new(f64::INFINITY, 0.0)),
        ..description()
    });
    assert!(nowhere.is_err(), "{nowhere:?}");
}

#[test]
fn speckle_grows_with_the_depth_of_the_tilted_sensor() {
    let straight = Camera::new(description()).unwrap();
    let pixel = DVec2::new(320.0, 40.0);
    assert_eq!(
        straight.imaging_geometry_at(pixel, 650e-9).unwrap(),
        straight.imaging_geometry(650e-9).unwrap(),
        "alike all over an untilted sensor"
    );
    let tilt = SensorTilt {
        angle: -0.3,
        azimuth: 0.0,
    };
    let camera = Camera::new(CameraDescription {
        tilt,
        ..description()
    })
    .unwrap();
    let geometry = camera.imaging_geometry_at(pixel, 650e-9).unwrap();
    let depth = 25e-3 * 0.3 / 0.275 + 200.0 * 3.45e-6 * 0.3_f64.sin();
    let expected = 650e-9 * depth / 3.125e-3;
    assert_relative(geometry.speckle_size(), expected, 1e-13);
    let in_focus = geometry.surface_to_pupil().recip();
    // Of the vergences of lens and image, 40 and 37 per metre, which differ by it.
    assert!((camera.focus_vergence_at(pixel) - in_focus).abs() < 1e-13);
    // The other way round the top of the image is in focus beyond infinity: −1 · 2.3 mm.
    let horizon = Camera::new(CameraDescription {
        tilt: SensorTilt {
            angle: 1.5,
            azimuth: 0.0,
        },
        focus_distance: 3.0,
        ..description()
    })
    .unwrap();
    let above = horizon.imaging_geometry_at(pixel, 650e-9);
    assert_eq!(above.unwrap_err().parameter, "surface_to_pupil");
    assert!(horizon.focus_vergence_at(pixel) < 0.0, "beyond infinity");
}

#[test]
fn what_moves_with_the_camera_stays_in_the_image() {
    let camera = Camera::new(crooked()).unwrap();
    let motion = RigidMotion::about(DVec3::new(0.2, 0.1, -0.4), DVec3::new(1.0, 2.0, -0.5), 0.9)
        .unwrap()
        .then(&RigidMotion::along(DVec3::new(0.0, 0.3, 1.0)).unwrap());
    let moved = camera.moved(&motion);
    let point = DVec3::new(0.011, 0.024, 0.01);
    let (before, after) = (
        camera.connect(point, [0.3, 0.8]).unwrap(),
        moved.connect(motion.point(point), [0.3, 0.8]).unwrap(),
    );
    // 1e4 pixels of image distance with roundings of coordinates of 1 m at 0.3 m.
    assert!(
        before.pixel.distance(after.pixel) < 1e-10,
        "{before:?}, {after:?}"
    );
    let described = Camera::new(*moved.description()).unwrap();
    assert!(
        described.axes().abs_diff_eq(moved.axes(), 1e-14),
        "{described:?}, {moved:?}"
    );
    assert_eq!(camera.moved(&RigidMotion::IDENTITY), camera, "stands still");
}

proptest! {
    #[test]
    fn projection_inverts_the_ray_of_any_camera(
        k in [-15.0_f64..15.0, -1e3_f64..1e3, -1e4_f64..1e4],
        angle in -0.5_f64..0.5,
        azimuth in -4.0_f64..4.0,
        pixel in [-16.0_f64..656.0, -16.0_f64..496.0],
        depth in 0.01_f64..10.0,
    ) {
        let bent = CameraDescription {
            tilt: SensorTilt { angle, azimuth },
            ..with_distortion(k[0], k[1], k[2])
        };
        let pixel = DVec2::from_array(pixel);
        // 1e4 pixels of image distance, times a few roundings; undoing the distortion magnifies
        // them up to ten times.
        for (description, tolerance) in [(description(), 1e-10), (bent, 1e-9)] {
            let camera = Camera::new(description).unwrap();
            let ray = camera.ray(pixel);
            let image = camera.project(ray.origin + depth * ray.direction).unwrap();
            prop_assert!(image.distance(pixel) < tolerance, "{image} for {pixel}");
        }
    }

    #[test]
    fn no_camera_gives_rays_that_are_not_numbers(
        k in [-1e9_f64..1e9, -1e9_f64..1e9, -1e9_f64..1e9],
        scale in -12.0_f64..0.0,
        angle in -1.6_f64..1.6,
        azimuth in -1e3_f64..1e3,
        pixel in [-1e6_f64..1e6, -1e6_f64..1e6],
    ) {
        let scale = 10.0_f64.powf(scale);
        let camera = Camera::new(CameraDescription {
            tilt: SensorTilt { angle, azimuth },
            ..with_distortion(k[0] * scale, k[1] * scale, k[2] * scale)
        });
        if let Ok(camera) = camera {
            let pixel = DVec2::from_array(pixel);
            let ray = camera.sample_ray(pixel, [0.2, 0.9]).ray;
            prop_assert!((ray.direction.length() - 1.0).abs() < 1e-12, "{ray:?}");
            prop_assert!(camera.solid_angle_per_pixel(pixel) >= 0.0, "{pixel}");
            prop_assert!(camera.irradiance_per_radiance(pixel) >= 0.0, "{pixel}");
        }
    }
}

#[test]
fn sights_turn_as_their_derivatives_say() {
    let camera = Camera::new(crooked()).unwrap();
    let step = 0.05;
    for pixel in [DVec2::new(20.0, 30.0), DVec2::new(600.0, 400.0)] {
        let direction = |pixel| camera.sight(pixel).unwrap().0;
        let (_, derivatives) = camera.sight(pixel).unwrap();
        let ray = camera.ray(pixel).direction;
        assert!(direction(pixel).normalize().distance(ray) < 1e-14, "{ray}");
        for (axis, derivative) in [DVec2::X, DVec2::Y].into_iter().zip(derivatives) {
            let there = direction(pixel + step * axis);
            let difference = (there - direction(pixel - step * axis)) / (2.0 * step);
            // Rounding, 1e-16 / step, against 1.3e-4 per pixel: 2e-11. The third derivative adds
            // less than (1e-4 step)^2 by the strongest term of the distortion, 1e5.
            let error = difference.distance(derivative) / derivative.length();
            assert!(error < 1e-7, "{pixel}: {error:e}");
        }
    }
}
