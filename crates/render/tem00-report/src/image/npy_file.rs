use std::io::Read;

use crate::npy::{NpyError, NpyReader};

use super::{
    common::{ImageError, MAXIMUM_PIXELS, check_room, checked_area, intensity},
    raw_file::{BYTES_PER_PIXEL, Samples},
    selection::Components,
};

/// The bytes of the largest image, of complex numbers that are turned once.
const MEMORY: u64 = 16 * MAXIMUM_PIXELS;

/// Reads a two-dimensional array of real values, or the intensity |U|² of complex ones.
///
/// Axes of one value are left out: (height, width, 1) is an image as well.
pub(super) fn read(reader: impl Read) -> Result<Samples, ImageError> {
    let file = NpyReader::new(reader)?;
    let [height, width] = file
        .grid_shape()
        .ok_or_else(|| ImageError::Shape(file.shape().to_vec()))?;
    // Values are turned where the file has the columns one after the other.
    check_room(
        checked_area(width, height)?,
        BYTES_PER_PIXEL + if file.is_complex() { 20 } else { 8 },
    )?;
    let element_type = file.element_type().to_owned();
    let (values, interpretation) = if file.is_complex() {
        let amplitude = file.into_complex(MEMORY)?;
        (amplitude.map(|&u| intensity(u)), "squared magnitudes")
    } else {
        let values = file.into_real(MEMORY).map_err(|error| match error {
            NpyError::ElementType { found, .. } => ImageError::ValueType(found),
            error => error.into(),
        })?;
        (values, "values")
    };
    let size = [values.width(), values.height()];
    let name = format!("{interpretation} of the type {element_type}");
    Ok(Samples::of_light(
        size,
        Components::Grey,
        values.into_values(),
        name,
    ))
}

#[cfg(test)]
mod tests {
    use crate::npy::write_npy;
    use num_complex::Complex;
    use tem00_numerics::Grid;

    use super::*;
    use crate::image::{LoadedImage, Reading};

    /// An array as NumPy writes it, but for the blanks behind the header.
    fn array(element_type: &str, shape: &str, values: &[u8]) -> Vec<u8> {
        let text =
            format!("{{'descr': '{element_type}', 'fortran_order': False, 'shape': {shape}, }}");
        let length = u16::try_from(text.len()).expect("a short header");
        let start = [&b"\x93NUMPY\x01\x00"[..], &length.to_le_bytes()].concat();
        [&start, text.as_bytes(), values].concat()
    }

    fn light(file: &[u8]) -> Result<LoadedImage, ImageError> {
        let reading = Reading {
            black_level: Some(0.0),
            ..Reading::default()
        };
        read(file)?.judged(None)?.light(&reading)
    }

    #[test]
    fn values_say_what_they_were() {
        let halves = [0x3c00_u16, 0xc000, 0x0001, 0x7bff];
        let cases: [(&str, Vec<u8>, [f32; 4]); 12] = [
            (
                "<u2",
                [1_u16, 2, 300, 4].map(u16::to_le_bytes).concat(),
                [1.0, 2.0, 300.0, 4.0],
            ),
            (
                ">i2",
                [-1_i16, 2, 300, -32768].map(i16::to_be_bytes).concat(),
                [-1.0, 2.0, 300.0, -32768.0],
            ),
            (
                "<i4",
                [-1_i32, 2, 70_000, 4].map(i32::to_le_bytes).concat(),
                [-1.0, 2.0, 70_000.0, 4.0],
            ),
            (
                "<i8",
                [-1_i64, 2, 1 << 40, 4].map(i64::to_le_bytes).concat(),
                [-1.0, 2.0, (1_u64 << 40) as f32, 4.0],
            ),
            (
                "<u4",
                [1_u32, 2, 1 << 31, 4].map(u32::to_le_bytes).concat(),
                [1.0, 2.0, (1_u64 << 31) as f32, 4.0],
            ),
            (
                ">u8",
                [1_u64, 2, 1 << 40, 4].map(u64::to_be_bytes).concat(),
                [1.0, 2.0, (1_u64 << 40) as f32, 4.0],
            ),
            ("|i1", vec![255, 2, 127, 128], [-1.0, 2.0, 127.0, -128.0]),
            ("|u1", vec![255, 2, 127, 128], [255.0, 2.0, 127.0, 128.0]),
            ("|b1", vec![1, 0, 0, 1], [1.0, 0.0, 0.0, 1.0]),
            // 1, −2, the smallest and the largest number of binary16: 2⁻²⁴ and 65504.
            (
                "<f2",
                halves.map(u16::to_le_bytes).concat(),
                [1.0, -2.0, 5.960_464_5e-8, 65_504.0],
            ),
            (
                ">f2",
                halves.map(u16::to_be_bytes).concat(),
                [1.0, -2.0, 5.960_464_5e-8, 65_504.0],
            ),
            (
                ">f8",
                [1.5_f64, 2.0, 3.0, 4.0].map(f64::to_be_bytes).concat(),
                [1.5, 2.0, 3.0, 4.0],
            ),
        ];
        for (element_type, values, expected) in cases {
            for shape in ["(2, 2)", "(2, 2, 1)", "(1, 2, 2)", "(1, 2, 2, 1)"] {
                let image = light(&array(element_type, shape, &values)).expect("an NPY file");
                assert_eq!(image.values.values(), expected, "{element_type} {shape}");
                let told = image.interpretation;
                assert!(
                    told.starts_with(&format!("values of the type {element_type}")),
                    "{told}"
                );
            }
        }
    }

    #[test]
    fn complex_amplitudes_are_read_as_intensities() {
        let image = Grid::from_fn(2, 2, |x, y| Complex::new(x as f32, 3.0 * y as f32));
        let mut file = Vec::new();
        write_npy(&image, &mut file).expect("written");
        let back = light(&file).expect("an NPY file");
        assert_eq!(back.values.values(), [0.0, 1.0, 9.0, 10.0]);
        assert_eq!(back.interpretation, "squared magnitudes of the type <c8");
    }

    #[test]
    fn shapes_that_are_no_image_are_refused() {
        let read_shape = |shape: &str| read(&array("<f4", shape, &[])[..]).map(|_| ());
        assert!(
            matches!(read_shape("(4,)"), Err(ImageError::Shape(_))),
            "a line"
        );
        assert!(
            matches!(read_shape("(4, 4, 3)"), Err(ImageError::Shape(_))),
            "colours"
        );
        assert!(
            matches!(read_shape("(0, 4)"), Err(ImageError::Size { .. })),
            "nothing"
        );
        assert!(
            matches!(
                read_shape("(1000000, 1000000)"),
                Err(ImageError::Size { .. })
            ),
            "too large"
        );
        assert!(
            matches!(read_shape("(4, 4)"), Err(ImageError::Npy(_))),
            "data is missing"
        );
    }

    #[test]
    fn unknown_types_are_named() {
        let error = read(&array("<U2", "(1, 2)", &[0; 16])[..]).map(drop);
        let error = error.expect_err("text is no light");
        assert!(error.to_string().contains("<U2"), "{error}");
    }
}
