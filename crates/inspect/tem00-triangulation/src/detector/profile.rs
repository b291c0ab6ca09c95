use core::ops::Range;

use super::column::Sighting;

/// A line in its column.
#[derive(Clone, Copy)]
pub(super) struct Profile<'a> {
    /// The grey values of the column above its background.
    pub(super) above: &'a [f64],
    /// The line as found in the column.
    pub(super) line: &'a Sighting,
}

/// The position of a line.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Estimate {
    /// The position along the column.
    pub(super) position: f64,
    /// The full width between the points of 1/e², of a method that fits it.
    pub(super) width: Option<f64>,
}

impl Profile<'_> {
    /// Returns the value of a pixel at a distance from the greatest one; 0 outside of the window.
    pub(super) fn at(&self, offset: isize) -> f64 {
        let pixel = self.line.greatest.checked_add_signed(offset);
        pixel
            .filter(|pixel| self.line.window.contains(pixel))
            .map_or(0.0, |pixel| self.above[pixel])
    }

    /// Returns the pixels of the window as distances from the greatest one, and their values.
    pub(super) fn pixels(&self) -> impl DoubleEndedIterator<Item = (f64, f64)> + Clone {
        let window: Range<usize> = self.line.window.clone();
        let greatest = self.line.greatest as f64;
        window.map(move |i| (i as f64 - greatest, self.above[i]))
    }

    /// Counts an estimate from the edge of the column; `None` if it lies outside of the pixels that
    /// it was made from.
    pub(super) fn placed(&self, relative: Estimate) -> Option<Estimate> {
        let position = self.line.greatest as f64 + 0.5 + relative.position;
        let zone = &self.line.zone;
        let inside = zone.start as f64 <= position && position <= zone.end as f64;
        inside.then_some(Estimate {
            position,
            ..relative
        })
    }
}
