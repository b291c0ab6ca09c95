//! Notes on lines that were found, or not.

use std::path::Path;

use tem00_report::image::RawImage;
use tem00_triangulation::{LinePoint, Validity};

use crate::args::LinesArgs;

/// The fraction of points that may be doubtful without a note.
const DOUBTFUL: f64 = 0.1;

/// The fraction of columns in which there should be a line.
const LIT: f64 = 0.25;

/// Returns the notes on the lines of an image.
pub(super) fn of(
    path: &Path,
    image: &RawImage,
    (found, args): (&[Vec<LinePoint>], &LinesArgs),
) -> Vec<String> {
    let name = path.display();
    let several = image
        .has_further_images
        .then(|| "the file has several images, and only the first was read".to_owned());
    let turned = (image.orientation != 1).then(|| {
        "viewers show the image turned, as the file asks: rows and columns are those of the sensor"
            .to_owned()
    });
    let of_lines = too_few(found, args).or_else(|| doubtful(found));
    let notes = several.into_iter().chain(turned).chain(of_lines);
    notes.map(|note| format!("{name}: {note}")).collect()
}

/// Returns a note if there is no line, or hardly any.
fn too_few(found: &[Vec<LinePoint>], args: &LinesArgs) -> Option<String> {
    let lit = found.iter().filter(|points| !points.is_empty()).count();
    if lit as f64 >= LIT * found.len() as f64 {
        return None;
    }
    let (unit, turned) = if args.rows {
        ("rows", "omit --rows if it is horizontal")
    } else {
        ("columns", "pass --rows if it is vertical")
    };
    Some(format!(
        "line found in only {lit} of {} {unit}: {turned}, lower --min-peak if it is faint",
        found.len()
    ))
}

/// Returns a note if many points cannot be trusted, for other reasons than saturation.
fn doubtful(found: &[Vec<LinePoint>]) -> Option<String> {
    let points = found.iter().map(Vec::len).sum::<usize>();
    let of = |validity: Validity| {
        let points = found.iter().flatten();
        points.filter(|point| point.validity == validity).count()
    };
    let share = |count: usize| count as f64 / points.max(1) as f64;
    // The warning covers saturated points.
    let doubtful = points - of(Validity::Valid) - of(Validity::Saturated);
    if share(doubtful) <= DOUBTFUL {
        return None;
    }
    let (count, why, help) = REASONS
        .iter()
        .map(|&(validity, why, help)| (of(validity), why, help))
        .max_by_key(|&(count, ..)| count)?;
    Some(format!(
        "{:.0} % of the points are not valid, {:.0} % because {why}: {help}",
        100.0 * share(points - of(Validity::Valid)),
        100.0 * share(count)
    ))
}

/// Returns why points are not valid, and what helps.
pub(crate) fn reason(validity: Validity) -> String {
    let mut reasons = REASONS.iter();
    match reasons.find(|(of, ..)| *of == validity) {
        Some((_, why, help)) => format!("{why}: {help}"),
        None => SATURATED.to_owned(),
    }
}

/// The reason of saturated points, and what helps.
pub(crate) const SATURATED: &str = "pixels are saturated: expose shorter";

/// The defects of doubtful points, and their remedies, except for saturation.
const REASONS: [(Validity, &str, &str); 4] = [
    (
        Validity::Cut,
        "the window reaches beyond the image",
        "a smaller --window helps",
    ),
    (
        Validity::Crowded,
        "the window reaches into the next line",
        "a smaller --window helps",
    ),
    (Validity::Missing, "pixels are NaN", "look at the image"),
    (
        Validity::Failed,
        "the estimate does not converge",
        "try another --detector or a wider --window",
    ),
];
