/// A kind of quantity, with the units in which a scene file may state it.
///
/// A bare number is in the SI unit; a string is a number followed by a unit.
#[derive(Debug)]
pub struct Dimension {
    /// What a value of this kind is called, with its article.
    pub(super) noun: &'static str,
    /// The plural of the SI unit, for messages.
    pub(super) si_unit: &'static str,
    /// A value as one would write it.
    example: &'static str,
    /// The least positive and the greatest magnitude, in SI units: beyond any apparatus, but far
    /// enough inside the range of `f64` that areas and volumes stay there, too.
    pub(super) magnitudes: (f64, f64),
    units: &'static [Unit],
}

/// A unit and its size in SI units, `multiplier / divisor`.
///
/// Both are exact in `f64`, so that "650 nm" is the same number as `650e-9`.
#[derive(Debug)]
struct Unit {
    symbol: &'static str,
    multiplier: f64,
    divisor: f64,
}

const fn unit(symbol: &'static str, multiplier: f64, divisor: f64) -> Unit {
    Unit {
        symbol,
        multiplier,
        divisor,
    }
}

/// Plain numbers.
pub const NUMBER: Dimension = Dimension {
    noun: "a number",
    si_unit: "",
    example: "0.5",
    magnitudes: (1e-12, 1e12),
    units: &[],
};

/// Lengths, in metres.
pub const LENGTH: Dimension = Dimension {
    noun: "a length",
    si_unit: "metres",
    example: "0.25 mm",
    magnitudes: (1e-12, 1e9),
    units: &[
        unit("nm", 1.0, 1e9),
        unit("um", 1.0, 1e6),
        unit("\u{b5}m", 1.0, 1e6),
        // The Greek letter, which looks the same as the micro sign.
        unit("\u{3bc}m", 1.0, 1e6),
        unit("mm", 1.0, 1e3),
        unit("cm", 1.0, 1e2),
        unit("m", 1.0, 1.0),
    ],
};

/// Angles, in radians.
pub const ANGLE: Dimension = Dimension {
    noun: "an angle",
    si_unit: "radians",
    example: "30 deg",
    magnitudes: (1e-12, 1e6),
    units: &[
        unit("deg", core::f64::consts::PI, 180.0),
        unit("°", core::f64::consts::PI, 180.0),
        unit("mrad", 1.0, 1e3),
        unit("rad", 1.0, 1.0),
    ],
};

/// Powers, in watts.
pub const POWER: Dimension = Dimension {
    noun: "a power",
    si_unit: "watts",
    example: "5 mW",
    magnitudes: (1e-18, 1e12),
    units: &[
        unit("uW", 1.0, 1e6),
        unit("\u{b5}W", 1.0, 1e6),
        unit("\u{3bc}W", 1.0, 1e6),
        unit("mW", 1.0, 1e3),
        unit("W", 1.0, 1.0),
    ],
};

/// Radiances, in W/(m² sr).
pub const RADIANCE: Dimension = Dimension {
    noun: "a radiance",
    si_unit: "W/(m² sr)",
    example: "0.5 W/(m² sr)",
    magnitudes: (1e-18, 1e18),
    units: &[unit("W/(m² sr)", 1.0, 1.0), unit("W/(m2 sr)", 1.0, 1.0)],
};

/// Durations, in seconds.
pub const DURATION: Dimension = Dimension {
    noun: "a duration",
    si_unit: "seconds",
    example: "2 ms",
    magnitudes: (1e-12, 1e9),
    units: &[
        unit("ns", 1.0, 1e9),
        unit("us", 1.0, 1e6),
        unit("\u{b5}s", 1.0, 1e6),
        unit("\u{3bc}s", 1.0, 1e6),
        unit("ms", 1.0, 1e3),
        unit("s", 1.0, 1.0),
    ],
};

/// Amounts of memory, in bytes.
pub const MEMORY: Dimension = Dimension {
    noun: "an amount of memory",
    si_unit: "bytes",
    example: "100 MiB",
    magnitudes: (1.0, 1e18),
    units: &[
        unit("B", 1.0, 1.0),
        unit("kB", 1e3, 1.0),
        unit("MB", 1e6, 1.0),
        unit("GB", 1e9, 1.0),
        unit("KiB", 1_024.0, 1.0),
        unit("MiB", 1_048_576.0, 1.0),
        unit("GiB", 1_073_741_824.0, 1.0),
    ],
};

/// All kinds that have units.
#[cfg(test)]
pub(super) const ALL: [&Dimension; 6] = [&LENGTH, &ANGLE, &POWER, &RADIANCE, &DURATION, &MEMORY];

impl Dimension {
    /// Returns the symbols of all units.
    #[cfg(test)]
    pub(super) fn symbols(&self) -> impl Iterator<Item = &'static str> {
        self.units.iter().map(|unit| unit.symbol)
    }

    /// Returns the value, in SI units, of a string such as "650 nm", or `None` if it is no quantity
    /// of this kind; a number without a unit is none.
    pub fn parse(&self, text: &str) -> Option<f64> {
        let text = text.trim();
        // The unit begins at the first letter that is not part of an exponent.
        let is_number = |c: char| c.is_ascii_digit() || "+-.".contains(c);
        let digits = text.trim_start_matches(is_number);
        let rest = match digits.strip_prefix(['e', 'E']) {
            Some(exponent) if exponent.starts_with(is_number) => {
                exponent.trim_start_matches(is_number)
            }
            _ => digits,
        };
        let (number, symbol) = text.split_at(text.len() - rest.len());
        let value: f64 = number.parse().ok()?;
        let unit = self.unit(symbol)?;
        Some(value * unit.multiplier / unit.divisor)
    }

    /// Returns the size of a unit in SI units, or `None` if it is no unit of this kind.
    pub(super) fn size_of(&self, symbol: &str) -> Option<f64> {
        self.unit(symbol).map(|unit| unit.multiplier / unit.divisor)
    }

    fn unit(&self, symbol: &str) -> Option<&Unit> {
        let symbol = symbol.trim();
        self.units.iter().find(|unit| unit.symbol == symbol)
    }

    /// Returns how to write a value of this kind, for help.
    pub(super) fn how_to_write(&self) -> String {
        format!(
            "write number and unit as a string, such as \"{}\"; a bare number is in {}",
            self.example, self.si_unit
        )
    }

    /// Returns the units for a message: "nm, um, µm, mm, cm or m".
    pub(super) fn units(&self) -> String {
        let mut symbols: Vec<&str> = self.units.iter().map(|unit| unit.symbol).collect();
        // The Greek letter would be listed a second time.
        symbols.retain(|symbol| !symbol.starts_with('\u{3bc}'));
        match symbols.split_last() {
            Some((last, rest)) if !rest.is_empty() => format!("{} or {last}", rest.join(", ")),
            _ => symbols.concat(),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn quantities_are_the_numbers_they_spell() {
        let cases = [
            (&LENGTH, "650 nm", 650e-9),
            (&LENGTH, "650nm", 650e-9),
            (&LENGTH, "  0.25  mm ", 0.25e-3),
            (&LENGTH, "-5e1 um", -50e-6),
            (&LENGTH, "3.45 \u{b5}m", 3.45e-6),
            (&LENGTH, "3.45 \u{3bc}m", 3.45e-6),
            (&LENGTH, "2. cm", 0.02),
            (&LENGTH, "1e-3 m", 1e-3),
            (&ANGLE, "180 deg", core::f64::consts::PI),
            (&ANGLE, "90°", core::f64::consts::FRAC_PI_2),
            (&ANGLE, "20 mrad", 0.02),
            (&POWER, "5 mW", 5e-3),
            (&RADIANCE, "0.5 W/(m2 sr)", 0.5),
            (&MEMORY, "1 GiB", 1_073_741_824.0),
            (&MEMORY, "100 MB", 1e8),
        ];
        for (dimension, text, expected) in cases {
            assert_eq!(dimension.parse(text), Some(expected), "{text:?}");
        }
    }

    #[test]
    fn anything_else_is_no_quantity() {
        let not_lengths = [
            "",
            "mm",
            "5",
            "5 deg",
            "5 mW",
            "5 MM",
            "1 2 mm",
            "nan mm",
            "inf m",
            "0x10 mm",
            "1,5 mm",
            "5 mm wide",
            "--5 mm",
            "5 m m",
            "e5 m",
            "5e mm",
        ];
        for text in not_lengths {
            assert_eq!(LENGTH.parse(text), None, "{text:?}");
        }
    }

    #[test]
    fn the_list_of_units_reads_as_a_sentence() {
        assert_eq!(LENGTH.units(), "nm, um, µm, mm, cm or m", "lengths");
        assert_eq!(NUMBER.units(), "", "numbers have no unit");
    }
}
