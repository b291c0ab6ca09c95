//! Beams behind optical systems.

use tem00_beam::{AstigmaticBeam, GaussianBeam, LocatedBeam, Refusal};
use tem00_numerics::check;

use crate::AbcdMatrix;

/// Largest relative difference of the determinants of the two axes of a system.
const DETERMINANT_TOLERANCE: f64 = 1e-9;

/// Returns the beam behind a thin lens in the reference plane, for the signed focal length `f`
/// in metres; positive for a focusing lens.
///
/// ```text
/// s      = −waist_distance                           from the waist to the lens
/// s'/f   = 1 + (s/f − 1) / ((s/f − 1)² + (z_R/f)²)   from the lens to the new waist
/// w₀'/w₀ = 1 / √((1 − s/f)² + (z_R/f)²)              magnification
/// ```
///
/// The waist distance of the result is `s'`. Distances along the light are positive: s < 0 means
/// that the beam would have its waist behind the lens, s' < 0 is a virtual waist in front of it.
/// For a vanishing Rayleigh range this is the lens equation of geometrical optics; a collimated
/// beam (s = 0) is focused short of the focal point, at `f / (1 + (f/z_R)²)`. M² enters through the
/// Rayleigh range alone.
///
/// # Errors
///
/// Returns an error if the magnitude of `focal_length` does not lie between 1e−30 m and 1e30 m,
/// if the new waist is below the paraxial limit or beyond 1e30 m, or if it is farther away than
/// 1e30 m.
///
/// # Examples
///
/// A collimated helium–neon beam of 1 mm diameter, focused by a lens of 100 mm:
///
/// ```
/// use tem00_beam::{GaussianBeam, LocatedBeam};
/// use tem00_optics::through_lens;
///
/// let laser = GaussianBeam::from_waist(632.8e-9, 0.5e-3)?;
/// let focus = through_lens(&LocatedBeam::new(laser, 0.0)?, 100e-3)?;
///
/// assert!((focus.beam().waist_radius() - 40.2e-6).abs() < 0.1e-6); // λ f / (π w)
/// assert!((focus.waist_distance() - 99.35e-3).abs() < 0.01e-3); // the focal shift
/// # Ok::<(), tem00_beam::Refusal>(())
/// ```
///
/// # References
///
/// - S. A. Self, *Focusing of Spherical Gaussian Beams*, 1983.
pub fn through_lens(beam: &LocatedBeam, focal_length: f64) -> Result<LocatedBeam, Refusal> {
    AbcdMatrix::thin_lens(focal_length)?.transform(beam)
}

/// Returns the beam behind a system, seen from its output plane, for a beam in front of it,
/// seen from its input plane, where the two matrices act along the principal axes of the beam.
///
/// Spherical lenses have the same matrix in both axes, cylinder lenses and tilted mirrors do not.
///
/// # Errors
///
/// Returns an error if the determinants of the matrices differ by more than 1e−9, and the errors of
/// [`AbcdMatrix::transform`] for either axis.
///
/// # Examples
///
/// A laser diode, focused by a lens of 4.5 mm to 200 mm behind it:
///
/// ```
/// use tem00_beam::AstigmaticBeam;
/// use tem00_optics::{AbcdMatrix, through_axes};
///
/// let diode = AstigmaticBeam::from_divergences(658e-9, [0.133, 0.326])?;
/// let lens = AbcdMatrix::free_space(4.6036e-3)?.then(AbcdMatrix::thin_lens(4.5e-3)?);
/// let [wx, wy] = through_axes(&diode, [lens; 2])?.radii_at(0.2);
/// assert!((wx - 68.4e-6).abs() < 0.1e-6 && (wy - 27.9e-6).abs() < 0.1e-6);
/// # Ok::<(), tem00_beam::Refusal>(())
/// ```
pub fn through_axes(
    beam: &AstigmaticBeam,
    systems: [AbcdMatrix; 2],
) -> Result<AstigmaticBeam, Refusal> {
    let [a, b] = systems.map(|system| system.determinant());
    let holds = (a - b).abs() <= DETERMINANT_TOLERANCE * a;
    check::that(holds, "determinant", [a, b], "", "equal in both axes")?;
    let x = systems[0].transform(&beam.axes()[0])?;
    let y = systems[1].transform(&beam.axes()[1])?;
    // The wavelength of y equals the wavelength of x except for rounding.
    let across = GaussianBeam::from_waist(x.beam().wavelength(), y.beam().waist_radius())?
        .with_m_squared(y.beam().m_squared())?;
    AstigmaticBeam::new(x, LocatedBeam::new(across, y.waist_distance())?)?
        .with_rotation(beam.rotation())
}

#[cfg(test)]
mod tests {
    use core::f64::consts::PI;

    use num_complex::Complex64;

    use tem00_testkit::{assert_absolute, assert_relative};

    use super::*;

    /// A cylinder lens of glass in water, as its faces and the path between them.
    fn lens_of_glass(curvature: f64) -> AbcdMatrix {
        AbcdMatrix::curved_interface(1.333, 1.5168, curvature)
            .unwrap()
            .then(AbcdMatrix::free_space(4e-3).unwrap())
            .then(AbcdMatrix::flat_interface(1.5168, 1.333).unwrap())
    }

    #[test]
    fn each_axis_passes_its_own_system() {
        const RED: f64 = 650e-9;
        let waists = [(40e-6, 1.0, 0.05), (90e-6, 1.6, -0.02)];
        let [x, y] = waists.map(|(w0, m2, z0)| {
            let beam = GaussianBeam::from_waist(RED, w0).unwrap();
            LocatedBeam::new(beam.with_m_squared(m2).unwrap(), z0).unwrap()
        });
        let beam = AstigmaticBeam::new(x, y)
            .unwrap()
            .with_rotation(0.6)
            .unwrap();
        // 1.333/1.5168 · 1.5168/1.333 is not 1: the determinants of the axes differ by rounding.
        let systems = [lens_of_glass(60.0), AbcdMatrix::free_space(4e-3).unwrap()];
        let behind = through_axes(&beam, systems).unwrap();
        assert_eq!(behind.rotation().to_bits(), beam.rotation().to_bits());
        // The q law, written out: q = (z − z₀) + i z_R, and w² = M² λ |q|² / (π z_R).
        for (axis, (system, (w0, m2, z0))) in systems.iter().zip(waists).enumerate() {
            let q = Complex64::new(-z0, PI * w0 * w0 / (m2 * RED));
            let q = (system.a() * q + system.b()) / (system.c() * q + system.d());
            for z in [-0.1, 0.0, 0.04, 0.3] {
                let want = (m2 * RED * (q + z).norm_sqr() / (PI * q.im)).sqrt();
                let got = behind.radii_at(z)[axis];
                // The tolerance covers a few roundings of the matrix and of q.
                assert_relative(got, want, 1e-12);
            }
        }
    }

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
                    let image = through_lens(&LocatedBeam::new(beam, -s).unwrap(), f).unwrap();
                    let [distance, magnification] = printed(s, f, z_r);
                    // The printed form subtracts terms of the size f, at most 34 z_R here, from a
                    // result that the depth z_R' = z_R m² may undercut by m⁻², at most 1e3.
                    let scale = image.waist_distance().abs() + f.abs();
                    let error = (image.waist_distance() - distance) / scale;
                    assert!(error.abs() < 1e-12, "s = {s}, f = {f}: {error:e}");
                    let ratio = image.beam().waist_radius() / (100e-6 * magnification);
                    assert!((ratio - 1.0).abs() < 1e-12, "s = {s}, f = {f}: {ratio}");
                    assert_absolute(image.beam().m_squared(), m_squared, f64::EPSILON);
                }
            }
        }
    }
}
