use glam::{DVec2, DVec3};
use tem00_decorrelation::pupil_overlap_correlation;
use tem00_shading::LightPath;
use tem00_tracer::Scene;

use super::{SpecklePoint, change::Change};

/// A point of a surface whose speckle is followed from frame to frame.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct FollowedPoint {
    /// The index of the surface in the scene.
    pub surface: usize,
    /// The position of the point in the first of the frames, in metres.
    pub position: DVec3,
    /// The unit normal of the surface there.
    pub normal: DVec3,
}

/// Change of speckle from one frame to another: the pattern moves in the image and decorrelates in
/// part.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SpeckleChange {
    /// The displacement of the pattern on the sensor, in pixels to the right and down.
    pub displacement: DVec2,
    /// The correlation of intensity apart from the displacement, from 0 to 1.
    pub correlation: f64,
}

impl SpeckleChange {
    /// Nothing has changed.
    pub const NONE: Self = Self {
        displacement: DVec2::ZERO,
        correlation: 1.0,
    };

    /// Returns the change of the speckle of a laser at a point between two frames, by the law with
    /// which frames are [rendered](crate::render_frame), where the first of the two is the
    /// reference frame.
    ///
    /// ```text
    /// x' = P⁻¹(P(x) + a)        from the image point x in the first frame to x' in the second
    /// γ  = chat²(s)             s the shift of the pupil over the speckle, in its diameters
    /// ```
    ///
    /// P maps from the sensor, which may be tilted and lie behind a lens with distortion, to the
    /// plane across the axis in which the law gives the displacement a. This is the plane that is
    /// in focus at the image point, not the plane in focus on the axis.
    ///
    /// A sensor head that moves over a fixed part changes speckle in the same way as a part that
    /// moves under a fixed head.
    ///
    /// Returns `None` where the law has no value, such as for a point that one of the frames does
    /// not see: each frame then has its own speckle.
    ///
    /// # Validity
    ///
    /// Two later frames of a render, neither of them its reference frame, have both changed from
    /// that frame. Their displacement is the difference of their two displacements. They correlate
    /// as stated here, within 0.05 and the error of blending two slices, unless
    /// [`SpecklePlan::correlation_notes`](crate::SpecklePlan::correlation_notes) has a note.
    ///
    /// # Panics
    ///
    /// Panics unless `laser < scene.lasers.len()` and `point.surface < scene.surfaces.len()`.
    pub fn between(
        scene: &Scene,
        laser: usize,
        point: &FollowedPoint,
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
