use glam::{DVec2, DVec3};
use tem00_decorrelation::pupil_overlap_correlation;
use tem00_shading::LightPath;
use tem00_tracer::Scene;

use super::{SpecklePoint, change::Change};

/// A point of a surface whose speckle is followed from frame to frame.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ReferencePoint {
    /// The index of the surface in the scene.
    pub surface: usize,
    /// The position of the point in the first of the frames, in metres.
    pub position: DVec3,
    /// The unit normal of the surface there.
    pub normal: DVec3,
}

/// Change of speckle from one frame to another: it moves in the image, and only a part of it is
/// left.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SpeckleChange {
    /// The displacement of the pattern on the sensor, in pixels to the right and down.
    pub displacement: DVec2,
    /// The correlation of intensity of what is left, from 0 to 1.
    pub correlation: f64,
}

impl SpeckleChange {
    /// Nothing has changed.
    pub const NONE: Self = Self {
        displacement: DVec2::ZERO,
        correlation: 1.0,
    };

    /// Returns what becomes of the speckle of a laser at a point between two frames, by the law
    /// that frames are [rendered](crate::render_frame) with, the first of the two as their
    /// reference.
    ///
    /// ```text
    /// x' = P⁻¹(P(x) + a)        from the image point x in the first frame to x' in the second
    /// γ  = chat²(s)             s the shift of the pupil over the speckle, in its diameters
    /// ```
    ///
    /// P leads from the sensor, which may be tilted, behind a lens that may distort, to the plane
    /// across the axis in which the law gives the displacement a. What is in focus is that at the
    /// image point, not that on the axis.
    ///
    /// A head that moves over a still part changes speckle as the part does that moves under it.
    ///
    /// Returns `None` where the law has no value, as for a point that one of the frames does not
    /// see: each frame then has speckle of its own.
    ///
    /// # Validity
    ///
    /// Two later frames of a render, neither of them its reference, have both changed from a third
    /// one. Their displacement is the difference of two. They correlate as said here, within 0.05
    /// and what the blend of two slices adds, unless
    /// [`SpecklePlan::correlation_notes`](crate::SpecklePlan::correlation_notes) has a note.
    ///
    /// # Panics
    ///
    /// Panics unless `laser < scene.lasers.len()` and `point.surface < scene.surfaces.len()`.
    pub fn between(
        scene: &Scene,
        laser: usize,
        point: &ReferencePoint,
        frames: [u32; 2],
    ) -> Option<Self> {
        let wavelength = scene.lasers[laser].wavelength();
        let surface = &scene.surfaces[point.surface];
        let [before, now] = frames.map(|frame| surface.trajectory.pose_at(frame));
        let carried = before.inverse().then(&now);
        let position = carried.point(point.position);
        let change = Change::between(scene, frames);
        let pixel = change.camera().project(position)?;
        let seen = SpecklePoint {
            pixel,
            position,
            normal: carried.direction(point.normal),
            surface: point.surface,
            wave: 0.5,
        };
        let geometry = scene.camera.imaging_geometry(wavelength).ok()?;
        let shift = change.known_shift(laser, &geometry, &seen, LightPath::Direct)?;
        let perspective = change.perspective();
        let old = perspective.pixel(perspective.point(pixel) - shift.displacement)?;
        Some(Self {
            displacement: pixel - old,
            correlation: pupil_overlap_correlation(shift.pupil),
        })
    }
}
