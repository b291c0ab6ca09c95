use tem00_numerics::{Shown, cast::to_usize};

/// A kind of quantity, with the units in which a file may state it.
///
/// A bare number is in the SI unit; a string is a number followed by a unit.
#[derive(Debug)]
pub struct Dimension {
    /// The name of a value of this kind, with its article.
    pub(crate) noun: &'static str,
    /// The plural of the SI unit, for messages.
    pub(crate) si_unit: &'static str,
    /// A value as a file would state it.
    example: &'static str,
    /// The smallest positive and the largest magnitude, in SI units. They lie beyond any apparatus,
    /// but far enough inside the range of `f64` that areas and volumes stay there, too.
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
    /// The value in SI units.
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
    Shown(format!("{value:.3e}").parse().unwrap_or(value)).to_string()
}

const fn unit(symbol: &'static str, multiplier: f64, divisor: f64) -> Unit {
    Unit {
        symbol,
        multiplier,
        divisor,
    }
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

    /// Returns the number of digits and the text of the shortest number, without an exponent, that
    /// reads back as the same bits; `None` if it would be long.
    fn shortest(&self, value: f64) -> Option<(usize, String)> {
        const MAX_DIGITS: usize = 9;
        let number = self.of(value);
        if !(1e-3..1e6).contains(&number.abs()) {
            return None;
        }
        (1..=MAX_DIGITS).find_map(|digits| {
            let rounded: f64 = format!("{number:.*e}", digits - 1).parse().ok()?;
            let is_same = self.si(rounded).to_bits() == value.to_bits();
            is_same.then(|| (digits, rounded.to_string()))
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

/// Dimensions that have units.
pub const DIMENSIONS: [&Dimension; 6] = [&LENGTH, &ANGLE, &POWER, &RADIANCE, &DURATION, &MEMORY];

impl Dimension {
    /// Returns the symbols of all units.
    pub fn symbols(&self) -> impl Iterator<Item = &'static str> {
        self.units.iter().map(|unit| unit.symbol)
    }

    /// Returns the value, in SI units, of a string such as "650 nm", or `None` if it is not a
    /// quantity of this kind; a number without a unit is not a quantity.
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

    /// Returns a message about `typed` with its quantities in the unit of `typed`, or `None` if
    /// `typed` is not a quantity of this kind.
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
            let is_it = number.to_bits() == value.to_bits();
            let written = match is_it {
                true => typed.trim().to_owned(),
                false => self.written_as(number, typed)?,
            };
            let in_si = rest.next_if(|next| bare(next) == si.symbol || bare(next) == self.si_unit);
            let is_got = is_it && words.last().is_some_and(|last| last == "got");
            words.push(match in_si.or(is_got.then_some(word)) {
                Some(end) => written + &end[bare(end).len()..],
                None => word.to_owned(),
            });
        }
        let message = words.join(" ");
        let message = message.replace(&format!(" (in {})", self.si_unit), "");
        Some(message.replace(&format!(", in {}", self.si_unit), ""))
    }

    /// Returns the quantity that a message states in a unit that is not the SI unit: "1 µm", or
    /// "45°" in one word.
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

    /// Returns the text of a value in SI units for a file: in the unit that takes the fewest
    /// digits, in the `usual` unit if several do, or else as a bare number. The text reads back as
    /// the same bits.
    pub fn text(&self, value: f64, usual: &str) -> String {
        // Symbols beyond ASCII are second names of units.
        let units = self.units.iter().filter(|unit| unit.symbol.is_ascii());
        let written = units.filter_map(|unit| Some((unit, unit.shortest(value)?)));
        let shortest = written.min_by_key(|(unit, (digits, _))| (*digits, unit.symbol != usual));
        match shortest {
            Some((unit, (_, number))) => format!("\"{number} {}\"", unit.symbol),
            None => Shown(value).to_string(),
        }
    }

    /// Returns the value nearest to one in SI units that is written with few digits in a unit:
    /// rounded to the power of ten at or below `step`, which is in SI units, too. Its text reads
    /// back as the same value.
    pub fn rounded(&self, value: f64, step: f64, symbol: &str) -> f64 {
        const MAX_DECIMALS: f64 = 15.0;
        const ONE: Unit = unit("", 1.0, 1.0);
        let unit = self.unit(symbol).unwrap_or(&ONE);
        let decimals = -libm::floor(libm::log10(unit.of(step)));
        if decimals.is_nan() || decimals > MAX_DECIMALS {
            return value;
        }
        let decimals = to_usize(decimals);
        let text = format!("{:.decimals$}", unit.of(value));
        text.parse().map_or(value, |number| unit.si(number))
    }

    /// Returns the size of a unit in SI units, or `None` if it is not a unit of this kind.
    pub(crate) fn size_of(&self, symbol: &str) -> Option<f64> {
        self.unit(symbol).map(|unit| unit.si(1.0))
    }

    fn unit(&self, symbol: &str) -> Option<&Unit> {
        // The Greek letter looks like the sign for micro.
        let symbol = symbol.trim().replace('\u{3bc}', "\u{b5}");
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
        let symbols: Vec<&str> = self.symbols().collect();
        match symbols.split_last() {
            Some((last, rest)) if !rest.is_empty() => format!("{} or {last}", rest.join(", ")),
            _ => symbols.concat(),
        }
    }
}

#[cfg(test)]
mod tests;
