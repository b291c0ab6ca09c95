use glam::DVec3;

use crate::{
    Refusal, RigidMotion, Wavefront,
    vector::{finite, unit},
};

/// A light source in world coordinates, as far as its speckle is concerned: the direction from
/// which it lights each point.
///
/// # Examples
///
/// ```
/// use tem00_decorrelation::{DVec3, Illumination, Wavefront};
///
/// let source = Illumination::point_source(DVec3::new(0.0, 0.0, 0.5))?;
/// assert_eq!(source.direction_from(DVec3::ZERO), Some(DVec3::Z));
///
/// // A fan along x with its apex at the same point, known where it meets the surface.
/// let fan = Wavefront::astigmatic(DVec3::Z, DVec3::X, 1.0 / 0.5, 0.0)?;
/// let line = Illumination::near(DVec3::ZERO, fan)?;
/// let x = DVec3::new(0.1, 0.0, 0.0);
/// assert_eq!(line.direction_from(x), source.direction_from(x));
/// # Ok::<(), tem00_decorrelation::Refusal>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Illumination {
    kind: Kind,
}

#[derive(Clone, Copy, Debug, PartialEq)]
enum Kind {
    /// Light from one direction, of unit length.
    Collimated(DVec3),
    PointSource(DVec3),
    Near {
        reference: DVec3,
        wavefront: Wavefront,
    },
}

impl Illumination {
    /// Creates collimated light from the direction to its source, of any length.
    ///
    /// # Errors
    ///
    /// Returns an error if the direction is zero or not finite.
    pub fn collimated(direction_to_source: DVec3) -> Result<Self, Refusal> {
        let kind = Kind::Collimated(unit("direction_to_source", direction_to_source)?);
        Ok(Self { kind })
    }

    /// Creates the light of a point source at a position, in metres.
    ///
    /// # Errors
    ///
    /// Returns an error if the position is not finite.
    pub fn point_source(position: DVec3) -> Result<Self, Refusal> {
        finite("position", position)?;
        Ok(Self {
            kind: Kind::PointSource(position),
        })
    }

    /// Creates light from its wavefront at a position, in metres.
    ///
    /// Around this position [`Wavefront::direction_from`] extrapolates the wave, within the limits
    /// stated there. Choose a position near the surface point, and describe a beam anew if the
    /// surface has moved too far through it.
    ///
    /// # Errors
    ///
    /// Returns an error if the position is not finite.
    pub fn near(position: DVec3, wavefront: Wavefront) -> Result<Self, Refusal> {
        finite("position", position)?;
        Ok(Self {
            kind: Kind::Near {
                reference: position,
                wavefront,
            },
        })
    }

    /// Returns the unit vector from a point, in metres, to the source, or `None` in a focus or at
    /// the source itself.
    pub fn direction_from(&self, point: DVec3) -> Option<DVec3> {
        match self.kind {
            Kind::Collimated(direction) => Some(direction),
            Kind::PointSource(position) => (position - point).try_normalize(),
            Kind::Near {
                reference,
                wavefront,
            } => wavefront.direction_from(point - reference),
        }
    }

    /// Returns the light after its source has moved.
    #[must_use]
    pub fn moved(&self, motion: &RigidMotion) -> Self {
        let kind = match self.kind {
            Kind::Collimated(direction) => {
                Kind::Collimated(motion.direction(direction).normalize())
            }
            Kind::PointSource(position) => Kind::PointSource(motion.point(position)),
            Kind::Near {
                reference,
                wavefront,
            } => Kind::Near {
                reference: motion.point(reference),
                wavefront: wavefront.turned(motion.rotation()),
            },
        };
        Self { kind }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn there_is_no_light_in_a_source() {
        let source = Illumination::point_source(DVec3::X).unwrap();
        assert_eq!(source.direction_from(DVec3::X), None, "in the source");
    }

    #[test]
    fn light_moves_with_its_source() {
        let fan = Wavefront::astigmatic(DVec3::new(0.2, 0.1, 1.0), DVec3::X, 4.0, -3.0).unwrap();
        let sources = [
            Illumination::collimated(DVec3::new(1.0, 2.0, 3.0)).unwrap(),
            Illumination::point_source(DVec3::new(0.1, 0.2, 0.5)).unwrap(),
            Illumination::near(DVec3::new(0.02, -0.01, 0.03), fan).unwrap(),
        ];
        let turn = RigidMotion::about(DVec3::Y, DVec3::new(0.3, -0.5, 1.0), 0.8).unwrap();
        let motion = turn.then(&RigidMotion::along(DVec3::new(0.1, 0.0, -0.2)).unwrap());
        for source in sources {
            for point in [DVec3::ZERO, DVec3::new(0.05, -0.08, 0.02)] {
                let before = source.direction_from(point).unwrap();
                let after = source.moved(&motion).direction_from(motion.point(point));
                // An observer who moves with the light sees it unchanged.
                let difference = (after.unwrap() - motion.direction(before)).length();
                assert!(difference < 1e-14, "{source:?} at {point}: {difference:e}");
            }
        }
    }
}
