//! `tem00-inspect list`: the names that set-ups can use.

use std::{io::Write, iter};

use tem00_report::{
    digits::rounded,
    failure::Failure,
    report::{Cell, Column, Table},
};
use tem00_triangulation::{LineMethod, SensorDescription};

use crate::args::{ListArgs, Listed};

/// Prints the requested list, with its sources.
///
/// # Errors
///
/// Returns a failure if standard output cannot be written.
pub(crate) fn run(args: &ListArgs, out: &mut impl Write) -> Result<(), Failure> {
    let (table, note) = match args.what {
        Listed::Detectors => (detectors(), DETECTORS),
        Listed::Sensors => (sensors(), SENSORS),
    };
    table
        .write_text(out)
        .and_then(|()| writeln!(out, "\n{note}"))
        .map_err(|error| Failure::stdout(&error))
}

const DETECTORS: &str = "\
In [detector]: method = \"parabola\". --detector of `tem00-inspect lines` takes the same names.";

fn detectors() -> Table {
    let headings = ["method", "minimum window", "position of the line"];
    let mut table = Table::new("", headings.map(Column::shown));
    for method in LineMethod::ALL {
        let window = method.min_window().to_string();
        table.row([method.name(), &window, place_of_line(&method)].map(Cell::from));
    }
    table
}

fn place_of_line(method: &LineMethod) -> &'static str {
    match method {
        LineMethod::CentreOfGravity => "centre of gravity over the window",
        LineMethod::ThresholdedCentreOfGravity { .. } => {
            "of what lies above `threshold` of the peak (Thomas et al. 2006)"
        }
        LineMethod::IteratedCentreOfGravity => "over a window that is moved onto its result",
        LineMethod::Parabola => {
            "vertex of a parabola through the brightest pixel and its neighbours"
        }
        LineMethod::LogGaussian => {
            "vertex through their logarithms; exact for points of a Gaussian"
        }
        LineMethod::LinearInterpolation => "straight flanks of equal slope (Naidu and Fisher 1991)",
        LineMethod::BlaisRioux { .. } => {
            "zero of a derivative filter of `order` taps (Blais and Rioux 1986)"
        }
        LineMethod::GaussianFit => "the Gaussian on a background that fits best, over pixels",
        LineMethod::Steger { .. } => "ridge of the image smoothed by `sigma` (Steger 1998)",
        _ => "",
    }
}

const SENSORS: &str = "\
Typical values and no measurement: an industrial CMOS sensor with global shutter and pixels of 3.45 µm, as
data sheets after EMVA 1288 have them around 2020. [sensor] takes them where it has no value of its own,
with `bit_depth` = 12 unless it says otherwise; `quantum_efficiency` and `exposure` must be given.";

fn sensors() -> Table {
    type Value = fn(&SensorDescription) -> f64;
    let rows: [(&str, Value); 7] = [
        ("full_well (electrons)", |sensor| sensor.full_well),
        ("dark_noise (electrons)", |sensor| sensor.dark_noise),
        ("dark_current (electrons/s)", |sensor| sensor.dark_current),
        ("prnu", |sensor| sensor.prnu),
        ("dsnu (electrons)", |sensor| sensor.dsnu),
        ("black_level (DN)", |sensor| sensor.black_level),
        ("gain (DN/electron)", |sensor| sensor.gain),
    ];
    let sensors = [8, 10, 12, 14, 16].map(SensorDescription::typical);
    let bits = sensors.iter().map(|sensor| sensor.bit_depth.to_string());
    let headings = iter::once("bit_depth".to_owned()).chain(bits);
    let mut table = Table::new("", headings.map(Column::shown).collect::<Vec<_>>());
    for (name, value) in rows {
        let values = sensors.iter().map(|sensor| rounded(value(sensor), 4));
        let cells = iter::once(name.to_owned()).chain(values).map(Cell::from);
        table.row(cells.collect::<Vec<_>>());
    }
    table
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn nothing_is_listed_without_words() {
        for method in LineMethod::ALL {
            assert!(!place_of_line(&method).is_empty(), "{method}");
        }
    }
}
