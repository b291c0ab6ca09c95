use core::{error, fmt};

use glam::{DMat2, DVec3};
use num_complex::Complex64;

/// Why a beam, a laser line or a placed light could not be constructed.
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub enum BeamError {
    /// The wavelength, in metres, is not a length from 1e−30 m to 1e30 m.
    Wavelength(f64),
    /// The two axes of an astigmatic beam, whose light is one, have different wavelengths.
    Wavelengths {
        /// The wavelength of the first axis, in metres.
        x: f64,
        /// The wavelength of the second axis, in metres.
        y: f64,
    },
    /// The waist radius, in metres, is not a length from 1e−30 m to 1e30 m.
    WaistRadius(f64),
    /// The divergence, in radians, is not in the interval (0, 0.5].
    Divergence(f64),
    /// The beam quality factor M² is not a finite number of at least 1.
    MSquared(f64),
    /// The waist is tighter than the paraxial model allows. Often the two arguments were swapped.
    NotParaxial {
        /// The rejected waist radius, in metres.
        waist_radius: f64,
        /// The smallest waist radius the model accepts at this wavelength and M², in metres.
        minimum: f64,
    },
    /// The beam radius, in metres, is not a length from 1e−30 m to 1e30 m.
    Radius(f64),
    /// The factor by which the beam radius may grow is not a finite number greater than 1.
    Growth(f64),
    /// The fraction of the power that a circle is to hold is not in the interval [0, 1).
    PowerFraction(f64),
    /// The full fan angle, in radians, is not in the open interval (0, π).
    FanAngle(f64),
    /// The distance of the virtual apex behind the lens is too short for the beam it belongs to.
    ApexOffset {
        /// The rejected distance, in metres.
        apex_offset: f64,
        /// The smallest accepted distance, in metres.
        minimum: f64,
    },
    /// The distance from the lens to the waist, in metres, is not finite or beyond 1e30 m.
    FocusDistance(f64),
    /// The relative edge width of a Powell profile is not in the interval [1e−6, 1].
    Edge(f64),
    /// A table of angles and powers differs in length, or has fewer than two entries.
    ProfileLength {
        /// The number of angles.
        angles: usize,
        /// The number of powers.
        powers: usize,
    },
    /// An angle of a table, in radians, is not in (−π/2, π/2), or not at least 1e−12 above the
    /// one before it.
    ProfileAngle {
        /// The place in the table, from 0.
        index: usize,
        /// The rejected angle, in radians.
        angle: f64,
    },
    /// A power of a table is negative or not finite.
    ProfilePower {
        /// The place in the table, from 0.
        index: usize,
        /// The rejected power.
        power: f64,
    },
    /// A table has no power at any angle; its total.
    ProfileTotal(f64),
    /// A `LineLight` cannot hold a table; a `TabulatedLineLight` can.
    TabulatedProfile,
    /// A `TabulatedLineLight` needs a table; a `LineLight` holds the other profiles.
    NotTabulated,
    /// The distance from the aperture to the waist, in metres, is not finite or beyond 1e30 m.
    WaistDistance(f64),
    /// The rotation of the principal axes, in radians, is not finite.
    Rotation(f64),
    /// The Rayleigh range, in metres, does not lie between 1e−100 m and 1e100 m.
    RayleighRange(f64),
    /// The curvature, in m⁻¹, of a wavefront or a surface is not finite or beyond 1e30 m⁻¹.
    Curvature(f64),
    /// An entry of a ray matrix is not finite.
    MatrixEntry(f64),
    /// The determinant of a ray matrix is not a positive finite number.
    Determinant(f64),
    /// The ray matrix of four dimensions is not symplectic, as that of an optical system is; the
    /// number is its relative deviation.
    NotSymplectic(f64),
    /// The ray matrices of the two axes of a system differ in determinant, the ratio of the indices.
    Determinants {
        /// The determinant of the first axis.
        x: f64,
        /// The determinant of the second axis.
        y: f64,
    },
    /// Half the trace of a round trip is not in the open interval (−1, 1): no beam reproduces
    /// itself.
    HalfTrace(f64),
    /// The length of a path, in metres, is not finite or beyond 1e30 m.
    Length(f64),
    /// The focal length, in metres, has no magnitude from 1e−30 m to 1e30 m.
    FocalLength(f64),
    /// The thickness of a lens, in metres, does not lie between 0 and 1e30 m.
    Thickness(f64),
    /// The refractive index does not lie between 0.001 and 1000.
    Index(f64),
    /// The angle of incidence, in radians, is not in the open interval (−π/2, π/2).
    AngleOfIncidence(f64),
    /// The gradient of a graded-index medium, in m⁻¹, does not lie between 0 and 1e30 m⁻¹.
    Gradient(f64),
    /// The position moments, in m², are not symmetric and positive definite, or spread less than the
    /// mixed and slope moments imply.
    PositionMoments(DMat2),
    /// The mixed moments, in metres, are not finite.
    MixedMoments(DMat2),
    /// The slope moments are not symmetric and positive definite.
    SlopeMoments(DMat2),
    /// The complex curvature, in m⁻¹, is not finite, not symmetric or has an imaginary part that is
    /// not negative definite.
    ComplexCurvature([[Complex64; 2]; 2]),
    /// The power does not lie between 0 and 1e100 W.
    Power(f64),
    /// The origin of a placement has a coordinate, in metres, that is not finite or beyond 1e30 m.
    Origin(DVec3),
    /// The direction of a placement has no length, or is not finite.
    Direction(DVec3),
    /// The fan axis of a placement has no length, is not finite, or is parallel to the direction.
    FanAxis(DVec3),
    /// A field of a placed light is outside the range that single precision can carry.
    SinglePrecision(f64),
}

impl BeamError {
    /// Returns the name of the argument or field that was refused, as its caller wrote it.
    ///
    /// Where the refused quantity follows from several arguments, it is the name of that quantity,
    /// as `determinant`.
    ///
    /// # Examples
    ///
    /// ```
    /// use tem00_beam::GaussianBeam;
    ///
    /// let error = GaussianBeam::from_waist(100e-6, 650e-9).unwrap_err();
    /// assert_eq!(error.parameter(), "waist_radius");
    /// ```
    pub const fn parameter(&self) -> &'static str {
        match self {
            Self::Wavelength(..) | Self::Wavelengths { .. } => "wavelength",
            Self::WaistRadius(..) | Self::NotParaxial { .. } => "waist_radius",
            Self::Divergence(..) => "divergence",
            Self::MSquared(..) => "m_squared",
            Self::Radius(..) => "radius",
            Self::Growth(..) => "growth",
            Self::PowerFraction(..) => "fraction",
            Self::FanAngle(..) => "fan_angle",
            Self::ApexOffset { .. } => "apex_offset",
            Self::FocusDistance(..) => "focus_distance",
            Self::Edge(..) => "edge",
            Self::ProfileAngle { .. } => "angles",
            Self::ProfileLength { .. } | Self::ProfilePower { .. } | Self::ProfileTotal(..) => {
                "powers"
            }
            Self::TabulatedProfile | Self::NotTabulated => "line",
            Self::WaistDistance(..) => "waist_distance",
            Self::Rotation(..) => "rotation",
            Self::RayleighRange(..) => "rayleigh_range",
            Self::Curvature(..) | Self::ComplexCurvature(..) => "curvature",
            Self::MatrixEntry(..) | Self::NotSymplectic(..) => "matrix",
            Self::Determinant(..) => "determinant",
            Self::Determinants { .. } => "axes",
            Self::HalfTrace(..) => "half_trace",
            Self::Length(..) => "length",
            Self::FocalLength(..) => "focal_length",
            Self::Thickness(..) => "thickness",
            Self::Index(..) => "index",
            Self::AngleOfIncidence(..) => "angle_of_incidence",
            Self::Gradient(..) => "gradient",
            Self::PositionMoments(..) => "position",
            Self::MixedMoments(..) => "mixed",
            Self::SlopeMoments(..) => "slope",
            Self::Power(..) => "power",
            Self::Origin(..) => "origin",
            Self::Direction(..) => "direction",
            Self::FanAxis(..) => "fan_axis",
            Self::SinglePrecision(..) => "single_precision",
        }
    }
}

impl fmt::Display for BeamError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        const LENGTH: &str = "must lie between 1e-30 m and 1e30 m";
        const POSITION: &str = "must be finite and within ±1e30 m";
        match self {
            Self::Wavelength(got) => write!(f, "wavelength {LENGTH}, got {got:e} m"),
            Self::Wavelengths { x, y } => write!(
                f,
                "wavelengths of the two axes must be equal, got {x:e} m and {y:e} m"
            ),
            Self::WaistRadius(got) => write!(f, "waist radius {LENGTH}, got {got:e} m"),
            Self::Divergence(got) => {
                write!(f, "divergence must lie in (0, 0.5] rad, got {got:e} rad")
            }
            Self::MSquared(got) => {
                write!(f, "M² must be finite and at least 1, got {got:e}")
            }
            Self::NotParaxial {
                waist_radius,
                minimum,
            } => write!(
                f,
                "waist radius must be at least 2 M² λ / π = {minimum:e} m to be paraxial, \
                 got {waist_radius:e} m"
            ),
            Self::Growth(got) => {
                write!(f, "growth must be finite and greater than 1, got {got:e}")
            }
            Self::PowerFraction(got) => {
                write!(f, "power fraction must lie in [0, 1), got {got:e}")
            }
            Self::FanAngle(got) => {
                write!(f, "full fan angle must lie in (0, π) rad, got {got:e} rad")
            }
            Self::ApexOffset {
                apex_offset,
                minimum,
            } => write!(
                f,
                "apex offset must be at least {minimum:e} m and at most 1e30 m, \
                 got {apex_offset:e} m"
            ),
            Self::FocusDistance(got) => write!(f, "focus distance {POSITION}, got {got:e} m"),
            Self::Edge(got) => {
                write!(
                    f,
                    "edge of the Powell profile must lie in [1e-6, 1], got {got:e}"
                )
            }
            Self::ProfileLength { angles, powers } => write!(
                f,
                "profile must have as many powers as angles, and at least 2, \
                 got {angles} angles and {powers} powers"
            ),
            Self::ProfileAngle { index, angle } => write!(
                f,
                "angles of the profile must ascend within (-π/2, π/2) rad, \
                 got {angle:e} rad at index {index}"
            ),
            Self::ProfilePower { index, power } => write!(
                f,
                "powers of the profile must be finite and not negative, \
                 got {power:e} at index {index}"
            ),
            Self::ProfileTotal(got) => {
                write!(
                    f,
                    "profile must have power at some angle, got {got:e} in all"
                )
            }
            Self::TabulatedProfile => write!(
                f,
                "a tabulated profile must be placed as a TabulatedLineLight, got a LineLight"
            ),
            Self::NotTabulated => write!(
                f,
                "a profile that is not tabulated must be placed as a LineLight, \
                 got a TabulatedLineLight"
            ),
            Self::WaistDistance(got) => write!(f, "waist distance {POSITION}, got {got:e} m"),
            Self::Rotation(got) => write!(f, "rotation must be finite, got {got:e} rad"),
            Self::RayleighRange(got) => write!(
                f,
                "Rayleigh range must lie between 1e-100 m and 1e100 m, got {got:e} m"
            ),
            Self::Radius(got) => write!(f, "beam radius {LENGTH}, got {got:e} m"),
            Self::Curvature(got) => write!(
                f,
                "curvature must be finite and within ±1e30 m⁻¹, got {got:e} m⁻¹"
            ),
            Self::MatrixEntry(got) => {
                write!(f, "entries of a ray matrix must be finite, got {got:e}")
            }
            Self::Determinant(got) => write!(
                f,
                "determinant of a ray matrix must be positive and finite, got {got:e}"
            ),
            Self::NotSymplectic(got) => write!(
                f,
                "ray matrix must be symplectic up to the ratio of the refractive indices, \
                 got a relative deviation of {got:e}"
            ),
            Self::Determinants { x, y } => write!(
                f,
                "determinants of the two axes must be equal, got {x:e} and {y:e}"
            ),
            Self::HalfTrace(got) => write!(
                f,
                "half the trace of a round trip must lie in (-1, 1), got {got:e}"
            ),
            Self::Length(got) => write!(f, "length {POSITION}, got {got:e} m"),
            Self::FocalLength(got) => {
                write!(f, "magnitude of the focal length {LENGTH}, got {got:e} m")
            }
            Self::Thickness(got) => {
                write!(
                    f,
                    "thickness must lie between 0 m and 1e30 m, got {got:e} m"
                )
            }
            Self::Index(got) => {
                write!(f, "refractive index must lie in [0.001, 1000], got {got:e}")
            }
            Self::AngleOfIncidence(got) => write!(
                f,
                "angle of incidence must lie in (-π/2, π/2) rad, got {got:e} rad"
            ),
            Self::Gradient(got) => write!(
                f,
                "gradient must lie between 0 m⁻¹ and 1e30 m⁻¹, got {got:e} m⁻¹"
            ),
            Self::PositionMoments(got) => write!(
                f,
                "position moments must be symmetric, positive definite and at least what the mixed \
                 and slope moments imply, got {got} m²"
            ),
            Self::MixedMoments(got) => {
                write!(f, "mixed moments must be finite, got {got} m")
            }
            Self::SlopeMoments(got) => write!(
                f,
                "slope moments must be symmetric and positive definite, got {got}"
            ),
            Self::ComplexCurvature([[xx, xy], [yx, yy]]) => write!(
                f,
                "complex curvature must be finite and symmetric with a negative definite imaginary \
                 part, got [[{xx}, {xy}], [{yx}, {yy}]] m⁻¹"
            ),
            Self::Power(got) => {
                write!(f, "power must lie between 0 and 1e100 W, got {got:e} W")
            }
            Self::Origin(got) => {
                write!(f, "origin must be finite and within ±1e30 m, got {got} m")
            }
            Self::Direction(got) => {
                write!(f, "direction must be finite and have a length, got {got}")
            }
            Self::FanAxis(got) => write!(
                f,
                "fan axis must be finite, have a length and not be parallel to the direction, \
                 got {got}"
            ),
            Self::SinglePrecision(got) => write!(
                f,
                "a field of the light is outside the range of f32, got {got:e}"
            ),
        }
    }
}

impl error::Error for BeamError {}

#[cfg(test)]
mod tests;
