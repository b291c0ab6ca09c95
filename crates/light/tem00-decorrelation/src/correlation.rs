mod axial_loss;
mod inverse;
mod joint;
#[cfg(test)]
mod tests;

pub use axial_loss::add_axial_shifts;
pub use inverse::{equivalent_axial_shift, equivalent_pupil_shift};
pub use joint::CorrelationLaw;

use tem00_numerics::{disc_overlap, sinc_pi_squared};

/// Returns the intensity correlation that remains after the speckle has moved across a circular
/// pupil.
///
/// ```text
/// γ = chat²(s),    chat(s) = (2/π) (acos s − s √(1 − s²))
/// ```
///
/// `shift` is the length s of the pupil displacement in units of the pupil diameter. The part of
/// the pupil that receives the same field as before is the overlap of two discs, which vanishes
/// from s = 1 on. The function is even.
///
/// # Examples
///
/// ```
/// use tem00_decorrelation::pupil_overlap_correlation;
///
/// assert!((pupil_overlap_correlation(0.25) - 0.469_276_571_606_7).abs() < 1e-12);
/// assert!(pupil_overlap_correlation(1.0) == 0.0);
/// ```
///
/// # References
///
/// - M. Sjödahl, *Calculation of speckle displacement, decorrelation, and object-point location in
///   imaging systems*, 1995.
/// - S. Bergmann et al. 2016, §6.4.
#[inline]
pub fn pupil_overlap_correlation(shift: f64) -> f64 {
    let overlap = disc_overlap(shift);
    overlap * overlap
}

/// Returns the intensity correlation that remains after the surface has moved along the optical
/// axis.
///
/// ```text
/// γ = sinc²(π x),    x = d_z / (8 λ (L/D)²),    sinc(x) = sin(x) / x
/// ```
///
/// `shift` is the displacement x in units of
/// [`axial_decorrelation_length`](crate::ImagingGeometry::axial_decorrelation_length), where the
/// correlation first vanishes. Beyond it the correlation revives: to 4.72 % at x = 1.43, and to
/// less at each later maximum. The amplitude sinc(π x) changes its sign at every zero; its square,
/// returned here, does not. The function is even.
///
/// In the notation of the original x = `a_O`/2. Bergmann et al. 2016 consider the pattern
/// decorrelated at `a_O` = 1, where 40.5 % remain.
///
/// # Examples
///
/// ```
/// use tem00_decorrelation::axial_correlation;
///
/// assert!((axial_correlation(0.5) - 0.405_284_734_569_4).abs() < 1e-12);
/// assert!(axial_correlation(1.0) < 1e-30);
/// ```
///
/// # References
///
/// - D. W. Li and F. P. Chiang, *Decorrelation functions in laser speckle photography*, 1986.
#[inline]
pub fn axial_correlation(shift: f64) -> f64 {
    sinc_pi_squared(shift)
}
