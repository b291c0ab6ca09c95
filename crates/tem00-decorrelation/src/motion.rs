use glam::{DVec2, DVec3};

use crate::{
    DecorrelationError, GRAZING_COSINE, ImagingGeometry, LineOfSight, Wavefront, correlation,
    finite::defocus_displacement,
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

/// Which way up image displacements are counted.
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
        let normal = normal
            .try_normalize()
            .ok_or(DecorrelationError::Normal(normal))?;
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
    /// optical axis, this is eq. (5) of Bergmann et al. 2016 with its sign corrected: see
    /// [`paper::image_displacement`](crate::paper::image_displacement).
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
    /// spherical wave this is the pair of Sjödahl 1995:
    /// see [`paper::pupil_displacement`](crate::paper::pupil_displacement).
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

/// What a motion does to the speckle at one surface point: all that a renderer needs per hit.
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub struct SpeckleMotion {
    /// Motion of the image of the surface, along b1 and b2, in metres on the sensor:
    /// [`SurfacePoint::image_displacement`].
    ///
    /// In focus the speckle moves with it.
    pub image_displacement: DVec2,
    /// What the speckle of a point out of focus moves in addition, along b1 and b2, in metres on the
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
    /// What is left of the old pattern as a correlation of intensity, in [0, 1]:
    /// [`correlation`].
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
            correlation(
                displacement.length() / geometry.pupil_diameter(),
                axial_shift,
            )
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

#[cfg(test)]
mod tests {
    use approx::assert_relative_eq;
    use glam::{DMat2, DMat3};
    use proptest::prelude::*;

    use super::*;
    use crate::{CameraFrame, LensData};

    fn geometry() -> ImagingGeometry {
        ImagingGeometry::from_lens(LensData {
            wavelength: 650e-9,
            focal_length: 25e-3,
            f_number: 8.0,
            surface_to_pupil: 0.3,
            pixel_pitch: 3.45e-6,
        })
        .unwrap()
    }

    /// A camera on +z, 0.3 m from a point at the origin.
    fn point(normal: DVec3, wavefront: Wavefront) -> SurfacePoint {
        let eye = DVec3::new(0.0, 0.0, 0.3);
        let camera = CameraFrame::look_at(eye, DVec3::ZERO, DVec3::Y).unwrap();
        let sight = LineOfSight::new(&camera, eye).unwrap();
        SurfacePoint::new(sight, normal, wavefront).unwrap()
    }

    fn collimated() -> Wavefront {
        Wavefront::plane(DVec3::new(1.0, 0.5, 1.0)).unwrap()
    }

    fn speckle(point: &SurfacePoint, motion: &Motion) -> SpeckleMotion {
        SpeckleMotion::new(&geometry(), point, motion, ImageOrientation::ScreenUpright)
    }

    /// The 2×2 system as it comes from the stationary phase, T[K + (I − l lᵀ)/d] a =
    /// T(I − l lᵀ)A/d with T = (n1, n2), for motions of the surface alone.
    fn pupil_displacement_by_solving(point: &SurfacePoint, a: DVec3) -> DVec2 {
        let (l, d) = (point.sight().direction(), point.sight().distance());
        let camera = point.sight().camera();
        let (n1, n2) = point.normal().any_orthonormal_pair();
        let across = |v: DVec3| (v - l * l.dot(v)) / d;
        let tangential = |v: DVec3| DVec2::new(n1.dot(v), n2.dot(v));
        let matrix = DMat2::from_cols(
            tangential(across(camera.right())),
            tangential(across(camera.up())),
        );
        matrix.inverse() * tangential(point.wavefront().curvature() * a + across(a))
    }

    #[test]
    fn motion_of_the_surface_shows_the_right_way_round() {
        let point = point(DVec3::Z, collimated());
        let motion = Motion {
            surface: DVec3::new(0.25e-3, -0.1e-3, 0.0),
            ..Motion::default()
        };
        let screen = speckle(&point, &motion).image_displacement;
        // m = f / (L − f) = 1/11.
        let expected = DVec2::new(0.25e-3, -0.1e-3) / 11.0;
        assert!((screen - expected).length() < 1e-18, "screen {screen}");
        let sensor =
            point.image_displacement(&geometry(), &motion, ImageOrientation::SensorInverted);
        assert!((sensor + expected).length() < 1e-18, "sensor {sensor}");
    }

    #[test]
    fn camera_motion_is_surface_motion_the_other_way_in_collimated_light() {
        let tilted = point(DVec3::new(0.5, -0.3, 1.0), collimated());
        let step = DVec3::new(0.4e-3, 0.2e-3, -0.3e-3);
        let by_camera = Motion {
            camera: -step,
            ..Motion::default()
        };
        let by_surface = Motion {
            surface: step,
            ..Motion::default()
        };
        let (camera, surface) = (speckle(&tilted, &by_camera), speckle(&tilted, &by_surface));
        assert_eq!(camera, surface, "only a − c counts, exactly");
        assert!(
            surface.correlation < 0.9,
            "the test would see nothing: {surface:?}"
        );
        assert_relative_eq!(surface.axial_displacement, -0.3e-3, max_relative = 1e-14);
    }

    #[test]
    fn camera_in_curved_light_keeps_what_the_surface_does_not() {
        // Moving the camera with the surface leaves the motion of the surface through the wave:
        // d K a, here with d = 0.3 m and 1/R = 5/m.
        let lit = point(DVec3::Z, Wavefront::spherical(DVec3::Z, 5.0).unwrap());
        let step = DVec3::new(0.1e-3, 0.2e-3, 0.0);
        let together = Motion {
            surface: step,
            camera: step,
            ..Motion::default()
        };
        let displacement = lit.pupil_displacement(&together).unwrap();
        let expected = step.truncate() * (0.3 * 5.0);
        assert!(
            (displacement - expected).length() < 1e-18,
            "{displacement} instead of {expected}"
        );
        let moved = speckle(&lit, &together);
        assert_eq!(moved.image_displacement, DVec2::ZERO, "the image stands");
    }

    #[test]
    fn correlation_is_that_of_pupil_and_axial_displacement() {
        let motion = Motion {
            surface: DVec3::new(0.78125e-3, 0.0, 12e-3),
            ..Motion::default()
        };
        let moved = speckle(&point(DVec3::Z, collimated()), &motion);
        // A quarter of the pupil of 3.125 mm, and 12 mm of 8 λ (L/D)² = 8 · 650 nm · 96².
        let chat = 0.685_037_642_474_293_f64;
        let x = 12e-3 / (8.0 * 650e-9 * 96.0 * 96.0) * core::f64::consts::PI;
        let expected = chat * chat * (x.sin() / x).powi(2);
        assert_relative_eq!(moved.correlation, expected, max_relative = 1e-13);
    }

    #[test]
    fn grazing_view_in_curved_light_is_decorrelated() {
        let spherical = Wavefront::spherical(DVec3::new(1.0, 0.2, 1.0), 5.0).unwrap();
        let motion = Motion {
            surface: DVec3::new(1e-6, 1e-6, 0.0),
            ..Motion::default()
        };
        // Edge-on exactly, and closer to it than rounding can tell.
        for normal in [DVec3::Y, DVec3::new(0.0, 1.0, 1e-9)] {
            let moved = speckle(&point(normal, spherical), &motion);
            assert_eq!(moved.pupil_displacement, None, "{normal}: {moved:?}");
            assert!(moved.correlation == 0.0, "{normal}: {moved:?}");
        }
        let edge_on = point(DVec3::Y, spherical);
        // At rest, or in collimated light, there is nothing to amplify.
        let still = speckle(&edge_on, &Motion::default());
        assert!((still.correlation - 1.0).abs() < 1e-15, "{still:?}");
        let plane = speckle(&point(DVec3::Y, collimated()), &motion);
        assert!(plane.correlation > 0.99, "{plane:?}");
    }

    #[test]
    fn results_can_cross_threads() {
        const fn crosses_threads<T: Send + Sync>() {}
        crosses_threads::<SpeckleMotion>();
        crosses_threads::<SurfacePoint>();
        crosses_threads::<ImagingGeometry>();
    }

    #[test]
    fn invalid_normals_are_rejected() {
        let sight = *point(DVec3::Z, collimated()).sight();
        for bad in [
            DVec3::ZERO,
            DVec3::splat(f64::NAN),
            DVec3::splat(f64::INFINITY),
        ] {
            let result = SurfacePoint::new(sight, bad, collimated());
            assert!(
                matches!(result, Err(DecorrelationError::Normal(_))),
                "{bad}: {result:?}"
            );
        }
    }

    fn vectors(size: f64) -> impl Strategy<Value = DVec3> {
        [-size..size, -size..size, -size..size].prop_map(DVec3::from_array)
    }

    fn directions() -> impl Strategy<Value = DVec3> {
        vectors(1.0).prop_filter("a direction", |v| v.length() > 1e-3)
    }

    prop_compose! {
        /// Any camera, a line of sight up to 60° off its axis, any normal and astigmatic light.
        fn points()(
            angles in [-3.0_f64..3.0, -1.5..1.5, -3.0..3.0],
            field in [-1.2_f64..1.2, -1.2..1.2],
            distance in 0.05_f64..5.0,
            normal in directions(),
            to_source in directions(),
            curvatures in [-20.0_f64..20.0, -20.0..20.0],
        ) -> SurfacePoint {
            let [yaw, pitch, roll] = angles;
            let axes = DMat3::from_euler(glam::EulerRot::YXZ, yaw, pitch, roll);
            let camera = CameraFrame::from_axes(axes).unwrap();
            let sight = axes * DVec3::new(field[0], field[1], 1.0) * distance;
            let sight = LineOfSight::new(&camera, sight).unwrap();
            let axis = to_source.any_orthogonal_vector();
            let wave = Wavefront::astigmatic(to_source, axis, curvatures[0], curvatures[1]);
            SurfacePoint::new(sight, normal, wave.unwrap()).unwrap()
        }
    }

    proptest! {
        #[test]
        fn moving_everything_together_changes_nothing(
            point in points(),
            step in vectors(1e-2),
        ) {
            let motion = Motion { surface: step, camera: step, source: step };
            prop_assert_eq!(speckle(&point, &motion), speckle(&point, &Motion::default()));
            prop_assert!((speckle(&point, &motion).correlation - 1.0).abs() < 1e-15);
        }

        #[test]
        fn closed_form_solves_the_stationary_phase_equations(
            point in points(),
            a in vectors(1e-3),
        ) {
            let cosine = point.normal().dot(point.sight().direction()).abs();
            prop_assume!(cosine > 1e-2);
            let motion = Motion { surface: a, ..Motion::default() };
            let closed = point.pupil_displacement(&motion).unwrap();
            let solved = pupil_displacement_by_solving(&point, a);
            // The matrix has the determinant (n·l)(l·b3)/d² with l·b3 > 0.5; terms up to 100 |a|
            // round at ε and are amplified by its inverse.
            let tolerance = 1e4 * f64::EPSILON * a.length() / (cosine * cosine);
            prop_assert!((closed - solved).length() <= tolerance, "{} vs {}", closed, solved);
        }

        #[test]
        fn normal_may_have_any_length_and_side(point in points(), a in vectors(1e-3)) {
            let cosine = point.normal().dot(point.sight().direction()).abs();
            prop_assume!(cosine > 1e-2);
            let normal = point.normal() * -3.0;
            let other = SurfacePoint::new(*point.sight(), normal, *point.wavefront()).unwrap();
            let motion = Motion { surface: a, ..Motion::default() };
            let one = point.pupil_displacement(&motion).unwrap();
            let two = other.pupil_displacement(&motion).unwrap();
            // The unit normals differ by rounding, which k·n/(n·l) amplifies; terms up to 100 |a|.
            let tolerance = 1e4 * f64::EPSILON * a.length() / (cosine * cosine);
            prop_assert!((one - two).length() <= tolerance, "{} vs {}", one, two);
        }

        #[test]
        fn no_motion_yields_anything_but_numbers(
            point in points(),
            exponent in prop_oneof![-300.0_f64..300.0, 303.0..307.0],
            directions in [vectors(1.0), vectors(1.0), vectors(1.0)],
        ) {
            let size = 10.0_f64.powf(exponent);
            let [surface, camera, source] = directions.map(|v| v * size);
            let moved = speckle(&point, &Motion { surface, camera, source });
            prop_assert!((0.0..=1.0).contains(&moved.correlation), "{:?}", moved);
            prop_assert!(moved.image_displacement.is_finite(), "{:?}", moved);
            prop_assert!(moved.pupil_displacement.is_none_or(DVec2::is_finite), "{:?}", moved);
        }
    }
}
