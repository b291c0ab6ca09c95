use glam::DVec2;

use crate::DecorrelationError;

/// Camera data from which an [`ImagingGeometry`] is made.
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

/// A camera focused on a surface: a thin lens, its pupil and the sensor behind it.
///
/// ```text
///   surface                 pupil D          sensor
///      │◀───────── L ─────────▶┃◀──── d_PI ────▶│
///
/// d_PI = f L / (L − f)          pupil to image
/// m    = d_PI / L               magnification
/// D    = f / F                  pupil diameter
/// h    = λ d_PI / D             speckle size on the sensor
/// ```
///
/// The speckle size `h` is the period of the finest intensity fringes that the pupil lets through.
/// The intensity correlation first vanishes at 1.22 h and its full width at half maximum is 1.03 h.
///
/// # Validity
///
/// A thin lens in air: entrance and exit pupil coincide with the lens, so that the same `D` limits
/// the light on both sides. Distances are paraxial, along the optical axis.
///
/// # Examples
///
/// A machine-vision camera with a 25 mm lens at f/8, 30 cm from the surface:
///
/// ```
/// use tem00_decorrelation::{ImagingGeometry, LensData};
///
/// let geometry = ImagingGeometry::from_lens(LensData {
///     wavelength: 650e-9,
///     focal_length: 25e-3,
///     f_number: 8.0,
///     surface_to_pupil: 0.3,
///     pixel_pitch: 3.45e-6,
/// })?;
///
/// assert!((geometry.pupil_diameter() - 3.125e-3).abs() < 1e-12);
/// assert!((geometry.speckle_size() - 5.673e-6).abs() < 1e-9);
/// assert!((geometry.speckle_size_in_pixels() - 1.644).abs() < 1e-3);
/// assert!((geometry.axial_decorrelation_length() - 47.92e-3).abs() < 0.01e-3);
/// # Ok::<(), tem00_decorrelation::DecorrelationError>(())
/// ```
///
/// # References
///
/// - J. W. Goodman, *Statistical properties of laser speckle patterns*, 1975, §2.5.
/// - S. Bergmann et al. 2016, §6.2.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ImagingGeometry {
    lens: LensData,
}

impl ImagingGeometry {
    /// Creates the geometry of a thin lens that images a surface at a given distance sharply.
    ///
    /// # Errors
    ///
    /// Returns an error if a length is not positive and finite, if the f-number is below 0.5, if
    /// the surface does not lie beyond the focal length, or if the pupil is smaller than the
    /// wavelength.
    ///
    /// # Examples
    ///
    /// A surface inside the focal length has no real image:
    ///
    /// ```
    /// use tem00_decorrelation::{DecorrelationError, ImagingGeometry, LensData};
    ///
    /// let too_close = ImagingGeometry::from_lens(LensData {
    ///     wavelength: 650e-9,
    ///     focal_length: 25e-3,
    ///     f_number: 8.0,
    ///     surface_to_pupil: 20e-3,
    ///     pixel_pitch: 3.45e-6,
    /// });
    /// assert!(matches!(too_close, Err(DecorrelationError::SurfaceToPupil { .. })));
    /// ```
    pub fn from_lens(lens: LensData) -> Result<Self, DecorrelationError> {
        let LensData {
            wavelength,
            focal_length,
            f_number,
            surface_to_pupil,
            pixel_pitch,
        } = lens;
        check_positive(wavelength, DecorrelationError::Wavelength)?;
        check_positive(focal_length, DecorrelationError::FocalLength)?;
        check_positive(pixel_pitch, DecorrelationError::PixelPitch)?;
        if !(f_number >= 0.5 && f_number.is_finite()) {
            return Err(DecorrelationError::FNumber(f_number));
        }
        if !(surface_to_pupil > focal_length && surface_to_pupil.is_finite()) {
            return Err(DecorrelationError::SurfaceToPupil {
                surface_to_pupil,
                focal_length,
            });
        }
        let pupil_diameter = focal_length / f_number;
        if pupil_diameter <= wavelength {
            return Err(DecorrelationError::PupilDiameter {
                pupil_diameter,
                wavelength,
            });
        }
        Ok(Self { lens })
    }

    /// Returns the vacuum wavelength `λ`, in metres.
    pub const fn wavelength(&self) -> f64 {
        self.lens.wavelength
    }

    /// Returns the focal length `f`, in metres.
    pub const fn focal_length(&self) -> f64 {
        self.lens.focal_length
    }

    /// Returns the f-number `F = f / D`.
    pub const fn f_number(&self) -> f64 {
        self.lens.f_number
    }

    /// Returns the distance `L` from the surface in focus to the pupil, in metres.
    pub const fn surface_to_pupil(&self) -> f64 {
        self.lens.surface_to_pupil
    }

    /// Returns the pixel pitch of the sensor, in metres.
    pub const fn pixel_pitch(&self) -> f64 {
        self.lens.pixel_pitch
    }

    /// Returns the distance `d_PI = f L / (L − f)` from the pupil to the sensor, in metres.
    pub fn pupil_to_image(&self) -> f64 {
        let beyond_focus = self.surface_to_pupil() - self.focal_length();
        self.focal_length() * (self.surface_to_pupil() / beyond_focus)
    }

    /// Returns the magnification `m = d_PI / L` at the surface in focus, without a sign.
    pub fn magnification(&self) -> f64 {
        self.focal_length() / (self.surface_to_pupil() - self.focal_length())
    }

    /// Returns the pupil diameter `D = f / F`, in metres.
    pub fn pupil_diameter(&self) -> f64 {
        self.focal_length() / self.f_number()
    }

    /// Returns the speckle size on the sensor `h = λ d_PI / D`, in metres.
    pub fn speckle_size(&self) -> f64 {
        self.wavelength() * (self.pupil_to_image() / self.pupil_diameter())
    }

    /// Returns the speckle size on the sensor in pixels, `h_I = h / w`, with the pixel pitch `w`.
    ///
    /// Below 2 the sensor undersamples the speckle, and its pixels average over it.
    pub fn speckle_size_in_pixels(&self) -> f64 {
        self.speckle_size() / self.pixel_pitch()
    }

    /// Returns the speckle size projected onto the surface in focus, `λ L / D`, in metres.
    pub fn object_speckle_size(&self) -> f64 {
        self.wavelength() * (self.surface_to_pupil() / self.pupil_diameter())
    }

    /// Returns the displacement along the axis that first decorrelates the speckle of the surface
    /// in focus entirely, in metres.
    ///
    /// ```text
    /// 8 λ (L / D)²
    /// ```
    ///
    /// See [`axial_correlation`](crate::axial_correlation) for the law up to there and beyond.
    pub fn axial_decorrelation_length(&self) -> f64 {
        self.axial_decorrelation_length_at(self.surface_to_pupil())
    }

    /// Returns the length `8 λ (Z / D)²` of [`axial_decorrelation_length`], in metres, for a point
    /// at `depth` Z, in metres, instead of the surface in focus.
    ///
    /// [`axial_decorrelation_length`]: Self::axial_decorrelation_length
    pub fn axial_decorrelation_length_at(&self, depth: f64) -> f64 {
        let aperture_ratio = depth / self.pupil_diameter();
        8.0 * self.wavelength() * aperture_ratio * aperture_ratio
    }

    /// Returns the coordinate in a speckle pattern, in pattern samples, that belongs to a pixel of
    /// the image.
    ///
    /// ```text
    /// c = (h_p / h_I) t − (h_p / h) a_I
    /// ```
    ///
    /// `pixel` is the position t in pixels and `image_displacement` the motion `a_I` of the speckle
    /// since the reference state, in metres. Both refer to the same two axes, so that the pattern
    /// moves across the image *by* `a_I`. `pattern_speckle_size` is `h_p`, the speckle size of the
    /// pattern in samples. The result is not wrapped to the period of the pattern.
    ///
    /// Bergmann et al. 2016, §6.3, prints a plus sign: see
    /// [`paper::pattern_coordinate`](crate::paper::pattern_coordinate).
    pub fn pattern_coordinate(
        &self,
        pixel: DVec2,
        image_displacement: DVec2,
        pattern_speckle_size: f64,
    ) -> DVec2 {
        let samples_per_pixel = pattern_speckle_size / self.speckle_size_in_pixels();
        let samples_per_metre = pattern_speckle_size / self.speckle_size();
        pixel * samples_per_pixel - image_displacement * samples_per_metre
    }
}

fn check_positive(x: f64, error: fn(f64) -> DecorrelationError) -> Result<(), DecorrelationError> {
    if x > 0.0 && x.is_finite() {
        Ok(())
    } else {
        Err(error(x))
    }
}

#[cfg(test)]
mod tests {
    use approx::assert_relative_eq;
    use proptest::prelude::*;

    use super::*;

    const LENS: LensData = LensData {
        wavelength: 632.8e-9,
        focal_length: 60e-3,
        f_number: 6.0,
        surface_to_pupil: 0.3,
        pixel_pitch: 3.45e-6,
    };

    #[test]
    fn a_quarter_magnification_lens_has_the_textbook_distances() {
        let geometry = ImagingGeometry::from_lens(LENS).unwrap();
        // L = (1 + 1/m) f and d_PI = (1 + m) f at m = 1/4; rounding only.
        assert_relative_eq!(geometry.magnification(), 0.25, max_relative = 1e-14);
        assert_relative_eq!(geometry.pupil_to_image(), 75e-3, max_relative = 1e-14);
        assert_relative_eq!(geometry.pupil_diameter(), 10e-3, max_relative = 1e-14);
        // h = λ (1 + m) F.
        let speckle_size = 632.8e-9 * 7.5;
        assert_relative_eq!(geometry.speckle_size(), speckle_size, max_relative = 1e-14);
        let in_pixels = speckle_size / 3.45e-6;
        assert_relative_eq!(
            geometry.speckle_size_in_pixels(),
            in_pixels,
            max_relative = 1e-14
        );
        // 8 λ (1 + 1/m)² F² = 8 · 632.8 nm · 900.
        assert_relative_eq!(
            geometry.axial_decorrelation_length(),
            4.556_16e-3,
            max_relative = 1e-14
        );
    }

    #[test]
    fn pattern_follows_the_image_displacement() {
        let geometry = ImagingGeometry::from_lens(LENS).unwrap();
        let shift = DVec2::new(17.0, -5.0);
        let pixel = DVec2::new(101.0, 33.0);
        let moved = geometry.pattern_coordinate(pixel + shift, shift * geometry.pixel_pitch(), 4.0);
        let before = geometry.pattern_coordinate(pixel, DVec2::ZERO, 4.0);
        // What was at `pixel` is now at `pixel + shift`; rounding of coordinates near 400.
        assert!(
            (moved - before).length() < 1e-12,
            "{moved} instead of {before}"
        );
        // One speckle of the image, h_I pixels, is one speckle of the pattern, h_p samples.
        let speckle = DVec2::new(geometry.speckle_size_in_pixels(), 0.0);
        let span = geometry.pattern_coordinate(pixel + speckle, DVec2::ZERO, 4.0) - before;
        assert!(
            (span - DVec2::new(4.0, 0.0)).length() < 1e-12,
            "span {span}"
        );
    }

    #[test]
    fn every_invalid_parameter_is_named() {
        use DecorrelationError as E;
        for bad in [0.0, -1.0, f64::NAN, f64::INFINITY] {
            let reject = |lens| ImagingGeometry::from_lens(lens).unwrap_err();
            let message = reject(LensData {
                wavelength: bad,
                ..LENS
            });
            assert!(matches!(message, E::Wavelength(_)), "{message}");
            let message = reject(LensData {
                focal_length: bad,
                ..LENS
            });
            assert!(matches!(message, E::FocalLength(_)), "{message}");
            let message = reject(LensData {
                f_number: bad,
                ..LENS
            });
            assert!(matches!(message, E::FNumber(_)), "{message}");
            let message = reject(LensData {
                surface_to_pupil: bad,
                ..LENS
            });
            assert!(matches!(message, E::SurfaceToPupil { .. }), "{message}");
            let message = reject(LensData {
                pixel_pitch: bad,
                ..LENS
            });
            assert!(matches!(message, E::PixelPitch(_)), "{message}");
        }
    }

    #[test]
    fn impossible_lenses_are_rejected() {
        let in_focus = LensData {
            surface_to_pupil: LENS.focal_length,
            ..LENS
        };
        assert!(
            matches!(
                ImagingGeometry::from_lens(in_focus),
                Err(DecorrelationError::SurfaceToPupil { .. })
            ),
            "a surface in the focal plane has its image at infinity"
        );
        let pinhole = LensData {
            f_number: 1e6,
            ..LENS
        };
        assert!(
            matches!(
                ImagingGeometry::from_lens(pinhole),
                Err(DecorrelationError::PupilDiameter { .. })
            ),
            "a pupil of 60 nm is below the wavelength"
        );
    }

    proptest! {
        #[test]
        fn image_obeys_the_lens_equation(
            focal_length in 1e-3_f64..1.0,
            ratio in 1.000_001_f64..1e6,
            f_number in 0.5_f64..100.0,
        ) {
            let lens = LensData {
                focal_length,
                f_number,
                surface_to_pupil: focal_length * ratio,
                ..LENS
            };
            let geometry = ImagingGeometry::from_lens(lens).unwrap();
            let (object, image) = (geometry.surface_to_pupil(), geometry.pupil_to_image());
            // Each reciprocal is at most 1/f and rounds by a few ε; L − f is exact near L = f.
            let residual = (1.0 / object + 1.0 / image - 1.0 / focal_length) * focal_length;
            prop_assert!(residual.abs() < 1e-14);
            // L/D = (1 + 1/m) F, and 1 + 1/m rounds as 1/m does.
            let (m, f) = (geometry.magnification(), geometry.f_number());
            let ratio = (1.0 + 1.0 / m) * f * geometry.pupil_diameter() / object;
            prop_assert!((ratio - 1.0).abs() < 1e-14);
        }
    }
}
