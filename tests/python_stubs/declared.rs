//! What the macros `methods!`, `functions!` and `record!` of the bindings declare.

use syn::{
    Attribute, Expr, Ident, LitStr, Result, Token, Type, braced, parenthesized,
    parse::{Parse, ParseStream},
};

use crate::{
    classes::Member,
    functions::{Function, Parameter},
    types::{Python, result},
};

/// The class and the members of a `methods!`.
pub(crate) struct Methods(pub(crate) String, pub(crate) Vec<Member>);

impl Parse for Methods {
    fn parse(input: ParseStream<'_>) -> Result<Self> {
        input.parse::<Token![impl]>()?;
        let class = input.parse::<Ident>()?.to_string();
        input.parse::<Token![as]>()?;
        input.parse::<Ident>()?;
        input.parse::<Token![:]>()?;
        input.parse::<Expr>()?;
        input.parse::<Token![;]>()?;
        let mut members = Vec::new();
        while !input.is_empty() {
            members.extend(member(input, &class)?);
        }
        Ok(Self(class, members))
    }
}

/// The functions of a `functions!`.
pub(crate) struct Functions(pub(crate) Vec<Function>);

impl Parse for Functions {
    fn parse(input: ParseStream<'_>) -> Result<Self> {
        let mut functions = Vec::new();
        while !input.is_empty() {
            Attribute::parse_outer(input)?;
            input.parse::<Ident>()?;
            functions.push(query(input, "")?);
        }
        Ok(Self(functions))
    }
}

/// The name of a `record!` and its fields.
pub(crate) struct Record(pub(crate) String, pub(crate) Vec<(String, Type)>);

impl Parse for Record {
    fn parse(input: ParseStream<'_>) -> Result<Self> {
        input.parse::<LitStr>()?;
        input.parse::<Token![,]>()?;
        Attribute::parse_outer(input)?;
        let name = input.parse::<Ident>()?.to_string();
        let content;
        braced!(content in input);
        let mut fields = Vec::new();
        while !content.is_empty() {
            Attribute::parse_outer(&content)?;
            let field = content.parse::<Ident>()?.to_string();
            content.parse::<Token![:]>()?;
            fields.push((field, content.parse()?));
            content.parse::<Option<Token![,]>>()?;
        }
        Ok(Self(name, fields))
    }
}

/// One declaration; `made_by` and `unmade` declare nothing that a stub shows.
fn member(input: ParseStream<'_>, class: &str) -> Result<Option<Member>> {
    Attribute::parse_outer(input)?;
    let kind = input.parse::<Ident>()?;
    if kind == "map" {
        return Ok(Some(Member::Method(query(input, "self")?, "")));
    }
    if kind == "make" {
        return Ok(Some(constructor(query(input, "")?, class)));
    }
    if kind == "unmade" {
        input.parse::<LitStr>()?;
        input.parse::<Token![;]>()?;
        return Ok(None);
    }
    let name = input.parse::<Ident>()?.to_string();
    if kind == "made_by" {
        let content;
        parenthesized!(content in input);
        content.parse_terminated(Ident::parse, Token![,])?;
        input.parse::<Token![;]>()?;
        return Ok(None);
    }
    input.parse::<Token![->]>()?;
    let ty: Type = input.parse()?;
    expression(input)?;
    Ok(Some(Member::Property(name, result(&ty, class))))
}

/// A constructor from numbers.
fn constructor(mut function: Function, class: &str) -> Member {
    for parameter in &mut function.parameters {
        parameter.ty = Python::One("float".to_owned());
    }
    function.returns = Python::One(class.to_owned());
    if function.name == "new" {
        "__new__".clone_into(&mut function.name);
        function.receiver = "cls";
        return Member::Method(function, "");
    }
    Member::Method(function, "@staticmethod\n")
}

/// The part of `map` or `make` behind this word.
fn query(input: ParseStream<'_>, receiver: &'static str) -> Result<Function> {
    let name = input.parse::<Ident>()?.to_string();
    let content;
    parenthesized!(content in input);
    let mut parameters = Vec::new();
    while !content.is_empty() {
        let name = content.parse::<Ident>()?.to_string();
        if content.parse::<Option<Token![:]>>()?.is_some() {
            content.parse::<Ident>()?;
        }
        content.parse::<Option<Token![,]>>()?;
        let ty = Python::Either("float", "Numbers");
        parameters.push(Parameter {
            name,
            ty,
            default: None,
            by_name: false,
        });
    }
    expression(input)?;
    let returns = Python::Either("float", "FloatArray");
    Ok(Function {
        name,
        receiver,
        parameters,
        returns,
    })
}

/// What may follow a declaration.
fn expression(input: ParseStream<'_>) -> Result<()> {
    if input.parse::<Option<Token![=]>>()?.is_some() {
        input.parse::<Expr>()?;
    }
    input.parse::<Token![;]>()?;
    Ok(())
}
