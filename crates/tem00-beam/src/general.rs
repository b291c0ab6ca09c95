use core::f64::consts::PI;

use glam::{DMat2, DVec2, DVec3};
use num_complex::Complex64;

use crate::gaussian::PARAXIAL_LIMIT;
use crate::measurement::CrossSection;
use crate::optics::AstigmaticSystem;
use crate::range::{check, check_length};
use crate::{AstigmaticBeam, BeamError};

use generator::{Ellipse, Generator, combine, covariance};

mod generator;

/// Largest rounding error, below 1, of the M² of a mode that is diffraction-limited.
const M_SQUARED_ROUNDING: f64 = 1e-6;

/// The second moments of the phase space of a beam at one plane.
///
/// They are covariances of the position `(x, y)`, in metres, and the slope `(s_x, s_y)` of the rays
/// of the beam. A radius to 1/e² is twice a standard deviation: `⟨x²⟩ = w²/4`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SecondMoments {
    /// `⟨x xᵀ⟩`, in m²; symmetric.
    pub position: DMat2,
    /// `⟨x sᵀ⟩`, in metres, with the component of the position as row and that of the slope as
    /// column. It need not be symmetric.
    pub mixed: DMat2,
    /// `⟨s sᵀ⟩`; symmetric.
    pub slope: DMat2,
}

/// A Gaussian beam with general astigmatism: the ellipse of its irradiance may turn on its way, and
/// it may be twisted and partially coherent.
///
/// The beam travels along +z from the reference plane z = 0. Its phase space is a normal density of
/// position and slope; straight rays drawn from it carry the beam:
///
/// ```text
/// ⟨x xᵀ⟩(z) = W + (K + z) S (K + z)ᵀ     W: spread of positions at a given slope
/// ⟨x sᵀ⟩(z) =     (K + z) S              K: position per slope at z = 0
/// ⟨s sᵀ⟩    =             S              S: spread of slopes
/// ```
///
/// All terms are positive, so that nothing cancels near a focus far from the reference plane. A beam
/// with simple astigmatism has `W`, `K` and `S` diagonal in common axes.
///
/// # Validity
///
/// Paraxial: the divergence is at most 0.5 rad. Both modes of the beam have an M² of at least 1,
/// within rounding; with both at 1 the beam is coherent, and its field is an elliptic Gaussian. Beams
/// with M² above 1 are of the Gaussian Schell kind. Distances up to 1e30 m keep all numbers finite.
///
/// # Examples
///
/// A cylinder lens at 45° to an elliptic beam makes the spot turn on its way through the focus:
///
/// ```
/// use core::f64::consts::FRAC_PI_4;
/// use tem00_beam::{AstigmaticBeam, GeneralAstigmaticBeam};
/// use tem00_beam::optics::AstigmaticSystem;
///
/// let elliptic = AstigmaticBeam::from_divergences(650e-9, [0.5e-3, 1e-3])?;
/// let lens = AstigmaticSystem::cylinder_lens(0.1, FRAC_PI_4)?;
/// let beam = GeneralAstigmaticBeam::from(elliptic).through(&lens)?;
///
/// let angles = [0.0, 0.1, 0.3].map(|z| beam.orientation_at(z).to_degrees());
/// for (angle, expected) in angles.into_iter().zip([0.0, -47.0, 67.6]) {
///     assert!((angle - expected).abs() < 0.1);
/// }
///
/// let [smaller, larger] = beam.beam_quality();
/// assert!((smaller - 1.0).abs() < 1e-9 && (larger - 1.0).abs() < 1e-9);
/// # Ok::<(), tem00_beam::BeamError>(())
/// ```
///
/// # References
///
/// - J. A. Arnaud and H. Kogelnik, "Gaussian light beams with general astigmatism", 1969.
/// - R. Simon, N. Mukunda and E. C. G. Sudarshan, "Partially coherent beams and a generalized
///   ABCD-law", 1988.
/// - ISO 11146-2, 2021.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct GeneralAstigmaticBeam {
    wavelength: f64,
    generator: Generator,
}

impl GeneralAstigmaticBeam {
    /// Creates a beam from its wavelength, in metres, and its second moments at z = 0.
    ///
    /// The moments of a plane far from the waist hold the waist in their last digits only: the M² of
    /// the result is known to about `2e−16 · (w / w₀)²`.
    ///
    /// # Errors
    ///
    /// Returns an error if `wavelength` is not a length from 1e−30 m to 1e30 m; if a moment is not
    /// finite; if the position or slope moments are not symmetric (to 1e−9 of their diagonal) and
    /// positive definite; if the positions are spread less than the mixed and slope moments imply;
    /// if the divergence is above 0.5 rad; if a radius is beyond 1e30 m; or if the M² of a mode is
    /// below 1 by more than 1e−6, which light of this wavelength cannot have.
    ///
    /// # Examples
    ///
    /// ```
    /// use tem00_beam::{BeamError, DMat2, GeneralAstigmaticBeam, SecondMoments};
    ///
    /// let moments = SecondMoments {
    ///     position: DMat2::from_diagonal([1e-8, 4e-8].into()), // radii of 0.2 mm and 0.4 mm
    ///     mixed: DMat2::ZERO,
    ///     slope: DMat2::IDENTITY * 0.36e-6, // half-angles of 1.2 mrad
    /// };
    /// let beam = GeneralAstigmaticBeam::from_moments(650e-9, &moments)?;
    /// assert!((beam.radii_at(0.0)[0] - 0.4e-3).abs() < 1e-15);
    /// let [smaller, larger] = beam.beam_quality(); // π w δ / λ
    /// assert!((smaller - 1.16).abs() < 1e-3 && (larger - 2.32).abs() < 1e-3);
    ///
    /// let infrared = GeneralAstigmaticBeam::from_moments(1064e-9, &moments);
    /// assert!(matches!(infrared, Err(e) if e.parameter() == "m_squared"));
    /// # Ok::<(), BeamError>(())
    /// ```
    pub fn from_moments(wavelength: f64, moments: &SecondMoments) -> Result<Self, BeamError> {
        let SecondMoments {
            position,
            mixed,
            slope,
        } = *moments;
        if !mixed.is_finite() {
            return Err(BeamError::Matrix {
                parameter: "mixed",
                value: mixed,
                allowed: "finite, in m",
            });
        }
        let slope_root = square_root(slope).ok_or(BeamError::Matrix {
            parameter: "slope",
            value: slope,
            allowed: "symmetric and positive definite",
        })?;
        let refused = BeamError::Matrix {
            parameter: "position",
            value: position,
            allowed: "symmetric, positive definite and at least what the mixed and slope moments \
                      imply, in m²",
        };
        square_root(position).ok_or(refused)?;
        let shift = mixed * slope_root.inverse().transpose();
        let symmetric = 0.5 * (position + position.transpose());
        let spread = square_root(symmetric - shift * shift.transpose()).ok_or(refused)?;
        let generator = Generator {
            spread,
            shift,
            slope: slope_root,
        };
        Self::checked(wavelength, generator)
    }

    /// Creates a coherent beam, with an M² of 1 in both modes, from its wavelength, in metres, and the
    /// complex curvature `Q⁻¹` of its field at z = 0, in m⁻¹.
    ///
    /// ```text
    /// field ∝ exp(−i π/λ · xᵀ Q⁻¹ x)     Q⁻¹ = 1/R − i λ/(π w²), as tensors
    /// ```
    ///
    /// The real part is the curvature of the wavefront, positive where the beam diverges; the
    /// imaginary part holds the ellipse of the irradiance. Their axes may differ.
    ///
    /// # Errors
    ///
    /// Returns an error if `wavelength` is not a length from 1e−30 m to 1e30 m; if `curvature` is not
    /// finite, not symmetric (to 1e−9 of its largest entry) or has an imaginary part that is not
    /// negative definite; or if the beam has a radius beyond 1e30 m or a divergence above 0.5 rad.
    ///
    /// # Examples
    ///
    /// A collimated circular beam with a radius of 1 mm, `z_R` = 4.96 m:
    ///
    /// ```
    /// use tem00_beam::{Complex64, GeneralAstigmaticBeam};
    ///
    /// let rayleigh_range = core::f64::consts::PI * 1e-6 / 633e-9;
    /// let (q, zero) = (Complex64::new(0.0, -1.0 / rayleigh_range), Complex64::ZERO);
    /// let beam = GeneralAstigmaticBeam::from_complex_curvature(633e-9, [[q, zero], [zero, q]])?;
    /// assert!((beam.radii_at(rayleigh_range)[0] / 1e-3 - 2_f64.sqrt()).abs() < 1e-12);
    /// # Ok::<(), tem00_beam::BeamError>(())
    /// ```
    pub fn from_complex_curvature(
        wavelength: f64,
        curvature: [[Complex64; 2]; 2],
    ) -> Result<Self, BeamError> {
        check_length("wavelength", wavelength)?;
        let largest = curvature
            .as_flattened()
            .iter()
            .fold(0.0, |max: f64, q| max.max(q.norm()));
        let [[xx, xy], [yx, yy]] = curvature;
        let matrix = |part: fn(Complex64) -> f64| {
            let off = 0.5 * part(xy + yx);
            DMat2::from_cols_array(&[part(xx), off, off, part(yy)])
        };
        let root = square_root(matrix(|q| -q.im))
            .filter(|_| matrix(|q| q.re).is_finite() && (xy - yx).norm() <= 1e-9 * largest)
            .ok_or(BeamError::Matrix {
                parameter: "curvature",
                value: matrix(|q| q.im),
                allowed: "finite and symmetric with a negative definite imaginary part (which is \
                          shown), in m⁻¹",
            })?;
        let unit = (wavelength / (4.0 * PI)).sqrt();
        let (position, spread) = (unit * root.inverse().transpose(), unit * root);
        let slope = matrix(|q| q.re) * position;
        let generator = Generator::from_columns(
            [position.x_axis, position.y_axis, DVec2::ZERO, DVec2::ZERO],
            [slope.x_axis, slope.y_axis, spread.x_axis, spread.y_axis],
        );
        Self::checked(wavelength, generator)
    }

    /// Returns the beam if light of the wavelength can have this phase space.
    fn checked(wavelength: f64, generator: Generator) -> Result<Self, BeamError> {
        check_length("wavelength", wavelength)?;
        let beam = Self {
            wavelength,
            generator,
        };
        let [radius, _] = beam.radii_at(0.0);
        check_length(
            "radius",
            if generator.is_finite() {
                radius
            } else {
                f64::NAN
            },
        )?;
        let [divergence, _] = beam.divergences();
        let paraxial = divergence <= PARAXIAL_LIMIT * (1.0 + 1e-12);
        check(paraxial, "divergence", divergence, "rad", "in (0, 0.5] rad")?;
        let [smaller, _] = beam.beam_quality();
        let possible = smaller >= 1.0 - M_SQUARED_ROUNDING;
        check(possible, "m_squared", smaller, "", "finite and at least 1")?;
        Ok(beam)
    }

    /// Returns the beam seen from a reference plane further along by `distance`, in metres, of
    /// either sign.
    ///
    /// # Errors
    ///
    /// Returns an error if a beam radius there is beyond 1e30 m.
    pub fn propagated(&self, distance: f64) -> Result<Self, BeamError> {
        let Generator { shift, slope, .. } = self.generator;
        let shift = shift + slope * distance;
        let generator = Generator {
            shift,
            ..self.generator
        };
        Self::checked(self.wavelength, generator)
    }

    /// Returns the beam behind `system`, with its reference plane at the exit of the system.
    ///
    /// # Errors
    ///
    /// Returns an error if the beam behind the system has a divergence above 0.5 rad, a radius at
    /// its exit or a wavelength that is not a length from 1e−30 m to 1e30 m; or if entries
    /// of the system of very different magnitude have cost more digits of M² than 1e−6.
    ///
    /// # Examples
    ///
    /// A lens focuses a collimated circular beam of 1 mm to a waist of `λ f / (π w)`:
    ///
    /// ```
    /// use tem00_beam::{AstigmaticBeam, GaussianBeam, GeneralAstigmaticBeam, LocatedBeam};
    /// use tem00_beam::optics::AstigmaticSystem;
    ///
    /// let beam = GaussianBeam::from_waist(633e-9, 1e-3)?;
    /// let beam = AstigmaticBeam::stigmatic(LocatedBeam::new(beam, 0.0)?);
    /// let lens = AstigmaticSystem::thin_lens(0.1)?;
    /// let focused = GeneralAstigmaticBeam::from(beam).through(&lens)?;
    /// assert!((focused.radii_at(0.1)[0] - 20.15e-6).abs() < 0.01e-6);
    /// # Ok::<(), tem00_beam::BeamError>(())
    /// ```
    pub fn through(&self, system: &AstigmaticSystem) -> Result<Self, BeamError> {
        let mut positions = self.generator.position_columns(0.0);
        let mut slopes = self.generator.slope_columns();
        for (position, slope) in positions.iter_mut().zip(&mut slopes) {
            [*position, *slope] = system.transform_ray([*position, *slope]);
        }
        Self::checked(
            self.wavelength * system.index_ratio(),
            Generator::from_columns(positions, slopes),
        )
    }

    /// Returns the wavelength in the medium the beam travels in, in metres.
    pub const fn wavelength(&self) -> f64 {
        self.wavelength
    }

    /// Returns the second moments at the distance `z` from the reference plane.
    pub fn moments_at(&self, z: f64) -> SecondMoments {
        let position = self.generator.position_columns(z);
        let slope = self.generator.slope_columns();
        SecondMoments {
            position: covariance(&position, &position),
            mixed: covariance(&position, &slope),
            slope: covariance(&slope, &slope),
        }
    }

    /// Returns the covariance `W` of the positions of all rays of one slope, in m².
    ///
    /// It is the same at every z. A coherent circular beam has `w₀²/4` on the diagonal.
    pub fn position_spread(&self) -> DMat2 {
        self.generator.spread * self.generator.spread.transpose()
    }

    /// Returns the matrix `K`, in metres, that takes a slope to the mean position of its rays at
    /// z = 0.
    ///
    /// A circular beam has minus the distance to its waist on the diagonal.
    pub fn position_per_slope(&self) -> DMat2 {
        self.generator.shift * self.generator.slope.inverse()
    }

    /// Returns the beam radii along the principal axes of the irradiance, the larger one first, in
    /// metres, at the distance `z` from the reference plane.
    pub fn radii_at(&self, z: f64) -> [f64; 2] {
        self.ellipse_at(z)
            .deviations()
            .map(|deviation| 2.0 * deviation)
    }

    /// Returns the distribution of the irradiance over the plane at the distance `z`, in metres, from
    /// the reference plane, along its principal axes, the larger one first.
    pub fn cross_section_at(&self, z: f64) -> CrossSection {
        CrossSection::of_radii(self.radii_at(z))
    }

    /// Returns the angle from x to the major axis of the irradiance, in radians and in the interval
    /// (−π/2, π/2], at the distance `z` from the reference plane; 0 where the spot is circular.
    ///
    /// The axes of a coherent beam with general astigmatism turn by π in all from z = −∞ to ∞
    /// (Arnaud and Kogelnik 1969); those of a beam with simple astigmatism stand still, but for the
    /// exchange of major and minor.
    pub fn orientation_at(&self, z: f64) -> f64 {
        self.ellipse_at(z).orientation()
    }

    /// Returns the far-field divergence half-angles along the principal axes of the far field, in
    /// radians, the larger one first.
    pub fn divergences(&self) -> [f64; 2] {
        let far_field = Ellipse::new(self.generator.slope_columns());
        far_field.deviations().map(|deviation| 2.0 * deviation)
    }

    /// Returns the tensor `U`, in m⁻¹, that takes a position to the mean slope of the rays there, at
    /// the distance `z` from the reference plane.
    ///
    /// ```text
    /// U = ⟨s xᵀ⟩ ⟨x xᵀ⟩⁻¹
    /// ```
    ///
    /// It is symmetric in a coherent beam, where it is the curvature of the wavefront: `1/R` along
    /// its axes, positive where the beam diverges. An antisymmetric part is the twist of a partially
    /// coherent beam, whose energy flows in a spiral.
    pub fn curvature_tensor_at(&self, z: f64) -> DMat2 {
        let ellipse = self.ellipse_at(z);
        DMat2::from_cols(
            self.mean_slope(&ellipse, DVec2::X),
            self.mean_slope(&ellipse, DVec2::Y),
        )
    }

    /// Returns the complex curvature, in m⁻¹, at the distance `z` from the reference plane.
    ///
    /// ```text
    /// Q⁻¹ = 1/R − i λ/(π w²), as tensors
    /// ```
    ///
    /// For a coherent beam it is all there is to know. A beam with M² above 1 has no field of this
    /// form; the tensor is then that of the coherent beam with the same irradiance and, but for the
    /// twist, the same mean energy flow at this z.
    pub fn complex_curvature_at(&self, z: f64) -> [[Complex64; 2]; 2] {
        let re = self.curvature_tensor_at(z);
        let im = self.ellipse_at(z).inverse() * (-self.wavelength / (4.0 * PI));
        let twist_free = 0.5 * (re.x_axis.y + re.y_axis.x);
        let off = Complex64::new(twist_free, im.x_axis.y);
        [
            [Complex64::new(re.x_axis.x, im.x_axis.x), off],
            [off, Complex64::new(re.y_axis.y, im.y_axis.y)],
        ]
    }

    /// Returns the irradiance on the axis per watt of beam power, in m⁻², at the distance `z` from
    /// the reference plane.
    pub fn peak_irradiance_per_watt(&self, z: f64) -> f64 {
        self.ellipse_at(z).peak()
    }

    /// Returns the irradiance per watt of beam power, in m⁻², at `point` on a plane square to the
    /// axis.
    ///
    /// ```text
    /// E / P = exp(−xᵀ Σ⁻¹ x / 2) / (2π √det Σ)     with Σ = ⟨x xᵀ⟩(z)
    /// ```
    ///
    /// Its integral over any plane of constant z is 1. On a surface of another orientation take
    /// [`flux_per_watt`](Self::flux_per_watt).
    pub fn irradiance_per_watt(&self, point: DVec3) -> f64 {
        irradiance(&self.ellipse_at(point.z), point.truncate())
    }

    /// Returns the energy-flow vector per watt of beam power, in m⁻², at `point`.
    ///
    /// ```text
    /// F / P = E / P · (s̄_x, s̄_y, 1)     with the mean slope s̄ = U(z) x
    /// ```
    ///
    /// The bracket is *not* normalised: its z-component is 1, so that F has no divergence and its
    /// integral over any surface that cuts the whole beam is 1. A surface whose normal `n` lies on
    /// the lit side receives the irradiance `max(0, −F·n)`.
    pub fn flux_per_watt(&self, point: DVec3) -> DVec3 {
        let (ellipse, position) = (self.ellipse_at(point.z), point.truncate());
        let irradiance = irradiance(&ellipse, position);
        if irradiance > 0.0 {
            irradiance * self.mean_slope(&ellipse, position).extend(1.0)
        } else {
            DVec3::ZERO
        }
    }

    /// Returns the M² of the two modes of the beam, the smaller one first.
    ///
    /// They are `4π/λ` times the symplectic eigenvalues of the second moments. No lens, mirror or
    /// distance changes them: of a beam with simple astigmatism they are the M² of its axes, however
    /// it was turned or sheared since.
    pub fn beam_quality(&self) -> [f64; 2] {
        let quantum = self.wavelength / (4.0 * PI);
        self.generator
            .symplectic_eigenvalues()
            .map(|eigenvalue| eigenvalue / quantum)
    }

    /// Returns the twist `⟨x s_y⟩ − ⟨y s_x⟩` of the beam, in metres.
    ///
    /// It is the orbital angular momentum of the beam: `2π/λ` times the twist is its mean per photon
    /// in units of ħ. Travel through free space, a circular lens and a rotation keep it; a cylinder
    /// lens may change it.
    pub fn twist(&self) -> f64 {
        self.generator.twist()
    }

    fn ellipse_at(&self, z: f64) -> Ellipse {
        Ellipse::new(self.generator.position_columns(z))
    }

    fn mean_slope(&self, ellipse: &Ellipse, position: DVec2) -> DVec2 {
        combine(
            &self.generator.slope_columns(),
            ellipse.coordinates(position),
        )
    }
}

impl From<AstigmaticBeam> for GeneralAstigmaticBeam {
    fn from(beam: AstigmaticBeam) -> Self {
        let axes = DMat2::from_angle(beam.rotation());
        let scaled = |factors: [f64; 2]| axes * DMat2::from_diagonal(factors.into());
        let half = |value: f64| 0.5 * value;
        let [x, y] = beam.axes();
        let slopes = [x, y].map(|axis| half(axis.beam().divergence()));
        let generator = Generator {
            spread: scaled([x, y].map(|axis| half(axis.beam().waist_radius()))),
            shift: scaled([
                -x.waist_distance() * slopes[0],
                -y.waist_distance() * slopes[1],
            ]),
            slope: scaled(slopes),
        };
        Self {
            wavelength: beam.wavelength(),
            generator,
        }
    }
}

/// Returns the normal density of `ellipse` at `position`.
fn irradiance(ellipse: &Ellipse, position: DVec2) -> f64 {
    let exponent = 0.5 * ellipse.squared_distance(position);
    // exp is 0 beyond. The comparison also refuses the distance of a point where it overflows.
    if exponent < 750.0 {
        ellipse.peak() * (-exponent).exp()
    } else {
        0.0
    }
}

/// Returns the lower triangular `L` with `L Lᵀ = matrix`, if that is symmetric and positive definite.
fn square_root(matrix: DMat2) -> Option<DMat2> {
    let (xx, yy) = (matrix.x_axis.x, matrix.y_axis.y);
    let asymmetry = (matrix.x_axis.y - matrix.y_axis.x).abs();
    let xy = 0.5 * (matrix.x_axis.y + matrix.y_axis.x);
    let first = xx.sqrt();
    let off = xy / first;
    // Not a number where the first entry is negative or the first row is 0.
    let rest = yy - off * off;
    let valid = rest > 0.0 && matrix.is_finite() && asymmetry <= 1e-9 * first * yy.sqrt();
    valid.then(|| DMat2::from_cols(DVec2::new(first, off), DVec2::new(0.0, rest.sqrt())))
}

#[cfg(test)]
mod tests;
