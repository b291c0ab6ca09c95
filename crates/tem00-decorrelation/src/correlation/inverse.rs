use core::f64::consts::PI;

use tem00_numerics::{disc_overlap_inverse, sinc_inverse};

use super::correlation as product_law;
use crate::DecorrelationError;

/// Returns the pupil displacement, in units of the pupil diameter, that alone would leave a given
/// intensity correlation γ.
///
/// ```text
/// s = chat⁻¹(√γ)
/// ```
///
/// It places any kind of decorrelation on a stack whose pupil moves along a straight line. The
/// result runs from 0 for γ = 1 to 1 for γ = 0.
///
/// # Errors
///
/// Returns an error unless γ is in [0, 1]. A measured correlation can lie outside by its noise: clamp it first.
///
/// # Examples
///
/// In collimated light the speckle moves across the pupil as far as the surface does. How far may
/// a surface move in its plane before a camera with a pupil of 3.125 mm loses half the correlation?
///
/// ```
/// use tem00_decorrelation::{equivalent_pupil_shift, pupil_overlap_correlation};
///
/// let shift = equivalent_pupil_shift(0.5)?;
/// assert!((shift - 0.2321).abs() < 5e-5);
/// assert!((shift * 3.125e-3 - 0.7254e-3).abs() < 1e-7);
/// assert!((pupil_overlap_correlation(shift) - 0.5).abs() < 1e-12);
/// assert!(equivalent_pupil_shift(-0.2).is_err());
/// # Ok::<(), tem00_decorrelation::DecorrelationError>(())
/// ```
#[inline]
pub fn equivalent_pupil_shift(correlation: f64) -> Result<f64, DecorrelationError> {
    Ok(disc_overlap_inverse(checked(correlation)?.sqrt()))
}

/// Returns the axial displacement, in units of
/// [`axial_decorrelation_length`](crate::ImagingGeometry::axial_decorrelation_length), that alone
/// would leave a given intensity correlation γ, on the branch before the first zero.
///
/// ```text
/// x = sinc⁻¹(√γ) / π
/// ```
///
/// The result runs from 0 for γ = 1 to 1 for γ = 0. Beyond x = 1 the correlation revives to 4.7 %
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
/// # Ok::<(), tem00_decorrelation::DecorrelationError>(())
/// ```
pub fn equivalent_axial_shift(correlation: f64) -> Result<f64, DecorrelationError> {
    Ok(sinc_inverse(checked(correlation)?.sqrt()) / PI)
}

/// Returns the multiple of a motion at which the product law first leaves a given intensity
/// correlation γ.
///
/// ```text
/// chat²(q s) sinc²(π q x) = γ,    q ≥ 0 on the branch before the first zero
/// ```
///
/// `pupil_shift` s and `axial_shift` x are those of the motion, in the units of
/// [`correlation`](crate::correlation). At first order they grow in proportion to it, so that the
/// motion may be any: a unit vector, or what happened between two frames. γ = 1 takes q = 0, and
/// γ = 0 the first zero, where q s = 1 or q x = 1.
///
/// Returns `None` if the motion leaves the pattern as it is, or so nearly that the multiple
/// overflows.
///
/// # Errors
///
/// Returns an error unless γ is in [0, 1] and both shifts are finite.
///
/// # Examples
///
/// A motion slides the speckle by 2 % of the pupil and 1 % of the axial length per frame. For how
/// many frames is half the correlation left?
///
/// ```
/// use tem00_decorrelation::{correlation, motion_multiple};
///
/// let frames = motion_multiple(0.5, 0.02, 0.01)?.expect("a motion");
/// assert!((frames - 11.03).abs() < 0.005);
/// assert!((correlation(0.02 * frames, 0.01 * frames) - 0.5).abs() < 1e-12);
/// # Ok::<(), tem00_decorrelation::DecorrelationError>(())
/// ```
pub fn motion_multiple(
    correlation: f64,
    pupil_shift: f64,
    axial_shift: f64,
) -> Result<Option<f64>, DecorrelationError> {
    checked(correlation)?;
    for (parameter, shift) in [("pupil_shift", pupil_shift), ("axial_shift", axial_shift)] {
        if !shift.is_finite() {
            return Err(DecorrelationError::refused(parameter, shift, "finite"));
        }
    }
    let (s, x) = (pupil_shift.abs(), axial_shift.abs());
    let larger = s.max(x);
    // Along the direction scaled so that its larger part is 1 the product falls from 1 at 0 to 0 at 1.
    let (mut low, mut high) = (0.0, 1.0);
    if correlation > 0.0 {
        let left = |q: f64| product_law(q * (s / larger), q * (x / larger));
        while let Some(middle) = between(low, high) {
            if left(middle) > correlation {
                low = middle;
            } else {
                high = middle;
            }
        }
    }
    let end = if correlation < 1.0 { high } else { 0.0 };
    Ok(Some(end / larger).filter(|multiple| multiple.is_finite()))
}

/// Returns the middle of an interval, or `None` if it cannot be divided further.
fn between(low: f64, high: f64) -> Option<f64> {
    let middle = 0.5 * (low + high);
    (low < middle && middle < high && high - low > f64::EPSILON * high).then_some(middle)
}

/// Returns an intensity correlation that can be.
#[inline]
fn checked(correlation: f64) -> Result<f64, DecorrelationError> {
    if (0.0..=1.0).contains(&correlation) {
        return Ok(correlation);
    }
    let allowed = "from 0 to 1";
    Err(DecorrelationError::refused(
        "correlation",
        correlation,
        allowed,
    ))
}
