use tem00_numerics::check;

use super::LineMethod;
use crate::TriangulationError;

/// Settings of a [`LineDetector`](crate::LineDetector).
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct DetectorSettings {
    /// The estimator of the position.
    pub method: LineMethod,
    /// The number of pixels of a column that an estimate uses, odd, about the peak.
    ///
    /// Two to three times the full width of the line between the points of 1/e². Outside of twice
    /// that width lie 6e−5 of the light of a Gaussian, which move the centre of gravity by 5e−4
    /// pixels at most; further pixels only add noise. The wings that a lens adds hold 0.13 h/Y of
    /// the light outside of ±Y, h being the speckle size: a window that moves with the speckle cuts
    /// them elsewhere in each column. In a short window a wide speckled line looks like several.
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
    /// The maximum number of pixels of a window.
    pub const MAX_WINDOW: usize = 1001;
    /// The maximum number of lines per column.
    pub const MAX_LINES: usize = 100;

    pub(super) fn validate(&self) -> Result<(), TriangulationError> {
        self.method.validate()?;
        let (window, odd) = (self.window, !self.window.is_multiple_of(2));
        let holds = odd && (3..=Self::MAX_WINDOW).contains(&window);
        let allowed = "an odd number of pixels from 3 to 1001";
        check::that(holds, "window", window, "", allowed)?;
        if window < self.method.min_window() {
            return Err(TriangulationError::TooFew {
                what: "pixels in the window of this method",
                got: window,
                needed: self.method.min_window(),
            });
        }
        let (min, allowed) = (self.min_peak, "zero or more grey values, and finite");
        let holds = (0.0..f64::INFINITY).contains(&min);
        check::that(holds, "min_peak", min, "", allowed)?;
        let lines = self.max_lines as f64;
        check::range("max_lines", lines, [1.0, Self::MAX_LINES as f64], "")?;
        let (level, allowed) = (self.saturation, "positive, infinite if none");
        Ok(check::that(level > 0.0, "saturation", level, "", allowed)?)
    }
}
