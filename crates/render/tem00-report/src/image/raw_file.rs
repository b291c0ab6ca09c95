//! Images of cameras: grey values in DN, as the converter gave them, in PNG, TIFF, JPEG, BMP, PGM
//! and PPM files. Frames are written as PNG or TIFF.
//!
//! Files that are written have 8 or 16 bits per value. Values of 10, 12 and 14 bits stand in files
//! of 16 bits as they are, not scaled up; a text entry `bit_depth` says so. The chunk sBIT of PNG
//! means the opposite, values scaled up to 16 bits, and is undone in files of other programs.

mod bmp_frame;
mod curve;
mod frame;
mod jpeg_frame;
mod png_frame;
mod pnm_frame;
mod samples;
#[cfg(test)]
mod tests;
mod tiff_frame;
mod tiff_packed;
mod tiff_pixels;

use std::{
    fs::File,
    io::{BufRead, BufWriter, Seek, SeekFrom},
    path::Path,
};

use tem00_numerics::check_memory;

use self::curve::StoredCurve;
use self::frame::{BIT_DEPTH, stated_bit_depth};
pub use self::frame::{GreyFrame, RawFormat, RawImage};
pub(super) use self::{
    frame::{BIT_DEPTHS, BYTES_PER_PIXEL},
    samples::Samples,
};
use super::common::{
    ImageError, MAX_DEFLATION, check_length, check_room, checked_area, name_of, open,
};
use super::orientation;
use super::selection::Components;
use crate::atomic::write_atomically;

/// Reads a frame.
///
/// `channel` picks one channel of a coloured file; without it the mean of R, G and B is taken. Grey
/// values are taken as they are, regardless of the curve that the file names, and rows are the rows
/// of the sensor, regardless of the orientation for display. `bits` is the bit depth of the camera,
/// if it is known.
///
/// # Errors
///
/// Returns an error if the file cannot be read, has none of the formats, is cut, empty or too
/// large, or has pixels that are not supported.
pub fn read_raw(
    path: &Path,
    channel: Option<&str>,
    bits: Option<u32>,
) -> Result<RawImage, ImageError> {
    let format = RawFormat::of_path(path).ok_or_else(|| ImageError::RawFormat(name_of(path)))?;
    read_samples(path, format)?.judged(bits)?.image(channel)
}

/// Reads all components of all pixels.
pub(super) fn read_samples(path: &Path, format: RawFormat) -> Result<Samples, ImageError> {
    decode(open(path)?, format)
}

/// Decodes a file.
pub(super) fn decode(
    mut reader: impl BufRead + Seek,
    format: RawFormat,
) -> Result<Samples, ImageError> {
    let read = match format {
        RawFormat::Png => return png_frame::read(reader),
        RawFormat::Tiff => tiff_frame::read,
        RawFormat::Jpeg => jpeg_frame::read,
        RawFormat::Bmp => bmp_frame::read,
        RawFormat::Pnm => pnm_frame::read,
    };
    let length = reader.seek(SeekFrom::End(0))?;
    reader.rewind()?;
    check_memory(length)?;
    let mut file = Vec::new();
    reader.read_to_end(&mut file)?;
    read(file)
}

/// Writes a frame as PNG or TIFF, as the name says. Each pair of `text` becomes a text entry.
///
/// # Errors
///
/// Returns an error if the name asks for another format or the file cannot be written.
pub fn write_raw(
    path: &Path,
    frame: GreyFrame<'_>,
    text: &[(&str, String)],
) -> Result<(), ImageError> {
    let format = RawFormat::of_path(path);
    write_atomically(path, |writer: &mut BufWriter<File>| match format {
        Some(RawFormat::Png) => png_frame::write(writer, frame, text),
        Some(RawFormat::Tiff) => tiff_frame::write(writer, frame, text),
        _ => Err(ImageError::FrameFormat(name_of(path))),
    })
}
