//! Frames as files hold them.

use std::path::Path;

use tem00_numerics::Grid;

use super::super::common::ImageError;

/// The text entry that holds the bits of a grey value.
pub(super) const BIT_DEPTH: &str = "bit_depth";

/// The bits that a grey value may have.
pub(super) const BIT_DEPTHS: [u32; 5] = [8, 10, 12, 14, 16];

/// The bytes that it takes to keep a pixel as a number, to find lines there and to draw them.
pub(super) const BYTES_PER_PIXEL: usize = 24;

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
    pub(super) largest: u16,
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

/// The bit depth that a text entry states, if it is one.
pub(super) fn stated_bit_depth(text: &str) -> Option<u32> {
    let bits = text.trim().parse().ok()?;
    BIT_DEPTHS.contains(&bits).then_some(bits)
}
