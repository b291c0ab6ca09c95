//! Does a step of known height come back within the uncertainty that its measurement states?
//!
//! ```sh
//! cargo run --release --example step_height [SEEDS]
//! ```
//!
//! A step of 1 mm is rendered, exposed, found and triangulated, with other speckle and other noise for
//! each seed. Prints how far the heights are from the truth, measured | stated.

#![expect(clippy::print_stdout, reason = "an example prints its answer")]
#![expect(clippy::expect_used, reason = "an example ends where something fails")]

mod plot;
mod step;

use std::error::Error;

use kuva::prelude::{LinePlot, Plot, ScatterPlot};
use rayon::prelude::*;
use step::{STEP, measure, scene};

/// What a standard normal number exceeds in magnitude once in twenty times.
const COVERAGE: f64 = 1.96;

fn main() -> Result<(), Box<dyn Error>> {
    let seeds: u64 = std::env::args()
        .nth(1)
        .map_or(Ok(300), |seeds| seeds.parse())?;
    let scene = scene();
    let steps: Vec<[f64; 2]> = (0..seeds)
        .into_par_iter()
        .map(|seed| {
            let mut scene = scene.clone();
            scene.scene.render.seed = seed;
            step::step(&measure(&scene))
        })
        .collect();
    let count = steps.len().max(1) as f64;
    let mean = |of: &dyn Fn(&[f64; 2]) -> f64| steps.iter().map(of).sum::<f64>() / count;
    let scores: Vec<f64> = steps
        .iter()
        .map(|[height, u]| (height - STEP) / u)
        .collect();
    let covered = scores.iter().filter(|z| z.abs() < COVERAGE).count() as f64;

    println!("                      | measured  | stated");
    println!(
        "mean height           | {:.2} µm | {:.2} µm",
        1e6 * mean(&|s| s[0]),
        1e6 * STEP
    );
    let deviation = mean(&|s| (s[0] - STEP).powi(2)).sqrt();
    let stated = mean(&|s| s[1] * s[1]).sqrt();
    println!(
        "standard deviation    | {:.2} µm   | {:.2} µm",
        1e6 * deviation,
        1e6 * stated
    );
    println!(
        "within 1.96 u         | {:.1} %    | 95.0 %",
        100.0 * covered / count
    );

    let level = |z: f64| {
        LinePlot::new()
            .with_data([(0.0, z), (count, z)])
            .with_color("gray")
    };
    let points = (0_u32..)
        .zip(&scores)
        .map(|(seed, &z)| (f64::from(seed), z));
    let plots: Vec<Plot> = vec![
        ScatterPlot::new()
            .with_data(points)
            .with_legend("step")
            .into(),
        level(COVERAGE).with_legend("±1.96").into(),
        level(-COVERAGE).into(),
    ];
    let axes = ["seed", "error / standard uncertainty"];
    let path = plot::write("step_height", "A step of 1 mm, measured", axes, plots)?;
    println!("{}", path.display());
    Ok(())
}
