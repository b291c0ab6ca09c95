//! From the camera and the motion in a scene to the speckle factor of a camera sample.

mod model;
mod plan;
mod survey;

use glam::{DVec2, DVec3};
pub use model::SpeckleModel;
pub(crate) use model::SpecklePoint;
pub use plan::{PatternPlan, SpecklePlan};
use tem00_decorrelation::{
    CameraFrame, DecorrelationError, ImageOrientation, ImagingGeometry, LineOfSight, Motion,
    SpeckleMotion, SurfacePoint, equivalent_pupil_shift,
};

use crate::{Laser, Scene};

/// Where the speckle of a surface point is found in the pattern of the first frame.
struct Origin {
    /// Where that speckle stood in the image of the first frame, in pixels, or `None` if the point
    /// was behind the camera.
    pixel: Option<DVec2>,
    /// How far the pupil has moved over it since, in pupil diameters.
    shift: f64,
}

impl Origin {
    fn of(
        scene: &Scene,
        laser: &Laser,
        hit: &SpecklePoint,
        frame: u32,
        geometry: &ImagingGeometry,
    ) -> Self {
        // Where the theory has no value, every frame has speckle of its own.
        let (beside, shift) = MovedPoint::new(scene, laser, hit, frame)
            .ok()
            .and_then(|moved| moved.drift(geometry))
            .unwrap_or((DVec2::ZERO, f64::from(frame)));
        let pixel = hit.reference(scene, frame);
        Self {
            pixel: pixel.map(|pixel| pixel - upright(beside)),
            shift,
        }
    }
}

/// A surface point and what has moved since the first frame, as the speckle theory needs it.
struct MovedPoint {
    point: SurfacePoint,
    motion: Motion,
}

impl MovedPoint {
    fn new(
        scene: &Scene,
        laser: &Laser,
        hit: &SpecklePoint,
        frame: u32,
    ) -> Result<Self, DecorrelationError> {
        let camera = scene.camera_at(frame);
        let axes = CameraFrame::from_axes(camera.axes())?;
        let motion = Motion {
            surface: scene.surface_displacement(hit.surface, frame),
            camera: scene.camera_trajectory.pose_at(frame).translation(),
            source: DVec3::ZERO,
        };
        // Seen half-way between both frames, where the defocus is the mean of both.
        let half_way_back = 0.5 * motion.surface_seen_by_camera();
        let sight = LineOfSight::new(&axes, camera.position() - hit.position + half_way_back)?;
        let direction = laser
            .illuminate(hit.position)
            .map(|light| light.direction)
            .or_else(|| laser.direction_from(hit.position))
            .unwrap_or(hit.normal);
        let wavefront = laser.wavefront_at(hit.position, direction)?;
        Ok(Self {
            point: SurfacePoint::new(sight, hit.normal, wavefront)?,
            motion,
        })
    }

    /// Returns how far the speckle has moved beside the image of the point, in pixels with y up, and
    /// how far the pupil has moved over it, in pupil diameters.
    ///
    /// In focus the speckle moves with the image of the point, and the first is zero.
    ///
    /// The overlap at the second gives the correlation with the first frame. Motion along the line of
    /// sight is turned into the shift of equal correlation. Shifts beyond one diameter keep growing,
    /// which tells the speckle of two later frames apart: exactly so for motion across the line of
    /// sight; along it, beyond the first zero of the correlation, by the unit of that zero, without
    /// the revival of 4.7 % behind it.
    fn drift(&self, geometry: &ImagingGeometry) -> Option<(DVec2, f64)> {
        let speckle = SpeckleMotion::new(
            geometry,
            &self.point,
            &self.motion,
            ImageOrientation::ScreenUpright,
        );
        let lateral = speckle.pupil_displacement?.length() / geometry.pupil_diameter();
        let depth = self.point.sight().depth();
        let axial = speckle.axial_displacement / geometry.axial_decorrelation_length_at(depth);
        let beyond_the_zero = if axial.abs() >= 1.0 { axial.abs() } else { 0.0 };
        let shift = equivalent_pupil_shift(speckle.correlation)
            .max(lateral)
            .max(beyond_the_zero);
        Some((speckle.defocus_displacement / geometry.pixel_pitch(), shift))
    }
}

/// Turns an image vector with y down, in pixels, into one with y up, and back.
fn upright(pixel: DVec2) -> DVec2 {
    DVec2::new(pixel.x, -pixel.y)
}

impl Scene {
    /// Returns how far a surface has moved from the first frame to `frame`, in metres.
    pub(crate) fn surface_displacement(&self, surface: usize, frame: u32) -> DVec3 {
        self.surfaces.get(surface).map_or(DVec3::ZERO, |surface| {
            surface.trajectory.pose_at(frame).translation()
        })
    }

    /// Returns whether anything moves between the frames.
    pub(crate) fn moves(&self) -> bool {
        let surfaces = self.surfaces.iter();
        self.render.frames > 1
            && (!self.camera_trajectory.is_still()
                || surfaces
                    .clone()
                    .any(|surface| !surface.trajectory.is_still()))
    }
}

#[cfg(test)]
mod tests {
    use std::path::Path;

    use tem00_decorrelation::{
        Configuration, ConfigurationData, Illumination, RigidMotion, RigidMotions,
    };

    use super::*;

    /// A plate in focus under a waist that comes nearer and goes aside.
    const SCENE: &str = r#"
        [render]
        frames = 2
        [camera]
        position = [0, 0, 0.3]
        look_at = [0, 0, 0]
        focal_length = "25 mm"
        f_number = 8
        pixel_pitch = "3.45 um"
        resolution = [640, 480]

        [[laser]]
        wavelength = "650 nm"
        power = "1 mW"
        position = [0, 0, 0.25]
        look_at = [0, 0, 0]
        spot = { waist_radius = "2 mm" }

        [[surface]]
        displacement_per_frame = ["0.3 mm", "0.1 mm", "4 mm"]
        rectangle = { centre = [0, 0, 0], normal = [0, 0, 1], size = [0.04, 0.04] }
    "#;

    #[test]
    fn origins_follow_the_law_of_finite_motions() {
        let scene = crate::parse_scene(SCENE, Path::new(".")).unwrap();
        let laser = &scene.lasers[0];
        let geometry = scene.camera.imaging_geometry(laser.wavelength()).unwrap();
        let surface = scene.surface_displacement(0, 1);
        let position = DVec3::new(5e-3, -3e-3, 0.0) + surface;
        let hit = SpecklePoint {
            pixel: scene.camera.project(position).unwrap(),
            position,
            normal: DVec3::Z,
            surface: 0,
        };
        let origin = Origin::of(&scene, laser, &hit, 1, &geometry);

        let pupil = scene.camera.position();
        let before = Configuration::new(ConfigurationData {
            wavelength: laser.wavelength(),
            point: position - surface,
            normal: DVec3::Z,
            illumination: Illumination::collimated(DVec3::Z).unwrap(),
            camera: CameraFrame::from_axes(scene.camera.axes()).unwrap(),
            pupil,
        });
        let before = before.unwrap();
        let after = before.moved(&RigidMotions {
            surface: RigidMotion::along(surface).unwrap(),
            ..RigidMotions::default()
        });
        let screen = ImageOrientation::ScreenUpright;
        let law = SpeckleMotion::between(&geometry, &before, &after.unwrap(), screen);

        let moved = upright(hit.pixel - origin.pixel.unwrap()) * geometry.pixel_pitch();
        let beside = law.defocus_displacement.length();
        // What the middle of the motion leaves is of the order (4 mm / 0.3 m)² / 4 = 5e−5; the first
        // order at either end would err by all of it.
        let error = (moved - law.speckle_displacement()).length();
        assert!(error < 2e-4 * beside, "{error:e} m of {beside:e} m");
        let shift = equivalent_pupil_shift(law.correlation);
        // The line of sight turns by half the motion, 2 mm of 0.3 m.
        let relative = origin.shift / shift - 1.0;
        assert!(relative.abs() < 1e-2, "shifts differ by {relative:e}");
    }
}
