//! Densities of the slope of a ray in the fan plane.
#![expect(unnameable_types, reason = "they belong to a sealed trait")]

use core::f64::consts::{FRAC_PI_2, SQRT_2};

use crate::normal::{interior, normal_density, standard_normal};
use crate::placed::secant;

/// The tangent of the angle next to π/2 in double precision: no ray of a fan is steeper.
const STEEPEST: f64 = 1.633_123_935_319_537e16;

/// The power along a fan, as a density normalised to 1.
///
/// Its argument is the slope `u = tan θ`, at most [`STEEPEST`] in magnitude.
pub trait SlopeProfile {
    /// Returns the density per unit slope, `g(u)`; 0 or not finite beyond the steepest slope.
    fn per_slope(&self, u: f64) -> f64;

    /// Returns the density per radian, `f(θ) = g(u) / cos² θ`.
    fn per_angle(&self, u: f64) -> f64;

    /// Returns the density per radian after a normal deviate of standard deviation `sigma`, in
    /// radians, has been added to the angle; to first order in `sigma` where the angle is not the
    /// variable of the profile.
    fn spread_per_angle(&self, u: f64, sigma: f64) -> f64;

    /// Returns whether the slope is within the cut-off, given in half-widths at 1/e².
    fn reaches(&self, u: f64, cutoff: f64) -> bool;

    /// Returns the largest slope within the cut-off.
    fn largest_slope(&self, cutoff: f64) -> f64;

    /// Returns the slope below which the fraction `p` in [0, 1) of the power lies.
    fn quantile(&self, p: f64) -> f64;

    /// Returns the fraction of the power between two slopes, `a` ≤ `b`.
    fn between(&self, a: f64, b: f64) -> f64;
}

/// The variable of the fan angle that a density is given in.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Variable {
    Tan,
    Angle,
    Sin,
    Tabulated,
}

impl Variable {
    /// Returns the number that identifies the variable in a placed light.
    pub(crate) const fn code(self) -> f64 {
        match self {
            Self::Tan => 0.0,
            Self::Angle => 1.0,
            Self::Sin => 2.0,
            Self::Tabulated => 3.0,
        }
    }

    #[inline(always)]
    fn from_code(code: f64) -> Self {
        if code < 0.5 {
            Self::Tan
        } else if code < 1.5 {
            Self::Angle
        } else if code < 2.5 {
            Self::Sin
        } else {
            Self::Tabulated
        }
    }

    /// Returns the variable at a slope.
    #[inline(always)]
    fn at(self, u: f64) -> f64 {
        match self {
            Self::Tan | Self::Tabulated => u,
            Self::Angle => u.atan(),
            Self::Sin => u / secant([u]),
        }
    }

    /// Returns the slope at a value of the variable; values beyond its ends count as the ends.
    pub(super) fn slope(self, v: f64) -> f64 {
        let slope = match self {
            Self::Tan | Self::Tabulated => v,
            Self::Angle => v.clamp(-FRAC_PI_2, FRAC_PI_2).tan(),
            Self::Sin => {
                let v = v.clamp(-1.0, 1.0);
                v / ((1.0 - v) * (1.0 + v)).sqrt()
            }
        };
        slope.clamp(-STEEPEST, STEEPEST)
    }
}

/// A uniform density on [−flat, flat], convolved with a normal density of standard deviation sigma,
/// in a variable of the fan angle.
///
/// All line profiles except the tabulated one are of this kind: `flat = 0` is a Gaussian,
/// `sigma = 0` a top hat.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SlopeDensity {
    /// The number of the variable; see [`Variable`].
    pub(crate) variable: f64,
    pub(crate) flat: f64,
    pub(crate) sigma: f64,
    /// The fraction of the density inside the range of the variable, by which the density is
    /// divided.
    pub(crate) mass: f64,
}

impl SlopeDensity {
    /// A Gaussian with its 1/e² points at ±`edge`.
    pub(crate) const fn gaussian(variable: Variable, edge: f64, mass: f64) -> Self {
        Self {
            variable: variable.code(),
            flat: 0.0,
            sigma: 0.5 * edge,
            mass,
        }
    }

    /// A uniform density on [−flat, flat] with the roll-off `sigma`.
    pub(crate) const fn uniform(variable: Variable, flat: f64, sigma: f64) -> Self {
        Self {
            variable: variable.code(),
            flat,
            sigma,
            mass: 1.0,
        }
    }
}

impl SlopeProfile for SlopeDensity {
    #[inline(always)]
    fn per_slope(&self, u: f64) -> f64 {
        let sec_sq = 1.0 + u * u;
        match self.variable() {
            Variable::Tan => self.in_variable(u),
            Variable::Angle => self.in_variable(Variable::Angle.at(u)) / sec_sq,
            Variable::Sin => {
                let sec = sec_sq.sqrt();
                self.in_variable(u / sec) / (sec_sq * sec)
            }
            Variable::Tabulated => 0.0,
        }
    }

    fn per_angle(&self, u: f64) -> f64 {
        let sec_sq = 1.0 + u * u;
        match self.variable() {
            Variable::Tan => self.in_variable(u) * sec_sq,
            Variable::Angle => self.in_variable(Variable::Angle.at(u)),
            Variable::Sin => {
                let sec = sec_sq.sqrt();
                self.in_variable(u / sec) / sec
            }
            Variable::Tabulated => 0.0,
        }
    }

    /// Normal distributions add their variances.
    #[expect(clippy::imprecise_flops, reason = "no square is out of range")]
    fn spread_per_angle(&self, u: f64, sigma: f64) -> f64 {
        let sec_sq = 1.0 + u * u;
        let added = match self.variable() {
            Variable::Tan | Variable::Tabulated => sigma * sec_sq,
            Variable::Angle => sigma,
            Variable::Sin => sigma / sec_sq.sqrt(),
        };
        let sigma = (self.sigma * self.sigma + added * added).sqrt();
        Self { sigma, ..*self }.per_angle(u)
    }

    #[inline(always)]
    fn reaches(&self, u: f64, cutoff: f64) -> bool {
        self.variable().at(u).abs() <= self.end(cutoff)
    }

    fn largest_slope(&self, cutoff: f64) -> f64 {
        self.variable().slope(self.end(cutoff))
    }

    fn quantile(&self, p: f64) -> f64 {
        let mass = self.mass;
        let p = mass * interior(p) + 0.5 * (1.0 - mass);
        self.variable().slope(self.quantile_in_variable(p))
    }

    fn between(&self, a: f64, b: f64) -> f64 {
        let [a, b] = [a, b].map(|u| u.clamp(-STEEPEST, STEEPEST));
        match (a < 0.0, b < 0.0) {
            (true, true) => self.tail(b) - self.tail(a),
            (true, false) => 1.0 - self.tail(a) - self.tail(-b),
            // The upper tail keeps its digits where 1 minus the tail loses them.
            (false, _) => self.tail(-a) - self.tail(-b),
        }
    }
}

impl SlopeDensity {
    #[inline(always)]
    fn variable(&self) -> Variable {
        Variable::from_code(self.variable)
    }

    /// Returns the end of the cut-off, in the variable.
    #[inline(always)]
    fn end(&self, cutoff: f64) -> f64 {
        self.flat + 2.0 * cutoff * self.sigma
    }

    /// Returns the density per unit of the variable.
    #[inline(always)]
    fn in_variable(&self, v: f64) -> f64 {
        let density = if self.flat <= 0.0 {
            normal_density(v, self.sigma)
        } else if self.sigma > 0.0 {
            self.rolled_off(v)
        } else if v.abs() <= self.flat {
            0.5 / self.flat
        } else {
            0.0
        };
        density / self.mass
    }

    /// The uniform density with its roll-off.
    fn rolled_off(&self, v: f64) -> f64 {
        let scale = 1.0 / (SQRT_2 * self.sigma);
        // The difference of complements keeps its digits in the tail.
        let inner = libm::erfc((v.abs() - self.flat) * scale);
        let outer = libm::erfc((v.abs() + self.flat) * scale);
        (inner - outer) / (4.0 * self.flat)
    }

    /// The fraction of the power at slopes below `u`, for u ≤ 0.
    fn tail(&self, u: f64) -> f64 {
        let v = self.variable().at(u);
        let below = if self.flat <= 0.0 {
            0.5 * libm::erfc(-v / (SQRT_2 * self.sigma))
        } else if self.sigma > 0.0 {
            self.rolled_off_tail(v)
        } else {
            0.5 * (1.0 + v / self.flat).max(0.0)
        };
        (below - 0.5 * (1.0 - self.mass)).max(0.0) / self.mass
    }

    /// Inverts the distribution function without the cut at the ends of the variable.
    fn quantile_in_variable(&self, p: f64) -> f64 {
        if self.flat <= 0.0 {
            self.sigma * standard_normal(p)
        } else if self.sigma > 0.0 {
            self.rolled_off_quantile(p)
        } else {
            self.flat * (2.0 * p - 1.0)
        }
    }

    /// Solves `C(v) = p` by Newton's method on `ln C`, which is concave and so converges from
    /// below.
    fn rolled_off_quantile(&self, p: f64) -> f64 {
        const MAX_STEPS: usize = 40;
        let tail = p.min(1.0 - p);
        let target = tail.ln();
        // The quantile of the uniform density alone bounds the root from above.
        let mut v = self.flat * (2.0 * tail - 1.0);
        for _ in 0..MAX_STEPS {
            let cumulative = self.rolled_off_tail(v);
            let step = (target - cumulative.ln()) * cumulative / self.rolled_off(v);
            v += step;
            if step.abs() <= 1e-14 * self.flat {
                break;
            }
        }
        if p < 0.5 { v } else { -v }
    }

    /// The fraction of the uniform density with its roll-off that lies below `v`, for v ≤ 0.
    fn rolled_off_tail(&self, v: f64) -> f64 {
        // H(t) = ∫ Φ dt = t Φ(t) + φ(t)
        let integral = |t: f64| 0.5 * t * libm::erfc(-t / SQRT_2) + normal_density(t, 1.0);
        let (inner, outer) = ((v + self.flat) / self.sigma, (v - self.flat) / self.sigma);
        0.5 * self.sigma / self.flat * (integral(inner) - integral(outer))
    }
}
