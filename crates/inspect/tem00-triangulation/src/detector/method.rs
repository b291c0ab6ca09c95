use core::fmt;

use tem00_numerics::{Refusal, cast::to_usize, check};

/// Estimator of the position of a line in a column.
///
/// Values are above the background b of the column. An estimate uses only the pixels of the window.
/// "Exact" refers to a Gaussian line without noise.
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub enum LineMethod {
    /// The centre of gravity over the window.
    ///
    /// ```text
    /// ŷ = Σ (I_i − b) y_i / Σ (I_i − b)
    /// ```
    ///
    /// Exact except for the light outside of the window. Negative values count as such: cut off,
    /// they would draw the estimate towards the middle of the window.
    CentreOfGravity,
    /// The centre of gravity of the values above a fraction of the peak, over the window.
    ///
    /// ```text
    /// ŷ = Σ w_i y_i / Σ w_i      w_i = max(0, I_i − b − t P)
    /// ```
    ///
    /// P is the greatest of the values. The threshold is subtracted (Thomas et al., MNRAS 371, 323,
    /// 2006): a pixel that comes in at the threshold does so without a step.
    ThresholdedCentreOfGravity {
        /// The threshold t as a fraction of the peak, from 0 to below 1.
        threshold: f64,
    },
    /// The centre of gravity over a window that is moved onto its result until it stays.
    ///
    /// The window holds fractions of the pixels at its ends, so that it can stand anywhere.
    IteratedCentreOfGravity,
    /// The vertex of the parabola through the greatest pixel of the window and its neighbours.
    ///
    /// ```text
    /// ŷ = y + (I₊ − I₋) / (2 (2 I₀ − I₋ − I₊))
    /// ```
    Parabola,
    /// The vertex of the parabola through the logarithms of the greatest pixel and its neighbours.
    ///
    /// Exact for points. Pixels integrate: at the distance δ of a line from the middle of its pixel
    /// the estimate is δ (1 − 4 δ²)/(1440 σ⁶) too far out, with σ = w/2 in pixels.
    LogGaussian,
    /// Straight flanks of equal slope through the greatest pixel and its neighbours (Naidu &
    /// Fisher, *A Comparative Analysis of Algorithms for Determining the Peak Position of a Stripe
    /// to Sub-Pixel Accuracy*, 1991).
    ///
    /// ```text
    /// ŷ = y + (I₊ − I₋) / (2 (I₀ − min(I₋, I₊)))
    /// ```
    LinearInterpolation,
    /// The zero of the derivative by a filter of Blais and Rioux (*Real-time numerical peak
    /// detector*, Signal Processing 11, 145, 1986), the nearest to the greatest pixel of the
    /// window.
    ///
    /// ```text
    /// g(i) = I_{i−m} + … + I_{i−1} − I_{i+1} − … − I_{i+m}      m half the order
    /// ŷ = y_i + g(i) / (g(i) − g(i+1))                          g(i) ≤ 0 < g(i+1)
    /// ```
    BlaisRioux {
        /// The order of the filter.
        order: FilterOrder,
    },
    /// The Gaussian on a constant background that fits best, by least squares.
    ///
    /// The fitted Gaussian is integrated over the pixels, as a sensor without gaps does it: the
    /// estimate is exact, and so is the [width](crate::LinePoint::width), which is the width of the
    /// fit.
    GaussianFit,
    /// The ridge by Steger (*An unbiased detector of curvilinear structures*, IEEE PAMI 20, 113,
    /// 1998), with derivatives of a Gaussian.
    ///
    /// In an image it looks along the normal of the ridge and needs the neighbours of the column;
    /// in a single column it looks along the column. Of a line with a flat top, such as a saturated
    /// one, of the half width a there is one ridge in the middle for σ ≥ a/√3.
    Steger {
        /// The standard deviation σ of the Gaussian, in pixels.
        sigma: f64,
    },
}

/// The order of a filter of Blais and Rioux.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum FilterOrder {
    /// Two taps.
    Second,
    /// Four taps.
    Fourth,
    /// Eight taps.
    Eighth,
}

impl FilterOrder {
    /// Returns the number of taps that are not zero: 2, 4 or 8.
    pub const fn taps(self) -> usize {
        match self {
            Self::Second => 2,
            Self::Fourth => 4,
            Self::Eighth => 8,
        }
    }

    /// Returns the order with as many taps, or `None` if there is none.
    pub const fn from_taps(taps: usize) -> Option<Self> {
        match taps {
            2 => Some(Self::Second),
            4 => Some(Self::Fourth),
            8 => Some(Self::Eighth),
            _ => None,
        }
    }
}

impl LineMethod {
    /// List of all methods with their default parameters: a threshold of 0.2, the order 4, a σ of 2
    /// pixels.
    pub const ALL: [Self; 9] = [
        Self::CentreOfGravity,
        Self::ThresholdedCentreOfGravity { threshold: 0.2 },
        Self::IteratedCentreOfGravity,
        Self::Parabola,
        Self::LogGaussian,
        Self::LinearInterpolation,
        Self::BlaisRioux {
            order: FilterOrder::Fourth,
        },
        Self::GaussianFit,
        Self::Steger { sigma: 2.0 },
    ];

    /// Returns the name in files and arguments: `centre_of_gravity`.
    pub const fn name(&self) -> &'static str {
        match self {
            Self::CentreOfGravity => "centre_of_gravity",
            Self::ThresholdedCentreOfGravity { .. } => "thresholded_centre_of_gravity",
            Self::IteratedCentreOfGravity => "iterated_centre_of_gravity",
            Self::Parabola => "parabola",
            Self::LogGaussian => "log_gaussian",
            Self::LinearInterpolation => "linear_interpolation",
            Self::BlaisRioux { .. } => "blais_rioux",
            Self::GaussianFit => "gaussian_fit",
            Self::Steger { .. } => "steger",
        }
    }

    /// Returns the method of a [name](Self::name), with the parameters that it has in
    /// [`ALL`](Self::ALL).
    pub fn from_name(name: &str) -> Option<Self> {
        Self::ALL.into_iter().find(|method| method.name() == name)
    }

    /// Returns the minimum number of pixels in a window of the method.
    pub fn min_window(&self) -> usize {
        match self {
            Self::BlaisRioux { order } => order.taps() + 3,
            Self::GaussianFit => 7,
            Self::Steger { sigma } => 2 * kernel_radius(*sigma) + 1,
            _ => 3,
        }
    }

    /// Checks that each parameter is in its range.
    pub(super) fn validate(&self) -> Result<(), Refusal> {
        match *self {
            Self::ThresholdedCentreOfGravity { threshold } => {
                let (holds, allowed) = (
                    (0.0..1.0).contains(&threshold),
                    "from 0 to below 1, a fraction of the peak",
                );
                check::that(holds, "threshold", threshold, "", allowed)
            }
            Self::Steger { sigma } => {
                let holds = (0.5..=100.0).contains(&sigma);
                check::that(holds, "sigma", sigma, "", "from 0.5 to 100 pixels")
            }
            _ => Ok(()),
        }
    }
}

impl fmt::Display for LineMethod {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(self.name())
    }
}

/// The pixels that a Gaussian of Steger's reaches to either side: beyond 4 σ is 6e−5 of it.
pub(super) fn kernel_radius(sigma: f64) -> usize {
    to_usize((4.0 * sigma).ceil().min(400.0))
}
