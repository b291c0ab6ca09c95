use core::f64::consts::SQRT_2;

use crate::BeamError;
use crate::normal::{interior, normal_density, standard_normal};
use crate::real::Real;

/// How a laser line spreads its power along the fan.
///
/// The variable is the slope `u = tan θ` of a ray in the fan plane, in units of `T = tan(α/2)` with
/// the full fan angle `α`. On a plane square to the axis the slope is proportional to the position
/// along the line.
///
/// # Validity
///
/// No profile is right for every lens. The light behind a rod or a plano-convex cylinder lens agrees
/// with a Gaussian in tan θ within 3 % of the peak up to a fan of 10°; wider fans deviate more. The
/// roll-off of real Powell lenses is manufacturer's data; an error function is a model of it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum LineProfile {
    /// Cylinder lens: Gaussian in tan θ, with the 1/e² points at the edges of the fan, `|u| = T`.
    ///
    /// ```text
    /// g(u) = √(2/π) / T · exp(−2 u² / T²)
    /// ```
    GaussianTan,
    /// Powell lens: uniform in tan θ between the edges of the fan, with a Gaussian roll-off.
    ///
    /// ```text
    /// g(u) = [erf((u + T) / (√2 σ)) − erf((u − T) / (√2 σ))] / (4 T)     with σ = edge · T
    /// ```
    ///
    /// At the edges, `|u| = T`, the density has fallen to one half.
    Powell {
        /// Standard deviation of the roll-off relative to the half-length of the line, from 1e−6
        /// (a top hat) to 1.
        edge: f64,
    },
}

impl LineProfile {
    /// Returns the density of the slope for a fan of half-slope `T`.
    pub(crate) fn slope_density(self, half_slope: f64) -> Result<SlopeDensity<f64>, BeamError> {
        match self {
            Self::GaussianTan => Ok(SlopeDensity {
                flat: 0.0,
                sigma: 0.5 * half_slope,
            }),
            Self::Powell { edge } if (1e-6..=1.0).contains(&edge) => Ok(SlopeDensity {
                flat: half_slope,
                sigma: edge * half_slope,
            }),
            Self::Powell { edge } => Err(BeamError::Edge(edge)),
        }
    }
}

/// A uniform density on [−flat, flat], convolved with a normal one of standard deviation sigma.
///
/// Both line profiles are of this kind: `flat = 0` is the Gaussian.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct SlopeDensity<T> {
    pub(crate) flat: T,
    pub(crate) sigma: T,
}

impl<T: Real> SlopeDensity<T> {
    /// Returns the density at `slope`, per unit slope.
    pub(crate) fn at(self, slope: T) -> T {
        if self.flat > T::ZERO {
            T::of(self.powell_at(slope.wide()))
        } else {
            normal_density(slope, self.sigma)
        }
    }

    fn powell_at(self, slope: f64) -> f64 {
        let (flat, sigma) = (self.flat.wide(), self.sigma.wide());
        let scale = 1.0 / (SQRT_2 * sigma);
        // The difference of complements keeps its digits in the tail.
        let inner = libm::erfc((slope.abs() - flat) * scale);
        let outer = libm::erfc((slope.abs() + flat) * scale);
        (inner - outer) / (4.0 * flat)
    }

    /// Returns the slope below which the fraction `u` in [0, 1) of the power lies.
    pub(crate) fn sample(self, u: T) -> T {
        if self.flat > T::ZERO {
            T::of(self.powell_quantile(interior(u)))
        } else {
            self.sigma * standard_normal(u)
        }
    }

    /// Solves `C(x) = p` by Newton's method on `ln C`, which is concave and so converges from
    /// below.
    fn powell_quantile(self, p: f64) -> f64 {
        const MAX_STEPS: usize = 40;
        let (flat, sigma) = (self.flat.wide(), self.sigma.wide());
        let tail = p.min(1.0 - p);
        let target = tail.ln();
        // The quantile of the uniform density alone bounds the root from above.
        let mut x = flat * (2.0 * tail - 1.0);
        for _ in 0..MAX_STEPS {
            let cumulative = powell_cumulative(x, flat, sigma);
            let step = (target - cumulative.ln()) * cumulative / self.powell_at(x);
            x += step;
            if step.abs() <= 1e-14 * flat {
                break;
            }
        }
        if p < 0.5 { x } else { -x }
    }
}

/// The fraction of a Powell profile below the slope `x`, for x ≤ 0.
fn powell_cumulative(x: f64, flat: f64, sigma: f64) -> f64 {
    // H(t) = ∫ Φ dt = t Φ(t) + φ(t)
    let integral = |t: f64| {
        let phi = normal_density(t, 1.0);
        0.5 * t * libm::erfc(-t / SQRT_2) + phi
    };
    0.5 * sigma / flat * (integral((x + flat) / sigma) - integral((x - flat) / sigma))
}
