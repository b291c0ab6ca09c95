use glam::{DVec2, DVec3};
use tem00_decorrelation::{
    CameraFrame, Configuration, ConfigurationData, Illumination, ImageOrientation, ImagingGeometry,
    RigidMotion, RigidMotions, SpeckleMotion, equivalent_pupil_shift,
};

use super::{SpecklePoint, perspective::Perspective, upright};
use crate::{Camera, Laser, Scene};

/// What has moved between the reference frame and another.
#[derive(Clone, Debug)]
pub(super) struct Change {
    /// The number of frames since the reference frame, negative before it.
    frames: f64,
    /// The camera in the reference frame and now.
    cameras: [Camera; 2],
    perspective: Perspective,
    camera: BodyChange,
    lasers: Vec<LaserChange>,
    surfaces: Vec<BodyChange>,
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

/// What has become of the speckle of a point since the reference frame.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(super) struct Drift {
    /// How far it has moved in the image in perspective, in pixels with y down.
    pub displacement: DVec2,
    /// How far the pupil has moved over it, in pupil diameters, never negative.
    pub shift: f64,
}

/// The motion since the reference frame as the formulas of the paper take it, in metres.
#[derive(Clone, Copy, Debug)]
pub(super) struct Translations {
    pub surface: DVec3,
    pub camera: DVec3,
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
    pub(super) fn new(scene: &Scene, frame: u32) -> Self {
        let reference = scene.render.reference_frame;
        let body = |trajectory: &crate::Trajectory| {
            BodyChange::between(trajectory.pose_at(reference), trajectory.pose_at(frame))
        };
        let laser = |(index, laser): (usize, &Laser)| LaserChange {
            before: scene.laser_at(index, reference),
            now: scene.laser_at(index, frame),
            moved: laser.trajectory().pose_at(reference) != laser.trajectory().pose_at(frame),
        };
        Self {
            frames: f64::from(frame) - f64::from(reference),
            cameras: [scene.camera_at(reference), scene.camera_at(frame)],
            perspective: Perspective::of(scene.camera_at(frame)),
            camera: body(&scene.camera_trajectory),
            lasers: scene.lasers.iter().enumerate().map(laser).collect(),
            surfaces: scene.surfaces.iter().map(|s| body(&s.trajectory)).collect(),
        }
    }

    /// Returns the camera now.
    pub(super) const fn camera(&self) -> &Camera {
        &self.cameras[1]
    }

    /// Returns the image of the camera in perspective.
    pub(super) const fn perspective(&self) -> &Perspective {
        &self.perspective
    }

    /// Returns laser `index` now.
    pub(super) fn laser(&self, index: usize) -> &Laser {
        &self.lasers[index].now
    }

    /// Returns whether now comes before the reference frame.
    pub(super) fn is_before(&self) -> bool {
        self.frames < 0.0
    }

    /// Returns whether nothing has moved that matters to the speckle of a laser on a surface.
    pub(super) fn is_still(&self, laser: usize, surface: usize) -> bool {
        let moved = self.lasers[laser].moved || self.camera.moved;
        !moved && self.surfaces.get(surface).is_none_or(|body| !body.moved)
    }

    /// Returns what has become of the speckle of a laser at a point.
    ///
    /// Where the theory has no value, every frame has speckle of its own.
    pub(super) fn drift(
        &self,
        laser: usize,
        geometry: &ImagingGeometry,
        point: &SpecklePoint,
    ) -> Drift {
        if self.is_still(laser, point.surface) {
            return Drift::default();
        }
        let drift = self.law(laser, geometry, point);
        let new = Drift {
            displacement: DVec2::ZERO,
            shift: self.frames.abs(),
        };
        drift.filter(Drift::is_finite).unwrap_or(new)
    }

    /// The law of speckle motion between two states, however far apart.
    fn law(&self, laser: usize, geometry: &ImagingGeometry, point: &SpecklePoint) -> Option<Drift> {
        let [before, now] = self.states(laser, point)?;
        let screen = ImageOrientation::ScreenUpright;
        let pixels_per_tangent = geometry.principal_distance() / geometry.pixel_pitch();
        let geometry = &self.perspective.geometry(geometry, point.pixel);
        let speckle = SpeckleMotion::between(geometry, &before, &now, screen);
        let tangents = speckle.speckle_displacement() / geometry.principal_distance();
        let displacement = upright(tangents * pixels_per_tangent);
        let shift = match speckle.pupil_displacement {
            Some(pupil) => {
                let lateral = pupil.length() / geometry.pupil_diameter();
                let axial = axial_shift(geometry, &before, &now);
                equivalent_shift(speckle.correlation, lateral, axial)
            }
            None => self.frames.abs(),
        };
        Some(Drift {
            displacement,
            shift,
        })
    }

    /// The point with its light and its camera, in the reference frame and now.
    fn states(&self, laser: usize, point: &SpecklePoint) -> Option<[Configuration; 2]> {
        let body = self.surfaces.get(point.surface)?;
        let laser = &self.lasers[laser];
        let then = body.back.point(point.position);
        // The phase of the light at a point follows from its direction alone, in either state: the
        // wave between them need not be known.
        let light = |laser: &Laser, point: DVec3| {
            let wave = laser.wave_direction_at(point);
            Illumination::collimated(wave.or_else(|| laser.direction_from(point))?).ok()
        };
        let camera = &self.cameras[0];
        let before = Configuration::new(ConfigurationData {
            wavelength: laser.now.wavelength(),
            point: then,
            normal: body.back.direction(point.normal),
            illumination: light(&laser.before, then)?,
            camera: CameraFrame::from_axes(camera.axes()).ok()?,
            pupil: camera.position(),
        })
        .ok()?;
        let motions = RigidMotions {
            surface: body.forth,
            camera: self.camera.forth,
            source: RigidMotion::IDENTITY,
        };
        let now = before.moved(&motions).ok()?;
        let lit = now.with_illumination(light(&laser.now, point.position)?);
        Some([before, lit.ok()?])
    }

    /// Returns how far the surface has moved at a point, and the camera.
    pub(super) fn translations(&self, point: &SpecklePoint) -> Translations {
        let then = self
            .surfaces
            .get(point.surface)
            .map_or(point.position, |body| body.back.point(point.position));
        Translations {
            surface: point.position - then,
            camera: self.cameras[1].position() - self.cameras[0].position(),
        }
    }
}

impl Drift {
    fn is_finite(&self) -> bool {
        self.displacement.is_finite() && self.shift.is_finite()
    }
}

/// How far the surface has gone out of focus, in axial decorrelation lengths.
fn axial_shift(geometry: &ImagingGeometry, before: &Configuration, now: &Configuration) -> f64 {
    let defocus = |state: &Configuration| geometry.defocus_at(state.sight().depth());
    let diameter = geometry.pupil_diameter();
    (defocus(now) - defocus(before)) * diameter * diameter / (8.0 * now.wavelength())
}

/// The shift of the pupil, in its diameters, whose overlap leaves `correlation`.
///
/// Motion along the line of sight is turned into the shift of equal correlation. Shifts beyond one
/// diameter keep growing, which tells the speckle of two later frames apart: exactly so for motion
/// across the line of sight; along it, beyond the first zero of the correlation, by the unit of that
/// zero, without the revival of 4.7 % behind it.
fn equivalent_shift(correlation: f64, lateral: f64, axial: f64) -> f64 {
    let beyond_the_zero = if axial.abs() >= 1.0 { axial.abs() } else { 0.0 };
    equivalent_pupil_shift(correlation)
        .max(lateral)
        .max(beyond_the_zero)
}

#[cfg(test)]
mod tests;
