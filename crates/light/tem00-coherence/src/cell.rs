use core::f64::consts::TAU;

use glam::{DVec2, DVec3};
use num_complex::Complex;
use tem00_numerics::check;

use crate::{
    Refusal, SourceExtent, blur::Blur, excess::HeightExcess, kernel::LagKernel,
    spectrum::WAVELENGTHS,
};

/// Geometry of illumination and observation of a rough surface, for [`ResolutionCell::new`].
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct CellGeometry {
    /// Direction from the surface to the source, of any length.
    pub to_source: DVec3,
    /// Direction from the surface to the centre of the pupil, of any length.
    pub to_pupil: DVec3,
    /// Normal of the surface, of any length.
    pub normal: DVec3,
    /// Aperture of the lens, `sin u = D / 2L`: half the pupil's diameter divided by its distance.
    pub sin_aperture: f64,
    /// Wavelength, in metres.
    pub wavelength: f64,
}

/// The part of a surface's relief that is finer than a resolution cell. Lengths are in metres.
///
/// Height variations longer than a cell tilt it and do not spread its paths. The roughness on a
/// drawing, measured over 0.8 mm, therefore says little about `rms_height`.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Relief {
    /// Root mean square height.
    pub rms_height: f64,
    /// Distance ℓ at which the correlation `exp(−d²/ℓ²)` of the heights falls to 1/e. 0 stands for
    /// heights that are uncorrelated between scatterers.
    pub correlation_length: f64,
}

/// The paths of the light from one resolution cell of a camera to one point of the image.
///
/// The sum of both directions splits into a part across the line of sight and one along the normal,
///
/// ```text
/// l_S + l = v + q n,     v ⊥ l,     q = (1 + l_S·l) / n·l
/// ```
///
/// so that a scatterer of height z that is imaged at ξ has the path −v·ξ − qz. With the difference
/// κ of two wave numbers, their fields have the correlation
///
/// ```text
/// |P̂(κ)| = chat(|κ|/κ_t) exp(−κ² σ_L²/2)     κ_t = 4π sin u / (λ |v|),   σ_L = q R_q
/// ```
///
/// The first factor is due to the *tilt* of the cell: for another wavelength the field is displaced
/// across the pupil, as by a motion. In the plane of incidence, both angles positive on one side of
/// the normal, `|v| = |sin θᵢ + sin θₒ| / cos θₒ` and `q = (1 + cos(θᵢ − θₒ)) / cos θₒ`, which is
/// `cos θᵢ + cos θₒ` for θₒ = 0 and for mirror directions only: a height also shifts the image.
///
/// # Validity
///
/// The laws hold for rough surfaces, `σ_L > λ/2`, with many scatterers in a cell and normally
/// distributed heights, without shadows and multiple scattering. The bandwidth must be small
/// compared with the wavelength: the speckle size varies over it, which is neglected. Where neither
/// tilt nor heights decorrelate the wave numbers, contrasts are too large by `0.48 Δλ/λ`, 2 % at 20
/// nm of 450 nm.
///
/// # References
///
/// - G. Parry, *Speckle patterns in partially coherent light*, in *Laser Speckle and Related
///   Phenomena*, ed. J. C. Dainty, 1975.
/// - J. W. Goodman, *Speckle Phenomena in Optics*, 2007, ch. 6.
#[derive(Clone, Debug, PartialEq)]
pub struct ResolutionCell {
    wavelength: f64,
    sin_aperture: f64,
    source: DVec3,
    source_extent: SourceExtent,
    pupil: DVec3,
    normal: DVec3,
    tilt: DVec3,
    height_factor: f64,
    relief: Relief,
    defocus: f64,
}

impl ResolutionCell {
    /// Creates the cell of a surface in focus, without relief.
    ///
    /// # Errors
    ///
    /// Returns an error unless source and pupil lie on the side of the normal,
    /// `0 < sin_aperture ≤ 1` and the wavelength is positive and finite.
    pub fn new(geometry: CellGeometry) -> Result<Self, Refusal> {
        let normal = unit("normal", geometry.normal)?;
        let above = |parameter, value: DVec3| {
            let direction = unit(parameter, value)?;
            let (holds, allowed) = (direction.dot(normal) > 1e-6, "on the side of the normal");
            check::that(holds, parameter, value.to_array(), "", allowed).map(|()| direction)
        };
        let source = above("to_source", geometry.to_source)?;
        let pupil = above("to_pupil", geometry.to_pupil)?;
        let sin_aperture = geometry.sin_aperture;
        let holds = sin_aperture > 0.0 && sin_aperture <= 1.0;
        check::that(
            holds,
            "sin_aperture",
            sin_aperture,
            "",
            "positive and at most 1",
        )?;
        check::range("wavelength", geometry.wavelength, WAVELENGTHS, "m")?;
        let height_factor = (1.0 + source.dot(pupil)) / normal.dot(pupil);
        Ok(Self {
            wavelength: geometry.wavelength,
            sin_aperture,
            source,
            source_extent: SourceExtent::default(),
            pupil,
            normal,
            tilt: source + pupil - height_factor * normal,
            height_factor,
            relief: Relief::default(),
            defocus: 0.0,
        })
    }

    /// Returns the cell of a surface with a relief.
    ///
    /// # Errors
    ///
    /// Returns an error unless both lengths are finite and not negative.
    pub fn with_relief(self, relief: Relief) -> Result<Self, Refusal> {
        check::not_negative("rms_height", relief.rms_height, "m")?;
        check::not_negative("correlation_length", relief.correlation_length, "m")?;
        Ok(Self { relief, ..self })
    }

    /// Returns the cell out of focus, by the distance of the surface from the plane of focus, in
    /// metres, of either sign.
    ///
    /// # Errors
    ///
    /// Returns an error if the distance is not finite.
    pub fn with_defocus(self, defocus: f64) -> Result<Self, Refusal> {
        let defocus = check::finite("defocus", defocus, "m")?;
        Ok(Self { defocus, ..self })
    }

    /// Returns the cell under a source of finite extent.
    ///
    /// ```text
    /// C² = ⟨ ∫ R(κ) chat²(|κ v + k w| / κ_t|v|) exp(−(κ q + k p)² R_q²) dκ ⟩
    ///      over pairs of directions l_S, l_S'
    /// w = δ − p n,   p = δ·l / n·l,   δ = l_S − l_S'
    /// ```
    ///
    /// A change δ of the direction to the source displaces the field across the pupil by w times
    /// the distance of the pupil, as a change of the wave number displaces it by κ v / k, and it
    /// changes the phases of heights. In the plane of incidence `|w| = |δ| cos θᵢ / cos θₒ`, across
    /// it `|w| = |δ|`.
    ///
    /// # Validity
    ///
    /// Light of one direction is coherent over the cell, and light of two different directions is
    /// mutually incoherent.
    ///
    /// # Examples
    ///
    /// A fibre of 0.4 mm at 100 mm, head-on, before a lens of sin u = 0.01:
    ///
    /// ```
    /// use tem00_coherence::{
    ///     CellGeometry, DVec3, PolychromaticSpeckle, ResolutionCell, SourceExtent, Spectrum,
    /// };
    ///
    /// let cell = ResolutionCell::new(CellGeometry {
    ///     to_source: DVec3::Z,
    ///     to_pupil: DVec3::Z,
    ///     normal: DVec3::Z,
    ///     sin_aperture: 0.01,
    ///     wavelength: 650e-9,
    /// })?;
    /// let spectrum = Spectrum::monochromatic(650e-9)?;
    /// let contrast = |half_angle| {
    ///     let cell = cell.clone().with_source_extent(SourceExtent::disc(half_angle)?);
    ///     Ok::<_, tem00_coherence::Refusal>(
    ///         PolychromaticSpeckle::new(&spectrum, &cell)?.contrast()
    ///     )
    /// };
    /// assert!(contrast(0.002)? > 0.85);
    /// assert!(contrast(0.02)? < 0.4);
    /// # Ok::<(), tem00_coherence::Refusal>(())
    /// ```
    ///
    /// # References
    ///
    /// - J. W. Goodman, *Speckle Phenomena in Optics*, 2007, ch. 5 and 6: moving diffusers, many
    ///   lasers.
    #[must_use]
    pub fn with_source_extent(self, source_extent: SourceExtent) -> Self {
        Self {
            source_extent,
            ..self
        }
    }

    /// Returns the extent of the source.
    pub const fn source_extent(&self) -> &SourceExtent {
        &self.source_extent
    }

    /// Returns the relief.
    pub const fn relief(&self) -> Relief {
        self.relief
    }

    /// Returns the tilt v of the cell, across the line of sight, as path per length on the object.
    pub const fn tilt(&self) -> DVec3 {
        self.tilt
    }

    /// Returns the path q per height.
    pub const fn height_factor(&self) -> f64 {
        self.height_factor
    }

    /// Returns the wavelength, in metres.
    pub(crate) const fn wavelength(&self) -> f64 {
        self.wavelength
    }

    /// Returns whether the surface is in focus.
    pub(crate) const fn is_in_focus(&self) -> bool {
        self.defocus == 0.0
    }

    /// Returns the unit vector from the surface to the source.
    pub(crate) const fn source(&self) -> DVec3 {
        self.source
    }

    /// Returns the effects of a change of the unit vector to the source, divided by the wave
    /// number: the displacement of the field across the pupil in pupil diameters, along the tilt
    /// and across it, and the difference of wave numbers that changes the phases of heights by the
    /// same amount. Both are linear in the change.
    pub(crate) fn change_with_source(&self, change: DVec3) -> (DVec2, f64) {
        let height_factor = change.dot(self.pupil) / self.normal.dot(self.pupil);
        let moved = change - height_factor * self.normal;
        let [along, across] = self.axes().map(|axis| moved.dot(axis));
        (
            DVec2::new(along, across) / self.full_displacement(),
            height_factor / self.height_factor,
        )
    }

    /// Returns the largest effect per radian of the direction to the source, divided by the wave
    /// number: on the displacement in pupil diameters, and on the phases of heights and of defocus
    /// in radians.
    pub(crate) fn greatest_change_with_source(&self) -> f64 {
        let height = self.normal.dot(self.pupil).recip();
        let moved = (1.0 + height) / self.full_displacement();
        let blur = (1.0 + height) * self.defocus.abs() * self.sin_aperture;
        moved.max(height * self.relief.rms_height).max(blur)
    }

    /// Two directions perpendicular to the line of sight. The first is the direction of the tilt;
    /// without a tilt it lies in the plane of incidence or, without such a plane, is arbitrary. The
    /// second is perpendicular to it.
    fn axes(&self) -> [DVec3; 2] {
        let across_sight = |v: DVec3| v - v.dot(self.pupil) * self.pupil;
        let along = [self.tilt, self.normal, self.pupil.any_orthonormal_vector()]
            .into_iter()
            .map(across_sight)
            .find(|axis| axis.length() > 1e-9);
        let along = along.unwrap_or(DVec3::X).normalize();
        [along, self.pupil.cross(along)]
    }

    /// Returns the gradient of the phase over the object, in rad/m, that displaces a field by the
    /// diameter of the pupil.
    fn full_displacement(&self) -> f64 {
        2.0 * TAU * self.sin_aperture / self.wavelength
    }

    /// Returns the standard deviation `σ_L` of the paths due to heights, in metres.
    pub fn path_spread(&self) -> f64 {
        self.height_factor * self.relief.rms_height
    }

    /// Returns the difference of wave numbers `κ_t`, in rad/m, by which the tilt displaces the
    /// field by the diameter of the pupil; infinite without a tilt.
    pub fn tilt_wave_number(&self) -> f64 {
        self.full_displacement() / self.tilt.length()
    }

    /// Returns the size of a speckle on the object, `λ / (2 sin u)`, in metres.
    pub fn speckle_size(&self) -> f64 {
        0.5 * self.wavelength / self.sin_aperture
    }

    /// Returns the width in rad/m of the finest feature of
    /// [`field_correlation`](Self::field_correlation).
    pub(crate) fn scale(&self) -> f64 {
        let blur = self.tilt.length() * self.defocus.abs() * self.sin_aperture;
        let tilt = self.tilt_wave_number();
        tilt.min(self.path_spread().recip()).min(2.0 / blur)
    }

    /// Returns the correlation P̂ of the fields of two wave numbers that differ by κ, in rad/m, at
    /// one point of the image, for a relief without correlation length.
    pub fn field_correlation(&self, kappa: f64) -> Complex<f64> {
        let shift = kappa / self.tilt_wave_number();
        self.blur(false).mean(shift, kappa) * self.height_correlation(kappa)
    }

    /// Returns the mean of `|P̂|²`, including the correlation length of the relief.
    ///
    /// ```text
    /// ⟨|P̂|²⟩ = ∬ |h|² |h'|² exp(−κ² σ_L² (1 − ρ) + iκ v·(ξ − ξ'))     h the image of a point
    /// ```
    ///
    /// The correlation length is taken into account in focus and neglected out of focus.
    pub fn squared_correlation(&self, kappa: f64) -> f64 {
        let difference = Difference {
            kappa,
            shift: DVec2::new(kappa / self.tilt_wave_number(), 0.0),
            of_heights: kappa,
        };
        Correlation::new(self, false).squared(difference)
    }

    /// The correlation length of the relief in speckles.
    pub(crate) fn correlation_length(&self) -> f64 {
        self.relief.correlation_length / self.speckle_size()
    }

    /// Returns the contribution of the relief's correlation length to a mean over lags with the
    /// weights of a kernel, with a table if it `is_often` evaluated.
    pub(crate) fn height_excess(&self, kernel: LagKernel, is_often: bool) -> HeightExcess {
        HeightExcess::new(
            kernel,
            [self.correlation_length(), self.path_spread()],
            is_often,
        )
    }

    /// Returns `exp(−κ² σ_L²/2)`.
    pub(crate) fn height_correlation(&self, kappa: f64) -> f64 {
        let exponent = 0.5 * (kappa * self.path_spread()).powi(2);
        // Computing a result that underflows takes long.
        if exponent > 750.0 {
            0.0
        } else {
            (-exponent).exp()
        }
    }

    /// Returns the overlap of the pupil for two parts of the light, with the phases of defocus and
    /// with a table if it `is_often` evaluated.
    fn blur(&self, is_often: bool) -> Blur {
        let half_depth = 0.5 * self.defocus * self.sin_aperture.powi(2);
        // Phase per displacement of a sphere about the plane in focus.
        let linear = 2.0 * half_depth * self.full_displacement() / self.sin_aperture;
        Blur::new([linear, half_depth], is_often)
    }
}

/// Correlation of two parts of the light of a cell, tabulated where many values are needed.
#[derive(Debug)]
pub(crate) struct Correlation<'a> {
    cell: &'a ResolutionCell,
    blur: Blur,
    excess: HeightExcess,
}

impl<'a> Correlation<'a> {
    pub(crate) fn new(cell: &'a ResolutionCell, is_often: bool) -> Self {
        Self {
            cell,
            blur: cell.blur(is_often),
            excess: cell.height_excess(LagKernel::CONTRAST, is_often),
        }
    }

    /// Returns the mean of the squared correlation of two parts of the light.
    pub(crate) fn squared(&self, difference: Difference) -> f64 {
        let shift = difference.shift.length();
        let shared = self.blur.squared(shift, difference.kappa);
        let dense = shared * self.cell.height_correlation(difference.of_heights).powi(2);
        if self.cell.defocus != 0.0 {
            return dense;
        }
        dense + self.excess.at(difference.of_heights, shift)
    }
}

/// Difference of two parts of the light.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Difference {
    /// Difference κ of their wave numbers, in rad/m.
    pub kappa: f64,
    /// Displacement between the positions in the pupil at which their fields are alike, in pupil
    /// diameters, along the tilt and across it.
    pub shift: DVec2,
    /// The difference of wave numbers, in rad/m, that changes the phases of heights by the same
    /// amount.
    pub of_heights: f64,
}

/// Returns the unit vector along a vector, if the vector has a direction.
pub(crate) fn unit(parameter: &'static str, vector: DVec3) -> Result<DVec3, Refusal> {
    let refused = || Refusal::new(parameter, vector.to_array(), "finite and not zero");
    vector.try_normalize().ok_or_else(refused)
}

#[cfg(test)]
mod tests;
