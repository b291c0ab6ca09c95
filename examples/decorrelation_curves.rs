//! How much of a speckle pattern is left when a surface moves, and what do the usual formulas make
//! of it?
//!
//! ```sh
//! cargo run --release --example decorrelation_curves
//! ```
//!
//! Compares the correlation of intensity after a pupil displacement, after an axial displacement,
//! and after both: what looking the pattern up at the slice of Bergmann et al. 2016 gives, as
//! printed; and the integral over the pupil, with the first state in focus or the defocus followed
//! to the peak.

#![expect(clippy::print_stdout, reason = "an example prints its answer")]

mod plot;

use std::{error::Error, io};

use kuva::prelude::{LinePlot, Plot};
use tem00::{
    decorrelation::{CorrelationLaw, axial_correlation, pupil_overlap_correlation},
    numerics::circular_path_overlap,
};

/// The correlation between slice 0 and the slice `u = (|a_P|/D + d_z/d_z⁰) M` of the paper, for a
/// displacement by `s` pupil diameters and the `x`-fold axial decorrelation length.
fn printed(s: f64, x: f64) -> f64 {
    // The length d_z⁰ is half the axial decorrelation length.
    circular_path_overlap(s + 2.0 * x).powi(2)
}

/// A law over a displacement from 0 to `end`.
fn curve(name: &str, colour: &str, end: f64, law: impl Fn(f64) -> f64) -> Plot {
    let points = (0..=300).map(|i| {
        let displacement = end * f64::from(i) / 300.0;
        (displacement, law(displacement))
    });
    let line = LinePlot::new().with_data(points).with_legend(name);
    line.with_color(colour).into()
}

/// A pupil displacement by 40 % of what a motion displaces the speckle along the axis.
fn slanted(law: CorrelationLaw) -> impl Fn(f64) -> f64 {
    move |x| law.correlation(0.4 * x, x)
}

fn table() {
    use CorrelationLaw::{AtImageDisplacement, AtPeak};
    println!("   s   |   x   | printed | first in focus | peak");
    for (s, x) in [
        (0.1, 0.0),
        (0.25, 0.0),
        (0.5, 0.0),
        (0.0, 0.1875),
        (0.0, 0.5),
        (0.0, 1.43),
        (0.1, 0.625),
        (0.26, 0.66),
    ] {
        let [focus, peak] = [AtImageDisplacement, AtPeak].map(|law| law.correlation(s, x));
        let paper = printed(s, x);
        println!(" {s:5.2} | {x:5.2} |{paper:8.4} |{focus:15.4} |{peak:8.4}");
    }
}

fn plots() -> io::Result<()> {
    use CorrelationLaw::{AtImageDisplacement, AtPeak};
    let shift = vec![
        curve("correct", "steelblue", 1.2, pupil_overlap_correlation),
        curve("as printed", "crimson", 1.2, |s| printed(s, 0.0)),
    ];
    let axial = vec![
        curve("correct", "steelblue", 2.5, axial_correlation),
        curve("as printed", "crimson", 2.5, |x| printed(0.0, x)),
    ];
    let both = vec![
        curve(
            "first in focus",
            "darkorange",
            1.5,
            slanted(AtImageDisplacement),
        ),
        curve("peak", "seagreen", 1.5, slanted(AtPeak)),
        curve("as printed", "crimson", 1.5, |x| printed(0.4 * x, x)),
    ];
    let left = "correlation of intensity";
    for (name, title, x, plots) in [
        (
            "shift",
            "Motion across the pupil",
            "pupil displacement / D",
            shift,
        ),
        (
            "axial",
            "Motion along the axis",
            "axial displacement / 8λ(L/D)²",
            axial,
        ),
        (
            "both",
            "Both, 0.4 D per 8λ(L/D)²",
            "axial displacement / 8λ(L/D)²",
            both,
        ),
    ] {
        let path = plot::write(&format!("decorrelation_{name}"), title, [x, left], plots)?;
        println!("{}", path.display());
    }
    Ok(())
}

fn main() -> Result<(), Box<dyn Error>> {
    println!("Correlation left by s pupil diameters and x axial decorrelation lengths 8λ(L/D)²");
    table();
    plots()?;
    Ok(())
}
