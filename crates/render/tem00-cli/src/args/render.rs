//! The command line of `tem00 render`.

use clap::{
    Args,
    builder::{PossibleValuesParser, TypedValueParser},
};
use tem00_config::Change;
use tem00_report::args::{crop, positive};
use tem00_tracer::Method;

use super::SceneArgs;

/// Render a scene: PNG preview, OpenEXR layers and a JSON summary.
///
/// A scene file needs only a laser, a camera and a surface. The size of the speckle
/// patterns is chosen from the camera, the image and the motion, and printed with the reason.
#[derive(Args, Clone, Debug)]
#[command(after_help = RENDER_EXAMPLES)]
pub struct RenderArgs {
    /// The scene.
    #[command(flatten)]
    pub common: SceneArgs,

    /// Skip frames that an earlier run of the same render has finished in the folder.
    #[arg(long)]
    pub(crate) resume: bool,

    /// Render only this part of the image, in pixels from the upper left corner [default: from the
    /// scene].
    #[arg(long, value_name = "X,Y,WIDTH,HEIGHT", value_parser = crop_of_scene)]
    pub(crate) crop: Option<Change>,

    /// Direction of light transport: `path` from the camera, `light` from the lasers
    /// [default: from the scene].
    #[arg(long, value_name = "METHOD", value_parser = method())]
    pub(crate) method: Option<Method>,

    /// Maximum number of surfaces between source and camera [default: from the scene].
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u32).range(1..=1_000_000))]
    pub(crate) max_depth: Option<u32>,

    /// Target relative standard error per pixel; a pixel takes 1 to 64 times --spp samples, as
    /// needed [default: from the scene].
    #[arg(long, value_name = "ERROR", value_parser = relative_error, conflicts_with = "adaptive")]
    pub(crate) target_error: Option<f64>,

    /// Use the reference integrator, one sample at a time: slow, for comparison.
    #[arg(long, conflicts_with_all = ["target_error", "adaptive"])]
    pub(crate) reference: bool,

    /// Do not render: report how much the camera will see of each laser and why, and draw camera,
    /// lasers and parts. The exit code is 3 if it will see no laser light.
    #[arg(long)]
    pub(crate) check: bool,

    /// Radiance in W/(m² sr) that the preview shows as white [default: from the scene,
    /// or 95 % of the pixels that laser light reaches in the first frame are darker].
    #[arg(long, value_name = "RADIANCE", value_parser = radiance)]
    pub(crate) white_level: Option<f64>,
}

const RENDER_EXAMPLES: &str = "\
Examples:
  tem00 render examples/scenes/spot.toml                       quick look, into out/spot/
  tem00 render examples/scenes/spot.toml --check               will the camera see the laser?
  tem00 render examples/scenes/spot.toml --spp 256 -o good     slower, with less noise
  tem00 render examples/scenes/spot.toml --no-speckle          the same light without interference
  tem00 render examples/scenes/moved_surface.toml --resume     continue after an interruption
  tem00 render examples/scenes/moved_surface.toml --frames 1   one frame, for example of several machines

Files:
  <scene>.png     preview, 16 bits, in the colour of the laser; <scene>_0000.png … for several frames
  <scene>.exr     layers per laser: single, multiple, speckle, radiance, in W/(m² sr),
                  and variance; lights, depth, normal, samples
  <scene>.json    power on the target, speckle size, contrast, exposure, speed; with several frames
                  also one per frame, which --resume reads
  <scene>_overview.svg|png  camera, lasers and parts from three sides; with --check, and if the camera
                  sees no laser light";

fn method() -> impl TypedValueParser<Value = Method> {
    let named = |name: String| Method::ALL.into_iter().find(|method| method.name() == name);
    PossibleValuesParser::new(Method::ALL.map(Method::name))
        .map(move |name| named(name).unwrap_or_default())
}

fn relative_error(text: &str) -> Result<f64, String> {
    match positive(text)? {
        value if (1e-6..=1.0).contains(&value) => Ok(value),
        _ => Err("must lie between 1e-6 and 1".into()),
    }
}

/// Reads a radiance that single precision can hold.
fn radiance(text: &str) -> Result<f64, String> {
    match positive(text)? {
        value if (1e-30..=1e30).contains(&value) => Ok(value),
        _ => Err("must lie between 1e-30 and 1e30 W/(m² sr)".into()),
    }
}

/// Returns what a part of the image changes in the scene, whose reader sees that it lies in the
/// image.
fn crop_of_scene(text: &str) -> Result<Change, String> {
    crop(text)?;
    format!("render.crop=[{text}]").parse()
}
