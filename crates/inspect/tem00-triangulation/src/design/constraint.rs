use super::DesignFigures;
use crate::{
    QuantityUnit,
    named::named,
    setup::{
        MAX_GRAIN_SATURATION, MIN_SIGNAL,
        unit::{MICROMETRES, MILLIMETRES, MILLISECONDS, MILLIWATTS, PERCENT, PLAIN},
    },
};

/// Declares the figures, whose names are the fields of [`DesignFigures`] with their values.
macro_rules! figures {
    ($($(#[$doc:meta])* $figure:ident = $field:ident, is_gain: $gain:literal, $unit:expr;)+) => {
        named! {
            /// A figure of merit of a set-up.
            #[derive(Hash)]
            #[non_exhaustive]
            DesignFigure { $($(#[$doc])* $figure = stringify!($field),)+ }
        }

        impl DesignFigure {
            /// The names of all of them.
            pub(crate) const NAMES: [&str; Self::ALL.len()] = [$(stringify!($field)),+];

            /// Returns the value of a set-up, in SI units.
            pub const fn value_in(self, figures: &DesignFigures) -> f64 {
                match self {
                    $(Self::$figure => figures.$field,)+
                }
            }

            /// Returns true if more of it is better: such a figure is bounded from below, others
            /// from above.
            pub const fn is_gain(self) -> bool {
                match self {
                    $(Self::$figure => $gain,)+
                }
            }

            /// Returns the unit that it is usually read and written in.
            pub const fn unit(self) -> &'static QuantityUnit {
                match self {
                    $(Self::$figure => &$unit,)+
                }
            }
        }
    };
}

figures! {
    /// The combined standard uncertainty of a height on the reference plane, in metres.
    Uncertainty = uncertainty, is_gain: false, MICROMETRES;
    /// The expanded uncertainty of a height on the reference plane, in metres.
    ExpandedUncertainty = expanded_uncertainty, is_gain: false, MICROMETRES;
    /// The length of the range of heights that can be measured, in metres.
    Range = range, is_gain: true, MILLIMETRES;
    /// The depth of field of camera and laser line together, in metres of height.
    DepthOfField = depth_of_field, is_gain: true, MILLIMETRES;
    /// The width of the field, in metres.
    FieldWidth = field_width, is_gain: true, MILLIMETRES;
    /// The power in the line, in watts.
    Power = power, is_gain: false, MILLIWATTS;
    /// The exposure time, in seconds.
    Exposure = exposure, is_gain: false, MILLISECONDS;
    /// The mean of the brightest pixel as a fraction of what the sensor can hold.
    Saturation = saturation, is_gain: false, PERCENT;
    /// The bright grains of speckle as a fraction of what the sensor can hold.
    GrainSaturation = grain_saturation, is_gain: false, PERCENT;
    /// The mean of the brightest pixel divided by its noise in the dark.
    Signal = signal, is_gain: true, PLAIN;
}

/// A bound that a set-up must keep.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Constraint {
    /// The bounded figure.
    pub figure: DesignFigure,
    /// The minimum of a [gain](DesignFigure::is_gain), the maximum of any other figure, in SI
    /// units.
    pub bound: f64,
}

/// The fraction of what the sensor can hold that the mean of the brightest pixel may fill: it
/// leaves room for noise where there is hardly any speckle.
const MAX_SATURATION: f64 = 0.9;

impl Constraint {
    /// The constraints of a search that names none: set-ups that keep them get the light that they
    /// need, by [`Setup::light_level`](crate::Setup::light_level), which uses two of them as its
    /// bounds.
    pub const LIGHT: [Self; 3] = [
        Self {
            figure: DesignFigure::Saturation,
            bound: MAX_SATURATION,
        },
        Self {
            figure: DesignFigure::GrainSaturation,
            bound: MAX_GRAIN_SATURATION,
        },
        Self {
            figure: DesignFigure::Signal,
            bound: MIN_SIGNAL,
        },
    ];

    /// Returns true if the bound is kept. To reach it is to keep it.
    pub fn is_kept(&self, figures: &DesignFigures) -> bool {
        let value = self.figure.value_in(figures);
        if self.figure.is_gain() {
            value >= self.bound
        } else {
            value <= self.bound
        }
    }

    /// Returns the fraction of the bound by which it is missed; 0 if it is kept.
    pub fn excess(&self, figures: &DesignFigures) -> f64 {
        if self.is_kept(figures) {
            return 0.0;
        }
        (self.figure.value_in(figures) / self.bound - 1.0).abs()
    }
}
