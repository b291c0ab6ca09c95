use core::{error, fmt};
use std::borrow::Cow;

use tem00_numerics::{Fft2Error, Grid, Refusal, RefusedValue, Shown};

use crate::axis::Axis;

/// Reasons for which a law, an estimate or a test is refused.
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub enum StatisticsError {
    /// An argument, or one value of a list, is out of its allowed range.
    Refused(Refusal),
    /// A sample is zero or negative where its logarithm is taken.
    NotPositive {
        /// The position of the sample.
        index: usize,
        /// The value of the sample.
        value: f64,
    },
    /// The Fourier transform of the grid could not be planned.
    Transform(Fft2Error),
    /// The speckles are smaller than a pixel along one axis.
    Unresolved {
        /// The axis along which the speckles were measured.
        axis: Axis,
        /// The autocovariance of neighbouring pixels.
        neighbours: f64,
    },
    /// The autocovariance has not fallen to one half at the largest lag.
    TooCoarse {
        /// The axis along which the speckles were measured.
        axis: Axis,
        /// The largest lag, in pixels.
        largest_lag: usize,
    },
    /// No degree of freedom remains.
    DegreesOfFreedom {
        /// The number of bins that remain after merging the sparse ones.
        bins: usize,
        /// The number of constraints on the expected counts.
        constraints: usize,
    },
}

impl StatisticsError {
    /// Requirement on samples whose spread is computed.
    pub(crate) const VARIED: &'static str = "of more than one value";
    /// Requirement on samples whose ratio to the mean is computed.
    pub(crate) const MEAN: &'static str =
        "of a mean that is positive and above their rounding errors";

    pub(crate) fn refused(
        parameter: &'static str,
        value: impl Into<RefusedValue>,
        allowed: impl Into<Cow<'static, str>>,
    ) -> Self {
        Self::Refused(Refusal::new(parameter, value, allowed))
    }

    /// Refuses one value of a list.
    pub(crate) fn refused_at(
        index: usize,
        parameter: &'static str,
        value: impl Into<f64>,
        allowed: &'static str,
    ) -> Self {
        Self::Refused(Refusal::new(parameter, value.into(), allowed).at(index))
    }

    /// Refuses a number of samples below `needed`.
    pub(crate) fn too_few_samples(given: usize, needed: usize) -> Self {
        Self::refused("samples", given, format!("at least {needed}"))
    }

    /// Checks that a window is wider than a pixel and fits into an image.
    pub(crate) fn check_window<T>(window: usize, image: &Grid<T>) -> Result<(), Self> {
        let (width, height) = (image.width(), image.height());
        if (2..=width.min(height)).contains(&window) {
            return Ok(());
        }
        let allowed =
            format!("at least 2 pixels wide and fit into the image of {width} × {height}");
        Err(Self::refused("window", window, allowed))
    }

    /// Returns the name of the refused argument, as constructors and functions call it.
    ///
    /// The values of an image or a field are `samples` and the values of a grid of lags `lags`,
    /// independent of the argument names of the function.
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
            Self::Refused(refusal) => refusal.parameter(),
            Self::NotPositive { .. } => "samples",
            Self::Transform(..) => "image",
            Self::Unresolved { .. } | Self::TooCoarse { .. } => "lags",
            Self::DegreesOfFreedom { .. } => "constraints",
        }
    }
}

impl fmt::Display for StatisticsError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Refused(refusal) => refusal.fmt(f),
            Self::NotPositive { index, value } => write!(
                f,
                "samples must be positive, got {} at index {index}",
                Shown(*value)
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

impl From<Refusal> for StatisticsError {
    fn from(refusal: Refusal) -> Self {
        Self::Refused(refusal)
    }
}

impl From<Fft2Error> for StatisticsError {
    fn from(reason: Fft2Error) -> Self {
        Self::Transform(reason)
    }
}
