//! The command line of `tem00 speckle`.

use clap::Args;
use tem00_config::ANGLE;
use tem00_report::args::{length, positive};

/// Compute the speckle size of a camera, the contrast in a pixel, and the motions that decorrelate
/// it.
///
/// This needs only the lens, the distance and the wavelength. The surface is rough and illuminated
/// over more than a resolution cell. The size h, wavelength times working f-number, is the period
/// of the finest fringes that the pupil transmits.
#[derive(Args, Debug)]
#[command(after_help = SPECKLE_EXAMPLES)]
pub(crate) struct SpeckleArgs {
    /// Vacuum wavelength, as in "650 nm".
    #[arg(long, value_name = "LENGTH", value_parser = length)]
    pub(crate) wavelength: f64,

    /// Focal length of the lens, as in "25 mm".
    #[arg(long, value_name = "LENGTH", value_parser = length)]
    pub(crate) focal_length: f64,

    /// F-number as engraved on the lens, for focus at infinity.
    #[arg(long, value_name = "F", value_parser = positive)]
    pub(crate) f_number: f64,

    /// Distance from the surface in focus to the entrance pupil, as in "300 mm"; for a thin lens,
    /// to the lens.
    #[arg(long, value_name = "LENGTH", value_parser = length)]
    pub(crate) distance: f64,

    /// Pixel pitch of the sensor, as in "3.45 um", for the contrast in a pixel.
    #[arg(long, value_name = "LENGTH", value_parser = length)]
    pub(crate) pixel_pitch: Option<f64>,

    /// Pupil magnification, the diameter of the exit pupil over the diameter of the entrance pupil;
    /// 1 for a thin lens.
    #[arg(long, value_name = "RATIO", default_value_t = 1.0, value_parser = positive)]
    pub(crate) pupil_magnification: f64,

    /// Angle between the collimated light and the line of sight, as in "30 deg"; the
    /// surface faces the camera.
    #[arg(long, value_name = "ANGLE", default_value = "0 deg", value_parser = angle)]
    pub(crate) angle: f64,

    /// Print JSON, in SI units, instead of a table.
    #[arg(long)]
    pub(crate) json: bool,
}

const SPECKLE_EXAMPLES: &str = "\
Examples:
  tem00 speckle --wavelength \"650 nm\" --focal-length \"25 mm\" --f-number 8 --distance \"300 mm\"
  tem00 speckle --wavelength 532nm --focal-length 50mm --f-number 4 --distance 0.4m \\
    --pixel-pitch 3.45um --angle 30deg --json";

/// Reads an angle below a right angle, with its unit.
fn angle(text: &str) -> Result<f64, String> {
    let allowed = 0.0..core::f64::consts::FRAC_PI_2;
    (ANGLE.parse(text))
        .filter(|angle| allowed.contains(angle))
        .ok_or_else(|| {
            "must be an angle from 0 to below 90 deg with its unit, such as \"30 deg\"".into()
        })
}
