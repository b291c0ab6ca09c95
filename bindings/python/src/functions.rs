//! Declarations of functions, and arguments of functions and methods.

/// Columns of arguments of numbers, and of the components of `vectors: 3`, up to a magnitude.
macro_rules! columns {
    ($limit:expr; $($name:ident $(: $size:literal)?),+) => {
        $crate::arrays::columns::<{ 0 $(+ $crate::arrays::width(0 $(+ $size)?))+ }>(
            &[$((stringify!($name), &$name, 0 $(+ $size)?)),+],
            $limit,
        )?
    };
}

/// Makes values of the library of arguments, under their names.
macro_rules! take {
    ($($argument:ident: $taken:ty),*) => {
        $(let $argument =
            <$taken as $crate::arguments::Take<'_>>::take(&$argument, stringify!($argument))?;)*
    };
}

/// Declares functions of a module, as [`methods`] does methods: `map`, `try_map` and `try`.
macro_rules! functions {
    () => {};
    (
        $(#[$($attribute:tt)*])*
        map $name:ident($($argument:ident $(: $check:ident)?),+); $($items:tt)*
    ) => {
        functions! {
            $(#[$($attribute)*])*
            map $name($($argument $(: $check)?),+) = physics::$name($($argument),+); $($items)*
        }
    };
    (
        $(#[$($attribute:tt)*])*
        map $name:ident($($argument:ident $(: $check:ident)?),+) = $value:expr; $($items:tt)*
    ) => {
        $(#[$($attribute)*])*
        #[pyo3::pyfunction]
        pub(super) fn $name<'py>(
            py: pyo3::Python<'py>,
            $($argument: pyo3::Bound<'py, pyo3::PyAny>),+
        ) -> pyo3::PyResult<$crate::arrays::Values<'py>> {
            take!($($argument: $crate::arrays::Numbers<'_>),+);
            $($($argument.$check(stringify!($argument))?;)?)+
            let arguments = columns!($crate::arrays::LIMIT; $($argument),+);
            $crate::arrays::map_inner(py, arguments, &[], |[$($argument),+]| [$value])
        }
        functions! { $($items)* }
    };
    ($(#[$($attribute:tt)*])* try_map $name:ident($argument:ident); $($items:tt)*) => {
        $(#[$($attribute)*])*
        #[pyo3::pyfunction]
        pub(super) fn $name<'py>(
            py: pyo3::Python<'py>,
            $argument: pyo3::Bound<'py, pyo3::PyAny>,
        ) -> pyo3::PyResult<$crate::arrays::Values<'py>> {
            take!($argument: $crate::arrays::Numbers<'_>);
            $crate::arrays::try_map(py, (stringify!($argument), &$argument), physics::$name)
        }
        functions! { $($items)* }
    };
    (
        $(#[$($attribute:tt)*])*
        try $name:ident($($argument:ident: $taken:ty),*) -> $type:ty = $value:expr; $($items:tt)*
    ) => {
        $(#[$($attribute)*])*
        #[pyo3::pyfunction]
        pub(super) fn $name<'py>(
            py: pyo3::Python<'py>,
            $($argument: pyo3::Bound<'py, pyo3::PyAny>),*
        ) -> pyo3::PyResult<$type> {
            take!($($argument: $taken),*);
            Ok($crate::error::OrRaise::or_raise(py.detach(|| $value))?.into())
        }
        functions! { $($items)* }
    };
}
