//! Common to the examples: a frame of a sensor in a file.

use std::{error::Error, fs, io::BufWriter, path::Path};

use png::{BitDepth, ColorType, Encoder};
use tem00::triangulation::RawFrame;

/// Writes the grey values of a frame as PNG, of 8 bits if they have no more and of 16 bits
/// otherwise.
pub(crate) fn write(path: &Path, frame: &RawFrame) -> Result<(), Box<dyn Error>> {
    let (width, height) = (frame.values.width(), frame.values.height());
    let file = BufWriter::new(fs::File::create(path)?);
    let mut encoder = Encoder::new(file, u32::try_from(width)?, u32::try_from(height)?);
    encoder.set_color(ColorType::Grayscale);
    let values = frame.values.values().iter();
    let bytes: Vec<u8> = if frame.bit_depth == 8 {
        values.map(|value| value.to_be_bytes()[1]).collect()
    } else {
        encoder.set_depth(BitDepth::Sixteen);
        values.flat_map(|value| value.to_be_bytes()).collect()
    };
    Ok(encoder.write_header()?.write_image_data(&bytes)?)
}
