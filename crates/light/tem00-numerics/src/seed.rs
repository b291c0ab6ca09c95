//! Seeds derived from another seed, by purpose and index.

/// Purpose of a derived seed.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Purpose {
    /// The speckle of a laser of a scene, by its number.
    Laser,
    /// The speckle of a body that moves by itself, from the seed of the laser; body 0 has the seed
    /// of the laser.
    Body,
    /// The noise of a sensor in a frame, or another quantity drawn anew for each frame.
    Frame,
    /// A pattern in a sum of patterns; pattern 0 has the seed of the sum.
    Pattern,
}

/// Returns the seed with the number `index` for a purpose.
///
/// Lasers, bodies and frames take steps of a Weyl sequence, which keep the seeds of small indices
/// far apart from each other. Patterns are scattered over all seeds, so that the second pattern of
/// one seed is not the first of another.
///
/// # Examples
///
/// Two lasers of a scene have independent speckle:
///
/// ```
/// use tem00_numerics::seed::{Purpose, derived};
///
/// let [first, second] = [0, 1].map(|laser| derived(7, Purpose::Laser, laser));
/// assert_ne!(first, second);
/// assert_eq!(derived(7, Purpose::Body, 0), 7);
/// ```
pub const fn derived(seed: u64, purpose: Purpose, index: u64) -> u64 {
    match purpose {
        Purpose::Laser | Purpose::Frame => {
            seed.wrapping_add(index.wrapping_add(1).wrapping_mul(GOLDEN))
        }
        Purpose::Body => seed.wrapping_add(index.wrapping_mul(0xd1b5_4a32_d192_ed03)),
        Purpose::Pattern if index == 0 => seed,
        Purpose::Pattern => scattered(scattered(seed).wrapping_add(index)),
    }
}

/// Spreads neighbouring numbers over the whole range: the output function of `SplitMix64` (Steele,
/// Lea and Flood 2014).
#[inline]
pub const fn scattered(number: u64) -> u64 {
    let mut bits = number.wrapping_add(GOLDEN);
    bits = (bits ^ (bits >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
    bits = (bits ^ (bits >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
    bits ^ (bits >> 31)
}

/// 2⁶⁴ over the golden ratio, odd: its multiples are spread most evenly.
const GOLDEN: u64 = 0x9e37_79b9_7f4a_7c15;

#[cfg(test)]
mod tests {
    use super::*;

    /// The first outputs of the reference implementation from the state 1234567.
    #[test]
    fn numbers_are_scattered_as_by_the_reference() {
        let state = |step: u64| 1_234_567_u64.wrapping_add(step.wrapping_mul(GOLDEN));
        let found = [0, 1, 2].map(|step| scattered(state(step)));
        assert_eq!(
            found,
            [
                6_457_827_717_110_365_317,
                3_203_168_211_198_807_973,
                9_817_491_932_198_370_423
            ]
        );
    }

    #[test]
    fn small_seeds_and_indices_have_seeds_of_their_own_for_each_purpose() {
        // Frames draw noise, which no pattern meets.
        let purposes = [Purpose::Laser, Purpose::Body, Purpose::Pattern];
        let seeds = (0..100).flat_map(|seed| {
            let of = move |purpose| (1..100).map(move |index| derived(seed, purpose, index));
            purposes.into_iter().flat_map(of)
        });
        let mut seeds: Vec<_> = seeds.chain(0..100).collect();
        let count = seeds.len();
        seeds.sort_unstable();
        seeds.dedup();
        assert_eq!(seeds.len(), count);
    }
}
