use tem00_numerics::check;

use crate::{GaussianBeam, Refusal};

/// A Gaussian beam and the position of its waist relative to a reference plane.
///
/// The reference plane lies where two parts of a set-up meet: an aperture, a lens, the end of an
/// optical system. The beam travels along +z, z = 0 is the reference plane, and the waist lies at
/// `z = waist_distance`: positive if the waist is still ahead, negative if the beam has passed it
/// or it is virtual.
///
/// # Examples
///
/// ```
/// use tem00_beam::{GaussianBeam, LocatedBeam};
///
/// let beam = GaussianBeam::from_waist(650e-9, 50e-6)?;
/// let ahead = LocatedBeam::new(beam, 0.2)?;
/// assert!((ahead.radius_at(0.2) - 50e-6).abs() < 1e-18);
/// assert!(ahead.curvature_at(0.0) < 0.0, "it converges until the waist");
/// # Ok::<(), tem00_beam::Refusal>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct LocatedBeam {
    beam: GaussianBeam,
    waist_distance: f64,
}

impl LocatedBeam {
    /// Creates a beam whose waist is at the signed distance `waist_distance`, in metres, from the
    /// reference plane.
    ///
    /// # Errors
    ///
    /// Returns an error if `waist_distance` is not finite or beyond 1e30 m.
    pub fn new(beam: GaussianBeam, waist_distance: f64) -> Result<Self, Refusal> {
        Ok(Self {
            beam,
            waist_distance: check::coordinate("waist_distance", waist_distance)?,
        })
    }

    /// Returns the beam.
    pub const fn beam(&self) -> &GaussianBeam {
        &self.beam
    }

    /// Returns the signed distance from the reference plane to the waist, in metres.
    pub const fn waist_distance(&self) -> f64 {
        self.waist_distance
    }

    /// Returns the beam radius, in metres, at the signed distance `z` from the reference plane.
    pub fn radius_at(&self, z: f64) -> f64 {
        self.beam.radius_at(z - self.waist_distance)
    }

    /// Returns the wavefront curvature `1/R`, in m⁻¹, at the signed distance `z` from the reference
    /// plane; positive where the beam diverges.
    pub fn curvature_at(&self, z: f64) -> f64 {
        self.beam.curvature_at(z - self.waist_distance)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn distances_count_from_the_reference_plane() {
        let beam = GaussianBeam::from_waist(650e-9, 50e-6).unwrap();
        let located = LocatedBeam::new(beam, 0.2).unwrap();
        for z in [-0.1, 0.0, 0.15, 0.4] {
            let (w, c) = (beam.radius_at(z - 0.2), beam.curvature_at(z - 0.2));
            assert!((located.radius_at(z) / w - 1.0).abs() < 1e-15, "z = {z}");
            assert!((located.curvature_at(z) - c).abs() < 1e-15, "z = {z}");
        }
        assert!(
            located.curvature_at(0.4) > 0.0,
            "it diverges behind the waist"
        );
    }
}
