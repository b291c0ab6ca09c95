use std::io::Read;

use tem00_speckle::{NpyError, NpyReader};

use super::common::{ImageError, LoadedImage, MAXIMUM_PIXELS, check_room, checked_area, intensity};

/// The bytes of the largest image, of complex numbers that are turned once.
const MEMORY: u64 = 16 * MAXIMUM_PIXELS;

/// Reads a two-dimensional array of real values, or the intensity |U|² of complex ones.
pub(super) fn read(reader: impl Read) -> Result<LoadedImage, ImageError> {
    let file = NpyReader::new(reader)?;
    let &[height, width] = file.shape() else {
        return Err(ImageError::Shape(file.shape().to_vec()));
    };
    // Values are turned where the file has the columns one after the other.
    check_room(
        checked_area(width, height)?,
        if file.is_complex() { 20 } else { 8 },
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
    Ok(LoadedImage {
        values,
        interpretation: format!("{interpretation} of the type {element_type}"),
        saturated: None,
    })
}

#[cfg(test)]
mod tests {
    use num_complex::Complex;
    use tem00_numerics::Grid;
    use tem00_speckle::write_npy;

    use super::*;

    /// An array as NumPy writes it, but for the blanks behind the header.
    fn array(element_type: &str, shape: &str, values: &[u8]) -> Vec<u8> {
        let text =
            format!("{{'descr': '{element_type}', 'fortran_order': False, 'shape': {shape}, }}");
        let length = u16::try_from(text.len()).expect("a short header");
        let start = [&b"\x93NUMPY\x01\x00"[..], &length.to_le_bytes()].concat();
        [&start, text.as_bytes(), values].concat()
    }

    #[test]
    fn values_say_what_they_were() {
        let values = [1_u16, 2, 300, 4].map(u16::to_le_bytes).concat();
        let image = read(&array("<u2", "(2, 2)", &values)[..]).expect("an NPY file");
        assert_eq!(image.values.values(), [1.0, 2.0, 300.0, 4.0]);
        assert_eq!(image.interpretation, "values of the type <u2");
    }

    #[test]
    fn complex_amplitudes_are_read_as_intensities() {
        let image = Grid::from_fn(2, 2, |x, y| Complex::new(x as f32, 3.0 * y as f32));
        let mut file = Vec::new();
        write_npy(&image, &mut file).expect("written");
        let back = read(&file[..]).expect("an NPY file");
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
        let error = read(&array("<i8", "(1, 2)", &[0; 16])[..]).expect_err("i8 is not supported");
        assert!(error.to_string().contains("<i8"), "{error}");
    }
}
