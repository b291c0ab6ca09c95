//! Declarations of classes.

/// Declares what objects that never change have in common: a copy is the object itself, and equal
/// objects have equal hashes, of the text `$text`.
macro_rules! immutable {
    ($class:ident) => {
        immutable!($class, this => pyo3::types::PyAnyMethods::repr(this.as_any())?.to_string());
    };
    ($class:ident, $this:ident => $text:expr) => {
        #[pyo3::pymethods]
        impl $class {
            fn __copy__(slf: pyo3::Bound<'_, Self>) -> pyo3::Bound<'_, Self> {
                slf
            }

            fn __deepcopy__<'py>(
                slf: pyo3::Bound<'py, Self>,
                _memo: &pyo3::Bound<'py, pyo3::PyAny>,
            ) -> pyo3::Bound<'py, Self> {
                slf
            }

            fn __hash__($this: &pyo3::Bound<'_, Self>) -> pyo3::PyResult<u64> {
                let text: String = $text;
                Ok($crate::pickling::hash(&text))
            }
        }
    };
}

/// Declares a class that holds an object of the library: frozen, compared by value, made from the
/// library's object by [`From`], and taken as an argument where the library's object is declared.
macro_rules! class {
    ($(#[$doc:meta])* $module:literal $class:ident($inner:ty) $(: $derive:ident)?) => {
        $(#[$doc])*
        #[pyo3::pyclass(frozen, eq, module = $module)]
        #[derive(Clone, Debug, PartialEq $(, $derive)?)]
        pub(crate) struct $class(pub(crate) $inner);

        immutable!($class);

        impl From<$inner> for $class {
            fn from(inner: $inner) -> Self {
                Self(inner)
            }
        }

        impl<'py> $crate::arguments::Take<'py> for $inner {
            fn take(
                given: &pyo3::Bound<'py, pyo3::PyAny>,
                name: &'static str,
            ) -> pyo3::PyResult<Self> {
                Ok($crate::arguments::object::<$class>(given, name)?.get().0.clone())
            }
        }
    };
}

/// Declares a class that keeps how it was made beside the object of the library, for its `__repr__`
/// and for pickle; otherwise as [`class`].
macro_rules! kept_class {
    ($(#[$doc:meta])* $module:literal $class:ident($inner:ty)) => {
        $(#[$doc])*
        #[pyo3::pyclass(frozen, eq, module = $module)]
        #[derive(Clone, Debug)]
        pub(crate) struct $class {
            inner: $inner,
            made: $crate::pickling::Made,
        }

        // What makes two equal objects may differ.
        immutable!($class, this => format!("{:?}", this.get().inner));

        impl PartialEq for $class {
            fn eq(&self, other: &Self) -> bool {
                self.inner == other.inner
            }
        }

        impl<'py> $crate::arguments::Take<'py> for $inner {
            fn take(
                given: &pyo3::Bound<'py, pyo3::PyAny>,
                name: &'static str,
            ) -> pyo3::PyResult<Self> {
                Ok($crate::arguments::object::<$class>(given, name)?.get().inner.clone())
            }
        }

        #[pyo3::pymethods]
        impl $class {
            fn __repr__(&self) -> String {
                self.made.call(stringify!($class))
            }

            fn __reduce__<'py>(
                &self,
                py: pyo3::Python<'py>,
            ) -> pyo3::PyResult<$crate::pickling::Recipe<'py>> {
                self.made.recipe::<Self>(py)
            }
        }
    };
}
