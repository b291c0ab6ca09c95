//! How far may a surface move along the line of sight before its speckle is a new pattern?
//!
//! ```sh
//! cargo run --release --example defocus
//! ```
//!
//! Not `d_z⁰ = λ [2 (1 + 1/m) F]²`, as Bergmann et al. 2016 state in §6.4: by the formula of Li and
//! Chiang that they print beside it, 40.5 % are left there, and the pattern is new at twice that
//! length. Patterns of a defocused pupil agree with the formula.

#![expect(clippy::print_stdout, reason = "an example prints its answer")]

mod plot;

use std::error::Error;

use kuva::prelude::{LinePlot, Plot, ScatterPlot};
use tem00::{
    decorrelation::{ImagingGeometry, LensData, axial_correlation, equivalent_axial_shift},
    speckle::PupilField,
    statistics::pearson_correlation,
};

/// Fields to average over; each has 51 000 speckles.
const SEEDS: u64 = 4;

/// The correlation of patterns in focus and out of focus by `a_o` printed lengths, which are half as
/// long as the axial decorrelation length, with its standard error.
fn measured(fields: &[PupilField], a_o: f64) -> Result<[f64; 2], Box<dyn Error>> {
    let mut gammas = Vec::new();
    for field in fields {
        let (sharp, moved) = (field.pattern(), field.pattern_at([0.0; 2], 0.5 * a_o));
        gammas.push(pearson_correlation(sharp.values(), moved.values())?);
    }
    let count = gammas.len() as f64;
    let mean = gammas.iter().sum::<f64>() / count;
    let squares: f64 = gammas.iter().map(|gamma| (gamma - mean).powi(2)).sum();
    Ok([mean, (squares / (count * (count - 1.0))).sqrt()])
}

fn main() -> Result<(), Box<dyn Error>> {
    // f = 60 mm at f/6, imaging 4 : 1 at the wavelength of a helium–neon laser.
    let geometry = ImagingGeometry::from_lens(LensData {
        wavelength: 632.8e-9,
        focal_length: 60e-3,
        f_number: 6.0,
        surface_to_pupil: 0.3,
        pixel_pitch: 3.45e-6,
    })?;
    let stated = tem00_paper::axial_decorrelation_length(&geometry);
    let zero = geometry.axial_decorrelation_length();
    let fields = (0..SEEDS).map(|seed| PupilField::new(768, 256, seed));
    let fields = fields.collect::<Result<Vec<_>, _>>()?;

    println!("a_O  | d_z / mm | measured        | theory");
    let mut points = Vec::new();
    for step in 1..=10 {
        let a_o = 0.25 * f64::from(step);
        let [gamma, error] = measured(&fields, a_o)?;
        let theory = axial_correlation(0.5 * a_o);
        let millimetres = 1e3 * stated * a_o;
        println!("{a_o:4.2} | {millimetres:8.3} | {gamma:7.4} ± {error:.4} | {theory:.4}");
        points.push((a_o, gamma));
    }
    let left = axial_correlation(stated / zero);
    let [stated, zero] = [stated, zero].map(|length| 1e3 * length);
    println!("The paper's statement is wrong by its own formula, sinc²(π a_O / 2):");
    println!("  λ [2 (1 + 1/m) F]² = {stated:.3} mm leave {left:.3} of the correlation");
    println!("2 λ [2 (1 + 1/m) F]² = {zero:.3} mm are its first zero");
    let half = zero * equivalent_axial_shift(0.5)?;
    println!("half of it is left after {half:.3} mm");

    let curve = (0..=300).map(|i| f64::from(i) * 0.01);
    let plots: Vec<Plot> = vec![
        LinePlot::new()
            .with_data(curve.map(|a_o| (a_o, axial_correlation(0.5 * a_o))))
            .with_legend("sinc²(π a_O / 2)")
            .into(),
        ScatterPlot::new()
            .with_data(points)
            .with_color("crimson")
            .with_legend("measured")
            .into(),
    ];
    let axes = ["a_O = d_z / λ[2(1 + 1/m)F]²", "correlation of intensity"];
    let path = plot::write("defocus", "Speckle out of focus", axes, plots)?;
    println!("{}", path.display());
    Ok(())
}
