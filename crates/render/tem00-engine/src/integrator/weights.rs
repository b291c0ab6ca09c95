/// Returns the weight of an estimate whose direction was drawn with the density `pdf`, if it could
/// also have been drawn with the density `other`.
///
/// It is the power heuristic of E. Veach, *Robust Monte Carlo Methods for Light Transport
/// Simulation*, 1997, §9.2.4, with the exponent 2.
pub(super) fn power_heuristic(pdf: f64, other: f64) -> f64 {
    let ratio = other / pdf;
    1.0 / (1.0 + ratio * ratio)
}

/// Returns the number by which an index chooses random numbers.
#[expect(
    clippy::cast_possible_truncation,
    reason = "it only chooses random numbers"
)]
pub(super) const fn random_number(index: usize) -> u32 {
    index as u32
}
