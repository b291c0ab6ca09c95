//! Two worked examples of the *Guide to the expression of uncertainty in measurement*: what a gauge
//! block's length (H.1) and a circuit's resistance (H.2, with correlations) are uncertain by, and
//! which input dominates.
//!
//! ```sh
//! cargo run --release --example guide_to_uncertainty -- [FILE]
//! ```
//!
//! The table goes to `out/guide_to_uncertainty.csv` without a file.

#![expect(clippy::print_stdout, reason = "an example prints its answer")]

use std::{env, error::Error, fmt::Write, fs, path::PathBuf};

use tem00::uncertainty::{
    Correlation, CoverageProbability, Distribution, FirstOrder, Input, Inputs, UncertaintyError,
    coverage_factor,
};

const GAUGE: [(f64, f64, f64); 9] = [
    // Standard block, comparator and its errors in nm; expansion in 1/°C, temperatures in °C.
    (50_000_623.0, 25.0, 18.0),
    (215.0, 5.8, 24.0),
    (0.0, 3.9, 5.0),
    (0.0, 6.7, 8.0),
    (11.5e-6, 1.2e-6, f64::INFINITY),
    (-0.1, 0.2, f64::INFINITY),
    (0.0, 0.35, f64::INFINITY),
    (0.0, 0.58e-6, 50.0),
    (0.0, 0.029, 2.0),
];

fn gauge(x: &[f64]) -> f64 {
    x[0] + x[1] + x[2] + x[3] - x[0] * (x[7] * (x[5] + x[6]) + x[4] * x[8]) - 50_000_000.0
}

const CIRCUIT: [(f64, f64, f64); 3] = [
    // Volts, amperes, radians.
    (4.999, 0.0032, f64::INFINITY),
    (19.661e-3, 0.0095e-3, f64::INFINITY),
    (1.044_46, 0.000_75, f64::INFINITY),
];
const CORRELATIONS: [([usize; 2], f64); 3] = [([0, 1], -0.36), ([0, 2], 0.86), ([1, 2], -0.65)];

fn resistance(x: &[f64]) -> f64 {
    x[0] / x[1] * x[2].cos()
}

fn inputs(
    rows: &[(f64, f64, f64)],
    correlations: &[([usize; 2], f64)],
) -> Result<Inputs, UncertaintyError> {
    let input = |&(estimate, uncertainty, freedom): &(f64, f64, f64)| {
        Input::new(estimate, uncertainty, Distribution::Normal)?.with_degrees_of_freedom(freedom)
    };
    let inputs = rows.iter().map(input).collect::<Result<_, _>>()?;
    let correlation = |&(between, coefficient): &_| Correlation {
        between,
        coefficient,
    };
    Inputs::correlated(
        inputs,
        &correlations.iter().map(correlation).collect::<Vec<_>>(),
    )
}

fn main() -> Result<(), Box<dyn Error>> {
    let default = || "out/guide_to_uncertainty.csv".into();
    let file = env::args_os().nth(1).map_or_else(default, PathBuf::from);
    let gauge = FirstOrder::new(&inputs(&GAUGE, &[])?, gauge)?;
    let circuit = FirstOrder::new(&inputs(&CIRCUIT, &CORRELATIONS)?, resistance)?;
    let mut csv = String::from("example,quantity,value\n");
    for (name, unit, found) in [("gauge", "nm", &gauge), ("circuit", "ohm", &circuit)] {
        let (freedom, probability) = (found.degrees_of_freedom(), CoverageProbability::P99);
        let (k, expanded) = (
            coverage_factor(freedom, probability),
            found.expanded(probability),
        );
        println!(
            "{name}: {:.3} ± {expanded:.3} {unit} (99 %, k = {k:.2})",
            found.estimate()
        );
        let numbers = [found.estimate(), found.combined(), freedom, k, expanded];
        let names = [
            "estimate",
            "combined",
            "degrees_of_freedom",
            "coverage_factor",
            "expanded",
        ];
        for (quantity, number) in names.iter().zip(numbers) {
            writeln!(csv, "{name},{quantity},{number:e}")?;
        }
        for (index, part) in found.contributions().iter().enumerate() {
            println!(
                "  input {index}: {:.4} {unit}, {:.1} %",
                part.uncertainty,
                100.0 * part.variance_fraction
            );
            writeln!(csv, "{name},contribution_{index},{:e}", part.uncertainty)?;
        }
    }
    fs::create_dir_all(file.parent().unwrap_or(&file))?;
    Ok(fs::write(file, csv)?)
}
