//! The layouts of the lights in memory, which the structs in WGSL and C share.

use core::mem::{offset_of, size_of};

use tem00_beam::{Axis, LineLight, NextEvent, SpotLight};

/// The names and offsets of the members of a struct, and its size.
pub(crate) type Layout = (Vec<(String, usize)>, usize);

macro_rules! layout_of {
    ($type:ty: $($field:ident)*) => {
        (
            vec![$((stringify!($field).to_owned(), offset_of!($type, $field) / 2)),*],
            size_of::<$type>() / 2,
        )
    };
}

/// The structs, half as large as in `f64`, by the names of their counterparts.
pub(crate) fn layouts() -> [(&'static str, Layout); 4] {
    [
        ("Tem00Axis", layout_of!(Axis: w0_sq theta_sq z0 pad)),
        (
            "Tem00SpotLight",
            layout_of!(SpotLight: origin power ex cutoff ey wavelength ez pad_ez x y),
        ),
        (
            "Tem00NextEvent",
            layout_of!(NextEvent: point distance wi e_perp),
        ),
        (
            "Tem00LineLight",
            layout_of!(
                LineLight:
                origin power ex cutoff ey apex_offset ez source_radius y
                flat sigma variable mass half_slope focus_on_plane wavelength pad
            ),
        ),
    ]
}
