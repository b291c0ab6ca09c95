use core::f64::consts::{FRAC_PI_2, PI};

use num_complex::Complex;
use tem00_numerics::{cast::to_f32, disc_overlap, quadrature::integrate};

use crate::{SpeckleError, Transmission};

/// The shape of the camera's pupil.
///
/// Lengths are in units of the pupil diameter D, which is C lattice points: the outer diameter of
/// an annulus or the width of a rectangle. A point at the position p from the pupil's centre, in
/// diameters, belongs to the pupil if
///
/// ```text
/// circle, Gaussian:  |p| ≤ ½
/// annulus:           inner / 2 ≤ |p| ≤ ½
/// rectangle:         |x| ≤ ½,  |y| ≤ height / 2
/// sampled:           |x| ≤ ½,  |y| ≤ ½
/// ```
///
/// Points on the rim, and points within 10⁻¹² of a diameter of it, belong to the pupil.
#[derive(Clone, Debug, Default, PartialEq)]
pub enum Pupil {
    /// A full disc.
    #[default]
    Circle,
    /// A disc with a central obstruction, as in a mirror telescope.
    Annulus {
        /// Diameter of the obstruction in units of the outer diameter, inside (0, 1).
        inner: f64,
    },
    /// A rectangular stop.
    Rectangle {
        /// Height in units of the width, inside (0, 1].
        height: f64,
    },
    /// A disc whose amplitude transmission falls off as `exp(−p²/radius²)`.
    Gaussian {
        /// The radius, in units of the diameter, at which 1/e² of the power is transmitted;
        /// positive and finite.
        radius: f64,
    },
    /// An arbitrary amplitude transmission over the bounding square, with a phase if there are
    /// aberrations.
    Sampled(Transmission),
}

impl Pupil {
    /// Factor by which the radius of a point on the rim may exceed the radius of the pupil: the
    /// rounding of coordinates.
    pub(crate) const RIM: f64 = 1.0 + 1e-12;

    /// Returns the overlap of the pupil with itself, displaced by `shift` diameters, in [0, 1].
    ///
    /// It is the common power of both divided by the power of one: the amplitude correlation of two
    /// speckle fields whose pupils are displaced by `shift`.
    ///
    /// ```text
    /// circle:     chat(ρ)                                       ρ = |shift|
    /// annulus:    [A(1, 1) − 2 A(1, ε) + A(ε, ε)] / (1 − ε²)    A: common area of two discs over
    ///                                                           π/4
    /// rectangle:  (1 − |x|)₊ (1 − |y| / height)₊
    /// Gaussian:   exp(−ρ²/2R²) ∫lens exp(−2q²/R²) d²q / ∫disc   R = radius, by quadrature
    /// sampled:    |∫ t(p) t*(p − shift) d²p| / ∫ |t|² d²p       exact
    /// ```
    ///
    /// # Examples
    ///
    /// ```
    /// use tem00_speckle::Pupil;
    ///
    /// assert!((Pupil::Circle.overlap([0.5, 0.0]) - 0.391_002).abs() < 1e-6);
    /// assert_eq!(Pupil::Rectangle { height: 0.5 }.overlap([0.5, 0.25]), 0.25);
    /// ```
    pub fn overlap(&self, [x, y]: [f64; 2]) -> f64 {
        match self {
            Self::Circle => disc_overlap(x.hypot(y)),
            &Self::Annulus { inner } => {
                let rho = x.hypot(y);
                let solid = disc_overlap(rho) - 2.0 * lens(inner, rho)
                    + inner * inner * disc_overlap(rho / inner);
                (solid / (1.0 - inner * inner)).clamp(0.0, 1.0)
            }
            Self::Rectangle { height } => {
                (1.0 - x.abs()).max(0.0) * (1.0 - y.abs() / height).max(0.0)
            }
            Self::Gaussian { radius } => gaussian_overlap(x.hypot(y), *radius),
            Self::Sampled(transmission) => transmission.overlap([x, y]),
        }
    }

    /// Checks the proportions of the pupil.
    ///
    /// # Errors
    ///
    /// Returns an error if a proportion lies outside the range that its variant states.
    pub fn check(&self) -> Result<(), SpeckleError> {
        match *self {
            Self::Annulus { inner } if !(inner > 0.0 && inner < 1.0) => {
                let allowed = "inside (0, 1), in units of the outer diameter";
                Err(SpeckleError::refused("inner", inner, allowed))
            }
            Self::Rectangle { height } if !(height > 0.0 && height <= 1.0) => {
                let allowed = "positive and at most 1, in units of the width";
                Err(SpeckleError::refused("height", height, allowed))
            }
            Self::Gaussian { radius } if !(radius > 0.0 && radius.is_finite()) => {
                let allowed = "positive and finite, in units of the diameter";
                Err(SpeckleError::refused("radius", radius, allowed))
            }
            _ => Ok(()),
        }
    }

    /// The width and the height of the pupil, in diameters.
    pub(crate) const fn reach(&self) -> [f64; 2] {
        match self {
            Self::Rectangle { height } => [1.0, *height],
            _ => [1.0, 1.0],
        }
    }

    /// Returns whether the point at `p` diameters from the centre belongs to the pupil.
    pub(crate) fn contains(&self, [x, y]: [f64; 2]) -> bool {
        let rim = 0.5 * Self::RIM;
        match self {
            Self::Circle | Self::Gaussian { .. } => x * x + y * y <= rim * rim,
            Self::Annulus { inner } => {
                let (square, hole) = (x * x + y * y, 0.5 * inner / Self::RIM);
                square <= rim * rim && square >= hole * hole
            }
            Self::Rectangle { height } => x.abs() <= rim && y.abs() <= height * rim,
            Self::Sampled(_) => x.abs() <= rim && y.abs() <= rim,
        }
    }

    /// Returns whether the transmission is other than 0 or 1.
    pub(crate) const fn is_weighted(&self) -> bool {
        matches!(self, Self::Gaussian { .. } | Self::Sampled(_))
    }

    /// The amplitude transmission at `p` diameters from the centre.
    pub(crate) fn transmission(&self, [x, y]: [f64; 2]) -> Complex<f32> {
        let amplitude = match self {
            _ if !self.contains([x, y]) => 0.0,
            Self::Gaussian { radius } => to_f32((-(x.hypot(y) / radius).powi(2)).exp()),
            Self::Sampled(transmission) => return transmission.at([x, y]),
            _ => 1.0,
        };
        Complex::new(amplitude, 0.0)
    }
}

/// The overlap of two apodised discs of diameter 1 at the distance `rho`.
///
/// About the middle between the centres the product of both transmissions is a Gaussian again, and
/// the rim of their overlap lies at b(φ) = √(¼ − ¼ρ² sin²φ) − ½ρ cos φ. In polar coordinates the
/// radial integral is elementary; all quadrants contribute equally.
fn gaussian_overlap(rho: f64, radius: f64) -> f64 {
    if rho >= 1.0 || rho.is_nan() {
        return 0.0;
    }
    // (1 − exp(−2b²/R²)) / (2/R²), in a form that is accurate for wide and narrow Gaussians.
    let wide = radius > 1.0;
    let radial = |b: f64| {
        let x = 2.0 * (b / radius).powi(2);
        match wide {
            true if x < 1e-8 => b * b * (1.0 - 0.5 * x),
            true => b * b * -(-x).exp_m1() / x,
            false => -(-x).exp_m1(),
        }
    };
    let along = |phi: f64| {
        let (sin, cos) = phi.sin_cos();
        let rim = 0.5 * (1.0 - (rho * sin).powi(2)).sqrt() - 0.5 * rho * cos;
        radial(rim.max(0.0))
    };
    // The corner of the overlap sharpens towards ρ = 1; eight panels have an error of 1e−10 of the
    // overlap.
    let shared = integrate(along, [0.0, FRAC_PI_2], FRAC_PI_2 / 8.0);
    (-0.5 * (rho / radius).powi(2)).exp() * shared / (radial(0.5) * FRAC_PI_2)
}

/// The common area of discs of diameters 1 and `inner` < 1 at the distance `rho`, divided by π/4.
fn lens(inner: f64, rho: f64) -> f64 {
    // Radii 1 and e and the distance d in units of the larger radius.
    let (e, d) = (inner, 2.0 * rho);
    if d >= 1.0 + e {
        return 0.0;
    }
    if d <= 1.0 - e {
        return e * e;
    }
    let cos_large = ((d * d + 1.0 - e * e) / (2.0 * d)).clamp(-1.0, 1.0);
    let cos_small = ((d * d + e * e - 1.0) / (2.0 * d * e)).clamp(-1.0, 1.0);
    let kite = ((1.0 + e - d) * (d + e - 1.0) * (d + 1.0 - e) * (d + 1.0 + e)).max(0.0);
    (cos_large.acos() + e * e * cos_small.acos() - 0.5 * kite.sqrt()) / PI
}

/// The law of the random phasors in the pupil.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Phasors {
    /// Magnitude 1 and uniform phase, as in the paper.
    ///
    /// By Parseval the mean intensity of every pattern is exactly 1. The squared contrast is
    /// `1 − 1/N` and the autocovariance `|μ|² − 1/N` for N phasors of equal weight; in general N is
    /// the effective count [`PupilField::effective_phasor_count`].
    ///
    /// [`PupilField::effective_phasor_count`]: crate::PupilField::effective_phasor_count
    #[default]
    Unit,
    /// Circular complex Gaussian with mean square 1.
    ///
    /// Every sample is exactly exponential and the autocovariance exactly `|μ|²` over the ensemble
    /// of seeds. Patterns are normalised by the *expected* mean: the mean of a single pattern
    /// fluctuates by `1/√N`.
    Gaussian,
}

#[cfg(test)]
mod tests {
    use tem00_testkit::assert_absolute;

    use super::*;
    use crate::pupil::mask::Mask;

    #[test]
    fn the_closed_overlap_is_the_share_of_a_fine_lattice() {
        const DIAMETER: f64 = 600.0;
        for pupil in [
            Pupil::Circle,
            Pupil::Annulus { inner: 0.3 },
            Pupil::Annulus { inner: 0.8 },
            Pupil::Rectangle { height: 0.25 },
            Pupil::Gaussian { radius: 0.2 },
            Pupil::Gaussian { radius: 0.6 },
            Pupil::Gaussian { radius: 3.0 },
        ] {
            let mask = Mask::new(&pupil, [DIAMETER; 2], [0.0; 2]);
            for shift in [[0, 0], [60, 0], [300, 100], [0, 90], [420, -30], [550, 0]] {
                let diameters = shift.map(|s| s as f64 / DIAMETER);
                let share = mask.overlap(shift).re / mask.power();
                // A rectangle of 151 rows instead of 150 has an error of 1/150; for the rims of
                // discs the errors average out. Relative to the area of a thin ring the error is
                // larger.
                let tolerance = match pupil {
                    Pupil::Rectangle { .. } => 1.0 / 150.0,
                    Pupil::Annulus { inner } => 2e-4 / (1.0 - inner * inner),
                    _ => 2e-4,
                };
                assert_absolute(share, pupil.overlap(diameters), tolerance);
            }
        }
    }

    #[test]
    fn the_overlap_of_a_gaussian_pupil_has_its_limits() {
        for shift in [0.0, 0.1, 0.35, 0.7, 0.99, 1.0, 2.0] {
            // A wide Gaussian is a disc except for 1/R² of its transmission.
            let wide = Pupil::Gaussian { radius: 1e4 }.overlap([0.0, shift]);
            let disc = Pupil::Circle.overlap([shift, 0.0]);
            // Simpson's rule has an error of 1e-9 where the corner of the overlap is sharp.
            assert!((wide - disc).abs() < 2e-8, "{wide} | {disc} at {shift}");
            // A narrow Gaussian never meets the rim.
            let narrow = Pupil::Gaussian { radius: 0.05 }.overlap([shift, 0.0]);
            let gaussian = (-0.5 * (shift / 0.05_f64).powi(2)).exp();
            assert!((narrow - gaussian).abs() < 1e-9, "{narrow} | {gaussian}");
        }
        for radius in [1e-300, 1e-30, 1e-3, 1.0, 1e30, 1e300] {
            let pupil = Pupil::Gaussian { radius };
            assert_absolute(pupil.overlap([0.0, 0.0]), 1.0, 1e-12);
            assert!(pupil.overlap([0.3, 0.0]).is_finite(), "{radius:e}");
        }
    }

    #[test]
    fn the_overlap_of_an_annulus_with_a_vanishing_hole_is_that_of_a_disc() {
        for shift in [0.0, 0.1, 0.4999, 0.5, 0.7, 1.0, 1.3] {
            // The hole changes the overlap by at most 2 ε² = 2e−8.
            let annulus = Pupil::Annulus { inner: 1e-4 }.overlap([shift, 0.0]);
            let disc = Pupil::Circle.overlap([shift, 0.0]);
            assert_absolute(annulus, disc, 3e-8);
        }
    }
}
