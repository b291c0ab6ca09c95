use pyo3::prelude::*;
use tem00_speckle as physics;

use super::{
    arguments::{counts, finite_pair},
    field::PupilField,
};
use crate::{
    arrays::{Whole, length},
    error::OrRaise,
    pickling::{Recipe, by_constructor},
};

/// The area of a rough surface that is lit; lengths are in metres.
#[pyclass(frozen, eq, module = "tem00.speckle")]
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct LitArea(physics::LitArea);

#[pymethods]
impl LitArea {
    /// Return a uniformly lit disc.
    ///
    /// Parameters
    /// ----------
    /// diameter : float
    ///     Diameter in metres.
    #[staticmethod]
    fn disc(diameter: f64) -> PyResult<Self> {
        let diameter = length("diameter", diameter)?;
        Ok(Self(physics::LitArea::Disc { diameter }))
    }

    /// Return a uniformly lit ring.
    ///
    /// Parameters
    /// ----------
    /// outer, inner : float
    ///     Outer and inner diameter in metres.
    #[staticmethod]
    fn ring(outer: f64, inner: f64) -> PyResult<Self> {
        let (outer, inner) = (length("outer", outer)?, length("inner", inner)?);
        Ok(Self(physics::LitArea::Ring { outer, inner }))
    }

    /// Return a uniformly lit rectangle, longer along x than along y or as long.
    ///
    /// Parameters
    /// ----------
    /// width, height : float
    ///     Length along x and along y in metres.
    #[staticmethod]
    fn rectangle(width: f64, height: f64) -> PyResult<Self> {
        let (width, height) = (length("width", width)?, length("height", height)?);
        Ok(Self(physics::LitArea::Rectangle { width, height }))
    }

    /// Return a Gaussian spot, cut off at 2.5 of its radii.
    ///
    /// Parameters
    /// ----------
    /// radius : float
    ///     Radius in metres at which the irradiance has fallen to 1/e².
    #[staticmethod]
    fn gaussian_spot(radius: f64) -> PyResult<Self> {
        let radius = length("radius", radius)?;
        Ok(Self(physics::LitArea::GaussianSpot { radius }))
    }

    fn __repr__(&self) -> String {
        match self.0 {
            physics::LitArea::Disc { diameter } => format!("LitArea.disc(diameter={diameter})"),
            physics::LitArea::Ring { outer, inner } => {
                format!("LitArea.ring(outer={outer}, inner={inner})")
            }
            physics::LitArea::Rectangle { width, height } => {
                format!("LitArea.rectangle(width={width}, height={height})")
            }
            physics::LitArea::GaussianSpot { radius } => {
                format!("LitArea.gaussian_spot(radius={radius})")
            }
        }
    }

    fn __reduce__<'py>(&self, py: Python<'py>) -> PyResult<Recipe<'py>> {
        match self.0 {
            physics::LitArea::Disc { diameter } => by_constructor::<Self>(py, "disc", (diameter,)),
            physics::LitArea::Ring { outer, inner } => {
                by_constructor::<Self>(py, "ring", (outer, inner))
            }
            physics::LitArea::Rectangle { width, height } => {
                by_constructor::<Self>(py, "rectangle", (width, height))
            }
            physics::LitArea::GaussianSpot { radius } => {
                by_constructor::<Self>(py, "gaussian_spot", (radius,))
            }
        }
    }
}

/// Speckle without a lens: what a lit area of a rough surface makes on a screen or sensor.
///
/// Parameters
/// ----------
/// wavelength : float
///     Wavelength in metres.
/// distance : float
///     Distance of the screen in metres.
/// area : `LitArea`
///     Area of the surface that is lit.
#[pyclass(frozen, eq, module = "tem00.speckle")]
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct ObjectiveSpeckle(physics::ObjectiveSpeckle);

#[pymethods]
impl ObjectiveSpeckle {
    #[new]
    fn new(wavelength: f64, distance: f64, area: &LitArea) -> PyResult<Self> {
        let speckle = physics::ObjectiveSpeckle::new(wavelength, distance, area.0);
        Ok(Self(speckle.or_raise()?))
    }

    /// Return the field on a screen.
    ///
    /// Parameters
    /// ----------
    /// size : (int, int)
    ///     Width and height of the screen in samples.
    /// `sample_pitch` : float
    ///     Distance of neighbouring samples in metres, at most half the speckle size.
    /// seed : int
    ///     Seed of the phasors, 0 to 2**64 - 1.
    fn field(
        &self,
        size: [Whole<'_>; 2],
        sample_pitch: f64,
        seed: Whole<'_>,
    ) -> PyResult<PupilField> {
        let (size, seed) = (counts("size", &size)?, seed.unsigned("seed")?);
        let field = self.0.field(size, sample_pitch, seed);
        Ok(PupilField(field.or_raise()?))
    }

    /// Return the displacement of the pupil, in its diameters, when the surface has moved.
    ///
    /// Parameters
    /// ----------
    /// displacement : (float, float)
    ///     Motion of the surface through the light along x and y, in metres.
    fn offset(&self, displacement: [f64; 2]) -> PyResult<(f64, f64)> {
        let displacement = finite_pair("displacement", displacement)?;
        let [x, y] = finite_pair("displacement", self.0.offset(displacement))?;
        Ok((x, y))
    }

    fn __repr__(&self) -> String {
        format!(
            "ObjectiveSpeckle(wavelength={:e}, distance={}, area={})",
            self.0.wavelength(),
            self.0.distance(),
            self.area().__repr__()
        )
    }

    fn __reduce__<'py>(&self, py: Python<'py>) -> PyResult<Recipe<'py>> {
        let arguments = (self.0.wavelength(), self.0.distance(), self.area());
        by_constructor::<Self>(py, "__call__", arguments)
    }
}

methods! {
    impl ObjectiveSpeckle as this: this.0;

    /// Wavelength in metres.
    get wavelength -> f64;

    /// Distance of the screen in metres.
    get distance -> f64;

    /// Area of the surface that is lit.
    get area -> LitArea = LitArea(this.0.area());

    /// Speckle size in metres: the period of the finest fringes along x.
    get speckle_size -> f64;
}
