//! Images of cameras: grey values in DN, as the converter gave them, in PNG, TIFF, JPEG, BMP, PGM and PPM
//! files. Frames are written as PNG or TIFF.
//!
//! Files have 8 or 16 bits per value. Values of 10, 12 and 14 bits stand in files of 16 bits as they
//! are, not scaled up; a text entry `bit_depth` says so. The chunk sBIT of PNG means the opposite,
//! values scaled up to 16 bits, and is undone in the files of others.

mod bmp_frame;
#[cfg(test)]
mod camera_formats;
mod jpeg_frame;
mod png_frame;
mod pnm_frame;
mod samples;
#[cfg(test)]
mod tests;
mod tiff_frame;

use std::{
    fs::File,
    io::{BufRead, BufWriter, Seek},
    path::Path,
};

use tem00_numerics::Grid;
use tem00_triangulation::RawFrame;

pub(super) use self::samples::Samples;
use self::samples::StoredCurve;
use super::selection::Components;
use super::{ImageError, check_room, checked_area, name_of, open};
use crate::atomic::write_atomically;

/// The text entry that holds the bits of a grey value.
const BIT_DEPTH: &str = "bit_depth";

/// The bits that a grey value may have.
const BIT_DEPTHS: [u32; 5] = [8, 10, 12, 14, 16];

/// The bytes that it takes to keep a pixel as a number, to find lines there and to draw them.
const BYTES_PER_PIXEL: usize = 24;

/// A frame as a file holds it.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct RawImage {
    /// The grey values, in DN.
    pub(crate) values: Grid<f32>,
    /// The bits of a grey value.
    pub(crate) bit_depth: u32,
    /// The number of pixels of which a chosen channel has the largest grey value.
    pub(crate) saturated: usize,
    /// A description of what was read from the file.
    pub(crate) interpretation: String,
    /// `true` if the file has images after this one.
    pub(crate) has_further_images: bool,
    /// The largest grey value of a chosen channel, in DN.
    largest: u16,
}

impl RawImage {
    /// Returns the grey value at which a pixel is saturated: the largest that the bits allow, in DN.
    pub(crate) fn saturation(&self) -> f64 {
        f64::from(self.bit_depth).exp2() - 1.0
    }

    /// Returns the frame as one of another bit depth, for files that do not know theirs.
    ///
    /// # Errors
    ///
    /// Returns an error if the file has fewer bits, or a grey value is larger than `bit_depth` bits allow.
    pub(crate) fn with_bit_depth(mut self, bit_depth: u32) -> Result<Self, ImageError> {
        if bit_depth > self.bit_depth {
            return Err(ImageError::FewerBits {
                expected: bit_depth,
                found: self.bit_depth,
            });
        }
        self.bit_depth = bit_depth;
        if f64::from(self.largest) > self.saturation() {
            return Err(ImageError::Bits {
                expected: bit_depth,
                found: self.largest,
            });
        }
        #[expect(
            clippy::cast_possible_truncation,
            reason = "grey values of at most 16 bits"
        )]
        let full = self.saturation() as f32;
        self.saturated = self.values.values().iter().filter(|&&v| v >= full).count();
        Ok(self)
    }
}

/// The formats of frames, told apart by the end of the file's name.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum RawFormat {
    Png,
    Tiff,
    Jpeg,
    Bmp,
    Pnm,
}

impl RawFormat {
    const KNOWN: [(&str, Self); 10] = [
        ("png", Self::Png),
        ("tif", Self::Tiff),
        ("tiff", Self::Tiff),
        ("jpg", Self::Jpeg),
        ("jpeg", Self::Jpeg),
        ("bmp", Self::Bmp),
        ("dib", Self::Bmp),
        ("pgm", Self::Pnm),
        ("ppm", Self::Pnm),
        ("pnm", Self::Pnm),
    ];

    /// Returns the format that the name of `path` asks for.
    pub(crate) fn of_path(path: &Path) -> Option<Self> {
        let extension = path.extension()?.to_str()?;
        let mut known = Self::KNOWN.into_iter();
        known
            .find(|(name, _)| extension.eq_ignore_ascii_case(name))
            .map(|(_, format)| format)
    }
}

/// Reads a frame of 8 to 16 bits.
///
/// `channel` picks one channel of a coloured file; without it the mean of R, G and B is taken. Grey
/// values are taken as they are, whatever curve the file names.
///
/// # Errors
///
/// Returns an error if the file cannot be read, is none of the formats, is cut, empty or too large, or has
/// pixels that are not supported.
pub(crate) fn read_raw(path: &Path, channel: Option<&str>) -> Result<RawImage, ImageError> {
    let format = RawFormat::of_path(path).ok_or_else(|| ImageError::RawFormat(name_of(path)))?;
    read_samples(path, format)?.image(channel)
}

/// Reads all components of all pixels.
pub(super) fn read_samples(path: &Path, format: RawFormat) -> Result<Samples, ImageError> {
    decode(open(path)?, format)
}

/// Decodes a file.
pub(super) fn decode(
    reader: impl BufRead + Seek,
    format: RawFormat,
) -> Result<Samples, ImageError> {
    match format {
        RawFormat::Png => png_frame::read(reader),
        RawFormat::Tiff => tiff_frame::read(reader),
        RawFormat::Jpeg => jpeg_frame::read(reader),
        RawFormat::Bmp => bmp_frame::read(reader),
        RawFormat::Pnm => pnm_frame::read(reader),
    }
}

/// Writes a frame as PNG or TIFF, as the name says. Each pair of `text` becomes a text entry.
///
/// # Errors
///
/// Returns an error if the name asks for another format or the file cannot be written.
pub(crate) fn write_raw(
    path: &Path,
    frame: &RawFrame,
    text: &[(&str, String)],
) -> Result<(), ImageError> {
    let format = RawFormat::of_path(path);
    write_atomically(path, |writer: &mut BufWriter<File>| match format {
        Some(RawFormat::Png) => png_frame::write(writer, frame, text),
        Some(RawFormat::Tiff) => tiff_frame::write(writer, frame, text),
        _ => Err(ImageError::FrameFormat(name_of(path))),
    })
}

/// The bit depth that a text entry states, if it is one.
fn stated_bit_depth(text: &str) -> Option<u32> {
    let bits = text.trim().parse().ok()?;
    BIT_DEPTHS.contains(&bits).then_some(bits)
}
