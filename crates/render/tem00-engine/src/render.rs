mod pass;
mod pilot;

use core::sync::atomic::AtomicBool;

use tem00_geometry::Intersector;
use tem00_tracer::{
    FilterSampler, Frame, Method, RenderError, RenderOptions, Scene, SpeckleBelow, TracerError,
};

use self::pass::PathPass;
use crate::{
    SpeckleModel,
    integrator::Integrator,
    light_tracer::{LightSelection, LightTracer},
    sampler::sample_counts,
    survey::{Survey, asks_for_survey},
};

/// The number of cells along the longer side of an image in the survey of multiple light.
const SURVEY_CELLS: usize = 64;

/// Returns the number of camera samples and light paths that one frame takes, of which
/// [`render_frame`] reports the progress; a target error may take more.
pub fn samples_per_frame(scene: &Scene, options: &RenderOptions) -> u64 {
    let whole = (scene.camera.width() * scene.camera.height()) as u64;
    let cropped = options.crop.map_or(whole, |crop| {
        (crop.width as u64).saturating_mul(crop.height as u64)
    });
    let light_paths = match light_traced(scene, options) {
        Some(_) => whole * scene.lasers.len() as u64,
        None => 0,
    };
    u64::from(options.samples_per_pixel).saturating_mul(cropped + light_paths)
}

/// Renders one frame, on the threads of the current rayon pool.
///
/// One pass over the image serves all lasers and lights. Without a `speckle` model every speckle
/// factor is 1. `progress` receives, from any thread, the number of camera samples and light paths
/// done since its last call; once `cancel` is set, the render stops within some thousand of them
/// per thread. The result has the same bits for any number of threads.
///
/// # Errors
///
/// Returns [`RenderError::Cancelled`] if `cancel` was set before the end, and an error if an option
/// is out of its range, if the geometry cannot be built, or if the layers exceed the memory that
/// the system has available (Linux).
///
/// # Panics
///
/// Panics unless `frame < scene.frames` and `speckle` has a pattern for every laser, as a model
/// of the same scene has.
pub fn render_frame(
    scene: &Scene,
    speckle: Option<&SpeckleModel>,
    frame: u32,
    options: &RenderOptions,
    progress: &(dyn Fn(u64) + Sync),
    cancel: &AtomicBool,
) -> Result<Frame, RenderError> {
    assert!(
        frame < scene.frames,
        "frame {frame} of a scene with {}",
        scene.frames
    );
    assert!(
        speckle.is_none_or(|model| model.pattern_count() >= scene.lasers.len()),
        "the speckle model belongs to another scene"
    );
    let area = options.area(&scene.camera)?;
    scene.check_bodies(options)?;
    let intersector = Intersector::build(&scene.shapes_at(frame))?;
    let speckle = speckle.map(|model| {
        let speckle = model.in_frame(scene, frame)?;
        let survey = Survey {
            scene,
            frame,
            intersector: &intersector,
            change: speckle.change(),
            seed: options.seed,
            max_depth: options.max_depth,
            cells: SURVEY_CELLS,
        };
        let map = asks_for_survey(scene, frame, options).then(|| survey.map());
        let below = SpeckleBelow::in_frame(scene, frame, &intersector)?;
        let speckle = speckle.with_light_below(below);
        Ok::<_, TracerError>(speckle.with_multiple_light(map.flatten()))
    });
    let speckle = speckle.transpose()?;
    let integrator =
        Integrator::new(scene, frame, &intersector, options).with_speckle(speckle.as_ref());
    let selection = light_traced(scene, options);
    let pass = PathPass {
        integrator: &integrator,
        options,
        counts: sample_counts(options),
        filter: FilterSampler::new(options.filter)?,
        frame,
        area,
        light_traced: selection.is_some(),
        progress,
        cancel,
    };
    let mut rendered = pass.render()?;
    if let Some(selection) = selection {
        let camera = integrator.camera();
        let pixels = (camera.width() * camera.height()) as u64;
        let tracer = LightTracer {
            scene,
            camera,
            intersector: &intersector,
            speckle: speckle.as_ref(),
            frame,
            max_depth: options.max_depth,
            selection,
            area,
            // As many for each laser as the whole image has camera samples.
            paths: pixels * u64::from(options.samples_per_pixel),
            seed: options.seed,
        };
        for (laser, layers) in rendered.lasers.iter_mut().enumerate() {
            tracer.trace(laser, layers, progress, cancel)?;
        }
    }
    Ok(rendered)
}

/// Returns which light is followed from the lasers, if any.
///
/// Paths from the camera find all light except the light whose first hit is a mirror or glass;
/// where they look for the beams themselves, they find this light, too.
fn light_traced(scene: &Scene, options: &RenderOptions) -> Option<LightSelection> {
    match options.method {
        Method::Light => Some(LightSelection::All),
        Method::Path if options.samples_beams() || !scene.has_specular_surfaces() => None,
        Method::Path => Some(LightSelection::SpecularFirst),
    }
}

#[cfg(test)]
mod tests;
