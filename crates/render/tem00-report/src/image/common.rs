//! The errors, options and sizes of image files.

use std::{
    fs::File,
    io::{self, BufReader},
    path::Path,
};

use tem00_config::open_input;
use tem00_numerics::{Crop, Grid, MemoryError, check_memory};
use thiserror::Error;

use crate::kind::of_ending;

/// The maximum number of pixels that are read from a file: 2²⁸, which is 1 GiB of `f32`.
pub(super) const MAXIMUM_PIXELS: u64 = 1 << 28;

/// The maximum size of an image file, in bytes: 8 GiB, enough for `MAXIMUM_PIXELS` complex numbers
/// and a header.
pub(super) const MAX_IMAGE_BYTES: u64 = 8 << 30;

/// The maximum number of bytes that a byte of compressed data stands for (zlib, Technical Details).
pub(super) const MAX_DEFLATION: u64 = 1032;

/// The formats of patterns, distinguished by the end of the file's name.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Format {
    /// 16-bit grey or colour, for the eye.
    Png,
    /// OpenEXR, `f32` layers.
    Exr,
    /// A NumPy array.
    Npy,
}

impl Format {
    /// Returns the format that the name of `path` asks for.
    pub fn of_path(path: &Path) -> Option<Self> {
        let known = [("png", Self::Png), ("exr", Self::Exr), ("npy", Self::Npy)];
        of_ending(path, &known)
    }
}

/// The relation of grey values to light.
#[derive(Clone, Copy, Debug, PartialEq, Eq, clap::ValueEnum)]
pub enum Transfer {
    /// In proportion to the light, as sensors deliver them.
    Linear,
    /// sRGB curve, as in pictures for the screen.
    Srgb,
}

/// Options for reading an image.
#[derive(Clone, Copy, Debug, Default)]
pub struct Reading<'a> {
    /// Channel by name; by default Y, the mean of R, G and B, or the only one that contains light.
    pub channel: Option<&'a str>,
    /// The relation of grey values to light, instead of the relation in the file.
    pub transfer: Option<Transfer>,
    /// The black level, in grey values of the file, to be subtracted.
    pub black_level: Option<f64>,
    /// A part of the image.
    pub crop: Option<Crop>,
}

/// An image in proportion to the light, and how it was understood.
#[derive(Debug)]
pub struct LoadedImage {
    /// Values, one per pixel.
    pub values: Grid<f32>,
    /// A description of what was read from the file and how.
    pub interpretation: String,
    /// The fraction of saturated pixels, where the saturation level is known.
    pub saturated: Option<f64>,
    /// The light of one grey value of the file, where the values are in proportion to the light.
    pub unit: Option<f64>,
    /// The light of the smallest difference of two grey values of one channel, likewise.
    pub step: Option<f64>,
}

/// Errors of reading or writing an image file.
#[derive(Debug, Error)]
pub enum ImageError {
    #[error("{0}")]
    Io(#[from] io::Error),
    #[error("not a readable PNG file: {0}")]
    PngDecoding(#[from] png::DecodingError),
    #[error("{0}")]
    PngEncoding(#[from] png::EncodingError),
    #[error("TIFF: {0}")]
    Tiff(#[from] tiff::TiffError),
    #[error("OpenEXR: {0}")]
    Exr(#[from] exr::error::Error),
    #[error("{0}")]
    Npy(#[from] crate::npy::NpyError),
    #[error("not a readable JPEG file: {0}")]
    Jpeg(#[from] zune_jpeg::errors::DecodeErrors),
    #[error("not a readable BMP file: its headers are wrong, or it is cut off")]
    Bmp,
    #[error("not a readable PGM or PPM file: {0}")]
    Pnm(&'static str),
    #[error("{0} is not supported: use .png, .tif, .jpg, .bmp, .pgm, .exr or .npy")]
    Format(String),
    #[error("{0} is not supported: use .png, .tif, .jpg, .bmp or .pgm")]
    RawFormat(String),
    #[error("{0} cannot hold a frame: use .png or .tif")]
    FrameFormat(String),
    #[error("not a readable JPEG file: it ends before its last pixel")]
    CutJpeg,
    #[error("{0} are not supported: docs/program.md lists what is read")]
    Pixels(String),
    #[error("--bits {expected}: grey values of the file have {found} bits; leave --bits out")]
    FewerBits { expected: u32, found: u32 },
    #[error(
        "--bits {expected}: grey values are then at most {}, but there is one of {found}",
        (1_u32 << .expected) - 1
    )]
    Bits { expected: u32, found: f32 },
    #[error(
        "the file names the transfer function {0} of ITU-T H.273, which is not supported: \
             --transfer linear or --transfer srgb takes another"
    )]
    Transfer(u8),
    #[error("the image has {width} × {height} pixels; between 1 and {MAXIMUM_PIXELS} are allowed")]
    Size { width: u64, height: u64 },
    #[error(
        "--crop {},{},{},{} must lie in the image of {width} × {height} pixels",
        crop.x, crop.y, crop.width, crop.height
    )]
    Crop {
        crop: Crop,
        width: usize,
        height: usize,
    },
    #[error("{0}")]
    Memory(#[from] MemoryError),
    #[error("the image has {width} × {height} pixels, which the file of {bytes} bytes cannot hold")]
    Cut { width: u64, height: u64, bytes: u64 },
    #[error("the array has the shape {0:?}; two dimensions, height × width, are needed")]
    Shape(Vec<u64>),
    #[error(
        "values of the type {0} are not supported: use integers, floating-point or complex \
         numbers, or bool"
    )]
    ValueType(String),
    #[error("there is no channel {wanted}; the file has {}", available.join(", "))]
    Channel {
        wanted: String,
        available: Vec<String>,
    },
    #[error("several channels may be meant; name one by --channel: {}", .0.join(", "))]
    NoChannel(Vec<String>),
    #[error("the pixel ({x}, {y}) is {value}; images of light hold numbers of 0 to 3.4e38{help}")]
    Value {
        x: usize,
        y: usize,
        value: f32,
        help: &'static str,
    },
    #[error("--black-level {black_level} is not below the largest value of the image, {largest}")]
    BlackLevel { black_level: f64, largest: f64 },
}

/// Opens a file of an image.
pub fn open(path: &Path) -> io::Result<BufReader<File>> {
    open_input(path, MAX_IMAGE_BYTES).map(BufReader::new)
}

/// Returns the name of a file, for messages.
pub(super) fn name_of(path: &Path) -> String {
    path.file_name().map_or_else(
        || path.display().to_string(),
        |name| name.to_string_lossy().into_owned(),
    )
}

/// Returns the number of pixels, or an error if there are none or too many.
pub(super) fn checked_area(width: u64, height: u64) -> Result<usize, ImageError> {
    width
        .checked_mul(height)
        .filter(|area| (1..=MAXIMUM_PIXELS).contains(area))
        .and_then(|area| usize::try_from(area).ok())
        .ok_or(ImageError::Size { width, height })
}

/// Checks that a file is long enough for its pixels, of which at most `pixels_per_byte` fit into a
/// byte.
pub(super) fn check_length(
    [width, height]: [u64; 2],
    bytes: u64,
    pixels_per_byte: u64,
) -> Result<(), ImageError> {
    if width.saturating_mul(height) / pixels_per_byte.max(1) <= bytes {
        return Ok(());
    }
    Err(ImageError::Cut {
        width,
        height,
        bytes,
    })
}

/// Checks that memory is available for `area` pixels of `bytes_per_pixel` bytes each.
pub(super) fn check_room(area: usize, bytes_per_pixel: usize) -> Result<(), ImageError> {
    Ok(check_memory(
        (area as u64).saturating_mul(bytes_per_pixel as u64),
    )?)
}

/// Returns the grid of values whose number was checked against the size before.
pub(super) fn grid<T>(width: usize, height: usize, values: Vec<T>) -> Result<Grid<T>, ImageError> {
    Grid::from_vec(width, height, values).map_err(|_| ImageError::Size {
        width: width as u64,
        height: height as u64,
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn absurd_sizes_are_refused_before_memory_is_taken() {
        assert!(checked_area(1_000_000, 1_000_000).is_err(), "too large");
        assert!(checked_area(u64::MAX, 2).is_err(), "the product overflows");
        assert!(checked_area(0, 5).is_err(), "empty");
        assert_eq!(checked_area(1 << 14, 1 << 14).ok(), Some(1 << 28));
    }
}
