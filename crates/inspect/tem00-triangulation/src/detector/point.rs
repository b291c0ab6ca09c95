use crate::named::named;

/// A line where it crosses a column.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct LinePoint {
    /// The position along the column, in pixels; the centre of the first pixel is at 0.5.
    pub position: f64,
    /// The full width between the points of 1/e², in pixels.
    ///
    /// It is twice the width between the points before which 16 and 84 % of the light of the window
    /// lie, or the width of the [fit](crate::LineMethod::GaussianFit).
    pub width: f64,
    /// The greatest grey value above the background.
    pub peak: f64,
    /// The sum of the grey values above the background over the window: the light that the surface
    /// reflects.
    pub integral: f64,
    /// The grey value of the background.
    pub background: f64,
    /// The reason why the position cannot be trusted, if there is one.
    pub validity: Validity,
    /// The index of the line of the image that the point belongs to, from 0; in a single column,
    /// the number of the line from the top.
    pub line: usize,
}

named! {
    /// Validity of a point of a line, with the reason if it cannot be trusted.
    #[non_exhaustive]
    Validity {
        /// Nothing speaks against it.
        Valid = "valid",
        /// A pixel of the window is saturated.
        Saturated = "saturated",
        /// The window reaches beyond the image.
        Cut = "cut",
        /// The window was cut where the next line of the column begins.
        Crowded = "crowded",
        /// A pixel of the window is not a finite number; it counts as background.
        Missing = "missing",
        /// The estimate did not converge or lies outside of the window; the position is the
        /// position of the peak.
        Failed = "failed",
        /// An edge of the part cuts the line so that only a sliver is seen, whose position is the
        /// position of the edge; or there is no line except by noise. Only code that knows the line
        /// without noise can find this; a detector does not.
        Sliver = "sliver",
    }
}
