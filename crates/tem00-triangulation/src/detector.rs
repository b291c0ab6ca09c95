use tem00_numerics::Grid;

use crate::TriangulationError;

/// How the place of a line in a column is estimated.
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub enum LineMethod {
    /// The centre of gravity of what lies above the background, over the window.
    CentreOfGravity,
    /// The centre of gravity of what lies above a fraction of the peak.
    ThresholdedCentreOfGravity {
        /// The threshold as a fraction of the peak, from 0 to 1.
        threshold: f64,
    },
    /// The centre of gravity over a window that is moved onto its result until it stays.
    IteratedCentreOfGravity,
    /// The vertex of the parabola through the peak and its neighbours.
    Parabola,
    /// The vertex of the parabola through the logarithms of the peak and its neighbours.
    LogGaussian,
    /// Linear interpolation between the peak and its neighbours.
    LinearInterpolation,
    /// The zero of the derivative by a filter of Blais and Rioux.
    BlaisRioux {
        /// The order of the filter.
        order: FilterOrder,
    },
    /// The Gaussian on a constant background that fits best.
    GaussianFit,
    /// The ridge by Steger, with derivatives of a Gaussian.
    Steger {
        /// The standard deviation of the Gaussian, in pixels.
        sigma: f64,
    },
}

/// The order of a filter of Blais and Rioux.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum FilterOrder {
    /// Two taps.
    Second,
    /// Four taps.
    Fourth,
    /// Eight taps.
    Eighth,
}

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
    /// The estimate did not converge or lies outside of the window.
    Failed,
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
    pub const fn new(settings: DetectorSettings) -> Result<Self, TriangulationError> {
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

    /// Returns by how much the place of the line at `point` moves per grey value of each pixel of the
    /// column, in pixels per grey value: the sensitivities of its uncertainty.
    pub fn sensitivities(&self, column: &[f32], _point: &LinePoint) -> Vec<f64> {
        vec![0.0; column.len()]
    }
}
