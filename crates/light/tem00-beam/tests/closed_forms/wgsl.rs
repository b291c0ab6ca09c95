use naga::{Module, Type, TypeInner};
use tem00_beam::closed_form::WGSL;

use super::layouts::{Layout, layouts};

fn module() -> Module {
    naga::front::wgsl::parse_str(WGSL)
        .unwrap_or_else(|error| panic!("{}", error.emit_to_string(WGSL)))
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
