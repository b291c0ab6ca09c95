//! The report of a measurement.

use tem00_triangulation::{HeightMap, MeasuredPoint, Raster};

use super::{
    Job, Measured,
    files::ranges,
    in_words,
    terms::{Terms, micrometres},
};
use crate::{
    failure::Failure,
    image::write_rgb_png,
    lines::overlay::picture,
    output,
    plot::{
        Bars, Chart, HeatMap, Scale,
        colours::{HEIGHT, UNCERTAINTY},
    },
    report::{Cloud, Report, Table},
};

/// A report in the making.
pub(super) struct Page<'a> {
    pub(super) job: &'a Job<'a>,
    pub(super) measured: &'a Measured,
}

/// The diagrams of what was measured.
const DRAWINGS: [&str; 5] = [
    "profile",
    "uncertainty",
    "terms",
    "height_map",
    "uncertainty_map",
];

/// What the numbers say of each other.
const CORRELATIONS: &str = "Speckle correlates the errors of neighbouring columns over about a speckle, and \
    those of frames in which the surface has not moved; shot noise, dark noise and quantisation are new in \
    every pixel and frame; PRNU and DSNU are new in every pixel and stay from frame to frame; the error of \
    the calibration is common to all points.";

impl Page<'_> {
    /// Writes the report and its diagrams.
    ///
    /// # Errors
    ///
    /// Returns a failure if a file cannot be written.
    pub(super) fn write(&self) -> Result<(), Failure> {
        let mut report = Report::new(&format!("{}: measured by triangulation", self.job.name));
        match &self.measured.terms {
            Ok(terms) => {
                report.verdict(&terms.verdict());
                if let Some(map) = &self.measured.map {
                    self.maps(&mut report, map)?;
                }
                self.profile(&mut report)?;
                self.budget(&mut report, terms)?;
            }
            Err(refusal) => {
                report.verdict(&format!("Nothing was measured: {}.", refusal.why));
                report.paragraph(&format!("What helps: {}.", refusal.advice));
                output::remove(&self.job.files.folder, &DRAWINGS, &["svg", "png"])?;
            }
        }
        self.frame(&mut report)?;
        self.settings(&mut report);
        if let Ok(text) = std::fs::read_to_string(&self.job.args.scene) {
            report.file(&self.job.args.scene.display().to_string(), &text);
        }
        report.save(&self.job.files.path("report.html"))
    }

    /// The raw frame with the line that was found.
    fn frame(&self, report: &mut Report) -> Result<(), Failure> {
        let Some(frame) = &self.measured.shown else {
            return Ok(());
        };
        report.heading("Frame");
        let marked = picture(&frame.raw.grey_values(), (&frame.lines, false));
        let mut png = Vec::new();
        write_rgb_png(&mut png, &marked, &[])
            .map_err(|error| Failure::running(format!("cannot write a picture: {error}")))?;
        let caption = format!(
            "Frame {} as the camera gives it, brightened to its largest grey value; a colour for each \
             piece of the line, magenta for points that are not valid.",
            frame.frame
        );
        report.picture(&png, marked.width(), &caption);
        let record = self
            .measured
            .frames
            .iter()
            .find(|r| r.number == frame.frame);
        if let Some(record) = record {
            report.facts(&[
                ("points found", record.points.to_string()),
                ("of them valid", record.valid.to_string()),
                ("on saturated pixels", record.saturated.to_string()),
                ("largest grey value", format!("{} DN", record.peak)),
                ("saturated pixels", record.saturated_pixels.to_string()),
                (
                    "mean width of the line",
                    record
                        .mean_width
                        .map_or("-".to_owned(), |width| format!("{width:.2} pixels (1/e²)")),
                ),
            ]);
        }
        Ok(())
    }

    /// The profile with its band of uncertainty.
    fn profile(&self, report: &mut Report) -> Result<(), Failure> {
        let profiles = &self.measured.profiles;
        let Some(profile) = profiles.get(profiles.len() / 2) else {
            return Ok(());
        };
        let [across, _, height] = self.job.measurement.axes();
        let mut points: Vec<[f64; 3]> = profile
            .iter()
            .filter(|point| point.is_valid())
            .map(|point| {
                [
                    1e3 * point.position.dot(across),
                    1e3 * point.position.dot(height),
                    1e6 * point.uncertainty_along(height),
                ]
            })
            .collect();
        points.sort_by(|a, b| a[0].total_cmp(&b[0]));
        report.heading("Profile");
        let chart = Chart::new("Profile", ["along the line (mm)", "height (mm)"]);
        let chart = chart
            .band(with_gaps(&points).map(band))
            .coloured(UNCERTAINTY)
            .dots("height ± 1.96 u", points.iter().map(|[x, z, _]| (*x, *z)))
            .coloured(HEIGHT);
        let profile = chart.draw().save(&self.job.files.folder, "profile")?;
        let chart = Chart::new(
            "Standard uncertainty of the profile",
            ["along the line (mm)", "u(height) (µm)"],
        )
        .line("", with_gaps(&points).map(|[x, _, u]| (x, u)))
        .coloured(UNCERTAINTY);
        let uncertainty = chart.draw().save(&self.job.files.folder, "uncertainty")?;
        report.drawings([
            (
                &*profile,
                "The middle profile, valid points, with their expanded uncertainty (95 %).",
            ),
            (&*uncertainty, "The standard uncertainty of its heights."),
        ]);
        Ok(())
    }

    /// The table of terms and what it means.
    fn budget(&self, report: &mut Report, terms: &Terms) -> Result<(), Failure> {
        let Terms {
            terms,
            combined,
            expanded,
            ..
        } = terms;
        report.heading("Uncertainty of a height");
        let mut table = Table::new(
            "Root mean squares over all valid points",
            &["term", "place (px)", "height (µm)", "share (%)"],
        );
        let mut bars = Bars::new(
            "What makes heights uncertain",
            "u(height) (µm)",
            &[("", UNCERTAINTY)],
        );
        for term in terms {
            table.row(vec![
                term.name.to_owned(),
                term.place
                    .map_or(String::new(), |place| format!("{place:.4}")),
                format!("{:.3}", 1e6 * term.height),
                format!("{:.1}", 100.0 * term.share),
            ]);
            bars = bars.group(term.name, &[1e6 * term.height]);
        }
        let total = |name: &str, value: f64| {
            vec![
                name.to_owned(),
                String::new(),
                format!("{:.3}", 1e6 * value),
                String::new(),
            ]
        };
        table.total(total("combined", *combined));
        table.total(total("expanded, 95 %", *expanded));
        report.table(&table);
        let svg = bars.draw().save(&self.job.files.folder, "terms")?;
        let caption = "Standard uncertainties of a height by their cause.";
        report.drawings([(&*svg, caption)]);
        report.paragraph(CORRELATIONS);
        Ok(())
    }

    /// The height map and its uncertainty.
    fn maps(&self, report: &mut Report, map: &HeightMap) -> Result<(), Failure> {
        report.heading("Height map");
        let (labels, factor, to_scale) = match map.raster {
            Raster::Image { .. } => (["column of the image", "profile"], 1.0, false),
            Raster::Part { .. } => (["along the line (mm)", "along the scan (mm)"], 1e3, true),
        };
        let ranges = ranges(map).map(|(from, to)| (factor * from, factor * to));
        let mut drawings = Vec::new();
        for (name, title, scale, unit, values) in [
            (
                "height_map",
                "height (mm)",
                Scale::Height,
                1e3,
                &map.heights,
            ),
            (
                "uncertainty_map",
                "u(height) (µm)",
                Scale::Uncertainty,
                1e6,
                &map.uncertainties,
            ),
        ] {
            let values = values.map(|&value| value * unit);
            let picture = HeatMap {
                title,
                labels,
                ranges,
                to_scale,
                scale,
                values: &values,
            };
            drawings.push((
                picture.draw().save(&self.job.files.folder, name)?,
                format!("{title}; without colour: nothing was measured."),
            ));
        }
        report.drawings(drawings.iter().map(|(svg, caption)| (&**svg, &**caption)));
        report.cloud(Cloud {
            labels: [labels[0], labels[1], "height (mm)"],
            to_scale,
            points: self.points(to_scale),
        });
        let heights = map.range().map_or("-".to_owned(), |[low, high]| {
            format!("{:.4} mm to {:.4} mm", 1e3 * low, 1e3 * high)
        });
        report.facts(&[
            ("heights", heights),
            (
                "cells",
                format!("{} × {}", map.heights.width(), map.heights.height()),
            ),
            ("holes", format!("{:.1} %", 100.0 * map.holes())),
        ]);
        Ok(())
    }

    /// Returns the valid points along the axes of the part in millimetres or, where they do not move on, of
    /// the image: columns, profiles and millimetres.
    fn points(&self, of_part: bool) -> Vec<[f64; 3]> {
        let axes = self.job.measurement.axes();
        let profiles = self.measured.profiles.iter().enumerate();
        let points = profiles.flat_map(|(number, profile)| {
            let valid = profile.iter().filter(|point| point.is_valid());
            valid.map(move |point| {
                let [x, y, z] = axes.map(|axis| 1e3 * point.position.dot(axis));
                if of_part {
                    [x, y, z]
                } else {
                    [point.seen.column as f64, number as f64, z]
                }
            })
        });
        points.collect()
    }

    fn settings(&self, report: &mut Report) {
        let measurement = &self.job.measurement;
        let scene = measurement.scene();
        let sensor = measurement.sensor().description();
        let speckle = measurement.speckle();
        let detector = measurement.detector().settings();
        let average = measurement.settings().average;
        let worth = self
            .measured
            .effective_frames
            .map_or_else(String::new, |frames| {
                format!("; worth {frames:.1} profiles of independent speckle")
            });
        let averages = format!(
            "{} frames, {} columns{worth}",
            average.frames, average.columns
        );
        let place = self
            .measured
            .profiles
            .iter()
            .flatten()
            .find(|p| p.is_valid());
        let per_pixel = |point: &MeasuredPoint| {
            let height = point.per_pixel.dot(measurement.settings().height).abs();
            format!("{} per pixel", micrometres(height))
        };
        report.heading("Settings");
        report.facts(&[
            ("frames", self.measured.frames.len().to_string()),
            ("average", averages),
            (
                "speckle size on the sensor",
                if self.job.args.no_speckle {
                    "left out, as asked".to_owned()
                } else {
                    let [across, down] = speckle.size();
                    format!(
                        "{across:.2} × {down:.2} pixels, contrast {:.2}",
                        speckle.variance.sqrt()
                    )
                },
            ),
            (
                "speckle from frame to frame",
                self.measured
                    .speckle_change
                    .as_ref()
                    .map_or("-".to_owned(), in_words),
            ),
            ("height", place.map_or("-".to_owned(), per_pixel)),
            (
                "detector",
                format!(
                    "{}, window {} pixels",
                    detector.method.name(),
                    detector.window
                ),
            ),
            (
                "sensor",
                format!(
                    "{} bits, {:.3} DN per electron, exposure {:.4} ms, full well {:.0} electrons",
                    sensor.bit_depth,
                    sensor.gain,
                    1e3 * sensor.exposure_time,
                    sensor.full_well
                ),
            ),
            (
                "calibration",
                match measurement.calibration().quality() {
                    None => "exact, from the scene".to_owned(),
                    Some(quality) => format!("estimated from {} boards", quality.boards),
                },
            ),
            ("seed", scene.render.seed.to_string()),
            (
                "samples per pixel",
                scene.render.samples_per_pixel.to_string(),
            ),
        ]);
    }
}

/// Returns the points of a profile, along the line, with one that is not a number where several columns
/// are missing.
fn with_gaps(points: &[[f64; 3]]) -> impl Iterator<Item = [f64; 3]> {
    const GAP: f64 = 4.0;
    let mut steps: Vec<f64> = points
        .windows(2)
        .map(|pair| pair[1][0] - pair[0][0])
        .collect();
    steps.sort_by(f64::total_cmp);
    let usual = steps.get(steps.len() / 2).copied().unwrap_or_default();
    let pieces = points.chunk_by(move |a, b| b[0] - a[0] <= GAP * usual);
    pieces.flat_map(|piece| piece.iter().copied().chain([[f64::NAN; 3]]))
}

/// Returns x, lower and upper end of the expanded uncertainty of a point.
fn band([x, z, u]: [f64; 3]) -> (f64, f64, f64) {
    let half = 1.96e-3 * u;
    (x, z - half, z + half)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn curves_end_at_gaps() {
        let points: Vec<[f64; 3]> = (0..20_u8)
            .filter(|x| !(8..13).contains(x))
            .map(|x| [f64::from(x), 1.0, 2.0])
            .collect();
        let found: Vec<_> = with_gaps(&points).collect();
        let pieces = found.split(|point| point[0].is_nan());
        let lengths: Vec<_> = pieces.map(<[_]>::len).collect();
        assert_eq!(lengths, [8, 7, 0], "each piece is closed");
        assert_eq!(with_gaps(&[]).count(), 0);
        assert_eq!(with_gaps(&points[..1]).count(), 2);
    }
}
