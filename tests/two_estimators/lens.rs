//! A ball of glass between laser and surface, against the complex q law of Gaussian beams.

use std::f64::consts::PI;

use tem00::{
    beam::{AbcdMatrix, DVec2, DVec3, GaussianBeam, LocatedBeam, ThickLens},
    tracer::{Frame, Material, Method, Scene},
};

use super::comparison::{Series, assert_mean, paint, sharp_scene};

const WAVELENGTH: f64 = 650e-9;
const POWER: f64 = 2e-3;
const RADIUS: f64 = 30e-3;
const INDEX: f64 = 1.5;
const WAIST: f64 = 0.3e-3;
const M_SQUARED: f64 = 2.0;
const LASER: f64 = 0.3;
const REFLECTANCE: f64 = 0.5;

/// A laser shines down through a ball whose lower vertex is `height` above a plate.
fn scene(height: f64) -> Scene {
    let mut scene = sharp_scene(&format!(
        r#"
        [camera]
        position = [0, 0.12, 0.07]
        look_at = [0, 0, 0]
        focal_length = "25 mm"
        f_number = 16
        pixel_pitch = "5 um"
        resolution = [96, 64]
        [render]
        samples_per_pixel = 1
        [[laser]]
        wavelength = {WAVELENGTH}
        power = {POWER}
        position = [0, 0, {LASER}]
        look_at = [0, 0, 0]
        spot = {{ waist_radius = {WAIST}, waist_distance = 0, m_squared = {M_SQUARED} }}
        [[surface]]
        name = "plate"
        rectangle = {{ centre = [0, 0, 0], normal = [0, 0, 1], size = [0.1, 0.1] }}
        lambertian = {{ reflectance = {REFLECTANCE} }}
        [[surface]]
        name = "ball"
        sphere = {{ centre = [0, 0, {centre}], radius = {RADIUS} }}
        "#,
        centre = height + RADIUS
    ));
    // Into the ball, out of it, and onto the plate: no light that went to and fro in the ball.
    scene.render.max_depth = Some(3);
    let glass = Material::dielectric(INDEX).expect("a valid material");
    paint(&mut scene, "ball", glass);
    scene
}

/// The point of the plate that an image point shows.
fn on_plate(scene: &Scene, image_point: DVec2) -> DVec3 {
    let ray = scene.camera.ray(image_point);
    ray.origin - ray.origin.z / ray.direction.z * ray.direction
}

/// The power on the plate and the beam radii along x and y, from the radiance of its image.
fn power_and_radii(scene: &Scene, frame: &Frame) -> [f64; 3] {
    let layer = &frame.lasers[0].coherent_before;
    let (mut power, mut moments) = (0.0, DVec2::ZERO);
    for (index, &radiance) in layer.values().iter().enumerate() {
        let (x, y) = (index % layer.width(), index / layer.width());
        let centre = DVec2::new(x as f64 + 0.5, y as f64 + 0.5);
        let point = on_plate(scene, centre);
        let to_camera = scene.camera.position() - point;
        let area =
            scene.camera.solid_angle_per_pixel(centre) * to_camera.length().powi(3) / to_camera.z;
        let share = f64::from(radiance) * PI / REFLECTANCE * area;
        power += share;
        // The second moments of the pixel, a square of unit side, are taken off (Sheppard).
        let right = on_plate(scene, centre + DVec2::X) - point;
        let down = on_plate(scene, centre + DVec2::Y) - point;
        let of_pixel = (right * right + down * down).truncate() / 12.0;
        moments += share * (point.truncate() * point.truncate() - of_pixel);
    }
    let variance = moments / power;
    [power, 2.0 * variance.x.sqrt(), 2.0 * variance.y.sqrt()]
}

#[test]
fn a_ball_lens_focuses_by_the_q_law() {
    let lens = AbcdMatrix::thick_lens(&ThickLens {
        index: INDEX,
        front_curvature: 1.0 / RADIUS,
        back_curvature: -1.0 / RADIUS,
        thickness: 2.0 * RADIUS,
    })
    .expect("a valid lens");
    let beam = GaussianBeam::from_waist(WAVELENGTH, WAIST)
        .and_then(|beam| beam.with_m_squared(M_SQUARED))
        .expect("a valid beam");
    // Before the focus, in it, and behind it.
    for height in [8e-3, 15e-3, 40e-3] {
        let scene = scene(height);
        let to_lens = LASER - height - 2.0 * RADIUS;
        let behind = LocatedBeam::new(beam, -to_lens)
            .and_then(|beam| lens.transform(&beam))
            .expect("a valid beam");
        let series = Series {
            method: Method::Path,
            samples_per_pixel: 5,
            seeds: 12,
        };
        let expected = behind.radius_at(height);
        let measured: Vec<_> = series
            .render(&scene, None)
            .iter()
            .map(|frame| power_and_radii(&scene, frame))
            .collect();
        // Fresnel's transmittance at normal incidence, twice.
        let transmittance = 4.0 * INDEX / (INDEX + 1.0).powi(2);
        let powers: Vec<f64> = measured.iter().map(|[power, ..]| power / POWER).collect();
        assert_mean(&powers, transmittance * transmittance, 0.003);
        // Spherical aberration moves the focus by 0.28 x² f = 2 µm, with f = 45 mm and x = 0.014 the
        // angle of incidence at one beam radius, and so the radius by less than 0.04 %.
        for axis in [1, 2] {
            let radii: Vec<f64> = measured.iter().map(|m| m[axis] / expected).collect();
            assert_mean(&radii, 1.0, 0.003);
        }
    }
}
