use super::physics::{self, LitArea};
use pyo3::prelude::*;

use crate::{
    arrays::{length, map},
    error::OrRaise,
    pickling::{Made, Recipe, keywords},
};

/// Speckle without a lens: the pattern that a lit area of a rough surface makes in a distant plane.
///
/// Lengths are in metres; the distance is that of the plane from the surface.
#[pyclass(frozen, eq, module = "tem00.statistics")]
#[derive(Clone, Debug)]
pub(crate) struct ObjectiveSpeckle {
    speckle: physics::ObjectiveSpeckle,
    made: Made,
}

impl PartialEq for ObjectiveSpeckle {
    fn eq(&self, other: &Self) -> bool {
        self.speckle == other.speckle
    }
}

impl ObjectiveSpeckle {
    /// Checks the lengths of the area, which are given last, and makes the speckle.
    fn of(made: Made, area: LitArea) -> PyResult<Self> {
        let [(_, wavelength), (_, distance), ref lengths @ ..] = made.keywords[..] else {
            unreachable!("keywords begin with wavelength and distance")
        };
        for &(name, value) in lengths {
            length(name, value)?;
        }
        let speckle = physics::ObjectiveSpeckle::new(wavelength, distance, area).or_raise()?;
        Ok(Self { speckle, made })
    }
}

#[pymethods]
impl ObjectiveSpeckle {
    /// Return the speckle of a uniformly lit disc of a diameter.
    #[staticmethod]
    fn disc(wavelength: Bound<'_, PyAny>, distance: f64, diameter: f64) -> PyResult<Self> {
        take!(wavelength: f64);
        let made = keywords!(disc: wavelength, distance, diameter);
        Self::of(made, LitArea::Disc { diameter })
    }

    /// Return the speckle of a uniformly lit rectangle of a width along x and a height along y.
    #[staticmethod]
    fn rectangle(
        wavelength: Bound<'_, PyAny>,
        distance: f64,
        width: f64,
        height: f64,
    ) -> PyResult<Self> {
        take!(wavelength: f64);
        let made = keywords!(rectangle: wavelength, distance, width, height);
        Self::of(made, LitArea::Rectangle { width, height })
    }

    /// Return the speckle of a Gaussian spot of a 1/e² radius.
    #[staticmethod]
    fn gaussian_spot(wavelength: Bound<'_, PyAny>, distance: f64, radius: f64) -> PyResult<Self> {
        take!(wavelength: f64);
        let made = keywords!(gaussian_spot: wavelength, distance, radius);
        Self::of(made, LitArea::GaussianSpot { radius })
    }

    fn __repr__(&self) -> String {
        self.made.call("ObjectiveSpeckle")
    }

    fn __reduce__<'py>(&self, py: Python<'py>) -> PyResult<Recipe<'py>> {
        self.made.recipe::<Self>(py)
    }
}

methods! {
    impl ObjectiveSpeckle as this: this.speckle;

    unmade "disc, rectangle or gaussian_spot";

    /// Return the normalised autocovariance of the intensity.
    ///
    /// Parameters
    /// ----------
    /// x, y : float or array_like
    ///     Lag along x and y in metres, broadcast together.
    map autocovariance(x, y) = this.speckle.autocovariance([x, y]);

    /// Speckle size along x and y, in metres.
    get size -> (f64, f64);

    /// Coherence area in m².
    get coherence_area -> f64;
}
