//! My part is plastic: how far below its surface does a sensor see it?
//!
//! ```sh
//! cargo run --release --example my_part_is_plastic
//! ```
//!
//! Light enters the part, is scattered below the surface, and leaves beside the line. What a height
//! is off by depends on the transport length of the material and on how the line is detected.

#![expect(clippy::print_stdout, reason = "an example prints its answer")]

mod plot;

use std::error::Error;

use kuva::prelude::{LinePlot, Plot};
use tem00::triangulation::{
    Budget, DetectorSettings, LineMethod, Setup, SetupDescription, SetupSurface, Subsurface,
    TriangulationError,
};

/// Transport lengths, in metres: from dense white bodies to skin.
const LENGTHS: [f64; 10] = [
    0.02e-3, 0.05e-3, 0.1e-3, 0.15e-3, 0.2e-3, 0.3e-3, 0.4e-3, 0.6e-3, 0.8e-3, 1e-3,
];

/// Detectors, their windows in pixels, and the colours of their curves.
const DETECTORS: [(&str, LineMethod, usize, &str); 3] = [
    (
        "centre of gravity, ± 1.6 mm",
        LineMethod::IteratedCentreOfGravity,
        71,
        "steelblue",
    ),
    (
        "centre of gravity, ± 0.2 mm",
        LineMethod::IteratedCentreOfGravity,
        9,
        "darkorange",
    ),
    ("parabola at the peak", LineMethod::Parabola, 3, "seagreen"),
];

/// Returns the error of a height that is not corrected, in metres.
fn height(length: f64, method: LineMethod, window: usize) -> Result<f64, TriangulationError> {
    let like = SetupDescription::default();
    let setup = SetupDescription {
        auto_exposure: true,
        detector: DetectorSettings {
            method,
            window,
            ..like.detector
        },
        surface: SetupSurface {
            subsurface: Subsurface {
                transport_length: length,
                // Of a thousand transport lengths of its path, light is left with a third.
                absorption: 1e-3 / length,
                ..Subsurface::default()
            },
            ..like.surface
        },
        ..like
    };
    let budget = Budget::new(&Setup::new(setup)?)?;
    Ok(budget.subsurface().map_or(0.0, |shift| shift.height))
}

fn main() -> Result<(), Box<dyn Error>> {
    println!("a line of 0.2 mm, a camera at 30°: heights without correction, in µm");
    let millimetres = LENGTHS.map(|length| format!("{:7.2}", 1e3 * length));
    println!("{:<28}{}", "transport length in mm", millimetres.join(""));
    let mut plots: Vec<Plot> = Vec::new();
    for (name, method, window, colour) in DETECTORS {
        let heights: Vec<f64> = LENGTHS
            .into_iter()
            .map(|length| Ok(1e6 * height(length, method, window)?))
            .collect::<Result<_, TriangulationError>>()?;
        let shown = heights.iter().map(|height| format!("{height:7.1}"));
        println!("{name:<28}{}", shown.collect::<String>());
        let points = LENGTHS.map(|length| 1e3 * length).into_iter().zip(heights);
        let line = LinePlot::new().with_data(points).with_color(colour);
        plots.push(line.with_legend(name).into());
    }
    // All light without absorption: −ℓ* cos α / n.
    let law = |length: f64| -1e6 * length * 30_f64.to_radians().cos() / 1.5;
    let points = LENGTHS.map(|length| (1e3 * length, law(length)));
    let line = LinePlot::new().with_data(points).with_color("dimgray");
    plots.push(
        line.with_dashed()
            .with_legend("all light, no absorption")
            .into(),
    );
    let path = plot::write(
        "plastic_shift",
        "A part that lets light in reads too low",
        ["transport length (mm)", "height without correction (µm)"],
        plots,
    )?;
    println!("{}", path.display());
    Ok(())
}
