//! The series in files: frames as PNG, and the list of them that evaluations read.

use std::{error::Error, fmt::Write, fs, path::Path};

use tem00::triangulation::{RawFrame, SensorDescription};

use super::{Exposure, SIZE, Series, WAVELENGTH, description, frame_file};

/// Writes all frames, the list of them, and what was put in.
pub(crate) fn write(folder: &Path, series: &Series) -> Result<(), Box<dyn Error>> {
    fs::create_dir_all(folder)?;
    let bits = description().bit_depth;
    let mut list = format!("v 4.0\nn {bits} {} {}\n", SIZE[0], SIZE[1]);
    let mut add = |heading: String, name: String, frames: &[RawFrame]| {
        writeln!(list, "{heading}")?;
        for (index, frame) in frames.iter().enumerate() {
            let file = format!("{name}_{index:02}.png");
            frame_file::write(&folder.join(&file), frame)?;
            writeln!(list, "i {file}")?;
        }
        Ok::<(), Box<dyn Error>>(())
    };
    let mut add_both = |at: &Exposure, name: &str| {
        let photons = at.photons;
        // Exposure times in ns.
        let time = 1e9 * at.time;
        add(
            format!("b {time:.3} {photons:.6}"),
            format!("bright_{name}"),
            &at.bright,
        )?;
        add(format!("d {time:.3}"), format!("dark_{name}"), &at.dark)
    };
    for (index, pair) in series.pairs.iter().enumerate() {
        add_both(pair, &format!("{index:02}"))?;
    }
    add_both(&series.stacks, "stack")?;
    fs::write(folder.join("emva1288.txt"), list)?;
    fs::write(
        folder.join("sensor.json"),
        put_in(&description(), series.irradiance),
    )?;
    Ok(())
}

fn put_in(d: &SensorDescription, irradiance: f64) -> String {
    let entries = [
        ("quantum_efficiency", d.quantum_efficiency),
        ("gain", d.gain),
        ("dark_noise", d.dark_noise),
        ("dark_current", d.dark_current),
        ("full_well", d.full_well),
        ("prnu", d.prnu),
        ("dsnu", d.dsnu),
        ("pixel_pitch", d.pixel_pitch),
        ("wavelength", WAVELENGTH),
        ("irradiance", irradiance),
    ];
    let lines = entries.map(|(name, value)| format!("  \"{name}\": {value:e}"));
    format!("{{\n{}\n}}\n", lines.join(",\n"))
}
