//! Frames as files hold them.

use std::path::Path;

use tem00_numerics::Grid;

use crate::kind::of_ending;

/// The text entry that holds the bits of a grey value.
pub(super) const BIT_DEPTH: &str = "bit_depth";

/// The bits that cameras give to grey values.
pub(in crate::image) const BIT_DEPTHS: [u32; 5] = [8, 10, 12, 14, 16];

/// The memory needed to keep a pixel as a number, to find lines there and to draw them, in bytes.
pub(in crate::image) const BYTES_PER_PIXEL: usize = 28;

/// A frame to be written.
#[derive(Clone, Copy, Debug)]
pub struct GreyFrame<'a> {
    /// The grey values, in DN.
    pub values: &'a Grid<u16>,
    /// The bits of a grey value.
    pub bit_depth: u32,
}

/// A frame as a file holds it.
#[derive(Clone, Debug, PartialEq)]
pub struct RawImage {
    /// The grey values, in DN.
    pub values: Grid<f32>,
    /// The bits of a grey value; `None` for numbers without a largest value.
    pub bit_depth: Option<u32>,
    /// The pixels of which a chosen channel is saturated.
    pub saturated: Grid<bool>,
    /// A description of what was read from the file.
    pub interpretation: String,
    /// The way in which viewers turn the image, from 1 (not at all) to 8; here its rows are the
    /// rows of the sensor.
    pub orientation: u16,
    /// `true` if the file has images after this one.
    pub has_further_images: bool,
}

impl RawImage {
    /// Returns the number of saturated pixels.
    pub fn saturated_pixels(&self) -> usize {
        count(&self.saturated)
    }
}

/// Returns the number of pixels that are marked.
pub(super) fn count(marked: &Grid<bool>) -> usize {
    marked.values().iter().filter(|&&is| is).count()
}

/// The formats of frames, distinguished by the end of the file's name.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum RawFormat {
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
    pub fn of_path(path: &Path) -> Option<Self> {
        of_ending(path, &Self::KNOWN)
    }
}

/// The bit depth that a text entry states, if it is one.
pub(super) fn stated_bit_depth(text: &str) -> Option<u32> {
    let bits = text.trim().parse().ok()?;
    BIT_DEPTHS.contains(&bits).then_some(bits)
}
