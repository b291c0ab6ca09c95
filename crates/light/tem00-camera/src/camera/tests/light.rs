use core::f64::consts::PI;

use super::*;

/// The solid angle per pixel of the rays through one point of the lens, by central differences.
fn solid_angle(camera: &Camera, pixel: DVec2, lens: [f64; 2]) -> f64 {
    let h = 0.1;
    let direction = |offset: DVec2| camera.sample_ray(pixel + offset, lens).ray.direction;
    let by_x = direction(DVec2::new(h, 0.0)) - direction(DVec2::new(-h, 0.0));
    let by_y = direction(DVec2::new(0.0, h)) - direction(DVec2::new(0.0, -h));
    by_x.cross(by_y).length() / (4.0 * h * h)
}

/// The relative error of the differences: (h pitch / d)² / 6 = 3e−11 in each of two directions,
/// times the third by the first derivative of the tangents: 6 k₁ = 60, and as much of the tilt and
/// of the higher coefficients.
const DIFFERENCES: f64 = 1e-8;

proptest! {
    #[test]
    fn pixels_see_the_solid_angle_of_their_rays(
        pixel in [1.0_f64..639.0, 1.0_f64..479.0],
    ) {
        let camera = Camera::new(crooked()).unwrap();
        let pixel = DVec2::from_array(pixel);
        let expected = solid_angle(&camera, pixel, [0.5, 0.5]);
        let relative = camera.solid_angle_per_pixel(pixel) / expected - 1.0;
        prop_assert!(relative.abs() < DIFFERENCES, "{relative:e}");
    }

    #[test]
    fn a_point_seen_through_the_lens_connects_to_its_pixel(
        pixel in [1.0_f64..639.0, 1.0_f64..479.0],
        lens in [0.0_f64..1.0, 0.0_f64..1.0],
        distance in 0.05_f64..3.0,
    ) {
        let camera = Camera::new(crooked()).unwrap();
        let pixel = DVec2::from_array(pixel);
        let CameraRay { ray, solid_angle: seen_angle, .. } = camera.sample_ray(pixel, lens);
        let point = ray.origin + distance * ray.direction;
        let seen = camera.connect(point, lens).unwrap();
        // 1e4 pixels of image distance; the blur at 5 cm magnifies roundings by another hundred.
        prop_assert!(seen.pixel.distance(pixel) < 1e-9, "{} for {pixel}", seen.pixel);
        prop_assert!(seen.lens_point.distance(ray.origin) < 1e-16, "{}", seen.lens_point);
        let product = seen.importance * distance * distance * solid_angle(&camera, pixel, lens);
        prop_assert!((product - 1.0).abs() < DIFFERENCES, "{product}");
        // The same closed form; the search for the pixel leaves 1e−12 of a tangent.
        let product = seen.importance * distance * distance * seen_angle;
        prop_assert!((product - 1.0).abs() < 1e-11, "{product}");
    }
}

/// A Gaussian radiance on an inclined plane out of focus, totalled over all pixels: from the
/// camera, and from the points of the plane towards the lens.
#[test]
fn light_followed_both_ways_gives_the_same_image() {
    const WIDTH: f64 = 1e-3;
    let camera = Camera::new(crooked()).unwrap();
    let centre = camera.position() - 0.35 * camera.axes().z_axis;
    let normal = (camera.axes().z_axis + 0.5 * camera.axes().x_axis).normalize();
    let tangents = [
        normal.any_orthonormal_pair().0,
        normal.any_orthonormal_pair().1,
    ];
    let radiance = |point: DVec3| (-point.distance_squared(centre) / (2.0 * WIDTH * WIDTH)).exp();
    // The trapezoidal rule errs on a Gaussian by exp(−2π² (width / step)²): both sums have steps of
    // a fifth of the width, or less. Cut off at seven widths, both lose up to 1e−10.
    let (mut from_camera, mut from_light) = (0.0, 0.0);
    for lens in [[0.1, 0.2], [0.8, 0.4], [0.45, 0.95]] {
        for index in 0..160 * 120_u32 {
            let pixel = 4.0 * DVec2::new(f64::from(index % 160), f64::from(index / 160)) + 2.0;
            let ray = camera.sample_ray(pixel, lens).ray;
            let distance = (centre - ray.origin).dot(normal) / ray.direction.dot(normal);
            from_camera += 16.0 * radiance(ray.origin + distance * ray.direction);
        }
        let step = WIDTH / 5.0;
        for index in 0..71 * 71_i32 {
            let (i, j) = (f64::from(index % 71 - 35), f64::from(index / 71 - 35));
            let point = centre + step * (i * tangents[0] + j * tangents[1]);
            if let Some(seen) = camera.connect(point, lens) {
                let towards = (seen.lens_point - point).normalize();
                let intensity = radiance(point) * normal.dot(towards) * step * step;
                from_light += intensity * seen.importance;
            }
        }
    }
    assert_relative(from_light, from_camera, 1e-9);
}

#[test]
fn what_is_not_in_the_image_is_not_connected() {
    let camera = Camera::new(description()).unwrap();
    for pixel in [DVec2::new(-0.5, 100.0), DVec2::new(320.0, 480.5)] {
        let ray = camera.ray(pixel);
        let beside = camera.connect(ray.origin + 0.3 * ray.direction, [0.5, 0.5]);
        assert!(beside.is_none(), "{beside:?}");
    }
    for depth in [-0.3, 0.0] {
        let point = camera.position() - depth * camera.axes().z_axis;
        let behind = camera.connect(point, [0.2, 0.7]);
        assert!(behind.is_none(), "{behind:?}");
    }
    let camera = Camera::new(CameraDescription {
        position: DVec3::ZERO,
        look_at: -DVec3::Z,
        ..description()
    });
    // So near to the lens that the importance overflows.
    let on_lens = camera.unwrap().connect(-1e-200 * DVec3::Z, [0.5, 0.5]);
    assert!(on_lens.is_none(), "{on_lens:?}");
}

#[test]
fn illumination_falls_off_by_the_cosine_to_the_fourth() {
    let camera = Camera::new(description()).unwrap();
    let (diameter, distance) = (3.125e-3, 25e-3 * 0.3 / 0.275);
    for pixel in [DVec2::new(320.0, 240.0), DVec2::new(0.0, 0.0)] {
        let angle = ((pixel - DVec2::new(320.0, 240.0)).length() * 3.45e-6 / distance).atan();
        let expected = PI / 4.0 * (diameter / distance).powi(2) * angle.cos().powi(4);
        let got = camera.irradiance_per_radiance(pixel);
        assert_relative(got, expected, 1e-13);
    }
}

#[test]
fn a_tilted_sensor_is_lit_by_the_pupil_at_its_own_angle() {
    let tilt = SensorTilt {
        angle: -0.4,
        azimuth: 0.0,
    };
    let camera = Camera::new(CameraDescription {
        tilt,
        ..description()
    })
    .unwrap();
    let (y, distance) = (100.0 * 3.45e-6, 25e-3 * 0.3 / 0.275);
    // The tilted image, upright: up = (0, cos τ, −sin τ) in right, up, view.
    let position = DVec3::new(0.0, y * tilt.angle.cos(), distance - y * tilt.angle.sin());
    let normal = DVec3::new(0.0, tilt.angle.sin(), tilt.angle.cos());
    let direction = position.normalize();
    let area = PI * 3.125e-3 * 3.125e-3 / 4.0;
    let expected = area * direction.z * direction.dot(normal) / position.length_squared();
    let got = camera.irradiance_per_radiance(DVec2::new(320.0, 140.0));
    assert_relative(got, expected, 1e-13);
}

#[test]
fn many_rays_are_those_of_single_calls() {
    let pinhole = CameraDescription {
        depth_of_field: false,
        ..description()
    };
    let tilted = CameraDescription {
        distortion: RadialDistortion::default(),
        ..crooked()
    };
    // The middle of the pupil, its diagonals and its axes among them.
    let number = |index: usize| (index % 13) as f64 / 12.5;
    let lens: Vec<_> = (0..200)
        .map(|index| [number(index), number(index / 13)])
        .chain([[0.5, 0.5], [0.5, 0.2], [0.2, 0.5], [0.3, 0.3]])
        .collect();
    let pixels: Vec<_> = (0..lens.len())
        .map(|index| DVec2::new(3.1 * index as f64, 477.3 - 2.3 * index as f64))
        .collect();
    for description in [description(), crooked(), pinhole, tilted] {
        let camera = Camera::new(description).unwrap();
        for count in [0, 1, 63, 64, 65, lens.len()] {
            let mut rays = vec![camera.ray(DVec2::ZERO); count];
            let mut solid_angles = vec![0.0; count];
            camera.sample_rays(
                &pixels[..count],
                &lens[..count],
                &mut rays,
                &mut solid_angles,
            );
            for index in 0..count {
                let alone = camera.sample_ray(pixels[index], lens[index]);
                assert_eq!(rays[index], alone.ray, "{index} of {count}");
                let angles = [solid_angles[index], alone.solid_angle].map(f64::to_bits);
                assert_eq!(angles[0], angles[1], "{index} of {count}");
            }
        }
    }
}
