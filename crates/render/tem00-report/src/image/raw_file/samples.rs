use tem00_numerics::{Crop, Grid, cast::to_f32};

use super::super::{
    common::{ImageError, LoadedImage, Reading, grid},
    orientation::turned,
    saturation::saturation_level,
    selection::{Components, Selection},
};
use super::{
    curve::{Curve, StoredCurve},
    frame::{RawImage, count},
};

/// The samples of a file before a channel is chosen.
pub(in crate::image) struct Samples {
    pub(super) width: usize,
    pub(super) height: usize,
    pub(super) components: Components,
    /// Components of all pixels, in DN.
    pub(super) values: Vec<f32>,
    /// The bits of a grey value, as the file says or as it stores them; `None` for numbers without
    /// a largest value.
    pub(super) bit_depth: Option<u32>,
    /// The relation of grey values to light, from the file.
    pub(super) curve: StoredCurve,
    /// The orientation in which the image is to be shown, from 1 (as stored) to 8.
    pub(super) orientation: u16,
    /// The name of the chosen component, where the reader has chosen.
    pub(super) name: Option<String>,
    /// Further remarks on the file.
    pub(super) remark: String,
    pub(super) has_further_images: bool,
}

impl Samples {
    /// Returns the samples of a file without further information.
    pub(super) fn new(
        [width, height]: [usize; 2],
        components: Components,
        values: Vec<f32>,
        bit_depth: Option<u32>,
    ) -> Self {
        Self {
            width,
            height,
            components,
            values,
            bit_depth,
            curve: StoredCurve::Unknown,
            orientation: 1,
            name: None,
            remark: String::new(),
            has_further_images: false,
        }
    }

    /// Returns numbers that are light, as their reader has chosen them.
    pub(in crate::image) fn of_light(
        size: [usize; 2],
        components: Components,
        values: Vec<f32>,
        name: String,
    ) -> Self {
        Self {
            curve: StoredCurve::Light,
            name: Some(name),
            ..Self::new(size, components, values, None)
        }
    }

    /// Determines the value from which on pixels are saturated; the user may know the bit depth of
    /// the camera.
    ///
    /// # Errors
    ///
    /// Returns an error if the file has fewer bits, or a grey value is larger than these allow.
    pub(in crate::image) fn judged(self, bits: Option<u32>) -> Result<JudgedSamples, ImageError> {
        let mut samples = self;
        let largest = samples.values.iter().copied().fold(0.0, f32::max);
        if let Some(expected) = bits {
            if let Some(found) = samples.bit_depth.filter(|found| expected > *found) {
                return Err(ImageError::FewerBits { expected, found });
            }
            if largest > full_scale(expected) {
                let found = largest;
                return Err(ImageError::Bits { expected, found });
            }
        }
        // A file that claims fewer bits than its values have does not know its bit depth.
        let own = samples.bit_depth;
        let known = own.map(|own| if largest <= full_scale(own) { own } else { 16 });
        samples.bit_depth = bits.or(known);
        let full = samples.bit_depth.map(full_scale);
        let components = samples.components.names().len();
        let level = |component: usize| match bits {
            Some(bits) => full_scale(bits),
            None => {
                let values = samples.values.iter().skip(component).step_by(components);
                saturation_level(values.copied(), full)
            }
        };
        let levels = (0..components).map(level).collect();
        Ok(JudgedSamples { samples, levels })
    }

    /// Turns the image to the orientation in which it is to be shown.
    pub(in crate::image) fn upright(mut self) -> Self {
        if self.orientation == 1 {
            return self;
        }
        let components = self.components.names().len();
        let size = [self.width, self.height];
        (self.values, [self.width, self.height]) =
            turned(&self.values, size, components, self.orientation);
        self.remark.push_str(", turned as the file says");
        self
    }
}

/// Samples, and the value from which on each component is saturated.
pub(in crate::image) struct JudgedSamples {
    samples: Samples,
    levels: Vec<f32>,
}

impl JudgedSamples {
    /// Returns the part of the pixels in a rectangle; the whole image determines what is saturated.
    pub(in crate::image) fn cropped(self, crop: Crop) -> Result<Self, ImageError> {
        let whole = &self.samples;
        let (width, height) = (whole.width, whole.height);
        if !crop.lies_in([width, height]) {
            return Err(ImageError::Crop {
                crop,
                width,
                height,
            });
        }
        let components = whole.components.names().len();
        let row = |y: usize| {
            let start = components * (y * whole.width + crop.x);
            &whole.values[start..start + components * crop.width]
        };
        let rows = (crop.y..crop.y + crop.height).flat_map(row);
        let samples = Samples {
            values: rows.copied().collect(),
            width: crop.width,
            height: crop.height,
            ..self.samples
        };
        Ok(Self { samples, ..self })
    }

    /// Returns grey values in DN: of `channel`, or the mean of R, G and B.
    pub(in crate::image) fn image(self, channel: Option<&str>) -> Result<RawImage, ImageError> {
        let selection = Selection::new(self.samples.components, channel)?;
        let values = self.pixels(&selection).map(mean).collect();
        let samples = &self.samples;
        let stated = samples.curve.of_grey_values();
        Ok(RawImage {
            values: grid(samples.width, samples.height, values)?,
            saturated: self.saturated(&selection)?,
            bit_depth: samples.bit_depth,
            interpretation: format!("{}{stated}", self.description(&selection, "")),
            orientation: samples.orientation,
            has_further_images: samples.has_further_images,
        })
    }

    /// Returns the light: in units of the largest value that the grey values can hold, if there is
    /// one. The options of `reading` override the information in the file.
    pub(in crate::image) fn light(self, reading: &Reading<'_>) -> Result<LoadedImage, ImageError> {
        let samples = &self.samples;
        let selection = Selection::new(samples.components, reading.channel)?;
        let curve = Curve::new(samples.curve, reading.transfer)?;
        let full = samples
            .bit_depth
            .map_or(1.0, |bits| full_scale(bits).into());
        let linear = |value: f64| curve.linear(value / full);
        let table: Option<Vec<f64>> = samples.bit_depth.map(|bits| {
            (0..1_u32 << bits)
                .map(|value| linear(value.into()))
                .collect()
        });
        let light = |value: f32| match &table {
            Some(table) => table[whole(value)],
            None => linear(value.into()),
        };
        let black = reading.black_level.unwrap_or(0.0);
        let dark = linear(black);
        let mean_light = |pixel: &[f32]| {
            let sum: f64 = pixel.iter().map(|&value| light(value)).sum();
            to_f32(sum / pixel.len() as f64 - dark)
        };
        let values = self.pixels(&selection).map(mean_light).collect();
        let largest = self.pixels(&selection).map(largest_of).fold(0.0, f32::max);
        if black > 0.0 && black >= largest.into() {
            return Err(ImageError::BlackLevel {
                black_level: black,
                largest: largest.into(),
            });
        }
        let coloured = self.pixels(&selection).any(|pixel| {
            pixel
                .iter()
                .any(|value| value.to_bits() != pixel[0].to_bits())
        });
        let differ = if coloured {
            ", which differ: light of one colour may want one channel"
        } else {
            ""
        };
        let saturated = self.saturated(&selection)?;
        let share = count(&saturated) as f64 / saturated.values().len() as f64;
        let is_linear = curve.is_linear();
        let step = self.step(&selection).filter(|_| is_linear);
        Ok(LoadedImage {
            values: grid(samples.width, samples.height, values)?,
            interpretation: format!(
                "{}{}",
                self.description(&selection, differ),
                curve.description()
            ),
            saturated: self.is_judged(&selection).then_some(share),
            unit: is_linear.then_some(1.0 / full),
            step: step.map(|step| f64::from(step) / full),
        })
    }

    /// Returns the chosen components of each pixel.
    fn pixels<'a>(&'a self, selection: &'a Selection) -> impl Iterator<Item = &'a [f32]> {
        let pixels = self.samples.values.chunks_exact(selection.components);
        pixels.map(|pixel| &pixel[selection.chosen.clone()])
    }

    /// Returns the pixels of which a chosen component is saturated.
    fn saturated(&self, selection: &Selection) -> Result<Grid<bool>, ImageError> {
        let levels = &self.levels[selection.chosen.clone()];
        let is_saturated = |pixel: &[f32]| {
            pixel
                .iter()
                .zip(levels)
                .any(|(value, level)| value >= level)
        };
        let saturated = self.pixels(selection).map(is_saturated).collect();
        grid(self.samples.width, self.samples.height, saturated)
    }

    /// Returns whether it is known from which value on a chosen component is saturated.
    fn is_judged(&self, selection: &Selection) -> bool {
        let mut levels = self.levels[selection.chosen.clone()].iter();
        levels.all(|level| level.is_finite())
    }

    /// Returns a description of what was taken from the file, and of the value from which on it
    /// counts as saturated where that is not its largest value.
    fn description(&self, selection: &Selection, differ: &str) -> String {
        let samples = &self.samples;
        let bits = samples
            .bit_depth
            .map_or_else(String::new, |bits| format!(", {bits} bits"));
        let full = samples.bit_depth.map_or(f32::INFINITY, full_scale);
        let mut below: Vec<f32> = self.levels[selection.chosen.clone()].to_vec();
        below.retain(|level| *level < full);
        below.dedup_by(|a, b| a.to_bits() == b.to_bits());
        let below: Vec<String> = below.iter().map(ToString::to_string).collect();
        let level = if below.is_empty() {
            String::new()
        } else {
            format!(
                ", saturated at {}, where its values end",
                below.join(" and ")
            )
        };
        let taken = samples.name.as_ref().unwrap_or(&selection.description);
        let remark = &samples.remark;
        format!("{taken}{differ}{bits}{remark}{level}")
    }

    /// Returns the smallest difference of two grey values of one chosen component, if they are
    /// whole numbers.
    fn step(&self, selection: &Selection) -> Option<f32> {
        let bits = self.samples.bit_depth?;
        let steps = (0..selection.chosen.len()).filter_map(|component| {
            let mut seen = vec![false; 1 << bits];
            self.pixels(selection)
                .for_each(|pixel| seen[whole(pixel[component])] = true);
            let seen: Vec<usize> = (0..seen.len()).filter(|&value| seen[value]).collect();
            seen.windows(2).map(|pair| pair[1] - pair[0]).min()
        });
        steps.min().map(|step| step as f32)
    }
}

/// Returns the largest grey value of `bit_depth` bits.
pub(super) const fn full_scale(bit_depth: u32) -> f32 {
    ((1_u32 << bit_depth) - 1) as f32
}

/// The index of a grey value, which is a whole number of at most 16 bits.
#[expect(
    clippy::cast_possible_truncation,
    clippy::cast_sign_loss,
    reason = "grey values of files with bits are whole numbers from 0 to 65535"
)]
const fn whole(value: f32) -> usize {
    value as usize
}

fn largest_of(pixel: &[f32]) -> f32 {
    pixel.iter().copied().fold(0.0, f32::max)
}

/// The mean of a few grey values.
fn mean(values: &[f32]) -> f32 {
    let sum: f64 = values.iter().map(|&value| f64::from(value)).sum();
    to_f32(sum / values.len() as f64)
}
