//! Ray matrices of one transverse axis.

use tem00_beam::{GaussianBeam, LocatedBeam, Refusal};
use tem00_numerics::check;

use crate::ComplexBeamParameter;

pub(crate) mod elements;
mod resonator;

/// Ray matrix of a paraxial optical system, from an input plane to an output plane.
///
/// ```text
/// x'  = A x + B s        x: height above the axis, in metres
/// s'  = C x + D s        s: slope dx/dz, in radians
/// q'  = (A q + B) / (C q + D)
/// det = A D − B C = n_in / n_out
/// ```
///
/// The slope is not multiplied by the refractive index, so that the determinant is the ratio of the
/// indices before and after the system; it is 1 if the system begins and ends in the same medium.
/// Light travels along +z; behind a mirror the axis is unfolded, so that light still travels along
/// +z. The constructors are the elements, and [`then`](Self::then) joins them in the order of
/// travel.
///
/// The same matrix carries a ray ([`transform_ray`](Self::transform_ray)), a complex beam parameter
/// ([`transform_parameter`](Self::transform_parameter)) and a beam with its wavelength and M²
/// ([`transform`](Self::transform)).
///
/// # Validity
///
/// The matrix is paraxial: slopes are small, and lenses have no aberrations and no aperture. The
/// parameters of every element are limited (lengths to 1e30 m), so that a chain of three elements
/// at their limits stays within the range of `f64`; a product beyond 1e308 overflows, and gives an
/// error as soon as it is applied to a beam.
///
/// # Examples
///
/// A beam expander of two lenses, 50 mm and 200 mm, makes a collimated beam four times as wide:
///
/// ```
/// use tem00_beam::{GaussianBeam, LocatedBeam};
/// use tem00_optics::AbcdMatrix;
///
/// let expander = AbcdMatrix::thin_lens(50e-3)?
///     .then(AbcdMatrix::free_space(250e-3)?)
///     .then(AbcdMatrix::thin_lens(200e-3)?);
/// assert!((expander.a() + 4.0).abs() < 1e-12 && expander.c().abs() < 1e-12);
///
/// let beam = GaussianBeam::from_waist(632.8e-9, 0.5e-3)?;
/// let wide = expander.transform(&LocatedBeam::new(beam, 0.0)?)?;
/// assert!((wide.beam().waist_radius() - 2e-3).abs() < 1e-15);
/// # Ok::<(), tem00_beam::Refusal>(())
/// ```
///
/// # References
///
/// - H. Kogelnik and T. Li, *Laser Beams and Resonators*, 1966, table I and eq. (43).
/// - A. E. Siegman, *Lasers*, 1986, ch. 15 and 20.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct AbcdMatrix {
    a: f64,
    b: f64,
    c: f64,
    d: f64,
    /// The product of the determinants of the elements, since A D − B C would cancel.
    determinant: f64,
}

impl AbcdMatrix {
    /// Creates the matrix with the rows (`a`, `b`) and (`c`, `d`), where `b` is in metres and `c`
    /// in m⁻¹.
    ///
    /// If the elements of the system are known, their own constructors give a more precise
    /// determinant.
    ///
    /// # Errors
    ///
    /// Returns an error if an entry is not finite, or if the determinant is not a positive finite
    /// number.
    pub fn new(a: f64, b: f64, c: f64, d: f64) -> Result<Self, Refusal> {
        check::each(&[a, b, c, d], |entry| check::finite("matrix", entry, ""))?;
        // The first product is not rounded, and the rounding error of the second is added back
        // (Kahan).
        let product = b * c;
        let determinant = a.mul_add(d, -product) - b.mul_add(c, -product);
        check::positive("determinant", determinant, "")?;
        Ok(Self {
            a,
            b,
            c,
            d,
            determinant,
        })
    }

    /// Returns the combination of this system followed by `next`: the matrix product `next · self`.
    ///
    /// # Examples
    ///
    /// ```
    /// use tem00_optics::AbcdMatrix;
    ///
    /// let space = AbcdMatrix::free_space(0.2)?;
    /// let imaging = space.then(AbcdMatrix::thin_lens(0.1)?).then(space);
    /// assert!(imaging.b().abs() < 1e-15, "2f in front, 2f behind: an image");
    /// assert!((imaging.a() + 1.0).abs() < 1e-15, "upside down, life-size");
    /// # Ok::<(), tem00_beam::Refusal>(())
    /// ```
    #[must_use]
    pub fn then(self, next: Self) -> Self {
        Self {
            a: next.a * self.a + next.b * self.c,
            b: next.a * self.b + next.b * self.d,
            c: next.c * self.a + next.d * self.c,
            d: next.c * self.b + next.d * self.d,
            determinant: next.determinant * self.determinant,
        }
    }

    /// Returns the entry `A`: the height behind the system per height in front, at slope 0.
    pub const fn a(&self) -> f64 {
        self.a
    }

    /// Returns the entry `B`, in metres; it is 0 if the output plane is an image of the input
    /// plane, and A is then the magnification.
    pub const fn b(&self) -> f64 {
        self.b
    }

    /// Returns the entry `C`, in m⁻¹; it is negative for a focusing system and 0 for an afocal one.
    pub const fn c(&self) -> f64 {
        self.c
    }

    /// Returns the entry `D`: the slope behind the system per slope in front, on the axis.
    pub const fn d(&self) -> f64 {
        self.d
    }

    /// Returns the determinant `A D − B C = n_in / n_out`.
    pub const fn determinant(&self) -> f64 {
        self.determinant
    }

    /// Returns the focal length `−1/C` on the side of the output, in metres, or `None` for an
    /// afocal system.
    ///
    /// It counts from the [`back_principal_plane`](Self::back_principal_plane) to the back focal
    /// point. On the side of the input the focal length is the same times the determinant.
    pub fn focal_length(&self) -> Option<f64> {
        finite(-1.0 / self.c)
    }

    /// Returns the signed distance `−A/C` from the output plane to the back focal point, where
    /// collimated light is focused, in metres, or `None` for an afocal system.
    pub fn back_focal_distance(&self) -> Option<f64> {
        finite(-self.a / self.c)
    }

    /// Returns the signed distance `(1 − A)/C` from the output plane to the back principal plane,
    /// in metres and positive along +z, or `None` for an afocal system.
    pub fn back_principal_plane(&self) -> Option<f64> {
        finite((1.0 - self.a) / self.c)
    }

    /// Returns the signed distance `(D − det)/C` from the input plane to the front principal
    /// plane, in metres and positive along +z, or `None` for an afocal system.
    pub fn front_principal_plane(&self) -> Option<f64> {
        finite((self.d - self.determinant) / self.c)
    }

    /// Returns the height, in metres, and slope with which a `[height, slope]` leaves the system.
    pub fn transform_ray(&self, [height, slope]: [f64; 2]) -> [f64; 2] {
        [
            self.a * height + self.b * slope,
            self.c * height + self.d * slope,
        ]
    }

    /// Returns the complex beam parameter in the output plane for the parameter in the input plane.
    ///
    /// ```text
    /// z_R' = det · z_R / |C q + D|²
    /// z'   = ((A z + B)(C z + D) + A C z_R²) / |C q + D|²
    /// ```
    ///
    /// The law is the same for every M² (Siegman 1986).
    ///
    /// # Errors
    ///
    /// Returns an error if the parameter in the output plane is outside the range of
    /// [`ComplexBeamParameter::new`].
    pub fn transform_parameter(
        &self,
        parameter: &ComplexBeamParameter,
    ) -> Result<ComplexBeamParameter, Refusal> {
        let (distance, scale) = self.distance_and_scale(parameter);
        let rayleigh_range = self.determinant * (parameter.rayleigh_range() / scale) / scale;
        ComplexBeamParameter::new(distance, rayleigh_range)
    }

    /// Returns the beam behind the system, seen from the output plane, for a beam in front of it,
    /// seen from the input plane.
    ///
    /// ```text
    /// w₀' = w₀ · det / |C q + D|
    /// λ'  = λ · det                  the wavelength in the medium behind the system
    /// ```
    ///
    /// M² does not change.
    ///
    /// # Errors
    ///
    /// Returns an error if the wavelength or the waist leaves the range of 1e−30 m to 1e30 m, if
    /// the waist is below the paraxial limit `2 M² λ' / π`, or if it is farther than 1e30 m from
    /// the output plane.
    pub fn transform(&self, beam: &LocatedBeam) -> Result<LocatedBeam, Refusal> {
        let (distance, scale) = self.distance_and_scale(&ComplexBeamParameter::of(beam));
        let beam = beam.beam();
        let wavelength = beam.wavelength() * self.determinant;
        let waist_radius = beam.waist_radius() * (self.determinant / scale);
        let image =
            GaussianBeam::from_waist(wavelength, waist_radius)?.with_m_squared(beam.m_squared())?;
        LocatedBeam::new(image, -distance)
    }

    /// The distance of the output plane from the new waist, and |C q + D|.
    fn distance_and_scale(&self, q: &ComplexBeamParameter) -> (f64, f64) {
        let (z, z_r) = (q.distance_from_waist(), q.rayleigh_range());
        let (re, im) = (self.c * z + self.d, self.c * z_r);
        let scale = re.hypot(im);
        let numerator = (self.a * z + self.b) * (re / scale) + self.a * z_r * (im / scale);
        (numerator / scale, scale)
    }
}

fn finite(x: f64) -> Option<f64> {
    Some(x).filter(|x| x.is_finite())
}

#[cfg(test)]
mod tests;
