use core::f64::consts::{FRAC_PI_2, SQRT_2};

use tem00_numerics::{Refusal, check};

mod angular;
mod density;

pub(crate) use angular::AngularTable;
pub use angular::{AngularKnot, AngularProfile};
pub(crate) use density::{SlopeDensity, SlopeProfile, Variable};

/// Distribution of the power of a laser line along its fan.
///
/// Each profile is a density in a variable `v` of the fan angle `θ`: in `tan θ`, in `θ` itself or
/// in `sin θ`. With the full fan angle `α`, the edges of the fan are at `v(α/2)`: the 1/e² points
/// of a Gaussian, the ends of a uniform profile, the half-value points of a Powell profile. On a
/// plane perpendicular to the axis `tan θ` is proportional to the position along the line.
///
/// The densities are normalised on `|θ| < π/2`; the tails of a Gaussian in θ or sin θ that would
/// lie outside of this range are cut off.
///
/// # Validity
///
/// No profile is right for every lens. Rays traced through glass of index 1.517 deviate from the
/// three Gaussian profiles by the following fractions of the peak:
///
/// | full fan angle | 10° | 30° | 60° |
/// |---|---|---|---|
/// | rod lens, Gaussian in tan θ | 0.008 | 0.070 | 0.239 |
/// | rod lens, Gaussian in θ | 0.006 | 0.048 | 0.160 |
/// | rod lens, Gaussian in sin θ | 0.004 | 0.037 | 0.121 |
/// | plano-convex lens, curved exit, Gaussian in tan θ | 0.025 | 0.180 | 0.455 |
///
/// A beam that spreads by diffraction alone is Gaussian in sin θ. Up to 10° the choice hardly
/// matters. The roll-off of a real Powell lens is known to its manufacturer; an error function is a
/// model of it.
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub enum LineProfile {
    /// Gaussian in `u = tan θ`, and so along the line on a plane perpendicular to the axis.
    ///
    /// ```text
    /// g(u) = √(2/π) / T · exp(−2 u² / T²)     with T = tan(α/2)
    /// ```
    GaussianTan,
    /// Gaussian in the angle θ.
    ///
    /// ```text
    /// f(θ) ∝ exp(−8 θ² / α²)
    /// ```
    GaussianAngle,
    /// Gaussian in sin θ: the far field of a diffracted Gaussian beam.
    ///
    /// ```text
    /// f(θ) ∝ exp(−2 sin² θ / sin²(α/2)) · cos θ
    /// ```
    GaussianSin,
    /// Uniform in tan θ between the edges of the fan: equal power on equal lengths of the line.
    UniformTan,
    /// Uniform in the angle θ between the edges of the fan.
    UniformAngle,
    /// Powell lens: uniform in `u = tan θ` between the edges of the fan, with a Gaussian roll-off.
    ///
    /// ```text
    /// g(u) = [erf((u + T) / (√2 σ)) − erf((u − T) / (√2 σ))] / (4 T)     with σ = edge · T
    /// ```
    ///
    /// At the edges, `|u| = T`, the density is half the density of the plateau, `1 / 2T`. With an
    /// `edge` above 0.3 no plateau is left: at 1 the edges have 70 % of the density on the axis.
    Powell {
        /// Standard deviation of the roll-off relative to the half-length of the line, from 1e−6
        /// (a top hat) to 1.
        edge: f64,
    },
    /// Power per angle from a table. The table need not end at the edges of the fan.
    ///
    /// [`TabulatedLineLight`](crate::TabulatedLineLight) places such a line in a scene.
    Tabulated(AngularProfile),
}

impl LineProfile {
    /// Returns the density of the slope for a fan of the full angle `fan_angle`. For a tabulated
    /// profile it is dark, and the table is used instead.
    pub(crate) fn slope_density(&self, fan_angle: f64) -> Result<SlopeDensity, Refusal> {
        let half_angle = 0.5 * fan_angle;
        let half_slope = half_angle.tan();
        Ok(match self {
            Self::GaussianTan => SlopeDensity::gaussian(Variable::Tan, half_slope, 1.0),
            Self::GaussianAngle => gaussian_within(Variable::Angle, half_angle, FRAC_PI_2),
            Self::GaussianSin => gaussian_within(Variable::Sin, half_angle.sin(), 1.0),
            Self::UniformTan => SlopeDensity::uniform(Variable::Tan, half_slope, 0.0),
            Self::UniformAngle => SlopeDensity::uniform(Variable::Angle, half_angle, 0.0),
            Self::Powell { edge } => {
                let edge = check::range("edge", *edge, [1e-6, 1.0], "")?;
                SlopeDensity::uniform(Variable::Tan, half_slope, edge * half_slope)
            }
            Self::Tabulated(_) => SlopeDensity::uniform(Variable::Tabulated, 0.0, 0.0),
        })
    }
}

/// A Gaussian with its 1/e² points at ±`edge`, cut off at ±`end`.
fn gaussian_within(variable: Variable, edge: f64, end: f64) -> SlopeDensity {
    SlopeDensity::gaussian(variable, edge, libm::erf(SQRT_2 * end / edge))
}

#[cfg(test)]
mod tests;
