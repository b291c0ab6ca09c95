use tem00_numerics::{Shown, check};

use crate::Refusal;

/// Parameters of a thin lens at a known distance from the surface, for an
/// [`ImagingGeometry`](crate::ImagingGeometry).
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct LensData {
    /// Vacuum wavelength `λ` of the light, in metres.
    pub wavelength: f64,
    /// Focal length `f` of the lens, in metres.
    pub focal_length: f64,
    /// F-number `F = f / D` as engraved on the lens, for focus at infinity.
    pub f_number: f64,
    /// Distance `L` from the surface in focus to the pupil along the optical axis, in metres.
    pub surface_to_pupil: f64,
    /// Distance between the centres of neighbouring pixels on the sensor, in metres.
    pub pixel_pitch: f64,
}

/// Parameters of a lens of many elements, for an [`ImagingGeometry`](crate::ImagingGeometry).
///
/// The pupils of the lens lie away from its principal planes and differ in size:
///
/// ```text
/// m   = f / (s − f)            magnification, s from the surface to the front principal plane
/// m_p = D_exit / D             pupil magnification, D the diameter of the entrance pupil
/// D   = f / F
/// L   = f (1/m + 1/m_p)        surface to entrance pupil
/// d   = f (m + m_p)            exit pupil to sensor
/// ```
///
/// The relations follow from Newton's form of the lens equation. An object imaged with the
/// magnification M, negative for an inverted image, lies at the distance −f/M before the front
/// focus, and its image at −M f behind the rear focus. The surface has M = −m, and the entrance
/// pupil, whose image is the exit pupil, has M = `m_p`.
///
/// `s` and `L` differ by `f (1/m_p − 1)`, the distance from the front principal plane to the
/// entrance pupil towards the image. A retrofocus lens has `m_p` above 1, a telephoto lens below.
///
/// # Validity
///
/// The lens is in air. A lens telecentric on the side of the surface has its entrance pupil at
/// infinity and is not covered.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ThickLensData {
    /// Vacuum wavelength `λ` of the light, in metres.
    pub wavelength: f64,
    /// Focal length `f` of the lens, in metres.
    pub focal_length: f64,
    /// F-number `F = f / D` as engraved on the lens, for focus at infinity.
    pub f_number: f64,
    /// Pupil magnification `m_p`, the diameter of the exit pupil divided by the diameter of the
    /// entrance pupil.
    pub pupil_magnification: f64,
    /// Position of the surface in focus.
    pub focus: Focus,
    /// Distance between the centres of neighbouring pixels on the sensor, in metres.
    pub pixel_pitch: f64,
}

/// Position of the surface in focus before a [thick lens](ThickLensData).
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub enum Focus {
    /// The distance that is imaged with this magnification `m`, counted positive.
    Magnification(f64),
    /// Distance `s` from the front principal plane, in metres: the object distance of the lens
    /// equation.
    SurfaceToPrincipalPlane(f64),
    /// Distance `L` from the entrance pupil, in metres. The entrance pupil is the centre of
    /// perspective, from which a renderer sees the scene.
    SurfaceToPupil(f64),
}

impl Focus {
    /// Returns `m` and `L`, in metres, for the focal length `f`, in metres, and `m_p`.
    pub(crate) fn resolve(self, f: f64, m_p: f64) -> Result<(f64, f64), Refusal> {
        let (m, surface_to_pupil) = match self {
            Self::Magnification(m) => (m, f / m + f / m_p),
            Self::SurfaceToPrincipalPlane(s) => {
                check_longer("surface_to_principal_plane", s, "the focal length", f)?;
                (f / (s - f), (s - f) + f / m_p)
            }
            Self::SurfaceToPupil(surface_to_pupil) => {
                let minimum = f / m_p;
                let limit = "the focal length over the pupil magnification";
                check_longer("surface_to_pupil", surface_to_pupil, limit, minimum)?;
                (f / (surface_to_pupil - minimum), surface_to_pupil)
            }
        };
        // Sums and quotients of finite numbers near the ends of their range may overflow.
        check_magnification(m, &[m, surface_to_pupil])?;
        Ok((m, surface_to_pupil))
    }
}

/// Distances and pupil of a camera, given directly, for an
/// [`ImagingGeometry`](crate::ImagingGeometry).
///
/// These are the parameters of Bergmann et al. 2016. Entrance and exit pupil coincide with the
/// lens.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PupilDistances {
    /// Vacuum wavelength `λ` of the light, in metres.
    pub wavelength: f64,
    /// Distance `L` from the surface in focus to the pupil along the optical axis, in metres.
    pub surface_to_pupil: f64,
    /// Distance `d_PI` from the pupil to the sensor, in metres.
    pub pupil_to_image: f64,
    /// Diameter `D` of the pupil, in metres.
    pub pupil_diameter: f64,
    /// Distance between the centres of neighbouring pixels on the sensor, in metres.
    pub pixel_pitch: f64,
}

/// Refuses a length that does not exceed its limit, in metres.
pub(crate) fn check_longer(
    parameter: &'static str,
    length: f64,
    limit: &str,
    minimum: f64,
) -> Result<(), Refusal> {
    if length > minimum && length.is_finite() {
        return Ok(());
    }
    let allowed = format!("finite and exceed {limit} of {} m", Shown(minimum));
    Err(Refusal::new(parameter, length, allowed).in_unit("m"))
}

/// Refuses a magnification with which one of these numbers is not positive and finite.
pub(crate) fn check_magnification(magnification: f64, numbers: &[f64]) -> Result<(), Refusal> {
    let holds = numbers.iter().all(|x| *x > 0.0 && x.is_finite());
    let allowed = "positive and finite, with the distances that follow from it";
    check::that(holds, "magnification", magnification, "", allowed)
}

pub(crate) fn check_f_number(f_number: f64) -> Result<(), Refusal> {
    let holds = f_number >= 0.5 && f_number.is_finite();
    let allowed = "finite and at least 0.5, the limit of any lens in air";
    check::that(holds, "f_number", f_number, "", allowed)
}
