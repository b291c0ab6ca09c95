//! One declaration for each class, method, attribute and function.
//!
//! What Python passes becomes a value of the library by [`Take`](crate::arguments::Take), which knows
//! the name of the argument; what the library returns becomes the declared type by [`From`]. The
//! library works without the interpreter's lock.

/// Declares a class that holds an object of the library: frozen, compared by value, made from the
/// library's object by [`From`], and taken as an argument where the library's object is declared.
macro_rules! class {
    ($(#[$doc:meta])* $module:literal $class:ident($inner:ty) $(: $derive:ident)?) => {
        $(#[$doc])*
        #[pyo3::pyclass(frozen, eq, module = $module)]
        #[derive(Clone, Debug, PartialEq $(, $derive)?)]
        pub(crate) struct $class(pub(crate) $inner);

        impl From<$inner> for $class {
            fn from(inner: $inner) -> Self {
                Self(inner)
            }
        }

        impl<'py> $crate::arguments::Take<'py> for $inner {
            fn take(given: &pyo3::Bound<'py, pyo3::PyAny>, name: &'static str) -> pyo3::PyResult<Self> {
                Ok($crate::arguments::object::<$class>(given, name)?.get().0.clone())
            }
        }
    };
}

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
///   walks through the arrays;
/// - `vectors name(x, y) -> N = expression;` is a query whose results are `[f64; N]`, in the last axis;
/// - `try_map name(x);` is a query over one argument that the library may refuse;
/// - `fn name(x: Type) -> Type = expression;` is a method, from values of the library to one;
/// - `try name(x: Type) -> Type = expression;` is a method whose expression is a `Result`;
/// - `make name(x: Type) = expression;` is a constructor, `Class(x)` if the name is `new`, whose
///   expression is a `Result`; without an expression, the library's function `name`;
/// - `unmade "from_x or from_y";` has `Class(…)` say how the class is made;
/// - `made_by name(x, y);` declares `__repr__` and `__reduce__` of what `Class.name(x, y)` makes
///   again, where `x` and `y` are attributes; `Class(x, y)` if the name is `new`;
/// - `made_as expression;` declares them where the name of the constructor and its arguments depend on the
///   value: the expression is a tuple of the name and of a `Vec` of [`Value`](crate::pickling::Value)s;
/// - `shown x, y;` declares the `__repr__` of what only other objects make, by its attributes.
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
                $value.into()
            }
        ] $($items)* }
    };
    (
        @item [$class:ident $this:ident $inner:tt] [$($done:tt)*]
        $(#[$($attribute:tt)*])* get $name:ident -> $type:ty; $($items:tt)*
    ) => {
        methods! { @item [$class $this $inner] [$($done)*]
            $(#[$($attribute)*])* get $name -> $type = $inner.$name(); $($items)*
        }
    };
    (
        @item [$class:ident $this:ident $inner:tt] [$($done:tt)*]
        $(#[$($attribute:tt)*])* field $name:ident -> $type:ty; $($items:tt)*
    ) => {
        methods! { @item [$class $this $inner] [$($done)*]
            $(#[$($attribute)*])* get $name -> $type = $inner.$name; $($items)*
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
        $(#[$($attribute:tt)*])*
        vectors $name:ident($($argument:ident),+) -> $count:literal = $value:expr; $($items:tt)*
    ) => {
        methods! { @item [$class $this $inner] [
            $($done)*
            $(#[$($attribute)*])*
            fn $name<'py>(
                &self,
                py: pyo3::Python<'py>,
                $($argument: $crate::arrays::Numbers<'py>),+
            ) -> pyo3::PyResult<$crate::arrays::Values<'py>> {
                let $this = self;
                let arguments = [$((stringify!($argument), &$argument)),+];
                map_vector::<_, $count>(py, arguments, |[$($argument),+]| $value)
            }
        ] $($items)* }
    };
    (
        @item [$class:ident $this:ident $inner:tt] [$($done:tt)*]
        $(#[$($attribute:tt)*])* try_map $name:ident($argument:ident); $($items:tt)*
    ) => {
        methods! { @item [$class $this $inner] [
            $($done)*
            $(#[$($attribute)*])*
            fn $name<'py>(
                &self,
                py: pyo3::Python<'py>,
                $argument: $crate::arrays::Numbers<'py>,
            ) -> pyo3::PyResult<$crate::arrays::Values<'py>> {
                let $this = self;
                try_map(py, (stringify!($argument), &$argument), |x| $inner.$name(x))
            }
        ] $($items)* }
    };
    (
        @item [$class:ident $this:ident $inner:tt] [$($done:tt)*]
        $(#[$($attribute:tt)*])*
        fn $name:ident($($argument:ident: $taken:ty),*) -> $type:ty = $value:expr; $($items:tt)*
    ) => {
        methods! { @item [$class $this $inner] [$($done)*]
            $(#[$($attribute)*])*
            try $name($($argument: $taken),*) -> $type = pyo3::PyResult::Ok($value); $($items)*
        }
    };
    (
        @item [$class:ident $this:ident $inner:tt] [$($done:tt)*]
        $(#[$($attribute:tt)*])*
        try $name:ident($($argument:ident: $taken:ty),*) -> $type:ty = $value:expr; $($items:tt)*
    ) => {
        methods! { @item [$class $this $inner] [
            $($done)*
            $(#[$($attribute)*])*
            fn $name<'py>(
                &self,
                py: pyo3::Python<'py>,
                $($argument: pyo3::Bound<'py, pyo3::PyAny>),*
            ) -> pyo3::PyResult<$type> {
                let $this = self;
                take!($($argument: $taken),*);
                Ok($crate::error::OrRaise::or_raise(py.detach(|| $value))?.into())
            }
        ] $($items)* }
    };
    (
        @item [$class:ident $this:ident $inner:tt] [$($done:tt)*]
        $(#[$($attribute:tt)*])*
        make $name:ident($($argument:ident: $taken:ty),*); $($items:tt)*
    ) => {
        methods! { @item [$class $this $inner] [$($done)*]
            $(#[$($attribute)*])*
            make $name($($argument: $taken),*) = physics::$class::$name($($argument),*); $($items)*
        }
    };
    (
        @item [$class:ident $this:ident $inner:tt] [$($done:tt)*]
        $(#[$($attribute:tt)*])*
        make new($($argument:ident: $taken:ty),*) = $value:expr; $($items:tt)*
    ) => {
        methods! { @item [$class $this $inner] [$($done)*]
            $(#[$($attribute)*])* #[new] make (new)($($argument: $taken),*) = $value; $($items)*
        }
    };
    (
        @item [$class:ident $this:ident $inner:tt] [$($done:tt)*]
        $(#[$($attribute:tt)*])*
        make $name:ident($($argument:ident: $taken:ty),*) = $value:expr; $($items:tt)*
    ) => {
        methods! { @item [$class $this $inner] [$($done)*]
            $(#[$($attribute)*])* #[staticmethod]
            make ($name)($($argument: $taken),*) = $value; $($items)*
        }
    };
    (
        @item [$class:ident $this:ident $inner:tt] [$($done:tt)*]
        $(#[$($attribute:tt)*])*
        make ($name:ident)($($argument:ident: $taken:ty),*) = $value:expr; $($items:tt)*
    ) => {
        methods! { @item [$class $this $inner] [
            $($done)*
            $(#[$($attribute)*])*
            fn $name<'py>(
                py: pyo3::Python<'py>,
                $($argument: pyo3::Bound<'py, pyo3::PyAny>),*
            ) -> pyo3::PyResult<Self> {
                take!($($argument: $taken),*);
                Ok($crate::error::OrRaise::or_raise(py.detach(|| $value))?.into())
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
            fn __repr__(slf: &pyo3::Bound<'_, Self>) -> pyo3::PyResult<String> {
                $crate::pickling::call(slf, stringify!($name), &[$(stringify!($argument)),*])
            }

            fn __reduce__<'py>(
                slf: &pyo3::Bound<'py, Self>,
            ) -> pyo3::PyResult<$crate::pickling::Recipe<'py>> {
                let arguments = $crate::pickling::plain(slf, &[$(stringify!($argument)),*])?;
                $crate::pickling::by_constructor::<Self>(slf.py(), stringify!($name), arguments)
            }
        ] $($items)* }
    };
    (
        @item [$class:ident $this:ident $inner:tt] [$($done:tt)*]
        made_as $value:expr; $($items:tt)*
    ) => {
        methods! { @item [$class $this $inner] [
            $($done)*
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
        ] $($items)* }
    };
    (
        @item [$class:ident $this:ident $inner:tt] [$($done:tt)*]
        shown $($argument:ident),+; $($items:tt)*
    ) => {
        methods! { @item [$class $this $inner] [
            $($done)*
            fn __repr__(slf: &pyo3::Bound<'_, Self>) -> pyo3::PyResult<String> {
                let shown = $crate::pickling::shown(slf, &[$(stringify!($argument)),+])?;
                Ok(format!(concat!("<", stringify!($class), ": {}>"), shown))
            }
        ] $($items)* }
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
            $($argument: $crate::arrays::Numbers<'py>),+
        ) -> pyo3::PyResult<$crate::arrays::Values<'py>> {
            $($($argument.$check(stringify!($argument))?;)?)+
            $crate::arrays::map(py, [$((stringify!($argument), &$argument)),+], |[$($argument),+]| $value)
        }
        functions! { $($items)* }
    };
    ($(#[$($attribute:tt)*])* try_map $name:ident($argument:ident); $($items:tt)*) => {
        $(#[$($attribute)*])*
        #[pyo3::pyfunction]
        pub(super) fn $name<'py>(
            py: pyo3::Python<'py>,
            $argument: $crate::arrays::Numbers<'py>,
        ) -> pyo3::PyResult<$crate::arrays::Values<'py>> {
            let argument = (stringify!($argument), &$argument);
            $crate::arrays::try_map(py, argument, physics::$name, $crate::error::IntoPython::into_python)
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
