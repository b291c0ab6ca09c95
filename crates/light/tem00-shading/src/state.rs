use glam::{DVec2, DVec3};
use tem00_camera::{Camera, Ray};
use tem00_decorrelation::{CameraFrame, Illumination, ImagingGeometry, RigidChange, RigidMotions};

use crate::{
    Laser, LightPath, Motion, Perspective, Pose, SeenPoint, ShadingError, SpeckleLaw, SpeckleShift,
    SpectralLaw,
};

/// Body, camera and laser in the current frame and in the reference state.
#[derive(Clone, Debug)]
pub(crate) struct State {
    pub(crate) motion: Motion,
    change: RigidChange,
    camera: Camera,
    /// The laser in the reference state and in the current frame.
    lasers: [Laser; 2],
    perspective: Perspective,
}

/// A point in the reference state, and the path of the pupil over its speckle in some frame.
///
/// It distinguishes motions to the two sides of the reference.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct ReferencePoint {
    position: DVec3,
    normal: DVec3,
    pupil_path: DVec3,
}

impl ReferencePoint {
    /// Returns the path of the pupil across the line of sight, to the right and up.
    pub(crate) fn pupil_path_across(&self) -> DVec2 {
        self.pupil_path.truncate()
    }
}

/// Number of rays along each dimension of the laser's light, and of the image, with which points
/// are found.
const RAYS: u32 = 6;

impl State {
    /// Moves a camera and a laser from their reference state.
    pub(crate) fn new(
        (camera, laser): (&Camera, &Laser),
        motion: &Motion,
    ) -> Result<Self, ShadingError> {
        let motions = RigidMotions {
            surface: motion.surface,
            camera: motion.camera,
            source: Pose::IDENTITY,
        };
        let axes = CameraFrame::from_axes(camera.axes())?;
        let moved = camera.moved(&motion.camera);
        Ok(Self {
            motion: *motion,
            change: RigidChange::new(axes, camera.position(), &motions)?,
            lasers: [laser.clone(), laser.moved(&motion.laser)],
            perspective: Perspective::new(moved),
            camera: moved,
        })
    }

    pub(crate) const fn perspective(&self) -> &Perspective {
        &self.perspective
    }

    /// Returns a point with its image point, if the point lies before the lens.
    pub(crate) fn seen(&self, position: DVec3, normal: DVec3) -> Option<SeenPoint> {
        let pixel = self.camera.project(position)?;
        Some(SeenPoint {
            pixel,
            position,
            // Normals that a host interpolates are too short.
            normal: normal.normalize_or_zero(),
        })
    }

    /// Writes the change of the speckle at points, `None` where the law has no value.
    pub(crate) fn shifts(
        &self,
        geometry: &ImagingGeometry,
        points: impl IntoIterator<Item = SeenPoint>,
        shifts: &mut [Option<SpeckleShift>],
    ) {
        if self.motion.is_still() {
            shifts.fill(Some(SpeckleShift::default()));
            return;
        }
        self.law(geometry).shifts(LightPath::Direct, points, shifts);
    }

    const fn law<'a>(&'a self, geometry: &'a ImagingGeometry) -> SpeckleLaw<'a> {
        let [before, now] = &self.lasers;
        SpeckleLaw {
            change: &self.change,
            lasers: [before, now],
            perspective: &self.perspective,
            geometry,
        }
    }

    /// Returns the change of the speckle of a point in light that is given in the reference state
    /// and moves with the laser.
    pub(crate) fn shift_under(
        &self,
        light: &Illumination,
        geometry: &ImagingGeometry,
        point: SeenPoint,
    ) -> Option<SpeckleShift> {
        let before = light.direction_from(self.change.origin(point.position))?;
        let now = light.moved(&self.motion.laser);
        let to_source = [before, now.direction_from(point.position)?];
        self.law(geometry).shift_under(to_source, point)
    }

    /// Returns the law by which speckle changes with the wave number in the current frame.
    pub(crate) const fn spectral_law<'a>(
        &'a self,
        geometry: &'a ImagingGeometry,
    ) -> SpectralLaw<'a> {
        let [_, now] = &self.lasers;
        SpectralLaw {
            laser: now,
            perspective: &self.perspective,
            geometry,
        }
    }

    fn shift(&self, geometry: &ImagingGeometry, point: SeenPoint) -> Option<SpeckleShift> {
        let mut shift = [None];
        self.shifts(geometry, [point], &mut shift);
        shift[0]
    }

    /// Returns the position of a point in the reference state, with the path of the pupil over its
    /// speckle.
    pub(crate) fn reference_point(&self, point: &SeenPoint, pupil_path: DVec3) -> ReferencePoint {
        let back = self.motion.surface.inverse();
        ReferencePoint {
            position: back.point(point.position),
            normal: back.direction(point.normal),
            pupil_path,
        }
    }

    /// Returns the side of the reference on which the speckle is: 1 if the pupil has moved over the
    /// speckle in the same direction as in the frame of the largest motion, and −1 if it has moved
    /// in the opposite direction.
    pub(crate) fn side(
        &self,
        geometry: &ImagingGeometry,
        farthest: Option<&ReferencePoint>,
    ) -> f64 {
        let along = farthest.and_then(|farthest| {
            let surface = &self.motion.surface;
            let (position, normal) = (farthest.position, farthest.normal);
            let point = self.seen(surface.point(position), surface.direction(normal))?;
            Some(
                self.shift(geometry, point)?
                    .pupil_path()
                    .dot(farthest.pupil_path),
            )
        });
        if along.is_some_and(|along| along < 0.0) {
            -1.0
        } else {
            1.0
        }
    }

    /// Returns points that the camera sees in the current frame, with the change of their speckle:
    /// the points given in the reference state or, without any, points of the plane in focus.
    pub(crate) fn scouted(
        &self,
        geometry: &ImagingGeometry,
        given: &[(DVec3, DVec3)],
    ) -> Vec<(SeenPoint, SpeckleShift)> {
        let surface = &self.motion.surface;
        let carried = given
            .iter()
            .map(|&(point, normal)| (surface.point(point), surface.direction(normal)));
        let points: Vec<_> = match given.is_empty() {
            true => self.in_focus(),
            false => carried.collect(),
        };
        let seen = points.into_iter();
        let seen = seen.filter_map(|(point, normal)| self.seen(point, normal));
        let seen: Vec<_> = seen.filter(|point| self.is_in_image(point.pixel)).collect();
        let mut shifts = vec![None; seen.len()];
        self.shifts(geometry, seen.iter().copied(), &mut shifts);
        let found = seen.into_iter().zip(shifts);
        found
            .filter_map(|(point, shift)| Some((point, shift?)))
            .collect()
    }

    fn is_in_image(&self, pixel: DVec2) -> bool {
        pixel.cmpge(DVec2::ZERO).all() && pixel.cmple(self.size()).all()
    }

    fn size(&self) -> DVec2 {
        DVec2::new(self.camera.width() as f64, self.camera.height() as f64)
    }

    /// Points in the image and in focus, with normals towards the camera, the laser and between
    /// both. They lie where rays of the laser meet the plane in focus or, if no ray does within the
    /// image, as for a line much wider than the image, all over the image.
    fn in_focus(&self) -> Vec<(DVec3, DVec3)> {
        let (origin, normal) = self.camera.plane_in_focus();
        let meet = |ray: Ray| {
            let distance = (origin - ray.origin).dot(normal) / ray.direction.dot(normal);
            let point = ray.origin + distance * ray.direction;
            (distance > 0.0 && point.is_finite()).then_some(point)
        };
        let fractions = |index: u32| {
            [0, 1, 2, 3].map(|i| (f64::from(index / RAYS.pow(i) % RAYS) + 0.5) / f64::from(RAYS))
        };
        let [_, laser] = &self.lasers;
        let lit = (0..RAYS.pow(4)).filter_map(|index| meet(laser.sample_ray(fractions(index)).ray));
        let in_image = |point: &DVec3| {
            let pixel = self.camera.project(*point);
            pixel.is_some_and(|pixel| self.is_in_image(pixel))
        };
        let mut points: Vec<_> = lit.filter(in_image).collect();
        if points.is_empty() {
            let pixels = (0..RAYS.pow(2)).map(|index| {
                let [x, y, ..] = fractions(index);
                DVec2::new(x, y) * self.size()
            });
            points.extend(pixels.filter_map(|pixel| meet(self.camera.ray(pixel))));
        }
        let facing = |point: DVec3| {
            let to_camera = (self.camera.position() - point).normalize_or_zero();
            let to_laser = laser.wave_direction_at(point);
            let between = (to_camera + to_laser).normalize_or_zero();
            [to_camera, to_laser, between].map(|normal| (point, normal))
        };
        points.into_iter().flat_map(facing).collect()
    }
}
