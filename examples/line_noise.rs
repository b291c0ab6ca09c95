//! How far does speckle move a laser line, over its width, the pupil of the camera and the height of
//! the rows that are read?
//!
//! ```sh
//! cargo run --release --example line_noise
//! ```
//!
//! Prints `measured | theory` for rendered frames and for wave optics. Lengths are in speckle sizes h
//! in the image; w is the 1/e² half-width of the line, p the extent of a pixel along it.

#![expect(clippy::print_stdout, reason = "an example prints its answer")]

#[expect(dead_code, reason = "other programs look at more of the images")]
mod line_image;
mod plot;
mod rendered_lines;

use core::f64::consts::FRAC_1_PI;
use std::error::Error;

use kuva::prelude::{LinePlot, Plot, ScatterPlot};
use line_image::{by_wave_optics, positions};
use rendered_lines::LineFrames;
use tem00::statistics::{
    SpeckledLine, imaged_line_centroid_deviation, line_centroid_deviation, speckle_length,
};

type Points = Vec<(f64, f64)>;

const LINE: LineFrames = LineFrames {
    thickness: 1e-3,
    f_number: 8.0,
    pixel_pitch: 3.45e-6,
    angle: 30.0,
    samples_per_pixel: 16,
    length: 512,
    lines: 5,
    seed: 7,
};

/// Renders lines, prints their noise and returns it as that of rows of no height.
fn rendered(name: &str, frames: &[LineFrames]) -> Result<Points, Box<dyn Error>> {
    let mut points = Vec::new();
    for frames in frames {
        let noise = frames.noise()?;
        let [radius, row_height] = [noise.radius, noise.row_height];
        let first_order = SpeckledLine::new(radius, row_height)?.centroid_deviation();
        println!(
            "{name:10} | {radius:5.2} | {row_height:4.2} | {:.3} ± {:.3} | {:.3} | {first_order:.3}",
            noise.deviation,
            noise.deviation * noise.error,
            line_centroid_deviation(radius, row_height)
        );
        let points_of_rows = (speckle_length(0.0) / speckle_length(row_height)).sqrt();
        points.push((radius, noise.deviation * points_of_rows));
    }
    Ok(points)
}

/// Returns the noise of the first moment of points of rows of a line that a lens images.
fn by_waves(width: f64) -> Result<f64, Box<dyn Error>> {
    let (mut squares, mut power, mut rows) = (0.0, 0.0, 0.0);
    for seed in 0..16 {
        for row in by_wave_optics(width, seed)? {
            let moment: f64 = positions().zip(&row).map(|(x, i)| x * i).sum();
            squares += moment * moment;
            power += row.iter().sum::<f64>();
            rows += 1.0;
        }
    }
    Ok((squares * rows).sqrt() / power)
}

fn imaged() -> Result<Points, Box<dyn Error>> {
    let mut points = Vec::new();
    for width in [0.25, 0.5, 1.0, 2.0, 4.0] {
        let measured = by_waves(width)?;
        let [law, theory] = [line_centroid_deviation, imaged_line_centroid_deviation];
        let [law, theory] = [law, theory].map(|form: fn(f64, f64) -> f64| form(width, 0.0));
        println!("waves      | {width:5.2} | 0.00 | {measured:.3} ± 3 %  | {law:.3} | {theory:.3}");
        points.push((width, measured));
    }
    Ok(points)
}

fn main() -> Result<(), Box<dyn Error>> {
    println!("           |   w/h |  p/h | σ/h measured  | law   | first order");
    let widths = [0.5e-3, 0.75e-3, 1e-3, 1.5e-3, 2e-3];
    let widths = widths.map(|thickness| LineFrames { thickness, ..LINE });
    let pupils = [4.0, 5.6, 11.0].map(|f_number| LineFrames { f_number, ..LINE });
    let pitches = [2.4e-6, 6.9e-6, 10e-6];
    let heights = pitches.map(|pixel_pitch| LineFrames {
        pixel_pitch,
        samples_per_pixel: 32,
        ..LINE
    });
    let series = [
        ("line width", "steelblue", rendered("line width", &widths)?),
        ("pupil", "darkorange", rendered("pupil", &pupils)?),
        ("row height", "seagreen", rendered("row height", &heights)?),
        ("wave optics", "black", imaged()?),
    ];
    println!("Dorsch: the centroid of a wide round spot scatters by h/π = {FRAC_1_PI:.3} h");

    let curve = |form: fn(f64) -> f64| {
        let points = (1..=360).map(|i| 0.05 * f64::from(i));
        LinePlot::new().with_data(points.map(move |width| (width, form(width))))
    };
    let mut plots: Vec<Plot> = vec![
        curve(|width| line_centroid_deviation(width, 0.0))
            .with_legend("√(w ℓ / 8√π)")
            .into(),
        curve(|_| FRAC_1_PI)
            .with_color("gray")
            .with_legend("spot, Dorsch 1994")
            .into(),
    ];
    for (name, colour, points) in series {
        let scatter = ScatterPlot::new().with_data(points).with_color(colour);
        plots.push(scatter.with_legend(name).into());
    }
    let axes = [
        "half-width of the line / h",
        "centroid noise of a point of a row / h",
    ];
    let path = plot::write("line_noise", "Speckle noise of a laser line", axes, plots)?;
    println!("{}", path.display());
    Ok(())
}
