//! How much contrast is left of speckle when the pixels of a sensor are not small beside it?
//!
//! ```sh
//! cargo run --release --example pixel_contrast
//! ```

#![expect(clippy::print_stdout, reason = "an example prints its answer")]

mod plot;

use std::error::Error;

use kuva::prelude::{LinePlot, Plot, ScatterPlot};
use tem00::{
    speckle::{PixelArray, PupilField, SpecklePattern},
    statistics::{Contrast, pixel_contrast},
};

/// Widths of a pixel, in speckle sizes.
const WIDTHS: [f64; 10] = [0.0, 0.25, 0.5, 0.75, 1.0, 1.5, 2.0, 3.0, 4.0, 6.0];

/// The mean contrast of the patterns, seen by pixels that are `width` speckle sizes wide.
fn measured(patterns: &[SpecklePattern], width: f64) -> Result<f64, Box<dyn Error>> {
    let mut sum = 0.0;
    for pattern in patterns {
        let side = width * pattern.speckle_size();
        let pixels = PixelArray::new([128; 2], [4.0; 2])?.with_size([side; 2])?;
        sum += Contrast::from_samples(pixels.image(pattern).values())?.value();
    }
    Ok(sum / patterns.len() as f64)
}

fn main() -> Result<(), Box<dyn Error>> {
    // Speckles of two samples, 256 of them across; four patterns for a smaller error.
    let field = PupilField::new(512, 256, 0)?;
    let patterns: Vec<_> = (0..4)
        .map(|seed| field.clone().with_seed(seed).pattern())
        .collect();

    println!("pixel / speckle size | speckles per pixel | measured | theory");
    let mut points = Vec::new();
    for width in WIDTHS {
        let (contrast, theory) = (measured(&patterns, width)?, pixel_contrast(width));
        let speckles = theory.powi(-2);
        println!("{width:>20.2} | {speckles:>18.2} | {contrast:>8.4} | {theory:.4}");
        points.push((width, contrast));
    }

    let curve = (0..=300).map(|i| f64::from(i) * 0.02);
    let plots: Vec<Plot> = vec![
        LinePlot::new()
            .with_data(curve.map(|width| (width, pixel_contrast(width))))
            .with_legend("closed form")
            .into(),
        ScatterPlot::new()
            .with_data(points)
            .with_color("crimson")
            .with_legend("measured")
            .into(),
    ];
    let axes = ["width of a pixel / speckle size", "contrast"];
    let title = "Contrast of speckle in the image of a sensor";
    println!(
        "{}",
        plot::write("pixel_contrast", title, axes, plots)?.display()
    );
    Ok(())
}
