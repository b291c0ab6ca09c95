use core::f64::consts::PI;

use tem00_beam::{GaussianBeam, LocatedBeam, Refusal};
use tem00_numerics::{Minimum, Residual, check, minimise_residuals};

use super::error::FitError;
use super::positions::{Axis, Estimate, check_count};

/// Assumption about the errors of measured beam radii.
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub enum RadiusErrors<'a> {
    /// Errors are proportional to the radius; the factor follows from the residuals.
    Relative,
    /// All radii have equal errors; their size follows from the residuals.
    Equal,
    /// The standard deviation of each radius is known, in metres. The standard errors follow from
    /// these values and do not depend on the scatter of the data.
    Known(&'a [f64]),
}

/// A Gaussian beam fitted to its radius measured at several positions: its caustic.
///
/// The model has three parameters, the waist radius `w₀`, the divergence `δ` and the position `z₀`
/// of the waist:
///
/// ```text
/// w(z) = √(w₀² + δ² (z − z₀)²)
/// M²   = π w₀ δ / λ
/// ```
///
/// By default the radii have *relative* errors, and the fit minimises the squares of
/// `ln(w_measured / w)`: a camera measures D4σ with an error proportional to the width, so that
/// with equal errors the noise of the far field would dominate the waist.
/// [`with_errors`](Self::with_errors) takes other assumptions. Standard errors are linear: they
/// assume that the curvature of the model over the error of a parameter is small. M² is not
/// constrained to values of at least 1: noise may reduce it below 1.
///
/// # Validity
///
/// The radii are second-moment radii, half of D4σ, on one axis of a beam whose axes do not rotate.
/// ISO 11146-1 requires at least ten positions, about half of them within one Rayleigh length of
/// the waist and half beyond two. A fit to fewer positions, or to positions on one side only, works
/// as well, with larger standard errors.
///
/// # Examples
///
/// A focused fibre laser at 1064 nm, measured with a scatter of about 1 %:
///
/// ```
/// use tem00_optics::CausticFit;
///
/// let positions = [0.0, 0.02, 0.03, 0.04, 0.05, 0.06, 0.07, 0.08, 0.10, 0.12];
/// let radii = [
///     424e-6, 267e-6, 187e-6, 122e-6, 88e-6, 122e-6, 188e-6, 262e-6, 424e-6, 598e-6,
/// ];
/// let fit = CausticFit::new(1064e-9, &positions, &radii)?;
///
/// assert!((fit.waist_position().value - 0.05).abs() < 0.1e-3);
/// let m_squared = fit.m_squared();
/// assert!((m_squared.value - 2.2).abs() < 0.05, "{m_squared:?}");
/// assert!(m_squared.standard_error < 0.03);
/// # Ok::<(), tem00_optics::FitError>(())
/// ```
///
/// # References
///
/// - ISO 11146-1, 2021, whose polynomial fit of `w²` is the start of the search.
/// - A. E. Siegman, *How to (Maybe) Measure Laser Beam Quality*, OSA TOPS 17, 1998.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct CausticFit {
    wavelength: f64,
    waist_radius: Estimate,
    waist_position: Estimate,
    divergence: Estimate,
    rayleigh_range: Estimate,
    beam_parameter_product: Estimate,
    residual_deviation: f64,
}

impl CausticFit {
    /// Fits a beam of the given wavelength to the radii measured at the given positions, all in
    /// metres, with errors proportional to the radius.
    ///
    /// # Errors
    ///
    /// Returns an error if the lists differ in length or hold fewer than 4 points, if the
    /// wavelength or a radius is not a length from 1e−30 m to 1e30 m, if a position is not finite
    /// or beyond 1e30 m, or if the data do not determine a beam: all positions are the same, or the
    /// radius shows no divergence.
    pub fn new(wavelength: f64, positions: &[f64], radii: &[f64]) -> Result<Self, FitError> {
        Self::with_errors(wavelength, positions, radii, RadiusErrors::Relative)
    }

    /// Fits a beam of the given wavelength to the radii measured at the given positions, all in
    /// metres, with the given errors.
    ///
    /// # Errors
    ///
    /// Returns the errors of [`new`](Self::new), and an error if a known standard deviation is
    /// missing or not a length from 1e−30 m to 1e30 m.
    pub fn with_errors(
        wavelength: f64,
        positions: &[f64],
        radii: &[f64],
        errors: RadiusErrors<'_>,
    ) -> Result<Self, FitError> {
        let data = Caustic::new(positions, radii, errors)?;
        check::length("wavelength", wavelength)?;
        let count = radii.len();
        let from_polynomial = data.polynomial().map(|start| data.search(start));
        let minimum = match from_polynomial {
            Some(Ok(minimum)) => minimum,
            _ => data.search(data.guess()?)?,
        };
        let variance = minimum.sum_of_squares / (count - PARAMETERS) as f64;
        Ok(Self::from_minimum(wavelength, &data, &minimum, variance))
    }

    fn from_minimum(
        wavelength: f64,
        data: &Caustic<'_>,
        minimum: &Minimum<[f64; PARAMETERS]>,
        variance: f64,
    ) -> Self {
        let (scale, residual_unit) = match data.errors {
            RadiusErrors::Relative => (variance, 1.0),
            RadiusErrors::Equal => (variance, data.unit),
            RadiusErrors::Known(_) => (1.0, 1.0),
        };
        let covariance = |i: usize, j: usize| scale * minimum.covariance[i][j];
        let [ln_waist, coordinate, ln_divergence] = minimum.state;
        let waist_radius = data.unit * ln_waist.exp();
        let divergence = data.unit / data.axis.half_range * ln_divergence.exp();
        let (of_waist, of_divergence) = (covariance(0, 0), covariance(2, 2));
        let both = 2.0 * covariance(0, 2);
        Self {
            wavelength,
            waist_radius: from_logarithm(waist_radius, of_waist),
            waist_position: data.axis.position(coordinate, covariance(1, 1)),
            divergence: from_logarithm(divergence, of_divergence),
            rayleigh_range: from_logarithm(
                waist_radius / divergence,
                of_waist + of_divergence - both,
            ),
            beam_parameter_product: from_logarithm(
                waist_radius * divergence,
                of_waist + of_divergence + both,
            ),
            residual_deviation: residual_unit * variance.sqrt(),
        }
    }

    /// Returns the waist radius `w₀`, in metres.
    pub const fn waist_radius(&self) -> Estimate {
        self.waist_radius
    }

    /// Returns the position `z₀` of the waist, in metres, on the axis of the measured positions.
    pub const fn waist_position(&self) -> Estimate {
        self.waist_position
    }

    /// Returns the far-field divergence half-angle `δ`, in radians.
    pub const fn divergence(&self) -> Estimate {
        self.divergence
    }

    /// Returns the Rayleigh range `w₀ / δ`, in metres.
    pub const fn rayleigh_range(&self) -> Estimate {
        self.rayleigh_range
    }

    /// Returns the beam parameter product `w₀ δ`, in m·rad; 1e−6 m·rad are 1 mm·mrad.
    pub const fn beam_parameter_product(&self) -> Estimate {
        self.beam_parameter_product
    }

    /// Returns the beam quality factor `M² = π w₀ δ / λ`.
    pub const fn m_squared(&self) -> Estimate {
        let per_product = PI / self.wavelength;
        Estimate {
            value: per_product * self.beam_parameter_product.value,
            standard_error: per_product * self.beam_parameter_product.standard_error,
        }
    }

    /// Returns the standard deviation of the data from the fit: relative to the radius for
    /// [`RadiusErrors::Relative`], in metres for [`RadiusErrors::Equal`], and in units of the known
    /// deviations, where it should be about 1, for [`RadiusErrors::Known`].
    pub const fn residual_deviation(&self) -> f64 {
        self.residual_deviation
    }

    /// Returns the fitted beam radius, in metres, at the position `z`.
    pub fn radius_at(&self, z: f64) -> f64 {
        let distance = z - self.waist_position.value;
        let spread = self.divergence.value * distance;
        self.waist_radius.value.hypot(spread)
    }

    /// Returns the fitted beam, with the origin of the measured positions as reference plane.
    ///
    /// # Errors
    ///
    /// Returns an error if there is no such beam: M² is below 1, or the divergence is beyond the
    /// paraxial limit of 0.5 rad.
    pub fn beam(&self) -> Result<LocatedBeam, Refusal> {
        let beam = GaussianBeam::from_waist(self.wavelength, self.waist_radius.value)?;
        let beam = beam.with_m_squared(self.m_squared().value)?;
        LocatedBeam::new(beam, self.waist_position.value)
    }
}

/// An estimate from the variance of its logarithm.
fn from_logarithm(value: f64, variance: f64) -> Estimate {
    Estimate {
        value,
        standard_error: value * variance.max(0.0).sqrt(),
    }
}

/// ln w₀, the coordinate of the waist, and ln δ: with logarithms waist and divergence stay
/// positive.
const PARAMETERS: usize = 3;

/// The data of a fit, in coordinates of order 1.
#[derive(Clone, Debug)]
struct Caustic<'a> {
    axis: Axis,
    /// The largest radius, in metres: the unit of the other radii.
    unit: f64,
    radii: Vec<f64>,
    errors: RadiusErrors<'a>,
}

impl<'a> Caustic<'a> {
    fn new(positions: &[f64], radii: &[f64], errors: RadiusErrors<'a>) -> Result<Self, FitError> {
        check_count(positions, radii, PARAMETERS + 1)?;
        let axis = Axis::new(positions)?;
        check::each(radii, |radius| check::length("radii", radius))?;
        if let RadiusErrors::Known(deviations) = errors {
            check_count(positions, deviations, PARAMETERS + 1)?;
            check::each(deviations, |deviation| check::length("errors", deviation))?;
        }
        let unit = radii.iter().copied().fold(0.0, f64::max);
        Ok(Self {
            axis,
            unit,
            radii: radii.iter().map(|radius| radius / unit).collect(),
            errors,
        })
    }

    /// The standard deviation of the logarithm of a radius, up to a common factor if it is unknown.
    fn relative_deviation(&self, i: usize) -> f64 {
        match self.errors {
            RadiusErrors::Relative => 1.0,
            RadiusErrors::Equal => 1.0 / self.radii[i],
            RadiusErrors::Known(deviations) => deviations[i] / self.unit / self.radii[i],
        }
    }

    fn residual(&self, p: &[f64; PARAMETERS], i: usize) -> Residual<PARAMETERS> {
        let (waist, divergence) = (p[0].exp(), p[2].exp());
        let spread = divergence * (self.axis.coordinates[i] - p[1]);
        let model = waist.hypot(spread);
        let (radius, deviation) = (self.radii[i], self.relative_deviation(i));
        // ∂ ln w / ∂p is of order 1; absolute errors turn it into ∂w / ∂p.
        let (value, factor) = match self.errors {
            RadiusErrors::Relative => ((radius / model).ln(), 1.0),
            _ => (
                (radius - model) / (radius * deviation),
                model / (radius * deviation),
            ),
        };
        let (near, far) = (waist / model, spread / model);
        let slopes = [near * near, -far * (divergence / model), far * far];
        Residual {
            value,
            slopes: slopes.map(|slope| -factor * slope),
        }
    }

    /// Returns whether waist and divergence both change some radius by more than rounding.
    fn show(&self, p: &[f64; PARAMETERS]) -> bool {
        const ROUNDING: f64 = 1e-12;
        let fraction = |k: usize, i: usize| {
            let slope = self.residual(p, i).slopes[k] * self.relative_deviation(i);
            slope.abs()
        };
        let shows = |k: usize| (0..self.radii.len()).any(|i| fraction(k, i) > ROUNDING);
        shows(0) && shows(2)
    }

    fn search(&self, start: [f64; PARAMETERS]) -> Result<Minimum<[f64; PARAMETERS]>, FitError> {
        let minimum = minimise_residuals(start, self.radii.len(), |p, i| self.residual(p, i))?;
        if self.show(&minimum.state) {
            Ok(minimum)
        } else {
            Err(FitError::Undetermined)
        }
    }

    /// Start of the search: the hyperbola as a polynomial, `w² = a + b z + c z²`, unless the
    /// polynomial has no waist.
    fn polynomial(&self) -> Option<[f64; PARAMETERS]> {
        let minimum = minimise_residuals([0.0; 3], self.radii.len(), |p, i| {
            let (x, square) = (self.axis.coordinates[i], self.radii[i].powi(2));
            let deviation = 2.0 * square * self.relative_deviation(i);
            let slopes = [1.0, x, x * x];
            let model: f64 = slopes.iter().zip(p).map(|(slope, p)| slope * p).sum();
            Residual {
                value: (square - model) / deviation,
                slopes: slopes.map(|slope| -slope / deviation),
            }
        });
        let [a, b, c] = minimum.ok()?.state;
        let waist = a - b * b / (4.0 * c);
        let start = [0.5 * waist.ln(), -b / (2.0 * c), 0.5 * c.ln()];
        (c > 0.0 && waist > 0.0).then_some(start)
    }

    /// Start of the search if the polynomial has no waist: the smallest radius as the waist, and
    /// the steepest line from it as the divergence.
    fn guess(&self) -> Result<[f64; PARAMETERS], FitError> {
        let points = || self.axis.coordinates.iter().zip(&self.radii);
        let (&middle, &waist) = points()
            .min_by(|(_, a), (_, b)| a.total_cmp(b))
            .ok_or(FitError::Undetermined)?;
        let divergence = points()
            .filter(|&(_, &radius)| radius > waist)
            .map(|(x, radius)| ((radius - waist) * (radius + waist)).sqrt() / (x - middle).abs())
            .filter(|slope| slope.is_finite())
            .fold(0.0, f64::max);
        if divergence > 0.0 {
            Ok([waist.ln(), middle, divergence.ln()])
        } else {
            Err(FitError::Undetermined)
        }
    }
}

#[cfg(test)]
mod tests;
