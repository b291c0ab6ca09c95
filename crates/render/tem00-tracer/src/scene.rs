use tem00_camera::Camera;
use tem00_coherence::Relief;
use tem00_geometry::Shape;

use crate::{Laser, Light, Material, Method, RenderOptions, TracerError, Trajectory};

/// An object: a shape made of a material, perhaps moving from frame to frame.
#[derive(Clone, Debug, PartialEq)]
pub struct Surface {
    /// The name by which reports call it.
    pub name: String,
    /// The shape, in world coordinates, before the trajectory moves it.
    pub shape: Shape,
    /// The material.
    pub material: Material,
    /// The motion of the surface from frame to frame.
    pub trajectory: Trajectory,
    /// The composition of its speckle.
    pub speckle: SurfaceSpeckle,
    /// The relief that is finer than the resolution of the camera; of height zero where it is not
    /// known.
    pub relief: Relief,
}

impl Surface {
    /// Creates a surface that stands still and whose speckle is fully developed and polarised.
    pub fn new(name: impl Into<String>, shape: Shape, material: Material) -> Self {
        Self {
            name: name.into(),
            shape,
            material,
            trajectory: Trajectory::default(),
            speckle: SurfaceSpeckle::default(),
            relief: Relief::default(),
        }
    }
}

/// The smallest radius of curvature of a translucent surface, in transport lengths.
const MIN_CURVATURE: f64 = 10.0;

impl Surface {
    /// Checks that light from below a translucent surface is spread as on a plane.
    ///
    /// # Errors
    ///
    /// Returns an error if more than a twentieth of the surface curves with a smaller radius than
    /// ten transport lengths.
    pub fn check_curvature(&self) -> Result<(), TracerError> {
        let Some(medium) = self.material.below() else {
            return Ok(());
        };
        let radius = self.shape.radius_of_curvature();
        let min = MIN_CURVATURE * medium.transport_length();
        match radius >= min {
            true => Ok(()),
            false => Err(TracerError::Curvature { radius, min }),
        }
    }
}

/// Composition of the speckle of a surface.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SurfaceSpeckle {
    /// The number of independent patterns of equal power that add up, at least 1.
    pub patterns: u32,
    /// The degree of polarisation of the scattered light, from 0 to 1.
    pub polarisation: f64,
}

impl Default for SurfaceSpeckle {
    fn default() -> Self {
        Self {
            patterns: 1,
            polarisation: 1.0,
        }
    }
}

/// Choices about the speckle patterns; a choice of `None` is made from camera, image and motion.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SpeckleSettings {
    /// The pattern size Q, in samples.
    pub size: Option<usize>,
    /// The diameter C of the random pupil field, in samples; at most half the size.
    pub diameter: Option<usize>,
    /// Half the number of slices, M.
    pub half_period: Option<usize>,
    /// The memory that the patterns of all lasers may take together, in bytes.
    pub memory: u64,
}

impl Default for SpeckleSettings {
    fn default() -> Self {
        Self {
            size: None,
            diameter: None,
            half_period: None,
            memory: 1 << 30,
        }
    }
}

/// Everything that is rendered, validated.
///
/// One frame is the reference frame: the speckle of the other frames has moved and changed by the
/// motion since then.
#[derive(Clone, Debug)]
pub struct Scene {
    /// The camera, before its trajectory moves it.
    pub camera: Camera,
    /// The motion of the camera from frame to frame.
    pub camera_trajectory: Trajectory,
    /// The lasers.
    pub lasers: Vec<Laser>,
    /// The objects.
    pub surfaces: Vec<Surface>,
    /// The incoherent lights.
    pub lights: Vec<Light>,
    /// Choices about the speckle patterns.
    pub speckle: SpeckleSettings,
    /// Choices about the image.
    pub render: RenderOptions,
    /// The number of frames.
    pub frames: u32,
    /// The reference frame, from which the speckle of the other frames has moved and changed.
    pub reference_frame: u32,
}

impl Scene {
    /// Creates a dark and empty scene with a camera that stands still.
    pub fn new(camera: Camera) -> Self {
        Self {
            camera,
            camera_trajectory: Trajectory::default(),
            lasers: Vec::new(),
            surfaces: Vec::new(),
            lights: Vec::new(),
            speckle: SpeckleSettings::default(),
            render: RenderOptions::default(),
            frames: 1,
            reference_frame: 0,
        }
    }

    /// Returns the camera as it stands in `frame`.
    pub fn camera_at(&self, frame: u32) -> Camera {
        self.camera.moved(&self.camera_trajectory.pose_at(frame))
    }

    /// Returns laser `index` as it stands in `frame`.
    ///
    /// # Panics
    ///
    /// Panics unless `index < lasers.len()`.
    pub fn laser_at(&self, index: usize, frame: u32) -> Laser {
        self.lasers[index].in_frame(frame)
    }

    /// Returns the shapes as they stand in `frame`: the surfaces, then the area lights, which stand
    /// still.
    pub fn shapes_at(&self, frame: u32) -> Vec<Shape> {
        let surfaces = self
            .surfaces
            .iter()
            .map(|surface| surface.shape.moved(&surface.trajectory.pose_at(frame)));
        let lights = self.lights.iter().filter_map(|light| match light {
            Light::Area { rectangle, .. } => Some(Shape::Rectangle(*rectangle)),
            Light::Point { .. } | Light::Environment(_) => None,
        });
        surfaces.chain(lights).collect()
    }

    /// Returns whether an object is a mirror or of smooth glass.
    ///
    /// If so, the light that it sends from a laser to other surfaces is followed from the laser.
    pub fn has_specular_surfaces(&self) -> bool {
        let mut surfaces = self.surfaces.iter();
        surfaces.any(|surface| surface.material.is_specular())
    }

    /// Checks that its translucent surfaces can be rendered with these options.
    ///
    /// # Errors
    ///
    /// Returns an error if a translucent surface [curves](Surface::check_curvature) strongly, or
    /// unless paths from the camera connect to the beams of lasers.
    pub fn check_bodies(&self, options: &RenderOptions) -> Result<(), TracerError> {
        self.surfaces
            .iter()
            .try_for_each(Surface::check_curvature)?;
        let mut surfaces = self.surfaces.iter();
        if !surfaces.any(|surface| surface.material.below().is_some()) {
            return Ok(());
        }
        if options.method == Method::Light {
            let needs = "the method \"path\"";
            return Err(TracerError::Translucent { needs });
        }
        if options.samples_beams() {
            let needs = "laser_events \"beam\"";
            return Err(TracerError::Translucent { needs });
        }
        Ok(())
    }

    /// Returns whether the speckle of laser `laser` on surface `surface` may differ between two
    /// frames: whether surface, camera or laser move.
    ///
    /// # Panics
    ///
    /// Panics unless `laser < lasers.len()` and `surface < surfaces.len()`.
    pub fn speckle_moves(&self, laser: usize, surface: usize) -> bool {
        self.frames > 1
            && !(self.camera_trajectory.is_still()
                && self.lasers[laser].trajectory().is_still()
                && self.surfaces[surface].trajectory.is_still())
    }
}
