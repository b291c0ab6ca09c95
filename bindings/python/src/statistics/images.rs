use super::physics::{self, Boundary};
use tem00_numerics::Grid;

use crate::{
    arrays::{Floats, ImageArray, named_tuple},
    error::OrRaise,
};

/// Names of the values of an image in errors.
const VALUES: &[&str] = &["samples", "lags"];

crate::arguments::choices! {
    Boundary: "periodic" = Self::Periodic, "finite" = Self::Finite;
}

named_tuple! { Ring(physics::Ring) as ring: (ring.radius, ring.mean, ring.count) }

functions! {
    /// Return the normalised autocovariance of an image at every lag, 1 at zero lag.
    ///
    /// Parameters
    /// ----------
    /// image : array_like, shape (rows, columns)
    ///     The image.
    /// boundary : {"periodic", "finite"}
    ///     Whether the image repeats, as a computed pattern does, or nothing is known beyond its
    ///     edges.
    ///
    /// Returns
    /// -------
    /// float32 ndarray, shape (rows, columns) or (2 rows, 2 columns)
    ///     Lag (x, y) stands at [y, x], negative lags at the far end. Twice the shape for a finite
    ///     image.
    try autocovariance(image: Grid<f32>, boundary: Boundary) -> ImageArray<f32> =
        physics::autocovariance(&image, boundary).or_raise_renamed(VALUES, "image");

    /// Return the power spectrum of the fluctuations of a periodic image.
    ///
    /// Parameters
    /// ----------
    /// image : array_like, shape (rows, columns)
    ///     The image.
    ///
    /// Returns
    /// -------
    /// float32 ndarray, shape (rows, columns)
    ///     Pixels² per unit variance. Frequency (kx / columns, ky / rows), in cycles per pixel,
    ///     stands at [ky, kx], negative ones at the far end.
    try power_spectrum(image: Grid<f32>) -> ImageArray<f32> =
        physics::power_spectrum(&image).or_raise_renamed(VALUES, "image");

    /// Return the averages of a grid of lags or frequencies over rings about its origin.
    ///
    /// Parameters
    /// ----------
    /// grid : array_like, shape (rows, columns)
    ///     Lags or frequencies, with the origin at [0, 0] and negative ones at the far end.
    /// step : (float, float)
    ///     Size of a cell along x and y: (1, 1) for lags in pixels, (1 / columns, 1 / rows) for
    ///     frequencies in cycles per pixel.
    ///
    /// Returns
    /// -------
    /// list of Ring
    ///     Ring k gathers the cells nearest to k times the larger step.
    try radial_average(grid: Grid<f32>, step: [f64; 2]) -> Vec<Ring> = {
        let rings = physics::radial_average(&grid, step);
        rings.map(|rings| rings.into_iter().map(Ring::from).collect::<Vec<_>>())
    };

    /// Return every ``stride``-th pixel of every ``stride``-th row.
    ///
    /// Parameters
    /// ----------
    /// grid : array_like, shape (rows, columns)
    ///     The image.
    /// stride : int
    ///     Pixels from one sample to the next: 1.22 speckle sizes at least, for independent ones.
    ///
    /// Returns
    /// -------
    /// ndarray, shape (n,)
    ///     The samples, without those of an incomplete last stride.
    try decorrelated_samples(grid: Grid<f32>, stride: usize) -> Floats =
        physics::decorrelated_samples(&grid, stride);

    /// Return the contrast of an image within a square window about every pixel.
    ///
    /// Parameters
    /// ----------
    /// image : array_like, shape (rows, columns)
    ///     The image.
    /// window : int
    ///     Width and height of the window in pixels, at least 2.
    ///
    /// Returns
    /// -------
    /// float32 ndarray, shape (rows − window + 1, columns − window + 1)
    ///     The value at [y, x] is that of the window whose first pixel is there.
    try local_contrast(image: Grid<f32>, window: usize) -> ImageArray<f32> =
        physics::local_contrast(&image, window).or_raise_renamed(VALUES, "image");
}

class! {
    /// The speckle size along both axes of an image, in pixels.
    "tem00.statistics" SpeckleSize(physics::SpeckleSize): Copy
}

methods! {
    impl SpeckleSize as this: this.0;

    unmade "from_image or from_autocovariance";

    /// Measure the speckle size of an image.
    ///
    /// Parameters
    /// ----------
    /// image : array_like, shape (rows, columns)
    ///     The image.
    /// boundary : {"periodic", "finite"}
    ///     Whether the image repeats, or nothing is known beyond its edges.
    make from_image(image: Grid<f32>, boundary: Boundary) =
        physics::SpeckleSize::from_image(&image, boundary).or_raise_renamed(VALUES, "image");

    /// Measure the speckle size from an autocovariance with zero lag at [0, 0].
    make from_autocovariance(lags: Grid<f32>) = physics::SpeckleSize::from_autocovariance(&lags);

    /// Speckle size along the rows, in pixels.
    get x -> f64;

    /// Speckle size along the columns, in pixels.
    get y -> f64;

    /// Geometric mean of both sizes, in pixels.
    get mean -> f64;

    shown x, y;
}
