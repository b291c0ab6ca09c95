use super::super::common::{ImageError, Transfer};
use crate::colour::srgb_decoded;

/// The relation of grey values to light, from a file.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum StoredCurve {
    Unknown,
    /// Numbers that are light.
    Light,
    /// A colour profile that is not read.
    Profile,
    Linear,
    Srgb,
    /// Grey values are light to this power.
    Gamma(f64),
    /// The curve of television, ITU-R BT.709.
    Television,
    /// A transfer function of ITU-T H.273 that is not known here.
    Other(u8),
}

impl StoredCurve {
    /// Returns the curve of a transfer function of ITU-T H.273, table 3.
    pub(super) const fn of_code(code: u8) -> Self {
        match code {
            1 | 6 | 14 | 15 => Self::Television,
            2 => Self::Unknown,
            4 => Self::Gamma(1.0 / 2.2),
            5 => Self::Gamma(1.0 / 2.8),
            8 => Self::Linear,
            13 => Self::Srgb,
            _ => Self::Other(code),
        }
    }

    /// Returns the remark for grey values that are taken as they are.
    pub(super) const fn of_grey_values(self) -> &'static str {
        match self {
            Self::Unknown | Self::Light | Self::Linear => "",
            Self::Gamma(gamma) if is_one(gamma) => "",
            Self::Profile => ", as they are: the colour profile of the file is not read",
            _ => ", as they are: the curve that the file names is not undone",
        }
    }
}

/// Returns whether a gamma is 1; files state it in steps of 1e-5.
const fn is_one(gamma: f64) -> bool {
    (gamma - 1.0).abs() < 5e-6
}

/// The relation of grey values to light, and its origin.
pub(super) struct Curve {
    stored: StoredCurve,
    is_told: bool,
}

impl Curve {
    /// Takes the requested relation, or else the relation in the file.
    pub(super) const fn new(
        stored: StoredCurve,
        transfer: Option<Transfer>,
    ) -> Result<Self, ImageError> {
        let stored = match (transfer, stored) {
            (Some(Transfer::Linear), _) => StoredCurve::Linear,
            (Some(Transfer::Srgb), _) => StoredCurve::Srgb,
            (None, StoredCurve::Other(code)) => return Err(ImageError::Transfer(code)),
            (None, stored) => stored,
        };
        Ok(Self {
            stored,
            is_told: transfer.is_some(),
        })
    }

    pub(super) fn is_linear(&self) -> bool {
        use StoredCurve::{Gamma, Light, Linear, Profile, Unknown};
        matches!(self.stored, Unknown | Light | Profile | Linear)
            || matches!(self.stored, Gamma(gamma) if is_one(gamma))
    }

    /// Returns the light of a grey value, both in units of their largest.
    pub(super) fn linear(&self, stored: f64) -> f64 {
        match self.stored {
            StoredCurve::Srgb => srgb_decoded(stored),
            StoredCurve::Gamma(gamma) => stored.powf(1.0 / gamma),
            StoredCurve::Television if stored < 0.081 => stored / 4.5,
            StoredCurve::Television => ((stored + 0.099) / 1.099).powf(1.0 / 0.45),
            _ => stored,
        }
    }

    /// Returns a description of the conversion of grey values, to follow the description of the
    /// values.
    pub(super) fn description(&self) -> String {
        match self.stored {
            StoredCurve::Light => String::new(),
            StoredCurve::Linear if self.is_told => ", linear, as asked".into(),
            StoredCurve::Srgb if self.is_told => ", sRGB curve undone, as asked".into(),
            StoredCurve::Linear => ", linear, as the file says".into(),
            StoredCurve::Srgb => ", sRGB curve undone, as the file says".into(),
            StoredCurve::Gamma(gamma) => format!(", gamma {gamma} undone, as the file says"),
            StoredCurve::Television => ", curve of BT.709 undone, as the file says".into(),
            StoredCurve::Profile => {
                ", taken as linear, for the colour profile of the file is not read".into()
            }
            _ => ", taken as linear, the file does not say".into(),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn transfer_functions_are_those_of_their_standards() {
        let undone = |code| {
            let curve = Curve::new(StoredCurve::of_code(code), None).expect("it is known");
            curve.linear(0.5)
        };
        // BT.709, item 1.2: V = 1.099 L^0.45 − 0.099; IEC 61966-2-1: ((V + 0.055) / 1.055)^2.4.
        for (code, light) in [
            (1, (0.599_f64 / 1.099).powf(1.0 / 0.45)),
            (4, 0.5_f64.powf(2.2)),
            (5, 0.5_f64.powf(2.8)),
            (8, 0.5),
            (13, (0.555_f64 / 1.055).powf(2.4)),
        ] {
            assert!((undone(code) - light).abs() < 1e-12, "{code}");
        }
        for code in [0, 3, 7, 16, 18, 255] {
            let refused = Curve::new(StoredCurve::of_code(code), None);
            let words = refused
                .err()
                .map(|error| error.to_string())
                .unwrap_or_default();
            assert!(
                words.contains(&format!("function {code} ")),
                "{code}: {words}"
            );
            let told = Curve::new(StoredCurve::of_code(code), Some(Transfer::Linear));
            assert!(told.is_ok_and(|curve| curve.is_linear()), "{code}");
        }
    }
}
