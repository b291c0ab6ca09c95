use super::physics;
use pyo3::prelude::*;

use crate::{
    arrays::LIMIT,
    error::{OrRaise, refused},
};

functions! {
    /// Return the probability density of the intensity of fully developed speckle, exp(−I).
    ///
    /// Parameters
    /// ----------
    /// intensity : float or array_like
    ///     Intensity in units of its mean.
    map exponential_density(intensity);

    /// Return the probability that the intensity of fully developed speckle is at most
    /// ``intensity``.
    ///
    /// Parameters
    /// ----------
    /// intensity : float or array_like
    ///     Intensity in units of its mean.
    map exponential_cumulative(intensity);

    /// Return a moment ⟨I^order⟩ of the intensity of a sum of phasors, in units of the mean.
    ///
    /// Parameters
    /// ----------
    /// count : int
    ///     Number of phasors of equal length and random phase, at least 1.
    /// order : int
    ///     Order of the moment, at most 20.
    try moment_of_phasor_sum(count: usize, order: u32) -> f64 = {
        within("count", count, 1, usize::MAX)?;
        within("order", order, 0, LARGEST_ORDER)?;
        PyResult::Ok(physics::moment_of_phasor_sum(count, order))
    };
}

/// The largest order of a moment.
const LARGEST_ORDER: u32 = 20;

/// Checks that a count lies between two others, which count too.
fn within<T: PartialOrd + core::fmt::Display>(
    name: &str,
    value: T,
    min: T,
    max: T,
) -> PyResult<()> {
    if (&min..=&max).contains(&&value) {
        return Ok(());
    }
    let message = format!("{name} must lie between {min} and {max}, got {value}");
    Err(refused(name, message))
}

/// Declares the class of a law of one parameter: density, probability and contrast of the
/// intensity.
macro_rules! law {
    ($(#[$doc:meta])* $law:ident($parameter:ident: $type:ty) $($items:tt)*) => {
        class! { $(#[$doc])* "tem00.statistics" $law(physics::$law) }

        methods! {
            impl $law as this: this.0;

            make new($parameter: $type);

            $($items)*

            #[doc = concat!("The parameter ``", stringify!($parameter), "``.")]
            get $parameter -> $type;

            /// Contrast, standard deviation over mean.
            get contrast -> f64;

            /// Return the probability density at intensities in units of their mean, in their
            /// shape.
            map density(intensity) = this.0.density(intensity);

            /// Return the probability of at most an intensity in units of the mean, in its shape.
            map cumulative(intensity) = this.0.cumulative(intensity);

            made_by new($parameter);
        }
    };
}

law! {
    /// The law of the intensity after speckle has been averaged: a Gamma distribution of mean 1.
    ///
    /// Parameters
    /// ----------
    /// shape : float
    ///     Number of degrees of freedom, from 1 to 10⁶.
    GammaIntensity(shape: f64)

    /// Return the law that has a contrast between 0.001 and 1.
    make from_contrast(contrast: f64);
}

law! {
    /// The law of the intensity of speckle on a coherent background, such as a specular reflection.
    ///
    /// Parameters
    /// ----------
    /// beam_ratio : float
    ///     Background over mean of the speckle, finite and not negative.
    CoherentBackground(beam_ratio: f64)

    /// Return the law that has a contrast between 0.001 and 1.
    make from_contrast(contrast: f64);
}

law! {
    /// The law of the intensity of partially polarised speckle.
    ///
    /// Parameters
    /// ----------
    /// degree : float
    ///     Degree of polarisation, from 0 to 1.
    PartiallyPolarised(degree: f64)
}

law! {
    /// The law of the intensity of a sum of few phasors of equal length and random phase.
    ///
    /// Parameters
    /// ----------
    /// count : int
    ///     Number of phasors, from 8 to 10⁶.
    PhasorSum(count: usize)
}

/// The law of the intensity of a sum of independent speckle patterns of any mean intensities.
///
/// Parameters
/// ----------
/// weights : array_like, shape (n,)
///     Mean intensities of the patterns, in any unit, none negative and not all zero, of at most
///     65,536 different values. Each of these takes some 10 µs of the time of a density.
#[pyclass(frozen, eq, module = "tem00.statistics")]
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct IncoherentSum(physics::IncoherentSum, Vec<f64>);

immutable!(IncoherentSum);

methods! {
    impl IncoherentSum as this: this.0;

    make new(weights: Vec<f64>) =
        physics::IncoherentSum::new(&weights).or_raise().map(|law| Self(law, weights));

    /// Mean intensities of the patterns, as given.
    get weights -> Vec<f64> = this.1.clone();

    /// Contrast, standard deviation over mean.
    get contrast -> f64;

    /// Return the probability density at intensities in units of their mean, in their shape.
    map density(intensity);

    /// Return the probability of at most an intensity in units of the mean, in its shape.
    map cumulative(intensity);

    made_by new(weights);
}

class! {
    /// The joint law of the intensities at two points of fully developed speckle, or at one point
    /// of two correlated patterns.
    ///
    /// Intensities are in units of their mean, and broadcast together.
    ///
    /// Parameters
    /// ----------
    /// amplitude_correlation : float
    ///     Magnitude of the correlation of the two amplitudes, from 0 to below 1.
    "tem00.statistics" JointIntensity(physics::JointIntensity): Copy
}

methods! {
    impl JointIntensity as this: this.0;

    make new(amplitude_correlation: f64);

    /// Magnitude of the correlation of the amplitudes.
    get amplitude_correlation -> f64;

    /// Correlation of the intensities, the square of that of the amplitudes.
    get intensity_correlation -> f64;

    /// Return the joint density of two intensities.
    map density(first, second) = this.0.density([first, second]);

    /// Return the moment ⟨I₁ᵐ I₂ⁿ⟩ of the orders (m, n), each at most 20.
    try moment(orders: [u32; 2]) -> f64 = {
        for order in orders {
            within("orders", order, 0, LARGEST_ORDER)?;
        }
        PyResult::Ok(this.0.moment(orders))
    };

    /// Return the density of the intensity at one point where that at the other is ``given``.
    map conditional_density(intensity, given: not_negative);

    /// Return the probability of at most ``intensity`` at one point where the other has ``given``.
    map conditional_cumulative(intensity, given: not_negative);

    /// Return the mean of the intensity at one point where that at the other is ``given``.
    map conditional_mean(given: not_negative);

    /// Return the variance of the intensity at one point where that at the other is ``given``.
    map conditional_variance(given: not_negative);

    made_by new(amplitude_correlation);
}
