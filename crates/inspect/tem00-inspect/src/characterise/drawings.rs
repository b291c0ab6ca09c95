//! The drawings of characteristics.

use std::path::Path;

use tem00_report::{
    failure::Failure,
    output,
    plot::{
        Chart, Drawing,
        colours::{FORMULAS, TRIALS},
    },
};
use tem00_topography::{Characteristics, GrooveResult};

const RESPONSE: &str = "response";
const GROOVES: &str = "grooves";

/// Draws the results into the folder, and returns the drawings with their captions.
pub(super) fn save(
    found: &Characteristics,
    folder: &Path,
) -> Result<Vec<(String, &'static str)>, Failure> {
    // Drawings of another run would be taken for drawings of this run.
    output::remove(folder, &[RESPONSE, GROOVES], &["svg", "png"])?;
    let mut drawings = Vec::new();
    if let Some(drawing) = response(found) {
        let caption = "Errors of the mean heights of a level flat over the range.";
        drawings.push((drawing.save(folder, RESPONSE)?, caption));
    }
    if found.grooves.iter().any(Option::is_some) {
        let caption =
            "Depth of grooves as measured in their middle, by the true depth, over their width.";
        drawings.push((grooves(&found.grooves).save(folder, GROOVES)?, caption));
    }
    Ok(drawings)
}

fn response(found: &Characteristics) -> Option<Drawing> {
    let response = found.response.as_ref()?;
    let points = response.heights.iter().zip(&response.deviations);
    let points = points.map(|(height, deviation)| (1e3 * height, 1e6 * deviation));
    let chart = Chart::new(
        "Heights of a level flat",
        ["height (mm)", "measured less true (µm)"],
    );
    Some(chart.dots("", points).coloured(FORMULAS).draw())
}

fn grooves(found: &[Option<GrooveResult>; 2]) -> Drawing {
    let mut chart = Chart::new(
        "Depth of grooves",
        ["width (µm)", "measured depth by true depth"],
    );
    let names = ["along the profile", "along the scan"];
    for ((grooves, name), colour) in found.iter().zip(names).zip([FORMULAS, TRIALS]) {
        let Some(grooves) = grooves else { continue };
        let points = grooves.responses.iter();
        let points = points.map(|groove| (1e6 * groove.width, groove.response.value));
        chart = chart.line(name, points).coloured(colour);
    }
    chart.draw()
}
