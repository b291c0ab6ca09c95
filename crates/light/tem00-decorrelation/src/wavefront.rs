use glam::{DMat3, DVec3};
use tem00_numerics::check;

use crate::{GRAZING_COSINE, Refusal, vector::unit};

/// Wavefront of the light that reaches a surface point: its direction and its curvature.
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
/// beam, and negative where the wave converges. They are curvatures of the *wavefront*: 1/R(z) for
/// a Gaussian beam, not the reciprocal distance to the emitter.
///
/// # Off the axis of a beam
///
/// A beam with the curvatures `κ_x` and `κ_y` at the distance z lights a point at the offsets x, y
/// from its axis from the direction `−(x κ_x, y κ_y, 1)`, in coordinates with z along the beam.
/// Give this direction to the constructors. The direction of the axis would be wrong by the angle x
/// κ, which is at most the divergence of a spot and half the angle of a fan.
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
/// # Ok::<(), tem00_decorrelation::Refusal>(())
/// ```
///
/// A helium–neon laser with a waist of 100 µm has a Rayleigh range of 49.65 mm. Seen from 200 mm, a
/// motion a of the surface moves the speckle across the pupil by (1 + d/R) a: by three times the
/// motion 50 mm behind the waist, by the motion itself at the waist, and in the opposite direction
/// 80 mm before it:
///
/// ```
/// use tem00_decorrelation::{
///     CameraFrame, Configuration, ConfigurationData, DVec2, DVec3, Illumination, RigidMotion,
///     RigidMotions, Wavefront,
/// };
///
/// let eye = DVec3::new(0.0, 0.0, 0.2);
/// let motions = RigidMotions {
///     surface: RigidMotion::along(DVec3::new(1e-3, 0.0, 0.0))?,
///     ..RigidMotions::default()
/// };
/// for (z, ratio) in [(50e-3, 3.014), (0.0, 1.0), (-80e-3, -0.805)] {
///     let curvature = z / (z * z + 49.65e-3_f64.powi(2));
///     let beam = Wavefront::spherical(DVec3::Z, curvature)?;
///     let before = Configuration::new(ConfigurationData {
///         wavelength: 632.8e-9,
///         point: DVec3::ZERO,
///         normal: DVec3::Z,
///         illumination: Illumination::near(DVec3::ZERO, beam)?,
///         camera: CameraFrame::look_at(eye, DVec3::ZERO, DVec3::Y)?,
///         pupil: eye,
///     })?;
///     let moved = before.pupil_point_after(&before.moved(&motions)?, DVec2::ZERO).unwrap();
///     assert!((moved.x / 1e-3 - ratio).abs() < 1e-3);
/// }
/// # Ok::<(), tem00_decorrelation::Refusal>(())
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
    pub fn plane(direction_to_source: DVec3) -> Result<Self, Refusal> {
        Self::spherical(direction_to_source, 0.0)
    }

    /// Creates a spherical wave from the direction to its source, of any length, and its curvature
    /// 1/R, in 1/m.
    ///
    /// # Errors
    ///
    /// Returns an error if the direction is zero or not finite, or the curvature not finite.
    pub fn spherical(direction_to_source: DVec3, curvature: f64) -> Result<Self, Refusal> {
        let direction = unit("direction_to_source", direction_to_source)?;
        let curvature = checked_curvature(curvature)?;
        Ok(Self {
            direction_to_source: direction,
            curvature: (DMat3::IDENTITY - outer(direction)) * curvature,
        })
    }

    /// Creates an astigmatic wave from the direction to its source, of any length, a principal
    /// axis, and the curvatures 1/R along and across that axis, in 1/m.
    ///
    /// The axis may have any length; only its component perpendicular to the direction to the
    /// source is used.
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
    ) -> Result<Self, Refusal> {
        let direction = unit("direction_to_source", direction_to_source)?;
        let curvature_along = checked_curvature(curvature_along)?;
        let curvature_across = checked_curvature(curvature_across)?;
        let across = axis
            .try_normalize()
            .map(|axis| direction.cross(axis))
            .filter(|across| across.length() > GRAZING_COSINE)
            .ok_or_else(|| {
                let allowed = "finite, not zero and not along the direction to the source";
                Refusal::new("axis", axis.to_array(), allowed)
            })?
            .normalize();
        let along = across.cross(direction);
        Ok(Self {
            direction_to_source: direction,
            curvature: outer(along) * curvature_along + outer(across) * curvature_across,
        })
    }

    /// Creates a wave from the direction to its source, of any length, and its curvature tensor K,
    /// in 1/m, as obtained from the second derivatives of a measured or computed phase.
    ///
    /// ```text
    /// K = ∂²φ/∂x∂x / k
    /// ```
    ///
    /// The phase φ grows with the path of the light, and k is 2π/λ. Only the part of K
    /// perpendicular to the direction to the source is used.
    ///
    /// # Errors
    ///
    /// Returns an error if the direction is zero or not finite, if the tensor is not finite, or if
    /// it is not symmetric within 10⁻⁶ of its largest entry.
    pub fn from_tensor(direction_to_source: DVec3, curvature: DMat3) -> Result<Self, Refusal> {
        let direction = unit("direction_to_source", direction_to_source)?;
        let largest = largest_entry(curvature);
        let skew = largest_entry(curvature - curvature.transpose());
        // A maximum drops NaN.
        if !(curvature.is_finite() && skew <= 1e-6 * largest) {
            let columns = curvature.to_cols_array();
            let allowed = "finite and symmetric within 1e-6";
            return Err(Refusal::new("curvature", columns, allowed).in_unit("1/m"));
        }
        let across = DMat3::IDENTITY - outer(direction);
        let symmetric = curvature * 0.5 + curvature.transpose() * 0.5;
        Ok(Self {
            direction_to_source: direction,
            curvature: across * symmetric * across,
        })
    }

    /// Creates a wave from the direction to its source, of any length, and the derivatives of this
    /// direction along a surface, as a renderer obtains them from its ray differentials, also after
    /// mirrors and lenses.
    ///
    /// ```text
    /// K t = −∂l_S/∂t
    /// ```
    ///
    /// `dp` are the derivatives of the surface point with respect to two parameters, in metres,
    /// `∂p/∂u` and `∂p/∂v`, and `dl` the derivatives of the unit vector to the source with respect
    /// to the same parameters. At a mirror with the normal n they follow from `∂n/∂u` and `∂n/∂v`
    /// and from the direction d in which the light arrives: the reflected light has the direction d
    /// − 2 n (n·d), and `l_S` points against it. Only the symmetric part perpendicular to the
    /// direction is used; the rays of one wave have no other part.
    ///
    /// # Errors
    ///
    /// Returns an error if the direction is zero or not finite, if differentials are not finite, or
    /// if the derivatives of the point are collinear as seen along the light, within 2⁻²⁶: at
    /// grazing incidence, or where a parametrisation is singular.
    ///
    /// # Examples
    ///
    /// The light of a source at 0.25 m on a surface at 45° to it:
    ///
    /// ```
    /// use tem00_decorrelation::{DVec3, Wavefront};
    ///
    /// let dp = [DVec3::new(1.0, 0.0, 1.0), DVec3::Y];
    /// let dl = [DVec3::new(-4.0, 0.0, 0.0), DVec3::new(0.0, -4.0, 0.0)];
    /// let wave = Wavefront::from_differentials(DVec3::Z, dp, dl)?;
    /// assert_eq!(wave, Wavefront::spherical(DVec3::Z, 1.0 / 0.25)?);
    /// # Ok::<(), tem00_decorrelation::Refusal>(())
    /// ```
    pub fn from_differentials(
        direction_to_source: DVec3,
        dp: [DVec3; 2],
        dl: [DVec3; 2],
    ) -> Result<Self, Refusal> {
        let direction = unit("direction_to_source", direction_to_source)?;
        let [u, v] = dp.map(|t| t - direction * direction.dot(t));
        let area = direction.dot(u.cross(v));
        let [du, dv] = [v.cross(direction) / area, direction.cross(u) / area];
        // NaN fails every comparison.
        if !(area.abs() > GRAZING_COSINE * dp[0].length() * dp[1].length()
            && du.is_finite()
            && dv.is_finite())
        {
            let allowed = "finite, and two directions as the light sees them (the third column)";
            let columns = DMat3::from_cols(dp[0], dp[1], direction).to_cols_array();
            return Err(Refusal::new("dp", columns, allowed).in_unit("m"));
        }
        let turn =
            |by: DVec3, along: DVec3| DMat3::from_cols(by * along.x, by * along.y, by * along.z);
        let curvature = -(turn(dl[0], du) + turn(dl[1], dv));
        if !curvature.is_finite() {
            let allowed = "finite, with a finite curvature (the third column is the direction)";
            let columns = DMat3::from_cols(dl[0], dl[1], direction).to_cols_array();
            return Err(Refusal::new("dl", columns, allowed));
        }
        Self::from_tensor(direction, (curvature + curvature.transpose()) * 0.5)
    }

    /// Returns the unit vector to the source at the displacement `offset`, in metres, from the
    /// point for which the wave is described, or `None` in a focus, where there is no direction.
    ///
    /// ```text
    /// l_S' ∝ l_S − K (I − ζ K)⁻¹ a,    ζ = l_S·a
    /// ```
    ///
    /// # Validity
    ///
    /// Rays are straight, so that spherical and cylindrical waves are extrapolated exactly at any
    /// distance. The curvatures of other waves change from point to point: for them the error is
    /// about the square of the offset in units of the radii or, in a Gaussian beam, of the Rayleigh
    /// range. At larger offsets, describe the wave anew.
    ///
    /// # Examples
    ///
    /// The direction to a point source at 0.3 m, from a point 0.4 m to the side:
    ///
    /// ```
    /// use tem00_decorrelation::{DVec3, Wavefront};
    ///
    /// let wave = Wavefront::spherical(DVec3::Z, 1.0 / 0.3)?;
    /// let direction = wave.direction_from(DVec3::new(0.4, 0.0, 0.0)).unwrap();
    /// assert!((direction - DVec3::new(-0.8, 0.0, 0.6)).length() < 1e-15);
    /// # Ok::<(), tem00_decorrelation::Refusal>(())
    /// ```
    pub fn direction_from(&self, offset: DVec3) -> Option<DVec3> {
        let along = self.direction_to_source.dot(offset);
        let to_reference = (DMat3::IDENTITY - self.curvature * along).try_inverse()?;
        let slope = self.curvature * (to_reference * offset);
        (self.direction_to_source - slope).try_normalize()
    }

    /// Returns the wave after a rotation.
    pub(crate) fn turned(&self, rotation: DMat3) -> Self {
        Self {
            direction_to_source: (rotation * self.direction_to_source).normalize(),
            curvature: rotation * self.curvature * rotation.transpose(),
        }
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

fn checked_curvature(curvature: f64) -> Result<f64, Refusal> {
    check::finite("curvature", curvature, "1/m")
}

fn largest_entry(matrix: DMat3) -> f64 {
    let entries = matrix.to_cols_array();
    entries.iter().fold(0.0, |a, b| a.max(b.abs()))
}

/// v vᵀ.
fn outer(v: DVec3) -> DMat3 {
    DMat3::from_cols(v * v.x, v * v.y, v * v.z)
}

#[cfg(test)]
mod tests;
