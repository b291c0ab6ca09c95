//! Bins of places and path lengths, in transport lengths, that grow in proportion to both.

/// Bits of a number behind those of its exponent and the leading bits that make eight bins per
/// octave.
const BITS: u32 = 49;
const PER_OCTAVE: usize = 8;
/// The exponent of 1.
const ONE: usize = 1023;

/// The first bins of places and lengths: 2⁻⁷ and 2⁻⁸.
const FIRST_PLACE: usize = (ONE - 7) * PER_OCTAVE;
const FIRST_LENGTH: usize = (ONE - 8) * PER_OCTAVE;
/// The bins on one side of the entry, up to 2¹⁰: what lies farther joins the last.
const SIDE: usize = 17 * PER_OCTAVE;
/// The number of bins of places: both sides and the middle.
pub(crate) const PLACES: usize = 2 * SIDE + 1;
/// The number of bins of lengths, up to 2¹⁸: what is shorter joins the first, what is longer the
/// last.
pub(crate) const LENGTHS: usize = 26 * PER_OCTAVE;

/// Part of the light of a line.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Bin {
    /// The place where the bin begins, in metres from the entry.
    pub from: f64,
    /// The place where it ends.
    pub to: f64,
    /// The fraction of the light that leaves there.
    pub fraction: f64,
}

/// Returns the bin of a number that is not negative, among all of its exponents.
fn bin(value: f64) -> usize {
    u16::try_from(value.to_bits() >> BITS).map_or(usize::MAX, usize::from)
}

/// Returns where a bin begins.
const fn begin(bin: usize) -> f64 {
    f64::from_bits((bin as u64) << BITS)
}

/// Returns the number of the bin of a path among [`PLACES`] times [`LENGTHS`].
pub(crate) fn index(place: f64, length: f64) -> usize {
    let from_middle = (bin(place.abs()) + 1).saturating_sub(FIRST_PLACE).min(SIDE);
    let place = if place < 0.0 {
        SIDE - from_middle
    } else {
        SIDE + from_middle
    };
    let length = bin(length).saturating_sub(FIRST_LENGTH).min(LENGTHS - 1);
    place * LENGTHS + length
}

/// Returns the places between which a bin lies.
pub(crate) fn places(index: usize) -> [f64; 2] {
    let edge = |from_middle: usize| begin(FIRST_PLACE + from_middle);
    if index > SIDE {
        let from_middle = index - SIDE;
        [edge(from_middle - 1), edge(from_middle)]
    } else if index < SIDE {
        let from_middle = SIDE - index;
        [-edge(from_middle), -edge(from_middle - 1)]
    } else {
        [-edge(0), edge(0)]
    }
}

/// Returns the length in the middle of a bin.
pub(crate) fn length(index: usize) -> f64 {
    0.5 * (begin(FIRST_LENGTH + index) + begin(FIRST_LENGTH + index + 1))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_bin_holds_what_lies_between_its_edges() {
        for place in [-3.2, -1e-3, 0.0, 1e-3, 0.007_812_5, 0.3, 1.0, 700.0] {
            let [from, to] = places(index(place, 1.0) / LENGTHS);
            assert!(from <= place && place <= to, "{place}: {from} to {to}");
        }
        for path in [0.01, 1.0, 1.1, 900.0] {
            let middle = length(index(0.0, path) % LENGTHS);
            assert!((middle / path - 1.0).abs() < 0.07, "{path}: {middle}");
        }
        assert_eq!(index(1e9, 1e9), PLACES * LENGTHS - 1);
        assert_eq!(index(-1e9, 0.0), 0);
    }
}
