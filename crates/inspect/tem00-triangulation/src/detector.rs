mod blais_rioux;
mod column;
mod estimate;
mod extent;
mod gaussian_fit;
mod gravity;
mod method;
mod point;
mod profile;
mod sensitivity;
mod settings;
mod steger;
#[cfg(test)]
mod tests;
mod three_point;
mod tracks;

use tem00_numerics::{Grid, parallel};

use column::{Column, Sighting};
use extent::Extent;
use profile::{Estimate, Profile};
use steger::Kernels;

use crate::TriangulationError;

pub use method::{FilterOrder, LineMethod};
pub use point::{LinePoint, Validity};
pub use settings::DetectorSettings;

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

    /// Returns the settings that the detector was created from.
    pub const fn settings(&self) -> &DetectorSettings {
        &self.settings
    }

    /// Finds the lines that cross a column, from the top.
    ///
    /// A line is where the column, smoothed over about a quarter of the window, has a maximum that
    /// stands out of the noise by six of its standard deviations. Of maxima closer than half a
    /// window the greater one counts, and of all maxima the
    /// [`max_lines`](DetectorSettings::max_lines) greatest. The background is the median of the
    /// pixels outside of the windows; where they are fewer than eight, the lowest decile of the
    /// column. Lines less than [`min_peak`](DetectorSettings::min_peak) above it are left out.
    /// Windows end where the next line begins, at the smallest value between the two.
    pub fn detect_column(&self, column: &[f32]) -> Vec<LinePoint> {
        self.in_column(column, &[])
    }

    /// Finds the lines of an image: for each column the points on them, from the top.
    ///
    /// Points of neighbouring columns that continue each other belong to the same
    /// [line](LinePoint::line). The straight line through the last 16 points of a line predicts
    /// where it continues; a point belongs to the nearest prediction within a quarter of a window,
    /// and 2 pixels at least, of the lines that were seen in the column before; else to a line that
    /// was seen earlier. A line may miss points for two windows; after a longer gap, or a step
    /// higher than a quarter of a window, it counts as another line. Lines that cross keep their
    /// numbers: where they come close, they continue in their directions. Near the crossing both
    /// are seen as one, and a point belongs to the line that is nearer. Lines are numbered from the
    /// top, by their mean positions; lines with less than a tenth of the points of the longest line
    /// come after all others.
    pub fn detect(&self, image: &Grid<f32>) -> Vec<Vec<LinePoint>> {
        self.find(&turned(image), None)
    }

    /// Finds the lines of an image as [`detect`](Self::detect) does, where it is known which pixels
    /// are saturated: for instance, from the colours of which the image is the mean.
    ///
    /// A pixel is saturated if it is marked or reaches
    /// [`saturation`](DetectorSettings::saturation).
    ///
    /// # Panics
    ///
    /// Panics if both grids differ in size.
    pub fn detect_marked(&self, image: &Grid<f32>, saturated: &Grid<bool>) -> Vec<Vec<LinePoint>> {
        let sizes = [
            [image.width(), image.height()],
            [saturated.width(), saturated.height()],
        ];
        assert_eq!(sizes[0], sizes[1], "both are of one image");
        self.find(&turned(image), Some(&turned(saturated)))
    }

    /// Finds the lines of an image in its rows, some of whose pixels may be marked as saturated.
    fn find(&self, image: &Grid<f32>, saturated: Option<&Grid<bool>>) -> Vec<Vec<LinePoint>> {
        let kernels = match self.settings.method {
            LineMethod::Steger { sigma } => Some(Kernels::new(sigma)),
            _ => None,
        };
        let find = |y| {
            let marked = saturated.map_or(&[][..], |saturated| saturated.row(y));
            match &kernels {
                Some(kernels) => self.ridges((image, marked), y, kernels),
                None => self.in_column(image.row(y), marked),
            }
        };
        let mut points = parallel::map(image.height(), find);
        tracks::number(&mut points, self.settings.window);
        points
    }

    fn in_column(&self, column: &[f32], marked: &[bool]) -> Vec<LinePoint> {
        let found = Column::of(column, &self.settings);
        let position = |profile: &Profile<'_>| profile.estimate(&self.settings.method);
        self.points((column, marked), &found, position)
    }

    fn ridges(
        &self,
        (image, marked): (&Grid<f32>, &[bool]),
        y: usize,
        kernels: &Kernels,
    ) -> Vec<LinePoint> {
        let found = Column::of(image.row(y), &self.settings);
        let position = |profile: &Profile<'_>| {
            let position = steger::in_image(profile, image, (y, found.background), kernels)?;
            let width = None;
            profile.placed(Estimate { position, width })
        };
        self.points((image.row(y), marked), &found, position)
    }

    fn points(
        &self,
        raw: (&[f32], &[bool]),
        column: &Column,
        position: impl Fn(&Profile<'_>) -> Option<Estimate>,
    ) -> Vec<LinePoint> {
        let above = &column.above;
        let point = |line: &Sighting| {
            let profile = Profile { above, line };
            let (extent, estimate) = (Extent::of(&profile), position(&profile));
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

    /// Returns the validity of a line whose position was estimated.
    fn validity(&self, (raw, marked): (&[f32], &[bool]), line: &Sighting) -> Validity {
        let half = self.settings.window / 2;
        let window = || raw[line.window.clone()].iter().copied();
        let is_marked = marked
            .get(line.window.clone())
            .is_some_and(|pixels| pixels.contains(&true));
        if is_marked || window().any(|value| f64::from(value) >= self.settings.saturation) {
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

/// Returns an image whose rows are the columns of another.
fn turned<T: Copy>(image: &Grid<T>) -> Grid<T> {
    Grid::from_fn(image.height(), image.width(), |y, x| image[(x, y)])
}
