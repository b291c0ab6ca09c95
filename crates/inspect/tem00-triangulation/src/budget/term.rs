use crate::named::named;

named! {
    /// Source of the uncertainty of a height.
    #[non_exhaustive]
    UncertaintySource {
        /// Speckle in the light of the line.
        Speckle = "speckle",
        /// The Poisson noise of the light.
        ShotNoise = "shot noise",
        /// The temporal dark noise of the sensor and the noise of its dark current.
        DarkNoise = "dark noise",
        /// The rounding to whole grey values.
        Quantisation = "quantisation",
        /// The different response of the pixels.
        Prnu = "PRNU",
        /// The different dark signal of the pixels.
        Dsnu = "DSNU",
        /// The systematic error of the detector, which varies with the position of the line in a
        /// pixel.
        DetectorBias = "detector bias",
        /// The calibration of camera and laser plane.
        Calibration = "calibration",
    }
}

impl UncertaintySource {
    /// Returns a remedy that reduces the term.
    pub const fn remedy(self) -> &'static str {
        match self {
            Self::Speckle => {
                "a larger pupil (smaller f-number), a narrower line, a larger angle, or averages \
                 over columns or frames of a moving part lower it; more light does not"
            }
            Self::ShotNoise => {
                "more light lowers it: power, exposure or pupil, or a sensor with a larger full \
                 well"
            }
            Self::DarkNoise => "more light, a shorter window or a quieter sensor lowers it",
            Self::Quantisation => "more bits, or more light per grey value, lower it",
            Self::Prnu | Self::Dsnu => {
                "a flat-field correction, averages over columns or a wider line lower it"
            }
            Self::DetectorBias => "another detector, a wider window or a wider line lowers it",
            Self::Calibration => "a better calibration lowers it",
        }
    }
}

/// Evaluation of a standard uncertainty, by the types of the GUM.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Evaluation {
    /// Evaluation by statistics of observations.
    A,
    /// Evaluation by other knowledge: models and data sheets.
    B,
}

named! {
    /// The distribution of an error.
    #[non_exhaustive]
    ErrorDistribution {
        /// Normal, if only as the sum of many.
        Normal = "normal",
        /// Rectangular in each pixel.
        Rectangular = "rectangular",
        /// Distribution of a periodic error at a uniformly distributed position.
        Periodic = "periodic",
    }
}

/// Term of a budget.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct BudgetTerm {
    /// The source of the uncertainty.
    pub source: UncertaintySource,
    /// The type of its evaluation.
    pub evaluation: Evaluation,
    /// The distribution of the error.
    pub distribution: ErrorDistribution,
    /// The standard uncertainty of the input quantity after all averages: of the position of the
    /// line, in pixels, or of a height, in metres, for the calibration.
    pub uncertainty: f64,
    /// The change of the height with the input quantity: in metres per pixel, or 1.
    pub sensitivity: f64,
    /// The degrees of freedom of the standard uncertainty; infinite if it is known.
    pub degrees_of_freedom: f64,
}

impl BudgetTerm {
    /// Returns the standard uncertainty of the height by this term alone, in metres.
    pub fn contribution(&self) -> f64 {
        self.uncertainty * self.sensitivity.abs()
    }

    /// Returns the unit of the input quantity: `px` or `m`.
    pub const fn unit(&self) -> &'static str {
        match self.source {
            UncertaintySource::Calibration => "m",
            _ => "px",
        }
    }
}
