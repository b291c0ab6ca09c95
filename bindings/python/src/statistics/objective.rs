use pyo3::prelude::*;
use tem00_statistics as physics;

use crate::{
    arrays::{Numbers, Values, length, map, wavelength_of_light},
    error::OrRaise,
    pickling::{Recipe, by_constructor},
};

/// The area of a rough surface that is lit, with lengths in metres.
#[pyclass(frozen, eq, module = "tem00.statistics")]
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct LitArea(physics::LitArea);

#[pymethods]
impl LitArea {
    /// Return a uniformly lit disc of a diameter in metres.
    #[staticmethod]
    fn disc(diameter: f64) -> PyResult<Self> {
        let diameter = length("diameter", diameter)?;
        Ok(Self(physics::LitArea::Disc { diameter }))
    }

    /// Return a uniformly lit rectangle of a width along x and a height along y, in metres.
    #[staticmethod]
    fn rectangle(width: f64, height: f64) -> PyResult<Self> {
        let (width, height) = (length("width", width)?, length("height", height)?);
        Ok(Self(physics::LitArea::Rectangle { width, height }))
    }

    /// Return a Gaussian spot of a 1/e² radius in metres.
    #[staticmethod]
    fn gaussian_spot(radius: f64) -> PyResult<Self> {
        let radius = length("radius", radius)?;
        Ok(Self(physics::LitArea::GaussianSpot { radius }))
    }

    fn __repr__(&self) -> String {
        match self.0 {
            physics::LitArea::Disc { diameter } => format!("LitArea.disc(diameter={diameter:?})"),
            physics::LitArea::Rectangle { width, height } => {
                format!("LitArea.rectangle(width={width:?}, height={height:?})")
            }
            physics::LitArea::GaussianSpot { radius } => {
                format!("LitArea.gaussian_spot(radius={radius:?})")
            }
        }
    }

    fn __reduce__<'py>(&self, py: Python<'py>) -> PyResult<Recipe<'py>> {
        match self.0 {
            physics::LitArea::Disc { diameter } => by_constructor::<Self>(py, "disc", (diameter,)),
            physics::LitArea::Rectangle { width, height } => {
                by_constructor::<Self>(py, "rectangle", (width, height))
            }
            physics::LitArea::GaussianSpot { radius } => {
                by_constructor::<Self>(py, "gaussian_spot", (radius,))
            }
        }
    }
}

methods! {
    impl LitArea as this: this.0;

    unmade "disc, rectangle or gaussian_spot";
}

/// Speckle without a lens: the pattern that a lit area of a rough surface makes in a distant plane.
///
/// Parameters
/// ----------
/// wavelength : float
///     Wavelength in metres.
/// distance : float
///     Distance of the plane from the surface, in metres.
/// area : LitArea
///     The lit area.
#[pyclass(frozen, eq, module = "tem00.statistics")]
#[derive(Clone, Copy, Debug)]
pub(crate) struct ObjectiveSpeckle {
    speckle: physics::ObjectiveSpeckle,
    wavelength: f64,
    distance: f64,
    area: LitArea,
}

impl PartialEq for ObjectiveSpeckle {
    fn eq(&self, other: &Self) -> bool {
        self.speckle == other.speckle
    }
}

#[pymethods]
impl ObjectiveSpeckle {
    #[new]
    fn new(wavelength: f64, distance: f64, area: PyRef<'_, LitArea>) -> PyResult<Self> {
        let wavelength = wavelength_of_light("wavelength", wavelength)?;
        Ok(Self {
            speckle: physics::ObjectiveSpeckle::new(wavelength, distance, area.0).or_raise()?,
            wavelength,
            distance,
            area: *area,
        })
    }

    /// Return the normalised autocovariance of the intensity.
    ///
    /// Parameters
    /// ----------
    /// lag : pair of float or array_like
    ///     Lag along x and y in metres, broadcast together.
    fn autocovariance<'py>(
        &self,
        py: Python<'py>,
        lag: [Numbers<'py>; 2],
    ) -> PyResult<Values<'py>> {
        let [x, y] = &lag;
        map(py, [("lag", x), ("lag", y)], |lag| {
            self.speckle.autocovariance(lag)
        })
    }

    fn __repr__(&self) -> String {
        let Self {
            wavelength,
            distance,
            area,
            ..
        } = self;
        let area = area.__repr__();
        format!("ObjectiveSpeckle(wavelength={wavelength:?}, distance={distance:?}, area={area})")
    }

    fn __reduce__<'py>(&self, py: Python<'py>) -> PyResult<Recipe<'py>> {
        by_constructor::<Self>(py, "__call__", (self.wavelength, self.distance, self.area))
    }
}

methods! {
    impl ObjectiveSpeckle as this: this.speckle;

    /// Speckle size along x and y, in metres.
    get size -> (f64, f64);

    /// Coherence area in m².
    get coherence_area -> f64;
}
