use core::f64::consts::{FRAC_PI_2, LN_2, PI, TAU};

use num_complex::Complex;
use tem00_numerics::{
    check, normal_quantile,
    quadrature::{for_each_node, integrate},
    sinc,
};

use crate::{Refusal, chebyshev::Tabulated};

/// The spectrum of a laser or of another narrow source.
///
/// ```text
/// S(k) = Σ wⱼ P(k − kⱼ)              Σ wⱼ = 1, P of unit area
/// γ(l) = ∫ S(k) e^{i(k − k₀)l} dk    degree of coherence at the path difference l
/// R(κ) = ∫ S(k) S(k + κ) dk          density of the difference of two draws of the wave number
/// ```
///
/// One peak represents a single line, several peaks the modes of a cavity; all peaks have one shape
/// P. Linewidths are full widths at half maximum of the power per wavelength; internally, all
/// quantities are wave numbers.
///
/// # Validity
///
/// Widths must be small compared with the wavelength, at most a tenth of it. Up to this limit a
/// shape in wavelength is equivalent to the same shape in wave number, and a pupil in units of the
/// wavelength is the same for the whole line.
///
/// # Examples
///
/// A single-mode laser is coherent over all its paths, a superluminescent diode of 20 nm over some
/// 20 µm:
///
/// ```
/// use tem00_coherence::{PeakShape, Spectrum};
///
/// let laser = Spectrum::monochromatic(650e-9)?;
/// assert_eq!(laser.squared_coherence(1.0), 1.0);
/// let diode = Spectrum::new(650e-9, 20e-9, PeakShape::Gaussian)?;
/// assert!((diode.coherence_length() - 14.03e-6).abs() < 0.01e-6);
/// # Ok::<(), tem00_coherence::Refusal>(())
/// ```
///
/// # References
///
/// - J. W. Goodman, *Statistical Optics*, 1985, ch. 5.
#[derive(Clone, Debug, PartialEq)]
pub struct Spectrum {
    wavelength: f64,
    shape: PeakShape,
    /// Width of a peak in rad/m: standard deviation, half width or full width, depending on its
    /// shape; 0 without a width.
    width: f64,
    peaks: Vec<Peak>,
}

/// The shape of a peak.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub enum PeakShape {
    /// A normal distribution: many modes under a gain curve, inhomogeneous broadening, a filter.
    #[default]
    Gaussian,
    /// A Cauchy distribution, with long wings: spontaneous emission, a single mode of a diode.
    Lorentzian,
    /// A constant density between two ends: a wavelength that is swept during the exposure.
    Rectangular,
}

/// A peak of a spectrum.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Peak {
    /// Wave number relative to the wave number of the line, in rad/m.
    offset: f64,
    /// The fraction of the power.
    weight: f64,
}

/// The range of wavelengths in metres.
pub(crate) const WAVELENGTHS: [f64; 2] = [10e-9, 1e-3];

/// The largest linewidth as a fraction of the wavelength.
const MAX_RELATIVE_WIDTH: f64 = 0.1;
/// The largest number of peaks whose widths are included in the modes.
const MAX_WIDE_PEAKS: usize = 24;
/// The largest number of peaks whose pairs are evaluated one by one.
const MAX_PEAKS_IN_PAIRS: usize = 8;
/// Standard deviations of a Gaussian and half widths of a Lorentzian beyond which the density is
/// negligible: 1e−16 of the Gaussian and 1e−12 of the Lorentzian lie beyond.
const GAUSSIAN_REACH: f64 = 8.5;
const LORENTZIAN_REACH: f64 = 1e12;

impl Spectrum {
    /// The largest number of peaks.
    pub const MAX_PEAKS: usize = 256;

    /// Creates light of one wavelength, in metres.
    ///
    /// # Errors
    ///
    /// Returns an error unless the wavelength is positive and finite.
    pub fn monochromatic(wavelength: f64) -> Result<Self, Refusal> {
        Self::new(wavelength, 0.0, PeakShape::Gaussian)
    }

    /// Creates a line from its central wavelength and its linewidth, both in metres.
    ///
    /// # Errors
    ///
    /// Returns an error unless the wavelength is positive and finite and the linewidth lies between
    /// 0 and a tenth of the wavelength.
    pub fn new(wavelength: f64, linewidth: f64, shape: PeakShape) -> Result<Self, Refusal> {
        let single = Peak {
            offset: 0.0,
            weight: 1.0,
        };
        Self::checked(wavelength, vec![single])?.with_linewidth(linewidth, shape)
    }

    /// Creates `count` equal peaks without a width, with the distance `span` between the first and
    /// the last, in metres: the longitudinal modes of a cavity.
    ///
    /// # Errors
    ///
    /// Returns the errors of [`new`](Self::new) for the span, and an error unless there are between
    /// 1 and `MAX_PEAKS` peaks.
    pub fn comb(wavelength: f64, span: f64, count: usize) -> Result<Self, Refusal> {
        let width = full_width(wavelength, span, "span")?;
        let place = |j: usize| match count {
            1 => 0.0,
            _ => j as f64 / (count - 1) as f64 - 0.5,
        };
        let peaks = (0..count).map(|j| Peak {
            offset: width * place(j),
            weight: (count as f64).recip(),
        });
        Self::checked(wavelength, peaks.take(Self::MAX_PEAKS + 1).collect())
    }

    /// Creates peaks without a width from wavelengths in metres, each with its power in any unit.
    /// The wavelength of the line is the wavelength of the mean wave number.
    ///
    /// # Errors
    ///
    /// Returns an error unless there are between 1 and `MAX_PEAKS` peaks, they lie within a tenth
    /// of the wavelength, and their powers are finite and positive.
    pub fn from_peaks(peaks: &[[f64; 2]]) -> Result<Self, Refusal> {
        check_count(peaks.len())?;
        for &[wavelength, power] in peaks {
            check::range("wavelength", wavelength, WAVELENGTHS, "m")?;
            check::positive("power", power, "")?;
        }
        let largest = peaks.iter().fold(0.0, |max: f64, peak| max.max(peak[1]));
        let total: f64 = peaks.iter().map(|peak| peak[1] / largest).sum();
        let peaks = peaks.iter().map(|&[wavelength, power]| Peak {
            offset: TAU / wavelength,
            weight: power / largest / total,
        });
        let mut peaks: Vec<Peak> = peaks.collect();
        let mean: f64 = peaks.iter().map(|peak| peak.offset * peak.weight).sum();
        for peak in &mut peaks {
            peak.offset -= mean;
            if peak.offset.abs() > MAX_RELATIVE_WIDTH * mean {
                let wavelength = TAU / (peak.offset + mean);
                let refusal = Refusal::new("wavelength", wavelength, "within a tenth of the mean");
                return Err(refusal.in_unit("m"));
            }
        }
        Self::checked(TAU / mean, peaks)
    }

    /// Returns the line with a linewidth and a shape for each of its peaks.
    ///
    /// # Errors
    ///
    /// Returns the errors of [`new`](Self::new).
    pub fn with_linewidth(self, linewidth: f64, shape: PeakShape) -> Result<Self, Refusal> {
        let full = full_width(self.wavelength(), linewidth, "linewidth")?;
        let width = match shape {
            PeakShape::Gaussian => full / (8.0 * LN_2).sqrt(),
            PeakShape::Lorentzian => 0.5 * full,
            PeakShape::Rectangular => full,
        };
        Ok(Self {
            shape,
            width,
            ..self
        })
    }

    fn checked(wavelength: f64, peaks: Vec<Peak>) -> Result<Self, Refusal> {
        check_count(peaks.len())?;
        Ok(Self {
            wavelength: check::range("wavelength", wavelength, WAVELENGTHS, "m")?,
            shape: PeakShape::Gaussian,
            width: 0.0,
            peaks,
        })
    }

    /// Returns the wavelength of the mean wave number, in metres.
    pub const fn wavelength(&self) -> f64 {
        self.wavelength
    }

    /// Returns the mean wave number k₀ = 2π/λ, in rad/m.
    pub const fn wave_number(&self) -> f64 {
        TAU / self.wavelength
    }

    /// Returns whether all light has one wavelength.
    pub fn is_monochromatic(&self) -> bool {
        self.width == 0.0 && self.peaks.len() == 1
    }

    /// Returns the standard deviation of the wave number in rad/m: infinite for a Lorentzian.
    pub fn wave_number_spread(&self) -> f64 {
        let within = match self.shape {
            PeakShape::Gaussian => self.width.powi(2),
            PeakShape::Lorentzian if self.width > 0.0 => f64::INFINITY,
            PeakShape::Lorentzian => 0.0,
            PeakShape::Rectangular => self.width.powi(2) / 12.0,
        };
        let moment = |power| {
            self.peaks
                .iter()
                .map(move |peak| peak.weight * peak.offset.powi(power))
        };
        let between = moment(2).sum::<f64>() - moment(1).sum::<f64>().powi(2);
        (within + between.max(0.0)).sqrt()
    }

    /// Returns the complex degree of coherence γ at a path difference, in metres, without the phase
    /// of the mean wave.
    pub fn coherence(&self, path: f64) -> Complex<f64> {
        let x = self.width * path;
        let within = match self.shape {
            PeakShape::Gaussian => (-0.5 * x * x).exp(),
            PeakShape::Lorentzian => (-x.abs()).exp(),
            PeakShape::Rectangular => sinc(0.5 * x),
        };
        let peaks = self.peaks.iter();
        // A phase that overflows counts as random: its mean phasor is 0.
        let phase = |peak: &Peak| Some(peak.offset * path).filter(|phase| phase.is_finite());
        let between = peaks.map(|peak| {
            phase(peak).map_or(Complex::ZERO, |phase| {
                Complex::from_polar(peak.weight, phase)
            })
        });
        within * between.sum::<Complex<f64>>()
    }

    /// Returns `|γ|²` at a path difference, in metres.
    pub fn squared_coherence(&self, path: f64) -> f64 {
        self.coherence(path).norm_sqr()
    }

    /// Returns the coherence length ∫ |γ|² dl over all path differences, in metres: for one
    /// Gaussian peak 0.664 λ²/Δλ. It is infinite for peaks without a width.
    pub fn coherence_length(&self) -> f64 {
        TAU * self.mean_over_differences(|offset| match self.width > 0.0 {
            true => self.pair_density(offset),
            false => f64::INFINITY,
        })
    }

    /// Returns the mean `∫ R(κ) f(κ) dκ` of a function over the difference κ of two wave numbers of
    /// the line, in rad/m.
    ///
    /// `scale` is the width of the finest feature of f; f may have a cusp at 0, and far away it
    /// decreases or is constant.
    pub fn mean_over_pairs(&self, scale: f64, f: impl Fn(f64) -> f64) -> f64 {
        let of_offset = |offset| match self.has_width() {
            true => self.mean_over_peaks(offset, scale, &f),
            false => f(offset),
        };
        if !self.has_many_pairs() {
            return self.mean_over_differences(of_offset);
        }
        let offsets = self.peaks.iter().map(|peak| peak.offset.abs());
        let farthest = 2.0 * offsets.fold(f64::MIN_POSITIVE, f64::max);
        let breaks = breaks_about([(0.0, scale)], 1.01 * farthest);
        let of_offset = Tabulated::new(breaks, of_offset);
        self.mean_over_differences(|offset| of_offset.at(offset))
    }

    /// Returns whether the peaks have a width.
    pub(crate) fn has_width(&self) -> bool {
        self.width > 0.0
    }

    /// Returns whether there are enough peaks that a function of their differences is tabulated.
    pub(crate) const fn has_many_pairs(&self) -> bool {
        self.peaks.len() > MAX_PEAKS_IN_PAIRS
    }

    /// The mean over pairs of peaks, of a function of their difference.
    fn mean_over_differences(&self, of_offset: impl Fn(f64) -> f64) -> f64 {
        let pairs = self
            .peaks
            .iter()
            .flat_map(|first| self.peaks.iter().map(move |second| (first, second)));
        pairs
            .map(|(first, second)| {
                first.weight * second.weight * of_offset(first.offset - second.offset)
            })
            .sum()
    }

    /// Returns the difference κ between a wave number drawn from the line and the mean one, in
    /// rad/m, for a uniform number between 0 and 1.
    ///
    /// The difference increases with the uniform number within a peak; the peaks follow in the
    /// order in which they were given. The wings of a Lorentzian end at a tenth of the mean wave
    /// number.
    pub fn draw(&self, uniform: f64) -> f64 {
        let mut rest = uniform.clamp(0.0, 1.0);
        let last = self.peaks.len() - 1;
        for (index, peak) in self.peaks.iter().enumerate() {
            if rest <= peak.weight || index == last {
                let within = (rest / peak.weight).clamp(1e-15, 1.0 - 1e-15);
                let reach = MAX_RELATIVE_WIDTH * self.wave_number();
                let drawn = self.width * self.shape.quantile(within);
                return peak.offset + drawn.clamp(-reach, reach);
            }
            rest -= peak.weight;
        }
        0.0
    }

    /// Returns the standard deviation, in rad/m, of a Gaussian line that is as wide as this one
    /// between the quantiles of 12 % and 88 %, where a Gaussian has half its maximum.
    pub fn effective_spread(&self) -> f64 {
        let tail = 0.5 * libm::erfc(LN_2.sqrt());
        (self.draw(1.0 - tail) - self.draw(tail)).abs() / (8.0 * LN_2).sqrt()
    }

    /// Returns wave numbers, relative to the mean one, with the fractions of the power that they
    /// represent in an integral. Each peak with a width has 16 nodes or more, as many as a function
    /// needs whose finest feature is `scale` wide. Returns `None` if more than `max` nodes are
    /// needed. With more than 24 peaks the widths are neglected.
    pub(crate) fn nodes(&self, scale: f64, max: usize) -> Option<Vec<[f64; 2]>> {
        let is_wide = self.width > 0.0 && self.peaks.len() <= MAX_WIDE_PEAKS;
        let fewest = if self.peaks.len() <= 4 { 4.0 } else { 1.0 };
        let panels = (self.width / scale).ceil().max(fewest);
        if is_wide && panels > max as f64 {
            return None;
        }
        let mut nodes = Vec::new();
        for peak in &self.peaks {
            if is_wide {
                self.shape.for_each_node(panels, |x, weight| {
                    nodes.push([peak.offset + self.width * x, peak.weight * weight]);
                });
            } else {
                nodes.push([peak.offset, peak.weight]);
            }
        }
        Some(nodes).filter(|nodes| nodes.len() <= max)
    }

    /// The density of the difference of two draws from one peak.
    fn pair_density(&self, kappa: f64) -> f64 {
        self.shape.pair_density(kappa / self.width) / self.width
    }

    /// ∫ f(κ) times the density of the difference of two draws from two peaks that are `offset`
    /// apart.
    fn mean_over_peaks(&self, offset: f64, scale: f64, f: &impl Fn(f64) -> f64) -> f64 {
        // Lengths are in widths of a peak, whose reciprocal may overflow.
        let width = self.width;
        let reach = match self.shape {
            PeakShape::Gaussian => 2.0_f64.sqrt() * GAUSSIAN_REACH,
            PeakShape::Lorentzian => LORENTZIAN_REACH,
            PeakShape::Rectangular => 1.0,
        };
        let integrand = |x: f64| self.shape.pair_density(x) * f(offset + width * x);
        breaks_about([(-offset / width, scale / width), (0.0, 1.0)], reach)
            .windows(2)
            .map(|ends| integrate(integrand, [ends[0], ends[1]], f64::INFINITY))
            .sum()
    }
}

impl PeakShape {
    /// The density of the difference of two draws from a peak of width 1.
    fn pair_density(self, x: f64) -> f64 {
        match self {
            Self::Gaussian => (-0.25 * x * x).exp() / (4.0 * PI).sqrt(),
            Self::Lorentzian => 2.0 / (PI * (4.0 + x * x)),
            Self::Rectangular => (1.0 - x.abs()).max(0.0),
        }
    }

    /// The quantile `u` of a peak of width 1.
    fn quantile(self, u: f64) -> f64 {
        match self {
            Self::Gaussian => normal_quantile(u),
            Self::Lorentzian => (PI * (u - 0.5)).tan(),
            Self::Rectangular => u - 0.5,
        }
    }

    /// Calls `visit` with nodes of a peak of width 1 and their fractions of its power, 16 on each
    /// panel.
    fn for_each_node(self, panels: f64, mut visit: impl FnMut(f64, f64)) {
        let (reach, width) = match self {
            Self::Gaussian => (5.5, 11.0),
            Self::Lorentzian => (FRAC_PI_2, PI),
            Self::Rectangular => (0.5, 1.0),
        };
        for_each_node([-reach, reach], width / panels, |x, weight| match self {
            Self::Gaussian => visit(x, weight * (-0.5 * x * x).exp() / TAU.sqrt()),
            Self::Lorentzian => visit(x.tan(), weight / PI),
            Self::Rectangular => visit(x, weight),
        });
    }
}

/// Returns breaks between −reach and reach, finer about features, each a centre and a width.
pub(crate) fn breaks_about(features: impl IntoIterator<Item = (f64, f64)>, reach: f64) -> Vec<f64> {
    let mut breaks = Vec::new();
    for (centre, feature) in features {
        let steps = ladder()
            .map(|step| step * feature)
            .take_while(|step| *step < 4.0 * reach);
        breaks.extend(steps.flat_map(|step| [centre - step, centre + step]));
        breaks.push(centre);
    }
    breaks.retain(|x: &f64| x.abs() < reach);
    breaks.extend([-reach, reach]);
    breaks.sort_unstable_by(f64::total_cmp);
    breaks
}

/// The largest step away from a feature, in widths of the feature.
pub(crate) const LADDER_END: f64 = (1_u64 << 59) as f64;

/// Steps away from a feature of width 1: evenly spaced nearby, doubling far away.
fn ladder() -> impl Iterator<Item = f64> {
    let near = (1..=16).map(|step| 0.5 * f64::from(step));
    near.chain((4..60).map(|power| 2.0_f64.powi(power)))
}

fn check_count(peaks: usize) -> Result<(), Refusal> {
    let holds = (1..=Spectrum::MAX_PEAKS).contains(&peaks);
    check::that(holds, "peaks", peaks, "", "from 1 to 256")
}

/// Converts a width in wavelength to a width in wave number.
fn full_width(wavelength: f64, width: f64, parameter: &'static str) -> Result<f64, Refusal> {
    check::range("wavelength", wavelength, WAVELENGTHS, "m")?;
    let holds = width >= 0.0 && width <= MAX_RELATIVE_WIDTH * wavelength;
    check::that(
        holds,
        parameter,
        width,
        "m",
        "from 0 to a tenth of the wavelength",
    )?;
    Ok(TAU / wavelength * (width / wavelength))
}

#[cfg(test)]
mod tests;
