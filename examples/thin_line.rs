//! How thin may a laser line be before its speckle is no pattern times an irradiance any more?
//!
//! ```sh
//! cargo run --release --example thin_line
//! ```
//!
//! Images of lines on a rough surface by wave optics, beside two that are made of a speckle
//! pattern: times the irradiance on the surface, and times the same blurred by the lens. Widths are
//! 1/e² half-widths, in speckle sizes on the surface.

#![expect(clippy::print_stdout, reason = "an example prints its answer")]

mod line_image;
mod plot;

use std::error::Error;

use kuva::prelude::{LinePlot, Plot, ScatterPlot};
use line_image::{Measured, Row, blurred_profile, by_pattern, by_wave_optics, geometric_profile};

const WIDTHS: [f64; 7] = [0.25, 0.5, 0.75, 1.0, 1.5, 2.0, 4.0];
const IMAGES: u64 = 24;
const MODELS: [(&str, &str); 3] = [
    ("wave optics", "black"),
    ("pattern × blurred", "steelblue"),
    ("pattern × sharp", "crimson"),
];

fn rows(
    image: impl Fn(u64) -> Result<Vec<Row>, Box<dyn Error>>,
) -> Result<Vec<Row>, Box<dyn Error>> {
    let mut all = Vec::new();
    for seed in 0..IMAGES {
        all.extend(image(seed)?);
    }
    Ok(all)
}

/// Standard deviation of the centroid of a row, first order in the fluctuations: the pattern times
/// the sharp irradiance.
fn closed_form(width: f64) -> f64 {
    use core::f64::consts::PI;
    let row = 32.0 / (3.0 * PI * PI);
    (width * row / (8.0 * PI.sqrt())).sqrt()
}

fn main() -> Result<(), Box<dyn Error>> {
    println!("w / h | image                | full width | centroid σ | across | row contrast");
    let mut points = MODELS.map(|_| Vec::new());
    for width in WIDTHS {
        let (blurred, sharp) = (blurred_profile(width), geometric_profile(width));
        let images = [
            rows(|seed| by_wave_optics(width, seed))?,
            rows(|seed| by_pattern(&blurred, seed))?,
            rows(|seed| by_pattern(&sharp, seed))?,
        ];
        for ((rows, (name, _)), points) in images.iter().zip(MODELS).zip(&mut points) {
            let Measured {
                width: full,
                centroid_noise,
                across,
                row_contrast,
            } = Measured::of(rows, width);
            println!(
                "{width:>5} | {name:20} | {full:>8.3} h | {centroid_noise:>8.3} h | \
                 {across:>6.3} | {row_contrast:.3}"
            );
            points.push((width, centroid_noise));
        }
        println!(
            "      | closed form          |            | {:>8.3} h |",
            closed_form(width)
        );
    }

    let curve = (1..=160).map(|i| f64::from(i) * 0.025);
    let law = LinePlot::new()
        .with_data(curve.map(|width| (width, closed_form(width))))
        .with_legend("closed form");
    let mut plots: Vec<Plot> = vec![law.into()];
    for (points, (name, colour)) in points.into_iter().zip(MODELS) {
        let scatter = ScatterPlot::new().with_data(points).with_color(colour);
        plots.push(scatter.with_legend(name).into());
    }
    let axes = ["half-width of the line / h", "centroid noise of a row / h"];
    let title = "Speckle noise of a laser line";
    println!(
        "{}",
        plot::write("thin_line", title, axes, plots)?.display()
    );
    Ok(())
}
