//! Where does a lens focus a laser beam, and how small is the focus?
//!
//! Not where geometrical optics says: a waist in the front focal plane has its image in the back
//! one, not at infinity, and no image is farther away than `f + f² / (2 z_R)`. Compares the closed
//! form of Self 1983 with the ABCD law for an ideal lens and for a real, thick one.

#![expect(clippy::print_stdout, reason = "an example prints its answer")]

mod plot;

use std::error::Error;

use kuva::prelude::{LinePlot, Plot};
use tem00::beam::{GaussianBeam, LocatedBeam, Refusal};
use tem00::optics::{AbcdMatrix, ThickLens, through_lens};

const FOCAL_LENGTH: f64 = 0.1;

/// A beam whose Rayleigh range is `rayleigh_range`, its waist `distance` before the lens.
fn before_lens(rayleigh_range: f64, distance: f64) -> Result<LocatedBeam, Refusal> {
    let waist_radius = (650e-9 * rayleigh_range / core::f64::consts::PI).sqrt();
    LocatedBeam::new(GaussianBeam::from_waist(650e-9, waist_radius)?, -distance)
}

/// The distance from a thin lens to the new waist, and the radius there, as Self gives them.
fn self_1983(beam: &LocatedBeam) -> [f64; 2] {
    let before = -beam.waist_distance() / FOCAL_LENGTH - 1.0;
    let depth = beam.beam().rayleigh_range() / FOCAL_LENGTH;
    let denominator = before * before + depth * depth;
    let distance = FOCAL_LENGTH * (1.0 + before / denominator);
    [distance, beam.beam().waist_radius() / denominator.sqrt()]
}

fn main() -> Result<(), Box<dyn Error>> {
    let ideal = AbcdMatrix::thin_lens(FOCAL_LENGTH)?;
    // An equiconvex lens of BK7, 4 mm thick, with nearly the same focal length.
    let real = AbcdMatrix::thick_lens(&ThickLens {
        index: 1.5143,
        front_curvature: 9.785,
        back_curvature: -9.785,
        thickness: 4e-3,
    })?;

    println!("A beam of 0.2 mm waist radius 300 mm before a lens of f = 100 mm");
    println!("                     | waist behind lens / mm | waist radius / µm");
    let beam = LocatedBeam::new(GaussianBeam::from_waist(650e-9, 0.2e-3)?, -0.3)?;
    let of = |focus: LocatedBeam| [focus.waist_distance(), focus.beam().waist_radius()];
    for (name, [distance, radius]) in [
        ("closed form (Self)", self_1983(&beam)),
        ("ABCD, thin lens", of(ideal.transform(&beam)?)),
        ("ABCD, thick lens", of(real.transform(&beam)?)),
    ] {
        let [distance, radius] = [distance * 1e3, radius * 1e6];
        println!("{name:<20} | {distance:>22.3} | {radius:>17.3}");
    }

    let mut plots: Vec<Plot> = Vec::new();
    for (relative, colour) in [(0.05, "crimson"), (0.25, "darkorange"), (1.0, "steelblue")] {
        let focus = (-200..=400).map(|i| {
            let s = f64::from(i) / 100.0;
            let beam = before_lens(relative * FOCAL_LENGTH, s * FOCAL_LENGTH)?;
            let behind = through_lens(&beam, FOCAL_LENGTH)?.waist_distance();
            Ok((s, behind / FOCAL_LENGTH))
        });
        let focus = focus.collect::<Result<Vec<_>, Refusal>>()?;
        let curve = LinePlot::new().with_data(focus).with_color(colour);
        plots.push(curve.with_legend(format!("z_R = {relative} f")).into());
    }
    let axes = ["waist before the lens / f", "waist behind the lens / f"];
    let path = plot::write("focus_by_lens", "Focus of a Gaussian beam", axes, plots)?;
    println!("{}", path.display());
    Ok(())
}
