use glam::{DMat2, DVec2};

use crate::BeamError;
use crate::optics::AbcdMatrix;
use crate::range::{check_coordinate, is_length};

/// Largest deviation from symplectic of a matrix given by its entries, relative to its largest
/// products.
const SYMPLECTIC_TOLERANCE: f64 = 1e-9;

/// The ray-transfer matrix of a paraxial system that may act differently in x and y, and mix them.
///
/// A ray enters at the position `x = (x, y)`, in metres, with the slope `s = (s_x, s_y)` and leaves
/// with
///
/// ```text
/// x' = A x + B s
/// s' = C x + D s
/// ```
///
/// Slopes are those of the ray itself, not multiplied by an index of refraction. The index `n` of
/// the medium before and `n'` of that behind then show in the matrix:
///
/// ```text
/// A Dᵀ − B Cᵀ = n/n' · 1     A Bᵀ and C Dᵀ symmetric
/// ```
///
/// That makes a system of lenses, mirrors and distances out of four matrices: it is *symplectic* up
/// to the ratio of the indices, so that no power is lost and no beam gets better.
///
/// # Examples
///
/// Two equal cylinder lenses at right angles are one lens:
///
/// ```
/// use core::f64::consts::FRAC_PI_2;
/// use tem00_beam::DVec2;
/// use tem00_beam::optics::AstigmaticSystem;
///
/// let crossed = AstigmaticSystem::cylinder_lens(0.1, 0.3)?
///     .then(AstigmaticSystem::cylinder_lens(0.1, 0.3 + FRAC_PI_2)?);
///
/// let [_, slope] = crossed.transform_ray([DVec2::new(1e-3, 2e-3), DVec2::ZERO]);
/// assert!((slope - DVec2::new(-0.01, -0.02)).length() < 1e-15);
/// # Ok::<(), tem00_beam::BeamError>(())
/// ```
///
/// # References
///
/// - A. E. Siegman, *Lasers*, 1986, ch. 15.
/// - J. A. Arnaud and H. Kogelnik, "Gaussian light beams with general astigmatism", 1969.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct AstigmaticSystem {
    a: DMat2,
    b: DMat2,
    c: DMat2,
    d: DMat2,
    index_ratio: f64,
}

impl AstigmaticSystem {
    /// Creates a system from the blocks `[[A, B], [C, D]]` of its matrix.
    ///
    /// # Errors
    ///
    /// Returns an error if an entry is not finite, if `A Dᵀ − B Cᵀ` is not a positive
    /// number times the identity, or if `A Bᵀ` or `C Dᵀ` is not symmetric. Deviations of 1e−9 of the
    /// largest product of entries in such an expression are accepted; no product may overflow.
    ///
    /// # Examples
    ///
    /// ```
    /// use tem00_beam::{BeamError, DMat2};
    /// use tem00_beam::optics::AstigmaticSystem;
    ///
    /// let one = DMat2::IDENTITY;
    /// let path = AstigmaticSystem::new([[one, 0.1 * one], [DMat2::ZERO, one]])?;
    /// assert_eq!(path, AstigmaticSystem::free_space(0.1)?);
    ///
    /// // No lens makes a beam narrower in x alone and leaves its slopes as they are.
    /// let narrow = DMat2::from_diagonal([0.5, 1.0].into());
    /// let magic = AstigmaticSystem::new([[narrow, DMat2::ZERO], [DMat2::ZERO, one]]);
    /// assert!(matches!(magic, Err(e) if e.parameter() == "matrix"));
    /// # Ok::<(), BeamError>(())
    /// ```
    pub fn new([[a, b], [c, d]]: [[DMat2; 2]; 2]) -> Result<Self, BeamError> {
        let mut entries = [a, b, c, d].into_iter().flat_map(|m| m.to_cols_array());
        if let Some(bad) = entries.find(|entry| !entry.is_finite()) {
            return Err(BeamError::out_of_range(
                "matrix",
                bad,
                "",
                "finite in all entries",
            ));
        }
        let ratio = a * d.transpose() - b * c.transpose();
        let index_ratio = 0.5 * (ratio.x_axis.x + ratio.y_axis.y);
        let products = magnitude(a, d) + magnitude(b, c);
        let deviation = relative(
            ratio - DMat2::from_diagonal(DVec2::splat(index_ratio)),
            products,
        )
        .max(relative(skew(a, b), magnitude(a, b)))
        .max(relative(skew(c, d), magnitude(c, d)));
        if deviation <= SYMPLECTIC_TOLERANCE && is_length(index_ratio) {
            Ok(Self {
                a,
                b,
                c,
                d,
                index_ratio,
            })
        } else {
            Err(BeamError::out_of_range(
                "matrix",
                deviation,
                "",
                "symplectic up to the ratio of the refractive indices (the relative deviation is \
                 shown)",
            ))
        }
    }

    /// Creates the system that acts as one of the two matrices in each of its principal axes, the
    /// first of which lies at the angle `rotation`, in radians, from x towards y.
    ///
    /// # Errors
    ///
    /// Returns an error if the determinants of the matrices, which are the ratio of the indices of
    /// refraction, differ by more than 1e−9; or if `rotation` is not finite.
    ///
    /// # Examples
    ///
    /// A concave mirror hit at 45° focuses in the plane of incidence first:
    ///
    /// ```
    /// use tem00_beam::DVec2;
    /// use tem00_beam::optics::{AbcdMatrix, AstigmaticSystem};
    ///
    /// let planes = AbcdMatrix::tilted_mirror(10.0, 45_f64.to_radians())?;
    /// let mirror = AstigmaticSystem::from_axes(planes, 0.0)?;
    /// let [_, slope] = mirror.transform_ray([DVec2::splat(1e-3), DVec2::ZERO]);
    /// assert!((slope.x + 0.0283).abs() < 1e-4 && (slope.y + 0.0141).abs() < 1e-4);
    /// # Ok::<(), tem00_beam::BeamError>(())
    /// ```
    pub fn from_axes(axes: [AbcdMatrix; 2], rotation: f64) -> Result<Self, BeamError> {
        let turn = DMat2::from_angle(finite_rotation(rotation)?);
        check_determinants(&axes)?;
        let [x, y] = axes.map(|axis| axis.determinant());
        let block = |entry: fn(&AbcdMatrix) -> f64| {
            let [x, y] = &axes;
            turn * DMat2::from_diagonal(DVec2::new(entry(x), entry(y))) * turn.transpose()
        };
        Ok(Self {
            a: block(AbcdMatrix::a),
            b: block(AbcdMatrix::b),
            c: block(AbcdMatrix::c),
            d: block(AbcdMatrix::d),
            index_ratio: 0.5 * (x + y),
        })
    }

    /// Creates the system of a straight path of `length`, in metres; a negative one leads back.
    ///
    /// # Errors
    ///
    /// Returns an error if `length` is not finite or beyond 1e30 m.
    pub fn free_space(length: f64) -> Result<Self, BeamError> {
        check_coordinate("length", length)?;
        Ok(Self {
            b: DMat2::IDENTITY * length,
            ..Self::straight(DMat2::IDENTITY)
        })
    }

    /// Creates a thin lens of the focal length `focal_length`, in metres, positive where it focuses.
    ///
    /// # Errors
    ///
    /// Returns an error if the magnitude of `focal_length` is not a length from 1e−30 m to 1e30 m.
    pub fn thin_lens(focal_length: f64) -> Result<Self, BeamError> {
        Self::lens(focal_length, DMat2::IDENTITY)
    }

    /// Creates a thin cylinder lens of the focal length `focal_length`, in metres, that bends rays
    /// along the direction at the angle `rotation`, in radians, from x towards y.
    ///
    /// The axis of its cylinder is at right angles to that direction: with `rotation = 0` the lens
    /// acts on x and the line focus is parallel to y.
    ///
    /// # Errors
    ///
    /// Returns an error if the magnitude of `focal_length` is not a length from 1e−30 m to 1e30 m,
    /// or if `rotation` is not finite.
    pub fn cylinder_lens(focal_length: f64, rotation: f64) -> Result<Self, BeamError> {
        let u = DVec2::from_angle(finite_rotation(rotation)?);
        Self::lens(focal_length, DMat2::from_cols(u * u.x, u * u.y))
    }

    /// Creates a system that turns positions and slopes by the angle `rotation`, in radians, from x
    /// towards y, as an image rotator of mirrors does.
    ///
    /// # Errors
    ///
    /// Returns an error if `rotation` is not finite.
    pub fn image_rotation(rotation: f64) -> Result<Self, BeamError> {
        Ok(Self::straight(DMat2::from_angle(finite_rotation(
            rotation,
        )?)))
    }

    /// Returns the system of this one followed by `next`, in the order in which light meets them.
    ///
    /// The matrix is the product `next · self`. Where systems of extreme entries follow one another
    /// it may overflow, which is an error as soon as it meets a beam.
    #[must_use]
    pub fn then(self, next: Self) -> Self {
        Self {
            a: next.a * self.a + next.b * self.c,
            b: next.a * self.b + next.b * self.d,
            c: next.c * self.a + next.d * self.c,
            d: next.c * self.b + next.d * self.d,
            index_ratio: self.index_ratio * next.index_ratio,
        }
    }

    /// Returns the ray `[position, slope]` behind the system, from that before it.
    pub fn transform_ray(&self, [position, slope]: [DVec2; 2]) -> [DVec2; 2] {
        [
            self.a * position + self.b * slope,
            self.c * position + self.d * slope,
        ]
    }

    /// Returns the blocks `[[A, B], [C, D]]` of the matrix; `B` is in metres, `C` in m⁻¹.
    pub const fn blocks(&self) -> [[DMat2; 2]; 2] {
        [[self.a, self.b], [self.c, self.d]]
    }

    /// Returns the ratio `n/n'` of the index of refraction before the system to that behind it.
    ///
    /// It is also the ratio of the wavelength behind to that before.
    pub const fn index_ratio(&self) -> f64 {
        self.index_ratio
    }

    /// A lens whose power acts along the directions that `projection` keeps.
    fn lens(focal_length: f64, projection: DMat2) -> Result<Self, BeamError> {
        if is_length(focal_length.abs()) {
            Ok(Self {
                c: projection * (-1.0 / focal_length),
                ..Self::straight(DMat2::IDENTITY)
            })
        } else {
            Err(BeamError::out_of_range(
                "focal_length",
                focal_length,
                "m",
                "between 1e-30 m and 1e30 m in magnitude",
            ))
        }
    }

    /// A thin system that applies the orthogonal `matrix` to positions and slopes.
    const fn straight(matrix: DMat2) -> Self {
        Self {
            a: matrix,
            b: DMat2::ZERO,
            c: DMat2::ZERO,
            d: matrix,
            index_ratio: 1.0,
        }
    }
}

/// Checks that light leaves both axes of a system into one medium.
pub(crate) fn check_determinants(axes: &[AbcdMatrix; 2]) -> Result<(), BeamError> {
    let [x, y] = axes.map(|axis| axis.determinant());
    if (x - y).abs() > SYMPLECTIC_TOLERANCE * x {
        return Err(BeamError::AxesDiffer {
            parameter: "determinant",
            values: [x, y],
        });
    }
    Ok(())
}

fn finite_rotation(rotation: f64) -> Result<f64, BeamError> {
    if rotation.is_finite() {
        Ok(rotation)
    } else {
        Err(BeamError::out_of_range(
            "rotation", rotation, "rad", "finite",
        ))
    }
}

/// Returns the antisymmetric part of `a bᵀ`, times 2.
fn skew(a: DMat2, b: DMat2) -> DMat2 {
    a * b.transpose() - b * a.transpose()
}

/// Returns the largest sum of magnitudes of products in `a bᵀ`.
fn magnitude(a: DMat2, b: DMat2) -> f64 {
    largest(a.abs() * b.abs().transpose())
}

/// Returns the largest entry of `residual` relative to `scale`; 0 if all are 0, and infinity where
/// the products overflow.
fn relative(residual: DMat2, scale: f64) -> f64 {
    if !scale.is_finite() {
        f64::INFINITY
    } else if scale > 0.0 {
        largest(residual.abs()) / scale
    } else {
        0.0
    }
}

fn largest(matrix: DMat2) -> f64 {
    matrix.to_cols_array().into_iter().fold(0.0, f64::max)
}

#[cfg(test)]
mod tests;
