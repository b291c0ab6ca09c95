use core::f64::consts::PI;

use tem00_numerics::{check, disc_overlap_inverse, sinc_inverse};

use crate::Refusal;

/// Returns the pupil displacement, in units of the pupil diameter, that alone would leave a given
/// intensity correlation γ.
///
/// ```text
/// s = chat⁻¹(√γ)
/// ```
///
/// It maps any kind of decorrelation to a position in a stack whose pupil moves along a straight
/// line. The result ranges from 0 for γ = 1 to 1 for γ = 0.
///
/// # Errors
///
/// Returns an error unless γ is in [0, 1]. A measured correlation can lie outside of this interval
/// because of noise: clamp it first.
///
/// # Examples
///
/// In collimated light the speckle moves across the pupil as far as the surface does. How far may a
/// surface move in its plane before a camera with a pupil of 3.125 mm loses half of the
/// correlation?
///
/// ```
/// use tem00_decorrelation::{equivalent_pupil_shift, pupil_overlap_correlation};
///
/// let shift = equivalent_pupil_shift(0.5)?;
/// assert!((shift - 0.2321).abs() < 5e-5);
/// assert!((shift * 3.125e-3 - 0.7254e-3).abs() < 1e-7);
/// assert!((pupil_overlap_correlation(shift) - 0.5).abs() < 1e-12);
/// assert!(equivalent_pupil_shift(-0.2).is_err());
/// # Ok::<(), tem00_decorrelation::Refusal>(())
/// ```
#[inline]
pub fn equivalent_pupil_shift(correlation: f64) -> Result<f64, Refusal> {
    Ok(disc_overlap_inverse(
        check::range("correlation", correlation, [0.0, 1.0], "")?.sqrt(),
    ))
}

/// Returns the axial displacement, in units of
/// [`axial_decorrelation_length`](crate::ImagingGeometry::axial_decorrelation_length), that alone
/// would leave a given intensity correlation γ, on the branch before the first zero.
///
/// ```text
/// x = sinc⁻¹(√γ) / π
/// ```
///
/// The result ranges from 0 for γ = 1 to 1 for γ = 0. Beyond x = 1 the correlation revives to 4.7 %
/// and falls again.
///
/// # Errors
///
/// Returns an error unless γ is in [0, 1].
///
/// # Examples
///
/// ```
/// use tem00_decorrelation::{axial_correlation, equivalent_axial_shift};
///
/// let shift = equivalent_axial_shift(0.5)?;
/// assert!((shift - 0.4429).abs() < 5e-5);
/// assert!((axial_correlation(shift) - 0.5).abs() < 1e-12);
/// # Ok::<(), tem00_decorrelation::Refusal>(())
/// ```
pub fn equivalent_axial_shift(correlation: f64) -> Result<f64, Refusal> {
    Ok(sinc_inverse(check::range("correlation", correlation, [0.0, 1.0], "")?.sqrt()) / PI)
}
