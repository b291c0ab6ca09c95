mod method;

use tem00_numerics::Grid;

use crate::TriangulationError;

pub use method::{FilterOrder, LineMethod};

/// How lines are found.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct DetectorSettings {
    /// How the place is estimated.
    pub method: LineMethod,
    /// The number of pixels of a column that an estimate looks at, odd, about the peak.
    pub window: usize,
    /// The least height of a peak above the background, in grey values.
    pub least_peak: f64,
    /// The most lines per column.
    pub most_lines: usize,
    /// The grey value from which on a pixel is saturated; infinite if there is none.
    pub saturation: f64,
}

impl Default for DetectorSettings {
    /// The centre of gravity over 31 pixels of one line per column, at least 10 grey values high.
    fn default() -> Self {
        Self {
            method: LineMethod::CentreOfGravity,
            window: 31,
            least_peak: 10.0,
            most_lines: 1,
            saturation: f64::INFINITY,
        }
    }
}

impl DetectorSettings {
    /// The most pixels of a window.
    pub const MOST_WINDOW: usize = 1001;
    /// The most lines per column.
    pub const MOST_LINES: usize = 100;

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
        if self.window < self.method.least_window() {
            return Err(TriangulationError::TooFew {
                what: "pixels in the window of this method",
                got: self.window,
                needed: self.method.least_window(),
            });
        }
        if !(0.0..f64::INFINITY).contains(&self.least_peak) {
            let allowed = "zero or more grey values, and finite";
            return refuse("least_peak", self.least_peak, allowed);
        }
        if !(1..=Self::MOST_LINES).contains(&self.most_lines) {
            return refuse("most_lines", self.most_lines as f64, "from 1 to 100");
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
}

impl Validity {
    /// Returns what to write into a table: `valid`, `saturated`, `cut`, `crowded`, `missing` or
    /// `failed`.
    pub const fn name(&self) -> &'static str {
        match self {
            Self::Valid => "valid",
            Self::Saturated => "saturated",
            Self::Cut => "cut",
            Self::Crowded => "crowded",
            Self::Missing => "missing",
            Self::Failed => "failed",
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
    pub fn detect_column(&self, column: &[f32]) -> Vec<LinePoint> {
        let weights = || column.iter().zip(0_u16..);
        let integral: f64 = column.iter().copied().map(f64::from).sum();
        let moment: f64 = weights()
            .map(|(&value, y)| f64::from(value) * (f64::from(y) + 0.5))
            .sum();
        vec![LinePoint {
            position: moment / integral,
            width: 0.0,
            peak: 0.0,
            integral,
            background: 0.0,
            validity: Validity::Valid,
            line: 0,
        }]
    }

    /// Finds the lines of an image: for each column the points on them, from the top.
    pub fn detect(&self, image: &Grid<f32>) -> Vec<Vec<LinePoint>> {
        let column = |x| {
            (0..image.height())
                .map(|y| image[(x, y)])
                .collect::<Vec<_>>()
        };
        (0..image.width())
            .map(|x| self.detect_column(&column(x)))
            .collect()
    }

    /// Finds the lines of an image in which they run from top to bottom: for each *row* the points on
    /// them, from the left, with places along x.
    pub fn detect_rows(&self, image: &Grid<f32>) -> Vec<Vec<LinePoint>> {
        image.rows().map(|row| self.detect_column(row)).collect()
    }

    /// Returns by how much the place of the line at `point` moves per grey value of each pixel of the
    /// column, in pixels per grey value: the sensitivities of its uncertainty.
    pub fn sensitivities(&self, column: &[f32], _point: &LinePoint) -> Vec<f64> {
        vec![0.0; column.len()]
    }
}
