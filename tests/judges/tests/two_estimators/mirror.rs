//! A mirror between laser and surface: the image of a laser behind the mirror.

use tem00::{
    beam::DVec3,
    geometry::{Rectangle, Shape},
    tracer::{LaserEvents, LaserLayers, Material, Method, Scene},
};

use crate::{means::assert_mean, renders};

use super::comparison::{Series, assert_agree, paint, sharp_scene};

const REFLECTANCE: f64 = 0.8;
const POWER: f64 = 2e-3;

/// The place of a laser and where it points.
#[derive(Clone, Copy)]
struct Placement {
    position: DVec3,
    axis: DVec3,
    line_direction: DVec3,
}

/// Directions and places of a beam that a mirror sends to the origin.
struct Fold {
    mirror: DVec3,
    normal: DVec3,
    laser: Placement,
    /// The laser as seen in the mirror.
    image: Placement,
}

fn fold() -> Fold {
    let to_origin = -DVec3::new(1.0, 0.0, 1.0).normalize();
    let incoming = DVec3::new(0.2, -0.9, 0.3).normalize();
    let line_direction = DVec3::new(0.3, 0.4, 1.0);
    let mirror = -0.12 * to_origin;
    let normal = (to_origin - incoming).normalize();
    let reflected = |v: DVec3| v - 2.0 * v.dot(normal) * normal;
    Fold {
        mirror,
        normal,
        laser: Placement {
            position: mirror - 0.1 * incoming,
            axis: incoming,
            line_direction,
        },
        image: Placement {
            position: mirror - 0.1 * to_origin,
            axis: to_origin,
            line_direction: reflected(line_direction),
        },
    }
}

fn scene(power: f64, laser: Placement, mirror: Option<(&Fold, DVec3)>) -> Scene {
    let [position, axis, line] = [laser.position, laser.axis, laser.line_direction];
    let mirror = mirror.map_or(String::new(), |(fold, centre)| {
        let normal = fold.normal;
        format!(
            r#"
            [[surface]]
            name = "mirror"
            rectangle = {{ centre = {centre:?}, normal = {normal:?}, up = [0, 0, 1], size = [0.03, 0.03] }}
            "#,
            centre = centre.to_array(),
            normal = normal.to_array()
        )
    });
    let mut scene = sharp_scene(&format!(
        r#"
        [camera]
        position = [-0.05, 0.1, 0.3]
        look_at = [0, 0, 0]
        focal_length = "25 mm"
        f_number = 16
        pixel_pitch = "20 um"
        resolution = [24, 16]
        [[laser]]
        wavelength = "650 nm"
        power = {power}
        position = {position:?}
        look_at = {target:?}
        line_direction = {line:?}
        spot = {{ waist_radius = ["0.6 mm", "0.9 mm"], waist_distance = 0.1, m_squared = 3 }}
        [[surface]]
        rectangle = {{ centre = [0, 0, 0], normal = [0, 0, 1], size = [0.1, 0.1] }}
        lambertian = {{ reflectance = 0.5 }}
        {mirror}
        "#,
        position = position.to_array(),
        target = (position + 0.1 * axis).to_array(),
        line = line.to_array()
    ));
    if !mirror.is_empty() {
        let silver = Material::mirror(REFLECTANCE).expect("a valid material");
        paint(&mut scene, "mirror", silver);
    }
    scene
}

const PATHS: Series = Series::of(Method::Path, 100);

#[test]
fn a_mirror_lights_a_surface_as_the_image_of_the_laser_does() {
    let fold = fold();
    let direct = scene(REFLECTANCE * POWER, fold.image, None);
    let folded = scene(POWER, fold.laser, Some((&fold, fold.mirror)));
    assert!(folded.has_specular_surfaces(), "a mirror");
    let speckle = renders::speckle(&direct, 0);
    let path = PATHS.render(&direct, Some(&speckle));
    let light = PATHS.render(&folded, Some(&speckle));
    assert_agree(&path, &light, |layers| &layers.single, 0.1);
    // The speckle is kept: both have the pattern at the image point.
    assert_agree(&path, &light, |layers| &layers.radiance, 0.1);
    for frame in light {
        let power = frame.lasers[0].power_on_target;
        // The edges of the image are 2.2 radii and more from the middle of the spot.
        let error = power / (REFLECTANCE * POWER) - 1.0;
        assert!(error.abs() < 1e-4, "{power} W");
    }
}

#[test]
fn light_past_a_mirror_and_light_from_it_add_up_to_all() {
    let fold = fold();
    // Shifted by its own half width along itself: half of the beam passes.
    let across = fold.normal.cross(DVec3::Z).normalize();
    let mut scene = scene(
        POWER,
        fold.image,
        Some((&fold, fold.mirror + 0.015 * across)),
    );
    // What the mirror sends away comes back from a second plate in its way.
    let away = -fold.laser.axis;
    let (along, up) = away.any_orthonormal_pair();
    let plate = Rectangle::new(fold.mirror + 0.05 * away, 0.05 * along, 0.05 * up);
    let mut wall = scene.surfaces[0].clone();
    wall.shape = Shape::Rectangle(plate.expect("a valid rectangle"));
    scene.surfaces.push(wall);
    let sums = |method| -> Vec<f64> {
        let sum = |layers: &LaserLayers| {
            let values = layers.single.values().iter();
            let all = values.chain(layers.multiple.values());
            all.map(|&value| f64::from(value)).sum()
        };
        let frames = Series::of(method, 100).render(&scene, None);
        frames.iter().map(|frame| sum(&frame.lasers[0])).collect()
    };
    let (both, all) = (sums(Method::Path), sums(Method::Light));
    let ratios: Vec<f64> = both.iter().zip(&all).map(|(a, b)| a / b - 1.0).collect();
    assert_mean("sums", &ratios, 0.0, 0.002);
}

#[test]
fn rays_from_the_camera_find_a_wide_beam_in_a_mirror_as_light_paths_do() {
    // Down from a mirror at 45°, 50 mm above a plate; the beam is a source 80 mm wide that spreads
    // by 0.25 rad, which one in fifty rays from the plate meets.
    let mut scene = sharp_scene(
        r#"
        [camera]
        position = [0, 0.25, 0.06]
        look_at = [0, 0, 0]
        focal_length = "25 mm"
        f_number = 16
        pixel_pitch = "100 um"
        resolution = [24, 16]
        [[laser]]
        wavelength = "650 nm"
        power = "2 mW"
        position = [0.05, 0, 0.05]
        look_at = [0, 0, 0.05]
        line_direction = [0, 1, 0]
        spot = { waist_radius = "40 mm", waist_distance = 0, m_squared = 48000 }
        [[surface]]
        rectangle = { centre = [0, 0, 0], normal = [0, 0, 1], size = [0.1, 0.1] }
        lambertian = { reflectance = 0.5 }
        [[surface]]
        name = "mirror"
        rectangle = { centre = [0, 0, 0.05], normal = [1, 0, -1], up = [0, 1, 0], size = [0.1, 0.08] }
        "#,
    );
    scene.render.max_depth = Some(2);
    let silver = Material::mirror(REFLECTANCE).expect("a valid material");
    paint(&mut scene, "mirror", silver);
    let sampled = Series {
        laser_events: LaserEvents::Sampled,
        ..Series::of(Method::Path, 600)
    };
    let path = sampled.render(&scene, None);
    let light = Series::of(Method::Path, 600).render(&scene, None);
    assert_agree(&path, &light, |layers| &layers.single, 0.1);
}
