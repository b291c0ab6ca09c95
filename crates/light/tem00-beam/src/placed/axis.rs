use crate::GaussianBeam;

/// The squared beam radius along one principal axis: `w²(z) = w0_sq + theta_sq (z − z0)²`.
///
/// The sum is kept in this form on purpose. Multiplied out into powers of z it loses all digits of
/// `f32` near a tight waist.
#[repr(C)]
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Axis {
    /// Squared waist radius, in m².
    pub w0_sq: f64,
    /// Squared divergence half-angle, in rad².
    pub theta_sq: f64,
    /// Position of the waist, in metres, on the coordinate that the light's documentation names.
    pub z0: f64,
    /// Unused, 0. Completes a row of four.
    pub pad: f64,
}

impl Axis {
    pub(super) fn new(beam: &GaussianBeam, z0: f64) -> Self {
        Self {
            w0_sq: beam.waist_radius() * beam.waist_radius(),
            theta_sq: beam.divergence() * beam.divergence(),
            z0,
            pad: 0.0,
        }
    }
}

impl Axis {
    /// Returns the squared beam radius `w²(z)`, in m².
    #[inline(always)]
    pub fn radius_sq_at(&self, z: f64) -> f64 {
        let dz = z - self.z0;
        self.w0_sq + self.theta_sq * dz * dz
    }

    pub(super) fn to_row(self) -> [f64; 4] {
        [self.w0_sq, self.theta_sq, self.z0, self.pad]
    }

    pub(super) fn from_row([w0_sq, theta_sq, z0, pad]: [f64; 4]) -> Self {
        Self {
            w0_sq,
            theta_sq,
            z0,
            pad,
        }
    }

    /// Returns the relative growth of the radius `w'/w`, which is 1/R.
    #[inline(always)]
    pub(super) fn growth_at(&self, z: f64) -> f64 {
        self.theta_sq * (z - self.z0) / self.radius_sq_at(z)
    }

    /// Returns the standard deviations of position at the waist, and of slope.
    pub(super) fn deviations(&self) -> (f64, f64) {
        let half = 0.5;
        (half * self.w0_sq.sqrt(), half * self.theta_sq.sqrt())
    }

    /// Returns the mean and standard deviation of the slope at the offset `x` from the axis.
    pub(super) fn conditional_slope(&self, x: f64, z: f64) -> (f64, f64) {
        let w_sq = self.radius_sq_at(z);
        let mean = x * self.growth_at(z);
        (
            mean,
            0.5 * (self.w0_sq * self.theta_sq).sqrt() / w_sq.sqrt(),
        )
    }
}
