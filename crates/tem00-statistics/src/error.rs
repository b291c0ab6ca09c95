use core::{error, fmt};

use tem00_numerics::Fft2Error;

use crate::Axis;

/// Why a law could not be constructed, a quantity not estimated or a hypothesis not tested.
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub enum StatisticsError {
    /// The shape of a Gamma law lies outside the supported range.
    Shape(f64),
    /// The contrast of a Gamma law lies outside the supported range.
    Contrast(f64),
    /// The degree of polarisation does not lie in [0, 1].
    Degree(f64),
    /// The correlation of two amplitudes does not lie in [0, 1).
    AmplitudeCorrelation(f64),
    /// The ratio of a coherent background to the speckle is negative or not finite.
    BeamRatio(f64),
    /// The mean intensity of a pattern in a sum is negative or not finite.
    Weight {
        /// The position of the pattern.
        index: usize,
        /// Its mean intensity.
        value: f64,
    },
    /// None of this many patterns in a sum has an intensity.
    NoWeight(usize),
    /// This many patterns of a sum differ in intensity, more than
    /// [`WeightedSum::MAX_DIFFERENT`](crate::WeightedSum::MAX_DIFFERENT).
    DifferentWeights(usize),
    /// The number of phasors in a sum lies outside the supported range.
    Phasors(usize),
    /// The wavelength, in metres, is not positive and finite.
    Wavelength(f64),
    /// The linewidth is not small against the wavelength. Often the two were swapped.
    Linewidth {
        /// The rejected linewidth, in metres.
        linewidth: f64,
        /// The largest linewidth the model accepts at this wavelength, in metres.
        maximum: f64,
    },
    /// A length, in units of the speckle size, or a number of pixels is outside its range.
    Extent {
        /// The name of the parameter.
        parameter: &'static str,
        /// The rejected value.
        value: f64,
        /// What is allowed.
        allowed: &'static str,
    },
    /// The distance from a lit area, in metres, is not positive and finite.
    Distance(f64),
    /// The size of a lit area, in metres, is not positive and finite.
    LitSize(f64),
    /// The level of a confidence interval does not lie in (0, 1).
    Level(f64),
    /// A sample is not positive.
    NotPositive {
        /// The position of the sample.
        index: usize,
        /// The value of the sample.
        value: f64,
    },
    /// A window is smaller than two pixels or larger than the image.
    Window {
        /// The width and height of the window, in pixels.
        window: usize,
        /// Width and height of the image.
        image: (usize, usize),
    },
    /// There are too few samples.
    Samples {
        /// The number of samples that were given.
        given: usize,
        /// The smallest number that determines the result.
        needed: usize,
    },
    /// A sample is infinite or not a number.
    NotFinite {
        /// The position of the sample.
        index: usize,
        /// The value of the sample.
        value: f64,
    },
    /// All samples have this same value, so that their variance is zero.
    Constant(f64),
    /// The mean of the samples is not positive, so that a ratio to it is undefined.
    Mean(f64),
    /// The mean to be tested is not finite.
    TestedMean(f64),
    /// Two grids differ in their size.
    Size {
        /// Width and height of the first grid.
        first: (usize, usize),
        /// Width and height of the second grid.
        second: (usize, usize),
    },
    /// The Fourier transform of the grid could not be planned.
    Transform(Fft2Error),
    /// The stride between samples is zero.
    Stride(usize),
    /// The size of a grid cell is not positive and finite.
    Step(f64),
    /// The speckle size, in pixels, is not positive and finite.
    SpeckleSize(f64),
    /// The autocovariance is not positive and finite at zero lag.
    ZeroLag(f64),
    /// The speckles are smaller than a pixel along one axis.
    Unresolved {
        /// The axis along which they were measured.
        axis: Axis,
        /// The autocovariance of neighbouring pixels.
        neighbours: f64,
    },
    /// The autocovariance has not fallen to one half at the largest lag.
    TooCoarse {
        /// The axis along which they were measured.
        axis: Axis,
        /// The largest lag, in pixels.
        largest_lag: usize,
    },
    /// The distribution function returned a value that is no probability.
    Probability {
        /// The sample at which it was evaluated.
        sample: f64,
        /// The value it returned.
        value: f64,
    },
    /// Observed and expected counts differ in their number.
    Bins {
        /// The number of observed counts.
        observed: usize,
        /// The number of expected counts.
        expected: usize,
    },
    /// An expected count is negative or not finite.
    ExpectedCount {
        /// The position of the bin.
        index: usize,
        /// The expected count.
        value: f64,
    },
    /// No degree of freedom is left.
    DegreesOfFreedom {
        /// The number of bins that are left after merging the sparse ones.
        bins: usize,
        /// The number of constraints on the expected counts.
        constraints: usize,
    },
}

impl StatisticsError {
    /// Returns the name of the argument that was refused, as constructors and functions call it.
    ///
    /// The values of an image or a field are `samples`, those of a grid of lags `lags`, whatever the
    /// function at hand calls them.
    ///
    /// # Examples
    ///
    /// ```
    /// use tem00_statistics::{GammaIntensity, Moments, StatisticsError};
    ///
    /// let name = |error: StatisticsError| error.parameter();
    /// assert_eq!(GammaIntensity::new(0.5).map_err(name), Err("shape"));
    /// assert_eq!(Moments::of(&[1.0]).map_err(name), Err("samples"));
    /// ```
    pub const fn parameter(&self) -> &'static str {
        match self {
            Self::Shape(..) => "shape",
            Self::Contrast(..) => "contrast",
            Self::Degree(..) => "degree",
            Self::AmplitudeCorrelation(..) => "amplitude_correlation",
            Self::BeamRatio(..) => "beam_ratio",
            Self::Weight { .. } => "weights",
            Self::NoWeight(..) | Self::DifferentWeights(..) => "weights",
            Self::Phasors(..) => "count",
            Self::Wavelength(..) => "wavelength",
            Self::Linewidth { .. } => "linewidth",
            Self::Extent { parameter, .. } => parameter,
            Self::Distance(..) => "distance",
            Self::LitSize(..) => "area",
            Self::Level(..) => "level",
            Self::NotPositive { .. } => "samples",
            Self::Window { .. } => "window",
            Self::Samples { .. } => "samples",
            Self::NotFinite { .. } => "samples",
            Self::Constant(..) => "samples",
            Self::Mean(..) => "samples",
            Self::TestedMean(..) => "mean",
            Self::Size { .. } => "second",
            Self::Transform(..) => "image",
            Self::Stride(..) => "stride",
            Self::Step(..) => "step",
            Self::SpeckleSize(..) => "speckle_size",
            Self::ZeroLag(..) => "lags",
            Self::Unresolved { .. } => "lags",
            Self::TooCoarse { .. } => "lags",
            Self::Probability { .. } => "cumulative",
            Self::Bins { .. } => "expected",
            Self::ExpectedCount { .. } => "expected",
            Self::DegreesOfFreedom { .. } => "constraints",
        }
    }
}

impl fmt::Display for StatisticsError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match *self {
            Self::Shape(got) => write!(f, "shape must lie between 1 and 1e6, got {got:e}"),
            Self::Contrast(got) => write!(f, "contrast must lie between 0.001 and 1, got {got:e}"),
            Self::Degree(got) => write!(
                f,
                "degree of polarisation must lie between 0 and 1, got {got:e}"
            ),
            Self::AmplitudeCorrelation(got) => write!(
                f,
                "amplitude correlation must be at least 0 and below 1, got {got}"
            ),
            Self::BeamRatio(got) => {
                write!(f, "beam ratio must be finite and not negative, got {got:e}")
            }
            Self::Weight { index, value } => write!(
                f,
                "weights must be finite and not negative, got {value:e} at position {index}"
            ),
            Self::NoWeight(count) => {
                write!(f, "weights must not all be zero, got {count} of them")
            }
            Self::DifferentWeights(got) => write!(
                f,
                "weights must have at most {} different values, got {got}",
                crate::WeightedSum::MAX_DIFFERENT
            ),
            Self::Phasors(got) => write!(
                f,
                "phasors must number between 8 and 1000000 for their law, got {got}"
            ),
            Self::Wavelength(got) => {
                write!(f, "wavelength must be positive and finite, got {got:e} m")
            }
            Self::Linewidth { linewidth, maximum } => write!(
                f,
                "linewidth must be positive and at most {maximum:e} m, got {linewidth:e} m"
            ),
            Self::Extent {
                parameter,
                value,
                allowed,
            } => write!(f, "{parameter} must be {allowed}, got {value}"),
            Self::Distance(got) => {
                write!(f, "distance must be positive and finite, got {got:e} m")
            }
            Self::LitSize(got) => write!(
                f,
                "size of the lit area must be positive and finite, got {got:e} m"
            ),
            Self::Level(got) => write!(f, "level must lie between 0 and 1, got {got:e}"),
            Self::NotPositive { index, value } => write!(
                f,
                "samples must be positive, got {value:e} at position {index}"
            ),
            Self::Window { window, image } => write!(
                f,
                "window must be at least 2 pixels wide and fit into the image of {} × {}, got \
                 {window}",
                image.0, image.1
            ),
            Self::Samples { given, needed } => {
                write!(f, "samples must number at least {needed}, got {given}")
            }
            Self::NotFinite { index, value } => {
                write!(f, "samples must be finite, got {value} at position {index}")
            }
            Self::Constant(value) => write!(f, "samples must differ, all of them are {value:e}"),
            Self::Mean(got) => write!(
                f,
                "mean must be positive and above the rounding error of the samples, got {got:e}"
            ),
            Self::TestedMean(got) => write!(f, "tested mean must be finite, got {got}"),
            Self::Size { first, second } => write!(
                f,
                "size of both grids must be the same, got {} × {} and {} × {}",
                first.0, first.1, second.0, second.1
            ),
            Self::Transform(reason) => write!(f, "grid must have a Fourier transform: {reason}"),
            Self::Stride(got) => write!(f, "stride must be at least 1, got {got}"),
            Self::Step(got) => write!(f, "step must be positive and finite, got {got:e}"),
            Self::SpeckleSize(got) => {
                write!(
                    f,
                    "speckle size must be positive and finite, got {got:e} pixels"
                )
            }
            Self::ZeroLag(got) => write!(
                f,
                "autocovariance at zero lag must be positive and finite, got {got:e}"
            ),
            Self::Unresolved { axis, neighbours } => write!(
                f,
                "speckle size along {axis} must be at least one pixel, got an autocovariance of \
                 neighbouring pixels of {neighbours:.4}, below the 0.0328 of one pixel"
            ),
            Self::TooCoarse { axis, largest_lag } => write!(
                f,
                "autocovariance along {axis} must fall to one half within the image, got more \
                 than that up to a lag of {largest_lag} pixels"
            ),
            Self::Probability { sample, value } => write!(
                f,
                "distribution function must return values in [0, 1], got {value} at {sample:e}"
            ),
            Self::Bins { observed, expected } => write!(
                f,
                "bins must be as many observed as expected, got {observed} and {expected}"
            ),
            Self::ExpectedCount { index, value } => write!(
                f,
                "expected counts must be finite and not negative, got {value} in bin {index}"
            ),
            Self::DegreesOfFreedom { bins, constraints } => write!(
                f,
                "bins with five expected counts must outnumber the constraints, got {bins} and \
                 {constraints}"
            ),
        }
    }
}

impl error::Error for StatisticsError {
    fn source(&self) -> Option<&(dyn error::Error + 'static)> {
        match self {
            Self::Transform(reason) => Some(reason),
            _ => None,
        }
    }
}

impl From<Fft2Error> for StatisticsError {
    fn from(reason: Fft2Error) -> Self {
        Self::Transform(reason)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn messages_name_the_parameter_the_value_and_what_is_allowed() {
        let message = StatisticsError::Shape(0.5).to_string();
        assert_eq!(message, "shape must lie between 1 and 1e6, got 5e-1");
        let message = StatisticsError::Samples {
            given: 1,
            needed: 2,
        }
        .to_string();
        assert_eq!(message, "samples must number at least 2, got 1");
        let rows = [
            (
                StatisticsError::Degree(1.5),
                "degree of polarisation must lie between 0 and 1, got 1.5e0",
            ),
            (
                StatisticsError::AmplitudeCorrelation(1.0),
                "amplitude correlation must be at least 0 and below 1, got 1",
            ),
            (
                StatisticsError::BeamRatio(-1.0),
                "beam ratio must be finite and not negative, got -1e0",
            ),
            (
                StatisticsError::Weight {
                    index: 2,
                    value: -3.0,
                },
                "weights must be finite and not negative, got -3e0 at position 2",
            ),
            (
                StatisticsError::NoWeight(2),
                "weights must not all be zero, got 2 of them",
            ),
            (
                StatisticsError::DifferentWeights(70_000),
                "weights must have at most 65536 different values, got 70000",
            ),
            (
                StatisticsError::Phasors(3),
                "phasors must number between 8 and 1000000 for their law, got 3",
            ),
            (
                StatisticsError::Wavelength(0.0),
                "wavelength must be positive and finite, got 0e0 m",
            ),
            (
                StatisticsError::Linewidth {
                    linewidth: 5e-7,
                    maximum: 6.5e-8,
                },
                "linewidth must be positive and at most 6.5e-8 m, got 5e-7 m",
            ),
            (
                StatisticsError::Extent {
                    parameter: "radius",
                    value: 0.0,
                    allowed: "from 0.01 to 1e6",
                },
                "radius must be from 0.01 to 1e6, got 0",
            ),
            (
                StatisticsError::Distance(-1.0),
                "distance must be positive and finite, got -1e0 m",
            ),
            (
                StatisticsError::LitSize(-1.0),
                "size of the lit area must be positive and finite, got -1e0 m",
            ),
            (
                StatisticsError::Level(95.0),
                "level must lie between 0 and 1, got 9.5e1",
            ),
            (
                StatisticsError::NotPositive {
                    index: 7,
                    value: 0.0,
                },
                "samples must be positive, got 0e0 at position 7",
            ),
            (
                StatisticsError::Window {
                    window: 9,
                    image: (8, 16),
                },
                "window must be at least 2 pixels wide and fit into the image of 8 × 16, got 9",
            ),
        ];
        for (error, message) in rows {
            assert_eq!(error.to_string(), message);
        }
    }

    #[test]
    fn the_parameter_is_the_argument_that_was_given() {
        use crate as s;
        let name = |error: StatisticsError| error.parameter();
        let spot = s::LitArea::Disc { diameter: -1.0 };
        let image = tem00_numerics::Grid::filled(4, 4, 1.0);
        let other = tem00_numerics::Grid::filled(4, 5, 1.0);
        let refusals = [
            (s::WeightedSum::new(&[-1.0]).err(), "weights"),
            (s::WeightedSum::new(&[0.0]).err(), "weights"),
            (s::PhasorSum::new(3).err(), "count"),
            (s::ObjectiveSpeckle::new(1e-6, 1.0, spot).err(), "area"),
            (s::t_test_mean(&[1.0, 2.0], f64::NAN).err(), "mean"),
            (s::pearson_correlation(&image, &other).err(), "second"),
            (s::kolmogorov_smirnov(&[1.0], |_| 2.0).err(), "cumulative"),
            (s::chi_squared(&[1], &[], 0).err(), "expected"),
            (s::chi_squared(&[9], &[9.0], 1).err(), "constraints"),
            (s::decorrelated_samples(&image, 0).err(), "stride"),
            (s::GammaFit::by_likelihood(&[0.0, 1.0]).err(), "samples"),
        ];
        for (error, parameter) in refusals {
            assert_eq!(error.map(name), Some(parameter), "{error:?}");
        }
    }

    #[test]
    fn a_refused_transform_is_the_source() {
        let error = StatisticsError::from(Fft2Error::Empty);
        let source = error::Error::source(&error).map(ToString::to_string);
        assert_eq!(source, Some(Fft2Error::Empty.to_string()));
    }
}
