use core::f64::consts::TAU;

use glam::{DVec2, DVec3};

use crate::{
    Configuration, CorrelationLaw, GRAZING_COSINE, ImagingGeometry, rigid_change::leaving,
};

/// Change of the speckle at one surface point between two states, which may be arbitrarily far
/// apart.
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub struct SpeckleMotion {
    /// Motion of the image of the surface, along b1 (right) and b2 (up) of the camera, in metres on
    /// the sensor, upright as shown on a screen. In focus the speckle moves with it.
    ///
    /// A renderer that counts its rows downwards flips the second component.
    pub image_displacement: DVec2,
    /// Additional motion of the speckle of a point out of focus, along b1 and b2, in metres on the
    /// sensor.
    ///
    /// A ray through the pupil point p meets the sensor at the distance `C W p` from the image of
    /// the point, with the defocus W. A speckle field that has moved across the pupil is displaced
    /// in the image by this distance. The displacement is zero for a point in focus, and where the
    /// pattern is decorrelated.
    pub defocus_displacement: DVec2,
    /// Motion of the speckle field across the pupil, along b1 and b2, in metres, or `None` where
    /// the pattern is decorrelated for [`Configuration::pupil_point_after`].
    pub pupil_displacement: Option<DVec2>,
    /// Motion of the surface towards the camera along the optical axis, in metres.
    pub axial_displacement: f64,
    /// Correlation γ of the intensity with the old pattern, in [0, 1], where the pattern is looked
    /// up at the [`speckle_displacement`](Self::speckle_displacement), by
    /// [`CorrelationLaw::AtPeak`].
    pub correlation: f64,
}

/// The law of speckle motion.
impl Configuration {
    /// Returns the point of the pupil to which the speckle field at `pupil_point` has moved after a
    /// change. Both points are along b1 and b2 of the camera in its respective state, in metres
    /// from the centre of the pupil.
    ///
    /// The light of all scatterers of the surface arrives there with the same phase differences as
    /// before. To first order in the distance between scatterers this condition is
    ///
    /// ```text
    /// (R T)ᵀ (l_S' + l') / λ'  =  Tᵀ (l_S + l) / λ
    /// ```
    ///
    /// with the tangents T of the surface, its rotation R, and the unit vectors `l_S` to the source
    /// and l to the pupil point. The law fixes the component of l' along the surface; its unit
    /// length fixes the rest. The line along l' meets the pupil at the wanted point.
    ///
    /// # Validity
    ///
    /// Motions may be arbitrarily large. The law holds at the point itself, for a lit patch that is
    /// small compared with its distances to source and pupil. It does not give the loss of
    /// correlation: see [`SpeckleMotion::between`] and
    /// [`height_phase_change`](Self::height_phase_change).
    ///
    /// Returns `None` where there is no such point and the pattern counts as decorrelated: the
    /// surface is seen edge-on, it is lit from its other side, or the light that would keep its
    /// phases leaves away from the pupil plane or, at too long a wavelength, not at all.
    ///
    /// # Examples
    ///
    /// With twice the wavelength the pattern in the pupil is twice as large about the direction of
    /// specular reflection:
    ///
    /// ```
    /// use tem00_decorrelation::{
    ///     CameraFrame, Configuration, ConfigurationData, DVec2, DVec3, Illumination,
    /// };
    ///
    /// let pupil = DVec3::new(0.0, 0.0, 0.3);
    /// let green = Configuration::new(ConfigurationData {
    ///     wavelength: 532e-9,
    ///     point: DVec3::ZERO,
    ///     normal: DVec3::Z,
    ///     illumination: Illumination::collimated(DVec3::Z)?,
    ///     camera: CameraFrame::look_at(pupil, DVec3::ZERO, DVec3::Y)?,
    ///     pupil,
    /// })?;
    /// let infrared = green.with_wavelength(1064e-9)?;
    ///
    /// let moved = green.pupil_point_after(&infrared, DVec2::new(1e-3, 0.0)).unwrap();
    /// assert!((moved - DVec2::new(2e-3, 0.0)).length() < 1e-7);
    /// # Ok::<(), tem00_decorrelation::Refusal>(())
    /// ```
    ///
    /// # References
    ///
    /// - I. Yamaguchi, *Fringe formations in deformation and vibration measurements using laser
    ///   light*, 1985. It treats the limit of small motions.
    pub fn pupil_point_after(&self, after: &Self, pupil_point: DVec2) -> Option<DVec2> {
        let direction = self.direction_to(pupil_point)?;
        after.pupil_point_along(self.direction_after(after, direction)?)
    }

    /// Returns the change of the phase that a scatterer gains per height above the surface, for the
    /// light to the centre of the pupil, in radians per metre of height.
    ///
    /// ```text
    /// Δq = 2π [n'·(l_S' + l') / λ' − n·(l_S + l) / λ]
    /// ```
    ///
    /// l' is the direction to [the point](Self::pupil_point_after) to which the field at the centre
    /// has moved. Once a look-up follows this motion, the patterns differ only because of the
    /// heights of the surface: the loss is due to roughness, not geometry. Normally distributed
    /// heights with the standard deviation σ leave the factor
    ///
    /// ```text
    /// γ = exp(−σ² Δq²)
    /// ```
    ///
    /// in the intensity, to be multiplied by the correlation of the geometry. It matters mostly
    /// under a change of wavelength or of the direction of illumination; translations and small
    /// rotations change q in second order.
    ///
    /// Returns `None` where `pupil_point_after` does.
    ///
    /// # Examples
    ///
    /// Two modes of a laser diode, 0.3 nm apart, on a surface with a roughness of 3 µm. The loss is
    /// 7 × 10⁻⁴:
    ///
    /// ```
    /// use tem00_decorrelation::{
    ///     CameraFrame, Configuration, ConfigurationData, DVec3, Illumination,
    /// };
    ///
    /// let pupil = DVec3::new(0.0, 0.0, 0.3);
    /// let before = Configuration::new(ConfigurationData {
    ///     wavelength: 650e-9,
    ///     point: DVec3::ZERO,
    ///     normal: DVec3::Z,
    ///     illumination: Illumination::collimated(DVec3::Z)?,
    ///     camera: CameraFrame::look_at(pupil, DVec3::ZERO, DVec3::Y)?,
    ///     pupil,
    /// })?;
    /// let after = before.with_wavelength(650.3e-9)?;
    ///
    /// let change = before.height_phase_change(&after).unwrap(); // −4π Δλ / λ²
    /// assert!((change + 8.92e3).abs() < 0.01e3);
    /// let loss = 1.0 - (-(3e-6 * change).powi(2)).exp();
    /// assert!((loss - 7.2e-4).abs() < 0.1e-4);
    /// # Ok::<(), tem00_decorrelation::Refusal>(())
    /// ```
    ///
    /// # References
    ///
    /// - J. W. Goodman, *Speckle Phenomena in Optics*, 2007. It treats speckle in light of several
    ///   wavelengths.
    pub fn height_phase_change(&self, after: &Self) -> Option<f64> {
        let direction = self.sight.direction();
        let direction_after = self.direction_after(after, direction)?;
        let before = self.normal().dot(self.to_source + direction) / self.wavelength;
        let since = after.normal().dot(after.to_source + direction_after) / after.wavelength;
        let change = TAU * (since - before);
        change.is_finite().then_some(change)
    }

    /// The unit vector from the surface point to a point of the pupil.
    fn direction_to(&self, pupil_point: DVec2) -> Option<DVec3> {
        let camera = self.sight.camera();
        let offset = camera.right() * pupil_point.x + camera.up() * pupil_point.y;
        (self.pupil - self.point + offset).try_normalize()
    }

    /// The direction after the change of the field that left in `direction` before.
    fn direction_after(&self, after: &Self, direction: DVec3) -> Option<DVec3> {
        let side = self.normal().dot(direction);
        let turned =
            after.surface_axes * (self.surface_axes.transpose() * (self.to_source + direction));
        let sum = turned * (after.wavelength / self.wavelength) - after.to_source;
        let (leaves, rest) = leaving(after.normal(), sum, side);
        let lit_side = self.normal().dot(self.to_source) * after.normal().dot(after.to_source);
        // NaN fails every comparison.
        (rest > 0.0 && side.abs() > GRAZING_COSINE && lit_side >= 0.0).then_some(leaves)
    }

    /// The point at which a line from the surface point meets the pupil plane.
    fn pupil_point_along(&self, direction: DVec3) -> Option<DVec2> {
        let camera = self.sight.camera();
        let cosine = direction.dot(camera.towards_camera());
        if cosine <= GRAZING_COSINE {
            return None;
        }
        let from_pupil = direction * (self.sight.depth() / cosine) - (self.pupil - self.point);
        let point = DVec2::new(from_pupil.dot(camera.right()), from_pupil.dot(camera.up()));
        point.is_finite().then_some(point)
    }

    /// Position of the image of the point, along b1 and b2 from the axis, upright, in units of the
    /// principal distance.
    fn tangents(&self) -> DVec2 {
        let (camera, direction) = (self.sight.camera(), self.sight.direction());
        let across = DVec2::new(direction.dot(camera.right()), direction.dot(camera.up()));
        across / -direction.dot(camera.towards_camera())
    }
}

impl SpeckleMotion {
    /// Computes the motion of the speckle between two states of the same surface point.
    ///
    /// ```text
    /// image     C (t' − t)                 t: tangents of the viewing angles
    /// pupil     A = pupil_point_after(0)
    /// defocus   −C A (W + W') / 2          W = 1/Z − 1/L
    /// along     Z − Z'
    /// left      γ of |A| / D and of (W'/λ' − W/λ) D²/8, at the peak
    /// ```
    ///
    /// `geometry` is the imaging geometry of the camera in both states. Its wavelength is ignored;
    /// the wavelengths of the states are used.
    ///
    /// # Validity
    ///
    /// The image displacement and the pupil displacement are exact for the centre of the pupil. The
    /// correlation assumes that the field moves across the pupil as a whole. After a large change
    /// the field also stretches; the error is about the variation of
    /// [`pupil_point_after`](Configuration::pupil_point_after) over the pupil, relative to the
    /// motion of the centre, divided by the pupil diameter.
    ///
    /// The loss of correlation of a *rough surface* under another wavelength or direction of
    /// illumination is not geometric and not included: see
    /// [`height_phase_change`](Configuration::height_phase_change).
    ///
    /// # Examples
    ///
    /// If a camera turns by 1 mrad about its own pupil, the image moves and the speckle moves with
    /// it, unchanged:
    ///
    /// ```
    /// use tem00_decorrelation::{
    ///     CameraFrame, Configuration, ConfigurationData, DVec3, Illumination, ImagingGeometry,
    ///     LensData, RigidMotion, RigidMotions, SpeckleMotion,
    /// };
    ///
    /// let geometry = ImagingGeometry::from_lens(LensData {
    ///     wavelength: 650e-9,
    ///     focal_length: 25e-3,
    ///     f_number: 8.0,
    ///     surface_to_pupil: 0.3,
    ///     pixel_pitch: 3.45e-6,
    /// })?;
    /// let pupil = DVec3::new(0.0, 0.0, 0.3);
    /// let before = Configuration::new(ConfigurationData {
    ///     wavelength: 650e-9,
    ///     point: DVec3::ZERO,
    ///     normal: DVec3::Z,
    ///     illumination: Illumination::collimated(DVec3::new(1.0, 0.0, 1.0))?,
    ///     camera: CameraFrame::look_at(pupil, DVec3::ZERO, DVec3::Y)?,
    ///     pupil,
    /// })?;
    /// let after = before.moved(&RigidMotions {
    ///     camera: RigidMotion::about(pupil, DVec3::Y, 1e-3)?,
    ///     ..RigidMotions::default()
    /// })?;
    ///
    /// let speckle = SpeckleMotion::between(&geometry, &before, &after);
    /// // The camera turns to the left: the picture moves to the right, by 27.3 µm.
    /// assert!((speckle.image_displacement.x - 27.27e-6).abs() < 0.01e-6);
    /// assert!((speckle.correlation - 1.0).abs() < 1e-9);
    /// # Ok::<(), tem00_decorrelation::Refusal>(())
    /// ```
    pub fn between(
        geometry: &ImagingGeometry,
        before: &Configuration,
        after: &Configuration,
    ) -> Self {
        let depths = [before, after].map(|state| state.sight.depth());
        let [w0, w1] = depths.map(|depth| geometry.defocus_at(depth));
        let diameter = geometry.pupil_diameter();
        let axial_shift =
            (w1 / after.wavelength - w0 / before.wavelength) * 0.125 * diameter * diameter;
        let image = (after.tangents() - before.tangents()) * geometry.principal_distance();
        let pupil = before.pupil_point_after(after, DVec2::ZERO);
        let beside = -0.5 * geometry.principal_distance() * (w0 + w1);
        let defocus = pupil.map(|pupil| pupil * beside);
        Self {
            image_displacement: image,
            defocus_displacement: defocus.filter(|v| v.is_finite()).unwrap_or_default(),
            pupil_displacement: pupil,
            axial_displacement: depths[0] - depths[1],
            correlation: pupil.map_or(0.0, |pupil| {
                CorrelationLaw::AtPeak.correlation(pupil.length() / diameter, axial_shift)
            }),
        }
    }

    /// Returns the motion of the speckle pattern in the image, along b1 and b2, in metres on the
    /// sensor: the sum of [`image_displacement`](Self::image_displacement) and
    /// [`defocus_displacement`](Self::defocus_displacement). At this displacement the correlation
    /// of both patterns peaks.
    pub fn speckle_displacement(&self) -> DVec2 {
        self.image_displacement + self.defocus_displacement
    }
}

#[cfg(test)]
mod tests;
