//! Image files: OpenEXR and NumPy for light, and the formats of cameras for grey values.

mod common;
mod exr_file;
mod exr_reader;
mod npy_file;
mod orientation;
mod png_data;
mod png_file;
mod raw_file;
mod reading;
mod saturation;
mod selection;

pub(crate) use self::png_file::write_png;
pub use self::{
    common::{Format, ImageError, Transfer, open},
    exr_file::{Layer, Window, write_exr},
    png_file::{write_grey_png, write_rgb_png},
};
pub use self::{
    common::{LoadedImage, Reading},
    raw_file::{GreyFrame, RawFormat, RawImage, read_raw, write_raw},
    reading::read_image,
};
