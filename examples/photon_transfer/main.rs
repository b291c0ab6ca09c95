//! A photon transfer series of a simulated sensor: what was put in comes back.
//!
//! ```sh
//! cargo run --release --example photon_transfer -- [FOLDER]
//! ```
//!
//! Frames of even light and darkness after EMVA 1288: pairs over the exposure time, up to saturation,
//! and two stacks for the differences between pixels. The folder, `out/photon_transfer` without one,
//! gets the frames, `emva1288.txt`, which lists them for programs that evaluate such series, and
//! `sensor.json`, which says what was put in.

#![expect(clippy::print_stdout, reason = "an example prints its answer")]

mod files;
mod measured;
#[path = "../plot/mod.rs"]
mod plot;

use std::{env, error::Error, path::PathBuf};

use kuva::prelude::{LinePlot, Plot, ScatterPlot};
use measured::Measured;
use tem00::triangulation::{RawFrame, Sensor, SensorDescription, TriangulationError};

const SIZE: [usize; 2] = [256, 256];
const WAVELENGTH: f64 = 650e-9;
/// The frames of a stack.
const STACK: u64 = 32;
/// The exposure time that fills the wells to the brim, in seconds.
const FULL: f64 = 10e-3;

/// A scientific CMOS sensor with large pixels.
fn description() -> SensorDescription {
    SensorDescription {
        quantum_efficiency: 0.6,
        gain: 0.161,
        dark_noise: 5.0,
        dark_current: 1_000.0,
        full_well: 100_000.0,
        prnu: 0.003,
        dsnu: 4.0,
        pixel_pitch: 9e-6,
        exposure_time: FULL,
        serial_number: 7,
        ..SensorDescription::typical(14)
    }
}

/// The exposures, as fractions of the one that fills the wells. The last but two stays 1.5 % below it, as
/// far as shot noise and the pixels' responses spread: no well is full yet, and in the next all are.
fn exposures() -> impl Iterator<Item = f64> {
    (1..=35).map(|step| 0.985 / 33.0 * f64::from(step))
}

/// One exposure of the series.
struct Exposure {
    time: f64,
    photons: f64,
    bright: [RawFrame; 2],
    dark: [RawFrame; 2],
}

/// The frames of all exposures under one irradiance, in W/m², and the stacks in the middle of them.
struct Series {
    irradiance: f64,
    exposures: Vec<Exposure>,
    stack_time: f64,
    stack_photons: f64,
    bright: Vec<RawFrame>,
    dark: Vec<RawFrame>,
}

fn take() -> Result<Series, TriangulationError> {
    let irradiance = Sensor::new(description())?.saturation_irradiance(WAVELENGTH);
    let mut seed = 0;
    let mut frames = |sensor: &Sensor, irradiance: f64, count: u64| {
        let electrons = sensor.electrons(irradiance, WAVELENGTH);
        seed += count;
        (seed - count..seed)
            .map(|seed| sensor.uniform_frame(SIZE, electrons, seed))
            .collect::<Result<Vec<RawFrame>, _>>()
    };
    let with = |fraction: f64| {
        Sensor::new(SensorDescription {
            exposure_time: fraction * FULL,
            ..description()
        })
    };
    let mut exposures_taken = Vec::new();
    for fraction in exposures() {
        let sensor = with(fraction)?;
        let mut pair = |irradiance| {
            let pair = frames(&sensor, irradiance, 2)?.try_into();
            pair.map_err(|_| TriangulationError::TooFew {
                what: "frames",
                got: 0,
                needed: 2,
            })
        };
        exposures_taken.push(Exposure {
            time: fraction * FULL,
            photons: sensor.photons(irradiance, WAVELENGTH),
            bright: pair(irradiance)?,
            dark: pair(0.0)?,
        });
    }
    let half = with(0.5)?;
    Ok(Series {
        irradiance,
        exposures: exposures_taken,
        stack_time: half.description().exposure_time,
        stack_photons: half.photons(irradiance, WAVELENGTH),
        bright: frames(&half, irradiance, STACK)?,
        dark: frames(&half, 0.0, STACK)?,
    })
}

fn main() -> Result<(), Box<dyn Error>> {
    let folder = env::args_os()
        .nth(1)
        .map_or("out/photon_transfer".into(), PathBuf::from);
    let series = take()?;
    files::write(&folder, &series)?;
    let measured = Measured::of(&series)?;
    println!("quantity                        | measured | put in");
    for (name, got, put_in) in measured.rows(&description()) {
        println!("{name:31} | {got:8.5} | {put_in}");
    }

    let line = LinePlot::new()
        .with_data(measured.line())
        .with_color("crimson")
        .with_legend(format!("K = {:.4} DN/e⁻", measured.gain));
    let points = ScatterPlot::new()
        .with_data(measured.points.clone())
        .with_color("black")
        .with_legend("pairs of frames");
    let axes = ["mean above dark / DN", "temporal variance above dark / DN²"];
    let title = "photon transfer: the slope is the gain";
    let plots = vec![Plot::Line(line), Plot::Scatter(points)];
    let path = plot::write("photon_transfer", title, axes, plots)?;
    println!("{} and {}", folder.display(), path.display());
    Ok(())
}
