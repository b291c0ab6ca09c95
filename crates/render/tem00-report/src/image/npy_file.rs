use std::io::Read;

use crate::npy::{NpyError, NpyReader};

use super::{
    common::{ImageError, MAXIMUM_PIXELS, check_room, checked_area},
    raw_file::{BYTES_PER_PIXEL, Samples},
    selection::Components,
};

/// The memory for the largest image, in bytes, of complex numbers that are transposed once.
const MEMORY: u64 = 16 * MAXIMUM_PIXELS;

/// Reads a two-dimensional array of real values, or the intensity |U|² of complex ones.
///
/// Axes of length 1 are left out: (height, width, 1) is an image as well.
pub(super) fn read(reader: impl Read) -> Result<Samples, ImageError> {
    let file = NpyReader::new(reader)?;
    let [height, width] = file
        .grid_shape()
        .ok_or_else(|| ImageError::Shape(file.shape().to_vec()))?;
    // Values are transposed where the file stores the columns one after the other.
    check_room(
        checked_area(width, height)?,
        BYTES_PER_PIXEL + if file.is_complex() { 20 } else { 8 },
    )?;
    let element_type = file.element_type();
    let (values, interpretation) = if file.is_complex() {
        let amplitude = file.into_complex(MEMORY)?;
        (amplitude.map(|u| u.norm_sqr()), "squared magnitudes")
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
    use num_complex::Complex;
    use tem00_numerics::Grid;

    use super::*;
    use crate::{
        image::{LoadedImage, Reading},
        npy::{tests::array, write_npy},
    };

    fn light(file: &[u8]) -> Result<LoadedImage, ImageError> {
        read(file)?.judged(None)?.light(&Reading::default())
    }

    #[test]
    fn values_say_what_they_were() {
        let image = light(&array("<u2", "(1, 2)", &[1, 0, 44, 1])).expect("an NPY file");
        assert_eq!(image.values.values(), [1.0, 300.0]);
        assert_eq!(image.interpretation, "values of the type <u2");
        // Complex amplitudes are read as intensities.
        let image = Grid::from_fn(2, 2, |x, y| Complex::new(x as f32, 3.0 * y as f32));
        let mut file = Vec::new();
        write_npy(&image, &mut file).expect("written");
        let back = light(&file).expect("an NPY file");
        assert_eq!(back.values.values(), [0.0, 1.0, 9.0, 10.0]);
        assert_eq!(back.interpretation, "squared magnitudes of the type <c8");
    }

    #[test]
    fn shapes_and_types_that_are_no_image_are_refused() {
        let table = "
            <f4 => (4,) => the shape [4]; two dimensions
            <f4 => (4, 4, 3) => the shape [4, 4, 3]; two dimensions
            <f4 => (0, 4) => 4 × 0 pixels
            <f4 => (1000000, 1000000) => 1000000 × 1000000 pixels
            <f4 => (4, 4) => ends before its array does
            <U2 => (1, 2) => values of the type <U2 are not supported";
        for [element_type, shape, part] in tem00_testkit::rows(table) {
            let error = light(&array(&element_type, &shape, &[0; 16])).expect_err(&shape);
            assert!(error.to_string().contains(&part), "{error}");
        }
    }
}
