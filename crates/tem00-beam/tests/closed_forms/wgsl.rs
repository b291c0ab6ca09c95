use naga::valid::{Capabilities, ValidationFlags, Validator};
use naga::{Module, Type, TypeInner};
use tem00_beam::closed_form::WGSL;

use super::layouts::{Layout, layouts};

fn module() -> Module {
    naga::front::wgsl::parse_str(WGSL)
        .unwrap_or_else(|error| panic!("{}", error.emit_to_string(WGSL)))
}

#[test]
fn the_source_is_valid_without_any_extension() {
    let mut validator = Validator::new(ValidationFlags::all(), Capabilities::empty());
    let result = validator.validate(&module());
    assert!(result.is_ok(), "{result:?}");
}

#[test]
fn the_source_has_no_bindings_and_a_prefix_on_every_name() {
    let module = module();
    assert!(module.global_variables.is_empty(), "no bindings");
    assert!(module.entry_points.is_empty(), "no entry points");
    for (_, function) in module.functions.iter() {
        let name = function.name.as_deref().unwrap();
        assert!(name.starts_with("tem00_"), "function {name}");
    }
    for name in module.types.iter().filter_map(|(_, ty)| ty.name.as_ref()) {
        assert!(name.starts_with("Tem00"), "struct {name}");
    }
}

fn layout(module: &Module, name: &str) -> Layout {
    let named = |ty: &&Type| ty.name.as_deref() == Some(name);
    let ty = module.types.iter().map(|(_, ty)| ty).find(named).unwrap();
    match &ty.inner {
        TypeInner::Struct { members, span } => {
            let fields = members
                .iter()
                .map(|member| (member.name.clone().unwrap(), member.offset as usize));
            (fields.collect(), *span as usize)
        }
        other => panic!("{name} is {other:?}"),
    }
}

#[test]
fn structs_have_the_layout_of_their_counterparts() {
    let module = module();
    for (name, expected) in layouts() {
        assert_eq!(layout(&module, name), expected, "{name}");
    }
}
