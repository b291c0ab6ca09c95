//! Focusing by a lens.

use crate::optics::AbcdMatrix;
use crate::{LocatedBeam, Refusal};

impl LocatedBeam {
    /// Returns the beam behind a thin lens in the reference plane, for the signed focal length `f`
    /// in metres; positive for a focusing lens.
    ///
    /// ```text
    /// s      = −waist_distance                           from the waist to the lens
    /// s'/f   = 1 + (s/f − 1) / ((s/f − 1)² + (z_R/f)²)   from the lens to the new waist
    /// w₀'/w₀ = 1 / √((1 − s/f)² + (z_R/f)²)              magnification
    /// ```
    ///
    /// The waist distance of the result is `s'`. Distances along the light are positive: s < 0 is a
    /// beam that would have its waist behind the lens, s' < 0 a virtual waist in front of it. With a
    /// vanishing Rayleigh range this is the lens equation of rays; a collimated beam (s = 0) is
    /// focused short of the focal point, at `f / (1 + (f/z_R)²)`. M² enters through the Rayleigh
    /// range alone.
    ///
    /// # Errors
    ///
    /// Returns an error if the magnitude of `focal_length` does not lie between 1e−30 m and 1e30 m,
    /// if the new waist is below the paraxial limit or beyond 1e30 m, or if it is farther than
    /// 1e30 m away.
    ///
    /// # Examples
    ///
    /// A collimated helium–neon beam of 1 mm diameter, focused by a lens of 100 mm:
    ///
    /// ```
    /// use tem00_beam::{GaussianBeam, LocatedBeam};
    ///
    /// let laser = GaussianBeam::from_waist(632.8e-9, 0.5e-3)?;
    /// let focus = LocatedBeam::new(laser, 0.0)?.through_lens(100e-3)?;
    ///
    /// assert!((focus.beam().waist_radius() - 40.2e-6).abs() < 0.1e-6); // λ f / (π w)
    /// assert!((focus.waist_distance() - 99.35e-3).abs() < 0.01e-3); // the focal shift
    /// # Ok::<(), tem00_beam::Refusal>(())
    /// ```
    ///
    /// # References
    ///
    /// - S. A. Self, *Focusing of Spherical Gaussian Beams*, 1983.
    pub fn through_lens(&self, focal_length: f64) -> Result<Self, Refusal> {
        AbcdMatrix::thin_lens(focal_length)?.transform(self)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::GaussianBeam;

    /// The distance s' and the magnification w₀'/w₀, as Self prints them.
    fn printed(s: f64, f: f64, z_r: f64) -> [f64; 2] {
        let denominator = (s / f - 1.0).powi(2) + (z_r / f).powi(2);
        [
            f * (1.0 + (s / f - 1.0) / denominator),
            1.0 / denominator.sqrt(),
        ]
    }

    #[test]
    fn a_lens_obeys_the_printed_closed_form() {
        for m_squared in [1.0, 2.5] {
            let beam = GaussianBeam::from_waist(632.8e-9, 100e-6).unwrap();
            let beam = beam.with_m_squared(m_squared).unwrap();
            let z_r = beam.rayleigh_range();
            for f in [-0.5, -0.05, 0.02, 0.1, 1.0] {
                for s in [-0.3, 0.0, 0.02, 0.1, 0.7] {
                    let image = LocatedBeam::new(beam, -s).unwrap().through_lens(f).unwrap();
                    let [distance, magnification] = printed(s, f, z_r);
                    // The printed form subtracts terms of the size f, at most 34 z_R here, from a
                    // result that the depth z_R' = z_R m² may undercut by m⁻², at most 1e3.
                    let scale = image.waist_distance().abs() + f.abs();
                    let error = (image.waist_distance() - distance) / scale;
                    assert!(error.abs() < 1e-12, "s = {s}, f = {f}: {error:e}");
                    let ratio = image.beam().waist_radius() / (100e-6 * magnification);
                    assert!((ratio - 1.0).abs() < 1e-12, "s = {s}, f = {f}: {ratio}");
                    assert!(
                        (image.beam().m_squared() - m_squared).abs() < f64::EPSILON,
                        "{image:?}"
                    );
                }
            }
        }
    }

    #[test]
    fn a_collimated_beam_is_focused_short_of_the_focal_point() {
        let beam = GaussianBeam::from_waist(1064e-9, 0.4e-3).unwrap();
        let z_r = beam.rayleigh_range();
        for f in [-0.3, 0.05, 0.3, 2.0] {
            let focus = LocatedBeam::new(beam, 0.0)
                .unwrap()
                .through_lens(f)
                .unwrap();
            let expected = f / (1.0 + (f / z_r).powi(2));
            let error = focus.waist_distance() / expected - 1.0;
            assert!(error.abs() < 1e-14, "f = {f}: {error:e}");
        }
    }

    #[test]
    fn the_longest_working_distance_is_one_rayleigh_range_beyond_the_front_focus() {
        // s' = f + f² (s − f) / ((s − f)² + z_R²) peaks at s = f + z_R, with f + f² / (2 z_R).
        let beam = GaussianBeam::from_waist(650e-9, 50e-6).unwrap();
        let (f, z_r) = (0.1, beam.rayleigh_range());
        let reach = |s: f64| {
            let located = LocatedBeam::new(beam, -s).unwrap();
            located.through_lens(f).unwrap().waist_distance()
        };
        let peak = reach(f + z_r);
        let expected = f + 0.5 * f * f / z_r;
        assert!((peak / expected - 1.0).abs() < 1e-14, "{peak}, {expected}");
        assert!(reach(f + 1.1 * z_r) < peak, "farther");
        assert!(reach(f + 0.9 * z_r) < peak, "nearer");
    }

    #[test]
    fn a_lens_bends_the_wavefront_and_leaves_the_radius() {
        let beam = GaussianBeam::from_waist(650e-9, 50e-6).unwrap();
        for distance in [-0.4, -0.01, 0.0, 0.3] {
            let before = LocatedBeam::new(beam, distance).unwrap();
            for f in [-0.2, 0.06, 0.5] {
                let after = before.through_lens(f).unwrap();
                let ratio = after.radius_at(0.0) / before.radius_at(0.0);
                assert!((ratio - 1.0).abs() < 1e-13, "{distance}, {f}: {ratio}");
                let bend = before.curvature_at(0.0) - after.curvature_at(0.0);
                assert!((bend * f - 1.0).abs() < 1e-12, "{distance}, {f}: {bend}");
            }
        }
    }
}
