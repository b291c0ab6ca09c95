//! Light followed from the lasers to the camera.
//!
//! The path tracer connects the surfaces that the camera sees directly to the lasers, so it finds
//! no light that a mirror or a lens has deflected on its way to a surface. Here rays drawn from the
//! phase space of a beam carry its power. Mirrors and glass send them on; at every rough surface
//! they are connected to the camera.
//!
//! A surface that the camera sees in a mirror or through glass cannot be connected to it. Light
//! that meets specular surfaces on both sides, between laser and rough surface and between rough
//! surface and camera, is found neither from the laser nor from the camera.
//!
//! Light that a mirror or glass has deflected keeps its coherence: up to the first rough surface it
//! counts as coherent, and its speckle is looked up at the image point. Where something moves, that
//! speckle moves and changes as if the light came straight from the laser.

mod connection;
mod group;
mod specular_search;
mod splats;

use core::sync::atomic::{AtomicBool, Ordering};

use tem00_camera::Camera;
use tem00_geometry::Intersector;
use tem00_numerics::parallel;
use tem00_tracer::{Crop, LaserLayers, RenderError, Scene};

pub(crate) use self::group::LightGroup;
pub use self::specular_search::has_specular_surfaces_on_both_sides;
use self::{connection::Connector, splats::SplatFilm};
use crate::speckle::SpeckleFrame;

/// Follows light from the lasers to the camera, in one frame.
#[derive(Clone, Copy, Debug)]
pub(crate) struct LightTracer<'a> {
    pub scene: &'a Scene,
    /// The camera as it stands in the frame.
    pub camera: &'a Camera,
    /// The surfaces as they stand in the frame, and the area lights behind them.
    pub intersector: &'a Intersector,
    pub speckle: Option<&'a SpeckleFrame<'a>>,
    pub frame: u32,
    /// The maximum number of surfaces that light may meet between laser and camera; `None` for no
    /// limit.
    pub max_depth: Option<u32>,
    pub selection: LightSelection,
    /// The part of the image that is rendered.
    pub area: Crop,
    /// The number of light paths for each laser. The same number gives the same bits in every part
    /// of the image.
    pub paths: u64,
    pub seed: u64,
}

/// The part of the light that is followed.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum LightSelection {
    /// All light that reaches the camera from a rough surface.
    All,
    /// Light whose first hit is specular: exactly the light that the path tracer cannot find.
    SpecularFirst,
}

/// The groups of light paths whose points of phase space are spread evenly.
#[derive(Clone, Copy, Debug)]
struct Groups {
    paths: u64,
    count: u64,
}

impl Groups {
    /// Chooses a group size that spreads the points well and leaves enough groups to estimate the
    /// variance.
    fn new(paths: u64) -> Self {
        const FEW: u64 = 64;
        const LARGE: u64 = 1 << 12;
        let size = (paths / FEW).clamp(1, LARGE);
        Self {
            paths,
            count: paths.div_ceil(size),
        }
    }

    /// Returns the number of paths in group `index`; groups differ by one path at most.
    fn size(self, index: u64) -> usize {
        let start =
            |group: u64| u128::from(group) * u128::from(self.paths) / u128::from(self.count);
        usize::try_from(start(index + 1) - start(index)).unwrap_or(usize::MAX)
    }
}

/// The number of groups that are followed before their light is added to the image, in order. This
/// bounds the memory, and the sums have the same bits for any number of threads.
const GROUPS_AT_ONCE: usize = 64;

impl LightTracer<'_> {
    /// Follows the light of one laser of the scene, and adds it to its layers.
    ///
    /// `progress` receives, from any thread, the number of light paths done since its last call.
    ///
    /// # Errors
    ///
    /// Returns [`RenderError::Cancelled`] if `cancel` was set before the end.
    pub(crate) fn trace(
        &self,
        laser: usize,
        layers: &mut LaserLayers,
        progress: &(dyn Fn(u64) + Sync),
        cancel: &AtomicBool,
    ) -> Result<(), RenderError> {
        let connector = Connector::new(self, laser);
        let groups = Groups::new(self.paths);
        let mut film = SplatFilm::new(self.area);
        for first in (0..groups.count).step_by(GROUPS_AT_ONCE) {
            let left = usize::try_from(groups.count - first).unwrap_or(usize::MAX);
            let followed = parallel::map(left.min(GROUPS_AT_ONCE), |index| {
                if cancel.load(Ordering::Relaxed) {
                    return Err(RenderError::Cancelled);
                }
                let index = first + index as u64;
                let splats = connector.group(index, groups.size(index));
                progress(groups.size(index) as u64);
                Ok(splats)
            });
            for splats in followed {
                film.add(&splats?);
            }
        }
        film.add_to(layers, groups.count, groups.paths);
        Ok(())
    }
}

#[cfg(test)]
mod tests;
