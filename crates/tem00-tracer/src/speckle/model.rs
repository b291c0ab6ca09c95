use glam::{DVec2, DVec3};
use tem00_decorrelation::{CameraFrame, DecorrelationError, ImagingGeometry, paper as printed};
use tem00_speckle::{SpeckleStack, paper::BilinearStack};

use super::{Origin, PatternPlan, SpecklePlan, upright};
use crate::{Laser, Scene, TracerError};

/// The speckle patterns of a scene, ready to be looked up.
#[derive(Clone, Debug)]
pub struct SpeckleModel {
    patterns: Vec<Pattern>,
}

/// The pattern of one laser.
#[derive(Clone, Debug)]
struct Pattern {
    geometry: ImagingGeometry,
    /// Slices per pupil diameter.
    slices_per_diameter: f64,
    /// The largest shift that the slices hold, in pupil diameters.
    reach: f64,
    half_period: usize,
    stack: Stack,
}

#[derive(Clone, Debug)]
enum Stack {
    Derived(SpeckleStack),
    /// With the speckle size, in samples.
    AsPrinted(BilinearStack, f64),
}

/// A surface point that a camera sample has hit.
#[derive(Clone, Copy, Debug)]
pub(crate) struct SpecklePoint {
    /// The image point of the sample, in pixels.
    pub pixel: DVec2,
    /// The point of the surface, in metres.
    pub position: DVec3,
    /// The unit normal on the side that is seen.
    pub normal: DVec3,
    /// The index of the surface in the scene.
    pub surface: usize,
}

impl SpecklePoint {
    /// Returns where the point stood in the image of the first frame, in pixels, or `None` if that
    /// was behind the camera.
    pub(super) fn reference(&self, scene: &Scene, frame: u32) -> Option<DVec2> {
        let before = self.position - scene.surface_displacement(self.surface, frame);
        scene.camera.project(before)
    }
}

impl SpeckleModel {
    /// Generates the patterns of a plan.
    ///
    /// # Errors
    ///
    /// Returns an error if the memory for a stack cannot be had.
    pub fn generate(scene: &Scene, plan: &SpecklePlan) -> Result<Self, TracerError> {
        let patterns = scene.lasers.iter().zip(plan.patterns());
        let patterns = patterns
            .map(|(laser, pattern)| {
                Pattern::generate(scene.camera.imaging_geometry(laser.wavelength())?, pattern)
            })
            .collect::<Result<_, _>>()?;
        Ok(Self { patterns })
    }

    /// Returns the number of patterns: one for each laser of the scene.
    pub(crate) fn pattern_count(&self) -> usize {
        self.patterns.len()
    }

    /// Returns the speckle factor of laser `index` at a surface point, in `frame` of the scene.
    pub(crate) fn factor(
        &self,
        scene: &Scene,
        index: usize,
        point: &SpecklePoint,
        frame: u32,
    ) -> f64 {
        let pattern = &self.patterns[index];
        let still = frame == 0 || !scene.moves();
        match &pattern.stack {
            Stack::Derived(stack) => {
                let (pixel, shift) = if still {
                    (point.pixel, 0.0)
                } else {
                    pattern.reference(scene, &scene.lasers[index], point, frame)
                };
                let c = pattern.geometry.pattern_coordinate(
                    upright(pixel),
                    DVec2::ZERO,
                    stack.speckle_size(),
                );
                stack.intensity_at(c.x, c.y, shift * pattern.slices_per_diameter)
            }
            Stack::AsPrinted(stack, speckle_size) => {
                let (displacement, u) = if still {
                    (DVec2::ZERO, 0.0)
                } else {
                    pattern.reference_as_printed(scene, &scene.lasers[index], point, frame)
                };
                let c = printed::pattern_coordinate(
                    &pattern.geometry,
                    upright(point.pixel),
                    displacement,
                    *speckle_size,
                );
                stack.intensity_at(c.x, c.y, u)
            }
        }
    }
}

impl Pattern {
    fn generate(geometry: ImagingGeometry, plan: &PatternPlan) -> Result<Self, TracerError> {
        let field = plan.stack().field(plan.seed())?;
        let stack = if plan.is_as_printed() {
            let stack = BilinearStack::generate(&field, plan.half_period())?;
            Stack::AsPrinted(stack, field.speckle_size())
        } else {
            Stack::Derived(SpeckleStack::generate(&field, plan.stack().path())?)
        };
        Ok(Self {
            geometry,
            slices_per_diameter: plan.stack().slices_per_diameter(),
            half_period: plan.half_period(),
            reach: plan.stack().reach(),
            stack,
        })
    }

    /// Returns where the speckle of a surface point stood in the image of the first frame, in pixels,
    /// and how far the pupil has moved over it since, in diameters.
    fn reference(
        &self,
        scene: &Scene,
        laser: &Laser,
        point: &SpecklePoint,
        frame: u32,
    ) -> (DVec2, f64) {
        let Origin { pixel, shift } = Origin::of(scene, laser, point, frame, &self.geometry);
        // A point that started behind the camera has no place in its image: any will do. Beyond the
        // reach the speckle is new to the first frame, wherever the pupil stands.
        (pixel.unwrap_or(point.pixel), shift.min(self.reach))
    }

    /// Returns the displacement in the image and the slice coordinate by the printed formulas.
    fn reference_as_printed(
        &self,
        scene: &Scene,
        laser: &Laser,
        point: &SpecklePoint,
        frame: u32,
    ) -> (DVec2, f64) {
        // Where a printed formula has no value, the pattern counts as decorrelated.
        self.printed_motion(scene, laser, point, frame)
            .ok()
            .flatten()
            .unwrap_or((DVec2::ZERO, self.half_period as f64))
    }

    fn printed_motion(
        &self,
        scene: &Scene,
        laser: &Laser,
        point: &SpecklePoint,
        frame: u32,
    ) -> Result<Option<(DVec2, f64)>, DecorrelationError> {
        let camera = scene.camera_at(frame);
        let axes = CameraFrame::from_axes(camera.axes())?;
        let (surface_axes, angles) = printed::EulerAngles::between(&axes, point.normal)?;
        let to_surface = surface_axes.transpose();
        let to_emitter = laser.description().position - point.position;
        let emitter = printed::Emitter {
            direction: to_surface * to_emitter.normalize_or_zero(),
            distance: to_emitter.length(),
        };
        let surface = scene.surface_displacement(point.surface, frame);
        let moved = scene.camera_trajectory.pose_at(frame).translation();
        let in_image = printed::image_displacement(
            self.geometry.magnification(),
            angles,
            to_surface * (surface - moved),
        );
        let distance = camera.position().distance(point.position);
        let in_pupil = printed::pupil_displacement(angles, emitter, distance, to_surface * surface);
        Ok(in_pupil.map(|in_pupil| {
            let of_camera = DVec2::new(moved.dot(axes.right()), moved.dot(axes.up()));
            let u = printed::slice_coordinate(
                &self.geometry,
                printed::relative_pupil_displacement(of_camera, in_pupil),
                (surface - moved).dot(axes.towards_camera()),
                self.half_period,
            );
            (in_image, u)
        }))
    }
}
