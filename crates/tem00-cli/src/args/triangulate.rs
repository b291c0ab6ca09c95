//! The command line of `tem00 triangulate`.

use std::path::PathBuf;

use clap::Args;

use super::{FileArgs, FrameRange};

/// Render what a triangulation sensor sees, and measure the part from it.
///
/// The scene file is that of `tem00 render`, with a section [sensor] and, if the defaults do not fit,
/// [detector], [calibration] and [scan]. Its first laser draws the line. Every frame is rendered, exposed,
/// searched for the line and turned into points with their uncertainties; the frames together make a
/// point cloud and, if there are several, a height map.
///
/// If no point of the line is valid, the frames and the report are written, but there is no number, and the
/// exit code is 3.
#[derive(Args, Debug)]
#[command(after_help = TRIANGULATE_EXAMPLES)]
pub(crate) struct TriangulateArgs {
    /// The scene file, with a section [sensor], or - for standard input.
    #[arg(value_name = "SCENE.toml")]
    pub(crate) scene: PathBuf,

    #[command(flatten)]
    pub(crate) files: FileArgs,

    /// The folder for the results, made if it is missing [default: out/<name of the scene>].
    #[arg(short, long, value_name = "DIR")]
    pub(crate) output: Option<PathBuf>,

    /// Camera samples per pixel, 1 to a million [default: from the scene].
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u32).range(1..=1_000_000))]
    pub(crate) spp: Option<u32>,

    /// The seed of everything random: camera samples, speckle, noise of the sensor [default: from the
    /// scene].
    #[arg(long, value_name = "N")]
    pub(crate) seed: Option<u64>,

    /// Only these frames, counted from 0: one, or FIRST..LAST with both ends [default: all].
    #[arg(long, visible_alias = "frame", value_name = "N|FIRST..LAST")]
    pub(crate) frames: Option<FrameRange>,

    /// Threads to work with, 1 to 1024; the result does not depend on it [default: all].
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u16).range(1..=1024))]
    pub(crate) threads: Option<u16>,

    /// Leave the speckle out.
    #[arg(long)]
    pub(crate) no_speckle: bool,
}

const TRIANGULATE_EXAMPLES: &str = "\
Examples:
  tem00 triangulate scenes/triangulation/step_gauge.toml            into out/step_gauge/
  tem00 triangulate scenes/triangulation/step_gauge.toml --seed 7   another part of the same kind
  tem00 triangulate scenes/triangulation/hexagon_nut.toml --frames 0..9

Files:
  report.html              all results on one page, which opens offline
  measurement.json         what was measured and with what, how uncertain it is and why
  raw_0000.png …           the frames as the camera gives them, 8 or 16 bits (or TIFF, see [scan])
  profile_0000.csv …       the points of each profile, with uncertainties, in metres and pixels
  points.ply               the point cloud: x y z in metres, their standard uncertainties, intensity
  height.png, height.npy   the height map of several profiles: 16 bits with scale and offset, 0 a hole;
                           and in metres, NaN a hole; height_uncertainty.npy beside it
  boards/                  photographs of boards, if the calibration is estimated: for `tem00 calibrate`
  profile, uncertainty, height_map, uncertainty_map: diagrams, each .svg and .png";

#[cfg(test)]
mod tests {
    use clap::Parser;

    use super::*;
    use crate::args::{Cli, Command};

    fn parse(line: &str) -> Result<TriangulateArgs, clap::Error> {
        let cli = Cli::try_parse_from(line.split_whitespace())?;
        match cli.command {
            Command::Triangulate(args) => Ok(args),
            other => panic!("{other:?} is not triangulate"),
        }
    }

    #[test]
    fn every_option_of_triangulate_is_understood() {
        let line = "tem00 triangulate a.toml -o d --spp 3 --seed 4 --frames 2..7 --threads 2 \
                    --no-speckle";
        let args = parse(line).expect("the line is valid");
        assert_eq!(args.scene, PathBuf::from("a.toml"));
        assert_eq!(args.output, Some(PathBuf::from("d")));
        assert_eq!((args.spp, args.seed), (Some(3), Some(4)));
        assert_eq!(args.frames, Some(FrameRange { first: 2, last: 7 }));
        assert_eq!(args.threads, Some(2));
        assert!(args.no_speckle, "it is on");
    }

    #[test]
    fn a_scene_is_all_that_triangulate_needs() {
        let args = parse("tem00 triangulate a.toml").expect("the line is valid");
        assert!(args.output.is_none() && args.frames.is_none(), "{args:?}");
        assert!(parse("tem00 triangulate").is_err(), "no scene");
    }
}
