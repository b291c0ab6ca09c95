//! The layouts of the lights in memory, which the structs in WGSL and C share.

use core::mem::{offset_of, size_of};

use tem00_beam::{Axis, LineLight, NextEvent, SpotLight};

/// The names and offsets of the members of a struct, and its size.
pub(crate) type Layout = (Vec<(String, usize)>, usize);

macro_rules! layout_of {
    ($type:ty: $($field:ident)*) => {
        (
            vec![$((stringify!($field).to_owned(), offset_of!($type, $field))),*],
            size_of::<$type>(),
        )
    };
}

/// The structs in `f32`, by the names of their counterparts.
pub(crate) fn layouts() -> [(&'static str, Layout); 4] {
    [
        ("Tem00Axis", layout_of!(Axis<f32>: w0_sq theta_sq z0 pad)),
        (
            "Tem00SpotLight",
            layout_of!(SpotLight<f32>: origin power ex cutoff ey wavelength ez pad_ez x y),
        ),
        (
            "Tem00NextEvent",
            layout_of!(NextEvent<f32>: point distance wi e_perp),
        ),
        (
            "Tem00LineLight",
            layout_of!(
                LineLight<f32>:
                origin power ex cutoff ey apex_offset ez source_radius y
                flat sigma variable mass half_slope focus_on_plane wavelength pad
            ),
        ),
    ]
}
