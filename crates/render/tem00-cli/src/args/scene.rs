//! The options of the commands that render a scene.

use std::path::PathBuf;

use clap::Args;
use tem00_report::args::{FileArgs, IndexRange};
use tem00_tracer::{RenderOptions, Sampling};

/// A scene, and what is rendered of it.
#[derive(Args, Clone, Debug)]
pub struct SceneArgs {
    /// The scene file, or - for standard input.
    #[arg(value_name = "SCENE.toml")]
    pub scene: PathBuf,

    /// Restrictions on reading the scene file.
    #[command(flatten)]
    pub files: FileArgs,

    /// Output folder, created if missing [default: out/ and the name of the scene].
    #[arg(short, long, value_name = "DIR")]
    pub output: Option<PathBuf>,

    /// Camera samples per pixel, 1 to a million [default: from the scene].
    #[arg(long, alias = "samples", value_name = "N")]
    #[arg(value_parser = clap::value_parser!(u32).range(1..=1_000_000))]
    spp: Option<u32>,

    /// Distribute samples adaptively; --spp becomes the maximum mean per pixel
    /// [default: from the scene].
    #[arg(long)]
    adaptive: bool,

    /// Random seed [default: from the scene].
    #[arg(long, value_name = "N")]
    seed: Option<u64>,

    /// Render only frame N or frames FIRST to LAST, inclusive, 0-based; each frame is independent
    /// of the selection [default: all].
    #[arg(long, visible_alias = "frame", value_name = "N|FIRST..LAST")]
    pub frames: Option<IndexRange>,

    /// Number of threads, 1 to 1024 and at most four per core; it does not change the result
    /// [default: all].
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u16).range(1..=1024))]
    pub threads: Option<u16>,

    /// Render without speckle.
    #[arg(long)]
    pub no_speckle: bool,
}

impl SceneArgs {
    /// Replaces the options of a scene by those of the command line.
    pub fn overrule(&self, options: &mut RenderOptions) {
        options.samples_per_pixel = self.spp.unwrap_or(options.samples_per_pixel);
        options.seed = self.seed.unwrap_or(options.seed);
        if self.adaptive {
            options.sampling = Sampling::Adaptive;
        }
    }
}
