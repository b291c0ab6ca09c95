use core::{error, fmt};

use tem00_numerics::{Fft2Error, Shown};

use crate::axis::Axis;

/// Reasons for which a law, an estimate or a test is refused.
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub enum StatisticsError {
    /// An argument is outside its range.
    OutOfRange {
        /// The name of the parameter.
        parameter: &'static str,
        /// The rejected value.
        value: f64,
        /// The allowed values, with the unit.
        allowed: &'static str,
    },
    /// One of many values is outside its range.
    ValueOutOfRange {
        /// The name of the parameter.
        parameter: &'static str,
        /// The position of the value.
        index: usize,
        /// The rejected value.
        value: f64,
        /// The allowed values.
        allowed: &'static str,
    },
    /// A sample is zero or negative where its logarithm is taken.
    NotPositive {
        /// The position of the sample.
        index: usize,
        /// The value of the sample.
        value: f64,
    },
    /// There are too few samples.
    Samples {
        /// The number of samples that were given.
        given: usize,
        /// The smallest number that determines the result.
        needed: usize,
    },
    /// A window is smaller than two pixels or larger than the image.
    Window {
        /// The width and height of the window, in pixels.
        window: usize,
        /// Width and height of the image.
        image: (usize, usize),
    },
    /// Two grids differ in their size.
    Size {
        /// Width and height of the first grid.
        first: (usize, usize),
        /// Width and height of the second grid.
        second: (usize, usize),
    },
    /// The Fourier transform of the grid could not be planned.
    Transform(Fft2Error),
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
    /// The distribution function returned a value outside [0, 1].
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
    /// No degree of freedom is left.
    DegreesOfFreedom {
        /// The number of bins that are left after merging the sparse ones.
        bins: usize,
        /// The number of constraints on the expected counts.
        constraints: usize,
    },
}

impl StatisticsError {
    /// Allowed for samples of which a spread is wanted.
    pub(crate) const VARIED: &'static str = "of more than one value";
    /// Allowed for samples of which a ratio to the mean is wanted.
    pub(crate) const MEAN: &'static str =
        "of a mean that is positive and above their rounding errors";

    pub(crate) const fn refused(
        parameter: &'static str,
        value: f64,
        allowed: &'static str,
    ) -> Self {
        Self::OutOfRange {
            parameter,
            value,
            allowed,
        }
    }

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
    /// assert_eq!(Moments::from_samples(&[1.0]).map_err(name), Err("samples"));
    /// ```
    pub const fn parameter(&self) -> &'static str {
        match self {
            Self::OutOfRange { parameter, .. } | Self::ValueOutOfRange { parameter, .. } => {
                parameter
            }
            Self::NotPositive { .. } | Self::Samples { .. } => "samples",
            Self::Window { .. } => "window",
            Self::Size { .. } => "second",
            Self::Transform(..) => "image",
            Self::Unresolved { .. } | Self::TooCoarse { .. } => "lags",
            Self::Probability { .. } => "cumulative",
            Self::Bins { .. } => "expected",
            Self::DegreesOfFreedom { .. } => "constraints",
        }
    }
}

impl fmt::Display for StatisticsError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match *self {
            Self::OutOfRange {
                parameter,
                value,
                allowed,
            } => write!(f, "{parameter} must be {allowed}, got {}", Shown(value)),
            Self::ValueOutOfRange {
                parameter,
                index,
                value,
                allowed,
            } => write!(
                f,
                "{parameter} must be {allowed}, got {} at position {index}",
                Shown(value)
            ),
            Self::NotPositive { index, value } => write!(
                f,
                "samples must be positive, got {} at position {index}",
                Shown(value)
            ),
            Self::Samples { given, needed } => {
                write!(f, "samples must number at least {needed}, got {given}")
            }
            Self::Window { window, image } => write!(
                f,
                "window must be at least 2 pixels wide and fit into the image of {} × {}, got \
                 {window}",
                image.0, image.1
            ),
            Self::Size { first, second } => write!(
                f,
                "size of both grids must be the same, got {} × {} and {} × {}",
                first.0, first.1, second.0, second.1
            ),
            Self::Transform(reason) => write!(f, "grid must have a Fourier transform: {reason}"),
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
                "distribution function must return values in [0, 1], got {value} at {}",
                Shown(sample)
            ),
            Self::Bins { observed, expected } => write!(
                f,
                "bins must be as many observed as expected, got {observed} and {expected}"
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
