use tem00_statistics::chi_squared;
use tem00_testkit::{Numbers, assert_relative};

use super::*;

const WIDTH: usize = 80;
const HEIGHT: usize = 6;

/// A map with dark pixels, whole dark rows at its upper edge and inside, and a dark block.
fn uneven() -> Environment {
    let map = Grid::from_fn(WIDTH, HEIGHT, |x, y| match (x, y) {
        (_, 0 | 3) | (32..64, 4) => 0.0,
        _ => f32::from(u8::try_from((7 * x * x + 3 * x * y + 11 * y) % 13).unwrap()),
    });
    Environment::from_radiance(map, DVec3::new(0.1, 0.2, 1.0), DVec3::new(1.0, -0.5, 0.3)).unwrap()
}

/// The axes of [`uneven`]: up, and the middle of the map.
fn axes() -> [DVec3; 2] {
    let up = DVec3::new(0.1, 0.2, 1.0).normalize();
    let middle = DVec3::new(1.0, -0.5, 0.3).reject_from_normalized(up);
    [up, middle.normalize()]
}

/// The direction at these angles from the axes of [`uneven`].
fn direction(from_up: f64, around: f64) -> DVec3 {
    let [up, middle] = axes();
    let flat = around.cos() * middle + around.sin() * middle.cross(up);
    from_up.cos() * up + from_up.sin() * flat
}

/// Row and column of a direction in [`uneven`], by angles from its axes.
fn place(direction: DVec3) -> (usize, usize) {
    let [up, middle] = axes();
    let from_up = direction.angle_between(up);
    let flat = direction.reject_from_normalized(up);
    let turn = flat.angle_between(middle);
    let around = if flat.dot(middle.cross(up)) < 0.0 {
        PI - turn
    } else {
        PI + turn
    };
    let cell = |angle: f64, all: f64, count: usize| {
        (0..count)
            .rev()
            .find(|i| angle >= all * *i as f64 / count as f64)
            .unwrap()
    };
    (cell(from_up, PI, HEIGHT), cell(around, 2.0 * PI, WIDTH))
}

#[test]
fn directions_are_drawn_in_proportion_to_the_light() {
    const DRAWS: u32 = 60_000;
    let sky = uneven();
    let mut sampler = Numbers::new(1);
    let mut counts = vec![0_u64; WIDTH * HEIGHT];
    for _ in 0..DRAWS {
        let direction = sky.sample(sampler.units()).unwrap().direction;
        let (y, x) = place(direction);
        counts[y * WIDTH + x] += 1;
    }
    // The density is constant in a pixel: times its solid angle it is the probability.
    let expected = (0..WIDTH * HEIGHT).map(|index| {
        let (x, y) = ((index % WIDTH) as f64, (index / WIDTH) as f64);
        let edge = |y: f64| (PI * y / HEIGHT as f64).cos();
        let solid_angle = (edge(y) - edge(y + 1.0)) * 2.0 * PI / WIDTH as f64;
        let from_up = PI * (y + 0.5) / HEIGHT as f64;
        let around = 2.0 * PI * ((x + 0.5) / WIDTH as f64 - 0.5);
        f64::from(DRAWS) * solid_angle * sky.pdf(direction(from_up, around))
    });
    let cells: Vec<_> = counts.into_iter().zip(expected).collect();
    let nothing = cells.iter().filter(|(_, expected)| *expected <= 0.0);
    assert!(
        nothing.map(|(count, _)| count).all(|&count| count == 0),
        "drawn where it is dark"
    );
    let (counts, expected): (Vec<u64>, Vec<f64>) =
        cells.into_iter().filter(|(_, e)| *e > 0.0).unzip();
    let total: f64 = expected.iter().sum();
    assert_relative(total, f64::from(DRAWS), 1e-12);
    let outcome = chi_squared(&counts, &expected, 0).unwrap();
    assert!(outcome.p_value > 1e-4, "{outcome:?}");
}

#[test]
fn the_light_of_a_sample_is_the_integral_over_the_sphere() {
    let sky = uneven();
    // Ten by ten midpoints in each pixel, in angles from fixed axes of the map.
    let (columns, rows) = (10 * WIDTH, 10 * HEIGHT);
    let mut integral = 0.0;
    for index in 0..columns * rows {
        let around = 2.0 * PI * ((index % columns) as f64 + 0.5) / columns as f64;
        let from_up = PI * ((index / columns) as f64 + 0.5) / rows as f64;
        let solid_angle = from_up.sin() * PI / rows as f64 * 2.0 * PI / columns as f64;
        integral += sky.radiance_along(direction(from_up, around)) * solid_angle;
    }
    for u in [[0.01, 0.02], [0.5, 0.5], [0.9, 0.97]] {
        let sample = sky.sample(u).unwrap();
        // The midpoint rule errs by (π/60)²/24 on sines.
        assert_relative(sample.radiance_over_pdf, integral, 1.5e-4);
        let pdf = sample.pdf.unwrap();
        assert_relative(pdf, sky.pdf(sample.direction), 1e-14);
        let radiance = sky.radiance_along(sample.direction);
        assert_relative(sample.radiance_over_pdf * pdf, radiance, 1e-14);
        assert!(sample.distance.is_infinite(), "beyond the scene");
    }
}

#[test]
fn the_density_is_that_of_the_drawn_directions() {
    for sky in [uneven(), Environment::constant(2.0).unwrap()] {
        for [u, v] in [[0.123, 0.2], [0.517, 0.61], [0.9, 0.93]] {
            let h = 1e-6;
            let at = |u: f64, v: f64| sky.sample([u, v]).unwrap().direction;
            let by_u = (at(u + h, v) - at(u - h, v)) / (2.0 * h);
            let by_v = (at(u, v + h) - at(u, v - h)) / (2.0 * h);
            let density = 1.0 / by_u.cross(by_v).length();
            let pdf = sky.sample([u, v]).unwrap().pdf.unwrap();
            // Differences err by ε/h on lengths of order 1.
            assert_relative(pdf, density, 1e-8);
        }
    }
}

#[test]
fn a_constant_sky_has_the_light_of_the_whole_sphere() {
    let sky = Environment::constant(2.0).unwrap();
    let sample = sky.sample([0.3, 0.4]).unwrap();
    assert_relative(sample.radiance_over_pdf, 8.0 * PI, 1e-15);
    assert_relative(sample.direction.length(), 1.0, 1e-15);
}

#[test]
fn the_map_is_upright_and_seen_from_inside() {
    // Bright in the upper row, in the column right of the middle.
    let map = Grid::from_fn(8, 4, |x, y| if (x, y) == (4, 0) { 1.0 } else { 0.0 });
    let sky = Environment::from_radiance(map, DVec3::Z, DVec3::X).unwrap();
    let bright = sky.sample([0.5, 0.5]).unwrap().direction;
    // An observer who looks along x, with z up, has −y on the right.
    assert!(bright.z > 0.7, "up: {bright}");
    assert!(bright.x > 0.0 && bright.y < 0.0, "right of x: {bright}");
    assert!(-bright.y < bright.x, "within 45° of the middle: {bright}");
}

#[test]
fn every_pair_of_numbers_gives_light() {
    let one_minus = 1.0 - 0.5 * f64::EPSILON;
    for u in [0.0, 0.4, one_minus] {
        for v in [0.0, 0.7, one_minus] {
            for sky in [uneven(), Environment::constant(1.0).unwrap()] {
                let sample = sky.sample([u, v]).unwrap();
                assert_relative(sample.direction.length(), 1.0, 1e-14);
                assert!(sample.pdf.unwrap() > 0.0, "{sample:?}");
            }
        }
    }
    let dark_start = Grid::from_fn(WIDTH, 1, |x, _| if x < 70 { 0.0 } else { 1.0 });
    let sky = Environment::from_radiance(dark_start, DVec3::Z, DVec3::X).unwrap();
    assert!(sky.sample([0.0, 0.5]).is_some(), "the first that shines");
    let black = Environment::from_radiance(Grid::filled(3, 2, 0.0), DVec3::Z, DVec3::X);
    for black in [Environment::constant(0.0).unwrap(), black.unwrap()] {
        assert_eq!(black.sample([0.5, 0.5]), None, "black");
        assert!(black.pdf(DVec3::X) <= 0.0, "black");
        assert!(black.radiance_along(DVec3::ZERO) <= 0.0, "black");
    }
}

#[test]
fn impossible_environments_are_refused() {
    for radiance in [-1.0, f64::NAN, f64::INFINITY] {
        assert!(Environment::constant(radiance).is_err(), "{radiance}");
    }
    for radiance in [-1.0, f32::NAN, f32::INFINITY] {
        let map = Grid::from_fn(3, 2, |x, _| if x == 2 { radiance } else { 1.0 });
        let sky = Environment::from_radiance(map, DVec3::Z, DVec3::X);
        assert!(sky.is_err(), "{radiance}");
    }
    for (up, middle) in [
        (DVec3::ZERO, DVec3::X),
        (DVec3::NAN, DVec3::X),
        (DVec3::Z, DVec3::ZERO),
        (DVec3::Z, -2.0 * DVec3::Z),
        (DVec3::Z, DVec3::NAN),
    ] {
        let sky = Environment::from_radiance(Grid::filled(2, 1, 1.0), up, middle);
        assert!(sky.is_err(), "{up}, {middle}");
    }
}
