//! Functions and methods as stubs.

use quote::ToTokens;
use syn::{Attribute, FnArg, Pat, ReturnType, Signature};

use crate::{
    exceptions,
    types::{Python, argument, result},
};

/// A function or a method.
#[derive(Clone, Debug)]
pub(crate) struct Function {
    pub(crate) name: String,
    /// What stands before the parameters: `self`, `cls` or nothing.
    pub(crate) receiver: &'static str,
    pub(crate) parameters: Vec<Parameter>,
    pub(crate) returns: Python,
}

#[derive(Clone, Debug)]
pub(crate) struct Parameter {
    pub(crate) name: String,
    pub(crate) ty: Python,
    pub(crate) default: Option<String>,
    pub(crate) by_name: bool,
}

impl Function {
    /// Reads a function of the bindings.
    pub(crate) fn read(attributes: &[Attribute], signature: &Signature, class: &str) -> Self {
        let mut receiver = "";
        let mut parameters = Vec::new();
        for input in &signature.inputs {
            match input {
                FnArg::Receiver(_) => receiver = "self",
                FnArg::Typed(typed) => {
                    let Pat::Ident(name) = &*typed.pat else {
                        continue;
                    };
                    let name = name.ident.to_string();
                    if name == "slf" {
                        receiver = "self";
                        continue;
                    }
                    let ty = exceptions::argument(&name, argument(&typed.ty, class));
                    if ty != Python::Hidden {
                        parameters.push(Parameter {
                            name,
                            ty,
                            default: None,
                            by_name: false,
                        });
                    }
                }
            }
        }
        defaults(attributes, &mut parameters);
        let returns = match &signature.output {
            ReturnType::Default => Python::One("None".to_owned()),
            ReturnType::Type(_, ty) => result(ty, class),
        };
        Self {
            name: signature.ident.to_string(),
            receiver,
            parameters,
            returns,
        }
    }

    /// Writes the stub: two overloads where numbers give a number and arrays an array.
    pub(crate) fn write(&self, indent: &str, decorator: &str) -> String {
        let broadcast = |p: &&Parameter| matches!(p.ty, Python::Either(..));
        let count = self.parameters.iter().filter(broadcast).count();
        let vectors = Python::One("Vectors".to_owned());
        let Python::Either(number, array) = &self.returns else {
            return self.definition(indent, decorator, self.returns.clone().text(), Python::text);
        };
        if count == 0 || self.parameters.iter().any(|p| p.ty == vectors) {
            return self.definition(indent, decorator, self.returns.clone().text(), Python::text);
        }
        let decorators = format!("{decorator}@overload\n");
        let numbers = self.definition(indent, &decorators, (*number).to_owned(), |ty| match ty {
            Python::Either(number, _) => number.to_owned(),
            ty => ty.text(),
        });
        let arrays = self.definition(indent, &decorators, (*array).to_owned(), |ty| match ty {
            Python::Either(_, "Numbers") if count == 1 => "RealArray".to_owned(),
            ty => ty.text(),
        });
        numbers + &arrays
    }

    fn definition(
        &self,
        indent: &str,
        decorators: &str,
        returns: String,
        shown: impl Fn(Python) -> String,
    ) -> String {
        let mut parts: Vec<String> = Vec::new();
        if !self.receiver.is_empty() {
            parts.push(self.receiver.to_owned());
        }
        let mut starred = false;
        for parameter in &self.parameters {
            if parameter.by_name && !starred {
                parts.push("*".to_owned());
                starred = true;
            }
            let ty = shown(parameter.ty.clone());
            let default = parameter
                .default
                .as_ref()
                .map_or(String::new(), |d| format!(" = {d}"));
            parts.push(format!("{}: {ty}{default}", parameter.name));
        }
        let mut text = String::new();
        for decorator in decorators.lines() {
            text += &format!("{indent}{decorator}\n");
        }
        let name = &self.name;
        let line = format!(
            "{indent}def {name}({}) -> {returns}: ...\n",
            parts.join(", ")
        );
        if line.chars().count() <= 101 {
            return text + &line;
        }
        text += &format!("{indent}def {name}(\n");
        for part in parts {
            text += &format!("{indent}    {part},\n");
        }
        text + &format!("{indent}) -> {returns}: ...\n")
    }
}

/// Takes defaults and parameters that only go by name from `#[pyo3(signature = (…))]`.
fn defaults(attributes: &[Attribute], parameters: &mut [Parameter]) {
    for attribute in attributes.iter().filter(|a| a.path().is_ident("pyo3")) {
        let text = attribute.meta.to_token_stream().to_string();
        let Some((_, signature)) = text.split_once("signature = (") else {
            continue;
        };
        let mut by_name = false;
        for part in signature.trim_end_matches([')', ' ']).split(',') {
            let (name, default) = match part.split_once('=') {
                Some((name, default)) => (name.trim(), Some(default.trim())),
                None => (part.trim(), None),
            };
            by_name |= name == "*";
            if let Some(parameter) = parameters.iter_mut().find(|p| p.name == name) {
                parameter.by_name = by_name;
                parameter.default = default.map(|default| match default {
                    "None" => "None".to_owned(),
                    text if text.starts_with('"') => text.to_owned(),
                    _ => "...".to_owned(),
                });
            }
        }
    }
}
