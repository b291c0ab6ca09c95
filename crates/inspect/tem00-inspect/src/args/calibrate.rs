//! The command line of `tem00-inspect calibrate`.

use std::path::PathBuf;

use clap::Args;

use tem00_report::args::{length, positive};

use super::lines::DetectorArgs;

/// Calibrate camera and laser plane from photographs of a checkerboard and of the line on it.
///
/// The folder holds pairs of images of the same camera, of 8 to 16 bits: `board_01.png` shows a
/// whole checkerboard in ordinary light, and `line_01.png` the laser line on it in the same pose;
/// .tif, .jpg, .bmp, .pgm and .ppm are taken, too. Tilt the board by 15° to 30° about different
/// axes and hold it at different heights. The first board, by name, is the reference: heights are
/// counted from it.
///
/// The table on standard output lists what was found and its standard uncertainty.
#[derive(Args, Debug)]
#[command(after_help = CALIBRATE_EXAMPLES)]
pub(crate) struct CalibrateArgs {
    /// Folder with the photographs.
    #[arg(value_name = "FOLDER")]
    pub(crate) folder: PathBuf,

    /// Number of inner corners of the board, where four squares meet, per row and per column.
    #[arg(long, value_name = "COLUMNSxROWS", value_parser = corners)]
    pub(crate) corners: [usize; 2],

    /// Side of a square, for example "5 mm".
    #[arg(long, value_name = "LENGTH", value_parser = length)]
    pub(crate) square: f64,

    /// Pixel pitch of the sensor, for example "3.45 um".
    #[arg(long, value_name = "LENGTH", value_parser = length)]
    pub(crate) pixel_pitch: f64,

    /// Focal length of the lens, for example "25 mm": the starting value of the fit, from which the
    /// distance of sharp focus follows.
    #[arg(long, value_name = "LENGTH", value_parser = length)]
    pub(crate) focal_length: Option<f64>,

    /// f-number of the lens, for blur and speckle.
    #[arg(long, value_name = "F", default_value_t = 8.0, value_parser = positive)]
    pub(crate) f_number: f64,

    /// The sensor is tilted (Scheimpflug): fit its tilt instead of the principal point.
    #[arg(long)]
    pub(crate) tilted: bool,

    /// Number of coefficients of radial distortion to fit, 0 to 3.
    #[arg(
        long,
        value_name = "N",
        default_value_t = 2,
        value_parser = clap::value_parser!(u8).range(0..=3)
    )]
    pub(crate) radial: u8,

    #[command(flatten)]
    pub(crate) detector: DetectorArgs,

    /// Colour channel: R, G or B [default: the mean of R, G and B].
    #[arg(long, value_name = "NAME")]
    pub(crate) channel: Option<String>,

    /// Output file [default: calibration.json in the folder].
    #[arg(short, long, value_name = "FILE.json")]
    pub(crate) output: Option<PathBuf>,
}

const CALIBRATE_EXAMPLES: &str = "\
Examples:
  tem00-inspect calibrate photos --corners 9x6 --square \"5 mm\" --pixel-pitch \"3.45 um\"
  tem00-inspect calibrate photos --corners 9x6 --square \"5 mm\" --pixel-pitch \"3.45 um\" --tilted
  tem00-inspect lines frame.png --calibration photos/calibration.json";

fn corners(text: &str) -> Result<[usize; 2], String> {
    let number = |text: &str| text.trim().parse().ok().filter(|n| (3..=50).contains(n));
    text.split_once(['x', '×'])
        .and_then(|(columns, rows)| Some([number(columns)?, number(rows)?]))
        .ok_or_else(|| "must be two numbers from 3 to 50, such as 9x6".into())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn boards_are_understood() {
        assert_eq!(corners("9x6"), Ok([9, 6]));
        assert_eq!(corners("12 × 7"), Ok([12, 7]));
        for bad in ["9", "9x", "2x6", "9x6x3", "-9x6", "9x51"] {
            assert!(corners(bad).is_err(), "{bad}");
        }
    }
}
