//! Height uncertainty of a set-up, and the source that dominates it.

mod first_order;
mod monte_carlo;
mod term;

use tem00_uncertainty::{CoverageProbability, coverage_factor, effective_degrees_of_freedom};

use crate::{Dorsch, ImagedLine, LightLevel, Setup, TriangulationError};

pub(crate) use self::monte_carlo::{Outcome, Simulator, estimate, in_parallel, invalid};
pub use self::{
    monte_carlo::{MonteCarloEstimate, Simulation, SimulationOptions, simulate},
    term::{BudgetTerm, ErrorDistribution, Evaluation, UncertaintySource},
};

/// The uncertainty budget of a height, after the GUM.
///
/// To first order the position of a line moves with the grey values of its column, δy = Σ gᵢ δIᵢ,
/// for any detector; the sensitivities gᵢ belong to the noise-free column. Each source adds a
/// variance ([`PositionNoise`](crate::PositionNoise)), which the geometry converts to a variance of
/// the height. The variances are means over the position of the line within a pixel.
///
/// # Averages
///
/// Over N columns and M frames shot noise and dark noise fall with √(N M), and so does quantisation
/// as long as the noise exceeds 0.3 grey values, below which all frames round alike (and pixels
/// that are equally dark, too: then rounding moves a line by less than stated). PRNU and DSNU fall
/// with √N: pixels stay what they are from frame to frame. Speckle noise of neighbouring columns is
/// correlated over the length of a speckle; over frames it falls with √M only if each frame has its
/// own speckle. Detector bias and calibration do not average out.
///
/// # Validity
///
/// First order in the fluctuations. Compared with images that were summed wave by wave, the speckle
/// noise of a centre of gravity is within 5 % for lines of at least
/// [`LEAST_SPECKLES`](Self::LEAST_SPECKLES) in full width, in and out of focus, in single columns
/// and means of a few; for means of sixteen it is 3 to 6 % too large. It is too small for thinner
/// lines, by 14 % at 1.2 speckles and a fifth at 0.8; about a third too large for detectors that
/// use three pixels, and half for Steger's, which also uses neighbouring columns. [`simulate`],
/// whose light interferes as waves do, shows by how much, and whether all columns have a line that
/// can be trusted. Pixels count as linear, also where bright grains of speckle exceed the sensor's
/// range; see [`Setup::light_level`].
///
/// A part that lets light in spreads the line to one side: the budget corrects the
/// [shift](Self::subsurface), and its speckle has the contrast that the lengths of the paths in the
/// window of the detector leave. Speckle of light from below the surface counts as new in every
/// frame of a part that moves.
///
/// The [front page](crate) has an example.
///
/// # References
///
/// - JCGM 100:2008, *Guide to the expression of uncertainty in measurement*, ch. 4 to 6 and annex
///   G.
#[derive(Clone, Debug, PartialEq)]
pub struct Budget {
    height: f64,
    terms: Vec<BudgetTerm>,
    speckles: f64,
    line_law: f64,
    dorsch: f64,
    subsurface: Option<SubsurfaceShift>,
}

/// Shift of a line by light from below the surface of the part, as the detector finds it. Measured
/// heights are corrected by it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SubsurfaceShift {
    /// The shift of the line along the column, in pixels.
    pub position: f64,
    /// The error of a height that is not corrected, in metres: negative for a part that reads too
    /// low.
    pub height: f64,
}

impl Budget {
    /// The full width of a line, in speckles, below which its budget does not hold: a column then
    /// has few grains, so that its position is far from linear in their light.
    pub const LEAST_SPECKLES: f64 = 2.0;

    /// Returns the budget of a height at the reference plane.
    ///
    /// # Errors
    ///
    /// Returns [`TriangulationError::NothingMeasured`] if the line
    /// [saturates](LightLevel::Saturated) the sensor, or if the detector finds no line even without
    /// noise.
    pub fn new(setup: &Setup) -> Result<Self, TriangulationError> {
        Self::at_height(setup, 0.0)
    }

    /// Returns the budget of a height of about `height`, in metres.
    ///
    /// # Errors
    ///
    /// Returns the errors of [`new`](Self::new), also if the camera does not see the line there.
    pub fn at_height(setup: &Setup, height: f64) -> Result<Self, TriangulationError> {
        let line = setup.line_at(height).ok_or(NOT_SEEN)?;
        let level = setup.light_level_of(&line);
        if level == LightLevel::Saturated {
            return Err(TriangulationError::NothingMeasured {
                why: "the line saturates the sensor",
                advice: level.advice(),
            });
        }
        Self::of_line(setup, &line, height).ok_or_else(|| no_line(level))
    }

    fn of_line(setup: &Setup, line: &ImagedLine, height: f64) -> Option<Self> {
        let d = setup.description();
        let contrast = d.surface.contrast();
        let law = contrast * line.centroid_deviation(d.average.columns);
        let terms = first_order::terms(setup, line, law)?;
        let frames = match d.average.independent_speckle {
            true => f64::from(d.average.frames),
            false => 1.0,
        };
        let speckles = line.projected_thickness.hypot(line.subsurface_width) / line.speckle_size[1];
        let bandwidth = line.bandwidth;
        let position = law / frames.sqrt();
        let shift = first_order::subsurface_shift(setup, line)?;
        let shift = SubsurfaceShift {
            position: shift,
            height: setup.height_at(line.position + shift)? - height,
        };
        Some(Self {
            subsurface: line.is_spread().then_some(shift),
            height,
            terms,
            speckles,
            line_law: position * line.height_per_pixel.abs() * bandwidth.line_noise_ratio,
            dorsch: dorsch(setup, contrast)? * bandwidth.spot_noise_ratio,
        })
    }

    /// Returns the height that the budget is for, in metres.
    pub const fn height(&self) -> f64 {
        self.height
    }

    /// Returns the full width of the line in the image between the points of 1/e², out of focus but
    /// without diffraction, in speckles.
    pub const fn speckles(&self) -> f64 {
        self.speckles
    }

    /// Returns the shift of the line by light from below the surface, which is corrected and part
    /// of no term; `None` for a part that lets no light in.
    ///
    /// Its uncertainty follows from the values of the set-up: see
    /// [`Measurement`](crate::Measurement).
    pub const fn subsurface(&self) -> Option<SubsurfaceShift> {
        self.subsurface
    }

    /// Returns all terms, in the order of [`UncertaintySource::ALL`].
    pub fn terms(&self) -> &[BudgetTerm] {
        &self.terms
    }

    /// Returns the standard uncertainty by one source alone, in metres.
    pub fn contribution(&self, source: UncertaintySource) -> f64 {
        self.term(source).map_or(0.0, BudgetTerm::contribution)
    }

    pub(crate) fn term(&self, source: UncertaintySource) -> Option<&BudgetTerm> {
        self.terms.iter().find(|term| term.source == source)
    }

    /// Returns the combined standard uncertainty of the height, in metres.
    pub fn combined(&self) -> f64 {
        let squares = self.terms.iter().map(|term| term.contribution().powi(2));
        squares.sum::<f64>().sqrt()
    }

    /// Returns the fraction of a term in the variance of the height, from 0 to 1.
    pub fn variance_fraction(&self, term: &BudgetTerm) -> f64 {
        let combined = self.combined();
        if combined > 0.0 {
            (term.contribution() / combined).powi(2)
        } else {
            0.0
        }
    }

    /// Returns the effective degrees of freedom of the combined standard uncertainty.
    pub fn degrees_of_freedom(&self) -> f64 {
        let pair = |term: &BudgetTerm| (term.contribution(), term.degrees_of_freedom);
        let pairs: Vec<_> = self.terms.iter().map(pair).collect();
        effective_degrees_of_freedom(self.combined(), &pairs)
    }

    /// Returns the factor for a coverage of 95 %.
    pub fn coverage_factor(&self) -> f64 {
        coverage_factor(self.degrees_of_freedom(), CoverageProbability::P95)
    }

    /// Returns the expanded uncertainty of the height for a coverage of 95 %, in metres.
    pub fn expanded(&self) -> f64 {
        self.coverage_factor() * self.combined()
    }

    /// Returns the term that contributes most.
    pub fn dominant(&self) -> &BudgetTerm {
        let by_contribution =
            |a: &&BudgetTerm, b: &&BudgetTerm| a.contribution().total_cmp(&b.contribution());
        // Of equal ones the first.
        let largest = self.terms.iter().rev().max_by(by_contribution);
        largest.unwrap_or(&self.terms[0])
    }

    /// Returns the standard uncertainty by speckle after the closed form for a line that a lens
    /// images as waves do, weighed over all of its width, in metres.
    ///
    /// See
    /// [`defocused_line_centroid_deviation`](tem00_statistics::laws::defocused_line_centroid_deviation);
    /// columns that are averaged make the rows higher. The budget's own term is this law, as the
    /// detector with its window weighs the light.
    pub const fn line_law(&self) -> f64 {
        self.line_law
    }

    /// Returns the standard uncertainty by speckle of a spot instead of a line after Dorsch,
    /// Häusler and Herrmann, in metres: the classical reference. It does not include averages.
    pub const fn dorsch(&self) -> f64 {
        self.dorsch
    }
}

const NOT_SEEN: TriangulationError = TriangulationError::NothingMeasured {
    why: "the camera does not see the line",
    advice: "take a height between camera and horizon",
};

/// The error that the detector finds no line even without noise.
const fn no_line(level: LightLevel) -> TriangulationError {
    TriangulationError::NothingMeasured {
        why: "the detector finds no line even without noise",
        advice: match level {
            LightLevel::Dark => level.advice(),
            _ => "the line does not stand out of its column: try more rows, or another `window`",
        },
    }
}

fn dorsch(setup: &Setup, contrast: f64) -> Option<f64> {
    let d = setup.description();
    let sensor = Dorsch {
        wavelength: d.laser.light.wavelength,
        contrast,
        aperture_angle: (0.5 * setup.camera().pupil_diameter() / d.camera.distance).asin(),
        triangulation_angle: d.camera.angle,
    };
    // A tilt ε of the light replaces sin θ by |sin(θ + ε)|/cos ε.
    let (angle, tilt) = (d.camera.angle, d.laser.tilt);
    let by_tilt = libm::sin(angle) * libm::cos(tilt) / libm::sin(angle + tilt).abs();
    Some(sensor.distance_deviation().ok()? * by_tilt)
}

#[cfg(test)]
pub(crate) mod tests;
