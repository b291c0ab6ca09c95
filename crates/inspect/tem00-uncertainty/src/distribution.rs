use core::fmt;

/// Shape of the distribution that describes the knowledge of a quantity.
///
/// # References
///
/// - JCGM 101:2008, *Propagation of distributions using a Monte Carlo method*, § 6.4.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Distribution {
    /// Normal (§ 6.4.7): an estimate and its standard uncertainty are known, and nothing else. With
    /// [degrees of freedom](crate::Input::with_degrees_of_freedom) it is a t.
    Normal,
    /// Rectangular (§ 6.4.2): the limits are known, and nothing else.
    Rectangular,
    /// Triangular (§ 6.4.5): the sum of two independent rectangular quantities of the same width.
    Triangular,
    /// Arcsine, U-shaped (§ 6.4.6): a quantity that oscillates between known limits, at an unknown
    /// time.
    Arcsine,
    /// Scaled and shifted t (§ 6.4.9): the mean of normal observations; it needs degrees of
    /// freedom.
    StudentT,
}

impl Distribution {
    /// List of all distributions.
    pub const ALL: [Self; 5] = [
        Self::Normal,
        Self::Rectangular,
        Self::Triangular,
        Self::Arcsine,
        Self::StudentT,
    ];

    /// Returns the name: `normal`, `rectangular`, `triangular`, `arcsine` or `t`.
    pub const fn name(self) -> &'static str {
        match self {
            Self::Normal => "normal",
            Self::Rectangular => "rectangular",
            Self::Triangular => "triangular",
            Self::Arcsine => "arcsine",
            Self::StudentT => "t",
        }
    }

    /// Returns the half-width in standard uncertainties: √3 for a rectangular, √6 for a triangular,
    /// √2 for an arcsine distribution; `None` for a distribution without limits.
    pub fn half_width(self) -> Option<f64> {
        let square: Option<f64> = match self {
            Self::Normal | Self::StudentT => None,
            Self::Rectangular => Some(3.0),
            Self::Triangular => Some(6.0),
            Self::Arcsine => Some(2.0),
        };
        square.map(f64::sqrt)
    }
}

impl fmt::Display for Distribution {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(self.name())
    }
}
