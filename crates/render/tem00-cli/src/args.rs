//! The command line.

mod list;
mod pupil;
mod render;
mod scene;
mod speckle;

use std::path::PathBuf;

use clap::{Args, Parser, Subcommand};
use tem00_numerics::Crop;
use tem00_report::{
    args::{CompletionsArgs, ManArgs, black_level, crop},
    image::Transfer,
};
use tem00_speckle::Pupil;

use self::pupil::pupil;
pub(crate) use self::{
    list::{ListArgs, Listed},
    speckle::SpeckleArgs,
};
pub use self::{render::RenderArgs, scene::SceneArgs};

const EXAMPLES: &str = "\
Examples:
  tem00 render examples/scenes/line_with_speckle.toml          render a scene into out/line_with_speckle/
  tem00 pattern -o speckle.png                        write a speckle pattern and check it
  tem00 stats photo.png                               measure the speckle in an image
  tem00 speckle --wavelength 650nm --focal-length 25mm --f-number 8 --distance 300mm
                                                      speckle size and contrast of a camera

Set-ups of laser triangulation, and camera frames: tem00-inspect --help

Data goes to standard output, everything else to standard error.
Exit codes: 0 success, 1 failure while running, 2 bad input or usage, 3 nothing measured or found,
130 interrupted.";

/// Laser light with speckle, from scene file to image.
#[derive(Debug, Parser)]
#[command(name = "tem00", version, max_term_width = 100, after_help = EXAMPLES)]
pub(crate) struct Cli {
    #[command(subcommand)]
    pub(crate) command: Command,

    /// Suppress notes and progress; print only results and errors.
    #[arg(short, long, global = true)]
    pub(crate) quiet: bool,
}

#[expect(clippy::large_enum_variant, reason = "there is one command a process")]
#[derive(Debug, Subcommand)]
pub(crate) enum Command {
    Render(RenderArgs),
    Pattern(PatternArgs),
    Stats(StatsArgs),
    Speckle(SpeckleArgs),
    List(ListArgs),
    Completions(CompletionsArgs),
    Man(ManArgs),
}

/// Generate a speckle pattern and compare it with the theory.
///
/// The pattern has Q × Q samples, is periodic, and has mean 1. A random pupil field of diameter C
/// gives speckles of Q / C samples, and so does a measured or computed field read with --field. The
/// table on standard output compares measured values with theory and states the tolerance of each.
#[derive(Args, Debug)]
#[command(after_help = PATTERN_EXAMPLES)]
pub(crate) struct PatternArgs {
    /// Output file: .png (16-bit grey), .exr or .npy (raw intensity, mean 1).
    #[arg(short, long, value_name = "FILE")]
    pub(crate) output: PathBuf,

    /// Size Q of the pattern, in samples [default: 512, or 4 C with --field].
    #[arg(long, value_name = "Q")]
    pub(crate) size: Option<usize>,

    /// Diameter C of the pupil, in samples: 8 to Q / 2 [default: Q / 4, speckles of 4 samples;
    /// with --field its shorter side].
    #[arg(long, value_name = "C")]
    pub(crate) diameter: Option<usize>,

    /// Seed of the random phases.
    #[arg(long, value_name = "N", default_value_t = 0)]
    pub(crate) seed: u64,

    /// Complex pupil field, measured or computed, instead of a random one: a NumPy array
    /// of complex64 or complex128, height × width, with the pupil in its middle.
    #[arg(long, value_name = "FILE.npy", conflicts_with = "seed")]
    pub(crate) field: Option<PathBuf>,

    /// Shape of the pupil; annulus:0.3 sets the inner diameter, rectangle:0.5 the height, both
    /// in units of C [annulus alone: 0.5; rectangle alone: 1].
    #[arg(long, value_name = "circle|annulus[:INNER]|rectangle[:HEIGHT]", default_value = "circle",
          value_parser = pupil)]
    pub(crate) pupil: Pupil,

    /// Write the complex amplitude instead of the intensity (.npy, or .exr with two channels).
    #[arg(long)]
    pub(crate) amplitude: bool,
}

const PATTERN_EXAMPLES: &str = "\
Examples:
  tem00 pattern -o speckle.png
  tem00 pattern -o fine.npy --size 2048 --diameter 1024 --seed 7
  tem00 pattern -o telescope.exr --pupil annulus:0.4
  tem00 pattern -o measured.npy --field pupil.npy     speckle behind a measured field
  tem00 pattern -o stopped.npy --field pupil.npy --diameter 300 --size 2048";

/// Measure the speckle in an image and compare it with theory.
///
/// The image may come from a camera, a simulation or this program: grey or colour, an OpenEXR
/// channel, or a two-dimensional NumPy array. The light should be even over the image: select a
/// part with --crop, or divide by the local mean with --flatten. Uneven light increases the
/// contrast, which gives a warning.
#[derive(Args, Debug)]
#[command(after_help = STATS_EXAMPLES)]
pub(crate) struct StatsArgs {
    /// Image: .png, .tif, .jpg, .bmp, .pgm, .exr or .npy.
    pub(crate) image: PathBuf,

    /// Use only this part of the image, in pixels from the upper left corner.
    #[arg(long, value_name = "X,Y,WIDTH,HEIGHT", value_parser = crop)]
    pub(crate) crop: Option<Crop>,

    /// Divide the image by its mean over PIXELS × PIXELS around each pixel, and correct contrast
    /// and speckle size for the effect of this division [default: 20 speckle sizes, at most a third
    /// of the image].
    #[arg(long, value_name = "PIXELS", num_args = 0..=1, require_equals = true)]
    pub(crate) flatten: Option<Option<usize>>,

    /// Channel: R, G, B, or `channel` or `layer.channel` of an OpenEXR file [default:
    /// Y, or the mean of R, G and B, or the only one that contains light].
    #[arg(long, value_name = "NAME")]
    pub(crate) channel: Option<String>,

    /// Transfer curve from light to grey values [default: from the file, otherwise linear].
    #[arg(long, value_name = "CURVE")]
    pub(crate) transfer: Option<Transfer>,

    /// Grey value without light, to be subtracted; noise around it may become negative.
    #[arg(long, value_name = "DN", value_parser = black_level)]
    pub(crate) black_level: Option<f64>,

    /// Print JSON instead of a table, including the curves of the plot.
    #[arg(long)]
    pub(crate) json: bool,

    /// Draw a page with histogram, autocovariance and power spectrum, compared with theory.
    #[arg(long, value_name = "FILE.svg|.png")]
    pub(crate) plot: Option<PathBuf>,
}

const STATS_EXAMPLES: &str = "\
Examples:
  tem00 stats photo.png
  tem00 stats photo.tif --crop 100,80,400,300
  tem00 stats photo.jpg --transfer srgb --flatten
  tem00 stats photo.png --plot page.svg
  tem00 stats photo.png --channel R --transfer srgb
  tem00 stats raw.tif --black-level 64
  tem00 stats out/spot/spot.exr --channel speckle --json";

#[cfg(test)]
mod tests {
    use clap::CommandFactory;

    use super::*;

    #[test]
    fn the_command_line_is_consistent() {
        Cli::command().debug_assert();
    }
}
