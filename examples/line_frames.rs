//! Frames of a laser line as a camera gives them, to try line detectors on.
//!
//! ```sh
//! cargo run --release --example line_frames -- [FOLDER]
//! tem00-inspect lines out/line_frames/*_12_bit.png --bits 12
//! ```
//!
//! One line, slightly curved, of 12 pixels full width: without speckle, with speckle of 2 pixels,
//! and with speckle in the noise of 8 bits. The folder is `out/line_frames` without one.

#![expect(clippy::print_stdout, reason = "an example prints its answer")]

mod frame_file;

use std::{env, error::Error, fs, path::PathBuf};

use tem00::triangulation::{LineImage, LineImageData, Sensor, SensorDescription};

const LINE: LineImageData = LineImageData {
    size: [240, 96],
    width: 12.0,
    blur: 0.0,
    // A quarter of a full well at the peak of the line; bright speckles have several times as much.
    column_electrons: 20_000.0,
    speckle_size: [2.0, 2.0],
    sensitive_side: 1.0,
    patterns: 1,
    polarisation: 1.0,
};

/// The place of the line along a column, in pixels.
fn place(along: f64) -> f64 {
    45.0 + 0.02 * along + 6.0 * (along / 40.0).sin()
}

fn main() -> Result<(), Box<dyn Error>> {
    let folder = env::args_os()
        .nth(1)
        .map_or("out/line_frames".into(), PathBuf::from);
    fs::create_dir_all(&folder)?;
    let line = LineImage::new(LINE)?;
    let sensor = |bits| Sensor::new(SensorDescription::typical(bits));
    let frames = [
        ("smooth_12_bit.png", line.mean(place), sensor(12)?),
        ("speckled_12_bit.png", line.speckled(1, place)?, sensor(12)?),
        ("speckled_8_bit.png", line.speckled(2, place)?, sensor(8)?),
    ];
    println!("frame               | largest value / DN | saturated pixels");
    for ((name, electrons, sensor), seed) in frames.iter().zip(0..) {
        let frame = sensor.expose(electrons, seed)?;
        let largest = frame.values.values().iter().max().copied().unwrap_or(0);
        println!("{name:19} | {largest:18} | {}", frame.saturated_pixels());
        frame_file::write(&folder.join(name), &frame)?;
    }
    println!("{}", folder.display());
    Ok(())
}
