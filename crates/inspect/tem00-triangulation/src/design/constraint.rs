use core::fmt;

use super::DesignFigures;
use crate::{
    QuantityUnit,
    setup::{
        MAX_GRAIN_SATURATION, MIN_SIGNAL,
        unit::{MICROMETRES, MILLIMETRES, MILLISECONDS, MILLIWATTS, PERCENT, PLAIN},
    },
};

/// A figure of merit of a set-up.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
#[non_exhaustive]
pub enum DesignFigure {
    /// The combined standard uncertainty of a height on the reference plane, in metres.
    Uncertainty,
    /// The expanded uncertainty of a height on the reference plane, in metres.
    ExpandedUncertainty,
    /// The length of the range of heights that can be measured, in metres.
    Range,
    /// The depth of field of camera and laser line together, in metres of height.
    DepthOfField,
    /// The width of the field, in metres.
    FieldWidth,
    /// The power in the line, in watts.
    Power,
    /// The exposure time, in seconds.
    Exposure,
    /// The mean of the brightest pixel as a part of what the sensor can hold.
    Saturation,
    /// The bright grains of speckle as a part of what the sensor can hold.
    GrainSaturation,
    /// The mean of the brightest pixel by its noise in the dark.
    Signal,
}

/// Declaration of a figure.
struct Row {
    name: &'static str,
    value: fn(&DesignFigures) -> f64,
    /// True if more of it is better.
    is_gain: bool,
    unit: &'static QuantityUnit,
}

const fn row(
    name: &'static str,
    value: fn(&DesignFigures) -> f64,
    is_gain: bool,
    unit: &'static QuantityUnit,
) -> Row {
    Row {
        name,
        value,
        is_gain,
        unit,
    }
}

/// The figures, in their order.
const ROWS: [Row; DesignFigure::ALL.len()] = [
    row("uncertainty", |f| f.uncertainty, false, &MICROMETRES),
    row(
        "expanded_uncertainty",
        |f| f.expanded_uncertainty,
        false,
        &MICROMETRES,
    ),
    row("range", |f| f.range, true, &MILLIMETRES),
    row("depth_of_field", |f| f.depth_of_field, true, &MILLIMETRES),
    row("field_width", |f| f.field_width, true, &MILLIMETRES),
    row("power", |f| f.power, false, &MILLIWATTS),
    row("exposure", |f| f.exposure, false, &MILLISECONDS),
    row("saturation", |f| f.saturation, false, &PERCENT),
    row("grain_saturation", |f| f.grain_saturation, false, &PERCENT),
    row("signal", |f| f.signal, true, &PLAIN),
];

impl DesignFigure {
    /// All of them.
    pub const ALL: [Self; 10] = [
        Self::Uncertainty,
        Self::ExpandedUncertainty,
        Self::Range,
        Self::DepthOfField,
        Self::FieldWidth,
        Self::Power,
        Self::Exposure,
        Self::Saturation,
        Self::GrainSaturation,
        Self::Signal,
    ];

    /// The names of all of them.
    pub(crate) const NAMES: [&str; Self::ALL.len()] = {
        let mut names = [""; Self::ALL.len()];
        let mut index = 0;
        while index < names.len() {
            names[index] = ROWS[index].name;
            index += 1;
        }
        names
    };

    /// Returns the name, as set-up files have it.
    pub const fn name(self) -> &'static str {
        ROWS[self as usize].name
    }

    /// Returns the value of a set-up, in SI units.
    pub fn value_in(self, figures: &DesignFigures) -> f64 {
        (ROWS[self as usize].value)(figures)
    }

    /// Returns true if more of it is better: such a figure is bounded from below, others from above.
    pub const fn is_gain(self) -> bool {
        ROWS[self as usize].is_gain
    }

    /// Returns the unit that it is usually read and written in.
    pub const fn unit(self) -> &'static QuantityUnit {
        ROWS[self as usize].unit
    }
}

impl fmt::Display for DesignFigure {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(self.name())
    }
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

/// The part of what the sensor can hold that the mean of the brightest pixel may fill: it leaves room for
/// noise where there is hardly any speckle.
const MAX_SATURATION: f64 = 0.9;

impl Constraint {
    /// The constraints of a search that names none: set-ups that keep them get the light that they need,
    /// by [`Setup::light_level`](crate::Setup::light_level), whose bounds two of them are.
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

    /// Returns by which part of the bound it is missed; 0 if it is kept.
    pub fn excess(&self, figures: &DesignFigures) -> f64 {
        if self.is_kept(figures) {
            return 0.0;
        }
        (self.figure.value_in(figures) / self.bound - 1.0).abs()
    }
}
