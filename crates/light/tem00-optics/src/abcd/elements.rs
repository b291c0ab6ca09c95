//! The matrices of single optical elements.

use core::f64::consts::FRAC_PI_2;

use tem00_beam::Refusal;
use tem00_numerics::check;

use super::AbcdMatrix;

/// A thick lens in air.
///
/// A curvature `1/R` is positive where the centre of the sphere lies beyond the surface, along +z,
/// and 0 for a flat surface. A biconvex lens has a positive front and a negative back curvature.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ThickLens {
    /// The refractive index of the glass, from 0.001 to 1000.
    pub index: f64,
    /// The curvature of the surface that the light enters, in m⁻¹.
    pub front_curvature: f64,
    /// The curvature of the surface that the light leaves through, in m⁻¹.
    pub back_curvature: f64,
    /// The distance of the surfaces on the axis, in metres.
    pub thickness: f64,
}

/// # Elements
impl AbcdMatrix {
    /// Returns the identity system, whose input plane is its output plane.
    pub const fn identity() -> Self {
        Self::unimodular([1.0, 0.0, 0.0, 1.0])
    }

    /// Returns a path of the signed `length`, in metres, in one homogeneous medium.
    ///
    /// A negative length steps back, for example to a plane in front of a lens.
    ///
    /// # Errors
    ///
    /// Returns an error if `length` is not finite or beyond 1e30 m.
    pub fn free_space(length: f64) -> Result<Self, Refusal> {
        check::coordinate("length", length)?;
        Ok(Self::unimodular([1.0, length, 0.0, 1.0]))
    }

    /// Returns a thin lens of the signed focal length, in metres; positive for a focusing lens.
    ///
    /// # Errors
    ///
    /// Returns an error if the magnitude of `focal_length` does not lie between 1e−30 m and 1e30 m.
    pub fn thin_lens(focal_length: f64) -> Result<Self, Refusal> {
        let holds = (1e-30..=1e30).contains(&focal_length.abs());
        let allowed = "from 1e-30 m to 1e30 m in magnitude";
        check::that(holds, "focal_length", focal_length, "m", allowed)?;
        Ok(Self::power(-1.0 / focal_length))
    }

    /// Returns a thick lens in air, from the vertex of its front to the vertex of its back.
    ///
    /// # Errors
    ///
    /// Returns an error if the index does not lie between 0.001 and 1000, if a curvature is not
    /// finite or beyond 1e30 m⁻¹, or if the thickness does not lie between 0 and 1e30 m.
    ///
    /// # Examples
    ///
    /// A ball lens of N-BK7, 5 mm across, has the focal length `n D / (4 (n − 1))`:
    ///
    /// ```
    /// use tem00_optics::{AbcdMatrix, ThickLens};
    ///
    /// let ball = AbcdMatrix::thick_lens(&ThickLens {
    ///     index: 1.517,
    ///     front_curvature: 400.0,
    ///     back_curvature: -400.0,
    ///     thickness: 5e-3,
    /// })?;
    /// assert!((ball.focal_length().unwrap() - 3.668e-3).abs() < 1e-6);
    /// assert!((ball.back_focal_distance().unwrap() - 1.168e-3).abs() < 1e-6);
    /// # Ok::<(), tem00_beam::Refusal>(())
    /// ```
    pub fn thick_lens(lens: &ThickLens) -> Result<Self, Refusal> {
        check::range("thickness", lens.thickness, [0.0, 1e30], "m")?;
        let front = Self::curved_interface(1.0, lens.index, lens.front_curvature)?;
        let glass = Self::free_space(lens.thickness)?;
        let back = Self::curved_interface(lens.index, 1.0, lens.back_curvature)?;
        Ok(Self {
            determinant: 1.0,
            ..front.then(glass).then(back)
        })
    }

    /// Returns a mirror at normal incidence with the curvature `1/R`, in m⁻¹; positive for a
    /// concave, focusing mirror, whose focal length is R/2.
    ///
    /// # Errors
    ///
    /// Returns an error if `curvature` is not finite or beyond 1e30 m⁻¹.
    pub fn curved_mirror(curvature: f64) -> Result<Self, Refusal> {
        Ok(Self::power(
            -2.0 * check::range("curvature", curvature, [-1e30, 1e30], "m⁻¹")?,
        ))
    }

    /// Returns a mirror with the curvature `1/R`, in m⁻¹ and positive if concave, at an angle of
    /// incidence in radians: the matrices in the plane of incidence (tangential) and perpendicular
    /// to it (sagittal).
    ///
    /// ```text
    /// f_t = (R/2) cos φ      f_s = (R/2) / cos φ
    /// ```
    ///
    /// # Errors
    ///
    /// Returns an error if `curvature` is not finite or beyond 1e30 m⁻¹, or if `angle_of_incidence`
    /// is not in the open interval (−π/2, π/2).
    ///
    /// # References
    ///
    /// - H. Kogelnik et al., *Astigmatically Compensated Cavities for CW Dye Lasers*, 1972.
    pub fn tilted_mirror(curvature: f64, angle_of_incidence: f64) -> Result<[Self; 2], Refusal> {
        check::range("curvature", curvature, [-1e30, 1e30], "m⁻¹")?;
        let (angle, cos) = (angle_of_incidence, angle_of_incidence.cos());
        let holds = angle.abs() < FRAC_PI_2 && cos > 0.0;
        check::that(
            holds,
            "angle_of_incidence",
            angle,
            "rad",
            "in (-π/2, π/2) rad",
        )?;
        Ok([-2.0 * curvature / cos, -2.0 * curvature * cos].map(Self::power))
    }

    /// Returns a flat interface from a medium of index `index_before` into one of `index_after`.
    ///
    /// # Errors
    ///
    /// Returns an error if an index does not lie between 0.001 and 1000.
    pub fn flat_interface(index_before: f64, index_after: f64) -> Result<Self, Refusal> {
        Self::curved_interface(index_before, index_after, 0.0)
    }

    /// Returns an interface of the curvature `1/R`, in m⁻¹, from a medium of index `index_before`
    /// into one of `index_after`; the curvature is positive where the centre of the sphere lies
    /// beyond the interface, along +z.
    ///
    /// ```text
    /// C = −(n₂ − n₁) / (n₂ R)      D = n₁ / n₂
    /// ```
    ///
    /// # Errors
    ///
    /// Returns an error if an index does not lie between 0.001 and 1000, or if `curvature` is not
    /// finite or beyond 1e30 m⁻¹.
    pub fn curved_interface(
        index_before: f64,
        index_after: f64,
        curvature: f64,
    ) -> Result<Self, Refusal> {
        check::range("curvature", curvature, [-1e30, 1e30], "m⁻¹")?;
        let ratio = checked_index(index_before)? / checked_index(index_after)?;
        Ok(Self {
            a: 1.0,
            b: 0.0,
            c: (index_before - index_after) / index_after * curvature,
            d: ratio,
            determinant: ratio,
        })
    }

    /// Returns a path of the signed `length`, in metres, inside a medium whose index falls off
    /// from the axis as `n(r) = n₀ (1 − g² r² / 2)`, where `gradient` is `g`, in m⁻¹.
    ///
    /// A gradient of 0 is free space. The pitch, after which all rays repeat, is `2π / g`.
    ///
    /// # Errors
    ///
    /// Returns an error if `gradient` does not lie between 0 and 1e30 m⁻¹, or if `length` is not
    /// finite or beyond 1e30 m.
    pub fn grin(gradient: f64, length: f64) -> Result<Self, Refusal> {
        check::range("gradient", gradient, [0.0, 1e30], "m⁻¹")?;
        check::coordinate("length", length)?;
        let phase = gradient * length;
        let (sin, cos) = phase.sin_cos();
        let sinc = if phase == 0.0 { 1.0 } else { sin / phase };
        Ok(Self::unimodular([cos, length * sinc, -gradient * sin, cos]))
    }

    /// Returns a rod of a gradient-index medium with flat faces, in air: `index` is `n₀` on the
    /// axis, `gradient` is `g`, in m⁻¹, and `length` is in metres.
    ///
    /// # Errors
    ///
    /// Returns an error if `index` does not lie between 0.001 and 1000, and the errors of
    /// [`grin`](Self::grin).
    ///
    /// # Examples
    ///
    /// A quarter pitch collimates the light of a fibre at its face, with the focal length
    /// `1 / (n₀ g)`:
    ///
    /// ```
    /// use tem00_optics::AbcdMatrix;
    ///
    /// let gradient = 327.0; // SELFOC-like, pitch 19.2 mm
    /// let quarter_pitch = std::f64::consts::FRAC_PI_2 / gradient;
    /// let collimator = AbcdMatrix::grin_rod(1.5916, gradient, quarter_pitch)?;
    /// assert!((collimator.focal_length().unwrap() - 1.921e-3).abs() < 1e-6);
    /// assert!(collimator.back_focal_distance().unwrap().abs() < 1e-15);
    /// # Ok::<(), tem00_beam::Refusal>(())
    /// ```
    pub fn grin_rod(index: f64, gradient: f64, length: f64) -> Result<Self, Refusal> {
        checked_index(index)?;
        let inside = Self::grin(gradient, length)?;
        Ok(Self {
            b: inside.b / index,
            c: inside.c * index,
            ..inside
        })
    }

    /// The refracting power of an element without length between equal media.
    const fn power(c: f64) -> Self {
        Self::unimodular([1.0, 0.0, c, 1.0])
    }

    const fn unimodular([a, b, c, d]: [f64; 4]) -> Self {
        Self {
            a,
            b,
            c,
            d,
            determinant: 1.0,
        }
    }
}

fn checked_index(index: f64) -> Result<f64, Refusal> {
    check::range("index", index, [1e-3, 1e3], "")
}

#[cfg(test)]
mod tests;
