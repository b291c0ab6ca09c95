use pyo3::{prelude::*, types::PyDict};
use tem00_decorrelation as physics;

use crate::{
    arrays::wavelength_of_light,
    pickling::{Recipe, by_constructor},
};

/// Result of `__getnewargs_ex__`: no positional arguments, and those with names.
type Keywords<'py> = ((), Bound<'py, PyDict>);

/// A thin lens at a known distance from the surface; all lengths in metres.
///
/// Parameters
/// ----------
/// wavelength : float
///     Vacuum wavelength of the light.
/// focal_length : float
///     Focal length of the lens.
/// f_number : float
///     F-number as engraved on the lens, for focus at infinity.
/// surface_to_pupil : float
///     Distance from the surface in focus to the pupil.
/// pixel_pitch : float
///     Distance between the centres of neighbouring pixels.
#[pyclass(frozen, eq, get_all, module = "tem00.decorrelation")]
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct LensData {
    pub(super) wavelength: f64,
    focal_length: f64,
    f_number: f64,
    surface_to_pupil: f64,
    pixel_pitch: f64,
}

impl LensData {
    pub(super) const fn physics(&self) -> physics::LensData {
        physics::LensData {
            wavelength: self.wavelength,
            focal_length: self.focal_length,
            f_number: self.f_number,
            surface_to_pupil: self.surface_to_pupil,
            pixel_pitch: self.pixel_pitch,
        }
    }
}

#[pymethods]
impl LensData {
    #[new]
    #[pyo3(signature = (*, wavelength, focal_length, f_number, surface_to_pupil, pixel_pitch))]
    fn new(
        wavelength: f64,
        focal_length: f64,
        f_number: f64,
        surface_to_pupil: f64,
        pixel_pitch: f64,
    ) -> PyResult<Self> {
        Ok(Self {
            wavelength: wavelength_of_light("wavelength", wavelength)?,
            focal_length,
            f_number,
            surface_to_pupil,
            pixel_pitch,
        })
    }

    pub(super) fn __repr__(&self) -> String {
        let Self {
            wavelength,
            focal_length,
            f_number,
            surface_to_pupil,
            pixel_pitch,
        } = self;
        format!(
            "LensData(wavelength={wavelength:?}, focal_length={focal_length:?}, \
             f_number={f_number:?}, surface_to_pupil={surface_to_pupil:?}, \
             pixel_pitch={pixel_pitch:?})"
        )
    }

    fn __getnewargs_ex__<'py>(&self, py: Python<'py>) -> PyResult<Keywords<'py>> {
        let named = PyDict::new(py);
        named.set_item("wavelength", self.wavelength)?;
        named.set_item("focal_length", self.focal_length)?;
        named.set_item("f_number", self.f_number)?;
        named.set_item("surface_to_pupil", self.surface_to_pupil)?;
        named.set_item("pixel_pitch", self.pixel_pitch)?;
        Ok(((), named))
    }
}

/// Position of the surface in focus before a thick lens.
#[pyclass(frozen, eq, module = "tem00.decorrelation")]
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Focus(physics::Focus);

impl Focus {
    /// The name of the constructor, and its argument.
    fn parts(&self) -> (&'static str, f64) {
        match self.0 {
            physics::Focus::SurfaceToPrincipalPlane(s) => ("surface_to_principal_plane", s),
            physics::Focus::SurfaceToPupil(distance) => ("surface_to_pupil", distance),
            physics::Focus::Magnification(m) => ("magnification", m),
            // The type may grow.
            _ => ("magnification", f64::INFINITY),
        }
    }
}

#[pymethods]
impl Focus {
    /// Return the focus at the distance that is imaged with a magnification, counted positive.
    #[staticmethod]
    fn magnification(magnification: f64) -> Self {
        Self(physics::Focus::Magnification(magnification))
    }

    /// Return the focus at a distance from the front principal plane, in metres.
    #[staticmethod]
    fn surface_to_principal_plane(surface_to_principal_plane: f64) -> Self {
        let focus = physics::Focus::SurfaceToPrincipalPlane(surface_to_principal_plane);
        Self(focus)
    }

    /// Return the focus at a distance from the entrance pupil, in metres.
    #[staticmethod]
    fn surface_to_pupil(surface_to_pupil: f64) -> Self {
        Self(physics::Focus::SurfaceToPupil(surface_to_pupil))
    }

    pub(super) fn __repr__(&self) -> String {
        let (name, value) = self.parts();
        format!("Focus.{name}({value:?})")
    }

    fn __reduce__<'py>(&self, py: Python<'py>) -> PyResult<Recipe<'py>> {
        let (name, value) = self.parts();
        by_constructor::<Self>(py, name, (value,))
    }
}

methods! {
    impl Focus as this: this.0;

    unmade "magnification, surface_to_principal_plane or surface_to_pupil";
}

/// A lens of many elements in air; all lengths in metres.
///
/// Parameters
/// ----------
/// wavelength : float
///     Vacuum wavelength of the light.
/// focal_length : float
///     Focal length of the lens.
/// f_number : float
///     F-number as engraved on the lens, for focus at infinity.
/// pupil_magnification : float
///     Diameter of the exit pupil over that of the entrance pupil.
/// focus : Focus
///     Where the surface in focus lies.
/// pixel_pitch : float
///     Distance between the centres of neighbouring pixels.
#[pyclass(frozen, eq, get_all, module = "tem00.decorrelation")]
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct ThickLensData {
    pub(super) wavelength: f64,
    focal_length: f64,
    f_number: f64,
    pupil_magnification: f64,
    focus: Focus,
    pixel_pitch: f64,
}

impl ThickLensData {
    pub(super) const fn physics(&self) -> physics::ThickLensData {
        physics::ThickLensData {
            wavelength: self.wavelength,
            focal_length: self.focal_length,
            f_number: self.f_number,
            pupil_magnification: self.pupil_magnification,
            focus: self.focus.0,
            pixel_pitch: self.pixel_pitch,
        }
    }
}

#[pymethods]
impl ThickLensData {
    #[new]
    #[pyo3(signature = (
        *, wavelength, focal_length, f_number, pupil_magnification, focus, pixel_pitch
    ))]
    fn new(
        wavelength: f64,
        focal_length: f64,
        f_number: f64,
        pupil_magnification: f64,
        focus: PyRef<'_, Focus>,
        pixel_pitch: f64,
    ) -> PyResult<Self> {
        Ok(Self {
            wavelength: wavelength_of_light("wavelength", wavelength)?,
            focal_length,
            f_number,
            pupil_magnification,
            focus: *focus,
            pixel_pitch,
        })
    }

    pub(super) fn __repr__(&self) -> String {
        let Self {
            wavelength,
            focal_length,
            f_number,
            pupil_magnification,
            focus,
            pixel_pitch,
        } = self;
        let focus = focus.__repr__();
        format!(
            "ThickLensData(wavelength={wavelength:?}, focal_length={focal_length:?}, \
             f_number={f_number:?}, pupil_magnification={pupil_magnification:?}, focus={focus}, \
             pixel_pitch={pixel_pitch:?})"
        )
    }

    fn __getnewargs_ex__<'py>(&self, py: Python<'py>) -> PyResult<Keywords<'py>> {
        let named = PyDict::new(py);
        named.set_item("wavelength", self.wavelength)?;
        named.set_item("focal_length", self.focal_length)?;
        named.set_item("f_number", self.f_number)?;
        named.set_item("pupil_magnification", self.pupil_magnification)?;
        named.set_item("focus", self.focus)?;
        named.set_item("pixel_pitch", self.pixel_pitch)?;
        Ok(((), named))
    }
}

/// The distances and the pupil of a camera as such; all lengths in metres.
///
/// Parameters
/// ----------
/// wavelength : float
///     Vacuum wavelength of the light.
/// surface_to_pupil : float
///     Distance from the surface in focus to the pupil.
/// pupil_to_image : float
///     Distance from the pupil to the sensor.
/// pupil_diameter : float
///     Diameter of the pupil.
/// pixel_pitch : float
///     Distance between the centres of neighbouring pixels.
#[pyclass(frozen, eq, get_all, module = "tem00.decorrelation")]
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct PupilDistances {
    pub(super) wavelength: f64,
    surface_to_pupil: f64,
    pupil_to_image: f64,
    pupil_diameter: f64,
    pixel_pitch: f64,
}

impl PupilDistances {
    pub(super) const fn physics(&self) -> physics::PupilDistances {
        physics::PupilDistances {
            wavelength: self.wavelength,
            surface_to_pupil: self.surface_to_pupil,
            pupil_to_image: self.pupil_to_image,
            pupil_diameter: self.pupil_diameter,
            pixel_pitch: self.pixel_pitch,
        }
    }
}

#[pymethods]
impl PupilDistances {
    #[new]
    #[pyo3(signature = (
        *, wavelength, surface_to_pupil, pupil_to_image, pupil_diameter, pixel_pitch
    ))]
    fn new(
        wavelength: f64,
        surface_to_pupil: f64,
        pupil_to_image: f64,
        pupil_diameter: f64,
        pixel_pitch: f64,
    ) -> PyResult<Self> {
        Ok(Self {
            wavelength: wavelength_of_light("wavelength", wavelength)?,
            surface_to_pupil,
            pupil_to_image,
            pupil_diameter,
            pixel_pitch,
        })
    }

    pub(super) fn __repr__(&self) -> String {
        let Self {
            wavelength,
            surface_to_pupil,
            pupil_to_image,
            pupil_diameter,
            pixel_pitch,
        } = self;
        format!(
            "PupilDistances(wavelength={wavelength:?}, surface_to_pupil={surface_to_pupil:?}, \
             pupil_to_image={pupil_to_image:?}, pupil_diameter={pupil_diameter:?}, \
             pixel_pitch={pixel_pitch:?})"
        )
    }

    fn __getnewargs_ex__<'py>(&self, py: Python<'py>) -> PyResult<Keywords<'py>> {
        let named = PyDict::new(py);
        named.set_item("wavelength", self.wavelength)?;
        named.set_item("surface_to_pupil", self.surface_to_pupil)?;
        named.set_item("pupil_to_image", self.pupil_to_image)?;
        named.set_item("pupil_diameter", self.pupil_diameter)?;
        named.set_item("pixel_pitch", self.pixel_pitch)?;
        Ok(((), named))
    }
}
