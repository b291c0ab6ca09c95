use glam::{DVec2, DVec3};

use crate::{
    CorrelationLaw, DecorrelationError, GRAZING_COSINE, ImagingGeometry, LineOfSight, Wavefront,
};

/// Small translations since the reference state, in world coordinates and metres.
///
/// The reference state is the configuration whose pattern is known: the first frame of a sequence.
///
/// ```text
///   source ☼ ──▶ s                ┃ ──▶ c   pupil of the camera
///            ╲                    ┃
///         l_S ╲                   │ l
///              ╲                  │
///   ════════════●═════════════════●═══════ ──▶ a   surface
/// ```
///
/// Only differences count. The camera sees the point move by `surface − camera`, and the point
/// moves by `surface − source` through the wave that lights it. If all three move together, nothing
/// changes.
///
/// # Validity
///
/// The theory is of first order. Its relative error is about the motion divided by the distance to
/// the pupil or by the radius of the wavefront, whichever is the shorter.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Motion {
    /// Translation `a` of the surface, in metres.
    pub surface: DVec3,
    /// Translation `c` of the camera, in metres.
    pub camera: DVec3,
    /// Translation `s` of the light source and its wavefront, in metres.
    pub source: DVec3,
}

impl Motion {
    /// Returns `a − c`, how far the camera sees the surface move, in metres.
    pub fn surface_seen_by_camera(&self) -> DVec3 {
        self.surface - self.camera
    }

    /// Returns `a − s`, how far the surface moves through the illumination, in metres.
    pub fn surface_within_illumination(&self) -> DVec3 {
        self.surface - self.source
    }
}

/// Orientation in which image displacements are counted.
///
/// Either way the axes are b1 and b2 of the camera: to the right and *upwards*. A renderer that
/// counts its rows downwards flips the second component.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum ImageOrientation {
    /// The picture as shown on a screen: what moves to the right in the scene moves to the right.
    ScreenUpright,
    /// The picture on the sensor behind the lens, upside down and mirrored, as in eq. (5) of
    /// Bergmann et al. 2016.
    SensorInverted,
}

impl ImageOrientation {
    pub(crate) fn of_upright(self, displacement: DVec2) -> DVec2 {
        match self {
            Self::ScreenUpright => displacement,
            Self::SensorInverted => -displacement,
        }
    }
}

/// A point of a rough surface, as the camera sees it and as the laser lights it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SurfacePoint {
    sight: LineOfSight,
    normal: DVec3,
    wavefront: Wavefront,
}

impl SurfacePoint {
    /// Creates a surface point from the line of sight to it, its normal and the light on it.
    ///
    /// The normal may have any length and point to either side.
    ///
    /// # Errors
    ///
    /// Returns an error if the normal is zero or not finite.
    pub fn new(
        sight: LineOfSight,
        normal: DVec3,
        wavefront: Wavefront,
    ) -> Result<Self, DecorrelationError> {
        let normal = normal.try_normalize().ok_or(DecorrelationError::vector(
            "normal",
            normal,
            "finite and not zero",
        ))?;
        Ok(Self {
            sight,
            normal,
            wavefront,
        })
    }

    /// Returns the line of sight to the point.
    pub const fn sight(&self) -> &LineOfSight {
        &self.sight
    }

    /// Returns the unit normal `n` of the surface.
    pub const fn normal(&self) -> DVec3 {
        self.normal
    }

    /// Returns the light on the point.
    pub const fn wavefront(&self) -> &Wavefront {
        &self.wavefront
    }

    /// Returns how far the speckle moves in the image, along b1 and b2, in metres on the sensor.
    ///
    /// In focus the speckle moves with the image of the surface:
    ///
    /// ```text
    /// a_I = ± (C / Z) Π (a − c)        + screen upright, − sensor inverted
    /// ```
    ///
    /// Π is [`LineOfSight::project`], Z the [depth](LineOfSight::depth) of the point and C the
    /// [principal distance](ImagingGeometry::principal_distance) of the camera. On the
    /// optical axis, this is eq. (5) of Bergmann et al. 2016 with the sign of sin q₁ in its
    /// first row corrected: as printed, motion along the normal goes the wrong way at 30°.
    pub fn image_displacement(
        &self,
        geometry: &ImagingGeometry,
        motion: &Motion,
        orientation: ImageOrientation,
    ) -> DVec2 {
        let magnification = geometry.principal_distance() / self.sight.depth();
        orientation.of_upright(self.sight.project(motion.surface_seen_by_camera()) * magnification)
    }

    /// Returns how far the speckle field moves across the pupil, along b1 and b2, in metres.
    ///
    /// The light that arrives in phase at the pupil point A after the motion is that which arrived
    /// at the centre before it:
    ///
    /// ```text
    /// k   = K (a − s)                                  turn of the illumination
    /// a_P = Π [(a − c) + d (k − n (k·l)/(n·l))]
    /// ```
    ///
    /// with the curvature K of the wavefront, the normal n, the line of sight l, its length d and
    /// the projection Π onto the pupil plane. For a line of sight along the optical axis and a
    /// spherical wave this is the pair of Sjödahl 1995.
    ///
    /// Returns `None` where the surface is seen edge-on under a curved wave: the speckle then
    /// rushes across the pupil, and the pattern counts as decorrelated.
    ///
    /// # Examples
    ///
    /// A point source at the distance of the camera doubles the motion of the speckle:
    ///
    /// ```
    /// use tem00_decorrelation::{CameraFrame, DVec3, LineOfSight, Motion, SurfacePoint, Wavefront};
    ///
    /// let eye = DVec3::new(0.0, 0.0, 0.2);
    /// let camera = CameraFrame::look_at(eye, DVec3::ZERO, DVec3::Y)?;
    /// let sight = LineOfSight::new(&camera, eye)?;
    /// let wave = Wavefront::spherical(DVec3::Z, 1.0 / 0.2)?;
    /// let point = SurfacePoint::new(sight, DVec3::Z, wave)?;
    ///
    /// let motion = Motion { surface: DVec3::new(1e-3, 0.0, 0.0), ..Motion::default() };
    /// let displacement = point.pupil_displacement(&motion).unwrap();
    /// assert!((displacement.x - 2e-3).abs() < 1e-15);
    /// # Ok::<(), tem00_decorrelation::DecorrelationError>(())
    /// ```
    pub fn pupil_displacement(&self, motion: &Motion) -> Option<DVec2> {
        let turn = self.wavefront.curvature() * motion.surface_within_illumination();
        let leverage = self.along_normal_onto_sight(turn)? * self.sight.distance();
        let displacement = self
            .sight
            .project(motion.surface_seen_by_camera() + leverage);
        displacement.is_finite().then_some(displacement)
    }

    /// Projects `turn` along the normal onto the plane across the line of sight: the scatterers of
    /// a surface respond only to what lies in the surface.
    fn along_normal_onto_sight(&self, turn: DVec3) -> Option<DVec3> {
        let (n, l) = (self.normal, self.sight.direction());
        let along = turn.dot(l);
        if along == 0.0 {
            return Some(turn);
        }
        let cosine = n.dot(l);
        (cosine.abs() > GRAZING_COSINE).then(|| turn - n * (along / cosine))
    }
}

/// Change of the speckle by a motion at one surface point: all that a renderer needs per hit.
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub struct SpeckleMotion {
    /// Motion of the image of the surface, along b1 and b2, in metres on the sensor:
    /// [`SurfacePoint::image_displacement`].
    ///
    /// In focus the speckle moves with it.
    pub image_displacement: DVec2,
    /// Additional motion of the speckle of a point out of focus, along b1 and b2, in metres on the
    /// sensor.
    ///
    /// ```text
    /// ∓ C W a_P,    W = 1/Z − 1/L        − screen upright, + sensor inverted
    /// ```
    ///
    /// A ray through the pupil point p meets the sensor `C W p` beside the image of the point. The
    /// speckle field that has moved across the pupil by `a_P` is therefore found that much farther
    /// in the image. Zero for a point in focus, and where the pattern is decorrelated.
    pub defocus_displacement: DVec2,
    /// Motion of the speckle field across the pupil, along b1 and b2, in metres, or `None` if it
    /// left the pupil in a grazing view: [`SurfacePoint::pupil_displacement`].
    pub pupil_displacement: Option<DVec2>,
    /// Motion of the surface towards the camera along the optical axis, `(a − c)·b3`, in metres.
    pub axial_displacement: f64,
    /// Correlation of the intensity with the old pattern, in [0, 1], where the pattern is
    /// looked up at the [`speckle_displacement`](Self::speckle_displacement).
    ///
    /// That displacement decides on the [`CorrelationLaw`]: it is
    /// [`AtImageDisplacement`](CorrelationLaw::AtImageDisplacement) in [`new`](Self::new), which keeps
    /// the defocus of the reference state, and [`AtPeak`](CorrelationLaw::AtPeak) in
    /// [`between`](Self::between), which takes the mean of both states.
    pub correlation: f64,
}

impl SpeckleMotion {
    /// Returns the motion of the speckle pattern in the image, along b1 and b2, in metres on the
    /// sensor: the sum of [`image_displacement`](Self::image_displacement) and
    /// [`defocus_displacement`](Self::defocus_displacement).
    pub fn speckle_displacement(&self) -> DVec2 {
        self.image_displacement + self.defocus_displacement
    }

    /// Computes the motion of the speckle at `point` since the reference state.
    ///
    /// `geometry` is that of the camera, for the distance in focus; the point may lie nearer or
    /// farther and brings its own depth.
    ///
    /// # Validity
    ///
    /// At first order. The defocus is that of the reference state: its change by the motion matters
    /// at second order, which [`between`](Self::between) takes in.
    pub fn new(
        geometry: &ImagingGeometry,
        point: &SurfacePoint,
        motion: &Motion,
        orientation: ImageOrientation,
    ) -> Self {
        let sight = point.sight();
        let seen = motion.surface_seen_by_camera();
        let axial_displacement = seen.dot(sight.camera().towards_camera());
        let axial_shift =
            axial_displacement / geometry.axial_decorrelation_length_at(sight.depth());
        let pupil_displacement = point.pupil_displacement(motion);
        let correlation = pupil_displacement.map_or(0.0, |displacement| {
            let pupil_shift = displacement.length() / geometry.pupil_diameter();
            CorrelationLaw::AtImageDisplacement.correlation(pupil_shift, axial_shift)
        });
        let defocus = geometry.defocus_at(sight.depth());
        let defocus = defocus_displacement(geometry, defocus, pupil_displacement);
        Self {
            image_displacement: point.image_displacement(geometry, motion, orientation),
            defocus_displacement: orientation.of_upright(defocus),
            pupil_displacement,
            axial_displacement,
            correlation,
        }
    }
}

/// `−C W A`, upright: the displacement in the image for one in the pupil at the defocus W.
pub(crate) fn defocus_displacement(
    geometry: &ImagingGeometry,
    defocus: f64,
    pupil_displacement: Option<DVec2>,
) -> DVec2 {
    let displacement = pupil_displacement.unwrap_or(DVec2::ZERO);
    let shift = displacement * (-geometry.principal_distance() * defocus);
    if shift.is_finite() {
        shift
    } else {
        DVec2::ZERO
    }
}

#[cfg(test)]
mod tests;
