//! The renderer face: placed lights as plain structs, generic over the scalar.

mod astigmatic;
mod batch;
mod ellipse;
mod emitter;
mod fan;
mod frame;
mod line;
pub(crate) mod phase_space;
mod record;
mod spot;
mod tabulated;

pub use astigmatic::AstigmaticLight;
pub use ellipse::Ellipse;
pub use emitter::Emitter;
pub use frame::Placement;
pub use line::LineLight;
pub use record::{Bounds, NextEvent, NextEventSlices, RayPdf, RaySample, SampledEvent};
pub use spot::SpotLight;
pub use tabulated::TabulatedLineLight;

use crate::real::Real;
use crate::real::sealed::Scalar;
use crate::{BeamError, GaussianBeam};

/// The cut-off of a freshly placed light, in beam radii.
const DEFAULT_CUTOFF: f64 = 4.0;

/// The squared beam radius along one principal axis: `w²(z) = w0_sq + theta_sq (z − z0)²`.
///
/// The sum is kept in this form on purpose. Multiplied out into powers of z it loses all digits of
/// `f32` near a tight waist.
#[repr(C)]
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Axis<T> {
    /// Squared waist radius, in m².
    pub w0_sq: T,
    /// Squared divergence half-angle, in rad².
    pub theta_sq: T,
    /// Position of the waist, in metres, on the coordinate the light says.
    pub z0: T,
    /// Unused, 0. Completes a row of four.
    pub pad: T,
}

impl Axis<f64> {
    fn new(beam: &GaussianBeam, z0: f64) -> Self {
        Self {
            w0_sq: beam.waist_radius() * beam.waist_radius(),
            theta_sq: beam.divergence() * beam.divergence(),
            z0,
            pad: 0.0,
        }
    }
}

impl<T: Real> Axis<T> {
    /// Returns the squared beam radius `w²(z)`, in m².
    #[inline(always)]
    pub fn radius_sq_at(&self, z: T) -> T {
        let dz = z - self.z0;
        self.w0_sq + self.theta_sq * dz * dz
    }

    fn to_row(self) -> [T; 4] {
        [self.w0_sq, self.theta_sq, self.z0, self.pad]
    }

    fn from_row([w0_sq, theta_sq, z0, pad]: [T; 4]) -> Self {
        Self {
            w0_sq,
            theta_sq,
            z0,
            pad,
        }
    }

    /// Returns the relative growth of the radius `w'/w`, which is 1/R.
    #[inline(always)]
    fn growth_at(&self, z: T) -> T {
        self.theta_sq * (z - self.z0) / self.radius_sq_at(z)
    }

    /// Returns the standard deviations of position at the waist, and of slope.
    fn deviations(&self) -> (T, T) {
        let half = T::of(0.5);
        (half * self.w0_sq.sqrt(), half * self.theta_sq.sqrt())
    }

    /// Returns the mean and standard deviation of the slope at the offset `x` from the axis.
    fn conditional_slope(&self, x: T, z: T) -> (T, T) {
        let w_sq = self.radius_sq_at(z);
        let mean = x * self.growth_at(z);
        (
            mean,
            T::of(0.5) * (self.w0_sq * self.theta_sq).sqrt() / w_sq.sqrt(),
        )
    }
}

/// Rounds the fields of a light to `f32`, unless one of them overflows.
fn to_single<const N: usize>(rows: [[f64; 4]; N]) -> Result<[[f32; 4]; N], BeamError> {
    let overflow = |field: &&f64| !<f32 as Scalar>::of(**field).is_finite();
    match rows.as_flattened().iter().find(overflow) {
        Some(&field) => Err(BeamError::single_precision(field)),
        None => Ok(rows.map(|row| row.map(<f32 as Scalar>::of))),
    }
}

fn row<T: Real>([x, y, z]: [T; 3], w: T) -> [T; 4] {
    [x, y, z, w]
}

fn first_three<T: Real>([x, y, z, _]: [T; 4]) -> [T; 3] {
    [x, y, z]
}

/// Checks that `f32` holds all digits of the quantities that a light divides by.
fn check_digits<const N: usize>(quantities: [f64; N]) -> Result<(), BeamError> {
    for quantity in quantities {
        let dark = quantity.abs() < f64::MIN_POSITIVE;
        if !(<f32 as Scalar>::of(quantity).is_normal() || dark) {
            return Err(BeamError::single_precision(quantity));
        }
    }
    Ok(())
}

/// Returns the power, if it is one and so small that no light concentrates it beyond all numbers.
fn checked_power(power: f64) -> Result<f64, BeamError> {
    if (0.0..=1e100).contains(&power) {
        Ok(power)
    } else {
        Err(BeamError::out_of_range(
            "power",
            power,
            "W",
            "between 0 W and 1e100 W",
        ))
    }
}

#[cfg(test)]
mod tests;
