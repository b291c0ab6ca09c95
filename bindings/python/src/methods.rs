//! Attributes and queries of a class, by their names in the library.

/// Declares methods of a class that hand on to the object of the library that it holds.
///
/// `impl Class as this: this.0;` names the class, the Python object and in it the library's. Then
/// follow, each under its documentation:
///
/// - `get name -> Type;` is an attribute, the library's method `name`;
/// - `field name -> Type;` is an attribute, the library's field `name`;
/// - `get name -> Type = expression;` is an attribute of any other origin;
/// - `map name(x, y);` is a query over numbers or arrays, broadcast together, the library's method
///   `name`; `map name(x, y) = expression;` has another origin. `x: not_negative` has the argument
///   checked by this method of [`Numbers`](crate::arrays::Numbers) first. The module's own `map`
///   walks through the arrays.
/// - `make name(x, y);` is a constructor from numbers, the library's function `name`, and `Class(x, y)`
///   if the name is `new`; `x: wavelength_of_light` has the argument checked by this function first;
/// - `unmade "from_x or from_y";` has `Class(…)` say how the class is made;
/// - `made_by name(x, y);` declares `__repr__` and `__reduce__` of what `Class.name(x, y)` makes
///   again, where `x` and `y` are methods of the library's object; `Class(x, y)` if the name is `new`.
///
/// Types are what [`From`] makes of the library's.
macro_rules! methods {
    (impl $class:ident as $this:ident: $inner:expr; $($items:tt)*) => {
        methods! { @item [$class $this ($inner)] [] $($items)* }
    };
    (@item [$class:ident $this:ident $inner:tt] [$($done:tt)*]) => {
        #[pyo3::pymethods]
        impl $class {
            $($done)*
        }
    };
    (
        @item [$class:ident $this:ident $inner:tt] [$($done:tt)*]
        $(#[$($attribute:tt)*])* get $name:ident -> $type:ty = $value:expr; $($items:tt)*
    ) => {
        methods! { @item [$class $this $inner] [
            $($done)*
            $(#[$($attribute)*])*
            #[getter]
            pub(crate) fn $name(&self) -> $type {
                let $this = self;
                $value
            }
        ] $($items)* }
    };
    (
        @item [$class:ident $this:ident $inner:tt] [$($done:tt)*]
        $(#[$($attribute:tt)*])* get $name:ident -> $type:ty; $($items:tt)*
    ) => {
        methods! { @item [$class $this $inner] [$($done)*]
            $(#[$($attribute)*])* get $name -> $type = $inner.$name().into(); $($items)*
        }
    };
    (
        @item [$class:ident $this:ident $inner:tt] [$($done:tt)*]
        $(#[$($attribute:tt)*])* field $name:ident -> $type:ty; $($items:tt)*
    ) => {
        methods! { @item [$class $this $inner] [$($done)*]
            $(#[$($attribute)*])* get $name -> $type = $inner.$name.into(); $($items)*
        }
    };
    (
        @item [$class:ident $this:ident $inner:tt] [$($done:tt)*]
        $(#[$($attribute:tt)*])*
        map $name:ident($($argument:ident $(: $check:ident)?),+) = $value:expr; $($items:tt)*
    ) => {
        methods! { @item [$class $this $inner] [
            $($done)*
            $(#[$($attribute)*])*
            fn $name<'py>(
                &self,
                py: pyo3::Python<'py>,
                $($argument: $crate::arrays::Numbers<'py>),+
            ) -> pyo3::PyResult<$crate::arrays::Values<'py>> {
                $($($argument.$check(stringify!($argument))?;)?)+
                let $this = self;
                map(py, [$((stringify!($argument), &$argument)),+], |[$($argument),+]| $value)
            }
        ] $($items)* }
    };
    (
        @item [$class:ident $this:ident $inner:tt] [$($done:tt)*]
        $(#[$($attribute:tt)*])*
        map $name:ident($($argument:ident $(: $check:ident)?),+); $($items:tt)*
    ) => {
        methods! { @item [$class $this $inner] [$($done)*]
            $(#[$($attribute)*])*
            map $name($($argument $(: $check)?),+) = $inner.$name($($argument),+); $($items)*
        }
    };
    (
        @item [$class:ident $this:ident $inner:tt] [$($done:tt)*]
        $(#[$($attribute:tt)*])* make new($($argument:ident $(: $check:ident)?),+); $($items:tt)*
    ) => {
        methods! { @item [$class $this $inner] [$($done)*]
            $(#[$($attribute)*])* #[new] make (new)($($argument $(: $check)?),+); $($items)*
        }
    };
    (
        @item [$class:ident $this:ident $inner:tt] [$($done:tt)*]
        $(#[$($attribute:tt)*])*
        make $name:ident($($argument:ident $(: $check:ident)?),+); $($items:tt)*
    ) => {
        methods! { @item [$class $this $inner] [$($done)*]
            $(#[$($attribute)*])* #[staticmethod]
            make ($name)($($argument $(: $check)?),+); $($items)*
        }
    };
    (
        @item [$class:ident $this:ident $inner:tt] [$($done:tt)*]
        $(#[$($attribute:tt)*])* make ($name:ident)($($argument:ident $(: $check:ident)?),+);
        $($items:tt)*
    ) => {
        methods! { @item [$class $this $inner] [
            $($done)*
            $(#[$($attribute)*])*
            fn $name($($argument: f64),+) -> pyo3::PyResult<Self> {
                $($($crate::arrays::$check(stringify!($argument), $argument)?;)?)+
                Ok(Self($crate::error::OrRaise::or_raise(physics::$class::$name($($argument),+))?))
            }
        ] $($items)* }
    };
    (
        @item [$class:ident $this:ident $inner:tt] [$($done:tt)*]
        unmade $by:literal; $($items:tt)*
    ) => {
        methods! { @item [$class $this $inner] [
            $($done)*
            #[new]
            #[pyo3(signature = (*_arguments, **_keywords), text_signature = None)]
            fn unmade(
                _arguments: &pyo3::Bound<'_, pyo3::types::PyTuple>,
                _keywords: Option<&pyo3::Bound<'_, pyo3::types::PyDict>>,
            ) -> pyo3::PyResult<pyo3::PyClassInitializer<Self>> {
                Err($crate::error::unmade(stringify!($class), $by))
            }
        ] $($items)* }
    };
    (
        @item [$class:ident $this:ident $inner:tt] [$($done:tt)*]
        made_by $name:ident($($argument:ident),*); $($items:tt)*
    ) => {
        methods! { @item [$class $this $inner] [
            $($done)*
            pub(crate) fn __repr__(&self) -> String {
                let $this = self;
                let arguments: &[String] =
                    &[$(format!(concat!(stringify!($argument), "={:?}"), $inner.$argument())),*];
                $crate::pickling::call(stringify!($class), stringify!($name), arguments)
            }

            fn __reduce__<'py>(
                &self,
                py: pyo3::Python<'py>,
            ) -> pyo3::PyResult<$crate::pickling::Recipe<'py>> {
                let $this = self;
                let arguments = ($($inner.$argument(),)*);
                $crate::pickling::by_constructor::<Self>(py, stringify!($name), arguments)
            }
        ] $($items)* }
    };
}

/// Declares functions over numbers or arrays, broadcast together, as [`methods`] does queries: each is
/// the function of this name in the module `physics`.
macro_rules! functions {
    ($(
        $(#[$($attribute:tt)*])*
        map $name:ident($($argument:ident $(: $check:ident)?),+);
    )+) => {$(
        $(#[$($attribute)*])*
        #[pyo3::pyfunction]
        pub(super) fn $name<'py>(
            py: pyo3::Python<'py>,
            $($argument: $crate::arrays::Numbers<'py>),+
        ) -> pyo3::PyResult<$crate::arrays::Values<'py>> {
            $($($argument.$check(stringify!($argument))?;)?)+
            map(py, [$((stringify!($argument), &$argument)),+], |[$($argument),+]| {
                physics::$name($($argument),+)
            })
        }
    )+};
}
