//! The judgement from which value on an image is saturated.

use super::raw_file::BIT_DEPTHS;

/// The number of values below the largest with which a pile at the largest value is compared.
const NEIGHBOURS: usize = 16;

/// The minimum number of pixels in a pile.
const FEWEST: usize = 8;

/// The minimum ratio of the pixels in a pile to the pixels with any value just below it.
///
/// The peak of a line without noise, A − c d² at the distance d, has `√1` pixels within a step of A
/// for each `√2 − √1` within the next one: 2.4 times as many.
const PILE: usize = 4;

/// Returns the value from which on a component is saturated; infinite if it is not known.
///
/// It is `full`, the largest value that the file can hold, unless the values end below it: at the
/// largest value of a camera of fewer bits, in the lower bits of a word or in its upper ones; or at
/// a pile, where the processing of a camera clips values before it writes them.
pub(super) fn saturation_level(values: impl Iterator<Item = f32>, full: Option<f32>) -> f32 {
    let largest = largest_values(values);
    let otherwise = full.unwrap_or(f32::INFINITY);
    let [(top, count), below @ ..] = &largest[..] else {
        return otherwise;
    };
    let max = below.iter().map(|&(_, count)| count).max();
    let is_pile = max.is_some_and(|max| *count >= FEWEST && *count > PILE * max);
    if *top < otherwise && (is_pile || is_largest_of_a_camera(*top)) {
        *top
    } else {
        otherwise
    }
}

fn is_largest_of_a_camera(value: f32) -> bool {
    let is = |value: f32, number: u32| value.to_bits() == (number as f32).to_bits();
    BIT_DEPTHS.into_iter().any(|bits| {
        let largest = (1_u32 << bits) - 1;
        is(value, largest) || is(value, largest << (16 - bits))
    })
}

/// Returns the largest values, from the top, and how many pixels have each.
fn largest_values(values: impl Iterator<Item = f32>) -> Vec<(f32, usize)> {
    let mut largest: Vec<(f32, usize)> = Vec::with_capacity(NEIGHBOURS + 2);
    for value in values.filter(|value| value.is_finite()) {
        let place = largest.partition_point(|&(other, _)| other > value);
        match largest.get_mut(place) {
            // It is not larger: the two are the same.
            Some((other, count)) if *other >= value => *count += 1,
            _ if place <= NEIGHBOURS => {
                largest.insert(place, (value, 1));
                largest.truncate(NEIGHBOURS + 1);
            }
            _ => (),
        }
    }
    largest
}

#[cfg(test)]
mod tests {
    use super::*;

    /// 10,000 exponential quantiles of a mean, in steps, as a sensor clips them.
    fn speckle(mean: f64, step: f64, limit: f32) -> impl Iterator<Item = f32> {
        (0..10_000_u32).map(move |i| {
            let light = -mean * (1.0 - (f64::from(i) + 0.5) / 1e4).ln();
            let stored = (light / step).round() * step;
            tem00_numerics::cast::to_f32(stored).min(limit)
        })
    }

    #[track_caller]
    fn assert_level(values: impl Iterator<Item = f32>, full: Option<f32>, expected: f32) {
        let found = saturation_level(values, full);
        let is_same = found.to_bits() == expected.to_bits();
        assert!(is_same, "{found} for {expected}");
    }

    #[test]
    fn piles_are_found_wherever_they_lie() {
        let full = Some(65_535.0);
        for (step, limit) in [
            (1.0, 4_095.0),
            (1.0, 1_023.0),
            (1.0, 16_383.0),
            (16.0, 65_520.0),
            (64.0, 65_472.0),
            // Clipped by what a camera computes: black level, white balance, range of video.
            (1.0, 3_931.0),
            (1.0, 235.0),
        ] {
            let limited = |mean: f64| speckle(mean * f64::from(limit), step, limit);
            assert_level(limited(0.2), full, limit);
            assert_level(limited(0.04), full, 65_535.0);
        }
        // One pixel at the largest value of a camera is enough.
        let one = speckle(50.0, 1.0, 900.0).chain([1_023.0]);
        assert_level(one, full, 1_023.0);
    }

    #[test]
    fn what_only_ends_is_no_pile() {
        let full = Some(65_535.0);
        for mean in [0.4, 3.0, 30.0, 777.0] {
            let light = || speckle(mean, 1.0, f32::INFINITY);
            assert_level(light(), full, 65_535.0);
            assert_level(light(), None, f32::INFINITY);
        }
        assert_level(core::iter::empty(), full, 65_535.0);
        assert_level([7.0; 100].into_iter(), None, f32::INFINITY);
        // Straight and curved lines without noise, of different widths.
        for (width, bend) in [
            (2.0, 0.0),
            (8.0, 0.0),
            (50.0, 0.0),
            (3.0, 0.02),
            (40.0, 0.02),
        ] {
            let line = (0..300_u16).flat_map(move |x| {
                (-60..60_i16).map(move |y| {
                    let d: f32 = (f32::from(y) + 0.3 + bend * f32::from(x)) / width;
                    (200.0 * (-2.0 * d * d).exp()).round()
                })
            });
            assert_level(line, Some(255.0), 255.0);
        }
    }
}
