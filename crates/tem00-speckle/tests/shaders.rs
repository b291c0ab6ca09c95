//! The text for graphics cards compiles, and keeps to its names.

use naga::valid::{Capabilities, ValidationFlags, Validator};
use tem00_speckle::closed_form::WGSL;

/// What the host writes.
const HOST: &str = "
    fn tem00_stack_coefficient(slice: u32, cell: vec2<u32>) -> vec2<f32> { return vec2<f32>(f32(slice * cell.x), 0.0); }
    fn tem00_stack_law(slice: u32, row: u32) -> vec4<f32> { return vec4<f32>(f32(slice + row)); }
";

fn module() -> naga::Module {
    let text = format!("{WGSL}{HOST}");
    naga::front::wgsl::parse_str(&text)
        .unwrap_or_else(|error| panic!("{}", error.emit_to_string(&text)))
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
        let name = function.name.as_deref().expect("a name");
        assert!(name.starts_with("tem00_"), "function {name}");
    }
    for name in module.types.iter().filter_map(|(_, ty)| ty.name.as_ref()) {
        assert!(name.starts_with("Tem00"), "struct {name}");
    }
}
