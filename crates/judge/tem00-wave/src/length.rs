//! The range of lengths in which a phase in `f64` is meaningful.

use core::ops::RangeInclusive;

use glam::{DMat3, DVec3};
use tem00_numerics::check;

use crate::Refusal;

/// Lengths from 1 pm to 10 km.
pub(crate) const LENGTHS: RangeInclusive<f64> = 1e-12..=1e4;

/// Wavelengths from 0.1 nm to 1 m.
pub(crate) const WAVELENGTHS: RangeInclusive<f64> = 1e-10..=1.0;

pub(crate) fn checked_length(length: f64, parameter: &'static str) -> Result<f64, Refusal> {
    let (holds, allowed) = (LENGTHS.contains(&length), "from 1e-12 to 1e4, in metres");
    check::that(holds, parameter, length, "", allowed).map(|()| length)
}

pub(crate) fn checked_wavelength(wavelength: f64) -> Result<f64, Refusal> {
    let holds = WAVELENGTHS.contains(&wavelength);
    let allowed = "from 1e-10 to 1, in metres";
    check::that(holds, "wavelength", wavelength, "", allowed).map(|()| wavelength)
}

pub(crate) fn checked_position(position: DVec3, parameter: &'static str) -> Result<DVec3, Refusal> {
    // A comparison with NaN is false.
    let holds = position.abs().cmple(DVec3::splat(*LENGTHS.end())).all();
    let allowed = "finite and at most 1e4 in each component, in metres";
    check::that(holds, parameter, position.to_array(), "", allowed).map(|()| position)
}

pub(crate) fn checked_direction(
    direction: DVec3,
    parameter: &'static str,
) -> Result<DVec3, Refusal> {
    direction
        .try_normalize()
        .ok_or_else(|| Refusal::new(parameter, direction.to_array(), "finite and not zero"))
}

/// Returns right-handed axes whose third column is `third` and whose first is `first` without its
/// component along the third, or `None` if the two are parallel.
pub(crate) fn axes_from(first: DVec3, third: DVec3) -> Option<DMat3> {
    /// The square root of the rounding unit: below it, the perpendicular component is mostly
    /// rounding.
    const PARALLEL: f64 = 1.0 / 67_108_864.0;
    let third = third.try_normalize()?;
    let second = third.cross(first.try_normalize()?);
    let second = (second.length() > PARALLEL).then(|| second.normalize())?;
    Some(DMat3::from_cols(second.cross(third), second, third))
}
