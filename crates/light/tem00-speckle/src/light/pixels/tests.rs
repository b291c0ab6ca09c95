use proptest::prelude::*;
use tem00_numerics::cast::to_signed;
use tem00_statistics::{pixel_contrast, rectangular_pixel_contrast, t_test_mean};

use super::*;
use crate::{PupilField, error::assert_refused};

fn mean(image: &Grid<f32>, of: impl Fn(f64) -> f64) -> f64 {
    let values = image.values();
    values.iter().map(|&i| of(f64::from(i))).sum::<f64>() / values.len() as f64
}

/// The intensity at any point, by the sum over the lattice points of the circle.
fn direct_intensity(field: &PupilField, r: [f64; 2]) -> f64 {
    let (mut sum, mut count) = (Complex::new(0.0, 0.0), 0.0);
    let [c_x, c_y] = field.diameter();
    let reach = to_signed(field.size()[0] / 2);
    for (kx, ky) in (-reach..=reach).flat_map(|kx| (-reach..=reach).map(move |ky| (kx, ky))) {
        if (kx as f64 / c_x).hypot(ky as f64 / c_y) > 0.5 {
            continue;
        }
        let [width, height] = field.size().map(|n| n as f64);
        let phasor = field.phasor([kx, ky]);
        let phasor = Complex::new(f64::from(phasor.re), f64::from(phasor.im));
        sum += phasor * wave(-(kx as f64 * r[0] / width + ky as f64 * r[1] / height));
        count += 1.0;
    }
    sum.norm_sqr() / count
}

/// The mean over a box by Simpson's rule along both axes.
fn box_mean(centre: [f64; 2], size: [f64; 2], f: impl Fn([f64; 2]) -> f64) -> f64 {
    const INTERVALS: usize = 48;
    let node = |i: usize| {
        let weight = match i {
            0 | INTERVALS => 1.0,
            i if i % 2 == 1 => 4.0,
            _ => 2.0,
        };
        (
            i as f64 / INTERVALS as f64 - 0.5,
            weight / (3.0 * INTERVALS as f64),
        )
    };
    let mut sum = 0.0;
    for (x, weight_x) in (0..=INTERVALS).map(node) {
        for (y, weight_y) in (0..=INTERVALS).map(node) {
            let r = [centre[0] + x * size[0], centre[1] + y * size[1]];
            sum += weight_x * weight_y * f(r);
        }
    }
    sum
}

#[test]
fn pixels_are_the_mean_of_the_exact_intensity_over_their_box() {
    // A pupil of 10 points makes fringes up to the highest frequency of 21 samples.
    let field = PupilField::from_speckle_size([21, 24], 2.1, 8).unwrap();
    let pattern = field.pattern();
    let (pitch, size, origin) = ([1.7, 2.9], [0.6, 2.3], [-3.4, 40.6]);
    let pixels = PixelArray::new([5, 4], pitch).unwrap();
    let pixels = pixels.with_size(size).unwrap().with_origin(origin).unwrap();
    let image = pixels.image(&pattern);
    for (i, j) in [(0, 0), (4, 0), (2, 3), (1, 2)] {
        let centre = [
            origin[0] + i as f64 * pitch[0],
            origin[1] + j as f64 * pitch[1],
        ];
        let expected = box_mean(centre, size, |r| direct_intensity(&field, r));
        let got = f64::from(image[(i, j)]);
        // Simpson: (2π/2.1 · 2.3/48)⁴/180 = 2e−6; rounding of the transforms in f32.
        assert!(
            (got - expected).abs() < 1e-5,
            "{got} for {expected} at ({i}, {j})"
        );
    }
}

#[test]
fn point_pixels_are_the_samples() {
    let pattern = PupilField::new(32, 16, 4).unwrap().pattern();
    let pixels = PixelArray::new([32, 32], [1.0, 1.0]).unwrap();
    let image = pixels.with_size([0.0, 0.0]).unwrap().image(&pattern);
    for (a, b) in image.values().iter().zip(pattern.values().values()) {
        assert!((a - b).abs() < 2e-6 * (1.0 + b), "{a} for {b}");
    }
}

#[test]
fn all_light_of_the_pattern_falls_on_pixels_without_gaps() {
    let pattern = PupilField::new(60, 20, 4).unwrap().pattern();
    for count in [[1, 1], [7, 60], [60, 13], [120, 90]] {
        let pitch = count.map(|count| 60.0 / count as f64);
        let image = PixelArray::new(count, pitch).unwrap().image(&pattern);
        // The mean of the pattern is 1 by Parseval; weights in f32.
        assert!((mean(&image, |i| i) - 1.0).abs() < 2e-6, "{count:?}");
    }
    let huge = PixelArray::new([2, 2], [1.0, 1.0]).unwrap();
    let image = huge.with_size([1e12, 1e12]).unwrap().image(&pattern);
    assert!((image[(1, 1)] - 1.0).abs() < 2e-6, "{}", image[(1, 1)]);
}

#[test]
fn the_pattern_repeats_under_the_pixels() {
    let pattern = PupilField::from_speckle_size([24, 32], 3.0, 2)
        .unwrap()
        .pattern();
    let pixels = PixelArray::new([5, 5], [1.3, 0.7]).unwrap();
    let here = pixels.with_origin([1.2, 3.4]).unwrap().image(&pattern);
    let there = pixels
        .with_origin([1.2 - 240.0, 3.4 + 64.0])
        .unwrap()
        .image(&pattern);
    for (a, b) in here.values().iter().zip(there.values()) {
        // The place is off by the rounding of 240, the weights by that of f32.
        assert!((a - b).abs() < 2e-6, "{a} and {b}");
    }
}

#[test]
fn contrasts_follow_the_law_of_integrating_pixels() {
    for (q, contrast) in [
        ([0.5, 0.5], pixel_contrast(0.5)),
        ([1.0, 1.0], pixel_contrast(1.0)),
        ([2.5, 2.5], pixel_contrast(2.5)),
        ([0.4, 3.0], rectangular_pixel_contrast([0.4, 3.0])),
    ] {
        let size = q.map(|q| q * 64.0 / 30.0);
        let squares = (0..24).map(|seed| {
            let field = PupilField::new(64, 30, seed).unwrap();
            let pixels = PixelArray::new([64, 64], [1.0, 1.0]).unwrap();
            let image = pixels.with_size(size).unwrap().image(&field.pattern());
            // The autocovariance of unit phasors is lower by 1/N at every lag.
            let bias = (field.phasor_count() as f64).recip();
            mean(&image, |i| (i - 1.0).powi(2)) + bias
        });
        let squares: Vec<f64> = squares.collect();
        // α = 1e−4 each; the tiles are independent.
        let outcome = t_test_mean(&squares, contrast * contrast).unwrap();
        assert!(outcome.p_value > 1e-4, "{outcome:?} at q = {q:?}");
    }
}

#[test]
fn pixels_outside_their_range_are_refused() {
    for bad in [0, 32_769, usize::MAX] {
        let pixels = PixelArray::new([1, bad], [1.0, 1.0]);
        let rule = "count must be 1 to 32768 pixels along each axis";
        assert_refused(pixels, rule, bad as f64);
    }
    let pitch = "pitch must be positive, all pixels together at most 1e12 samples";
    let good = PixelArray::new([100, 1], [1.0, 1.0]).unwrap();
    for bad in [-1.0, 1.1e12, f64::NAN, f64::INFINITY] {
        assert_refused(PixelArray::new([1, 1], [1.0, bad]), pitch, bad);
        let pixels = good.with_size([bad, 1.0]);
        assert_refused(pixels, "size must be 0 to 1e12 samples", bad);
    }
    for bad in [-1.1e12, 1.1e12, f64::NAN, f64::INFINITY] {
        let pixels = good.with_origin([0.0, bad]);
        assert_refused(pixels, "origin must be within ±1e12 samples", bad);
    }
    assert_refused(PixelArray::new([100, 1], [1.1e10, 1.0]), pitch, 1.1e10);
    assert_refused(PixelArray::new([1, 1], [0.0, 1.0]), pitch, 0);
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(64))]

    #[test]
    fn any_pixel_sees_a_finite_intensity_below_the_greatest(
        pitch in -30.0..11.0_f64, size in -30.0..12.0_f64, origin in -1e12..1e12_f64,
    ) {
        let field = PupilField::new(24, 10, 6).unwrap();
        let pixels = PixelArray::new([3, 2], [10.0_f64.powf(pitch), 1.0]).unwrap();
        let pixels = pixels.with_size([10.0_f64.powf(size), 0.3]).unwrap();
        let image = pixels.with_origin([origin, -origin]).unwrap().image(&field.pattern());
        // N phasors in step.
        let greatest = to_f32(field.phasor_count() as f64);
        prop_assert!(image.values().iter().all(|&i| i > -1e-5 && i <= greatest));
    }
}

#[test]
fn an_array_tells_what_it_was_made_of() {
    let pixels = PixelArray::new([5, 4], [1.3, 0.7]).unwrap();
    let bits = |lengths: [f64; 2]| lengths.map(f64::to_bits);
    assert_eq!(pixels.count(), [5, 4], "columns and rows");
    assert_eq!(bits(pixels.pitch()), bits([1.3, 0.7]), "the pitch");
    assert_eq!(bits(pixels.size()), bits([1.3, 0.7]), "pixels without gaps");
}
