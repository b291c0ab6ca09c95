//! How evenly does a laser line light what it falls on: cylinder lens against Powell lens?
//!
//! Compares the irradiance along two lines of the same power, fan angle and thickness, and what of
//! the power a sensor that sees 100 mm of the line can use.

#![expect(clippy::print_stdout, reason = "an example prints its answer")]

mod plot;

use std::error::Error;

use kuva::prelude::{LinePlot, Plot};
use tem00::beam::{DVec3, FanGeometry, FocusCurve, GaussianBeam, LaserLine, LineProfile, Refusal};

const DISTANCE: f64 = 0.2;
const HALF_FIELD: f64 = 50e-3;

fn line(profile: LineProfile) -> Result<LaserLine, Refusal> {
    let fan = FanGeometry {
        fan_angle: 30_f64.to_radians(),
        apex_offset: 2e-3,
        focus_distance: DISTANCE,
        focus_curve: FocusCurve::EqualPlane,
    };
    LaserLine::new(GaussianBeam::from_waist(650e-9, 0.1e-3)?, fan, profile)
}

/// The irradiance per watt on the middle of the line, in m⁻², at the position `x` along it.
fn irradiance(line: &LaserLine, x: f64) -> f64 {
    line.irradiance_per_watt(DVec3::new(x, 0.0, DISTANCE))
}

fn main() -> Result<(), Box<dyn Error>> {
    println!("A 30° line, 0.2 mm thick at 200 mm, of which a sensor sees 100 mm");
    println!("lens     | power in the field | darkest / brightest in the field");
    let mut plots: Vec<Plot> = Vec::new();
    for (name, colour, profile) in [
        ("cylinder", "steelblue", LineProfile::GaussianTan),
        ("Powell", "crimson", LineProfile::Powell { edge: 0.05 }),
    ] {
        let line = line(profile)?;
        let share = line.power_on_length(-HALF_FIELD, HALF_FIELD, DISTANCE);
        let evenness = irradiance(&line, HALF_FIELD) / irradiance(&line, 0.0);
        println!("{name:<8} | {:>17.1}% | {evenness:.3}", 100.0 * share);

        let curve = (-400..=400).map(|i| {
            let x = 80e-3 * f64::from(i) / 400.0;
            (x * 1e3, irradiance(&line, x) * 1e-4)
        });
        let curve = LinePlot::new().with_data(curve).with_color(colour);
        plots.push(curve.with_legend(name).into());
    }
    let axes = ["position along the line / mm", "irradiance per watt / cm⁻²"];
    let path = plot::write(
        "line_profile",
        "Cylinder lens against Powell lens",
        axes,
        plots,
    )?;
    println!("{}", path.display());
    Ok(())
}
