//! The drawings of a measurement.

use tem00_report::{
    failure::Failure,
    image::write_rgb_png,
    output,
    plot::{
        Bars, Chart, HeatMap, Scale,
        colours::{HEIGHT, UNCERTAINTY},
    },
    report::{Cloud, Section},
};
use tem00_scan::{HeightMap, Raster};

use super::{
    files::ranges,
    job::{Job, ScanResult},
    terms::Terms,
};
use crate::lines::overlay::picture;

/// The diagrams of a measurement.
const DRAWINGS: [&str; 5] = [
    "profile",
    "uncertainty",
    "terms",
    "height_map",
    "uncertainty_map",
];

/// Draws a measurement into its folder and into sections of its report.
pub(super) struct Drawings<'a> {
    pub(super) job: &'a Job<'a>,
    pub(super) measured: &'a ScanResult,
}

impl Drawings<'_> {
    /// Removes the diagrams of another run, which would be taken for diagrams of this run.
    pub(super) fn remove(&self) -> Result<(), Failure> {
        output::remove(&self.job.files.folder, &DRAWINGS, &["svg", "png"])
    }

    /// The raw frame with the line that was found.
    pub(super) fn frame(&self, section: &mut Section) -> Result<(), Failure> {
        let Some(frame) = &self.measured.shown else {
            return Ok(());
        };
        let marked = picture(&frame.raw.grey_values(), (&frame.lines, false));
        let mut png = Vec::new();
        write_rgb_png(&mut png, &marked, &[])
            .map_err(|error| Failure::running(format!("cannot write a picture: {error}")))?;
        let caption = format!(
            "Frame {} as the camera gives it, brightened to its largest grey value; a colour for \
             each piece of the line, magenta for points that are not valid.",
            frame.frame
        );
        section.picture(png, marked.width(), caption);
        Ok(())
    }

    /// The profile with its band of uncertainty.
    pub(super) fn profile(&self, section: &mut Section) -> Result<(), Failure> {
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
        section
            .drawing(
                profile,
                "The middle profile, valid points, with their expanded uncertainty (95 %).",
            )
            .drawing(uncertainty, "The standard uncertainty of its heights.");
        Ok(())
    }

    /// The terms of the uncertainty.
    pub(super) fn terms(&self, section: &mut Section, terms: &Terms) -> Result<(), Failure> {
        let mut bars = Bars::new(
            "What makes heights uncertain",
            "u(height) (µm)",
            &[("", UNCERTAINTY)],
        );
        for term in &terms.terms {
            bars = bars.group(term.name, &[1e6 * term.height]);
        }
        let svg = bars.draw().save(&self.job.files.folder, "terms")?;
        section.drawing(svg, "Standard uncertainties of a height by their cause.");
        Ok(())
    }

    /// The height map and its uncertainty.
    pub(super) fn maps(&self, section: &mut Section, map: &HeightMap) -> Result<(), Failure> {
        let (labels, factor, to_scale) = match map.raster {
            Raster::Image { .. } => (["column of the image", "profile"], 1.0, false),
            Raster::Part { .. } => (["along the line (mm)", "along the scan (mm)"], 1e3, true),
        };
        let ranges = ranges(map).map(|(from, to)| (factor * from, factor * to));
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
            let svg = picture.draw().save(&self.job.files.folder, name)?;
            section.drawing(
                svg,
                format!("{title}; without colour: nothing was measured."),
            );
        }
        section.cloud(Cloud {
            labels: [labels[0], labels[1], "height (mm)"],
            to_scale,
            points: self.points(to_scale),
        });
        Ok(())
    }

    /// Returns the valid points along the axes of the part in millimetres or, where the profiles do
    /// not advance, of the image: columns, profiles and millimetres.
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
}

/// Returns the points of a profile, along the line, with one that is not a number where several
/// columns are missing.
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
