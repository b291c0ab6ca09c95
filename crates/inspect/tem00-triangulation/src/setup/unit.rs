use core::f64::consts::PI;

use tem00_config::{ANGLE, DURATION, Dimension, LENGTH, NUMBER, POWER};

/// Unit in which people read and write a quantity.
#[derive(Debug)]
pub struct QuantityUnit {
    /// The symbol in files, in ASCII; empty for numbers.
    pub symbol: &'static str,
    /// The symbol in texts, behind a value; empty for numbers.
    pub shown: &'static str,
    /// The symbol as a divisor of another unit, as in µm/K.
    pub divisor: &'static str,
    /// Its size in SI units, or in pixels.
    pub size: f64,
    /// The SI unit of the quantity, as headings of files end with it; empty for numbers.
    pub si: &'static str,
    /// The SI unit of the quantity, as the D-SI writes it.
    pub d_si: &'static str,
    /// The counted things, where the quantity is a number of them.
    pub counted: Option<&'static str>,
    /// The kind of quantity.
    pub dimension: &'static Dimension,
}

impl QuantityUnit {
    const fn of(
        dimension: &'static Dimension,
        [symbol, shown]: [&'static str; 2],
        size: f64,
        [si, d_si]: [&'static str; 2],
    ) -> Self {
        Self {
            symbol,
            shown,
            divisor: shown,
            size,
            si,
            d_si,
            counted: None,
            dimension,
        }
    }

    const fn length(symbol: &'static str, shown: &'static str, size: f64) -> Self {
        Self::of(&LENGTH, [symbol, shown], size, ["m", "\\metre"])
    }

    const fn number(divisor: &'static str, d_si: &'static str) -> Self {
        Self {
            divisor,
            ..Self::of(&NUMBER, ["", ""], 1.0, ["", d_si])
        }
    }

    const fn count(things: &'static str) -> Self {
        Self {
            counted: Some(things),
            ..PLAIN
        }
    }
}

pub(crate) const MILLIMETRES: QuantityUnit = QuantityUnit::length("mm", "mm", 1e-3);
pub(crate) const MICROMETRES: QuantityUnit = QuantityUnit::length("um", "µm", 1e-6);
pub(crate) const NANOMETRES: QuantityUnit = QuantityUnit::length("nm", "nm", 1e-9);
/// Heights of reliefs: files have them next to correlation lengths.
pub(crate) const RELIEF: QuantityUnit = QuantityUnit {
    symbol: "um",
    ..NANOMETRES
};
pub(crate) const DEGREES: QuantityUnit =
    QuantityUnit::of(&ANGLE, ["deg", "°"], PI / 180.0, ["rad", "\\radian"]);
pub(crate) const MILLIRADIANS: QuantityUnit =
    QuantityUnit::of(&ANGLE, ["mrad", "mrad"], 1e-3, ["rad", "\\radian"]);
pub(crate) const MILLIWATTS: QuantityUnit =
    QuantityUnit::of(&POWER, ["mW", "mW"], 1e-3, ["W", "\\watt"]);
pub(crate) const MILLISECONDS: QuantityUnit =
    QuantityUnit::of(&DURATION, ["ms", "ms"], 1e-3, ["s", "\\second"]);
pub(crate) const PLAIN: QuantityUnit = QuantityUnit::number("1", "\\one");
pub(crate) const PERCENT: QuantityUnit = QuantityUnit::of(&NUMBER, ["", "%"], 0.01, ["", "\\one"]);
pub(crate) const PIXELS: QuantityUnit = QuantityUnit {
    counted: Some("in pixels"),
    ..QuantityUnit::of(&NUMBER, ["", "px"], 1.0, ["", "\\one"])
};
/// The position of a line.
pub(crate) const LINE_PIXELS: QuantityUnit = QuantityUnit {
    counted: Some("error of the position of the line, in pixels"),
    ..PIXELS
};
pub(crate) const ELECTRONS: QuantityUnit = QuantityUnit::count("in electrons");
pub(crate) const GREY_VALUES: QuantityUnit = QuantityUnit::count("in grey values");
pub(crate) const GREY_PER_ELECTRON: QuantityUnit = QuantityUnit::count("grey values per electron");
pub(crate) const ELECTRONS_PER_SECOND: QuantityUnit = QuantityUnit {
    counted: Some("electrons per second"),
    ..QuantityUnit::number("1", "\\second\\tothe{-1}")
};
pub(crate) const KELVINS: QuantityUnit = QuantityUnit::number("K", "\\kelvin");
pub(crate) const PER_METRE: QuantityUnit = QuantityUnit::number("m⁻¹", "\\metre\\tothe{-1}");
pub(crate) const PER_KELVIN: QuantityUnit = QuantityUnit::number("K⁻¹", "\\kelvin\\tothe{-1}");
