use tem00_numerics::cast::to_f32;
use tem00_tracer::Crop;

use super::super::{
    common::{ImageError, LoadedImage, Transfer, check_inside, grid},
    selection::{Components, Selection},
};
use super::frame::RawImage;
use crate::colour::srgb_decoded;

/// The samples of a file before a channel is chosen.
pub(in crate::image) struct Samples {
    pub(super) width: usize,
    pub(super) height: usize,
    pub(super) components: Components,
    /// All components of all pixels, in DN.
    pub(super) values: Vec<u16>,
    /// The bits of a grey value, as the file says or as it stores them.
    pub(super) bit_depth: u32,
    /// The relation of grey values to light, from the file.
    pub(super) curve: StoredCurve,
    /// A further remark on the file.
    pub(super) remark: &'static str,
    pub(super) has_further_images: bool,
}

/// The relation of grey values to light, from a file.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum StoredCurve {
    Unknown,
    Srgb,
    /// Grey values are light to this power.
    Gamma(f64),
}

impl Samples {
    /// Returns the part of the pixels in a rectangle.
    pub(in crate::image) fn cropped(self, crop: Crop) -> Result<Self, ImageError> {
        check_inside(crop, [self.width, self.height])?;
        let components = self.components.names().len();
        let row = |y: usize| {
            let start = components * (y * self.width + crop.x);
            &self.values[start..start + components * crop.width]
        };
        let rows = (crop.y..crop.y + crop.height).flat_map(row);
        Ok(Self {
            values: rows.copied().collect(),
            width: crop.width,
            height: crop.height,
            ..self
        })
    }

    /// Returns grey values in DN: of `channel`, or the mean of R, G and B.
    pub(super) fn image(self, channel: Option<&str>) -> Result<RawImage, ImageError> {
        let selection = Selection::new(self.components, channel)?;
        let largest = self
            .pixels(&selection)
            .map(largest_of)
            .max()
            .unwrap_or_default();
        let bit_depth = self.bit_depth_of(largest);
        Ok(RawImage {
            saturated: self.saturated(&selection, bit_depth),
            values: grid(
                self.width,
                self.height,
                self.pixels(&selection).map(mean).collect(),
            )?,
            bit_depth,
            interpretation: format!("{}, {bit_depth} bits{}", selection.description, self.remark),
            has_further_images: self.has_further_images,
            largest,
        })
    }

    /// Returns the light in units of the largest that the grey values can hold; `transfer` overrules
    /// what the file says of them.
    pub(in crate::image) fn light(
        self,
        channel: Option<&str>,
        transfer: Option<Transfer>,
    ) -> Result<LoadedImage, ImageError> {
        let selection = Selection::new(self.components, channel)?;
        let largest = self
            .pixels(&selection)
            .map(largest_of)
            .max()
            .unwrap_or_default();
        let bit_depth = self.bit_depth_of(largest);
        let curve = Curve::new(self.curve, transfer);
        let full = full_scale(bit_depth);
        let light: Vec<f64> = (0..=full)
            .map(|value| curve.linear(f64::from(value) / f64::from(full)))
            .collect();
        let mean_light = |pixel: &[u16]| {
            let sum: f64 = pixel.iter().map(|&value| light[usize::from(value)]).sum();
            to_f32(sum / pixel.len() as f64)
        };
        let values = self.pixels(&selection).map(mean_light).collect();
        let coloured = self
            .pixels(&selection)
            .any(|pixel| pixel.iter().any(|&value| value != pixel[0]));
        let differ = if coloured {
            ", which differ: light of one colour may want one channel"
        } else {
            ""
        };
        let saturated = self.saturated(&selection, bit_depth);
        Ok(LoadedImage {
            values: grid(self.width, self.height, values)?,
            interpretation: format!(
                "{}{differ}, {bit_depth} bits{}, {}",
                selection.description,
                self.remark,
                curve.description()
            ),
            saturated: Some(saturated as f64 / (self.width * self.height) as f64),
        })
    }

    /// Returns the chosen components of each pixel.
    fn pixels<'a>(&'a self, selection: &'a Selection) -> impl Iterator<Item = &'a [u16]> {
        let pixels = self.values.chunks_exact(selection.components);
        pixels.map(|pixel| &pixel[selection.chosen.clone()])
    }

    /// Returns the bits of grey values: a file that claims fewer than its values have does not know
    /// them.
    const fn bit_depth_of(&self, largest: u16) -> u32 {
        if largest as u32 <= full_scale(self.bit_depth) {
            self.bit_depth
        } else {
            16
        }
    }

    /// Returns the number of pixels of which a chosen component has the largest grey value.
    fn saturated(&self, selection: &Selection, bit_depth: u32) -> usize {
        let full = full_scale(bit_depth);
        self.pixels(selection)
            .filter(|pixel| u32::from(largest_of(pixel)) == full)
            .count()
    }
}

const fn full_scale(bit_depth: u32) -> u32 {
    (1 << bit_depth) - 1
}

fn largest_of(pixel: &[u16]) -> u16 {
    pixel.iter().copied().max().unwrap_or(0)
}

/// The mean of a few values of 16 bits.
fn mean(values: &[u16]) -> f32 {
    let sum: f64 = values.iter().map(|&value| f64::from(value)).sum();
    to_f32(sum / values.len() as f64)
}

/// The relation of grey values to light, and its origin.
enum Curve {
    Linear { told: bool },
    Srgb { told: bool },
    Gamma(f64),
}

impl Curve {
    const fn new(stored: StoredCurve, transfer: Option<Transfer>) -> Self {
        match (transfer, stored) {
            (Some(Transfer::Linear), _) => Self::Linear { told: true },
            (Some(Transfer::Srgb), _) => Self::Srgb { told: true },
            (None, StoredCurve::Srgb) => Self::Srgb { told: false },
            (None, StoredCurve::Gamma(gamma)) => Self::Gamma(gamma),
            (None, StoredCurve::Unknown) => Self::Linear { told: false },
        }
    }

    fn linear(&self, stored: f64) -> f64 {
        match self {
            Self::Linear { .. } => stored,
            Self::Srgb { .. } => srgb_decoded(stored),
            Self::Gamma(gamma) => stored.powf(1.0 / gamma),
        }
    }

    fn description(&self) -> String {
        match self {
            Self::Linear { told: true } => "linear, as asked".into(),
            Self::Linear { told: false } => "taken as linear, the file does not say".into(),
            Self::Srgb { told: true } => "sRGB curve undone, as asked".into(),
            Self::Srgb { told: false } => "sRGB curve undone, as the file says".into(),
            Self::Gamma(gamma) => format!("gamma {gamma} undone, as the file says"),
        }
    }
}
