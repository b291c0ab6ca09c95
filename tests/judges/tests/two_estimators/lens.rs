//! A ball of glass between laser and surface, against the complex q law of Gaussian beams.

use std::f64::consts::PI;

use tem00::{
    DVec2,
    beam::{DVec3, GaussianBeam, LocatedBeam},
    geometry::{Shape, TriangleMesh},
    optics::{AbcdMatrix, ThickLens},
    tracer::{Frame, Material, Method, Scene},
};

use crate::means::assert_mean;

use super::comparison::{Series, paint, sharp_scene};

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
    let layer = &frame.lasers[0].single;
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

/// Tests that the beam on the plate has the power and the radii that the q law predicts.
fn assert_focused(scene: &Scene, height: f64) {
    let lens = AbcdMatrix::thick_lens(&ThickLens {
        index: INDEX,
        front_curvature: 1.0 / RADIUS,
        back_curvature: -1.0 / RADIUS,
        thickness: 2.0 * RADIUS,
    });
    let beam = GaussianBeam::from_waist(WAVELENGTH, WAIST)
        .and_then(|beam| beam.with_m_squared(M_SQUARED))
        .and_then(|beam| LocatedBeam::new(beam, height + 2.0 * RADIUS - LASER))
        .and_then(|beam| lens?.transform(&beam));
    let expected = beam.expect("a valid beam").radius_at(height);
    let frames = Series::of(Method::Path, 5).render(scene, None);
    let measured: Vec<_> = frames
        .iter()
        .map(|frame| power_and_radii(scene, frame))
        .collect();
    // Fresnel's transmittance at normal incidence, twice.
    let transmittance = 4.0 * INDEX / (INDEX + 1.0).powi(2);
    let powers: Vec<f64> = measured.iter().map(|[power, ..]| power / POWER).collect();
    assert_mean("power", &powers, transmittance * transmittance, 0.002);
    // Spherical aberration moves the focus by 0.28 x² f = 2 µm, with f = 45 mm and x = 0.014 the
    // angle of incidence at one beam radius, and so the radius by less than 0.04 %.
    for axis in [1, 2] {
        let radii: Vec<f64> = measured.iter().map(|m| m[axis] / expected).collect();
        assert_mean("radius", &radii, 1.0, 0.002);
    }
}

#[test]
fn a_ball_lens_focuses_by_the_q_law() {
    // Before the focus, in it, and behind it.
    for height in [8e-3, 15e-3, 40e-3] {
        assert_focused(&scene(height), height);
    }
}

#[test]
fn a_ball_of_triangles_with_smooth_normals_is_a_lens_too() {
    let height = 15e-3;
    let mut scene = scene(height);
    scene.surfaces[1].shape = Shape::from(ball_of_triangles(height + RADIUS));
    assert_focused(&scene, height);
}

/// A ball of 320 × 160 faces with its middle at the height `centre`, with the normals of the
/// sphere.
///
/// Facets of 0.6 mm lie up to 3 µm below the sphere, and the normal that is interpolated between
/// their corners is off by less than 1e-6 rad.
fn ball_of_triangles(centre: f64) -> TriangleMesh {
    const ROUND: u32 = 320;
    const HALF: u32 = 160;
    let normal = |i: u32, j: u32| {
        let (sin, cos) = (PI * f64::from(j) / f64::from(HALF)).sin_cos();
        let (y, x) = (2.0 * PI * f64::from(i) / f64::from(ROUND)).sin_cos();
        // The poles are at the sides, out of the beam.
        DVec3::new(cos, sin * x, sin * y)
    };
    let rows = (0..=HALF).flat_map(|j| (0..ROUND).map(move |i| normal(i, j)));
    let normals: Vec<_> = rows.collect();
    let middle = DVec3::new(0.0, 0.0, centre);
    let vertices = normals.iter().map(|&n| middle + RADIUS * n).collect();
    let faces = (0..HALF).flat_map(|j| {
        (0..ROUND).flat_map(move |i| {
            let [a, b] = [i, (i + 1) % ROUND].map(|column| j * ROUND + column);
            [[a, a + ROUND, b], [b, a + ROUND, b + ROUND]]
        })
    });
    TriangleMesh::with_normals(vertices, normals, faces.collect()).expect("a valid mesh")
}
