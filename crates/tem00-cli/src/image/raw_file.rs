//! Frames of cameras: grey values in DN, as the converter gave them, in PNG and TIFF files.
//!
//! Files have 8 or 16 bits per value. Values of 10, 12 and 14 bits stand in files of 16 bits as they
//! are, not scaled up; a text entry `bit_depth` says so. The chunk sBIT of PNG means the opposite,
//! values scaled up to 16 bits, and is undone in the files of others.

mod png_frame;
#[cfg(test)]
mod tests;
mod tiff_frame;

use std::{
    fs::File,
    io::{BufReader, BufWriter},
    path::Path,
};

use tem00_numerics::Grid;
use tem00_triangulation::RawFrame;

use super::selection::{Components, Selection};
use super::{ImageError, checked_area, grid};
use crate::atomic::write_atomically;

/// The text entry that holds the bits of a grey value.
const BIT_DEPTH: &str = "bit_depth";

/// The bits that a grey value may have.
const BIT_DEPTHS: [u32; 5] = [8, 10, 12, 14, 16];

/// A frame as a file holds it.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct RawImage {
    /// The grey values, in DN.
    pub(crate) values: Grid<f32>,
    /// The bits of a grey value.
    pub(crate) bit_depth: u32,
    /// The number of pixels of which a chosen channel has the largest grey value.
    pub(crate) saturated: usize,
    /// What was taken from the file, in words.
    pub(crate) interpretation: String,
    /// Whether the file has images after this one.
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
                told: bit_depth,
                found: self.bit_depth,
            });
        }
        self.bit_depth = bit_depth;
        if f64::from(self.largest) > self.saturation() {
            return Err(ImageError::Bits {
                told: bit_depth,
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
#[derive(Clone, Copy)]
enum RawFormat {
    Png,
    Tiff,
}

impl RawFormat {
    fn of_path(path: &Path) -> Result<Self, ImageError> {
        let extension = path.extension().and_then(|extension| extension.to_str());
        let known = [
            ("png", Self::Png),
            ("tif", Self::Tiff),
            ("tiff", Self::Tiff),
        ];
        known
            .into_iter()
            .find(|(name, _)| extension.is_some_and(|e| e.eq_ignore_ascii_case(name)))
            .map(|(_, format)| format)
            .ok_or_else(|| {
                ImageError::RawFormat(path.file_name().map_or_else(
                    || path.display().to_string(),
                    |name| name.to_string_lossy().into_owned(),
                ))
            })
    }
}

/// Reads a frame of 8 to 16 bits.
///
/// `channel` picks one channel of a coloured file; without it the mean of R, G and B is taken. Grey
/// values are taken as they are, whatever curve the file names.
///
/// # Errors
///
/// Returns an error if the file cannot be read, is no PNG or TIFF, is cut, empty or too large, or has
/// pixels that are not supported.
pub(crate) fn read_raw(path: &Path, channel: Option<&str>) -> Result<RawImage, ImageError> {
    let format = RawFormat::of_path(path)?;
    let reader = BufReader::new(File::open(path)?);
    let samples = match format {
        RawFormat::Png => png_frame::read(reader),
        RawFormat::Tiff => tiff_frame::read(reader),
    }?;
    samples.image(channel)
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
    let format = RawFormat::of_path(path)?;
    write_atomically(path, |writer: &mut BufWriter<File>| match format {
        RawFormat::Png => png_frame::write(writer, frame, text),
        RawFormat::Tiff => tiff_frame::write(writer, frame, text),
    })
}

/// What a file holds before a channel is chosen.
struct Samples {
    width: usize,
    height: usize,
    components: Components,
    /// All components of all pixels, in DN.
    values: Vec<u16>,
    /// The bits of a grey value, as the file says or as it stores them.
    bit_depth: u32,
    /// What else is to be said of the file.
    remark: &'static str,
    has_further_images: bool,
}

impl Samples {
    fn image(self, channel: Option<&str>) -> Result<RawImage, ImageError> {
        let selection = Selection::new(self.components, channel)?;
        let pixels = || {
            let pixels = self.values.chunks_exact(selection.components);
            pixels.map(|pixel| &pixel[selection.chosen.clone()])
        };
        let largest_of = |pixel: &[u16]| pixel.iter().copied().max().unwrap_or(0);
        let largest = pixels().map(largest_of).max().unwrap_or(0);
        // A file that claims fewer bits than its values have does not know them.
        let bit_depth = match self.bit_depth {
            told if u32::from(largest) < 1 << told => told,
            _ => 16,
        };
        let full = (1_u32 << bit_depth) - 1;
        let saturated = pixels().filter(|pixel| u32::from(largest_of(pixel)) == full);
        Ok(RawImage {
            saturated: saturated.count(),
            values: grid(self.width, self.height, pixels().map(mean).collect())?,
            bit_depth,
            interpretation: format!("{}, {bit_depth} bits{}", selection.description, self.remark),
            has_further_images: self.has_further_images,
            largest,
        })
    }
}

/// The mean of a few values of 16 bits.
#[expect(
    clippy::cast_possible_truncation,
    clippy::cast_precision_loss,
    reason = "there are up to three values of 16 bits"
)]
fn mean(values: &[u16]) -> f32 {
    let sum: f64 = values.iter().map(|&value| f64::from(value)).sum();
    (sum / values.len() as f64) as f32
}

/// The bit depth that a text entry states, if it is one.
fn stated_bit_depth(text: &str) -> Option<u32> {
    let bits = text.trim().parse().ok()?;
    BIT_DEPTHS.contains(&bits).then_some(bits)
}
