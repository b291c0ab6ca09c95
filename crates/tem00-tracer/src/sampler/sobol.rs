/// Returns the second coordinate of a point of Sobol's sequence, in units of 2⁻³².
///
/// The columns of its generator matrix are those of Pascal's triangle modulo 2.
pub(super) const fn sobol_second(index: u32) -> u32 {
    let mut column = 1_u32 << 31;
    let (mut value, mut rest) = (0, index);
    while rest > 0 {
        if rest & 1 == 1 {
            value ^= column;
        }
        column ^= column >> 1;
        rest >>= 1;
    }
    value
}

/// Scrambles a number by Owen's method, its bits in reverse: each bit is flipped, or not, by chance
/// that depends on the bits below it.
///
/// The hash is that of S. Laine and T. Karras, *Stratified Sampling for Stochastic Transparency*,
/// 2011, with the constants of Burley 2020.
#[inline(always)]
pub(super) const fn scrambled(reversed: u32, seed: u32) -> u32 {
    let mut x = reversed.wrapping_add(seed);
    x ^= x.wrapping_mul(0x6c50_b47c);
    x ^= x.wrapping_mul(0xb82f_1e52);
    x ^= x.wrapping_mul(0xc7af_e638);
    x ^ x.wrapping_mul(0x8d22_f6e6)
}
