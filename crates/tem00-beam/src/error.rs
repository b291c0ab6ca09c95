use core::{error, fmt};

use glam::DVec3;

/// Why a beam, a laser line or a placed light could not be constructed.
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub enum BeamError {
    /// The wavelength, in metres, is not a length from 1e−30 m to 1e30 m.
    Wavelength(f64),
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
    /// A radius of a cross-section, in metres, is not a length from 1e−30 m to 1e30 m.
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
    /// The distance from the aperture to the waist, in metres, is not finite or beyond 1e30 m.
    WaistDistance(f64),
    /// The power, in watts, is negative or not finite.
    Power(f64),
    /// The origin of a placement has a coordinate, in metres, that is not finite.
    Origin(DVec3),
    /// The direction of a placement has no length, or is not finite.
    Direction(DVec3),
    /// The fan axis of a placement has no length, is not finite, or is parallel to the direction.
    FanAxis(DVec3),
    /// The fraction of the peak at which a cone is cut off is not in the open interval (0, 1).
    CutoffFraction(f64),
    /// A field of a placed light is outside the range that single precision can carry.
    SinglePrecision(f64),
}

impl fmt::Display for BeamError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        const LENGTH: &str = "must lie between 1e-30 m and 1e30 m";
        const POSITION: &str = "must be finite and within ±1e30 m";
        match self {
            Self::Wavelength(got) => write!(f, "wavelength {LENGTH}, got {got:e} m"),
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
                "waist radius {waist_radius:e} m is below the paraxial limit of {minimum:e} m"
            ),
            Self::Radius(got) => write!(f, "radius {LENGTH}, got {got:e} m"),
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
            Self::WaistDistance(got) => write!(f, "waist distance {POSITION}, got {got:e} m"),
            Self::Power(got) => {
                write!(f, "power must be finite and not negative, got {got:e} W")
            }
            Self::Origin(got) => write!(f, "origin must be finite, got {got} m"),
            Self::Direction(got) => {
                write!(f, "direction must be finite and have a length, got {got}")
            }
            Self::FanAxis(got) => write!(
                f,
                "fan axis must be finite, have a length and not be parallel to the direction, \
                 got {got}"
            ),
            Self::CutoffFraction(got) => {
                write!(f, "cut-off fraction must lie in (0, 1), got {got:e}")
            }
            Self::SinglePrecision(got) => write!(
                f,
                "a field of the light is outside the range of f32, got {got:e}"
            ),
        }
    }
}

impl error::Error for BeamError {}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn messages_name_the_parameter_and_its_value() {
        let cases = [
            (BeamError::Wavelength(-1.5), "wavelength", "-1.5e0"),
            (BeamError::WaistRadius(-1.5), "waist radius", "-1.5e0"),
            (BeamError::Divergence(2.5), "divergence", "2.5e0"),
            (BeamError::MSquared(0.5), "M²", "5e-1"),
            (BeamError::Radius(-1.5), "radius", "-1.5e0"),
            (BeamError::Growth(0.5), "growth", "5e-1"),
            (BeamError::PowerFraction(1.5), "power fraction", "1.5e0"),
            (BeamError::FanAngle(4.0), "fan angle", "4e0"),
            (BeamError::FocusDistance(1e31), "focus distance", "1e31"),
            (BeamError::Edge(3.0), "edge", "3e0"),
            (BeamError::WaistDistance(1e31), "waist distance", "1e31"),
            (BeamError::Power(-2.0), "power", "-2e0"),
            (BeamError::Origin(DVec3::X * 7.0), "origin", "[7, 0, 0]"),
            (BeamError::Direction(DVec3::ZERO), "direction", "[0, 0, 0]"),
            (BeamError::FanAxis(DVec3::Z), "fan axis", "[0, 0, 1]"),
            (BeamError::CutoffFraction(2.0), "fraction", "2e0"),
            (BeamError::SinglePrecision(1e60), "f32", "1e60"),
            (
                BeamError::NotParaxial {
                    waist_radius: 1e-9,
                    minimum: 1e-7,
                },
                "waist radius",
                "1e-9",
            ),
            (
                BeamError::ApexOffset {
                    apex_offset: 1e-8,
                    minimum: 1e-6,
                },
                "apex offset",
                "1e-8",
            ),
        ];
        for (error, name, value) in cases {
            let text = error.to_string();
            assert!(text.contains(name), "{text:?} does not name {name:?}");
            assert!(text.contains(value), "{text:?} does not show {value:?}");
        }
    }
}
