//! The function files for graphics cards: what their texts promise. What they compute is tested on a card.

use naga::{
    Module, Type, TypeInner,
    valid::{Capabilities, ValidationFlags, Validator},
};

/// What the host writes.
const HOST: &str = "
    fn tem00_slice_overlaps(slice: u32) -> vec2<f32> { return vec2<f32>(1.0); }
    fn tem00_stack_coefficient(slice: u32, cell: vec2<u32>) -> vec2<f32> { return vec2<f32>(1.0); }
    fn tem00_stack_law(slice: u32, row: u32) -> vec4<f32> { return vec4<f32>(1.0); }
";

const FILES: [&str; 3] = [
    tem00::beam::closed_form::WGSL,
    tem00::decorrelation::closed_form::WGSL,
    tem00::speckle::closed_form::WGSL,
];

/// The text with what the host writes.
fn module(text: &str) -> Module {
    let text = format!("{text}{HOST}");
    naga::front::wgsl::parse_str(&text)
        .unwrap_or_else(|error| panic!("{}", error.emit_to_string(&text)))
}

#[test]
fn each_file_and_all_of_them_are_valid_without_any_extension() {
    for text in FILES.map(str::to_owned).into_iter().chain([FILES.concat()]) {
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

#[test]
fn the_imaging_of_a_kernel_is_four_rows() {
    let module = module(tem00::decorrelation::closed_form::WGSL);
    let imaging = |ty: &&Type| ty.name.as_deref() == Some("Tem00Imaging");
    let ty = module.types.iter().map(|(_, ty)| ty).find(imaging).unwrap();
    let TypeInner::Struct { members, span } = &ty.inner else {
        panic!("{ty:?}");
    };
    assert_eq!(*span, 64, "bytes");
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
    assert_eq!(rows, expected, "members and their places");
}
