use tem00_decorrelation::CorrelationLaw;

use crate::{numbers::check_number, status::Status};

/// Computes the intensity correlation left after a pupil displacement, in pupil diameters, and an
/// axial displacement, in axial decorrelation lengths, where it is largest: looked up at the
/// displacement of the speckle.
///
/// # Safety
///
/// The pointer is null or valid.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn tem00_correlation(
    pupil_shift: f64,
    axial_shift: f64,
    correlation: *mut f64,
) -> Status {
    answer!(pupil_shift: check_number, axial_shift: check_number =>
        correlation: CorrelationLaw::AtPeak.correlation(pupil_shift, axial_shift))
}
