//! The stub of each module.

use std::{collections::BTreeSet, fs, path::Path};

use syn::{Item, UseTree};

use crate::{
    classes::{Class, Declared, Member},
    exceptions,
    types::{Python, result},
};

/// The modules of Python, the source that lists what they hold, and their stubs.
const MODULES: &[(&str, &str, &str)] = &[
    ("beam", "beam.rs", "beam/__init__.pyi"),
    ("closed_form", "beam/closed_form.rs", "beam/closed_form.pyi"),
    ("coherence", "coherence.rs", "coherence.pyi"),
    ("decorrelation", "decorrelation.rs", "decorrelation.pyi"),
    ("shading", "shading.rs", "shading.pyi"),
    ("speckle", "speckle.rs", "speckle.pyi"),
    ("statistics", "statistics.rs", "statistics.pyi"),
];

/// Classes written in Python: where they are shown, and the module that has them.
const PYTHON: &[(&str, &str, &str)] = &[("beam", "_estimate", "Estimate")];

/// Where the words of stubs come from.
const WORDS: &[(&str, &[&str])] = &[
    ("collections.abc", &["Callable", "Iterable", "Sequence"]),
    (
        "typing",
        &[
            "ClassVar",
            "Final",
            "Literal",
            "SupportsIndex",
            "final",
            "overload",
        ],
    ),
    ("numpy.typing", &["NDArray"]),
    ("typing_extensions", &["disjoint_base"]),
    ("tem00.beam", &["Emitter", "LineProfile", "NextEvent"]),
    ("tem00.coherence", &["SpectralLine"]),
    ("tem00.decorrelation", &["RigidMotion"]),
    (
        "tem00._typing",
        &[
            "Boundary",
            "ComplexArray",
            "Counts",
            "Cumulative",
            "Dtype",
            "Errors",
            "File",
            "FloatArray",
            "FocusCurve",
            "Interpolation",
            "Numbers",
            "Pair",
            "Phasors",
            "Purpose",
            "RealArray",
            "Table",
            "Values",
            "Vector",
            "Vectors",
        ],
    ),
];

/// The stubs that the sources of the bindings declare, by their path in the package.
pub(crate) fn stubs(root: &Path) -> Vec<(String, String)> {
    MODULES
        .iter()
        .map(|(name, source, path)| {
            let text = fs::read_to_string(root.join(source)).expect("a readable source");
            let declared = Declared::read(&root.join(name));
            ((*path).to_owned(), stub(&text, name, &declared))
        })
        .collect()
}

fn stub(source: &str, module: &str, declared: &Declared) -> String {
    let file = syn::parse_file(source).expect("a module of Rust");
    let mut names = Vec::new();
    let mut body = String::new();
    for item in &file.items {
        let Item::Mod(item) = item else { continue };
        if item.ident != module {
            continue;
        }
        for item in item.content.iter().flat_map(|(_, items)| items) {
            match item {
                Item::Const(item) => {
                    let Python::One(ty) = result(&item.ty, "") else {
                        continue;
                    };
                    names.push(item.ident.to_string());
                    body += &format!("{}: Final[{ty}]\n", item.ident);
                }
                Item::Use(item) => leaves(&item.tree, &mut names),
                _ => {}
            }
        }
    }
    let in_python = PYTHON.iter().filter(|(shown, ..)| *shown == module);
    names.extend(in_python.clone().map(|(_, _, name)| (*name).to_owned()));
    names.sort();
    for name in &names {
        if let Some(function) = declared.functions.get(name) {
            body += &function.write("", "");
        }
    }
    for name in &names {
        if let Some(base) = declared.exceptions.get(name) {
            body += &format!("\nclass {name}({base}): ...\n");
        } else if let Some(class) = declared.classes.get(name) {
            body += &write_class(name, class);
        }
    }
    let mut inner: String = in_python
        .map(|(_, own, name)| format!("from tem00.{own} import {name} as {name}\n"))
        .collect();
    for name in &names {
        if !declared.functions.contains_key(name)
            && !declared.exceptions.contains_key(name)
            && !declared.classes.contains_key(name)
            && name.chars().all(|c| c.is_lowercase() || c == '_')
        {
            inner += &format!("from tem00.{module} import {name} as {name}\n");
        }
    }
    let imports = imports(&body, &names) + &inner;
    let all: String = names
        .iter()
        .map(|name| format!("    \"{name}\",\n"))
        .collect();
    format!("{imports}\n__all__ = [\n{all}]\n\n{body}")
}

/// The imports of the words that a stub uses, but for its own.
fn imports(body: &str, own: &[String]) -> String {
    let used: BTreeSet<_> = body
        .split(|c: char| !c.is_alphanumeric() && c != '_')
        .collect();
    let mut text = String::new();
    for (module, words) in WORDS {
        let words: Vec<_> = words
            .iter()
            .copied()
            .filter(|word| used.contains(word) && own.iter().all(|own| own != word))
            .collect();
        if *module == "numpy.typing" && used.contains("np") {
            text += "import numpy as np\n";
        }
        if !words.is_empty() {
            text += &format!("from {module} import {}\n", words.join(", "));
        }
    }
    text
}

fn leaves(tree: &UseTree, names: &mut Vec<String>) {
    match tree {
        UseTree::Path(path) => leaves(&path.tree, names),
        UseTree::Group(group) => group.items.iter().for_each(|tree| leaves(tree, names)),
        UseTree::Name(name) => names.push(name.ident.to_string()),
        _ => {}
    }
}

fn write_class(name: &str, class: &Class) -> String {
    let decorator = if class.open {
        "@disjoint_base"
    } else {
        "@final"
    };
    let base = class
        .base
        .as_ref()
        .map_or(String::new(), |base| format!("({base})"));
    let mut text = format!("\n{decorator}\nclass {name}{base}:\n");
    for member in &class.members {
        text += &match member {
            Member::Constant(name, ty) => {
                format!("    {name}: ClassVar[{}]\n", ty.clone().text())
            }
            Member::Property(member, ty) => {
                let ty = exceptions::attribute(name, member, ty.clone()).text();
                format!("    @property\n    def {member}(self) -> {ty}: ...\n")
            }
            Member::Method(function, decorator) => exceptions::method(name, &function.name)
                .map_or_else(|| function.write("    ", decorator), str::to_owned),
        };
    }
    if class.equal {
        text += "    def __eq__(self, value: object, /) -> bool: ...\n";
        text += "    def __ne__(self, value: object, /) -> bool: ...\n";
        text += if class.hash {
            "    def __hash__(self) -> int: ...\n"
        } else {
            "    __hash__: ClassVar[None]  # type: ignore[assignment]\n"
        };
    }
    text
}
