//! Patterns against the closed forms of spots and pixels.

use tem00::{
    numerics::Grid,
    speckle::PupilField,
    statistics::{
        laws::{
            PixelAutocovariance, PixelColumn, disc_spot_centroid_deviation,
            gaussian_spot_centroid_deviation,
        },
        t_test_mean,
    },
};

/// Samples of a pattern in a speckle size.
const SAMPLES: usize = 4;

/// Size of a pattern, in speckle sizes.
const SIZE: usize = 128;

const SEEDS: u64 = 16;

/// A correct law fails a comparison with this probability at a given set of seeds.
const SIGNIFICANCE: f64 = 1e-3;

fn patterns() -> impl Iterator<Item = Grid<f32>> {
    (0..SEEDS).map(|seed| {
        let field = PupilField::new(SIZE * SAMPLES, SIZE, seed).expect("a small field");
        field.pattern().values().clone()
    })
}

/// Returns the mean square of the moments along both axes of spots side by side on a pattern, over
/// their mean power. `irradiance` is that of a spot at a squared distance from its middle; both are in
/// speckle sizes.
fn moments(pattern: &Grid<f32>, irradiance: impl Fn(f64) -> f64) -> f64 {
    // Spots reach 6 speckles from their middles.
    const REACH: i64 = 24;
    let offset = |steps: i64| steps as f64 / SAMPLES as f64;
    let middles = || (0..10).map(|spot| (2 * spot + 1) * REACH);
    let (mut squares, mut spots, mut power) = (0.0, 0.0, 0.0);
    for top in middles() {
        for left in middles() {
            let (mut x_moment, mut y_moment, mut even) = (0.0, 0.0, 0.0);
            for (dy, dx) in (-REACH..=REACH).flat_map(|y| (-REACH..=REACH).map(move |x| (y, x))) {
                let (x, y) = (offset(dx), offset(dy));
                let light = irradiance(x * x + y * y);
                let speckled = light * f64::from(*pattern.wrapped(left + dx, top + dy));
                x_moment += x * speckled;
                y_moment += y * speckled;
                even += light;
            }
            squares += 0.5 * (x_moment * x_moment + y_moment * y_moment);
            spots += 1.0;
            power = even;
        }
    }
    squares / spots / (power * power)
}

fn judge(name: &str, estimates: &[f64], law: f64) {
    let test = t_test_mean(estimates, law).expect("patterns that differ");
    let mean = estimates.iter().sum::<f64>() / estimates.len() as f64;
    assert!(
        test.p_value > SIGNIFICANCE,
        "{name}: {mean:.5} | {law:.5}, p = {:e}",
        test.p_value
    );
}

#[test]
fn spots_scatter_as_their_closed_forms_say() {
    let (mut gaussian, mut disc) = (Vec::new(), Vec::new());
    for pattern in patterns() {
        // A 1/e² radius of 4, and a radius of 4 whose edge stands between two samples.
        gaussian.push(moments(&pattern, |squared| (-squared / 8.0).exp()));
        disc.push(moments(&pattern, |squared| f64::from(squared < 16.0)));
    }
    judge(
        "Gaussian",
        &gaussian,
        gaussian_spot_centroid_deviation(4.0).powi(2),
    );
    judge("disc", &disc, disc_spot_centroid_deviation(4.0).powi(2));
}

#[test]
fn pixels_go_together_as_their_autocovariance_says() {
    // Four samples beside each other stand for a pixel: points, whose mean is taken.
    let column = PixelColumn {
        size: [0.0, 0.0],
        pitch: [0.25, 0.25],
        pixels: 8,
        averaged_columns: 4,
    };
    let law = PixelAutocovariance::new(&column).expect("a column");
    let mut estimates = vec![Vec::new(); 8];
    for pattern in patterns() {
        let size = SIZE * SAMPLES;
        let pixels = Grid::from_fn(size / 4, size, |x, y| {
            let four = (0..4).map(|i| f64::from(pattern[(4 * x + i, y)]) - 1.0);
            0.25 * four.sum::<f64>()
        });
        for (lag, estimates) in estimates.iter_mut().enumerate() {
            let mut sum = 0.0;
            for y in 0..size {
                let other = pixels.row((y + lag) % size);
                let pairs = pixels.row(y).iter().zip(other);
                sum += pairs.map(|(a, b)| a * b).sum::<f64>();
            }
            estimates.push(sum / (size * size / 4) as f64);
        }
    }
    for (lag, estimates) in estimates.iter().enumerate() {
        judge(&format!("lag {lag}"), estimates, law.covariance(lag));
    }
}
