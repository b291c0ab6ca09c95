//! How does speckle change while the pupil that it is seen through moves?
//!
//! ```sh
//! cargo run --release --example correlated_slices
//! ```
//!
//! The film has the slices of one stack: the pupil goes once around a circle as wide as itself, and
//! the first and last frame join. The speckle does not travel: it boils.

#![expect(clippy::print_stdout, reason = "an example prints its answer")]

mod picture;
mod plot;

use std::error::Error;

use kuva::prelude::{LinePlot, Plot, ScatterPlot};
use tem00::{
    numerics::Grid,
    speckle::{PupilField, SlicePath, SpeckleStack},
    statistics::pearson_correlation,
};

const SIZE: usize = 192;
const FRAMES: u32 = 24;

#[expect(clippy::cast_possible_truncation, reason = "a picture is kept in f32")]
fn frame(stack: &SpeckleStack, u: f64) -> Grid<f32> {
    let intensity = |x, y| stack.intensity_at(x as f64, y as f64, u) as f32;
    Grid::from_fn(SIZE, SIZE, intensity)
}

/// The mean correlation of all frames that are `distance` apart around the circle.
fn mean_correlation(frames: &[Grid<f32>], distance: usize) -> Result<f64, Box<dyn Error>> {
    let mut sum = 0.0;
    for (i, first) in frames.iter().enumerate() {
        sum += pearson_correlation(first, &frames[(i + distance) % frames.len()])?;
    }
    Ok(sum / frames.len() as f64)
}

fn main() -> Result<(), Box<dyn Error>> {
    let half_period = FRAMES as usize / 2;
    let field = PupilField::new(SIZE, SIZE / 4, 1)?;
    let stack = SpeckleStack::generate(&field, SlicePath::Circle { half_period })?;
    let frames: Vec<_> = (0..FRAMES).map(|i| frame(&stack, f64::from(i))).collect();

    println!("frames apart | with the first | mean of all pairs | theory");
    let mut measured = Vec::new();
    for distance in 0..=half_period {
        let first = pearson_correlation(&frames[0], &frames[distance])?;
        let mean = mean_correlation(&frames, distance)?;
        let theory = stack.correlation_at(distance as f64);
        println!("{distance:>12} | {first:>14.3} | {mean:>17.3} | {theory:.3}");
        measured.push((distance as f64, mean));
    }
    println!(
        "half the correlation is left after {:.2} frames",
        stack.coordinate_of(0.5)
    );

    let law = (0..=240).map(|i| f64::from(i) * half_period as f64 / 240.0);
    let plots: Vec<Plot> = vec![
        LinePlot::new()
            .with_data(law.map(|u| (u, stack.correlation_at(u))))
            .with_legend("squared overlap of the pupils")
            .into(),
        ScatterPlot::new()
            .with_data(measured)
            .with_color("crimson")
            .with_legend("measured")
            .into(),
    ];
    let axes = ["frames apart", "correlation of the intensities"];
    let title = "Speckle behind a pupil on a circle";
    println!(
        "{}",
        plot::write("correlated_slices", title, axes, plots)?.display()
    );
    println!(
        "{}",
        picture::write("correlated_slices", &frames)?.display()
    );
    Ok(())
}
