use core::f64::consts::PI;

use tem00_numerics::disc_overlap;

use crate::SpeckleError;

/// The shape of the camera's pupil.
///
/// Lengths are in units of the pupil diameter C, which is the outer diameter of an annulus and the
/// width of a rectangle. Lattice points on the rim belong to the pupil.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub enum Pupil {
    /// A full disc.
    #[default]
    Circle,
    /// A disc with a central obstruction, as of a mirror telescope.
    Annulus {
        /// Diameter of the obstruction in units of the outer diameter, inside (0, 1).
        inner: f64,
    },
    /// A rectangular stop.
    Rectangle {
        /// Height in units of the width, inside (0, 1].
        height: f64,
    },
}

impl Pupil {
    /// Returns the overlap of the pupil with itself, displaced by `shift` diameters, in [0, 1].
    ///
    /// It is the area common to both over the area of one: the amplitude correlation of two speckle
    /// fields whose pupils are displaced by `shift`.
    ///
    /// ```text
    /// circle:     chat(ρ)                                       ρ = |shift|
    /// annulus:    [A(1, 1) − 2 A(1, ε) + A(ε, ε)] / (1 − ε²)    A: common area of two discs over π/4
    /// rectangle:  (1 − |x|)₊ (1 − |y| / height)₊
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
    pub fn overlap(self, [x, y]: [f64; 2]) -> f64 {
        match self {
            Self::Circle => disc_overlap(x.hypot(y)),
            Self::Annulus { inner } => {
                let rho = x.hypot(y);
                let solid = disc_overlap(rho) - 2.0 * lens(inner, rho)
                    + inner * inner * disc_overlap(rho / inner);
                (solid / (1.0 - inner * inner)).clamp(0.0, 1.0)
            }
            Self::Rectangle { height } => {
                (1.0 - x.abs()).max(0.0) * (1.0 - y.abs() / height).max(0.0)
            }
        }
    }

    pub(crate) fn check(self) -> Result<(), SpeckleError> {
        match self {
            Self::Annulus { inner } if !(inner > 0.0 && inner < 1.0) => {
                Err(SpeckleError::InnerDiameter(inner))
            }
            Self::Rectangle { height } if !(height > 0.0 && height <= 1.0) => {
                Err(SpeckleError::Height(height))
            }
            _ => Ok(()),
        }
    }
}

/// The common area of discs of diameters 1 and `inner` < 1 at the distance `rho`, over π/4.
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
    /// `1 − 1/N` and the autocovariance `|μ|² − 1/N` for N phasors.
    #[default]
    Unit,
    /// Circular complex Gaussian with mean square 1.
    ///
    /// Every sample is exactly exponential and the autocovariance exactly `|μ|²` over the ensemble
    /// of seeds. Patterns are normalised by the *expected* mean: the mean of a single one
    /// fluctuates by `1/√N`.
    Gaussian,
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::PupilField;

    #[test]
    fn the_closed_overlap_is_the_share_of_a_fine_lattice() {
        const DIAMETER: usize = 600;
        let solid = PupilField::new(2 * DIAMETER, DIAMETER, 0).unwrap();
        for pupil in [
            Pupil::Circle,
            Pupil::Annulus { inner: 0.3 },
            Pupil::Annulus { inner: 0.8 },
            Pupil::Rectangle { height: 0.25 },
        ] {
            let field = solid.clone().with_pupil(pupil).unwrap();
            for shift in [[0, 0], [60, 0], [300, 100], [0, 90], [420, -30], [550, 0]] {
                #[expect(clippy::cast_precision_loss, reason = "small integers")]
                let diameters = shift.map(|s| s as f64 / 600.0);
                // A rectangle of 151 rows instead of 150 is off by 1/150; rims of discs average out.
                let difference = field.overlap(shift) - pupil.overlap(diameters);
                assert!(
                    difference.abs() < 1.0 / 150.0,
                    "{pupil:?} at {shift:?}: {difference}"
                );
            }
        }
    }

    #[test]
    fn the_overlap_of_an_annulus_with_a_vanishing_hole_is_that_of_a_disc() {
        for shift in [0.0, 0.1, 0.4999, 0.5, 0.7, 1.0, 1.3] {
            // The hole takes and gives at most 2 ε² = 2e−8.
            let annulus = Pupil::Annulus { inner: 1e-4 }.overlap([shift, 0.0]);
            let disc = Pupil::Circle.overlap([shift, 0.0]);
            assert!(
                (annulus - disc).abs() < 3e-8,
                "{annulus} and {disc} at {shift}"
            );
        }
    }

    #[test]
    fn proportions_outside_their_range_are_refused() {
        let field = PupilField::new(64, 32, 0).unwrap();
        for bad in [0.0, 1.0, -0.5, f64::NAN, f64::INFINITY] {
            let annulus = field.clone().with_pupil(Pupil::Annulus { inner: bad });
            assert!(
                matches!(annulus, Err(SpeckleError::InnerDiameter(_))),
                "inner = {bad}"
            );
        }
        for bad in [0.0, 1.5, -0.5, f64::NAN, f64::INFINITY] {
            let rectangle = field.clone().with_pupil(Pupil::Rectangle { height: bad });
            assert!(
                matches!(rectangle, Err(SpeckleError::Height(_))),
                "height = {bad}"
            );
        }
        let thin = field.with_pupil(Pupil::Rectangle { height: 0.01 });
        assert_eq!(thin, Err(SpeckleError::PhasorCount(33)));
    }
}
