use numpy::{Complex32, PyArray2};
use pyo3::prelude::*;
use tem00_speckle as physics;

use super::images::view;
use crate::{
    arrays::{ComplexImage, Image, map},
    error::OrRaise,
    pickling::{Recipe, by_constructor},
};

/// The shape of the camera's pupil; lengths are in units of its diameter.
#[pyclass(frozen, eq, module = "tem00.speckle")]
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Pupil(pub(super) physics::Pupil);

#[pymethods]
impl Pupil {
    /// Return a full disc.
    #[staticmethod]
    const fn circle() -> Self {
        Self(physics::Pupil::Circle)
    }

    /// Return a disc with a central obstruction.
    ///
    /// Parameters
    /// ----------
    /// inner : float
    ///     Diameter of the obstruction, between 0 and 1.
    #[staticmethod]
    fn annulus(inner: f64) -> PyResult<Self> {
        Self::checked(physics::Pupil::Annulus { inner })
    }

    /// Return a rectangular stop.
    ///
    /// Parameters
    /// ----------
    /// height : float
    ///     Height in units of the width, above 0 and at most 1.
    #[staticmethod]
    fn rectangle(height: f64) -> PyResult<Self> {
        Self::checked(physics::Pupil::Rectangle { height })
    }

    /// Return a disc whose amplitude transmission falls off as exp(-p**2 / radius**2).
    ///
    /// Parameters
    /// ----------
    /// radius : float
    ///     Distance from the centre at which 1/e² of the power is transmitted.
    #[staticmethod]
    fn gaussian(radius: f64) -> PyResult<Self> {
        Self::checked(physics::Pupil::Gaussian { radius })
    }

    /// Return a pupil of any transmission over its bounding square.
    ///
    /// Parameters
    /// ----------
    /// transmission : Transmission
    ///     Amplitude transmission, with phase if there are aberrations.
    #[staticmethod]
    fn sampled(transmission: &Transmission) -> Self {
        Self(physics::Pupil::Sampled(transmission.0.clone()))
    }

    pub(super) fn __repr__(&self) -> String {
        match &self.0 {
            physics::Pupil::Circle => "Pupil.circle()".to_owned(),
            physics::Pupil::Annulus { inner } => format!("Pupil.annulus(inner={inner})"),
            physics::Pupil::Rectangle { height } => format!("Pupil.rectangle(height={height})"),
            physics::Pupil::Gaussian { radius } => format!("Pupil.gaussian(radius={radius})"),
            physics::Pupil::Sampled(transmission) => {
                let grid = transmission.values();
                let (height, width) = (grid.height(), grid.width());
                format!("<Pupil: {height} x {width} samples>")
            }
        }
    }

    fn __reduce__<'py>(slf: &Bound<'py, Self>) -> PyResult<Recipe<'py>> {
        let py = slf.py();
        match &slf.get().0 {
            physics::Pupil::Circle => by_constructor::<Self>(py, "circle", ()),
            physics::Pupil::Annulus { inner } => by_constructor::<Self>(py, "annulus", (*inner,)),
            physics::Pupil::Rectangle { height } => {
                by_constructor::<Self>(py, "rectangle", (*height,))
            }
            physics::Pupil::Gaussian { radius } => {
                by_constructor::<Self>(py, "gaussian", (*radius,))
            }
            physics::Pupil::Sampled(transmission) => {
                let transmission = Transmission(transmission.clone());
                by_constructor::<Self>(py, "sampled", (transmission,))
            }
        }
    }
}

methods! {
    impl Pupil as this: this.0;

    unmade "circle, annulus, rectangle, gaussian or sampled";

    /// "circle", "annulus", "rectangle", "gaussian" or "sampled".
    get kind -> &'static str = match this.0 {
        physics::Pupil::Circle => "circle",
        physics::Pupil::Annulus { .. } => "annulus",
        physics::Pupil::Rectangle { .. } => "rectangle",
        physics::Pupil::Gaussian { .. } => "gaussian",
        physics::Pupil::Sampled(_) => "sampled",
    };

    /// Return the overlap of the pupil with itself, displaced by x and y diameters.
    ///
    /// It is the amplitude correlation of two speckle fields whose pupils are so displaced.
    ///
    /// Parameters
    /// ----------
    /// x, y : array_like
    ///     Displacement in pupil diameters.
    map overlap(x, y) = this.0.overlap([x, y]);
}

impl Pupil {
    fn checked(pupil: physics::Pupil) -> PyResult<Self> {
        pupil.check().or_raise()?;
        Ok(Self(pupil))
    }
}

/// The amplitude transmission of a pupil of any shape, on a grid over its bounding square.
///
/// Parameters
/// ----------
/// amplitude : array_like, shape (rows, columns)
///     0 where the pupil is opaque, 1 where it is open.
#[pyclass(frozen, eq, module = "tem00.speckle")]
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Transmission(physics::Transmission);

#[pymethods]
impl Transmission {
    #[new]
    fn new(amplitude: Image<'_>) -> PyResult<Self> {
        let amplitude = amplitude.grid("amplitude")?;
        Ok(Self(physics::Transmission::new(&amplitude).or_raise()?))
    }

    /// Return the transmission of a complex amplitude, as of a lens with aberrations.
    ///
    /// Parameters
    /// ----------
    /// amplitude : array_like of complex, shape (rows, columns)
    ///     Magnitudes between 0 and 1.
    #[staticmethod]
    fn from_complex(amplitude: ComplexImage<'_>) -> PyResult<Self> {
        let amplitude = amplitude.grid("amplitude")?;
        let transmission = physics::Transmission::from_complex(amplitude);
        Ok(Self(transmission.or_raise()?))
    }

    /// Amplitude transmission, complex64 [row, column]: a read-only view without a copy.
    #[getter]
    fn values<'py>(slf: &Bound<'py, Self>) -> PyResult<Bound<'py, PyArray2<Complex32>>> {
        // SAFETY: the values lie in this object, which is frozen.
        unsafe { view(slf.clone().into_any(), slf.get().0.values()) }
    }

    pub(super) fn __repr__(&self) -> String {
        let grid = self.0.values();
        format!(
            "<Transmission: {} x {} samples>",
            grid.height(),
            grid.width()
        )
    }

    fn __reduce__<'py>(slf: &Bound<'py, Self>) -> PyResult<Recipe<'py>> {
        let values = Self::values(slf)?;
        by_constructor::<Self>(slf.py(), "from_complex", (values,))
    }
}
