//! Scenes whose radiance is known in closed form: plates under a light, and face to face.

use tem00::tracer::Frame;

use crate::{
    means::{self, assert_mean, mean},
    renders::{options, scene},
};

fn render(text: &str, seed: u64, samples_per_pixel: u32) -> Frame {
    let scene = scene(text);
    let mut options = options(samples_per_pixel, seed);
    options.max_depth = scene.render.max_depth;
    means::render(&scene, &options)
}

#[test]
fn a_point_light_obeys_the_inverse_square_and_the_cosine() {
    // A plate seen from above in its middle.
    let plate = r#"
        [camera]
        position = [0, 0, 1]
        look_at = [0, 0, 0]
        focal_length = 0.1
        f_number = 8
        pixel_pitch = "1 um"
        resolution = [4, 4]
        [[laser]]
        wavelength = "650 nm"
        power = "1 mW"
        position = [0.5, 0, 1]
        look_at = [0, 0, 0]
        spot = { waist_radius = "1 mm" }
        [[surface]]
        rectangle = { centre = [0, 0, 0], normal = [0, 0, 1], size = [1, 1] }
        lambertian = { reflectance = 0.6 }
        [[light]]
        point = { position = [0.3, 0, 0.4], power = 5 }
        "#;
    let frame = render(plate, 0, 4);
    // Intensity P/4π at 0.5 m under cos θ = 0.8, reflected with ρ/π.
    let pi = std::f64::consts::PI;
    let expected = 0.6 / pi * 5.0 / (4.0 * pi) / 0.25 * 0.8;
    let measured = mean(frame.lights.values());
    // The plate's points lie within 0.04 mm of the middle: relative change below 1e-4.
    assert!(
        (measured / expected - 1.0).abs() < 2e-4,
        "{measured} | {expected}"
    );
}

/// Two plates that face each other, `GAP` apart, under a laser that stands just before the upper
/// one and lights the lower one.
mod facing_plates {
    use tem00::beam::GaussianBeam;

    use super::*;

    const GAP: f64 = 0.05;
    /// Half the side of the upper plate; the lower one is larger than all light.
    const HALF: f64 = 0.1;
    const LOWER: f64 = 0.7;
    const UPPER: f64 = 0.5;
    const POWER: f64 = 2.0;
    const WAIST: f64 = 0.5e-6;
    const CELLS: usize = 160;

    /// The middles of the cells of an interval about 0.
    fn cells(half: f64) -> impl Iterator<Item = f64> + Clone {
        (0..CELLS).map(move |i| half * ((2 * i + 1) as f64 / CELLS as f64 - 1.0))
    }

    /// Returns the irradiance at `x` off the axis of one plate by the radiance, round the axis, of
    /// a square of the other.
    fn irradiance(x: f64, half: f64, radiance: impl Fn(f64) -> f64) -> f64 {
        let cell = (2.0 * half / CELLS as f64).powi(2);
        let rows = cells(half).flat_map(|u| cells(half).map(move |v| (u, v)));
        let share = |(u, v): (f64, f64)| {
            let squared = (u - x).powi(2) + v * v + GAP * GAP;
            radiance(u.hypot(v)) * GAP * GAP / (squared * squared)
        };
        rows.map(share).sum::<f64>() * cell
    }

    /// Returns the radiance of the upper plate at `x` off the axis, of light from the lower one.
    fn upper_radiance(x: f64) -> f64 {
        let beam = GaussianBeam::from_waist(650e-9, WAIST).expect("a valid beam");
        let pi = std::f64::consts::PI;
        let lower = |r: f64| LOWER / pi * POWER * beam.irradiance_per_watt(r, GAP);
        // Beyond four radii lie 1e-14 of the power.
        UPPER / pi * irradiance(x, 4.0 * beam.radius_at(GAP), lower)
    }

    /// Returns the radiance of the lower plate at `x` off the axis, of light that has met all of
    /// lower, upper and lower plate.
    fn lower_radiance(x: f64) -> f64 {
        const KNOTS: usize = 64;
        let step = HALF * 2.0_f64.sqrt() / (KNOTS - 1) as f64;
        let table: Vec<f64> = (0..=KNOTS)
            .map(|i| upper_radiance(i as f64 * step))
            .collect();
        let upper = |r: f64| {
            let (knot, part) = ((r / step).floor(), (r / step).fract());
            #[expect(
                clippy::cast_possible_truncation,
                clippy::cast_sign_loss,
                reason = "a distance within the table"
            )]
            let knot = knot as usize;
            table[knot] + part * (table[knot + 1] - table[knot])
        };
        LOWER / std::f64::consts::PI * irradiance(x, HALF, upper)
    }

    /// Returns the light that has met more than one surface, where a camera between the plates
    /// looks.
    fn seen(camera_height: f64, height: f64, max_depth: u32, seed: u64) -> f64 {
        let scene = format!(
            r#"
            [render]
            max_depth = {max_depth}
            [camera]
            position = [0.09, 0, {camera_height}]
            look_at = [0.01, 0, {height}]
            up = [0, 1, 0]
            focal_length = 0.05
            pixel_pitch = "20 um"
            resolution = [8, 8]
            depth_of_field = false
            [[laser]]
            wavelength = "650 nm"
            power = {POWER}
            position = [0, 0, {GAP}]
            look_at = [0, 0, 0]
            spot = {{ waist_radius = {WAIST}, waist_distance = 0 }}
            [[surface]]
            rectangle = {{ normal = [0, 0, 1], size = [2, 2] }}
            lambertian = {{ reflectance = {LOWER} }}
            [[surface]]
            rectangle = {{ centre = [0, 0, {above}], normal = [0, 0, -1], size = [{side}, {side}] }}
            lambertian = {{ reflectance = {UPPER} }}
            "#,
            side = 2.0 * HALF,
            // The laser's aperture must not lie behind the plate.
            above = GAP * (1.0 + 1e-9),
        );
        mean(render(&scene, seed, 256).lasers[0].multiple.values())
    }

    #[test]
    fn plates_that_face_each_other_pass_light_to_and_fro() {
        for (name, camera, at, depth, expected) in [
            ("upper", 0.01, GAP, 2, upper_radiance(0.01)),
            ("lower", 0.04, 0.0, 3, lower_radiance(0.01)),
        ] {
            let radiances: Vec<f64> = (0..20).map(|seed| seen(camera, at, depth, seed)).collect();
            // Their spread is small enough to tell one reflection from two: 9 % more light.
            assert_mean(name, &radiances, expected, 1.2e-2 * expected);
        }
    }
}
