use core::f64::consts::{FRAC_2_SQRT_PI, SQRT_2};

use tem00_numerics::{Minimum, Residual, check, minimise_residuals};

use super::error::FitError;
use super::positions::{Axis, Estimate, check_count};

/// A Gaussian beam fitted to the power that passes a knife edge moved across it.
///
/// The model is the integral of a Gaussian irradiance of 1/e² radius `w` and centre `x₀`, with an
/// optional background `B` that the edge does not change:
///
/// ```text
/// P(x) = P₀/2 · erfc(±√2 (x − x₀) / w) + B
/// ```
///
/// The sign follows from the data: the power may rise or fall with the position of the edge. Powers
/// may have any unit, and their errors are assumed equal; the size of the errors follows from the
/// scatter of the data.
///
/// # Examples
///
/// A trace across a beam of about half a millimetre:
///
/// ```
/// use tem00_optics::KnifeEdgeFit;
///
/// let positions = [0.0, 0.2e-3, 0.4e-3, 0.6e-3, 0.8e-3, 1.0e-3, 1.2e-3];
/// let powers = [0.00, 0.06, 0.34, 1.00, 1.66, 1.94, 2.00]; // mW
/// let fit = KnifeEdgeFit::new(&positions, &powers)?;
///
/// assert!((fit.radius().value - 0.421e-3).abs() < 0.003e-3);
/// assert!((fit.centre().value - 0.6e-3).abs() < 0.001e-3);
/// assert!((fit.power().value - 2.0).abs() < 0.01);
/// # Ok::<(), tem00_optics::FitError>(())
/// ```
///
/// # References
///
/// - J. M. Khosrofian and B. A. Garetz, Applied Optics 22, 3406, 1983, for the method.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct KnifeEdgeFit {
    radius: Estimate,
    centre: Estimate,
    power: Estimate,
    background: Option<Estimate>,
    residual_deviation: f64,
    /// The sign in the argument of erfc: 1 if the power falls with the position, −1 if it rises.
    direction: f64,
}

impl KnifeEdgeFit {
    /// Fits radius, centre and power to the powers, in any unit, that pass a knife edge at the
    /// given positions, in metres, on the assumption that no power passes the closed edge.
    ///
    /// # Errors
    ///
    /// Returns an error if the lists differ in length or hold fewer than 4 points, if a value is
    /// not finite or beyond 1e30, or if the data do not determine a beam: all positions are the
    /// same, the power does not change, or it jumps between two positions.
    pub fn new(positions: &[f64], powers: &[f64]) -> Result<Self, FitError> {
        Self::fit::<3>(positions, powers)
    }

    /// Fits radius, centre, power and a constant background to the powers, in any unit, that pass a
    /// knife edge at the given positions, in metres.
    ///
    /// # Errors
    ///
    /// Returns the errors of [`new`](Self::new), and an error if there are fewer than 5 points.
    pub fn with_background(positions: &[f64], powers: &[f64]) -> Result<Self, FitError> {
        Self::fit::<4>(positions, powers)
    }

    fn fit<const N: usize>(positions: &[f64], powers: &[f64]) -> Result<Self, FitError> {
        check_count(positions, powers, N + 1)?;
        let trace = Trace::new(positions, powers, N > BACKGROUND)?;
        let count = powers.len();
        let minimum = minimise_residuals(trace.start::<N>(), count, |p, i| trace.residual(p, i))?;
        let variance = minimum.sum_of_squares / (count - N) as f64;
        Self::from_minimum(&trace, &minimum, variance)
    }

    fn from_minimum<const N: usize>(
        trace: &Trace,
        minimum: &Minimum<[f64; N]>,
        variance: f64,
    ) -> Result<Self, FitError> {
        let p = &minimum.state;
        let variance_of = |i: usize| variance * minimum.covariance[i][i];
        if p[POWER] <= 0.0 {
            return Err(FitError::NoEdge);
        }
        let radius = trace.axis.half_range * p[LN_RADIUS].exp();
        Ok(Self {
            radius: Estimate {
                value: radius,
                standard_error: radius * variance_of(LN_RADIUS).sqrt(),
            },
            centre: trace.axis.position(p[CENTRE], variance_of(CENTRE)),
            power: Estimate {
                value: trace.unit * p[POWER],
                standard_error: trace.unit * variance_of(POWER).sqrt(),
            },
            background: p.get(BACKGROUND).map(|background| Estimate {
                value: trace.floor + trace.unit * background,
                standard_error: trace.unit * variance_of(BACKGROUND).sqrt(),
            }),
            residual_deviation: trace.unit * variance.sqrt(),
            direction: trace.direction,
        })
    }

    /// Returns the 1/e² radius of the beam along the movement of the edge, in metres.
    pub const fn radius(&self) -> Estimate {
        self.radius
    }

    /// Returns the position of the centre of the beam, in metres.
    pub const fn centre(&self) -> Estimate {
        self.centre
    }

    /// Returns the power of the whole beam, in the unit of the measured powers.
    pub const fn power(&self) -> Estimate {
        self.power
    }

    /// Returns the background, in the unit of the measured powers, if one was fitted.
    pub const fn background(&self) -> Option<Estimate> {
        self.background
    }

    /// Returns the standard deviation of the data from the fit, in the unit of the measured powers.
    pub const fn residual_deviation(&self) -> f64 {
        self.residual_deviation
    }

    /// Returns the fitted power, in the unit of the measured powers, that passes an edge at
    /// `position`, in metres.
    pub fn power_at(&self, position: f64) -> f64 {
        let distance = (position - self.centre.value) / self.radius.value;
        let passed = 0.5 * libm::erfc(self.direction * SQRT_2 * distance);
        let background = self.background.map_or(0.0, |background| background.value);
        self.power.value * passed + background
    }
}

/// The indices of the parameters; a fit without background lacks its parameter.
const POWER: usize = 0;
const CENTRE: usize = 1;
const LN_RADIUS: usize = 2;
const BACKGROUND: usize = 3;

/// The data of a fit, in coordinates of order 1.
#[derive(Clone, Debug)]
struct Trace {
    axis: Axis,
    /// Measured powers are `floor + unit · power`.
    floor: f64,
    unit: f64,
    powers: Vec<f64>,
    direction: f64,
}

impl Trace {
    fn new(positions: &[f64], powers: &[f64], with_floor: bool) -> Result<Self, FitError> {
        let axis = Axis::new(positions)?;
        check::each(powers, |power| {
            check::range("powers", power, [-1e30, 1e30], "")
        })?;
        let minimum = powers.iter().copied().fold(f64::INFINITY, f64::min);
        let maximum = powers.iter().copied().fold(f64::NEG_INFINITY, f64::max);
        let unit = maximum - minimum;
        if unit < f64::MIN_POSITIVE {
            return Err(FitError::NoEdge);
        }
        let floor = if with_floor { minimum } else { 0.0 };
        let powers: Vec<_> = powers.iter().map(|power| (power - floor) / unit).collect();
        let mean = powers.iter().sum::<f64>() / powers.len() as f64;
        let trend: f64 = powers
            .iter()
            .zip(&axis.coordinates)
            .map(|(power, x)| x * (power - mean))
            .sum();
        Ok(Self {
            axis,
            floor,
            unit,
            powers,
            direction: if trend < 0.0 { 1.0 } else { -1.0 },
        })
    }

    fn residual<const N: usize>(&self, p: &[f64; N], i: usize) -> Residual<N> {
        let width = p[LN_RADIUS].exp();
        let t = self.direction * SQRT_2 * (self.axis.coordinates[i] - p[CENTRE]) / width;
        let passed = 0.5 * libm::erfc(t);
        // −∂passed / ∂t
        let density = 0.5 * FRAC_2_SQRT_PI * (-t * t).exp();
        let background = p.get(BACKGROUND).copied().unwrap_or(0.0);
        let mut slopes = [-1.0; N];
        slopes[POWER] = -passed;
        slopes[CENTRE] = -p[POWER] * density * self.direction * SQRT_2 / width;
        slopes[LN_RADIUS] = -p[POWER] * density * t;
        Residual {
            value: self.powers[i] - p[POWER] * passed - background,
            slopes,
        }
    }

    /// The best point of a grid of centres over the range of the positions and of radii from twice
    /// this range downwards.
    fn start<const N: usize>(&self) -> [f64; N] {
        let max = self
            .powers
            .iter()
            .copied()
            .fold(f64::NEG_INFINITY, f64::max);
        let sum_of_squares = |p: &[f64; N]| -> f64 {
            let residuals = (0..self.powers.len()).map(|i| self.residual(p, i).value);
            residuals.map(|value| value * value).sum()
        };
        let centres = (-16..=16).map(|step| f64::from(step) / 16.0);
        let grid = centres.flat_map(|centre| {
            (-8..=2).map(move |exponent| {
                let mut p = [0.0; N];
                p[POWER] = max;
                p[CENTRE] = centre;
                p[LN_RADIUS] = f64::from(exponent) * core::f64::consts::LN_2;
                p
            })
        });
        let candidates = grid.map(|p| (sum_of_squares(&p), p));
        let best = candidates.min_by(|(a, _), (b, _)| a.total_cmp(b));
        best.map_or([0.0; N], |(_, p)| p)
    }
}

#[cfg(test)]
mod tests;
