use crate::{
    numbers::check_finite,
    pointers::write,
    status::{Status, call},
};

/// Computes the intensity correlation left after a pupil displacement, in pupil diameters, and an
/// axial displacement, in axial decorrelation lengths.
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
    call(|| {
        check_finite("pupil_shift", &[pupil_shift])?;
        check_finite("axial_shift", &[axial_shift])?;
        let result = tem00_decorrelation::correlation(pupil_shift, axial_shift);
        // SAFETY: by the contract of this function.
        unsafe { write("correlation", correlation, result) }
    })
}

/// Computes the coordinate u of a circular stack at which the intensity has a given correlation to that
/// at u = 0: 0 for 1 or more, and `half_period` for 0 or less. The stack has twice `half_period` slices,
/// at least 2.
///
/// # Safety
///
/// The pointer is null or valid.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn tem00_slice_coordinate(
    correlation: f64,
    half_period: usize,
    coordinate: *mut f64,
) -> Status {
    call(|| {
        check_finite("correlation", &[correlation])?;
        if half_period == 0 {
            return Err(tem00_decorrelation::DecorrelationError::HalfPeriod.into());
        }
        let result = tem00_decorrelation::slice_coordinate(correlation, half_period);
        // SAFETY: by the contract of this function.
        unsafe { write("coordinate", coordinate, result) }
    })
}
