//! A photon transfer series of a simulated sensor: what was put in comes back.
//!
//! ```sh
//! cargo run --release --example photon_transfer -- [FOLDER]
//! ```
//!
//! Frames of even light and darkness after EMVA 1288: pairs over the exposure time, up to
//! saturation, and two stacks for the differences between pixels. The folder, `out/photon_transfer`
//! without one, gets the frames, `emva1288.txt`, which lists them for programs that evaluate such
//! series, and `sensor.json`, which says what was put in.

#![expect(clippy::print_stdout, reason = "an example prints its answer")]

mod files;
#[path = "../frame_file/mod.rs"]
mod frame_file;
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

/// The exposures, as fractions of the one that fills the wells. The last but two stays 1.5 % below
/// it, as far as shot noise and the pixels' responses spread: no well is full yet, and in the next
/// all are.
fn exposures() -> impl Iterator<Item = f64> {
    (1..=35).map(|step| 0.985 / 33.0 * f64::from(step))
}

/// Bright and dark frames of one exposure time, in seconds.
struct Exposure {
    time: f64,
    photons: f64,
    bright: Vec<RawFrame>,
    dark: Vec<RawFrame>,
}

/// The pairs of all exposure times under one irradiance, in W/m², and the stacks of one in the
/// middle.
struct Series {
    irradiance: f64,
    pairs: Vec<Exposure>,
    stacks: Exposure,
}

/// A camera under even light that numbers its frames.
struct Camera {
    irradiance: f64,
    frames: u64,
}

impl Camera {
    /// Takes bright frames and as many dark ones.
    fn take(
        &mut self,
        sensor: &Sensor,
        count: u64,
    ) -> Result<[Vec<RawFrame>; 2], TriangulationError> {
        let electrons = sensor.electrons(self.irradiance, WAVELENGTH);
        let first = self.frames;
        self.frames += 2 * count;
        let frames = |electrons, first| {
            let seeds = first..first + count;
            let frames = seeds.map(|seed| sensor.uniform_frame(SIZE, electrons, seed));
            frames.collect::<Result<Vec<RawFrame>, _>>()
        };
        Ok([frames(electrons, first)?, frames(0.0, first + count)?])
    }
}

fn take() -> Result<Series, TriangulationError> {
    let irradiance = Sensor::new(description())?.saturation_irradiance(WAVELENGTH);
    let mut camera = Camera {
        irradiance,
        frames: 0,
    };
    let mut exposure = |fraction: f64, count| {
        let exposure_time = fraction * FULL;
        let sensor = Sensor::new(SensorDescription {
            exposure_time,
            ..description()
        })?;
        let [bright, dark] = camera.take(&sensor, count)?;
        let photons = sensor.photons(irradiance, WAVELENGTH);
        Ok::<_, TriangulationError>(Exposure {
            time: exposure_time,
            photons,
            bright,
            dark,
        })
    };
    Ok(Series {
        irradiance,
        pairs: exposures()
            .map(|fraction| exposure(fraction, 2))
            .collect::<Result<_, _>>()?,
        stacks: exposure(0.5, STACK)?,
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
