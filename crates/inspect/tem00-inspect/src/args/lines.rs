//! The command line of `tem00-inspect lines`.

use std::path::PathBuf;

use clap::{Args, builder::PossibleValuesParser, builder::TypedValueParser};
use tem00_report::failure::Failure;
use tem00_triangulation::{DetectorSettings, LineDetector, LineMethod};

/// Find laser lines in images, to a fraction of a pixel.
///
/// The images come from a camera or from this program: grey or in colours. A line runs from left to
/// right, and has a position in each column (with --rows from top to bottom, and in each row). For
/// every image there is a table of all points and a picture of the image with the lines drawn on
/// it; the summary on standard output says how much of each line was found, how much it scatters
/// from column to column and how wide it is. If no image has a valid point of a line, or most
/// points are on saturated pixels, the exit code is 3.
#[derive(Args, Debug)]
#[command(after_help = LINES_EXAMPLES)]
pub(crate) struct LinesArgs {
    /// Images: .png, .tif, .jpg, .bmp, .pgm or .ppm.
    #[arg(required = true, value_name = "IMAGE")]
    pub(crate) images: Vec<PathBuf>,

    /// Output folder [default: out/lines].
    #[arg(short, long, value_name = "FOLDER")]
    pub(crate) output: Option<PathBuf>,

    #[command(flatten)]
    pub(crate) detector: DetectorArgs,

    /// Lines run from top to bottom, with one position per row.
    #[arg(long, conflicts_with = "calibration")]
    pub(crate) rows: bool,

    /// Colour channel: R, G or B [default: the mean of R, G and B].
    #[arg(long, value_name = "NAME")]
    pub(crate) channel: Option<String>,

    /// Bit depth of the camera, if lower than that of the file: 8, 10, 12, 14 or 16. A pixel at the
    /// largest value of that depth counts as saturated [default: the depth of the file, or the
    /// value at which grey values pile up].
    #[arg(long, value_name = "BITS", value_parser = bits)]
    pub(crate) bits: Option<u32>,

    /// Calibration made by `tem00-inspect calibrate`: the tables then contain points in space with
    /// their uncertainties.
    #[arg(long, value_name = "FILE.json")]
    pub(crate) calibration: Option<PathBuf>,

    /// Print the summary as JSON instead of a table.
    #[arg(long)]
    pub(crate) json: bool,
}

/// The options of the line detector.
#[derive(Args, Debug)]
pub(crate) struct DetectorArgs {
    /// Estimator of the position of the line in a column.
    #[arg(long = "detector", value_name = "METHOD", default_value = "centre_of_gravity",
          value_parser = method())]
    method: LineMethod,

    /// Number of pixels per column that the estimator uses, odd [default: 31, or more if the method
    /// needs it].
    #[arg(long, value_name = "N")]
    window: Option<usize>,

    /// Threshold of `thresholded_centre_of_gravity`, as a fraction of the peak, from 0 to below 1
    /// [default: 0.2].
    #[arg(long, value_name = "F", allow_negative_numbers = true)]
    threshold: Option<f64>,

    /// Number of taps of `blais_rioux`: 2, 4 or 8 [default: 4].
    #[arg(long, value_name = "N")]
    order: Option<usize>,

    /// Standard deviation of the Gaussian of `steger`, in pixels [default: 2].
    #[arg(long, value_name = "S", allow_negative_numbers = true)]
    sigma: Option<f64>,

    /// Minimum height of a line above the background, in grey values.
    #[arg(
        long,
        value_name = "DN",
        default_value_t = 10.0,
        allow_negative_numbers = true
    )]
    min_peak: f64,

    /// Maximum number of lines per column.
    #[arg(long, value_name = "K", default_value_t = 1)]
    max_lines: usize,
}

impl DetectorArgs {
    /// Returns the detector of a command; the saturation is for the image to say.
    ///
    /// # Errors
    ///
    /// Returns a failure that names an option which does not belong to the method or has no such
    /// value.
    pub(crate) fn detector(&self, command: &str) -> Result<LineDetector, Failure> {
        let settings = self.settings();
        let detector = settings
            .and_then(|settings| LineDetector::new(settings).map_err(|error| error.to_string()));
        let help = format!("`tem00-inspect {command} --help` lists what is allowed");
        detector.map_err(|message| Failure::input(message, help))
    }

    fn settings(&self) -> Result<DetectorSettings, String> {
        let method = self.method()?;
        let usual = DetectorSettings::default();
        Ok(DetectorSettings {
            method,
            window: self
                .window
                .unwrap_or_else(|| usual.window.max(method.min_window())),
            min_peak: self.min_peak,
            max_lines: self.max_lines,
            ..usual
        })
    }

    fn method(&self) -> Result<LineMethod, String> {
        let mut method = self.method;
        let given = [
            (
                "--threshold",
                self.threshold.is_some(),
                "thresholded_centre_of_gravity",
            ),
            ("--order", self.order.is_some(), "blais_rioux"),
            ("--sigma", self.sigma.is_some(), "steger"),
        ];
        for (option, given, owner) in given {
            if given && method.name() != owner {
                return Err(format!(
                    "{option} belongs to --detector {owner}, not to {method}"
                ));
            }
        }
        match &mut method {
            LineMethod::ThresholdedCentreOfGravity { threshold } => {
                *threshold = self.threshold.unwrap_or(*threshold);
            }
            LineMethod::BlaisRioux { order } => {
                let taps = self.order.unwrap_or_else(|| order.taps());
                *order = tem00_triangulation::FilterOrder::from_taps(taps)
                    .ok_or_else(|| format!("--order must be 2, 4 or 8, got {taps}"))?;
            }
            LineMethod::Steger { sigma } => *sigma = self.sigma.unwrap_or(*sigma),
            _ => (),
        }
        Ok(method)
    }
}

fn method() -> impl TypedValueParser<Value = LineMethod> {
    let names = LineMethod::ALL.map(|method| method.name());
    PossibleValuesParser::new(names).map(|name| {
        // One of the names above.
        LineMethod::from_name(&name).unwrap_or(LineMethod::CentreOfGravity)
    })
}

fn bits(text: &str) -> Result<u32, String> {
    match text.parse() {
        Ok(bits @ (8 | 10 | 12 | 14 | 16)) => Ok(bits),
        _ => Err("must be 8, 10, 12, 14 or 16".into()),
    }
}

const LINES_EXAMPLES: &str = "\
Examples:
  tem00-inspect lines frame.png
  tem00-inspect lines frames/*.tif --bits 12 --detector gaussian_fit --window 21 -o found
  tem00-inspect lines photo.png --channel R --max-lines 2
  tem00-inspect lines frame.png --calibration calibration.json     points in space";
