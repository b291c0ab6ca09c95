use num_complex::Complex;
use tem00_numerics::Grid;

/// A speckle pattern: intensity with mean 1 on W × H samples, periodic in both axes.
#[derive(Clone, Debug, PartialEq)]
pub struct SpecklePattern {
    values: Grid<f32>,
    speckle_size: f64,
}

impl SpecklePattern {
    pub(crate) const fn new(values: Grid<f32>, speckle_size: f64) -> Self {
        Self {
            values,
            speckle_size,
        }
    }

    /// Returns the intensity at every sample; its expected mean is 1.
    pub const fn values(&self) -> &Grid<f32> {
        &self.values
    }

    /// Converts the pattern into its intensity.
    pub fn into_values(self) -> Grid<f32> {
        self.values
    }

    /// Returns the width and the height, which are the periods, in samples.
    pub const fn size(&self) -> [usize; 2] {
        [self.values.width(), self.values.height()]
    }

    /// Returns the speckle size `Q / C`, in samples.
    pub const fn speckle_size(&self) -> f64 {
        self.speckle_size
    }
}

/// The complex amplitude of a speckle field on W × H samples, periodic in both axes.
///
/// Its band is centred on zero frequency, within half a lattice point, and its expected mean square
/// is 1. The width of the band, the diameter C of the pupil, is at most half the sampling
/// frequency.
#[derive(Clone, Debug, PartialEq)]
pub struct SpeckleField {
    values: Grid<Complex<f32>>,
    speckle_size: f64,
}

impl SpeckleField {
    pub(crate) const fn new(values: Grid<Complex<f32>>, speckle_size: f64) -> Self {
        Self {
            values,
            speckle_size,
        }
    }

    /// Returns the amplitude at every sample.
    pub const fn values(&self) -> &Grid<Complex<f32>> {
        &self.values
    }

    /// Returns the width and the height, which are the periods, in samples.
    pub const fn size(&self) -> [usize; 2] {
        [self.values.width(), self.values.height()]
    }

    /// Returns the speckle size `Q / C`, in samples.
    pub const fn speckle_size(&self) -> f64 {
        self.speckle_size
    }

    /// Returns the intensity `|U|²`.
    pub fn to_pattern(&self) -> SpecklePattern {
        SpecklePattern::new(self.values.map(Complex::norm_sqr), self.speckle_size)
    }
}
