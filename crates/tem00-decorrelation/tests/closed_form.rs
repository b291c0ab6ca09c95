//! The WGSL of the law of motion: what its text promises. What it computes is tested on a card.

use naga::{
    Module, TypeInner,
    valid::{Capabilities, ValidationFlags, Validator},
};
use tem00_decorrelation::closed_form::WGSL;

/// The functions with what the host defines.
fn module() -> Module {
    let hook = "fn tem00_slice_overlaps(slice: u32) -> vec2<f32> { return vec2(1.0); }";
    let text = format!("{WGSL}\n{hook}");
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
        let name = function.name.as_deref().unwrap();
        assert!(name.starts_with("tem00_"), "function {name}");
    }
    for name in module.types.iter().filter_map(|(_, ty)| ty.name.as_ref()) {
        assert!(name.starts_with("Tem00"), "struct {name}");
    }
}

#[test]
fn the_imaging_of_a_kernel_is_four_rows() {
    let module = module();
    let imaging = |ty: &&naga::Type| ty.name.as_deref() == Some("Tem00Imaging");
    let ty = module.types.iter().map(|(_, ty)| ty).find(imaging).unwrap();
    let TypeInner::Struct { members, span } = &ty.inner else {
        panic!("{ty:?}");
    };
    assert_eq!(*span, 64);
    let rows: Vec<_> = members
        .iter()
        .map(|member| (member.name.as_deref().unwrap(), member.offset / 4))
        .collect();
    let expected = [
        ("right", 0),
        ("signed_principal_distance", 3),
        ("up", 4),
        ("per_surface_to_pupil", 7),
        ("towards_camera", 8),
        ("per_pupil_diameter", 11),
        ("per_axial_length", 12),
        ("samples_per_metre", 13),
        ("pad", 14),
    ];
    assert_eq!(rows, expected);
}
