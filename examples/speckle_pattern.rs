//! What does fully developed speckle look like, and is a computed pattern fully developed?
//!
//! ```sh
//! cargo run --release --example speckle_pattern
//! ```

#![expect(clippy::print_stdout, reason = "an example prints its answer")]

mod picture;
mod plot;

use std::error::Error;

use kuva::prelude::{LinePlot, Plot, ScatterPlot};
use tem00::{
    speckle::PupilField,
    statistics::{
        Boundary, Contrast, Moments, SpeckleSize, contrast_of_phasor_sum, decorrelated_samples,
        exponential_cumulative, exponential_density, kolmogorov_smirnov,
    },
};

/// The width of a bar of the histogram, in units of the mean intensity.
const BAR: f64 = 0.25;

fn row(quantity: &str, measured: f64, theory: f64) {
    println!("{quantity:<22} {measured:>8.4} | {theory:.4}");
}

/// The middles of the bars and the density of the samples in them.
fn histogram(samples: &[f64]) -> impl Iterator<Item = (f64, f64)> {
    (0..28_u32).map(|i| {
        let low = f64::from(i) * BAR;
        let inside = |x: &&f64| (low..low + BAR).contains(*x);
        let count = samples.iter().filter(inside).count() as f64;
        (low + 0.5 * BAR, count / (BAR * samples.len() as f64))
    })
}

fn main() -> Result<(), Box<dyn Error>> {
    // Speckles of four pixels, 256 of them across.
    let field = PupilField::new(1024, 256, 1)?;
    let pattern = field.pattern();
    let image = pattern.values();
    let contrast =
        Contrast::from_samples(image.values())?.with_speckle_size(pattern.speckle_size())?;
    let size = SpeckleSize::from_image(image, Boundary::Periodic)?;
    // Every fifth pixel: the first zero of the autocovariance lies at 1.22 speckle sizes.
    let samples = decorrelated_samples(image, 5)?;
    let exponential = kolmogorov_smirnov(&samples, exponential_cumulative)?;

    println!("{:<22} measured | theory", "");
    row("mean", Moments::from_samples(image.values())?.mean(), 1.0);
    let theory = contrast_of_phasor_sum(field.phasor_count());
    row("contrast", contrast.value(), theory);
    println!("{:<22} ±{:.4}", "", contrast.standard_error());
    row("speckle size / pixels", size.mean(), field.speckle_size());
    let brighter = samples.iter().filter(|&&x| x > 3.0).count() as f64 / samples.len() as f64;
    row("share above 3 means", brighter, (-3.0_f64).exp());
    println!(
        "exponential? Kolmogorov and Smirnov's distance is {:.4}, p = {:.3}",
        exponential.statistic, exponential.p_value
    );

    let curve = (0..=280).map(|i| f64::from(i) * 0.025);
    let plots: Vec<Plot> = vec![
        LinePlot::new()
            .with_data(curve.map(|x| (x, exponential_density(x))))
            .with_legend("exp(−I)")
            .into(),
        ScatterPlot::new()
            .with_data(histogram(&samples))
            .with_color("crimson")
            .with_legend("measured")
            .into(),
    ];
    let axes = ["intensity / mean", "probability density"];
    let title = "Intensity of fully developed speckle";
    println!(
        "{}",
        plot::write("speckle_pattern", title, axes, plots)?.display()
    );
    println!(
        "{}",
        picture::write("speckle_pattern", &[pattern.into_values()])?.display()
    );
    Ok(())
}
