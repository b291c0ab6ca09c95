//! What is lost when speckle between samples is interpolated in intensity?
//!
//! ```sh
//! cargo run --release --example interpolation_matters
//! ```
//!
//! Bergmann et al. 2016 interpolate intensities: bilinear in the plane, linear between slices. The mean
//! of two intensities fluctuates less than either, so that the speckle fades and returns while it
//! moves. [`SpeckleStack`] interpolates amplitudes, and even its cheaper ways keep mean and contrast: what
//! they pay with is the correlation of neighbours.

#![expect(clippy::print_stdout, reason = "an example prints its answer")]

mod plot;

use std::error::Error;

use kuva::prelude::{LinePlot, Plot, ScatterPlot};
use tem00::{
    speckle::{Interpolation, PupilField, SlicePath, SpeckleStack, StackOptions},
    statistics::{Contrast, StatisticsError},
};
use tem00_paper::BilinearStack;

/// Speckles across a pattern.
const SPECKLES: usize = 256;

/// The contrast of look-ups on a lattice of two per speckle, displaced by a fraction of a sample.
fn contrast(
    h: usize,
    fraction: f64,
    look_up: impl Fn(f64, f64) -> f64,
) -> Result<f64, StatisticsError> {
    let place = |i: usize| (i * h / 2) as f64 + fraction;
    // As printed, the last interval along each axis is missing.
    let along = 0..2 * SPECKLES - 1;
    let lattice = along
        .clone()
        .flat_map(|y| along.clone().map(move |x| (x, y)));
    let values: Vec<f64> = lattice.map(|(x, y)| look_up(place(x), place(y))).collect();
    Ok(Contrast::from_samples(&values)?.value())
}

/// One way between two look-ups without error, at a fraction of which the contrast is given.
struct Way<'a> {
    name: String,
    color: &'a str,
    law: &'a dyn Fn(f64) -> f64,
    printed: &'a dyn Fn(f64) -> Result<f64, StatisticsError>,
    ours: &'a dyn Fn(f64) -> Result<f64, StatisticsError>,
}

impl Way<'_> {
    fn show(&self, plots: &mut Vec<Plot>) -> Result<(), StatisticsError> {
        let [printed, law, ours] = [(self.printed)(0.5)?, (self.law)(0.5), (self.ours)(0.5)?];
        println!(
            "{:<32} | {printed:>8.3} | {law:>11.3} | {ours:.3}",
            self.name
        );

        let curve = (0..=50)
            .map(|i| f64::from(i) / 50.0)
            .map(|f| (f, (self.law)(f)));
        let line = LinePlot::new().with_data(curve).with_color(self.color);
        plots.push(line.with_legend(&*self.name).into());
        for (look_up, color) in [(self.printed, self.color), (self.ours, "black")] {
            let mut points = Vec::new();
            for f in (0..=10).map(|i| f64::from(i) / 10.0) {
                points.push((f, look_up(f)?));
            }
            plots.push(
                ScatterPlot::new()
                    .with_data(points)
                    .with_color(color)
                    .into(),
            );
        }
        Ok(())
    }
}

/// Mean and contrast half-way between samples and slices, and the correlation of look-ups half-way
/// between samples that are one sample apart.
fn show_ways_in_amplitude() -> Result<(), Box<dyn Error>> {
    println!("\namplitudes, 2 per speckle         |  mean | contrast | one sample on  | expected");
    let field = PupilField::new(2 * SPECKLES, SPECKLES, 1)?;
    let expected = field.amplitude_correlation([1.0, 0.0]).norm_sqr();
    for interpolation in [
        Interpolation::CubicSpline,
        Interpolation::Bilinear,
        Interpolation::Nearest,
    ] {
        let options = StackOptions {
            interpolation,
            ..StackOptions::default()
        };
        let path = SlicePath::Circle { half_period: 8 };
        let stack = SpeckleStack::generate_with(&field, path, options)?;
        let (mut sum, mut square, mut product, mut count) = (0.0, 0.0, 0.0, 0.0);
        for i in 0..2 * SPECKLES {
            for j in 0..2 * SPECKLES {
                let at = |x: f64, y: f64, u| stack.intensity_at(i as f64 + x, j as f64 + y, u);
                let between = at(0.5, 0.5, 0.5);
                sum += between;
                square += between * between;
                product += at(0.5, 0.5, 0.0) * at(1.5, 0.5, 0.0) - 1.0;
                count += 1.0;
            }
        }
        let mean: f64 = sum / count;
        let contrast = (square / count - mean * mean).sqrt() / mean;
        let name = format!("{interpolation:?}");
        println!(
            "{name:<33} | {mean:.3} | {contrast:>8.3} | {:>14.3} | {expected:.3}",
            product / count
        );
    }
    Ok(())
}

fn main() -> Result<(), Box<dyn Error>> {
    let mut plots = Vec::new();
    println!("contrast half-way between        | measured | closed form | amplitudes");
    for (h, color) in [(2, "crimson"), (4, "darkorange"), (8, "steelblue")] {
        let field = PupilField::new(h * SPECKLES, SPECKLES, 1)?;
        let printed = BilinearStack::generate(&field, 1)?;
        let stack = SpeckleStack::generate(&field, SlicePath::Still)?;
        let way = Way {
            name: format!("samples, {h} per speckle"),
            color,
            law: &|f| printed.contrast_between_samples(f, f),
            printed: &|f| contrast(h, f, |x, y| printed.intensity_at(x, y, 0.0)),
            ours: &|f| contrast(h, f, |x, y| stack.intensity_at(x, y, 0.0)),
        };
        way.show(&mut plots)?;
    }

    let field = PupilField::new(2 * SPECKLES, SPECKLES, 1)?;
    let printed = BilinearStack::generate(&field, 8)?;
    let stack = SpeckleStack::generate(&field, SlicePath::Circle { half_period: 8 })?;
    let way = Way {
        name: "slices, 16 around the circle".into(),
        color: "seagreen",
        law: &|f| printed.contrast_between_slices(0, f),
        printed: &|f| contrast(2, 0.0, |x, y| printed.intensity_at(x, y, f)),
        ours: &|f| contrast(2, 0.0, |x, y| stack.intensity_at(x, y, f)),
    };
    way.show(&mut plots)?;
    show_ways_in_amplitude()?;

    let axes = [
        "fraction of the way between two samples or slices",
        "contrast",
    ];
    let title = "Interpolated speckle: intensities (colours), amplitudes (black)";
    println!(
        "{}",
        plot::write("interpolation_matters", title, axes, plots)?.display()
    );
    Ok(())
}
