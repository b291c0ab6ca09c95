//! How wide is a laser beam that a knife edge was drawn through?
//!
//! ```sh
//! cargo run --release --example knife_edge -- trace.csv
//! ```
//!
//! The file has two columns, the position of the edge in mm and the power that passes, in any unit.
//! Without a file, a trace of a beam of 0.5 mm is made up, with noise.

#![expect(clippy::print_stdout, reason = "an example prints its answer")]

mod plot;
mod table;

use std::env;

use kuva::prelude::{LinePlot, Plot, ScatterPlot};
use rand::{RngExt, SeedableRng};
use rand_chacha::ChaCha8Rng;
use table::Failure;
use tem00::beam::Refusal;
use tem00::optics::{CrossSection, KnifeEdgeFit};

/// A trace of a 1 mW beam with w = 0.5 mm around 3 mm, with an error of ±5 µW.
fn made_up() -> Result<[Vec<f64>; 2], Refusal> {
    let spot = CrossSection::new([0.5e-3; 2])?;
    let mut random = ChaCha8Rng::seed_from_u64(7);
    let positions: Vec<_> = (0..=60).map(|i| 1.5 + 0.05 * f64::from(i)).collect();
    let powers = positions.iter().map(|position| {
        let error = 0.01 * (random.random::<f64>() - 0.5);
        spot.power_past_knife_edge((position - 3.0) * 1e-3) + error
    });
    let powers = powers.collect();
    Ok([positions, powers])
}

fn main() -> Result<(), Failure> {
    let [millimetres, powers] = match env::args().nth(1) {
        Some(path) => table::read(&path)?,
        None => made_up()?,
    };
    let positions: Vec<_> = millimetres.iter().map(|x| x * 1e-3).collect();
    let fit = KnifeEdgeFit::with_background(&positions, &powers)?;

    let [radius, centre] = [fit.radius(), fit.centre()];
    let width = 1e3 * CrossSection::new([radius.value; 2])?.knife_edge_width()[0];
    let in_mm = |value: f64| 1e3 * value;
    println!("{} positions of the edge", positions.len());
    println!(
        "w      = {:.3} ± {:.3} mm   (1/e² radius; D4σ is twice that)",
        in_mm(radius.value),
        in_mm(radius.standard_error)
    );
    println!(
        "centre = {:.3} ± {:.3} mm",
        in_mm(centre.value),
        in_mm(centre.standard_error)
    );
    println!("10–90 % width = {width:.3} mm");
    println!("scatter about the fit = {:.2e} of the power", {
        fit.residual_deviation() / fit.power().value
    });

    let [first, last] = table::range(&positions);
    let curve = (0..=300).map(|i| {
        let x = first + (last - first) * f64::from(i) / 300.0;
        (in_mm(x), fit.power_at(x))
    });
    let measured = millimetres.iter().copied().zip(powers.iter().copied());
    let plots: Vec<Plot> = vec![
        LinePlot::new().with_data(curve).with_legend("fit").into(),
        ScatterPlot::new()
            .with_data(measured)
            .with_color("crimson")
            .with_legend("measured")
            .into(),
    ];
    let axes = ["position of the edge / mm", "power past the edge"];
    let path = plot::write("knife_edge", "Knife-edge trace", axes, plots)?;
    println!("{}", path.display());
    Ok(())
}
