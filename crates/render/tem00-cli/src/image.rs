//! Image files: OpenEXR and NumPy for light, and what cameras write for grey values.

mod common;
mod exr_file;
#[cfg(feature = "full")]
mod exr_reader;
#[cfg(feature = "full")]
mod npy_file;
#[cfg(feature = "full")]
mod orientation;
mod png_file;
#[cfg(feature = "full")]
mod raw_file;
#[cfg(feature = "full")]
mod reading;
#[cfg(feature = "full")]
mod saturation;
#[cfg(feature = "full")]
mod selection;

pub(crate) use self::{
    common::{Format, ImageError, Transfer, check_inside, open},
    exr_file::{Layer, Window, write_exr},
    png_file::{write_grey_png, write_rgb_png},
};
#[cfg(feature = "full")]
pub(crate) use self::{
    common::{LoadedImage, Reading},
    raw_file::{RawFormat, RawImage, read_raw, write_raw},
    reading::read_image,
};
