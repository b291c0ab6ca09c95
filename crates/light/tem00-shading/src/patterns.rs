use glam::{DVec2, DVec3};
use tem00_camera::Camera;
use tem00_decorrelation::ImagingGeometry;
use tem00_speckle::{SpeckleStack, StackNeeds, StackPlan};

use crate::{Bandwidth, Laser, state::ReferencePoint};

/// The patterns, and the requirements for which they were chosen.
#[derive(Debug)]
pub(crate) struct Patterns {
    pub(crate) camera: Camera,
    pub(crate) laser: Laser,
    pub(crate) geometry: ImagingGeometry,
    /// The number of fields that share a stack.
    pub(crate) in_a_stack: usize,
    /// Stacks, one for each field or one for all.
    pub(crate) stacks: Vec<SpeckleStack>,
    pub(crate) parts: Vec<Part>,
    pub(crate) bandwidth: Option<Bandwidth>,
    /// The number of equal parts of the line, each represented by its median wave number.
    pub(crate) waves: usize,
    pub(crate) needs: StackNeeds,
    pub(crate) plan: StackPlan,
    /// The largest shifts of the poses to either side of the reference, in pupil diameters.
    pub(crate) shifts: [f64; 2],
    pub(crate) farthest: Option<ReferencePoint>,
    pub(crate) points: Vec<(DVec3, DVec3)>,
}

/// A pattern, and its fraction of the light.
#[derive(Clone, Debug)]
pub(crate) struct Part {
    pub fraction: f64,
    /// Fields that add: one, or one for each height of the relief.
    pub fields: Vec<Field>,
}

/// A position in one of the stacks.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Field {
    pub stack: usize,
    /// Offset in samples.
    pub offset: DVec2,
}

/// The heights of a surface in light of one wavelength.
const FLAT: &[[f64; 2]] = &[[0.0, 1.0]];

impl Patterns {
    pub(crate) fn heights(&self) -> &[[f64; 2]] {
        self.bandwidth.as_ref().map_or(FLAT, |b| &b.heights)
    }
}
