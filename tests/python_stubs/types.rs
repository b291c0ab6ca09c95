//! The types of Python that stand for those of Rust in the signatures of the bindings.

use quote::ToTokens;
use syn::{GenericArgument, PathArguments, Type, TypeArray};

/// What a type of Rust is in Python, as an argument or as a result.
#[derive(Clone, Debug, PartialEq)]
pub(crate) enum Python {
    /// A type.
    One(String),
    /// Numbers or arrays, broadcast together: a type for numbers, and one with arrays.
    Either(&'static str, &'static str),
    /// Not seen from Python: the interpreter.
    Hidden,
}

impl Python {
    /// The type where numbers and arrays are not told apart.
    pub(crate) fn text(self) -> String {
        match self {
            Self::One(text) => text,
            Self::Either(_, "FloatArray") => "Values".to_owned(),
            Self::Either(_, arrays) => arrays.to_owned(),
            Self::Hidden => String::new(),
        }
    }
}

/// Types with a name of their own, as arguments. What no table names is a class of this name.
const ARGUMENTS: &[(&str, &str)] = &[
    ("f64", "float"),
    ("Whole", "SupportsIndex"),
    ("Image", "RealArray"),
    ("ComplexImage", "ComplexArray | RealArray"),
    ("Components", "Vector"),
    ("Table", "Table"),
    ("Samples", "RealArray"),
    ("PathBuf", "File"),
    ("Precision", "Dtype"),
    ("FocusCurve", "FocusCurve"),
    ("Rows", "Table"),
];

/// Types with a name of their own, as results.
const RESULTS: &[(&str, &str)] = &[
    ("f64", "float"),
    ("bool", "bool"),
    ("u8", "int"),
    ("i8", "int"),
    ("i32", "int"),
    ("i64", "int"),
    ("u32", "int"),
    ("u64", "int"),
    ("usize", "int"),
    ("str", "str"),
    ("Vector", "FloatArray"),
    ("Matrix", "FloatArray"),
    ("Array", "FloatArray"),
    ("Array2", "FloatArray"),
    ("Array3", "FloatArray"),
    ("Field", "Values"),
    ("PyComplex", "complex"),
    ("Complex64", "complex"),
];

/// The type of an argument in the methods of `class`.
pub(crate) fn argument(ty: &Type, class: &str) -> Python {
    match ty {
        Type::Reference(reference) => argument(&reference.elem, class),
        Type::Array(array) => sequence(array, class),
        Type::Path(path) => {
            let Some(last) = path.path.segments.last() else {
                return Python::Hidden;
            };
            let inner = || inner(&last.arguments).map(|ty| argument(ty, class));
            match last.ident.to_string().as_str() {
                "Python" => Python::Hidden,
                "Numbers" | "Floats" => Python::Either("float", "Numbers"),
                "Spectrum" => Python::One("float | SpectralLine".to_owned()),
                "Self" => Python::One(class.to_owned()),
                "Option" => Python::One(format!("{} | None", text_of(inner()))),
                "Vec" => Python::One(format!("Sequence[{}]", text_of(inner()))),
                "PyRef" | "Bound" => inner().unwrap_or(Python::Hidden),
                name => Python::One(named(name, ARGUMENTS)),
            }
        }
        _ => Python::One(ty.to_token_stream().to_string()),
    }
}

/// The type of an argument that is an array in Rust.
fn sequence(array: &TypeArray, class: &str) -> Python {
    let depth = core::iter::successors(Some(&*array.elem), |ty| match ty {
        Type::Array(array) => Some(&*array.elem),
        _ => None,
    });
    let inner = depth.clone().last().map(|ty| argument(ty, class));
    let text = match (inner, depth.count()) {
        (Some(Python::Either(..)), _) => return Python::Either("tuple[float, float]", "Pair"),
        (Some(Python::One(text)), 1) if text == "float" => "Vector".to_owned(),
        (Some(Python::One(text)), 2) if text == "float" => "Table".to_owned(),
        (Some(Python::One(text)), 1) if text == "SupportsIndex" => "Counts".to_owned(),
        (Some(Python::One(text)), _) => format!("tuple[{text}, {text}] | Sequence[{text}]"),
        (inner, _) => text_of(inner),
    };
    Python::One(text)
}

/// The type of a result of the methods of `class`.
pub(crate) fn result(ty: &Type, class: &str) -> Python {
    match ty {
        Type::Reference(reference) => result(&reference.elem, class),
        Type::Tuple(tuple) if tuple.elems.is_empty() => Python::One("None".to_owned()),
        Type::Tuple(tuple) => {
            let parts: Vec<_> = tuple
                .elems
                .iter()
                .map(|ty| result(ty, class).text())
                .collect();
            Python::One(format!("tuple[{}]", parts.join(", ")))
        }
        Type::Array(_) => Python::Either("list[float]", "list[FloatArray]"),
        Type::Path(path) => {
            let Some(last) = path.path.segments.last() else {
                return Python::Hidden;
            };
            let inner = || inner(&last.arguments).map(|ty| result(ty, class));
            match last.ident.to_string().as_str() {
                "PyResult" | "Bound" | "Py" => inner().unwrap_or(Python::Hidden),
                "Values" => Python::Either("float", "FloatArray"),
                "Self" => Python::One(class.to_owned()),
                "Option" => Python::One(format!("{} | None", text_of(inner()))),
                "Vec" => Python::One(format!("list[{}]", text_of(inner()))),
                "PyArray1" | "PyArray2" | "PyArray4" | "PyArrayDyn" => {
                    Python::One(array_of(&last.arguments))
                }
                name => Python::One(named(name, RESULTS)),
            }
        }
        _ => Python::One(ty.to_token_stream().to_string()),
    }
}

/// The array of NumPy that holds these elements.
fn array_of(arguments: &PathArguments) -> String {
    let element = inner(arguments).map(|ty| ty.to_token_stream().to_string());
    match element.as_deref() {
        Some("f32") => "NDArray[np.float32]",
        Some("Complex32") => "NDArray[np.complex64]",
        Some("Complex64") => "NDArray[np.complex128]",
        _ => "FloatArray",
    }
    .to_owned()
}

fn text_of(ty: Option<Python>) -> String {
    ty.map_or(String::new(), Python::text)
}

fn named(name: &str, table: &[(&str, &str)]) -> String {
    let found = table.iter().find(|(rust, _)| *rust == name);
    found.map_or(name, |(_, python)| python).to_owned()
}

fn inner(arguments: &PathArguments) -> Option<&Type> {
    let PathArguments::AngleBracketed(arguments) = arguments else {
        return None;
    };
    arguments.args.iter().find_map(|argument| match argument {
        GenericArgument::Type(ty) => Some(ty),
        _ => None,
    })
}
