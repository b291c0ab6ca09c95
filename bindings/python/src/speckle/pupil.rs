use numpy::Complex32;
use pyo3::prelude::*;
use tem00_numerics::Grid;
use tem00_speckle::{self as physics, Pupil as Shape, SpeckleError};

use super::images::{View, view};
use crate::{arrays::LIMIT, pickling::Value};

class! {
    /// The shape of the camera's pupil; lengths are in units of its diameter.
    "tem00.speckle" Pupil(Shape)
}

methods! {
    impl Pupil as this: this.0;

    unmade "circle, annulus, rectangle, gaussian or sampled";

    /// Return a full disc.
    make circle() = PyResult::Ok(Shape::Circle);

    /// Return a disc with a central obstruction.
    ///
    /// Parameters
    /// ----------
    /// inner : float
    ///     Diameter of the obstruction, between 0 and 1.
    make annulus(inner: f64) = checked(Shape::Annulus { inner });

    /// Return a rectangular stop.
    ///
    /// Parameters
    /// ----------
    /// height : float
    ///     Height in units of the width, above 0 and at most 1.
    make rectangle(height: f64) = checked(Shape::Rectangle { height });

    /// Return a disc whose amplitude transmission falls off as exp(-p**2 / radius**2).
    ///
    /// Parameters
    /// ----------
    /// radius : float
    ///     Distance from the centre at which 1/e² of the power is transmitted.
    make gaussian(radius: f64) = checked(Shape::Gaussian { radius });

    /// Return a pupil of any transmission over its bounding square, with phase if there are
    /// aberrations.
    ///
    /// Parameters
    /// ----------
    /// amplitude : array_like of complex, shape (rows, columns)
    ///     Amplitude transmission of magnitudes between 0 and 1.
    make sampled(amplitude: Grid<Complex32>) =
        physics::Transmission::from_complex(amplitude).map(Shape::Sampled);

    /// Return the overlap of the pupil with itself, displaced by x and y diameters.
    ///
    /// It is the amplitude correlation of two speckle fields whose pupils are so displaced.
    ///
    /// Parameters
    /// ----------
    /// x, y : array_like
    ///     Displacement in pupil diameters.
    map overlap(x, y) = this.0.overlap([x, y]);

    made_as match &this.0 {
        Shape::Circle => ("circle", vec![]),
        Shape::Annulus { inner } => ("annulus", vec![Value::Number(*inner)]),
        Shape::Rectangle { height } => ("rectangle", vec![Value::Number(*height)]),
        Shape::Gaussian { radius } => ("gaussian", vec![Value::Number(*radius)]),
        Shape::Sampled(grid) => ("sampled", vec![Value::Image(grid.values().clone().into())]),
    };
}

#[pymethods]
impl Pupil {
    /// Amplitude transmission of a sampled pupil, complex64 [row, column], a read-only view; None
    /// for others.
    #[getter]
    fn values<'py>(slf: &Bound<'py, Self>) -> PyResult<View<'py, Complex32>> {
        view(slf, |this| match &this.0 {
            Shape::Sampled(transmission) => Some(transmission.values()),
            _ => None,
        })
    }
}

fn checked(pupil: Shape) -> Result<Shape, SpeckleError> {
    pupil.check().map(|()| pupil)
}
