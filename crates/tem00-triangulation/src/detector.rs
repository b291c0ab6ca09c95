mod blais_rioux;
mod column;
mod estimate;
mod extent;
mod gaussian_fit;
mod gravity;
mod method;
mod profile;
mod sensitivity;
mod steger;
#[cfg(test)]
mod tests;
mod three_point;
mod tracks;

use rayon::prelude::*;
use tem00_numerics::Grid;

use column::{Column, Sighting};
use extent::Extent;
use profile::{Estimate, Profile};
use steger::Kernels;

use crate::TriangulationError;

pub use method::{FilterOrder, LineMethod};

/// Settings of a [`LineDetector`].
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct DetectorSettings {
    /// The estimator of the position.
    pub method: LineMethod,
    /// The number of pixels of a column that an estimate looks at, odd, about the peak.
    ///
    /// Two to three times the full width of the line between the points of 1/e². Outside of twice that
    /// width lie 6e−5 of the light of a Gaussian, which move the centre of gravity by 5e−4 pixels at most;
    /// further pixels only add noise. The wings that a lens adds hold 0.13 h/Y of the light outside of ±Y, h
    /// being the speckle size: a window that moves with the speckle cuts them elsewhere in each column. In a short window a wide speckled line looks like several.
    pub window: usize,
    /// The minimum height of a peak above the background, in grey values.
    pub min_peak: f64,
    /// The maximum number of lines per column.
    pub max_lines: usize,
    /// The grey value from which on a pixel is saturated; infinite if there is none.
    pub saturation: f64,
}

impl Default for DetectorSettings {
    /// The centre of gravity over 31 pixels of one line per column, at least 10 grey values high.
    fn default() -> Self {
        Self {
            method: LineMethod::CentreOfGravity,
            window: 31,
            min_peak: 10.0,
            max_lines: 1,
            saturation: f64::INFINITY,
        }
    }
}

impl DetectorSettings {
    /// The most pixels of a window.
    pub const MOST_WINDOW: usize = 1001;
    /// The maximum number of lines per column.
    pub const MAX_LINES: usize = 100;

    fn validate(&self) -> Result<(), TriangulationError> {
        let refuse = |parameter, value, allowed| {
            Err(TriangulationError::OutOfRange {
                parameter,
                value,
                allowed,
            })
        };
        self.method.validate()?;
        if self.window.is_multiple_of(2) || !(3..=Self::MOST_WINDOW).contains(&self.window) {
            return refuse(
                "window",
                self.window as f64,
                "an odd number of pixels from 3 to 1001",
            );
        }
        if self.window < self.method.min_window() {
            return Err(TriangulationError::TooFew {
                what: "pixels in the window of this method",
                got: self.window,
                needed: self.method.min_window(),
            });
        }
        if !(0.0..f64::INFINITY).contains(&self.min_peak) {
            let allowed = "zero or more grey values, and finite";
            return refuse("min_peak", self.min_peak, allowed);
        }
        if !(1..=Self::MAX_LINES).contains(&self.max_lines) {
            return refuse("max_lines", self.max_lines as f64, "from 1 to 100");
        }
        if self.saturation.is_nan() || self.saturation <= 0.0 {
            return refuse("saturation", self.saturation, "positive, infinite if none");
        }
        Ok(())
    }
}

/// A line where it crosses a column.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct LinePoint {
    /// The place along the column, in pixels; the centre of the first pixel is at 0.5.
    pub position: f64,
    /// The full width between the points of 1/e², in pixels.
    ///
    /// It is twice the width between the points before which 16 and 84 % of the light of the window lie,
    /// or that of the [fit](LineMethod::GaussianFit).
    pub width: f64,
    /// The greatest grey value above the background.
    pub peak: f64,
    /// The sum of the grey values above the background over the window: what the surface reflects.
    pub integral: f64,
    /// The grey value of the background.
    pub background: f64,
    /// Whether the place can be trusted.
    pub validity: Validity,
    /// Which of the lines of the image the point belongs to, counted from 0; in a single column, the
    /// number of the line from the top.
    pub line: usize,
}

/// Whether a point of a line can be trusted, and if not, why.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub enum Validity {
    /// Nothing speaks against it.
    Valid,
    /// A pixel of the window is saturated.
    Saturated,
    /// The window reaches beyond the image.
    Cut,
    /// The window was cut where the next line of the column begins.
    Crowded,
    /// A pixel of the window is not a finite number; it counts as background.
    Missing,
    /// The estimate did not converge or lies outside of the window; the place is that of the peak.
    Failed,
    /// An edge of the part cuts the line, of which but a sliver is seen: its place is that of the edge. Or
    /// there is no line but by noise. Only who knows the line without noise can tell; a detector does not.
    Sliver,
}

impl Validity {
    /// Returns what to write into a table: `valid`, `saturated`, `cut`, `crowded`, `missing`,
    /// `failed` or `sliver`.
    pub const fn name(&self) -> &'static str {
        match self {
            Self::Valid => "valid",
            Self::Saturated => "saturated",
            Self::Cut => "cut",
            Self::Crowded => "crowded",
            Self::Missing => "missing",
            Self::Failed => "failed",
            Self::Sliver => "sliver",
        }
    }
}

/// Finds laser lines in columns and images.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct LineDetector {
    settings: DetectorSettings,
}

impl LineDetector {
    /// Creates a detector.
    ///
    /// # Errors
    ///
    /// Returns an error if a setting is outside its range.
    pub fn new(settings: DetectorSettings) -> Result<Self, TriangulationError> {
        settings.validate()?;
        Ok(Self { settings })
    }

    /// Returns what the detector was created from.
    pub const fn settings(&self) -> &DetectorSettings {
        &self.settings
    }

    /// Finds the lines that cross a column, from the top.
    ///
    /// A line is where the column, smoothed over about a quarter of the window, has a maximum that stands
    /// out of the noise by six of its standard deviations. Of maxima closer than half a window the greater
    /// one counts, and of all the [`max_lines`](DetectorSettings::max_lines) greatest. The background is
    /// the median of the pixels outside of the windows; where they are fewer than eight, the lowest
    /// decile of the column. Lines less than [`min_peak`](DetectorSettings::min_peak) above it are
    /// left out. Windows end where the next line begins, at the least value between both.
    pub fn detect_column(&self, column: &[f32]) -> Vec<LinePoint> {
        let found = Column::of(column, &self.settings);
        let place = |profile: &Profile<'_>| profile.estimate(&self.settings.method);
        self.points(column, &found, place)
    }

    /// Finds the lines of an image: for each column the points on them, from the top.
    ///
    /// Points of neighbouring columns that continue each other belong to the same
    /// [line](LinePoint::line). The straight line through the last 16 points of a line tells where it
    /// goes on; a point belongs to the nearest one within a quarter of a window of that, and 2 pixels at
    /// least, of the lines that were seen in the column before; else to one that was seen earlier. A line may
    /// miss points for two windows; behind a longer gap, or a step higher than a quarter of a window, it is
    /// another one. Lines that cross keep their numbers: where they come
    /// close they go on as they came. Near the crossing both are seen as one, and a point belongs to the
    /// one that it is nearer to. Lines are numbered from the top, by their mean places; those of less than
    /// a tenth of the points of the longest come after all others.
    pub fn detect(&self, image: &Grid<f32>) -> Vec<Vec<LinePoint>> {
        let columns = Grid::from_fn(image.height(), image.width(), |y, x| image[(x, y)]);
        self.detect_rows(&columns)
    }

    /// Finds the lines of an image in which they run from top to bottom, as [`detect`](Self::detect)
    /// does: for each *row* the points on them, from the left, with places along x.
    pub fn detect_rows(&self, image: &Grid<f32>) -> Vec<Vec<LinePoint>> {
        let kernels = match self.settings.method {
            LineMethod::Steger { sigma } => Some(Kernels::new(sigma)),
            _ => None,
        };
        let find = |y| match &kernels {
            Some(kernels) => self.ridges(image, y, kernels),
            None => self.detect_column(image.row(y)),
        };
        let rows = (0..image.height()).into_par_iter();
        let mut points: Vec<Vec<LinePoint>> = rows.map(find).collect();
        tracks::number(&mut points, self.settings.window);
        points
    }

    fn ridges(&self, image: &Grid<f32>, y: usize, kernels: &Kernels) -> Vec<LinePoint> {
        let found = Column::of(image.row(y), &self.settings);
        let place = |profile: &Profile<'_>| {
            let position = steger::in_image(profile, image, (y, found.background), kernels)?;
            let width = None;
            profile.placed(Estimate { position, width })
        };
        self.points(image.row(y), &found, place)
    }

    fn points(
        &self,
        raw: &[f32],
        column: &Column,
        place: impl Fn(&Profile<'_>) -> Option<Estimate>,
    ) -> Vec<LinePoint> {
        let above = &column.above;
        let point = |line: &Sighting| {
            let profile = Profile { above, line };
            let (extent, estimate) = (Extent::of(&profile), place(&profile));
            let of_extent = extent.map_or(0.0, |extent| extent.width);
            LinePoint {
                position: estimate.map_or(line.greatest as f64 + 0.5, |found| found.position),
                width: estimate.and_then(|found| found.width).unwrap_or(of_extent),
                peak: above[line.greatest],
                integral: line.window.clone().map(|i| above[i]).sum(),
                background: column.background,
                validity: match estimate {
                    Some(_) => self.validity(raw, line),
                    None => Validity::Failed,
                },
                line: 0,
            }
        };
        let mut points: Vec<LinePoint> = column.lines.iter().map(point).collect();
        points.sort_by(|a, b| a.position.total_cmp(&b.position));
        points
            .iter_mut()
            .zip(0..)
            .for_each(|(point, line)| point.line = line);
        points
    }

    /// Returns what speaks against a line whose place was estimated.
    fn validity(&self, raw: &[f32], line: &Sighting) -> Validity {
        let half = self.settings.window / 2;
        let window = || raw[line.window.clone()].iter().copied();
        if window().any(|value| f64::from(value) >= self.settings.saturation) {
            Validity::Saturated
        } else if window().any(|value| !value.is_finite()) {
            Validity::Missing
        } else if line.is_cut(half, raw.len()) {
            Validity::Cut
        } else if line.is_crowded(half, raw.len()) {
            Validity::Crowded
        } else {
            Validity::Valid
        }
    }
}
