/// A kind of quantity, with the units in which a file may state it.
///
/// A bare number is in the SI unit; a string is a number followed by a unit.
#[derive(Debug)]
pub struct Dimension {
    /// The name of a value of this kind, with its article.
    pub(crate) noun: &'static str,
    /// The plural of the SI unit, for messages.
    pub(crate) si_unit: &'static str,
    /// A value as one would write it.
    example: &'static str,
    /// The least positive and the greatest magnitude, in SI units: beyond any apparatus, but far
    /// enough inside the range of `f64` that areas and volumes stay there, too.
    pub(crate) magnitudes: (f64, f64),
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

/// A quantity in a message.
struct Limit {
    /// In SI units.
    value: f64,
    /// True if number and unit are one word.
    is_one_word: bool,
}

/// Returns a word without the punctuation behind it.
fn bare(word: &str) -> &str {
    word.trim_end_matches([',', ';', ':', '.', ')'])
}

/// Writes a number with four significant digits at most.
fn digits(value: f64) -> String {
    // Reading it back drops the zeros at its end.
    let rounded: f64 = format!("{value:.3e}").parse().unwrap_or(value);
    if (1e-3..1e7).contains(&rounded.abs()) || rounded == 0.0 {
        format!("{rounded}")
    } else {
        format!("{rounded:e}")
    }
}

const fn unit(symbol: &'static str, multiplier: f64, divisor: f64) -> Unit {
    Unit {
        symbol,
        multiplier,
        divisor,
    }
}

/// A number as it is written.
#[derive(Debug)]
struct Written {
    digits: usize,
    text: String,
}

impl Unit {
    /// Returns whether it is the SI unit itself.
    fn is_si(&self) -> bool {
        self.multiplier.to_bits() == self.divisor.to_bits()
    }

    /// Returns a number of units in SI units.
    fn si(&self, number: f64) -> f64 {
        number * self.multiplier / self.divisor
    }

    /// Returns a value in SI units in this unit.
    fn of(&self, value: f64) -> f64 {
        value * self.divisor / self.multiplier
    }

    /// Returns the shortest number, without an exponent, that reads back as the same bits; `None` if it
    /// would be long.
    fn shortest(&self, value: f64) -> Option<Written> {
        const MAX_DIGITS: usize = 9;
        let number = self.of(value);
        if !(1e-3..1e6).contains(&number.abs()) {
            return None;
        }
        (1..=MAX_DIGITS).find_map(|digits| {
            let rounded: f64 = format!("{number:.*e}", digits - 1).parse().ok()?;
            let is_same = self.si(rounded).to_bits() == value.to_bits();
            is_same.then(|| Written {
                digits,
                text: rounded.to_string(),
            })
        })
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
pub const DIMENSIONS: [&Dimension; 6] = [&LENGTH, &ANGLE, &POWER, &RADIANCE, &DURATION, &MEMORY];

impl Dimension {
    /// Returns the symbols of all units.
    pub fn symbols(&self) -> impl Iterator<Item = &'static str> {
        self.units.iter().map(|unit| unit.symbol)
    }

    /// Returns the value, in SI units, of a string such as "650 nm", or `None` if it is no quantity
    /// of this kind; a number without a unit is not one.
    pub fn parse(&self, text: &str) -> Option<f64> {
        let (number, unit) = self.split(text)?;
        Some(unit.si(number))
    }

    /// Returns the number and the unit of a string, or `None` if it is not a quantity of this kind.
    fn split(&self, text: &str) -> Option<(f64, &Unit)> {
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
        Some((number.parse().ok()?, self.unit(symbol)?))
    }

    /// Writes a value in SI units in the unit of `typed`, a quantity as somebody has typed it.
    pub(crate) fn written_as(&self, value: f64, typed: &str) -> Option<String> {
        let (_, unit) = self.split(typed)?;
        Some(format!("{} {}", digits(unit.of(value)), unit.symbol))
    }

    /// Returns a message about `typed` with its lengths, or whatever it is, in the unit that was typed; or
    /// `None` if it is not a quantity of this kind.
    pub(crate) fn retyped(&self, message: &str, typed: &str) -> Option<String> {
        let value = self.parse(typed)?;
        let si = self.units.iter().find(|unit| unit.is_si())?;
        let mut words: Vec<String> = Vec::new();
        let mut rest = message.split(' ').peekable();
        while let Some(word) = rest.next() {
            if let Some(limit) = self.limit(word, rest.peek().copied()) {
                let unit = match limit.is_one_word {
                    true => Some(word),
                    false => rest.next(),
                };
                let end = unit.map_or("", |unit| &unit[bare(unit).len()..]);
                words.push(format!("{}{end}", self.written_as(limit.value, typed)?));
                continue;
            }
            let Ok(number) = bare(word).parse::<f64>() else {
                words.push(word.to_owned());
                continue;
            };
            let written = if number.to_bits() == value.to_bits() {
                typed.trim().to_owned()
            } else {
                self.written_as(number, typed)?
            };
            let in_si = rest.next_if(|next| bare(next) == si.symbol || bare(next) == self.si_unit);
            let is_it = number.to_bits() == value.to_bits()
                && words.last().is_some_and(|last| last == "got");
            match in_si {
                Some(unit) => words.push(format!("{written}{}", &unit[bare(unit).len()..])),
                None if is_it => words.push(format!("{written}{}", &word[bare(word).len()..])),
                None => words.push(word.to_owned()),
            }
        }
        let asides = [
            format!(" (in {})", self.si_unit),
            format!(", in {}", self.si_unit),
        ];
        let message = words.join(" ");
        Some(
            asides
                .iter()
                .fold(message, |text, aside| text.replace(aside, "")),
        )
    }

    /// Returns the quantity that a message tells in a unit that is not the SI unit: "1 µm", or "45°" in one word.
    fn limit(&self, word: &str, next: Option<&str>) -> Option<Limit> {
        let of = |number: &str, symbol: &str, is_one_word: bool| {
            let unit = self.unit(symbol).filter(|unit| !unit.is_si())?;
            let value = unit.si(number.parse().ok()?);
            Some(Limit { value, is_one_word })
        };
        let one = bare(word);
        let degrees = one
            .strip_suffix('°')
            .and_then(|number| of(number, "°", true));
        degrees.or_else(|| of(one, bare(next?), false))
    }

    /// Returns a value in SI units as one would write it into a file: in the unit that takes the fewest
    /// digits, in the `usual` one of several, or else as a bare number. It reads back as the same bits.
    pub fn text(&self, value: f64, usual: &str) -> String {
        // Symbols beyond ASCII are second names of units.
        let units = self.units.iter().filter(|unit| unit.symbol.is_ascii());
        let written = units.filter_map(|unit| Some((unit, unit.shortest(value)?)));
        let shortest = written.min_by_key(|(unit, number)| (number.digits, unit.symbol != usual));
        match shortest {
            Some((unit, number)) => format!("\"{} {}\"", number.text, unit.symbol),
            None if value == 0.0 || (1e-3..1e6).contains(&value.abs()) => value.to_string(),
            None => format!("{value:e}"),
        }
    }

    /// Returns the value nearest to one in SI units that is written with few digits in a unit: rounded to
    /// the power of ten at or below `step`, which is in SI units, too. It is the value that its text reads
    /// back as.
    pub fn rounded(&self, value: f64, step: f64, symbol: &str) -> f64 {
        const MAX_DECIMALS: f64 = 15.0;
        const ONE: Unit = unit("", 1.0, 1.0);
        let unit = self.unit(symbol).unwrap_or(&ONE);
        let decimals = -libm::floor(libm::log10(unit.of(step)));
        if decimals.is_nan() || decimals > MAX_DECIMALS {
            return value;
        }
        #[expect(
            clippy::cast_possible_truncation,
            clippy::cast_sign_loss,
            reason = "from 0 to 15"
        )]
        let decimals = decimals.max(0.0) as usize;
        let text = format!("{:.decimals$}", unit.of(value));
        text.parse().map_or(value, |number| unit.si(number))
    }

    /// Returns the size of a unit in SI units, or `None` if it is not a unit of this kind.
    pub(crate) fn size_of(&self, symbol: &str) -> Option<f64> {
        self.unit(symbol).map(|unit| unit.si(1.0))
    }

    fn unit(&self, symbol: &str) -> Option<&Unit> {
        let symbol = symbol.trim();
        self.units.iter().find(|unit| unit.symbol == symbol)
    }

    /// Returns how to write a value of this kind, for help.
    pub(crate) fn how_to_write(&self) -> String {
        format!(
            "write number and unit as a string, such as \"{}\"; a bare number is in {}",
            self.example, self.si_unit
        )
    }

    /// Returns the units for a message: "nm, um, µm, mm, cm or m".
    pub(crate) fn units(&self) -> String {
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
    fn messages_come_back_in_the_unit_that_was_typed() {
        for (dimension, typed, message, expected) in [
            (
                &LENGTH,
                "20 mm",
                "focus_distance must be greater than the focal length (in metres), got 0.02",
                "focus_distance must be greater than the focal length, got 20 mm",
            ),
            (
                &LENGTH,
                "0.1 um",
                "waist radius 5e-8 m is below the limit of 4.138e-7 m",
                "waist radius 0.05 um is below the limit of 0.4138 um",
            ),
            (
                &LENGTH,
                "10 um",
                "wavelength must be from 368e-9 m to 1088e-9 m, where it was measured, got 0.00001",
                "wavelength must be from 0.368 um to 1.088 um, where it was measured, got 10 um",
            ),
            (
                &POWER,
                "0 W",
                "power must be at least 0.5, got 0",
                "power must be at least 0.5, got 0 W",
            ),
            (&ANGLE, "180 deg", "at most 1 rad", "at most 57.3 deg"),
            (
                &LENGTH,
                "0.5 um",
                "line_thickness must be from 1 µm to 1 m (in metres), got 5e-7",
                "line_thickness must be from 1 um to 1000000 um, got 0.5 um",
            ),
            (
                &ANGLE,
                "2 rad",
                "angle must be from 1° to 89° (in radians), got 2",
                "angle must be from 0.01745 rad to 1.553 rad, got 2 rad",
            ),
            (
                &LENGTH,
                "10 mm",
                "distance must be from 1.001 focal lengths to 1 m (in metres), got 0.01",
                "distance must be from 1.001 focal lengths to 1000 mm, got 10 mm",
            ),
            (
                &POWER,
                "2000 W",
                "power must be positive, at most 1000000 mW (in watts), got 2000",
                "power must be positive, at most 1000 W, got 2000 W",
            ),
        ] {
            assert_eq!(
                dimension.retyped(message, typed).unwrap(),
                expected,
                "{typed}"
            );
        }
        assert_eq!(
            LENGTH.retyped("got 5", "5"),
            None,
            "a bare number is in SI units"
        );
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
    fn values_are_written_as_a_person_writes_them() {
        // The text that is read, and that which is written: as short, in the usual unit if it may be.
        for (dimension, usual, text, expected) in [
            (&DURATION, "ms", "0.16 ms", "0.16 ms"),
            (&DURATION, "ms", "20 us", "0.02 ms"),
            (&ANGLE, "deg", "40 deg", "40 deg"),
            (&ANGLE, "deg", "0.25 rad", "250 mrad"),
            (&LENGTH, "nm", "0.66 um", "660 nm"),
            (&LENGTH, "um", "3.45 um", "3.45 um"),
            (&LENGTH, "mm", "0.3 m", "300 mm"),
            (&POWER, "mW", "1e1 mW", "10 mW"),
        ] {
            let value = dimension.parse(text).unwrap();
            assert_eq!(dimension.text(value, usual), format!("\"{expected}\""));
            let read = dimension.parse(expected).unwrap();
            assert_eq!(read.to_bits(), value.to_bits(), "{text} is {expected}");
        }
        assert_eq!(NUMBER.text(5.6, ""), "5.6");
        assert_eq!(NUMBER.text(1e-9, ""), "1e-9");
        // No unit makes this short.
        assert_eq!(ANGLE.text(0.1 + 0.2, "deg"), "0.30000000000000004");
    }

    #[test]
    fn values_are_rounded_to_what_reads_back() {
        // A third of the way from 0.02 ms to 0.64 ms on a logarithmic scale, and its neighbours.
        let value = 0.02e-3 * 32.0_f64.powf(3.0 / 5.0);
        let rounded = DURATION.rounded(value, 0.8e-6, "ms");
        assert_eq!(Some(rounded), DURATION.parse("0.16 ms"));
        assert_eq!(DURATION.text(rounded, "ms"), "\"0.16 ms\"");
        let rounded = |value, step| Some(NUMBER.rounded(value, step, ""));
        assert_eq!(rounded(5.039_68, 0.0104), Some(5.04));
        assert_eq!(rounded(123.4, 30.0), Some(123.0), "no step is so wide");
        for step in [0.0, f64::NAN, 1e-30] {
            assert_eq!(rounded(5.039_68, step), Some(5.039_68), "{step}");
        }
    }

    #[test]
    fn the_list_of_units_reads_as_a_sentence() {
        assert_eq!(LENGTH.units(), "nm, um, µm, mm, cm or m", "lengths");
        assert_eq!(NUMBER.units(), "", "numbers have no unit");
    }
}
