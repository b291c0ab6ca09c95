use core::f64::consts::PI;

use glam::{DVec2, DVec3};
use tem00_numerics::check;

use crate::{GaussianBeam, LocatedBeam, Refusal};

/// An elliptic Gaussian beam with simple astigmatism: two principal axes at right angles, each with
/// its own waist, waist position and M².
///
/// The beam travels along +z from the reference plane z = 0, the aperture. In its principal axes
/// `u` and `v` it is the product of two one-dimensional beams:
///
/// ```text
/// E / P = 2 / (π w_u w_v) · exp(−2 u² / w_u² − 2 v² / w_v²)     with w_u(z), w_v(z)
/// u =  x cos φ + y sin φ
/// v = −x sin φ + y cos φ
/// ```
///
/// The rotation `φ` turns the x axis to the first principal axis, right-handed about +z.
///
/// # Validity
///
/// Both axes are paraxial. The type cannot describe a beam whose ellipse rotates as it propagates,
/// as behind a cylinder lens that is aligned with neither axis.
///
/// # Examples
///
/// A laser diode of 650 nm, whose data sheet gives full widths at half maximum of 9° and 22° and an
/// astigmatic distance of 10 µm, lights an upright ellipse:
///
/// ```
/// use core::f64::consts::LN_2;
/// use tem00_beam::AstigmaticBeam;
///
/// let half_angle = |fwhm: f64| fwhm.to_radians() / (2.0 * LN_2).sqrt();
/// let diode = AstigmaticBeam::from_divergences(650e-9, [9.0, 22.0].map(half_angle))?
///     .with_waist_distances([-10e-6, 0.0])?;
///
/// let [wx, wy] = diode.radii_at(0.0);
/// assert!((wx - 2.05e-6).abs() < 0.01e-6 && (wy - 0.634e-6).abs() < 0.001e-6);
/// assert!((diode.ellipticity_at(1.0) - 9.0 / 22.0).abs() < 1e-4);
/// # Ok::<(), tem00_beam::Refusal>(())
/// ```
///
/// # References
///
/// - A. E. Siegman, *Lasers*, 1986, ch. 16 and 17.
/// - ISO 11146-1, 2021, for principal axes and ellipticity.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct AstigmaticBeam {
    axes: [LocatedBeam; 2],
    rotation: f64,
}

impl AstigmaticBeam {
    /// Creates a beam from its two axes, with the first one along x and the second one along y.
    ///
    /// # Errors
    ///
    /// Returns an error if the two beams differ in wavelength.
    pub fn new(x: LocatedBeam, y: LocatedBeam) -> Result<Self, Refusal> {
        let [first, second] = [x, y].map(|axis| axis.beam().wavelength());
        if (first - second).abs() > 0.0 {
            return Err(
                Refusal::new("wavelength", [first, second], "equal in both axes").in_unit("m"),
            );
        }
        Ok(Self {
            axes: [x, y],
            rotation: 0.0,
        })
    }

    /// Creates the circular beam whose two axes both equal `beam`.
    pub const fn stigmatic(beam: LocatedBeam) -> Self {
        Self {
            axes: [beam, beam],
            rotation: 0.0,
        }
    }

    /// Creates a diffraction-limited beam from its wavelength, in metres, and the far-field
    /// divergence half-angles along x and y, in radians, with both waists at z = 0.
    ///
    /// The half-angle reaches to 1/e² of the peak. Data sheets of laser diodes give the full width
    /// at half maximum `θ`, and `exp(−2 (θ/2)² / δ²) = 1/2` converts it:
    ///
    /// ```text
    /// δ = θ / √(2 ln 2) = 0.849 θ     the full angle to 1/e² is 1.699 θ
    /// ```
    ///
    /// # Errors
    ///
    /// Returns an error if `wavelength` is not a length from 1e−30 m to 1e30 m, if a divergence is
    /// not in the interval (0, 0.5], or if the resulting waist radius exceeds 1e30 m.
    pub fn from_divergences(wavelength: f64, divergences: [f64; 2]) -> Result<Self, Refusal> {
        let axis = |divergence| {
            let beam = GaussianBeam::from_divergence(wavelength, divergence)?;
            LocatedBeam::new(beam, 0.0)
        };
        Self::new(axis(divergences[0])?, axis(divergences[1])?)
    }

    /// Returns this beam with its waists at other signed distances from the reference plane, in
    /// metres.
    ///
    /// Their difference is the astigmatic distance. In an edge-emitting diode the waist of the fast
    /// axis lies at the facet and the waist of the slow axis a few micrometres behind it.
    ///
    /// # Errors
    ///
    /// Returns an error if a distance is not finite or beyond 1e30 m.
    pub fn with_waist_distances(self, waist_distances: [f64; 2]) -> Result<Self, Refusal> {
        let [x, y] = self.axes;
        let axes = [
            LocatedBeam::new(*x.beam(), waist_distances[0])?,
            LocatedBeam::new(*y.beam(), waist_distances[1])?,
        ];
        Ok(Self { axes, ..self })
    }

    /// Returns this beam with its first principal axis at the angle `rotation`, in radians, from x
    /// towards y.
    ///
    /// # Errors
    ///
    /// Returns an error if `rotation` is not finite.
    pub fn with_rotation(self, rotation: f64) -> Result<Self, Refusal> {
        let rotation = check::finite("rotation", rotation, "rad")?;
        Ok(Self { rotation, ..self })
    }

    /// Returns the beams along the first and the second principal axis.
    pub const fn axes(&self) -> &[LocatedBeam; 2] {
        &self.axes
    }

    /// Returns the angle from x to the first principal axis, in radians.
    pub const fn rotation(&self) -> f64 {
        self.rotation
    }

    /// Returns the wavelength, in metres.
    pub const fn wavelength(&self) -> f64 {
        self.axes[0].beam().wavelength()
    }

    /// Returns the beam radii along the principal axes, in metres, at the distance `z` from the
    /// reference plane.
    pub fn radii_at(&self, z: f64) -> [f64; 2] {
        self.axes.map(|axis| axis.radius_at(z))
    }

    /// Returns the wavefront curvatures `1/R` along the principal axes, in m⁻¹, at the distance `z`
    /// from the reference plane; positive where the beam diverges.
    pub fn curvatures_at(&self, z: f64) -> [f64; 2] {
        self.axes.map(|axis| axis.curvature_at(z))
    }

    /// Returns the Gouy phase, in radians, at the distance `z` from the reference plane: the mean
    /// of the phases of the two axes, each 0 at its own waist.
    pub fn gouy_phase_at(&self, z: f64) -> f64 {
        let phase = |axis: LocatedBeam| axis.beam().gouy_phase_at(z - axis.waist_distance());
        let [x, y] = self.axes.map(phase);
        0.5 * (x + y)
    }

    /// Returns the ratio of the smaller to the larger beam radius, a number from 0 to 1, at the
    /// distance `z` from the reference plane.
    ///
    /// A beam above 0.87 counts as circular in ISO 11146-1.
    pub fn ellipticity_at(&self, z: f64) -> f64 {
        let [x, y] = self.radii_at(z);
        x.min(y) / x.max(y)
    }

    /// Returns the distances from the reference plane, in metres and in ascending order, at which
    /// the beam is circular.
    ///
    /// Where the two waists are apart, one of them lies between the line foci: the circle of least
    /// confusion of a focused beam. Diffraction-limited axes of different waists are equally wide
    /// in two planes; with M² there may be fewer. For a beam that is circular everywhere no plane
    /// is returned, and planes beyond 1e30 m are left out.
    ///
    /// # Examples
    ///
    /// The radii cross midway between two equal waists, and nowhere else:
    ///
    /// ```
    /// use tem00_beam::{AstigmaticBeam, GaussianBeam, LocatedBeam};
    ///
    /// let beam = GaussianBeam::from_waist(633e-9, 50e-6)?;
    /// let focus = AstigmaticBeam::new(
    ///     LocatedBeam::new(beam, 0.10)?,
    ///     LocatedBeam::new(beam, 0.14)?,
    /// )?;
    /// let [plane, other] = focus.circular_planes();
    /// assert!((plane.expect("the radii cross") - 0.12).abs() < 1e-12);
    /// assert_eq!(other, None);
    /// # Ok::<(), tem00_beam::Refusal>(())
    /// ```
    pub fn circular_planes(&self) -> [Option<f64>; 2] {
        let [x, y] = &self.axes;
        let origin = x.waist_distance();
        let named = |t: f64| Some(origin + t).filter(|z| z.abs() <= 1e30);
        match crossings(x, y).map(named) {
            [Some(a), Some(b)] => [Some(a.min(b)), Some(a.max(b))],
            [a, b] => [a.or(b), None],
        }
    }

    /// Returns the irradiance on the axis per watt of beam power, `2 / (π w_u w_v)`, in m⁻², at the
    /// distance `z` from the reference plane.
    pub fn peak_irradiance_per_watt(&self, z: f64) -> f64 {
        let [wu, wv] = self.radii_at(z);
        2.0 / (PI * wu * wv)
    }

    /// Returns the irradiance per watt of beam power, in m⁻², at `point` on a plane perpendicular
    /// to the axis.
    ///
    /// Its integral over any plane of constant z is 1. For a surface of another orientation use
    /// [`flux_per_watt`](Self::flux_per_watt).
    pub fn irradiance_per_watt(&self, point: DVec3) -> f64 {
        let radii = DVec2::from(self.radii_at(point.z));
        let rho = self.principal(point) / radii;
        let exponent = 2.0 * rho.length_squared();
        // exp is 0 beyond. The comparison also rejects a point whose distance overflows.
        if exponent < 750.0 {
            self.peak_irradiance_per_watt(point.z) * (-exponent).exp()
        } else {
            0.0
        }
    }

    /// Returns the energy-flow vector per watt of beam power, in m⁻², at `point`.
    ///
    /// ```text
    /// F / P = E / P · (u / R_u, v / R_v, 1)     in the principal axes
    /// ```
    ///
    /// The bracket is *not* normalised: its z-component is 1, so that F has no divergence and its
    /// integral over any surface that cuts the whole beam is 1. A surface whose normal `n` lies on
    /// the lit side receives the irradiance `max(0, −F·n)`.
    pub fn flux_per_watt(&self, point: DVec3) -> DVec3 {
        let irradiance = self.irradiance_per_watt(point);
        if irradiance > 0.0 {
            let slopes = self.principal(point) * DVec2::from(self.curvatures_at(point.z));
            let turned = DVec2::from_angle(self.rotation).rotate(slopes);
            irradiance * turned.extend(1.0)
        } else {
            DVec3::ZERO
        }
    }

    /// Returns the coordinates (u, v) of `point` along the principal axes.
    fn principal(&self, point: DVec3) -> DVec2 {
        DVec2::from_angle(-self.rotation).rotate(point.truncate())
    }
}

/// Returns the two solutions, measured from the waist of `x`, of
///
/// ```text
/// w_x² + δ_x² t² = w_y² + δ_y² (t − d)²
/// ```
///
/// A solution that does not exist is not finite.
fn crossings(x: &LocatedBeam, y: &LocatedBeam) -> [f64; 2] {
    let d = y.waist_distance() - x.waist_distance();
    let [sx, sy] = [x, y].map(|axis| axis.beam().divergence());
    let [wx, wy] = [x, y].map(|axis| axis.beam().waist_radius());
    let spread = (sx - sy) * (sx + sy);
    let waists = (wx - wy) * (wx + wy);
    let half_linear = sy * sy * d;
    let constant = waists - sy * d * (sy * d);
    // The difference is negative where the radii never meet: the root and the results are then NaN.
    let root = ((sx * sy * d) * (sx * sy * d) - spread * waists).sqrt();
    let sum = -(half_linear + root.copysign(half_linear));
    [sum / spread, constant / sum]
}

#[cfg(test)]
mod tests;
