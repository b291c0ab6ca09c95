//! The summary of the lines of an image.

use std::path::Path;

use serde::Serialize;
use tem00_report::{
    image::RawImage,
    report::{Cell, Column, Report, Table},
};
use tem00_triangulation::{DetectorSettings, LinePoint, Validity};

use super::notes::SATURATED;
use crate::saturated_points::PointCounts;

/// The number of columns to either side of a column to which a parabola is fitted.
const REACH: usize = 8;

/// Summary of a line in an image.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct LineSummary {
    /// The number of the line, from 0.
    pub(super) line: usize,
    /// The columns in which it was found.
    columns: usize,
    /// The columns in which its position can be trusted.
    valid: usize,
    /// The mean of its valid positions, in pixels.
    position: Option<f64>,
    /// The standard deviation of its valid positions about a smooth line, in pixels.
    pub(super) noise: Option<f64>,
    /// The mean of its full 1/e² widths where it is valid, in pixels.
    width: Option<f64>,
    /// The mean of its peaks above the background where it is valid, in DN.
    peak: Option<f64>,
}

impl LineSummary {
    /// Sums up all lines of an image.
    pub(super) fn of_all(found: &[Vec<LinePoint>]) -> Vec<Self> {
        let numbers = found.iter().flatten().map(|point| point.line);
        let count = numbers.max().map_or(0, |max| max + 1);
        (0..count).map(|line| Self::of(found, line)).collect()
    }

    fn of(found: &[Vec<LinePoint>], line: usize) -> Self {
        let of_line = |points: &Vec<LinePoint>| points.iter().find(|p| p.line == line).copied();
        let columns: Vec<Option<LinePoint>> = found.iter().map(of_line).collect();
        let is_valid = |point: &LinePoint| point.validity == Validity::Valid;
        let valid: Vec<LinePoint> = columns.iter().flatten().copied().filter(is_valid).collect();
        let places: Vec<Option<f64>> = columns
            .iter()
            .map(|point| point.filter(is_valid).map(|point| point.position))
            .collect();
        let of = |what: fn(&LinePoint) -> f64| mean(valid.iter().map(what));
        Self {
            line,
            columns: columns.iter().flatten().count(),
            valid: valid.len(),
            position: of(|point| point.position),
            noise: noise_about_parabola(&places),
            width: of(|point| point.width),
            peak: of(|point| point.peak),
        }
    }
}

/// Returns the standard deviation of values about a smooth curve, or `None` if there are not 17 in
/// a row.
///
/// The smooth curve is the least-squares parabola of the 17 values about each value. For noise of
/// the variance σ² that is independent from value to value, the residual in the middle has the
/// variance σ² (1 − h) with the weight h of the middle value in the parabola; noise that neighbours
/// share is underestimated.
///
/// ```text
/// w_i = 3 (3m² + 3m − 1 − 5i²) / ((2m − 1) (2m + 1) (2m + 3))     h = w_0, m = 8
/// ```
///
/// The weights are those of A. Savitzky and M. J. E. Golay, *Smoothing and Differentiation of Data
/// by Simplified Least Squares Procedures*, 1964.
fn noise_about_parabola(values: &[Option<f64>]) -> Option<f64> {
    let weights = parabola_weights();
    let residuals = values.windows(weights.len()).filter_map(|window| {
        let terms = window.iter().zip(&weights);
        let smooth: Option<f64> = terms.map(|(value, weight)| Some((*value)? * weight)).sum();
        Some(window[REACH]? - smooth?)
    });
    let variance = mean(residuals.map(|residual| residual * residual))?;
    Some((variance / (1.0 - weights[REACH])).sqrt())
}

fn parabola_weights() -> [f64; 2 * REACH + 1] {
    let (m, at) = (REACH as f64, |i: usize| i as f64 - REACH as f64);
    let sum = (2.0 * m - 1.0) * (2.0 * m + 1.0) * (2.0 * m + 3.0);
    let weight = |i: f64| 3.0 * (3.0 * m * m + 3.0 * m - 1.0 - 5.0 * i * i) / sum;
    core::array::from_fn(|i| weight(at(i)))
}

fn mean(values: impl Iterator<Item = f64>) -> Option<f64> {
    let (count, sum) = values.fold((0_u32, 0.0), |(count, sum), value| (count + 1, sum + value));
    (count > 0).then(|| sum / f64::from(count))
}

/// Summary of an image.
#[derive(Debug, Serialize)]
pub(super) struct ImageSummary {
    image: String,
    size: [usize; 2],
    bit_depth: Option<u32>,
    interpretation: String,
    saturated_pixels: usize,
    #[serde(skip)]
    pub(super) counts: PointCounts,
    #[serde(skip)]
    lines: Vec<LineSummary>,
    #[serde(skip)]
    name: String,
}

impl ImageSummary {
    pub(super) fn new(
        path: &Path,
        image: &RawImage,
        (lines, counts): (Vec<LineSummary>, PointCounts),
    ) -> Self {
        Self {
            image: path.display().to_string(),
            size: [image.values.width(), image.values.height()],
            bit_depth: image.bit_depth,
            interpretation: image.interpretation.clone(),
            saturated_pixels: image.saturated_pixels(),
            counts,
            lines,
            name: tem00_report::output::name(path, "image"),
        }
    }

    /// Returns whether any of its lines can be trusted anywhere, and most points are not saturated.
    pub(super) fn has_result(&self) -> bool {
        self.counts.valid > 0 && !self.counts.are_too_many()
    }

    /// Returns a warning if many points are saturated.
    pub(super) fn warning(&self) -> Option<String> {
        let warning = self.counts.warning(SATURATED)?;
        Some(format!("{}: {warning}", self.image))
    }

    /// Adds its lines to the table, or the remark that there is none.
    fn add_to(&self, table: &mut Table) {
        let name = || Cell::new(&self.image, &self.name);
        if self.lines.is_empty() {
            let mut row = vec![name(), Cell::missing("none")];
            row.resize_with(8, || Cell::missing("-"));
            table.row(row);
        }
        for line in &self.lines {
            table.row([
                name(),
                line.line.into(),
                line.columns.into(),
                valid_fraction(line),
                Cell::or_dash(line.position),
                Cell::or_dash(line.noise),
                Cell::or_dash(line.width),
                Cell::or_dash(line.peak),
            ]);
        }
    }
}

fn valid_fraction(line: &LineSummary) -> Cell {
    let share = line.valid as f64 / line.columns.max(1) as f64;
    Cell::new(share, format!("{:.1} %", 100.0 * share))
}

/// Returns the report of all images.
pub(super) fn report(settings: &DetectorSettings, images: &[ImageSummary]) -> Report {
    let mut report = Report::new("Lines in images");
    report.data("detector", settings.method.name());
    report.data("window_pixels", settings.window);
    report.data("min_peak_dn", settings.min_peak);
    report.data("max_lines", settings.max_lines);
    report.data("images", images);
    let columns = [
        Column::new("image", "image"),
        Column::new("line", "line"),
        Column::new("columns", "columns"),
        Column::new("valid_fraction", "valid"),
        Column::new("position_pixels", "position/px"),
        Column::new("noise_pixels", "noise/px"),
        Column::new("width_pixels", "width/px"),
        Column::new("peak_dn", "peak/DN"),
    ];
    let mut table = Table::new("Lines", columns).under("lines");
    images.iter().for_each(|image| image.add_to(&mut table));
    report.section("Lines").table(table);
    report
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_parabola_is_smooth() {
        let parabola = |x: f64| 3.0 - 0.4 * x + 0.02 * x * x;
        let values: Vec<_> = (0..40).map(|x| Some(parabola(f64::from(x)))).collect();
        let noise = noise_about_parabola(&values).expect("there are enough");
        // Rounding of values up to 20.
        assert!(noise < 1e-13, "{noise}");
    }

    #[test]
    fn the_noise_of_a_line_is_its_standard_deviation() {
        // Uniform in [−½, ½): the variance is 1/12.
        let mut numbers = tem00_testkit::Numbers::new(1);
        let values: Vec<_> = (0..20_000)
            .map(|x| Some(numbers.unit() - 0.5 + 1e-3 * f64::from(x)))
            .collect();
        let noise = noise_about_parabola(&values).expect("there are enough");
        let expected = 1.0 / 12.0_f64.sqrt();
        // Four standard errors: the standard error of a variance of n uniform values is √(0.8 / n)
        // of it, 0.6 %, and a little more for the neighbours that residuals share.
        assert!(
            (noise / expected - 1.0).abs() < 0.015,
            "{noise} for {expected}"
        );
    }

    #[test]
    fn noise_takes_seventeen_columns_in_a_row() {
        let mut values = vec![Some(1.0); 40];
        assert!(noise_about_parabola(&values).is_some(), "without gaps");
        for gap in [5, 14, 25, 36] {
            values[gap] = None;
        }
        assert_eq!(noise_about_parabola(&values), None);
        assert_eq!(noise_about_parabola(&[]), None);
    }
}
