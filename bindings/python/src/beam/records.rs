//! Results of queries: named numbers, or named arrays of one shape.

use pyo3::prelude::*;

use crate::arrays::Values;

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

pub(crate) use record;

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
    /// The light that a ray meets on its way to the aperture.
    ///
    /// For arrays of rays all members are arrays, and 0 where a ray meets none.
    ApertureHit {
        /// Point of the aperture plane, shape (..., 3).
        point: Array,
        /// Distance to ``point``, in metres, shape (...).
        distance: Values,
        /// Radiance that arrives along the ray, in W/(m² sr), shape (...).
        radiance: Values,
        /// Probability density with which a sampled next event has this direction, per steradian,
        /// shape (...).
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
        /// Probability densities of the ray.
        pdf: RayPdf,
    }
}

record! {
    "tem00.beam",
    /// The probability densities of a ray, whose joint density factors in two ways.
    ///
    /// ``position · direction_given_position = direction · position_given_direction``. Bidirectional
    /// methods want the left side, the right side is what a ray is drawn from. Positions are those on
    /// the aperture plane.
    RayPdf {
        /// Density of the position, whatever the direction, per m² of the aperture plane, shape (...).
        position: Values,
        /// Density of the direction at this position, per steradian, shape (...).
        direction_given_position: Values,
        /// Density of the direction, wherever the ray starts, per steradian, shape (...).
        direction: Values,
        /// Density of the position among the rays of this direction, per m² of the aperture plane,
        /// shape (...).
        position_given_direction: Values,
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

impl RayPdf {
    /// Names densities, in the order of the fields.
    pub(super) fn of(columns: [Values<'_>; 4]) -> Self {
        let [
            position,
            direction_given_position,
            direction,
            position_given_direction,
        ] = columns.map(Bound::unbind);
        Self {
            position,
            direction_given_position,
            direction,
            position_given_direction,
        }
    }
}

/// The values of a record as Python would write its constructor.
pub(crate) fn shown(py: Python<'_>, name: &str, fields: &[(&str, &Py<PyAny>)]) -> PyResult<String> {
    let mut text = Vec::new();
    for (field, value) in fields {
        text.push(format!("{field}={}", value.bind(py).repr()?));
    }
    Ok(format!("{name}({})", text.join(", ")))
}
