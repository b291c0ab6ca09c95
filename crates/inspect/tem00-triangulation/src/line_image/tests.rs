use tem00_numerics::cast::to_f32;
use tem00_statistics::{
    laws::{PixelAutocovariance, PixelColumn},
    rectangular_pixel_contrast,
};
use tem00_testkit::{assert_absolute, assert_relative, on_threads, refuses};

use super::*;
use crate::SetupDescription;

/// A line of 12 pixels on speckle of 1.6 pixels.
const DATA: LineImageData = LineImageData {
    size: [96, 48],
    width: 12.0,
    blur: 0.0,
    column_electrons: 1e4,
    speckle_size: [1.6; 2],
    sensitive_side: 1.0,
    patterns: 1,
    polarisation: 1.0,
};

#[test]
fn the_mean_of_many_images_is_the_line_that_the_lens_blurs() {
    const IMAGES: u64 = 200;
    for (width, sensitive_side) in [(12.0, 1.0), (1.0, 0.7)] {
        let data = LineImageData {
            width,
            sensitive_side,
            ..DATA
        };
        let lines = LineImage::new(data).unwrap();
        let centre = |x: f64| 24.0 + 0.01 * x;
        let mean = lines.mean(centre);
        let mut sum = vec![0.0; 96 * 48];
        let mut squares = 0.0;
        for seed in 0..IMAGES {
            let image = lines.speckled(seed, centre).unwrap();
            let total: f64 = image.values().iter().map(|&value| f64::from(value)).sum();
            squares += total * total / IMAGES as f64;
            let pairs = sum.iter_mut().zip(image.values());
            pairs.for_each(|(sum, &value)| *sum += f64::from(value) / IMAGES as f64);
        }
        // Over a block of 12 columns, at five positions across the line.
        for y in [17, 21, 24, 26, 30] {
            for block in 0..8 {
                let row = 96 * y + 12 * block..96 * y + 12 * (block + 1);
                let [found, expected] = [
                    sum[row.clone()].iter().sum::<f64>(),
                    mean.values()[row]
                        .iter()
                        .map(|&v| f64::from(v))
                        .sum::<f64>(),
                ];
                // 200 images of 12 columns, 7.5 speckles, have 1500 independent positions: 2.6 %
                // each, four of them. Light in the darkness next to the image comes in at the other
                // side.
                assert_absolute(found, expected, f64::max(1.0, 0.104 * expected));
            }
        }
        let [found, expected] = [
            sum.iter().sum::<f64>(),
            mean.values().iter().map(|&v| f64::from(v)).sum(),
        ];
        // All light of a column except for the light that falls into the darkness: of the wings,
        // 4h/(π³ Y) = 0.9 %, that lie outside of the image, some come in from the lines after which
        // it repeats. The power of columns fluctuates.
        let all = 96.0 * 1e4;
        let chance = 4.0 * ((squares - found * found) / IMAGES as f64).sqrt();
        assert!(
            (expected - chance..all + chance).contains(&found),
            "{width}: {found}, from {expected} to {all}"
        );
    }
}

#[test]
fn speckle_leaves_the_mean_and_has_the_contrast_of_its_pixels() {
    // A line so wide that it is even.
    let data = LineImageData {
        size: [200, 200],
        width: 1e5,
        column_electrons: 1e5,
        ..DATA
    };
    let lines = LineImage::new(data).unwrap();
    let mean = f64::from(lines.mean(|_| 100.0)[(0, 0)]);
    let expected = rectangular_pixel_contrast([1.0 / 1.6; 2]);
    let (mut sum, mut squares) = (0.0, 0.0);
    for seed in 0..4 {
        let image = lines.speckled(seed, |_| 100.0).unwrap();
        for &value in image.values() {
            let ratio = f64::from(value) / mean;
            sum += ratio;
            squares += ratio * ratio;
        }
    }
    let n = 4.0 * 40_000.0;
    // A pattern has the mean 1 over its period, which the image fills except for 15 % of its area:
    // the rest has the mean 1 ± √(0.15/125²).
    assert!((sum / n - 1.0).abs() < 6e-3, "mean {}", sum / n);
    let contrast = (squares / n - (sum / n).powi(2)).sqrt();
    // The spread of C² of one pattern of 125 speckles is 1.53/125; of the contrast, half of that,
    // and again half for four patterns: 0.3 %. Six samples a speckle add 0.5 %.
    assert_relative(contrast, expected, 0.015);
}

#[test]
fn pixels_of_a_column_go_together_as_their_autocovariance_says() {
    let (hx, hy) = (2.1, 2.6);
    let data = LineImageData {
        size: [256, 256],
        width: 1e5,
        column_electrons: 1e5,
        speckle_size: [hx, hy],
        sensitive_side: 0.8,
        ..DATA
    };
    let lines = LineImage::new(data).unwrap();
    let mean = f64::from(lines.mean(|_| 128.0)[(0, 0)]);
    let theory = PixelAutocovariance::new(&PixelColumn {
        size: [0.8 / hx, 0.8 / hy],
        pitch: [1.0 / hx, 1.0 / hy],
        pixels: 4,
        averaged_columns: 1,
    });
    let theory = theory.unwrap();
    for lag in 0..4 {
        let mut covariance = 0.0;
        for seed in 0..4 {
            let image = lines.speckled(seed, |_| 128.0).unwrap();
            for (x, y) in (0..256).flat_map(|x| (0..256 - lag).map(move |y| (x, y))) {
                let factor = |y| f64::from(image[(x, y)]) / mean - 1.0;
                covariance += factor(y) * factor(y + lag) / (1024.0 * (256 - lag) as f64);
            }
        }
        // 4 · 256²/(hx hy) = 48000 speckles: 3 standard errors of a product of two are 0.014 at
        // most. Sampling and the mismatch of 1 % of the sizes add 0.01 at the steepest.
        let expected = theory.covariance(lag);
        assert!(
            (covariance - expected).abs() < 0.024,
            "{lag}: {covariance}, {expected}"
        );
    }
}

#[test]
fn a_seed_gives_the_same_bits_for_any_number_of_threads() {
    let lines = LineImage::new(DATA).unwrap();
    let image = |threads| on_threads(threads, || lines.speckled(3, |_| 24.3).unwrap());
    assert_eq!(image(1), image(3), "one thread and three");
    let other = lines.speckled(4, |_| 24.3).unwrap();
    assert_ne!(image(1), other, "another seed");
}

#[test]
fn impossible_images_are_rejected_by_name() {
    refuses!(data = DATA => LineImage::new(data);
        data.size: [[0, 10], [usize::MAX; 2]],
        data.width: [f64::NAN],
        data.column_electrons: [-1.0],
        data.speckle_size: [[1.6, 0.01]],
        data.sensitive_side: [0.0],
        data.patterns: [0],
        data.polarisation: [f64::INFINITY],
    );
    refuses!(speckle_size = [1.6; 2] => LineImage::new(LineImageData {
            size: [4000, 100],
            speckle_size,
            ..DATA
        });
        speckle_size: [[0.07; 2]]);
}

/// The light of a line as a sharp lens would image it, in parts of pixels.
fn sharp(data: &LineImageData, parts: usize, middle: f64) -> Grid<f32> {
    let peak = (8.0 / core::f64::consts::PI).sqrt() * data.column_electrons / data.width;
    Grid::from_fn(data.size[0] * parts, data.size[1] * parts, |_, y| {
        let distance = (y as f64 + 0.5) / parts as f64 - middle;
        let density = peak * (-8.0 * (distance / data.width).powi(2)).exp();
        to_f32(density / (parts * parts) as f64)
    })
}

#[test]
fn a_line_that_is_given_by_its_light_has_the_mean_and_the_noise_of_one_that_is_given_by_its_width()
{
    const IMAGES: u64 = 60;
    for (width, blur) in [(2.0, 0.0), (6.0, 9.0)] {
        let data = LineImageData {
            size: [96, 64],
            width,
            blur,
            ..DATA
        };
        let lines = LineImage::new(data).unwrap();
        let parts = lines.parts_of_pixel();
        let middle = 31.3;
        let light = sharp(&data, parts, middle);
        // The moment of a column, over its mean power.
        let moment = |image: &Grid<f32>, x: usize| -> f64 {
            let moments = (0..64).map(|y| f64::from(image[(x, y)]) * (y as f64 + 0.5 - middle));
            moments.sum::<f64>() / data.column_electrons
        };
        let mut found = [[0.0; 3]; 2];
        for seed in 0..IMAGES {
            let images = [
                lines.speckled(seed, |_| middle).unwrap(),
                lines.speckled_light(seed + IMAGES, &light).unwrap(),
            ];
            for (image, [sum, square, power]) in images.iter().zip(&mut found) {
                // At the ends less light comes in than goes out.
                for x in 12..84 {
                    *sum += moment(image, x) / (72 * IMAGES) as f64;
                    *square += moment(image, x).powi(2) / (72 * IMAGES) as f64;
                    let column = image.values().iter().skip(x).step_by(96);
                    *power += column.map(|&e| f64::from(e)).sum::<f64>();
                }
            }
        }
        let [strip, light] = found;
        // Some 2500 independent columns: 1.4 % of a deviation, four of them, and of both.
        assert_relative(strip[1].sqrt(), light[1].sqrt(), 0.08);
        let chance = 4.0 * (2.0 * strip[1] / 2500.0).sqrt();
        assert_absolute(strip[0], light[0], chance);
        // Light that falls next to the image comes in again at the other side, except for the light
        // in the darkness: 2 %.
        assert_relative(strip[2], light[2], 0.02);
    }
}

#[test]
fn light_that_does_not_fit_the_image_is_refused_by_name() {
    let lines = LineImage::new(DATA).unwrap();
    for size in [[95, 48], [192, 48], [1, 1]] {
        let light = Grid::filled(size[0], size[1], 1.0);
        let error = lines.speckled_light(1, &light).unwrap_err();
        assert_eq!(error.parameter(), Some("light"), "{error}");
    }
}

/// Light of any surface is spread as the light of the plate of the set-up.
#[test]
fn light_from_below_a_surface_leaves_it_where_the_line_of_the_plate_does() {
    let mut description = SetupDescription::default();
    description.surface.subsurface.transport_length = 0.2e-3;
    description.surface.subsurface.absorption = 5.0;
    description.surface.subsurface.surface_fraction = 0.1;
    let setup = Setup::new(description).unwrap();
    let lines = LineImage::of_setup(&setup, [4, 200]).unwrap();
    let data = LineImageData {
        blur: 0.0,
        ..lines.data
    };
    let parts = 8;
    let mut sharp_line = lines.clone();
    sharp_line.data = data;
    let light = lines.spread(sharp(&data, parts, 100.0));
    let expected = sharp_line.mean(|_| 100.0);
    // Diffraction takes light from the core to the wings, some hundredths of theirs.
    for rows in [0..50, 50..90, 90..110, 110..150, 150..200] {
        let expected: f32 = rows.clone().map(|y| expected[(0, y)]).sum();
        let parts_of_rows = parts * rows.start..parts * rows.end;
        let found: f32 = parts_of_rows.flat_map(|row| &light.row(row)[..parts]).sum();
        assert_relative(f64::from(found), f64::from(expected), 0.05);
    }
}

#[test]
fn light_without_speckle_is_the_mean_of_light_with_it() {
    for blur in [0.0, 9.0] {
        let data = LineImageData {
            width: 3.0,
            blur,
            ..DATA
        };
        let mut lines = LineImage::new(data).unwrap();
        lines.even = 1.0;
        let parts = 4;
        let light = sharp(&data, parts, 23.6);
        let found = lines.speckled_light(1, &light).unwrap();
        let mean = lines.mean(|_| 23.6);
        let max = f64::from(mean.values().iter().fold(0.0, |a: f32, &b| a.max(b)));
        for y in 0..48 {
            let [found, expected] = [&found, &mean].map(|image| f64::from(image[(48, y)]));
            // Wings come in from the lines after which the image repeats, and go out at the ends of
            // the line.
            assert_absolute(found, expected, 4e-3 * max);
        }
    }
}
