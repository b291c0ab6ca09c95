//! Results of queries: named numbers, or named arrays of one shape.

use pyo3::prelude::*;

/// Defines a frozen class of named values with a constructor, a repr and pickling. The types are for
/// the stubs: `Values` are numbers or arrays.
macro_rules! record {
    ($module:literal, $(#[$doc:meta])* $name:ident { $($(#[$field_doc:meta])* $field:ident: $type:ident,)+ }) => {
        $(#[$doc])*
        #[pyclass(frozen, module = $module)]
        #[derive(Debug)]
        pub(crate) struct $name {
            $($(#[$field_doc])* #[pyo3(get)] pub(super) $field: Py<PyAny>,)+
        }

        #[pymethods]
        impl $name {
            #[new]
            fn new($($field: Py<PyAny>),+) -> Self {
                Self { $($field),+ }
            }

            fn __repr__(&self, py: Python<'_>) -> PyResult<String> {
                let fields = [$((stringify!($field), &self.$field)),+];
                $crate::beam::records::shown(py, stringify!($name), &fields)
            }

            fn __getnewargs__<'py>(
                &self,
                py: Python<'py>,
            ) -> PyResult<Bound<'py, pyo3::types::PyTuple>> {
                pyo3::types::PyTuple::new(py, [$(self.$field.clone_ref(py)),+])
            }
        }
    };
}

record! {
    "tem00.beam",
    /// The light that arrives at a point, as one direction and one irradiance.
    ///
    /// For arrays of points all members are arrays, and 0 where no light arrives.
    NextEvent {
        /// Point of the aperture plane that the light seems to come from, shape (..., 3).
        point: Array,
        /// Distance to ``point``, in metres, shape (...).
        distance: Values,
        /// Unit vector towards the light, against the mean energy flow, shape (..., 3).
        wi: Array,
        /// Irradiance of a surface square to ``wi``, in W/m², shape (...).
        e_perp: Values,
    }
}

record! {
    "tem00.beam",
    /// The light that arrives at a point, as a random direction and its density.
    ///
    /// For arrays of points all members are arrays, and 0 where no light arrives.
    SampledEvent {
        /// Point of the aperture plane that the ray comes from, shape (..., 3).
        point: Array,
        /// Distance to ``point``, in metres, shape (...).
        distance: Values,
        /// Unit vector towards the light, shape (..., 3).
        wi: Array,
        /// Radiance divided by ``pdf``, in W/m², shape (...).
        value: Values,
        /// Probability density of ``wi``, per steradian, shape (...).
        pdf: Values,
    }
}

record! {
    "tem00.beam",
    /// A ray that leaves the aperture, or arrays of them.
    RaySample {
        /// Point of the aperture plane, shape (..., 3).
        origin: Array,
        /// Power the ray stands for, in watts: that of the light, to be divided by the number of
        /// rays, shape (...).
        flux: Values,
        /// Unit vector along the ray, shape (..., 3).
        direction: Array,
        /// Cosine of the angle between the ray and the axis, shape (...).
        cos: Values,
        /// Probability density of ``origin`` given the direction, per m² of the aperture plane,
        /// shape (...).
        pdf_position: Values,
        /// Probability density of ``direction``, per steradian, shape (...).
        pdf_direction: Values,
    }
}

record! {
    "tem00.beam",
    /// The probability densities of a ray; their product is the joint density.
    RayPdf {
        /// Density of the position given the direction, per m² of the aperture plane, shape (...).
        position: Values,
        /// Density of the direction, per steradian, shape (...).
        direction: Values,
    }
}

record! {
    "tem00.beam",
    /// Bounds of a light in space and direction, as a light hierarchy stores them.
    Bounds {
        /// Smallest corner of an axis-aligned box around the lit volume, in metres, shape (3,).
        min: Array,
        /// Largest corner of the box, in metres, shape (3,).
        max: Array,
        /// Unit vector along the axis, shape (3,).
        axis: Array,
        /// Half-angle, in radians, of the cone about ``axis`` that the light travels in.
        half_angle: f64,
    }
}

/// The values of a record as Python would write its constructor.
pub(super) fn shown(py: Python<'_>, name: &str, fields: &[(&str, &Py<PyAny>)]) -> PyResult<String> {
    let mut text = Vec::new();
    for (field, value) in fields {
        text.push(format!("{field}={}", value.bind(py).repr()?));
    }
    Ok(format!("{name}({})", text.join(", ")))
}
