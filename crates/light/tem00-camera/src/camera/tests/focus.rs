use core::f64::consts::PI;

use glam::DQuat;

use super::*;
use crate::Ray;

/// The normal of the sensor, along the view, and the unit vector in the lens across the line about
/// which the sensor turns: by a rotation of the axes as such.
fn tilted_normal(camera: &Camera) -> (DVec3, DVec3) {
    let SensorTilt { angle, azimuth } = camera.description().tilt;
    let axes = camera.axes();
    let line = azimuth.cos() * axes.x_axis + azimuth.sin() * axes.y_axis;
    let normal = DQuat::from_axis_angle(line, angle) * -axes.z_axis;
    (normal, line.cross(axes.z_axis))
}

/// Intersection of a ray with the plane in focus.
fn in_focus(camera: &Camera, ray: &Ray) -> DVec3 {
    let (point, normal) = camera.plane_in_focus();
    let distance = (point - ray.origin).dot(normal) / ray.direction.dot(normal);
    ray.origin + distance * ray.direction
}

proptest! {
    #[test]
    fn all_of_the_lens_sees_the_same_point_of_the_plane_in_focus(
        angle in -0.15_f64..0.15,
        azimuth in -4.0_f64..4.0,
        pixel in [0.0_f64..640.0, 0.0_f64..480.0],
        lens in [0.0_f64..1.0, 0.0_f64..1.0],
    ) {
        let camera = Camera::new(CameraDescription {
            tilt: SensorTilt { angle, azimuth },
            f_number: 1.0,
            ..description()
        }).unwrap();
        let pixel = DVec2::from_array(pixel);
        let chief = in_focus(&camera, &camera.ray(pixel));
        let other = in_focus(&camera, &camera.sample_ray(pixel, lens).ray);
        // 0.5 m with a hundred roundings, as the plane is seen at grazing angles down to 30°.
        prop_assert!(chief.distance(other) < 5e-15 * 10.0, "{chief} and {other}");
        // What is in focus there is also imaged there, through all of the lens.
        let back = camera.connect(other, lens).unwrap();
        prop_assert!(back.pixel.distance(pixel) < 1e-8, "{} for {pixel}", back.pixel);
    }

    #[test]
    fn with_distortion_rays_meet_at_the_depth_of_the_lens_equation(
        pixel in [0.0_f64..640.0, 0.0_f64..480.0],
        lens in [0.0_f64..1.0, 0.0_f64..1.0],
    ) {
        let camera = Camera::new(crooked()).unwrap();
        let pixel = DVec2::from_array(pixel);
        let (normal, _) = tilted_normal(&camera);
        let axes = camera.axes();
        // The position on the turned sensor, relative to where the axis meets it.
        let offset = (pixel - DVec2::new(300.0, 260.0)) * 3.45e-6;
        let turn = DQuat::from_rotation_arc(-axes.z_axis, normal);
        let position = turn * (offset.x * axes.x_axis - offset.y * axes.y_axis);
        let depth = camera.image_distance() - position.dot(axes.z_axis);
        let in_focus = 1.0 / (1.0 / 25e-3 - 1.0 / depth);
        let at_depth = |ray: Ray| {
            let distance = in_focus / -ray.direction.dot(axes.z_axis);
            ray.origin + distance * ray.direction
        };
        let chief = at_depth(camera.ray(pixel));
        let other = at_depth(camera.sample_ray(pixel, lens).ray);
        // The lens equation amplifies roundings of the depth by L / f = 12 at each of two steps.
        prop_assert!(chief.distance(other) < 1e-13, "{chief} and {other}");
    }
}

#[test]
fn lens_sensor_and_focus_meet_in_one_line() {
    for (angle, azimuth) in [(0.1, 0.0), (-0.3, 1.1), (0.02, -2.5)] {
        let camera = Camera::new(CameraDescription {
            tilt: SensorTilt { angle, azimuth },
            ..description()
        })
        .unwrap();
        let (point, focus) = camera.plane_in_focus();
        let (normal, across) = tilted_normal(&camera);
        let view = -camera.axes().z_axis;
        let off_plane = |p: DVec3| (p - point).dot(focus);
        // Scheimpflug: where the sensor, behind the lens, cuts the plane of the lens.
        let along_lens = -camera.image_distance() * normal.dot(view) / normal.dot(across);
        let on_line = camera.position() + along_lens * across;
        // Merklinger's hinge: where the parallel to the sensor through the lens cuts the front
        // focal plane.
        let along_hinge = -25e-3 * normal.dot(view) / normal.dot(across);
        let on_hinge = camera.position() + 25e-3 * view + along_hinge * across;
        // Lengths up to 1.4 m.
        assert!(off_plane(on_line).abs() < 1e-14, "{}", off_plane(on_line));
        assert!(off_plane(on_hinge).abs() < 1e-14, "{}", off_plane(on_hinge));
        let line = normal.cross(view).normalize();
        assert!(focus.dot(line).abs() < 1e-14, "{}", focus.dot(line));
        assert!(focus.dot(view) < 0.0, "towards the camera: {focus}");
    }
}

#[test]
fn a_sensor_tilted_forwards_focuses_on_a_floor() {
    let tilted = Camera::new(CameraDescription {
        tilt: SensorTilt {
            angle: 0.05,
            azimuth: 0.0,
        },
        ..description()
    })
    .unwrap();
    let depth = |y: f64| {
        let ray = tilted.ray(DVec2::new(320.0, y));
        (in_focus(&tilted, &ray) - tilted.position()).dot(-tilted.axes().z_axis)
    };
    assert!(depth(0.0) > 0.3 && depth(480.0) < 0.3, "{}", depth(0.0));
    let (_, normal) = tilted.plane_in_focus();
    let tangent = normal.dot(tilted.axes().y_axis) / normal.dot(tilted.axes().z_axis);
    // tan τ′ = (L / d_PI) tan τ, L / d_PI = 11.
    assert_relative(tangent, 11.0 * 0.05_f64.tan(), 1e-12);
}

#[test]
fn a_point_out_of_focus_becomes_a_disc_of_the_blur_diameter() {
    let camera = Camera::new(description()).unwrap();
    let point = camera.position() - 0.4 * camera.axes().z_axis;
    let at = |lens| camera.connect(point, lens).unwrap().pixel;
    let middle = at([0.5, 0.5]);
    // D d_PI |1/L − 1/Z| / pitch, the geometrical blur: D = 3.125 mm.
    let d = 25e-3 * 0.3 / 0.275;
    let radius = 0.5 * 3.125e-3 * d * (1.0 / 0.3 - 1.0 / 0.4) / 3.45e-6;
    // Beyond the focus the right of the lens sees the point to the right of the middle.
    let right = at([1.0, 0.5]) - middle;
    let up = at([0.5, 1.0]) - middle;
    assert!(right.distance(DVec2::new(radius, 0.0)) < 1e-9, "{right}");
    assert!(up.distance(DVec2::new(0.0, -radius)) < 1e-9, "{up}");
}

#[test]
fn points_are_uniform_over_the_pupil() {
    let camera = Camera::new(description()).unwrap();
    let radius = 0.5 * 25e-3 / 8.0;
    for [u, v] in [
        [0.1, 0.3],
        [0.9, 0.45],
        [0.52, 0.51],
        [0.3, 0.98],
        [0.7, 0.05],
    ] {
        let on_lens = |u: f64, v: f64| {
            let ray = camera.sample_ray(DVec2::new(100.0, 50.0), [u, v]).ray;
            ray.origin - camera.position()
        };
        let h = 1e-5;
        let by_u = (on_lens(u + h, v) - on_lens(u - h, v)) / (2.0 * h);
        let by_v = (on_lens(u, v + h) - on_lens(u, v - h)) / (2.0 * h);
        // The area of the pupil for the unit square. Differences err by h² and ε/h.
        let area = by_u.cross(by_v).length();
        assert_relative(area, PI * radius * radius, 1e-8);
        let on_axis = on_lens(u, v).dot(camera.axes().z_axis);
        assert!(
            on_axis.abs() < 1e-16,
            "off the plane of the lens: {on_axis}"
        );
        assert!(on_lens(u, v).length() < radius, "outside of the pupil");
    }
    let ray = camera.sample_ray(DVec2::ZERO, [0.5, 0.5]).ray;
    assert_eq!(ray, camera.ray(DVec2::ZERO), "the middle of the lens");
}

#[test]
fn without_depth_of_field_every_ray_goes_through_the_centre() {
    let camera = Camera::new(CameraDescription {
        depth_of_field: false,
        ..crooked()
    })
    .unwrap();
    for lens in [[0.0, 0.0], [0.99, 0.2]] {
        let pixel = DVec2::new(17.0, 333.0);
        assert_eq!(camera.sample_ray(pixel, lens).ray, camera.ray(pixel));
        let point = camera.position() - 0.2 * camera.axes().z_axis;
        let seen = camera.connect(point, lens).unwrap();
        assert_eq!(seen.lens_point, camera.position(), "the centre");
        assert_eq!(Some(seen.pixel), camera.project(point), "one image point");
    }
}
