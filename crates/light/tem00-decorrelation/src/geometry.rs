use glam::DVec2;
use tem00_numerics::{Shown, check};

use crate::{
    LensData, PupilDistances, Refusal, ThickLensData,
    lens::{check_f_number, check_longer, check_magnification},
};

/// Imaging geometry of a camera focused on a surface: a lens, its pupils and the sensor behind it.
///
/// ```text
///   surface       entrance pupil D   exit pupil m_p D      sensor
///      │◀──────── L ───────▶┃              ┃◀───── d_PI ─────▶│
///
/// m   = c / L                  magnification
/// c   = m L = d_PI / m_p       principal distance
/// F_w = c / D                  working f-number
/// h   = λ F_w                  speckle size on the sensor
/// ```
///
/// The scene is seen in perspective from the centre of the entrance pupil, as by a pinhole camera
/// with the sensor at the principal distance `c`. In a thin lens both pupils coincide with the
/// lens: `m_p` = 1 and `c = d_PI`.
///
/// The speckle size `h` is the period of the finest intensity fringes that the pupil lets through.
/// The intensity correlation first vanishes at 1.22 h and its full width at half maximum is 1.03 h.
///
/// | known parameters of the camera | constructor |
/// |---|---|
/// | focal length, f-number, distance to the surface | [`from_lens`](Self::from_lens) |
/// | the same with the magnification or with separate pupils | [`from_thick_lens`](Self::from_thick_lens) |
/// | the distances on both sides and the pupil | [`from_distances`](Self::from_distances) |
///
/// # Validity
///
/// Distances are paraxial, along the optical axis, and the lens is free of aberrations.
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
/// assert!((geometry.working_f_number() - 8.727).abs() < 1e-3);
/// assert!((geometry.speckle_size() - 5.673e-6).abs() < 1e-9);
/// assert!((geometry.speckle_size_in_pixels() - 1.644).abs() < 1e-3);
/// assert!((geometry.axial_decorrelation_length() - 47.92e-3).abs() < 0.01e-3);
/// # Ok::<(), tem00_decorrelation::Refusal>(())
/// ```
///
/// # References
///
/// - J. W. Goodman, *Statistical properties of laser speckle patterns*, 1975, §2.5.
/// - S. Bergmann et al. 2016, §6.2.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ImagingGeometry {
    wavelength: f64,
    focal_length: f64,
    pupil_diameter: f64,
    pupil_magnification: f64,
    surface_to_pupil: f64,
    principal_distance: f64,
    pixel_pitch: f64,
}

impl ImagingGeometry {
    /// Creates the geometry of a thin lens that images a surface at a given distance sharply.
    ///
    /// ```text
    /// d_PI = f L / (L − f),    D = f / F
    /// ```
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
    /// use tem00_decorrelation::{ImagingGeometry, LensData};
    ///
    /// let too_close = ImagingGeometry::from_lens(LensData {
    ///     wavelength: 650e-9,
    ///     focal_length: 25e-3,
    ///     f_number: 8.0,
    ///     surface_to_pupil: 20e-3,
    ///     pixel_pitch: 3.45e-6,
    /// });
    /// assert_eq!(too_close.unwrap_err().parameter, "surface_to_pupil");
    /// ```
    pub fn from_lens(lens: LensData) -> Result<Self, Refusal> {
        let LensData {
            wavelength,
            focal_length,
            f_number,
            surface_to_pupil,
            pixel_pitch,
        } = lens;
        check::positive("focal_length", focal_length, "m")?;
        check_f_number(f_number)?;
        let limit = "the focal length";
        check_longer("surface_to_pupil", surface_to_pupil, limit, focal_length)?;
        let beyond_focus = surface_to_pupil - focal_length;
        Self {
            wavelength,
            focal_length,
            pupil_diameter: focal_length / f_number,
            pupil_magnification: 1.0,
            surface_to_pupil,
            principal_distance: focal_length * (surface_to_pupil / beyond_focus),
            pixel_pitch,
        }
        .checked()
    }

    /// Creates the geometry of a lens of many elements from its focal length, f-number, pupil
    /// magnification and focus.
    ///
    /// # Errors
    ///
    /// Returns an error if a length, the magnification or the pupil magnification is not positive
    /// and finite, if the f-number is below 0.5, if the surface lies so near that no real image
    /// forms or that the pupil is wider than twice the surface distance, or if the pupil is smaller
    /// than the wavelength.
    ///
    /// # Examples
    ///
    /// A 50 mm lens at f/4 images at half size. As the exit pupil is smaller than the entrance
    /// pupil, the working f-number is 6.5 and not 6:
    ///
    /// ```
    /// use tem00_decorrelation::{Focus, ImagingGeometry, ThickLensData};
    ///
    /// let geometry = ImagingGeometry::from_thick_lens(ThickLensData {
    ///     wavelength: 650e-9,
    ///     focal_length: 50e-3,
    ///     f_number: 4.0,
    ///     pupil_magnification: 0.8,
    ///     focus: Focus::Magnification(0.5),
    ///     pixel_pitch: 3.45e-6,
    /// })?;
    ///
    /// assert!((geometry.working_f_number() - 6.5).abs() < 1e-12);
    /// assert!((geometry.surface_to_pupil() - 162.5e-3).abs() < 1e-12);
    /// assert!((geometry.pupil_to_image() - 65e-3).abs() < 1e-12);
    /// assert!((geometry.exit_pupil_diameter() - 10e-3).abs() < 1e-12);
    /// assert!((geometry.speckle_size() - 4.225e-6).abs() < 1e-12);
    /// # Ok::<(), tem00_decorrelation::Refusal>(())
    /// ```
    pub fn from_thick_lens(lens: ThickLensData) -> Result<Self, Refusal> {
        let ThickLensData {
            wavelength,
            focal_length,
            f_number,
            pupil_magnification,
            focus,
            pixel_pitch,
        } = lens;
        check::positive("focal_length", focal_length, "m")?;
        check_f_number(f_number)?;
        check::positive("pupil_magnification", pupil_magnification, "")?;
        let (magnification, surface_to_pupil) = focus.resolve(focal_length, pupil_magnification)?;
        let principal_distance = focal_length + focal_length * magnification / pupil_magnification;
        check_magnification(magnification, &[principal_distance])?;
        Self {
            wavelength,
            focal_length,
            pupil_diameter: focal_length / f_number,
            pupil_magnification,
            surface_to_pupil,
            principal_distance,
            pixel_pitch,
        }
        .checked()
    }

    /// Creates the geometry of a camera whose pupil and distances are known.
    ///
    /// ```text
    /// 1/f = 1/L + 1/d_PI,    F = f / D
    /// ```
    ///
    /// # Errors
    ///
    /// Returns an error if a length is not positive and finite, if the pupil is wider than twice
    /// its distance to surface or sensor, or if the pupil is smaller than the wavelength.
    ///
    /// # Examples
    ///
    /// ```
    /// use tem00_decorrelation::{ImagingGeometry, PupilDistances};
    ///
    /// let geometry = ImagingGeometry::from_distances(PupilDistances {
    ///     wavelength: 632.8e-9,
    ///     surface_to_pupil: 0.3,
    ///     pupil_to_image: 75e-3,
    ///     pupil_diameter: 10e-3,
    ///     pixel_pitch: 3.45e-6,
    /// })?;
    ///
    /// assert!((geometry.focal_length() - 60e-3).abs() < 1e-15);
    /// assert!((geometry.magnification() - 0.25).abs() < 1e-15);
    /// assert!((geometry.speckle_size() - 4.746e-6).abs() < 1e-12);
    /// # Ok::<(), tem00_decorrelation::Refusal>(())
    /// ```
    pub fn from_distances(distances: PupilDistances) -> Result<Self, Refusal> {
        let PupilDistances {
            wavelength,
            surface_to_pupil,
            pupil_to_image,
            pupil_diameter,
            pixel_pitch,
        } = distances;
        check::positive("surface_to_pupil", surface_to_pupil, "m")?;
        check::positive("pupil_to_image", pupil_to_image, "m")?;
        let focal_length = 1.0 / (1.0 / surface_to_pupil + 1.0 / pupil_to_image);
        check::positive("focal_length", focal_length, "m")?;
        Self {
            wavelength,
            focal_length,
            pupil_diameter,
            pupil_magnification: 1.0,
            surface_to_pupil,
            principal_distance: pupil_to_image,
            pixel_pitch,
        }
        .checked()
    }

    /// Returns the geometry of the same camera in light of another wavelength, in metres.
    ///
    /// Lens and distances stay as they are: the lens is free of chromatic aberration.
    ///
    /// # Errors
    ///
    /// Returns an error if the wavelength is not positive and finite or exceeds the pupil.
    pub fn with_wavelength(self, wavelength: f64) -> Result<Self, Refusal> {
        Self { wavelength, ..self }.checked()
    }

    fn checked(self) -> Result<Self, Refusal> {
        check::positive("wavelength", self.wavelength, "m")?;
        check::positive("pixel_pitch", self.pixel_pitch, "m")?;
        let diameter = self.pupil_diameter;
        check_longer(
            "pupil_diameter",
            diameter,
            "the wavelength",
            self.wavelength,
        )?;
        // Half the reciprocal is a numerical aperture, which does not exceed one for a lens in air.
        let distance = self.surface_to_pupil.min(self.principal_distance);
        if distance < 0.5 * diameter {
            let distance = Shown(distance);
            let allowed =
                format!("at most twice the distance of {distance} m to surface or sensor");
            return Err(Refusal::new("pupil_diameter", diameter, allowed).in_unit("m"));
        }
        Ok(self)
    }

    /// Returns the vacuum wavelength `λ`, in metres.
    pub const fn wavelength(&self) -> f64 {
        self.wavelength
    }

    /// Returns the focal length `f`, in metres.
    pub const fn focal_length(&self) -> f64 {
        self.focal_length
    }

    /// Returns the f-number `F = f / D`, for focus at infinity.
    pub const fn f_number(&self) -> f64 {
        self.focal_length / self.pupil_diameter
    }

    /// Returns the f-number of the light on the sensor, `F_w = F (1 + m / m_p)`.
    pub const fn working_f_number(&self) -> f64 {
        self.principal_distance / self.pupil_diameter
    }

    /// Returns the distance `L` from the surface in focus to the entrance pupil, in metres.
    pub const fn surface_to_pupil(&self) -> f64 {
        self.surface_to_pupil
    }

    /// Returns the pixel pitch of the sensor, in metres.
    pub const fn pixel_pitch(&self) -> f64 {
        self.pixel_pitch
    }

    /// Returns the principal distance `c = m L`, in metres.
    ///
    /// It converts the tangent of a viewing angle to a length on the sensor: the image of an object
    /// at the depth Z is c/Z times as large as the object, in focus or not. Photogrammetry calls it
    /// the camera constant.
    pub const fn principal_distance(&self) -> f64 {
        self.principal_distance
    }

    /// Returns the distance `d_PI = m_p c` from the exit pupil to the sensor, in metres.
    pub const fn pupil_to_image(&self) -> f64 {
        self.pupil_magnification * self.principal_distance
    }

    /// Returns the magnification `m = c / L` at the surface in focus, without a sign.
    pub const fn magnification(&self) -> f64 {
        self.principal_distance / self.surface_to_pupil
    }

    /// Returns the pupil magnification `m_p`, 1 for a thin lens.
    pub const fn pupil_magnification(&self) -> f64 {
        self.pupil_magnification
    }

    /// Returns the diameter `D = f / F` of the entrance pupil, in metres.
    pub const fn pupil_diameter(&self) -> f64 {
        self.pupil_diameter
    }

    /// Returns the diameter `m_p D` of the exit pupil, in metres.
    pub const fn exit_pupil_diameter(&self) -> f64 {
        self.pupil_magnification * self.pupil_diameter
    }

    /// Returns the speckle size on the sensor `h = λ c / D`, in metres.
    pub fn speckle_size(&self) -> f64 {
        self.wavelength() * self.working_f_number()
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

    /// Returns the depth of focus of the speckle at the surface, in metres: the displacement of the
    /// surface along the axis, in either direction, after which the correlation is `(2/π)²` = 40.5
    /// %.
    ///
    /// ```text
    /// 4 λ (L / D)²
    /// ```
    ///
    /// At this displacement the edge of the pupil is half a wave out of phase with its centre. The
    /// depth of focus is half the [axial decorrelation length](Self::axial_decorrelation_length).
    /// At a quarter of this length, Rayleigh's criterion, the correlation is 81 %.
    ///
    /// # Examples
    ///
    /// A macro lens at f/2.8 and m = 1/2:
    ///
    /// ```
    /// use tem00_decorrelation::{Focus, ImagingGeometry, ThickLensData};
    ///
    /// let geometry = ImagingGeometry::from_thick_lens(ThickLensData {
    ///     wavelength: 632.8e-9,
    ///     focal_length: 50e-3,
    ///     f_number: 2.8,
    ///     pupil_magnification: 1.0,
    ///     focus: Focus::Magnification(0.5),
    ///     pixel_pitch: 3.45e-6,
    /// })?;
    /// // L/D = (1 + 1/m) F = 8.4 and F_w = (1 + m) F = 4.2.
    /// assert!((geometry.depth_of_focus() - 178.6e-6).abs() < 0.1e-6);
    /// assert!((geometry.sensor_depth_of_focus() - 44.65e-6).abs() < 0.01e-6);
    /// assert!((geometry.object_speckle_size() - 5.316e-6).abs() < 1e-9);
    /// # Ok::<(), tem00_decorrelation::Refusal>(())
    /// ```
    pub fn depth_of_focus(&self) -> f64 {
        0.5 * self.axial_decorrelation_length()
    }

    /// Returns the depth of focus of the speckle at the sensor, in metres: the displacement of the
    /// sensor, in either direction, after which the correlation is 40.5 %.
    ///
    /// ```text
    /// 4 λ F_w²
    /// ```
    ///
    /// The full width at half maximum of the correlation is `7.09 λ F_w²` along the axis and 1.03
    /// times the [`speckle_size`](Self::speckle_size) across it.
    pub fn sensor_depth_of_focus(&self) -> f64 {
        4.0 * self.wavelength() * self.working_f_number().powi(2)
    }

    /// Returns the defocus `W = 1/Z − 1/L` of a point at `depth` Z, in metres, before the entrance
    /// pupil, in 1/m.
    ///
    /// It is positive before the surface in focus and negative behind it. The path of the light
    /// through the pupil point p is longer by `W p²/2` than the path to a point in focus.
    pub fn defocus_at(&self, depth: f64) -> f64 {
        depth.recip() - self.surface_to_pupil.recip()
    }

    /// Returns the coordinate in a speckle pattern, in pattern samples, of a pixel of the image.
    ///
    /// ```text
    /// c = (h_p / h_I) (t_x, −t_y) − (h_p / h) a_I
    /// ```
    ///
    /// `pixel` is the position t in pixels, x to the right and y *down* in the direction of the
    /// rows, from any origin. `image_displacement` is the motion `a_I` of the speckle since the
    /// reference state to the right and *up*, in metres, as [`SpeckleMotion`](crate::SpeckleMotion)
    /// has it: the pattern moves across the image *by* `a_I`. `pattern_speckle_size` is `h_p`, the
    /// speckle size of the pattern in samples. The result is the look-up coordinate, to the right
    /// and up, and not wrapped to the period of the pattern.
    ///
    /// Bergmann et al. 2016, §6.3, prints a plus sign, with which the pattern would move backwards.
    pub fn pattern_coordinate(
        &self,
        pixel: DVec2,
        image_displacement: DVec2,
        pattern_speckle_size: f64,
    ) -> DVec2 {
        let samples_per_pixel = pattern_speckle_size / self.speckle_size_in_pixels();
        let samples_per_metre = pattern_speckle_size / self.speckle_size();
        DVec2::new(pixel.x, -pixel.y) * samples_per_pixel - image_displacement * samples_per_metre
    }
}

#[cfg(test)]
mod tests;
