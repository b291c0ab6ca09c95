//! The function files for graphics cards: what their texts promise.

#[path = "../../../../crates/light/tem00-beam/tests/closed_forms/layouts.rs"]
mod layouts;

use wgpu::naga::{
    Module, Type, TypeInner,
    front::wgsl::parse_str,
    valid::{Capabilities, ValidationFlags, Validator},
};

use layouts::{Layout, layouts};

/// What the host writes.
const HOST: &str = "
    fn tem00_stack_coefficient(slice: u32, cell: vec2<u32>) -> vec2<f32> { return vec2<f32>(1.0); }
    fn tem00_stack_law(slice: u32, row: u32) -> vec4<f32> { return vec4<f32>(1.0); }
";

/// The last calls functions of those before it.
const FILES: [&str; 4] = [
    tem00_beam::closed_form::WGSL,
    tem00_decorrelation::closed_form::WGSL,
    tem00_speckle::closed_form::WGSL,
    tem00_shading::WGSL,
];

/// The text with what the host writes.
fn module(text: &str) -> Module {
    let text = format!("{text}{HOST}");
    parse_str(&text).unwrap_or_else(|error| panic!("{}", error.emit_to_string(&text)))
}

#[test]
fn each_file_and_all_of_them_are_valid_without_any_extension() {
    let alone = FILES[..3].iter().map(|&text| text.to_owned());
    for text in alone.chain([FILES.concat()]) {
        let mut validator = Validator::new(ValidationFlags::all(), Capabilities::empty());
        let result = validator.validate(&module(&text));
        assert!(result.is_ok(), "{result:?}");
    }
}

#[test]
fn the_files_have_no_bindings_and_a_prefix_on_every_name() {
    let module = module(&FILES.concat());
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

fn structure<'a>(module: &'a Module, name: &str) -> &'a TypeInner {
    let named = |ty: &&Type| ty.name.as_deref() == Some(name);
    &module
        .types
        .iter()
        .map(|(_, ty)| ty)
        .find(named)
        .unwrap()
        .inner
}

#[test]
fn lights_have_the_layout_of_their_counterparts() {
    let module = module(tem00_beam::closed_form::WGSL);
    for (name, expected) in layouts() {
        let TypeInner::Struct { members, span } = structure(&module, name) else {
            panic!("{name} is no struct");
        };
        let members = members.iter();
        let fields = members.map(|member| (member.name.clone().unwrap(), member.offset as usize));
        let found: Layout = (fields.collect(), *span as usize);
        assert_eq!(found, expected, "{name}");
    }
}

#[test]
fn a_frame_of_a_kernel_is_fourteen_rows() {
    let module = module(&FILES.concat());
    let TypeInner::Struct { members, span } = structure(&module, "Tem00SpeckleFrame") else {
        panic!("a frame is a struct");
    };
    assert_eq!(*span, 14 * 16, "bytes");
    // No member is moved to where its alignment wants it: three numbers and one in a row.
    let mut end = 0;
    for member in members {
        assert_eq!(member.offset, end, "{:?}", member.name);
        end += module.types[member.ty].inner.size(module.to_ctx());
    }
    assert_eq!(end, *span, "bytes of the members");
}
