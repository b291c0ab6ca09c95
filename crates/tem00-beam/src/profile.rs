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

#[cfg(test)]
mod tests {
    use super::*;

    fn densities() -> [SlopeDensity<f64>; 4] {
        [
            LineProfile::GaussianTan,
            LineProfile::Powell { edge: 1e-3 },
            LineProfile::Powell { edge: 0.1 },
            LineProfile::Powell { edge: 1.0 },
        ]
        .map(|profile| profile.slope_density(0.25).unwrap())
    }

    /// ∫ g over [a, b] by the midpoint rule.
    fn integrate(density: SlopeDensity<f64>, a: f64, b: f64) -> f64 {
        const INTERVALS: u32 = 20_000;
        let h = (b - a) / f64::from(INTERVALS);
        (0..INTERVALS)
            .map(|i| density.at(a + (f64::from(i) + 0.5) * h))
            .sum::<f64>()
            * h
    }

    #[test]
    fn densities_integrate_to_one() {
        for density in densities() {
            let reach = density.flat + 9.0 * density.sigma;
            let total = integrate(density, -reach, reach);
            assert!((total - 1.0).abs() < 1e-12, "{density:?}: {total}");
        }
    }

    #[test]
    fn printed_forms_are_special_cases() {
        let t = 0.25;
        let gaussian = LineProfile::GaussianTan.slope_density(t).unwrap();
        let powell = LineProfile::Powell { edge: 0.1 }.slope_density(t).unwrap();
        let width = SQRT_2 * 0.1 * t;
        for u in [-0.3_f64, -0.25, 0.0, 0.1, 0.24, 0.4] {
            let expected =
                (2.0 / core::f64::consts::PI).sqrt() / t * (-2.0 * u * u / (t * t)).exp();
            assert!((gaussian.at(u) / expected - 1.0).abs() < 1e-14, "u = {u}");
            let expected = (libm::erf((u + t) / width) - libm::erf((u - t) / width)) / (4.0 * t);
            assert!((powell.at(u) - expected).abs() < 1e-15 / t, "u = {u}");
        }
    }

    #[test]
    fn samples_invert_the_cumulative_density() {
        for density in densities() {
            for u in [1e-15, 1e-9, 1e-4, 0.01, 0.2, 0.5, 0.8, 0.999] {
                let x = density.sample(u);
                let tail = u.min(1.0 - u);
                let reach = density.flat + 12.0 * density.sigma;
                let mass = integrate(density, -reach, -x.abs());
                // Midpoint rule with 20000 points: h² g'' / 24 < 1e−6 of the mass at edge 1e−3.
                assert!(
                    (mass / tail - 1.0).abs() < 2e-6,
                    "{density:?}, u = {u:e}: {mass:e}"
                );
                assert!(
                    (x < 0.0) == (u < 0.5) || x.abs() < 1e-15,
                    "{density:?}, u = {u}: {x}"
                );
            }
        }
    }

    #[test]
    fn samples_grow_with_the_uniform_variate() {
        for density in densities() {
            let samples = (0..1000).map(|i| density.sample(f64::from(i) / 1000.0));
            assert!(samples.clone().all(f64::is_finite), "{density:?}");
            assert!(samples.is_sorted(), "{density:?}");
        }
    }

    #[test]
    fn edges_outside_the_range_are_rejected() {
        for edge in [0.0, -0.1, 1.001, f64::NAN] {
            let result = LineProfile::Powell { edge }.slope_density(0.25);
            assert!(matches!(result, Err(BeamError::Edge(_))), "edge {edge}");
        }
    }
}
