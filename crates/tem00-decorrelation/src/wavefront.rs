use glam::{DMat3, DVec3};

use crate::{DecorrelationError, GRAZING_COSINE};

/// The light that reaches a surface point: where it comes from and how its wavefront is curved.
///
/// The wavefront is described to second order, by the unit vector `l_S` from the surface to the
/// source and the symmetric curvature tensor `K`, in 1/m, with `K l_S = 0`. Moving by `a` through
/// the wave turns the direction to the source by `−K a`.
///
/// ```text
/// K = 0                                plane wave
/// K = (I − l_S l_Sᵀ) / R               spherical wave
/// K = e1 e1ᵀ / R1 + e2 e2ᵀ / R2        astigmatic wave, such as the fan of a laser line
/// ```
///
/// Curvatures are positive where the wave diverges, zero for a plane wave and at the waist of a
/// beam, and negative where the wave converges. They are those of the *wavefront*: for a Gaussian
/// beam 1/R(z), not the reciprocal distance to the emitter.
///
/// # Examples
///
/// A laser line 200 mm from the apex of its fan, with the fan along x and its waist on the surface:
///
/// ```
/// use tem00_decorrelation::{DVec3, Wavefront};
///
/// let line = Wavefront::astigmatic(DVec3::Z, DVec3::X, 1.0 / 0.2, 0.0)?;
/// let turned = line.curvature() * DVec3::new(1e-3, 1e-3, 1e-3);
/// assert!((turned - DVec3::new(5e-3, 0.0, 0.0)).length() < 1e-15);
/// # Ok::<(), tem00_decorrelation::DecorrelationError>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Wavefront {
    direction_to_source: DVec3,
    curvature: DMat3,
}

impl Wavefront {
    /// Creates a plane wave, such as collimated light, from the direction to its source.
    ///
    /// The direction may have any length.
    ///
    /// # Errors
    ///
    /// Returns an error if the direction is zero or not finite.
    pub fn plane(direction_to_source: DVec3) -> Result<Self, DecorrelationError> {
        Self::spherical(direction_to_source, 0.0)
    }

    /// Creates a spherical wave from the direction to its source, of any length, and its curvature
    /// 1/R, in 1/m.
    ///
    /// # Errors
    ///
    /// Returns an error if the direction is zero or not finite, or the curvature not finite.
    pub fn spherical(
        direction_to_source: DVec3,
        curvature: f64,
    ) -> Result<Self, DecorrelationError> {
        let direction = unit_direction(direction_to_source)?;
        let curvature = checked_curvature(curvature)?;
        Ok(Self {
            direction_to_source: direction,
            curvature: (DMat3::IDENTITY - outer(direction)) * curvature,
        })
    }

    /// Creates an astigmatic wave from the direction to its source, of any length, a principal
    /// axis, and the curvatures 1/R along and across that axis, in 1/m.
    ///
    /// The axis may have any length; only its part across the direction to the source counts.
    ///
    /// # Errors
    ///
    /// Returns an error if a direction is zero or not finite, if the axis is parallel to the
    /// direction to the source, or if a curvature is not finite.
    pub fn astigmatic(
        direction_to_source: DVec3,
        axis: DVec3,
        curvature_along: f64,
        curvature_across: f64,
    ) -> Result<Self, DecorrelationError> {
        let direction = unit_direction(direction_to_source)?;
        let curvature_along = checked_curvature(curvature_along)?;
        let curvature_across = checked_curvature(curvature_across)?;
        let across = axis
            .try_normalize()
            .map(|axis| direction.cross(axis))
            .filter(|across| across.length() > GRAZING_COSINE)
            .ok_or(DecorrelationError::PrincipalAxis(axis))?
            .normalize();
        let along = across.cross(direction);
        Ok(Self {
            direction_to_source: direction,
            curvature: outer(along) * curvature_along + outer(across) * curvature_across,
        })
    }

    /// Returns the unit vector `l_S` from the surface to the source.
    pub const fn direction_to_source(&self) -> DVec3 {
        self.direction_to_source
    }

    /// Returns the symmetric curvature tensor `K`, in 1/m.
    pub const fn curvature(&self) -> DMat3 {
        self.curvature
    }
}

fn unit_direction(direction: DVec3) -> Result<DVec3, DecorrelationError> {
    direction
        .try_normalize()
        .ok_or(DecorrelationError::DirectionToSource(direction))
}

fn checked_curvature(curvature: f64) -> Result<f64, DecorrelationError> {
    if curvature.is_finite() {
        Ok(curvature)
    } else {
        Err(DecorrelationError::Curvature(curvature))
    }
}

/// v vᵀ.
fn outer(v: DVec3) -> DMat3 {
    DMat3::from_cols(v * v.x, v * v.y, v * v.z)
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use super::*;

    const NOT_DIRECTIONS: [DVec3; 3] = [
        DVec3::ZERO,
        DVec3::splat(f64::NAN),
        DVec3::splat(f64::INFINITY),
    ];

    fn norm(m: DMat3) -> f64 {
        m.to_cols_array().iter().map(|x| x * x).sum::<f64>().sqrt()
    }

    #[test]
    fn invalid_directions_and_curvatures_are_rejected() {
        use DecorrelationError as E;
        for bad in NOT_DIRECTIONS {
            let plane = Wavefront::plane(bad);
            assert!(matches!(plane, Err(E::DirectionToSource(_))), "{plane:?}");
            let fan = Wavefront::astigmatic(bad, DVec3::X, 1.0, 1.0);
            assert!(matches!(fan, Err(E::DirectionToSource(_))), "{fan:?}");
            let fan = Wavefront::astigmatic(DVec3::Z, bad, 1.0, 1.0);
            assert!(matches!(fan, Err(E::PrincipalAxis(_))), "{fan:?}");
        }
        let parallel = Wavefront::astigmatic(DVec3::Z, DVec3::NEG_Z, 1.0, 1.0);
        assert!(matches!(parallel, Err(E::PrincipalAxis(_))), "{parallel:?}");
        for bad in [f64::NAN, f64::INFINITY, f64::NEG_INFINITY] {
            let sphere = Wavefront::spherical(DVec3::Z, bad);
            assert!(matches!(sphere, Err(E::Curvature(_))), "{sphere:?}");
            let fan = Wavefront::astigmatic(DVec3::Z, DVec3::X, bad, 0.0);
            assert!(matches!(fan, Err(E::Curvature(_))), "{fan:?}");
            let fan = Wavefront::astigmatic(DVec3::Z, DVec3::X, 0.0, bad);
            assert!(matches!(fan, Err(E::Curvature(_))), "{fan:?}");
        }
    }

    #[test]
    fn only_the_part_of_the_axis_across_the_light_counts() {
        let direction = DVec3::new(1.0, 0.0, 1.0);
        let skewed = Wavefront::astigmatic(direction, DVec3::X * 3.0, 5.0, -2.0).unwrap();
        let square =
            Wavefront::astigmatic(direction, DVec3::new(1.0, 0.0, -1.0), 5.0, -2.0).unwrap();
        // Rounding of entries of size 5.
        let difference = norm(skewed.curvature() - square.curvature());
        assert!(difference < 1e-14, "difference {difference:e}");
    }

    prop_compose! {
        fn directions()(x in -1.0_f64..1.0, y in -1.0_f64..1.0, z in 0.1_f64..1.0) -> DVec3 {
            DVec3::new(x, y, z)
        }
    }

    proptest! {
        #[test]
        fn equal_curvatures_make_a_sphere(
            direction in directions(),
            axis in directions(),
            curvature in -100.0_f64..100.0,
        ) {
            let sine = direction.normalize().cross(axis.normalize()).length();
            prop_assume!(sine > 1e-3);
            let fan = Wavefront::astigmatic(direction, axis, curvature, curvature).unwrap();
            let sphere = Wavefront::spherical(direction, curvature).unwrap();
            // The axes round by ε over the sine between the axis and the direction.
            let tolerance = 10.0 * f64::EPSILON * curvature.abs() / sine;
            prop_assert!(norm(fan.curvature() - sphere.curvature()) <= tolerance);
        }

        #[test]
        fn wave_is_not_curved_along_its_direction(
            direction in directions(),
            axis in directions(),
            along in -100.0_f64..100.0,
            across in -100.0_f64..100.0,
        ) {
            let sine = direction.normalize().cross(axis.normalize()).length();
            prop_assume!(sine > 1e-3);
            let fan = Wavefront::astigmatic(direction, axis, along, across).unwrap();
            let turned = fan.curvature() * fan.direction_to_source();
            prop_assert!(turned.length() <= 10.0 * f64::EPSILON * (along.abs() + across.abs()) / sine);
        }
    }
}
