use core::{error, fmt};

use glam::{DMat3, DVec3};

/// Why a description of camera, light or surface was rejected.
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub enum DecorrelationError {
    /// The wavelength, in metres, is not a positive finite number.
    Wavelength(f64),
    /// The focal length, in metres, is not a positive finite number.
    FocalLength(f64),
    /// The f-number is not a finite number of at least 0.5, the limit of any lens in air.
    FNumber(f64),
    /// The pixel pitch, in metres, is not a positive finite number.
    PixelPitch(f64),
    /// The distance from surface to pupil is not finite, or so short that no real image forms.
    SurfaceToPupil {
        /// The rejected distance, in metres.
        surface_to_pupil: f64,
        /// The distance it must exceed, in metres: the focal length over the pupil magnification.
        minimum: f64,
    },
    /// The distance from the surface to the front principal plane is not a finite number above the
    /// focal length, so that no real image forms.
    SurfaceToPrincipalPlane {
        /// The rejected distance, in metres.
        surface_to_principal_plane: f64,
        /// The focal length it must exceed, in metres.
        focal_length: f64,
    },
    /// The distance from pupil to sensor, in metres, is not a positive finite number.
    PupilToImage(f64),
    /// The magnification is not a positive finite number, or the distances that follow from it are
    /// not.
    Magnification(f64),
    /// The pupil magnification is not a positive finite number.
    PupilMagnification(f64),
    /// The pupil, given or as it follows from focal length and f-number, is not finite or not larger
    /// than the wavelength.
    PupilDiameter {
        /// The pupil diameter, in metres.
        pupil_diameter: f64,
        /// The wavelength, in metres.
        wavelength: f64,
    },
    /// The pupil is wider than twice its distance to the surface or, in units of the entrance pupil,
    /// to the sensor, which would be a numerical aperture above one.
    PupilTooWide {
        /// The diameter of the entrance pupil, in metres.
        pupil_diameter: f64,
        /// The shorter of both distances, in metres.
        distance: f64,
    },
    /// The columns of the matrix are not right-handed orthonormal axes within 10⁻⁶.
    Axes(DMat3),
    /// The vector from the target to the camera, in metres, is zero or not finite.
    ViewDirection(DVec3),
    /// The upward direction is zero, not finite, or parallel to the direction of view.
    Up(DVec3),
    /// The vector from the surface point to the pupil, in metres, is zero or not finite, or the
    /// point does not lie in front of the camera.
    ToPupil(DVec3),
    /// The direction to the light source is zero or not finite.
    DirectionToSource(DVec3),
    /// The curvature of the wavefront, in 1/m, is not finite.
    Curvature(f64),
    /// The curvature tensor of the wavefront, in 1/m, is not finite or not symmetric.
    CurvatureTensor(DMat3),
    /// The principal axis of the wavefront is zero, not finite, or parallel to the direction to the
    /// source.
    PrincipalAxis(DVec3),
    /// The position of the light source or of its wavefront, in metres, is not finite.
    LightPosition(DVec3),
    /// The surface point, in metres, lies in a focus or at the light source, where light has no
    /// direction.
    LitPoint(DVec3),
    /// The surface normal is zero or not finite.
    Normal(DVec3),
    /// The columns of the rotation matrix are not right-handed orthonormal axes within 10⁻⁶.
    Rotation(DMat3),
    /// The axis of a rotation is zero or not finite.
    RotationAxis(DVec3),
    /// The angle of a rotation, in radians, is not finite.
    RotationAngle(f64),
    /// The pivot of a rotation, in metres, is not finite.
    Pivot(DVec3),
    /// The translation, in metres, is not finite.
    Translation(DVec3),
    /// The centre of the pupil, in metres, is not finite.
    PupilCentre(DVec3),
    /// The speckle size of the pattern, in samples, is not a positive finite number.
    PatternSpeckleSize(f64),
    /// A ratio of lengths of the camera and the pattern, in samples per pixel or per metre, or 1/m, is
    /// so large that products with coordinates overflow.
    Scale(f64),
}

impl DecorrelationError {
    /// Returns the name of the argument that was refused, as constructors and functions call it.
    ///
    /// A pupil that follows from other arguments is `pupil_diameter` all the same, and a line of sight
    /// from two points `to_pupil`.
    ///
    /// # Examples
    ///
    /// ```
    /// use tem00_decorrelation::{DVec3, DecorrelationError, RigidMotion};
    ///
    /// let name = |error: DecorrelationError| error.parameter();
    /// let turn = RigidMotion::about(DVec3::ZERO, DVec3::ZERO, 1.0);
    /// assert_eq!(turn.map_err(name), Err("axis"));
    /// ```
    pub const fn parameter(&self) -> &'static str {
        match self {
            Self::Wavelength(..) => "wavelength",
            Self::FocalLength(..) => "focal_length",
            Self::FNumber(..) => "f_number",
            Self::PixelPitch(..) => "pixel_pitch",
            Self::SurfaceToPupil { .. } => "surface_to_pupil",
            Self::SurfaceToPrincipalPlane { .. } => "surface_to_principal_plane",
            Self::PupilToImage(..) => "pupil_to_image",
            Self::Magnification(..) => "magnification",
            Self::PupilMagnification(..) => "pupil_magnification",
            Self::PupilDiameter { .. } => "pupil_diameter",
            Self::PupilTooWide { .. } => "pupil_diameter",
            Self::Axes(..) => "axes",
            Self::ViewDirection(..) => "target",
            Self::Up(..) => "up",
            Self::ToPupil(..) => "to_pupil",
            Self::DirectionToSource(..) => "direction_to_source",
            Self::Curvature(..) => "curvature",
            Self::CurvatureTensor(..) => "curvature",
            Self::PrincipalAxis(..) => "axis",
            Self::LightPosition(..) => "position",
            Self::LitPoint(..) => "point",
            Self::Normal(..) => "normal",
            Self::Rotation(..) => "rotation",
            Self::RotationAxis(..) => "axis",
            Self::RotationAngle(..) => "angle",
            Self::Pivot(..) => "pivot",
            Self::Translation(..) => "translation",
            Self::PupilCentre(..) => "pupil_centre",
            Self::PatternSpeckleSize(..) => "pattern_speckle_size",
            Self::Scale(..) => "geometry",
        }
    }
}

impl fmt::Display for DecorrelationError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        const POSITIVE: &str = "must be positive and finite, got";
        const FINITE: &str = "must be finite, got";
        const DIRECTION: &str = "must be finite and not zero, got";
        match self {
            Self::Wavelength(got) => write!(f, "wavelength {POSITIVE} {got:e} m"),
            Self::FocalLength(got) => write!(f, "focal length {POSITIVE} {got:e} m"),
            Self::FNumber(got) => write!(f, "f-number must be finite and at least 0.5, got {got}"),
            Self::PixelPitch(got) => write!(f, "pixel pitch {POSITIVE} {got:e} m"),
            Self::SurfaceToPupil {
                surface_to_pupil,
                minimum,
            } => write!(
                f,
                "surface-to-pupil distance must be finite and exceed {minimum:e} m, got \
                 {surface_to_pupil:e} m"
            ),
            Self::SurfaceToPrincipalPlane {
                surface_to_principal_plane,
                focal_length,
            } => write!(
                f,
                "distance from surface to principal plane must be finite and exceed the focal \
                 length of {focal_length:e} m, got {surface_to_principal_plane:e} m"
            ),
            Self::PupilToImage(got) => write!(f, "pupil-to-image distance {POSITIVE} {got:e} m"),
            Self::Magnification(got) => write!(
                f,
                "magnification and the distances that follow from it must be positive and finite, \
                 got {got:e}"
            ),
            Self::PupilMagnification(got) => write!(f, "pupil magnification {POSITIVE} {got:e}"),
            Self::PupilDiameter {
                pupil_diameter,
                wavelength,
            } => write!(
                f,
                "pupil diameter must be finite and exceed the wavelength of {wavelength:e} m, got \
                 {pupil_diameter:e} m"
            ),
            Self::PupilTooWide {
                pupil_diameter,
                distance,
            } => write!(
                f,
                "pupil diameter must not exceed twice the distance of {distance:e} m to surface or \
                 sensor, got {pupil_diameter:e} m"
            ),
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
            Self::ToPupil(got) => write!(
                f,
                "vector from surface to pupil must be finite and lead from a point in front of the \
                 camera, got {got} m"
            ),
            Self::DirectionToSource(got) => {
                write!(f, "direction to the source {DIRECTION} {got}")
            }
            Self::Curvature(got) => {
                write!(
                    f,
                    "wavefront curvature (1/R) must be finite, got {got:e} 1/m"
                )
            }
            Self::CurvatureTensor(got) => write!(
                f,
                "curvature tensor must be finite and symmetric within 1e-6, got columns {got} 1/m"
            ),
            Self::PrincipalAxis(got) => write!(
                f,
                "principal axis must be finite, not zero and not along the direction to the \
                 source, got {got}"
            ),
            Self::LightPosition(got) => write!(f, "position of the light {FINITE} {got} m"),
            Self::LitPoint(got) => write!(
                f,
                "surface point must not lie at the source or in a focus, got {got} m"
            ),
            Self::Rotation(got) => write!(
                f,
                "rotation matrix must be right-handed and orthonormal within 1e-6, got columns {got}"
            ),
            Self::RotationAxis(got) => write!(f, "axis of rotation {DIRECTION} {got}"),
            Self::RotationAngle(got) => write!(f, "angle of rotation {FINITE} {got:e} rad"),
            Self::Pivot(got) => write!(f, "pivot {FINITE} {got} m"),
            Self::Translation(got) => write!(f, "translation {FINITE} {got} m"),
            Self::Normal(got) => write!(f, "surface normal {DIRECTION} {got}"),
            Self::PupilCentre(got) => {
                write!(f, "centre of the pupil must be finite, got {got} m")
            }
            Self::PatternSpeckleSize(got) => {
                write!(f, "speckle size of the pattern {POSITIVE} {got} samples")
            }
            Self::Scale(got) => write!(
                f,
                "geometry and pattern must have lengths of one scale, with ratios of at most \
                 1e250, got {got:e}"
            ),
        }
    }
}

impl error::Error for DecorrelationError {}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{CameraFrame, Illumination, RigidMotion, Wavefront};

    #[test]
    fn the_parameter_is_the_argument_that_was_given() {
        let (x, zero) = (DVec3::X, DVec3::ZERO);
        let fan = |axis| Wavefront::astigmatic(x, axis, 1.0, 1.0);
        let skew = DMat3::from_cols(x, x, x);
        let refusals = [
            (CameraFrame::look_at(x, x, DVec3::Y).err(), "target"),
            (CameraFrame::look_at(x, zero, x).err(), "up"),
            (Wavefront::spherical(x, f64::NAN).err(), "curvature"),
            (Wavefront::from_tensor(x, skew).err(), "curvature"),
            (fan(x).err(), "axis"),
            (Illumination::point_source(DVec3::NAN).err(), "position"),
            (RigidMotion::about(zero, zero, 1.0).err(), "axis"),
            (RigidMotion::about(zero, x, f64::NAN).err(), "angle"),
        ];
        for (error, parameter) in refusals {
            assert_eq!(error.map(|e| e.parameter()), Some(parameter), "{error:?}");
        }
    }

    #[test]
    fn every_message_names_the_parameter_and_its_value() {
        use DecorrelationError as E;
        let vector = DVec3::new(1.25, 2.5, -3.75);
        let cases = [
            (E::Wavelength(-1.25), "wavelength", "-1.25e0 m"),
            (E::FocalLength(-1.25), "focal length", "-1.25e0 m"),
            (E::FNumber(0.25), "f-number", "0.25"),
            (E::PixelPitch(-1.25), "pixel pitch", "-1.25e0 m"),
            (
                E::SurfaceToPupil {
                    surface_to_pupil: 0.02,
                    minimum: 0.025,
                },
                "2.5e-2",
                "2e-2 m",
            ),
            (
                E::SurfaceToPrincipalPlane {
                    surface_to_principal_plane: 0.02,
                    focal_length: 0.025,
                },
                "2.5e-2",
                "2e-2 m",
            ),
            (E::PupilToImage(-1.25), "pupil-to-image", "-1.25e0 m"),
            (E::Magnification(-1.25), "magnification", "-1.25e0"),
            (
                E::PupilMagnification(-1.25),
                "pupil magnification",
                "-1.25e0",
            ),
            (
                E::PupilTooWide {
                    pupil_diameter: 0.3,
                    distance: 0.125,
                },
                "1.25e-1 m",
                "3e-1 m",
            ),
            (
                E::PupilDiameter {
                    pupil_diameter: 1e-9,
                    wavelength: 6.5e-7,
                },
                "6.5e-7",
                "1e-9 m",
            ),
            (E::Axes(DMat3::IDENTITY * 2.5), "camera axes", "2.5"),
            (E::ViewDirection(vector), "target to the camera", "-3.75"),
            (E::Up(vector), "upward direction", "-3.75"),
            (E::ToPupil(vector), "surface to pupil", "-3.75"),
            (
                E::DirectionToSource(vector),
                "direction to the source",
                "-3.75",
            ),
            (E::Curvature(f64::INFINITY), "curvature", "inf 1/m"),
            (
                E::CurvatureTensor(DMat3::IDENTITY * 2.5),
                "curvature tensor",
                "2.5",
            ),
            (E::PrincipalAxis(vector), "principal axis", "-3.75"),
            (E::LightPosition(vector), "position of the light", "-3.75"),
            (E::LitPoint(vector), "surface point", "-3.75"),
            (E::Normal(vector), "surface normal", "-3.75"),
            (E::Rotation(DMat3::IDENTITY * 2.5), "rotation matrix", "2.5"),
            (E::RotationAxis(vector), "axis of rotation", "-3.75"),
            (
                E::RotationAngle(f64::INFINITY),
                "angle of rotation",
                "inf rad",
            ),
            (E::Pivot(vector), "pivot", "-3.75"),
            (E::Translation(vector), "translation", "-3.75"),
            (E::PupilCentre(vector), "centre of the pupil", "-3.75"),
            (
                E::PatternSpeckleSize(-1.25),
                "speckle size",
                "-1.25 samples",
            ),
            (E::Scale(1e300), "geometry", "1e300"),
        ];
        for (error, name, value) in cases {
            let message = error.to_string();
            assert!(message.contains(name), "no {name} in: {message}");
            assert!(message.contains(value), "no {value} in: {message}");
            assert!(message.contains("must "), "nothing allowed in: {message}");
        }
    }
}
