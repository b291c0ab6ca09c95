use glam::{DVec2, DVec3};
use tem00_camera::Camera;
use tem00_decorrelation::{CameraFrame, ImagingGeometry, RigidChange, RigidMotion, RigidMotions};
use tem00_shading::{LightPath, Perspective, SpeckleLaw, SpeckleShift, SpectralLaw};
use tem00_tracer::{Laser, Scene};

use super::SpecklePoint;

/// Motion of the scene between the reference frame and another.
#[derive(Clone, Debug)]
pub(crate) struct Change {
    /// The number of frames since the reference frame, negative before it.
    frames: f64,
    /// The camera in the reference frame and now.
    cameras: [Camera; 2],
    perspective: Perspective,
    camera: BodyChange,
    lasers: Vec<LaserChange>,
    surfaces: Vec<BodyChange>,
    /// The law for the points of each surface.
    laws: Vec<RigidChange>,
}

/// The motion of a body from the reference frame to now, and back.
#[derive(Clone, Debug)]
struct BodyChange {
    forth: RigidMotion,
    back: RigidMotion,
    moved: bool,
}

/// A laser in the reference frame and now.
#[derive(Clone, Debug)]
struct LaserChange {
    before: Laser,
    now: Laser,
    moved: bool,
}

/// A point of a surface over whose speckle the pupil has moved.
///
/// It distinguishes motion to one side of the reference frame from motion to the other side.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct ReferencePoint {
    surface: usize,
    /// The image point where it was seen, in pixels.
    pixel: DVec2,
    /// Its position in the reference frame, in metres.
    position: DVec3,
    /// Its unit normal there.
    normal: DVec3,
    /// The displacement of the pupil over its speckle.
    pupil_path: DVec3,
}

/// Returns whether anything that matters to speckle moves.
pub(crate) fn moves(scene: &Scene) -> bool {
    let mut lasers = 0..scene.lasers.len();
    lasers.any(|laser| (0..scene.surfaces.len()).any(|surface| scene.speckle_moves(laser, surface)))
}

impl BodyChange {
    fn between(before: RigidMotion, now: RigidMotion) -> Self {
        let forth = before.inverse().then(&now);
        Self {
            forth,
            back: forth.inverse(),
            moved: before != now,
        }
    }
}

impl Change {
    /// Finds the motion since the reference frame of a render.
    pub(crate) fn new(scene: &Scene, frame: u32) -> Self {
        Self::between(scene, [scene.reference_frame, frame])
    }

    /// Finds the motion from one frame, which is the reference, to another.
    pub(super) fn between(scene: &Scene, [reference, frame]: [u32; 2]) -> Self {
        let body = |trajectory: &tem00_tracer::Trajectory| {
            BodyChange::between(trajectory.pose_at(reference), trajectory.pose_at(frame))
        };
        let laser = |(index, laser): (usize, &Laser)| LaserChange {
            before: scene.laser_at(index, reference),
            now: scene.laser_at(index, frame),
            moved: laser.trajectory().pose_at(reference) != laser.trajectory().pose_at(frame),
        };
        let axes = CameraFrame::from_axes(scene.camera_at(reference).axes()).ok();
        let camera = body(&scene.camera_trajectory);
        let surfaces: Vec<_> = scene.surfaces.iter().map(|s| body(&s.trajectory)).collect();
        let law = |surface: &BodyChange| {
            let motions = RigidMotions {
                surface: surface.forth,
                camera: camera.forth,
                source: RigidMotion::IDENTITY,
            };
            RigidChange::new(axes?, scene.camera_at(reference).position(), &motions).ok()
        };
        Self {
            laws: surfaces.iter().map_while(law).collect(),
            frames: f64::from(frame) - f64::from(reference),
            cameras: [scene.camera_at(reference), scene.camera_at(frame)],
            perspective: Perspective::new(scene.camera_at(frame)),
            camera,
            lasers: scene.lasers.iter().enumerate().map(laser).collect(),
            surfaces,
        }
    }

    /// Returns whether the current frame is the reference frame.
    pub(super) fn is_reference(&self) -> bool {
        self.frames == 0.0
    }

    /// Returns the camera in the current frame.
    pub(crate) const fn camera(&self) -> &Camera {
        &self.cameras[1]
    }

    /// Returns the image of the camera in perspective.
    pub(super) const fn perspective(&self) -> &Perspective {
        &self.perspective
    }

    /// Returns laser `index` in the current frame.
    pub(crate) fn laser(&self, index: usize) -> &Laser {
        &self.lasers[index].now
    }

    /// Returns the side of the reference frame on which the current frame is, for the speckle of a
    /// laser on the surface of a reference point: 1 if the pupil has moved over its speckle in the
    /// direction of the largest displacement, and −1 if it has moved the other way.
    ///
    /// Without a reference point, or where the theory has no value, −1 means before the reference
    /// frame.
    pub(super) fn side(
        &self,
        laser: usize,
        geometry: &ImagingGeometry,
        reference_point: Option<&ReferencePoint>,
    ) -> f64 {
        let along = reference_point.and_then(|reference_point| {
            let point = self.carried(reference_point)?;
            Some(
                self.pupil_path(laser, geometry, &point)?
                    .dot(reference_point.pupil_path),
            )
        });
        match along {
            Some(along) if along > 0.0 => 1.0,
            Some(along) if along < 0.0 => -1.0,
            _ if self.frames < 0.0 => -1.0,
            _ => 1.0,
        }
    }

    /// Returns the reference point at a point, with the displacement of the pupil over its speckle,
    /// if the theory has a value.
    pub(super) fn reference_point(
        &self,
        laser: usize,
        geometry: &ImagingGeometry,
        point: &SpecklePoint,
    ) -> Option<ReferencePoint> {
        self.reference_point_along(point, self.pupil_path(laser, geometry, point)?)
    }

    /// Returns the reference point for a given displacement of the pupil over its speckle.
    pub(super) fn reference_point_along(
        &self,
        point: &SpecklePoint,
        pupil_path: DVec3,
    ) -> Option<ReferencePoint> {
        let body = self.surfaces.get(point.surface)?;
        Some(ReferencePoint {
            surface: point.surface,
            pixel: point.pixel,
            position: body.back.point(point.position),
            normal: body.back.direction(point.normal),
            pupil_path,
        })
    }

    /// The point now, at the image point where it was seen.
    fn carried(&self, point: &ReferencePoint) -> Option<SpecklePoint> {
        let body = self.surfaces.get(point.surface)?;
        Some(SpecklePoint {
            pixel: point.pixel,
            position: body.forth.point(point.position),
            normal: body.forth.direction(point.normal),
            surface: point.surface,
            wave: 0.5,
        })
    }

    /// Returns the point now, if it lies in the image and is lit by a laser.
    pub(super) fn seen(&self, laser: usize, point: &ReferencePoint) -> Option<SpecklePoint> {
        let point = self.carried(point)?;
        let camera = self.camera();
        let pixel = camera.project(point.position)?;
        let size = DVec2::new(camera.width() as f64, camera.height() as f64);
        let is_inside = pixel.cmpge(DVec2::ZERO).all() && pixel.cmple(size).all();
        let is_lit = self.laser(laser).next_event(point.position).is_some();
        (is_inside && is_lit).then_some(SpecklePoint { pixel, ..point })
    }

    /// Returns the displacement of the pupil over the speckle of a point, if the theory has a
    /// value.
    fn pupil_path(
        &self,
        laser: usize,
        geometry: &ImagingGeometry,
        point: &SpecklePoint,
    ) -> Option<DVec3> {
        let shift = self.known_shift(laser, geometry, point, LightPath::Direct)?;
        Some(shift.pupil_path()).filter(|path| path.is_finite())
    }

    /// Returns the shift of the speckle of a laser at a point since the reference frame.
    ///
    /// Where the theory has no value, every frame has its own speckle.
    pub(super) fn speckle_shift(
        &self,
        laser: usize,
        geometry: &ImagingGeometry,
        point: &SpecklePoint,
    ) -> SpeckleShift {
        let shift = self.known_shift(laser, geometry, point, LightPath::Direct);
        shift.unwrap_or_else(|| self.new_speckle())
    }

    /// Returns the shift of the speckle of a laser at a point since the reference frame, if the
    /// theory has a value.
    pub(super) fn known_shift(
        &self,
        laser: usize,
        geometry: &ImagingGeometry,
        point: &SpecklePoint,
        path: LightPath,
    ) -> Option<SpeckleShift> {
        let mut shift = [None];
        let point = core::slice::from_ref(point);
        self.known_shifts((laser, path), geometry, point, &mut shift);
        shift[0]
    }

    /// Returns the shift of speckle that has nothing in common with the reference frame.
    pub(super) fn new_speckle(&self) -> SpeckleShift {
        SpeckleShift {
            pupil: self.frames().abs(),
            ..SpeckleShift::default()
        }
    }

    /// Writes the shifts of the speckle of a laser at points of one surface, `None` where the
    /// theory has no value.
    ///
    /// # Panics
    ///
    /// Panics unless the slices have the same length.
    pub(super) fn known_shifts(
        &self,
        (laser, path): (usize, LightPath),
        geometry: &ImagingGeometry,
        points: &[SpecklePoint],
        shifts: &mut [Option<SpeckleShift>],
    ) {
        assert_eq!(points.len(), shifts.len(), "a shift for each point");
        let Some(surface) = points.first().map(|point| point.surface) else {
            return;
        };
        if path == LightPath::Direct && self.is_still(laser, surface) {
            shifts.fill(Some(SpeckleShift::default()));
            return;
        }
        shifts.fill(None);
        let Some(change) = self.laws.get(surface) else {
            return;
        };
        let law = SpeckleLaw {
            change,
            lasers: [&self.lasers[laser].before, self.laser(laser)],
            perspective: &self.perspective,
            geometry,
        };
        law.shifts(path, points.iter().map(SpecklePoint::seen), shifts);
        let new = self.new_speckle().pupil;
        for shift in shifts.iter_mut().flatten() {
            if shift.pupil.is_infinite() {
                shift.pupil = new;
            }
        }
    }

    /// Returns whether nothing has moved that matters to the speckle of a laser on a surface.
    pub(super) fn is_still(&self, laser: usize, surface: usize) -> bool {
        let moved = self.lasers[laser].moved || self.camera.moved;
        !moved && self.surfaces.get(surface).is_none_or(|body| !body.moved)
    }

    /// Returns the number of frames since the reference frame, negative before it.
    pub(super) const fn frames(&self) -> f64 {
        self.frames
    }

    /// Returns where a point of a surface stood in the reference frame, in metres.
    pub(crate) fn origin(&self, surface: usize, point: DVec3) -> DVec3 {
        let body = self.surfaces.get(surface);
        body.map_or(point, |body| body.back.point(point))
    }

    /// Returns the optical path of a laser to a point of a surface, in metres: now, and where both
    /// stood in the reference frame.
    pub(crate) fn paths_to(&self, laser: usize, surface: usize, point: DVec3) -> Option<[f64; 2]> {
        let LaserChange { before, now, .. } = &self.lasers[laser];
        Some([
            now.path_to(point)?,
            before.path_to(self.origin(surface, point))?,
        ])
    }

    /// Returns the law by which the speckle of a laser changes with the wave number, now.
    pub(super) fn spectral_law<'a>(
        &'a self,
        laser: usize,
        geometry: &'a ImagingGeometry,
    ) -> SpectralLaw<'a> {
        SpectralLaw {
            laser: self.laser(laser),
            perspective: &self.perspective,
            geometry,
        }
    }
}

impl ReferencePoint {
    /// Returns the displacement of the pupil across the line of sight, to the right and up.
    pub(super) fn pupil_path_across(&self) -> DVec2 {
        self.pupil_path.truncate()
    }
}

#[cfg(test)]
mod tests;
