//! The command line of `tem00-inspect triangulate`.

use clap::Args;
use tem00_cli::SceneArgs;

/// Render what a triangulation sensor sees, and measure the part from it.
///
/// The scene file is that of `tem00 render`, with a section [sensor] and, if the defaults do not
/// fit, [detector], [calibration] and [scan]. Its first laser draws the line. Every frame is
/// rendered, exposed, searched for the line and turned into points with their uncertainties; the
/// frames together make a point cloud and, if there are several, a height map.
///
/// If no point of the line is valid, the frames and the report are written, but there is no number,
/// and the exit code is 3.
#[derive(Args, Clone, Debug)]
#[command(after_help = TRIANGULATE_EXAMPLES)]
pub(crate) struct TriangulateArgs {
    #[command(flatten)]
    pub(crate) common: SceneArgs,
}

const TRIANGULATE_EXAMPLES: &str = "\
Examples:
  tem00-inspect triangulate examples/scenes/triangulation/step_gauge.toml            into out/step_gauge/
  tem00-inspect triangulate examples/scenes/triangulation/step_gauge.toml --seed 7   another part of the same kind
  tem00-inspect triangulate examples/scenes/triangulation/hexagon_nut.toml --frames 0..9

Files:
  report.html              all results on one page, which opens offline
  measurement.json         what was measured and with what, how uncertain it is and why
  raw_0000.png …           the frames as the camera gives them, 8 or 16 bits (or TIFF, see [scan])
  profile_0000.csv …       the points of each profile, with uncertainties, in metres and pixels
  points.ply, points.pcd   the point cloud: x y z in metres, their standard uncertainties, intensity
  height.png, height.npy   the height map of several profiles: 16 bits with scale and offset, 0 a hole;
                           and in metres, NaN a hole; height_uncertainty.npy beside it
  height.x3p               the same for surface metrology, if the scan has a pitch
  reflectance.png …        the grey values across the line, summed, and width.png, like height.png
  boards/                  photographs of boards, if the calibration is estimated: for `tem00-inspect calibrate`
  profile, uncertainty, height_map, uncertainty_map: diagrams, each .svg and .png";
