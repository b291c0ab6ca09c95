use core::{error, fmt};

use glam::{DMat3, DVec2, DVec3};
use num_complex::Complex;

/// Why a description of surface, light or camera was rejected.
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub enum WaveError {
    /// The wavelength, in metres, is not between 0.1 nm and 1 m.
    Wavelength(f64),
    /// A component of a position, in metres, is not finite or above 10 km.
    Position(DVec3),
    /// A component of a centre, in metres, is not finite or above 10 km.
    Centre(DVec3),
    /// A component of a translation, in metres, is not finite or above 10 km.
    Translation(DVec3),
    /// The axis of a rotation is zero or not finite.
    RotationAxis(DVec3),
    /// The angle of a rotation, in radians, is not finite.
    Angle(f64),
    /// The direction of travel of the light is zero or not finite.
    Direction(DVec3),
    /// The waist radius, in metres, is not between 1 pm and 10 km.
    WaistRadius(f64),
    /// The waist is tighter than the paraxial model allows. Often the two arguments were swapped.
    NotParaxial {
        /// The rejected waist radius, in metres.
        waist_radius: f64,
        /// The smallest waist radius the model accepts at this wavelength, in metres.
        minimum: f64,
    },
    /// The direction in which a fan opens is zero, not finite, or parallel to its direction of
    /// travel.
    Opening(DVec3),
    /// The half-angle of a fan, in radians, is not between 0 and π/2.
    HalfAngle(f64),
    /// The distance from the apex to the waist, in metres, is not finite or above 10 km in magnitude.
    WaistDistance(f64),
    /// The normal of the patch is zero or not finite.
    Normal(DVec3),
    /// The direction of the patch's first side is zero, not finite, or parallel to its normal.
    Along(DVec3),
    /// A side of the patch, in metres, is not between 1 pm and 10 km.
    Size([f64; 2]),
    /// There are no scatterers, or more than 2²⁸.
    Scatterers([usize; 2]),
    /// A part of a scatterer's amplitude, in metres, is not finite or above 10⁴.
    Amplitude(Complex<f64>),
    /// The rms height, in metres, is neither zero nor between 1 pm and 10 km.
    Rms(f64),
    /// The correlation length of the heights, in metres, is neither zero nor between 1 pm and 10 km.
    CorrelationLength(f64),
    /// A step between samples, in metres, is not between 1 pm and 10 km long.
    Steps([DVec3; 2]),
    /// There are no samples, or more than 2²⁸.
    Samples([usize; 2]),
    /// The radius of a stop, in metres, is not between 1 pm and 10 km.
    Radius(f64),
    /// The columns of the matrix are not right-handed orthonormal axes within 10⁻⁶.
    Axes(DMat3),
    /// The vector from the target to the camera, in metres, is zero or not finite.
    ViewDirection(DVec3),
    /// The upward direction is zero, not finite, or parallel to the direction of view.
    Up(DVec3),
    /// The pupil diameter, in metres, is not between 1 pm and 10 km.
    PupilDiameter(f64),
    /// The distance of focus, in metres, is not between 1 pm and 10 km.
    FocusDistance(f64),
    /// The distance from pupil to image, in metres, is not between 1 pm and 10 km.
    PupilToImage(f64),
    /// The centre of the window, in metres, is not finite or too far off the axis.
    ImageCentre(DVec2),
    /// The step between samples of the image is not between 1 pm and the speckle size.
    ImageStep {
        /// The rejected step, in metres.
        step: f64,
        /// The speckle size λ · `pupil_to_image` / D, in metres.
        speckle_size: f64,
    },
    /// The number of samples along the side of an image is not between 2 and 2¹³.
    ImageSamples(usize),
}

impl fmt::Display for WaveError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        const LENGTH: &str = "must be between 1e-12 m and 1e4 m, got";
        const NEAR: &str = "must be finite and at most 1e4 m in each component, got";
        const DIRECTION: &str = "must be finite and not zero, got";
        match self {
            Self::Wavelength(got) => {
                write!(
                    f,
                    "wavelength must be between 1e-10 m and 1 m, got {got:e} m"
                )
            }
            Self::Position(got) => write!(f, "position {NEAR} {got} m"),
            Self::Centre(got) => write!(f, "centre {NEAR} {got} m"),
            Self::Translation(got) => write!(f, "translation {NEAR} {got} m"),
            Self::RotationAxis(got) => write!(f, "axis of rotation {DIRECTION} {got}"),
            Self::Angle(got) => write!(f, "angle of rotation must be finite, got {got} rad"),
            Self::Direction(got) => write!(f, "direction of travel {DIRECTION} {got}"),
            Self::WaistRadius(got) => write!(f, "waist radius {LENGTH} {got:e} m"),
            Self::NotParaxial {
                waist_radius,
                minimum,
            } => write!(
                f,
                "waist radius must be at least the paraxial limit of {minimum:e} m, got \
                 {waist_radius:e} m"
            ),
            Self::Opening(got) => write!(
                f,
                "opening of the fan must be finite, not zero and not along its direction, got {got}"
            ),
            Self::HalfAngle(got) => {
                write!(f, "half-angle must be between 0 and π/2, got {got} rad")
            }
            Self::WaistDistance(got) => write!(
                f,
                "waist distance must be finite and at most 1e4 m, got {got:e} m"
            ),
            Self::Normal(got) => write!(f, "surface normal {DIRECTION} {got}"),
            Self::Along(got) => write!(
                f,
                "direction along the patch must be finite, not zero and not along its normal, got \
                 {got}"
            ),
            Self::Size([a, b]) => write!(f, "sides of the patch {LENGTH} {a:e} m × {b:e} m"),
            Self::Scatterers([a, b]) => {
                write!(
                    f,
                    "number of scatterers must be from 1 to 2²⁸, got {a} × {b}"
                )
            }
            Self::Amplitude(got) => write!(
                f,
                "amplitude of a scatterer must be finite and at most 1e4 m in each part, got {got} m"
            ),
            Self::Rms(got) => write!(f, "rms height must be 0 or a length; it {LENGTH} {got:e} m"),
            Self::CorrelationLength(got) => write!(
                f,
                "correlation length must be 0 or a length; it {LENGTH} {got:e} m"
            ),
            Self::Steps([a, b]) => write!(f, "steps between samples {LENGTH} {a} m and {b} m"),
            Self::Samples([a, b]) => {
                write!(f, "number of samples must be from 1 to 2²⁸, got {a} × {b}")
            }
            Self::Radius(got) => write!(f, "radius of the stop {LENGTH} {got:e} m"),
            Self::Axes(got) => write!(
                f,
                "camera axes must be right-handed and orthonormal within 1e-6, got columns {got}"
            ),
            Self::ViewDirection(got) => write!(
                f,
                "vector from the target to the camera {DIRECTION} {got} m"
            ),
            Self::Up(got) => write!(
                f,
                "upward direction must be finite, not zero and not along the view, got {got}"
            ),
            Self::PupilDiameter(got) => write!(f, "pupil diameter {LENGTH} {got:e} m"),
            Self::FocusDistance(got) => write!(f, "focus distance {LENGTH} {got:e} m"),
            Self::PupilToImage(got) => write!(f, "pupil-to-image distance {LENGTH} {got:e} m"),
            Self::ImageCentre(got) => write!(
                f,
                "centre of the window must be finite and within 10 pupil-to-image distances of the \
                 axis, got {got} m"
            ),
            Self::ImageStep { step, speckle_size } => write!(
                f,
                "image step must be at least 1e-12 m and below the speckle size of \
                 {speckle_size:e} m, got {step:e} m"
            ),
            Self::ImageSamples(got) => {
                write!(
                    f,
                    "samples along the image must be from 2 to 8192, got {got}"
                )
            }
        }
    }
}

impl error::Error for WaveError {}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_message_names_the_parameter_and_its_value() {
        use WaveError as E;
        let vector = DVec3::new(1.25, 2.5, -3.75);
        let cases = [
            (E::Wavelength(-1.25), "wavelength", "-1.25e0 m"),
            (E::Position(vector), "position", "-3.75"),
            (E::Centre(vector), "centre", "-3.75"),
            (E::Translation(vector), "translation", "-3.75"),
            (E::RotationAxis(vector), "axis of rotation", "-3.75"),
            (E::Angle(f64::INFINITY), "angle", "inf rad"),
            (E::Direction(vector), "direction of travel", "-3.75"),
            (E::WaistRadius(-1.25), "waist radius", "-1.25e0 m"),
            (
                E::NotParaxial {
                    waist_radius: 1e-9,
                    minimum: 4e-7,
                },
                "4e-7",
                "1e-9 m",
            ),
            (E::Opening(vector), "opening", "-3.75"),
            (E::HalfAngle(1.75), "half-angle", "1.75 rad"),
            (E::WaistDistance(1e30), "waist distance", "1e30 m"),
            (E::Normal(vector), "normal", "-3.75"),
            (E::Along(vector), "along the patch", "-3.75"),
            (E::Size([1.0, -1.25]), "sides", "-1.25e0 m"),
            (E::Scatterers([0, 7]), "scatterers", "0 × 7"),
            (E::Amplitude(Complex::new(0.5, 1e30)), "amplitude", "0.5"),
            (E::Rms(-1.25), "rms height", "-1.25e0 m"),
            (
                E::CorrelationLength(-1.25),
                "correlation length",
                "-1.25e0 m",
            ),
            (E::Steps([vector; 2]), "steps", "-3.75"),
            (E::Samples([0, 7]), "samples", "0 × 7"),
            (E::Radius(-1.25), "radius", "-1.25e0 m"),
            (E::Axes(DMat3::IDENTITY * 2.5), "camera axes", "2.5"),
            (E::ViewDirection(vector), "target to the camera", "-3.75"),
            (E::Up(vector), "upward direction", "-3.75"),
            (E::PupilDiameter(-1.25), "pupil diameter", "-1.25e0 m"),
            (E::FocusDistance(-1.25), "focus distance", "-1.25e0 m"),
            (E::PupilToImage(-1.25), "pupil-to-image", "-1.25e0 m"),
            (E::ImageCentre(DVec2::splat(-1.25)), "centre", "-1.25"),
            (
                E::ImageStep {
                    step: 1e-3,
                    speckle_size: 4e-6,
                },
                "4e-6 m",
                "1e-3 m",
            ),
            (E::ImageSamples(1), "samples", "got 1"),
        ];
        for (error, name, value) in cases {
            let message = error.to_string();
            assert!(message.contains(name), "no {name} in: {message}");
            assert!(message.contains(value), "no {value} in: {message}");
            assert!(message.contains("must "), "nothing allowed in: {message}");
        }
    }
}
