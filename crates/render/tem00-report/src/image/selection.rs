//! The choice of a component of the pixels.

use png::ColorType;

use super::common::ImageError;

/// The components of a pixel of a file.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Components {
    Grey,
    GreyAlpha,
    Rgb,
    Rgba,
    /// Number of unnamed channels, at most 16.
    Bands(u16),
}

/// The names of components of which nothing is known.
const BANDS: [&str; 16] = [
    "1", "2", "3", "4", "5", "6", "7", "8", "9", "10", "11", "12", "13", "14", "15", "16",
];

impl Components {
    /// Returns the names of the components, in order.
    pub(super) fn names(self) -> &'static [&'static str] {
        match self {
            Self::Bands(count) => &BANDS[..usize::from(count).min(BANDS.len())],
            Self::Grey => &["Y"],
            Self::GreyAlpha => &["Y", "A"],
            Self::Rgb => &["R", "G", "B"],
            Self::Rgba => &["R", "G", "B", "A"],
        }
    }

    const fn is_grey(self) -> bool {
        matches!(self, Self::Grey | Self::GreyAlpha)
    }
}

impl From<ColorType> for Components {
    /// A palette counts as the colours in it.
    fn from(colour: ColorType) -> Self {
        match colour {
            ColorType::Grayscale => Self::Grey,
            ColorType::GrayscaleAlpha => Self::GreyAlpha,
            ColorType::Rgb | ColorType::Indexed => Self::Rgb,
            ColorType::Rgba => Self::Rgba,
        }
    }
}

/// The choice among the components of a pixel.
pub(super) struct Selection {
    pub(super) components: usize,
    pub(super) chosen: core::ops::Range<usize>,
    pub(super) description: String,
}

impl Selection {
    /// Takes the component of the name `channel`, or without one the grey value or all colours,
    /// never alpha.
    pub(super) fn new(of: Components, channel: Option<&str>) -> Result<Self, ImageError> {
        let names = of.names();
        let (chosen, description) = match channel {
            None if matches!(of, Components::Bands(_)) => {
                let names = names.iter().map(|name| (*name).to_owned());
                return Err(ImageError::NoChannel(names.collect()));
            }
            None if of.is_grey() => (0..1, "grey".to_owned()),
            None => (0..3, "mean of R, G and B".to_owned()),
            Some(wanted) => {
                let index = names
                    .iter()
                    .position(|name| name.eq_ignore_ascii_case(wanted))
                    .ok_or_else(|| ImageError::Channel {
                        wanted: wanted.to_owned(),
                        available: names.iter().map(|name| (*name).to_owned()).collect(),
                    })?;
                (index..index + 1, format!("channel {}", names[index]))
            }
        };
        Ok(Self {
            components: names.len(),
            chosen,
            description,
        })
    }
}
