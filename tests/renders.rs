//! Scenes that are written as text, and their renders.

use std::{path::Path, sync::atomic::AtomicBool};

use tem00::{
    engine::{SpeckleModel, SpecklePlan, render_frame},
    scene::parse_scene,
    tracer::{Frame, RenderOptions, Scene},
};

#[track_caller]
pub(crate) fn scene(text: &str) -> Scene {
    parse_scene(text, Path::new(".")).expect("a valid scene")
}

pub(crate) fn options(samples_per_pixel: u32, seed: u64) -> RenderOptions {
    RenderOptions {
        samples_per_pixel,
        seed,
        ..RenderOptions::default()
    }
}

/// The speckle of a scene, of patterns by a seed.
pub(crate) fn speckle(scene: &Scene, seed: u64) -> SpeckleModel {
    let plan = SpecklePlan::new(scene, seed).expect("small patterns");
    SpeckleModel::generate(scene, &plan).expect("small patterns")
}

/// A frame with speckle, or without.
pub(crate) fn frame(
    scene: &Scene,
    speckle: Option<&SpeckleModel>,
    frame: u32,
    options: &RenderOptions,
) -> Frame {
    let go_on = AtomicBool::new(false);
    render_frame(scene, speckle, frame, options, &|_| (), &go_on).expect("a render")
}
