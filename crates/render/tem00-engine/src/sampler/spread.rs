/// Returns the point `index` of an even spread over the unit cube of `N` dimensions, at most 6.
pub(crate) fn even<const N: usize>(index: u32) -> [f64; N] {
    // Square roots of primes have no period in common.
    const PRIMES: [f64; 6] = [2.0, 3.0, 5.0, 7.0, 11.0, 13.0];
    core::array::from_fn(|axis| (f64::from(index) * PRIMES[axis].sqrt() + 0.5).fract())
}
