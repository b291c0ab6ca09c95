//! What are the waist and the M² of a beam whose radius was measured along its way?
//!
//! ```sh
//! cargo run --release --example beam_caustic -- radii.csv 1064e-9
//! ```
//!
//! The file has two columns, the position along the beam and the 1/e² radius (half of D4σ), both in
//! mm; the second argument is the wavelength in metres. Without arguments, twelve radii of a beam
//! with M² = 1.3 at 650 nm are made up, with errors of 1 %.

#![expect(clippy::print_stdout, reason = "an example prints its answer")]

mod plot;
mod table;

use std::env;

use kuva::prelude::{LinePlot, Plot, ScatterPlot};
use rand::{RngExt, SeedableRng};
use rand_chacha::ChaCha8Rng;
use table::Failure;
use tem00::beam::{GaussianBeam, Refusal};
use tem00::optics::{CausticFit, Estimate};

const WAVELENGTH: f64 = 650e-9;

/// Radii, in mm, of a beam with a waist of 40 µm at 50 mm.
fn made_up() -> Result<[Vec<f64>; 2], Refusal> {
    let beam = GaussianBeam::from_waist(WAVELENGTH, 40e-6)?.with_m_squared(1.3)?;
    let mut random = ChaCha8Rng::seed_from_u64(3);
    let positions = [
        0.0, 10.0, 20.0, 44.0, 47.0, 49.0, 51.0, 53.0, 56.0, 80.0, 90.0, 100.0,
    ];
    let radii = positions.map(|z| {
        let error = 0.01 * 12_f64.sqrt() * (random.random::<f64>() - 0.5);
        1e3 * beam.radius_at((z - 50.0) * 1e-3) * (1.0 + error)
    });
    Ok([positions.to_vec(), radii.to_vec()])
}

fn show(name: &str, estimate: Estimate, scale: f64, unit: &str) {
    let [value, error] = [estimate.value, estimate.standard_error].map(|x| x * scale);
    println!("{name:<22} {value:>9.3} ± {error:.3} {unit}");
}

/// A wavelength in metres, from the command line.
fn wavelength_of(text: &str) -> Result<f64, String> {
    text.parse()
        .map_err(|_| format!("the wavelength must be in metres, as in 1064e-9, got {text:?}"))
}

/// Whether the fit contradicts physics by more than its own error.
fn is_better_than_light(m_squared: Estimate) -> bool {
    m_squared.value + 3.0 * m_squared.standard_error < 1.0
}

fn main() -> Result<(), Failure> {
    let mut arguments = env::args().skip(1);
    let ([positions, radii], wavelength) = match (arguments.next(), arguments.next()) {
        (Some(path), Some(wavelength)) => (table::read(&path)?, wavelength_of(&wavelength)?),
        (Some(_), None) => return Err("after the file, give the wavelength in metres".into()),
        (None, _) => (made_up()?, WAVELENGTH),
    };
    let in_metres = |lengths: &[f64]| lengths.iter().map(|x| x * 1e-3).collect::<Vec<_>>();
    let fit = CausticFit::new(wavelength, &in_metres(&positions), &in_metres(&radii))?;

    println!("{} positions along the beam", positions.len());
    show("waist radius", fit.waist_radius(), 1e6, "µm");
    show("waist position", fit.waist_position(), 1e3, "mm");
    show("Rayleigh range", fit.rayleigh_range(), 1e3, "mm");
    show("divergence, half-angle", fit.divergence(), 1e3, "mrad");
    show("M²", fit.m_squared(), 1.0, "");
    if is_better_than_light(fit.m_squared()) {
        println!("M² is below 1: the wavelength, or a unit of the table, must be wrong");
    }
    println!(
        "scatter of the radii   {:>9.2} %",
        100.0 * fit.residual_deviation()
    );

    let [first, last] = table::range(&positions);
    let curve = (0..=300).map(|i| {
        let z = first + (last - first) * f64::from(i) / 300.0;
        (z, 1e3 * fit.radius_at(z * 1e-3))
    });
    let measured = positions.iter().copied().zip(radii.iter().copied());
    let plots: Vec<Plot> = vec![
        LinePlot::new().with_data(curve).with_legend("fit").into(),
        ScatterPlot::new()
            .with_data(measured)
            .with_color("crimson")
            .with_legend("measured")
            .into(),
    ];
    let axes = ["position along the beam / mm", "beam radius / mm"];
    let path = plot::write("beam_caustic", "Caustic of a focused beam", axes, plots)?;
    println!("{}", path.display());
    Ok(())
}
