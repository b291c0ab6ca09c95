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

impl fmt::Display for StatisticsError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match *self {
            Self::Shape(got) => write!(f, "shape must lie between 1 and 1e6, got {got:e}"),
            Self::Contrast(got) => write!(f, "contrast must lie between 0.001 and 1, got {got:e}"),
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
    }

    #[test]
    fn a_refused_transform_is_the_source() {
        let error = StatisticsError::from(Fft2Error::Empty);
        let source = error::Error::source(&error).map(ToString::to_string);
        assert_eq!(source, Some(Fft2Error::Empty.to_string()));
    }
}
