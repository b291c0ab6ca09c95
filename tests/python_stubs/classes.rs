//! The classes and functions that the sources of the bindings declare.

use std::{collections::BTreeMap, fs, path::Path};

use quote::ToTokens;
use syn::{Attribute, ImplItem, Item, ItemImpl, ItemMacro, ItemStruct, Type};

use crate::{
    declared::{Functions, Methods, Record},
    functions::{Function, Parameter},
    types::{Python, result},
};

/// A member of a class.
#[derive(Clone, Debug)]
pub(crate) enum Member {
    Constant(String, Python),
    Property(String, Python),
    /// A method, and its decorator.
    Method(Function, &'static str),
}

#[derive(Clone, Debug, Default)]
pub(crate) struct Class {
    pub(crate) base: Option<String>,
    pub(crate) equal: bool,
    pub(crate) hash: bool,
    pub(crate) open: bool,
    pub(crate) members: Vec<Member>,
}

/// All that the sources of one module declare, by name.
#[derive(Debug, Default)]
pub(crate) struct Declared {
    pub(crate) classes: BTreeMap<String, Class>,
    pub(crate) functions: BTreeMap<String, Function>,
    pub(crate) exceptions: BTreeMap<String, String>,
}

impl Declared {
    /// Reads the folder of the sources of a module.
    pub(crate) fn read(folder: &Path) -> Self {
        let mut declared = Self::default();
        if folder.is_dir() {
            declared.read_folder(folder);
        }
        declared
    }

    fn read_folder(&mut self, folder: &Path) {
        let mut paths: Vec<_> = fs::read_dir(folder)
            .expect("a folder of sources")
            .map(|entry| entry.expect("a readable folder").path())
            .collect();
        paths.sort();
        for path in paths {
            if path.is_dir() {
                self.read_folder(&path);
            } else {
                let text = fs::read_to_string(&path).expect("a readable source");
                let file = syn::parse_file(&text)
                    .unwrap_or_else(|error| panic!("{}: {error}", path.display()));
                for item in &file.items {
                    self.read_item(item);
                }
            }
        }
    }

    fn read_item(&mut self, item: &Item) {
        match item {
            Item::Struct(item) => self.read_struct(item),
            Item::Impl(item) if has(&item.attrs, "pymethods") => self.read_impl(item),
            Item::Fn(item) if has(&item.attrs, "pyfunction") => {
                let function = Function::read(&item.attrs, &item.sig, "");
                self.functions.insert(function.name.clone(), function);
            }
            Item::Macro(item) => self.read_macro(item),
            _ => {}
        }
    }

    fn read_struct(&mut self, item: &ItemStruct) {
        let Some(attribute) = item.attrs.iter().find(|a| a.path().is_ident("pyclass")) else {
            return;
        };
        let words = attribute.meta.to_token_stream().to_string();
        let class = self.classes.entry(item.ident.to_string()).or_default();
        class.equal = words.contains("eq ,");
        class.hash = words.contains("hash ,");
        class.open = words.contains("subclass ,");
        class.base = words
            .split_once("extends = ")
            .and_then(|(_, base)| base.split([' ', ',']).next().map(str::to_owned));
        if words.contains("get_all") {
            for field in &item.fields {
                if let Some(name) = &field.ident {
                    let ty = result(&field.ty, "");
                    class.members.push(Member::Property(name.to_string(), ty));
                }
            }
        }
    }

    fn read_impl(&mut self, item: &ItemImpl) {
        let Type::Path(path) = &*item.self_ty else {
            return;
        };
        let name = path.path.segments[0].ident.to_string();
        let class = self.classes.entry(name.clone()).or_default();
        for item in &item.items {
            match item {
                ImplItem::Const(item) => {
                    let ty = result(&item.ty, &name);
                    class
                        .members
                        .push(Member::Constant(item.ident.to_string(), ty));
                }
                ImplItem::Fn(item) => class.members.extend(method(&item.attrs, &item.sig, &name)),
                _ => {}
            }
        }
    }

    fn read_macro(&mut self, item: &ItemMacro) {
        let name = item
            .mac
            .path
            .segments
            .last()
            .map(|last| last.ident.to_string());
        match name.as_deref() {
            Some("methods") => {
                let Methods(name, members) = item.mac.parse_body().expect("a methods!");
                self.classes
                    .entry(name)
                    .or_default()
                    .members
                    .extend(members);
            }
            Some("functions") => {
                let Functions(functions) = item.mac.parse_body().expect("a functions!");
                for function in functions {
                    self.functions.insert(function.name.clone(), function);
                }
            }
            Some("record") => {
                let Record(name, fields) = item.mac.parse_body().expect("a record!");
                self.classes.insert(name.clone(), record(&name, &fields));
            }
            Some("create_exception") => {
                let text = item.mac.tokens.to_string();
                let mut parts = text.split(',').map(str::trim).skip(1);
                if let (Some(name), Some(base)) = (parts.next(), parts.next()) {
                    let base = base.trim_start_matches("Py").to_owned();
                    self.exceptions.insert(name.to_owned(), base);
                }
            }
            _ => {}
        }
    }
}

/// The member that a method of Rust becomes, unless Python inherits its stub or does not see it.
fn method(attributes: &[Attribute], signature: &syn::Signature, class: &str) -> Option<Member> {
    let mut function = Function::read(attributes, signature, class);
    if has(attributes, "getter") {
        return Some(Member::Property(function.name, function.returns));
    }
    if has(attributes, "new") {
        "__new__".clone_into(&mut function.name);
        function.receiver = "cls";
        return Some(Member::Method(function, ""));
    }
    match function.name.as_str() {
        "__repr__" | "__str__" | "__reduce__" => return None,
        "__getnewargs__" => function.returns = Python::One("tuple[object, ...]".to_owned()),
        "__getnewargs_ex__" => {
            function.returns = Python::One("tuple[tuple[()], dict[str, object]]".to_owned());
        }
        name if name.starts_with('_') && !name.starts_with("__") => return None,
        _ => {}
    }
    let decorator = if has(attributes, "staticmethod") {
        "@staticmethod\n"
    } else {
        ""
    };
    Some(Member::Method(function, decorator))
}

fn record(name: &str, fields: &[(String, Type)]) -> Class {
    let ty = |ty| Python::One(result(ty, "").text());
    let parameters = fields
        .iter()
        .map(|(name, field)| Parameter {
            name: name.clone(),
            ty: ty(field),
            default: None,
            by_name: false,
        })
        .collect();
    let new = Function {
        name: "__new__".to_owned(),
        receiver: "cls",
        parameters,
        returns: Python::One(name.to_owned()),
    };
    let arguments = Function {
        name: "__getnewargs__".to_owned(),
        receiver: "self",
        parameters: Vec::new(),
        returns: Python::One("tuple[object, ...]".to_owned()),
    };
    let mut members = vec![Member::Method(new, ""), Member::Method(arguments, "")];
    members.extend(
        fields
            .iter()
            .map(|(name, field)| Member::Property(name.clone(), ty(field))),
    );
    Class {
        members,
        ..Class::default()
    }
}

fn has(attributes: &[Attribute], name: &str) -> bool {
    attributes.iter().any(|attribute| {
        attribute
            .path()
            .segments
            .last()
            .is_some_and(|last| last.ident == name)
    })
}
