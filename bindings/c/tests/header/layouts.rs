//! The structs and enumerations of the header against those of the library.

use std::{
    mem::{offset_of, size_of},
    process::Command,
};

use tem00_capi::*;

use super::compiled::{Language, compile};

/// The name in C, the size and the name and offset of the last field of structs.
macro_rules! structs {
    ($($type:ident $name:literal $last:ident,)*) => {
        [$((
            concat!("tem00_", $name),
            size_of::<$type>(),
            stringify!($last),
            offset_of!($type, $last),
        )),*]
    };
}

const STRUCTS: [(&str, usize, &str, usize); 30] = structs![
    Placement "placement" fan_axis,
    SpotDescription "spot_description" m_squared,
    EllipticDescription "elliptic_description" rotation,
    LineDescription "line_description" knot_count,
    NextEvent "next_event" e_perp,
    NextEventF32 "next_event_f32" e_perp,
    SampledEvent "sampled_event" pdf,
    RaySample "ray_sample" pdf,
    RayPdf "ray_pdf" position_given_direction,
    Bounds "bounds" half_angle,
    LightInfo "light_info" wavelength,
    ApertureHit "aperture_hit" pdf,
    NextEventColumns "next_event_columns" e_perp,
    NextEventColumnsF32 "next_event_columns_f32" e_perp,
    LightData "light_data" fields,
    CameraDescription "camera_description" distortion,
    Pose "pose" translation,
    BodyMotion "body_motion" light,
    SpeckleDescription "speckle_description" threads,
    SpeckleInfo "speckle_info" memory_bytes,
    SpeckleShift "speckle_shift" correlation,
    StackDescription "stack_description" threads,
    StackNeeds "stack_needs" memory_limit,
    StackInfo "stack_info" memory_bytes,
    BandwidthDescription "bandwidth_description" correlation_length,
    BandwidthInfo "bandwidth_info" height_count,
    Wave "wave" phase_per_height,
    LensDescription "lens_description" pixel_pitch,
    PupilDistances "pupil_distances" pixel_pitch,
    ImagingInfo "imaging_info" axial_decorrelation_length,
];

/// The last constant of each enumeration, and its number.
const CONSTANTS: [(&str, u32); 7] = [
    ("STATUS_PANIC", Status::Panic as u32),
    ("FOCUS_CURVE_EQUAL_PLANE", FocusCurve::EqualPlane as u32),
    ("PEAK_SHAPE_RECTANGULAR", PeakShape::Rectangular as u32),
    ("LINE_PROFILE_TABULATED", LineProfile::Tabulated as u32),
    ("LIGHT_KIND_TABULATED_LINE", LightKind::TabulatedLine as u32),
    ("SLICE_PATH_STRAIGHT", SlicePath::Straight as u32),
    ("FOCUS_MAGNIFICATION", Focus::Magnification as u32),
];

/// A program that prints what the header makes of structs and constants.
fn program() -> String {
    let mut body = String::new();
    for (name, _, last, _) in STRUCTS {
        body += &format!(
            "    printf(\"{name} %zu {last} %zu\\n\", sizeof({name}), offsetof({name}, {last}));\n"
        );
    }
    for (name, _) in CONSTANTS {
        body += &format!("    printf(\"{name} %d\\n\", (int)TEM00_{name});\n");
    }
    body += "    printf(\"version %s\\n\", TEM00_VERSION);\n";
    format!(
        "#include <stdio.h>\n#include \"tem00.h\"\n\nint main(void) {{\n{body}    return 0;\n}}\n"
    )
}

/// What it must print.
fn expected() -> String {
    let mut text = String::new();
    for (name, size, last, offset) in STRUCTS {
        text += &format!("{name} {size} {last} {offset}\n");
    }
    for (name, number) in CONSTANTS {
        text += &format!("{name} {number}\n");
    }
    text + &format!("version {}\n", env!("CARGO_PKG_VERSION"))
}

#[test]
fn structs_enumerations_and_the_version_are_those_of_the_library() {
    for language in [Language::C99, Language::Cpp17] {
        let output = Command::new(compile(language, "layouts", &program(), &[]))
            .output()
            .unwrap();
        let printed = String::from_utf8(output.stdout).unwrap();
        assert_eq!(
            printed,
            expected(),
            "the header, then the library: {language:?}"
        );
    }
}
