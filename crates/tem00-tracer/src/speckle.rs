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
        let sight = LineOfSight::new(&axes, camera.position() - hit.position)?;
        let direction = laser
            .illuminate(hit.position)
            .map(|light| light.direction)
            .or_else(|| laser.direction_from(hit.position))
            .unwrap_or(hit.normal);
        let wavefront = laser.wavefront_at(hit.position, direction)?;
        Ok(Self {
            point: SurfacePoint::new(sight, hit.normal, wavefront)?,
            motion: Motion {
                surface: scene.surface_displacement(hit.surface, frame),
                camera: f64::from(frame) * scene.camera_displacement_per_frame,
                source: DVec3::ZERO,
            },
        })
    }

    /// Returns how far the pupil has moved over the speckle of a surface point since the first frame,
    /// in pupil diameters.
    ///
    /// The overlap at that shift gives the correlation with the first frame. Motion along the line of
    /// sight is turned into the shift of equal correlation. Shifts beyond one diameter keep growing,
    /// which tells the speckle of two later frames apart: exactly so for motion across the line of
    /// sight; along it, beyond the first zero of the correlation, by the unit of that zero, without
    /// the revival of 4.7 % behind it.
    fn shift_of(
        scene: &Scene,
        laser: &Laser,
        hit: &SpecklePoint,
        frame: u32,
        geometry: &ImagingGeometry,
    ) -> f64 {
        // Where the theory has no value, every frame has speckle of its own.
        Self::new(scene, laser, hit, frame)
            .ok()
            .and_then(|moved| moved.shift(geometry))
            .unwrap_or(f64::from(frame))
    }

    fn shift(&self, geometry: &ImagingGeometry) -> Option<f64> {
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
        Some(
            equivalent_pupil_shift(speckle.correlation)
                .max(lateral)
                .max(beyond_the_zero),
        )
    }
}

/// Turns an image vector with y down, in pixels, into one with y up.
fn upright(pixel: DVec2) -> DVec2 {
    DVec2::new(pixel.x, -pixel.y)
}

impl Scene {
    /// Returns how far a surface has moved from the first frame to `frame`, in metres.
    pub(crate) fn surface_displacement(&self, surface: usize, frame: u32) -> DVec3 {
        self.surfaces.get(surface).map_or(DVec3::ZERO, |surface| {
            f64::from(frame) * surface.displacement_per_frame
        })
    }

    /// Returns whether anything moves between the frames.
    pub(crate) fn moves(&self) -> bool {
        let surfaces = self.surfaces.iter();
        self.render.frames > 1
            && (self.camera_displacement_per_frame != DVec3::ZERO
                || surfaces
                    .clone()
                    .any(|surface| surface.displacement_per_frame != DVec3::ZERO))
    }
}
