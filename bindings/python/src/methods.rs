//! Macros that declare classes, methods, attributes and functions once.
//!
//! What Python passes becomes a value of the library by [`Take`](crate::arguments::Take), which
//! knows the name of the argument; what the library returns becomes the declared type by [`From`].
//! The library works without the interpreter's lock.

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
///   checked by this method of [`Numbers`](crate::arrays::Numbers) first. The magnitude of
///   arguments is that of the constant `LIMIT` in scope at most;
/// - `over name(x, y, v: 3) -> [2] = |[x, y, v @ ..]| expression;` is a query over numbers and over
///   vectors in the last axis, `v` of three components, broadcast together: the expression is an
///   array, of one number for `-> []`, else in the last axes of the result;
/// - `try_map name(x);` is a query over one argument that the library may refuse;
/// - `fn name(x: Type) -> Type = expression;` is a method, from values of the library to one;
/// - `try name(x: Type) -> Type = expression;` is a method whose expression is a `Result`;
/// - `make name(x: Type) = expression;` is a constructor, `Class(x)` if the name is `new`, whose
///   expression is a `Result`; without an expression, the library's function `name`;
/// - `call name(py; x: Type) -> Type = expression;` is a method whose arguments PyO3 takes, and
///   `build name(py; x: Type) = expression;` such a constructor;
/// - `keep name(x: Type) = expression;` is a constructor of a class that keeps how it was made;
/// - `unmade "from_x or from_y";` has `Class(…)` say how the class is made;
/// - `made_by name(x, y);` declares `__repr__` and `__reduce__` of what `Class.name(x, y)` makes
///   again, where `x` and `y` are attributes; `Class(x, y)` if the name is `new`;
/// - `made_as expression;` declares them where the constructor and its arguments depend on the
///   value:
///   the expression is a tuple of the name and of a `Vec` of [`Value`](crate::pickling::Value)s;
/// - `shown x, y;` declares the `__repr__` of what only other objects make, by its attributes.
macro_rules! methods {
    (impl $class:ident as $this:ident: $inner:expr; $($items:tt)*) => {
        methods! { @ [$class $this ($inner)] $($items)* }
    };
    (@ $head:tt) => {};
    (
        @ [$class:ident $this:ident $inner:tt] $(#[$($doc:tt)*])*
        get $name:ident -> $type:ty = $value:expr; $($items:tt)*
    ) => {
        #[pyo3::pymethods]
        impl $class {
            $(#[$($doc)*])*
            #[getter]
            pub(crate) fn $name(&self) -> $type {
                let $this = self;
                $value.into()
            }
        }
        methods! { @ [$class $this $inner] $($items)* }
    };
    (
        @ [$class:ident $this:ident $inner:tt] $(#[$($doc:tt)*])*
        get $name:ident -> $type:ty; $($items:tt)*
    ) => {
        methods! { @ [$class $this $inner]
            $(#[$($doc)*])* get $name -> $type = $inner.$name(); $($items)*
        }
    };
    (
        @ [$class:ident $this:ident $inner:tt] $(#[$($doc:tt)*])*
        field $name:ident -> $type:ty; $($items:tt)*
    ) => {
        methods! { @ [$class $this $inner]
            $(#[$($doc)*])* get $name -> $type = $inner.$name; $($items)*
        }
    };
    (
        @ [$class:ident $this:ident $inner:tt] $(#[$($doc:tt)*])*
        map $name:ident($($argument:ident $(: $check:ident)?),+) = $value:expr; $($items:tt)*
    ) => {
        #[pyo3::pymethods]
        impl $class {
            $(#[$($doc)*])*
            fn $name<'py>(
                &self,
                py: pyo3::Python<'py>,
                $($argument: pyo3::Bound<'py, pyo3::PyAny>),+
            ) -> pyo3::PyResult<$crate::arrays::Values<'py>> {
                take!($($argument: $crate::arrays::Numbers<'_>),+);
                $($($argument.$check(stringify!($argument))?;)?)+
                let $this = self;
                let arguments = columns!(LIMIT; $($argument),+);
                $crate::arrays::map_inner(py, arguments, &[], |[$($argument),+]| [$value])
            }
        }
        methods! { @ [$class $this $inner] $($items)* }
    };
    (
        @ [$class:ident $this:ident $inner:tt] $(#[$($doc:tt)*])*
        map $name:ident($($argument:ident $(: $check:ident)?),+); $($items:tt)*
    ) => {
        methods! { @ [$class $this $inner]
            $(#[$($doc)*])*
            map $name($($argument $(: $check)?),+) = $inner.$name($($argument),+);
            $($items)*
        }
    };
    (
        @ [$class:ident $this:ident $inner:tt] $(#[$($doc:tt)*])*
        over $name:ident($($argument:ident $(: $size:literal)?),+) -> [$($count:literal)?] =
        $value:expr; $($items:tt)*
    ) => {
        #[pyo3::pymethods]
        impl $class {
            $(#[$($doc)*])*
            fn $name<'py>(
                &self,
                py: pyo3::Python<'py>,
                $($argument: pyo3::Bound<'py, pyo3::PyAny>),+
            ) -> pyo3::PyResult<$crate::arrays::Values<'py>> {
                take!($($argument: $crate::arrays::Numbers<'_>),+);
                let $this = self;
                let arguments = columns!(LIMIT; $($argument $(: $size)?),+);
                $crate::arrays::map_inner(py, arguments, &[$($count)?], $value)
            }
        }
        methods! { @ [$class $this $inner] $($items)* }
    };
    (
        @ [$class:ident $this:ident $inner:tt] $(#[$($doc:tt)*])*
        try_map $name:ident($argument:ident); $($items:tt)*
    ) => {
        #[pyo3::pymethods]
        impl $class {
            $(#[$($doc)*])*
            fn $name<'py>(
                &self,
                py: pyo3::Python<'py>,
                $argument: pyo3::Bound<'py, pyo3::PyAny>,
            ) -> pyo3::PyResult<$crate::arrays::Values<'py>> {
                take!($argument: $crate::arrays::Numbers<'_>);
                let $this = self;
                $crate::arrays::try_map(
                    py,
                    (stringify!($argument), &$argument),
                    |x| $inner.$name(x),
                )
            }
        }
        methods! { @ [$class $this $inner] $($items)* }
    };
    (
        @ [$class:ident $this:ident $inner:tt] $(#[$($doc:tt)*])*
        fn $name:ident($($argument:ident: $taken:ty),*) -> $type:ty = $value:expr; $($items:tt)*
    ) => {
        methods! { @ [$class $this $inner]
            $(#[$($doc)*])*
            try $name($($argument: $taken),*) -> $type = pyo3::PyResult::Ok($value);
            $($items)*
        }
    };
    (
        @ [$class:ident $this:ident $inner:tt] $(#[$($doc:tt)*])*
        try $name:ident($($argument:ident: $taken:ty),*) -> $type:ty = $value:expr; $($items:tt)*
    ) => {
        #[pyo3::pymethods]
        impl $class {
            $(#[$($doc)*])*
            fn $name<'py>(
                &self,
                py: pyo3::Python<'py>,
                $($argument: pyo3::Bound<'py, pyo3::PyAny>),*
            ) -> pyo3::PyResult<$type> {
                let $this = self;
                take!($($argument: $taken),*);
                Ok($crate::error::OrRaise::or_raise(py.detach(|| $value))?.into())
            }
        }
        methods! { @ [$class $this $inner] $($items)* }
    };
    (
        @ [$class:ident $this:ident $inner:tt] $(#[$($doc:tt)*])*
        call $name:ident($py:ident; $($argument:ident: $type:ty),*) -> $result:ty = $value:expr;
        $($items:tt)*
    ) => {
        #[pyo3::pymethods]
        impl $class {
            $(#[$($doc)*])*
            fn $name<'py>(
                &self,
                $py: pyo3::Python<'py>,
                $($argument: $type),*
            ) -> pyo3::PyResult<$result> {
                let $this = self;
                $value
            }
        }
        methods! { @ [$class $this $inner] $($items)* }
    };
    (
        @ [$class:ident $this:ident $inner:tt] $(#[$($doc:tt)*])*
        build $name:ident($py:ident; $($argument:ident: $type:ty),*) = $value:expr;
        $($items:tt)*
    ) => {
        #[pyo3::pymethods]
        impl $class {
            $(#[$($doc)*])*
            fn $name<'py>(
                $py: pyo3::Python<'py>,
                $($argument: $type),*
            ) -> pyo3::PyResult<Self> {
                $value
            }
        }
        methods! { @ [$class $this $inner] $($items)* }
    };
    (
        @ [$class:ident $this:ident $inner:tt] $(#[$($doc:tt)*])*
        make $name:ident($($argument:ident: $taken:ty),*); $($items:tt)*
    ) => {
        methods! { @ [$class $this $inner]
            $(#[$($doc)*])*
            make $name($($argument: $taken),*) = physics::$class::$name($($argument),*);
            $($items)*
        }
    };
    (
        @ [$class:ident $this:ident $inner:tt] $(#[$($doc:tt)*])*
        make new($($argument:ident: $taken:ty),*) = $value:expr; $($items:tt)*
    ) => {
        methods! { @ [$class $this $inner]
            $(#[$($doc)*])* #[new] made new($($argument: $taken),*) = $value; $($items)*
        }
    };
    (
        @ [$class:ident $this:ident $inner:tt] $(#[$($doc:tt)*])*
        make $name:ident($($argument:ident: $taken:ty),*) = $value:expr; $($items:tt)*
    ) => {
        methods! { @ [$class $this $inner]
            $(#[$($doc)*])* #[staticmethod] made $name($($argument: $taken),*) = $value; $($items)*
        }
    };
    (
        @ [$class:ident $this:ident $inner:tt] $(#[$($doc:tt)*])*
        made $name:ident($($argument:ident: $taken:ty),*) = $value:expr; $($items:tt)*
    ) => {
        #[pyo3::pymethods]
        impl $class {
            $(#[$($doc)*])*
            fn $name<'py>(
                py: pyo3::Python<'py>,
                $($argument: pyo3::Bound<'py, pyo3::PyAny>),*
            ) -> pyo3::PyResult<Self> {
                take!($($argument: $taken),*);
                Ok($crate::error::OrRaise::or_raise(py.detach(|| $value))?.into())
            }
        }
        methods! { @ [$class $this $inner] $($items)* }
    };
    (
        @ [$class:ident $this:ident $inner:tt] $(#[$($doc:tt)*])*
        keep $name:ident($($argument:ident),*) = $value:expr; $($items:tt)*
    ) => {
        #[pyo3::pymethods]
        impl $class {
            $(#[$($doc)*])*
            #[staticmethod]
            fn $name($($argument: pyo3::Bound<'_, pyo3::PyAny>),*) -> pyo3::PyResult<Self> {
                take!($($argument: f64),*);
                let keywords = vec![$((stringify!($argument), $argument)),*];
                let made = $crate::pickling::Made { name: stringify!($name), keywords };
                let inner = $crate::error::OrRaise::or_raise($value)?;
                Ok(Self { inner, made })
            }
        }
        methods! { @ [$class $this $inner] $($items)* }
    };
    (
        @ [$class:ident $this:ident $inner:tt]
        unmade $by:literal; $($items:tt)*
    ) => {
        #[pyo3::pymethods]
        impl $class {
            #[new]
            #[pyo3(signature = (*_arguments, **_keywords), text_signature = None)]
            fn unmade(
                _arguments: &pyo3::Bound<'_, pyo3::types::PyTuple>,
                _keywords: Option<&pyo3::Bound<'_, pyo3::types::PyDict>>,
            ) -> pyo3::PyResult<pyo3::PyClassInitializer<Self>> {
                Err($crate::error::unmade(stringify!($class), $by))
            }
        }
        methods! { @ [$class $this $inner] $($items)* }
    };
    (
        @ [$class:ident $this:ident $inner:tt]
        made_by $name:ident($($argument:ident),*); $($items:tt)*
    ) => {
        #[pyo3::pymethods]
        impl $class {
            fn __repr__(slf: &pyo3::Bound<'_, Self>) -> pyo3::PyResult<String> {
                $crate::pickling::call(slf, stringify!($name), &[$(stringify!($argument)),*])
            }

            fn __reduce__<'py>(
                slf: &pyo3::Bound<'py, Self>,
            ) -> pyo3::PyResult<$crate::pickling::Recipe<'py>> {
                let arguments = $crate::pickling::plain(slf, &[$(stringify!($argument)),*])?;
                $crate::pickling::by_constructor::<Self>(slf.py(), stringify!($name), arguments)
            }
        }
        methods! { @ [$class $this $inner] $($items)* }
    };
    (
        @ [$class:ident $this:ident $inner:tt]
        made_as $value:expr; $($items:tt)*
    ) => {
        #[pyo3::pymethods]
        impl $class {
            fn __repr__(&self, py: pyo3::Python<'_>) -> pyo3::PyResult<String> {
                let $this = self;
                let (name, arguments) = $value;
                let shown = $crate::pickling::listed(py, arguments)?;
                Ok(format!(concat!(stringify!($class), ".{}({})"), name, shown))
            }

            fn __reduce__<'py>(
                &self,
                py: pyo3::Python<'py>,
            ) -> pyo3::PyResult<$crate::pickling::Recipe<'py>> {
                let $this = self;
                let (name, arguments) = $value;
                let arguments = pyo3::types::PyTuple::new(py, arguments)?;
                $crate::pickling::by_constructor::<Self>(py, name, arguments)
            }
        }
        methods! { @ [$class $this $inner] $($items)* }
    };
    (
        @ [$class:ident $this:ident $inner:tt]
        shown $($argument:ident),+; $($items:tt)*
    ) => {
        #[pyo3::pymethods]
        impl $class {
            fn __repr__(slf: &pyo3::Bound<'_, Self>) -> pyo3::PyResult<String> {
                let shown = $crate::pickling::shown(slf, &[$(stringify!($argument)),+])?;
                Ok(format!(concat!("<", stringify!($class), ": {}>"), shown))
            }
        }
        methods! { @ [$class $this $inner] $($items)* }
    };
}
