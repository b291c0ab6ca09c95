use std::io::{Read, Write};

use npyz::{AutoSerialize, NpyFile, Order, WriterBuilder};
use num_complex::Complex;
use tem00_numerics::Grid;

use super::{ImageError, LoadedImage, checked_area, grid, intensity};

/// Writes a grid as an array of `float32` with the shape (height, width).
pub(crate) fn write_npy_f32(writer: impl Write, image: &Grid<f32>) -> Result<(), ImageError> {
    write(writer, image)
}

/// Writes a grid as an array of `complex64` with the shape (height, width).
pub(crate) fn write_npy_complex(
    writer: impl Write,
    image: &Grid<Complex<f32>>,
) -> Result<(), ImageError> {
    write(writer, image)
}

fn write<T: AutoSerialize + Copy>(writer: impl Write, image: &Grid<T>) -> Result<(), ImageError> {
    let mut writer = npyz::WriteOptions::new()
        .default_dtype()
        .shape(&[image.height() as u64, image.width() as u64])
        .writer(writer)
        .begin_nd()?;
    writer.extend(image.values().iter().copied())?;
    Ok(writer.finish()?)
}

/// Reads a two-dimensional array of real values, or the intensity |U|² of complex ones.
pub(super) fn read(reader: impl Read) -> Result<LoadedImage, ImageError> {
    let file = NpyFile::new(reader).map_err(ImageError::Npy)?;
    let &[height, width] = file.shape() else {
        return Err(ImageError::Shape(file.shape().to_vec()));
    };
    checked_area(width, height)?;
    let (dtype, order) = (file.dtype().descr(), file.order());
    let (values, interpretation) = read_values(file)?;
    let cannot = |_| ImageError::Size { width, height };
    let width = usize::try_from(width).map_err(cannot)?;
    let height = usize::try_from(height).map_err(cannot)?;
    let values = match order {
        Order::C => grid(width, height, values)?,
        Order::Fortran => {
            let columns = grid(height, width, values)?;
            Grid::from_fn(width, height, |x, y| columns[(y, x)])
        }
    };
    let dtype = dtype.trim_matches('\'').to_owned();
    Ok(LoadedImage {
        values,
        interpretation: format!("{interpretation} of the type {dtype}"),
        saturated: None,
    })
}

#[expect(clippy::cast_possible_truncation, reason = "pixels are stored as f32")]
fn read_values(file: NpyFile<impl Read>) -> Result<(Vec<f32>, &'static str), ImageError> {
    let real = "values";
    let file = match file.try_data::<f32>() {
        Ok(data) => return Ok((collect(data, |value| value)?, real)),
        Err(file) => file,
    };
    let file = match file.try_data::<f64>() {
        Ok(data) => return Ok((collect(data, |value| value as f32)?, real)),
        Err(file) => file,
    };
    let file = match file.try_data::<u8>() {
        Ok(data) => return Ok((collect(data, f32::from)?, real)),
        Err(file) => file,
    };
    let file = match file.try_data::<u16>() {
        Ok(data) => return Ok((collect(data, f32::from)?, real)),
        Err(file) => file,
    };
    let squared = "squared magnitudes";
    let file = match file.try_data::<Complex<f32>>() {
        Ok(data) => return Ok((collect(data, intensity)?, squared)),
        Err(file) => file,
    };
    match file.try_data::<Complex<f64>>() {
        Ok(data) => Ok((collect(data, |value| value.norm_sqr() as f32)?, squared)),
        Err(file) => Err(ImageError::ValueType(file.dtype().descr())),
    }
}

fn collect<T>(
    data: impl Iterator<Item = std::io::Result<T>>,
    convert: impl Fn(T) -> f32,
) -> Result<Vec<f32>, ImageError> {
    data.map(|value| value.map(&convert).map_err(ImageError::Npy))
        .collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn real_values_survive_bit_by_bit() {
        let image = Grid::from_fn(5, 3, |x, y| 0.1 + x as f32 / (y as f32 + 3.0));
        let mut file = Vec::new();
        write_npy_f32(&mut file, &image).expect("written");
        let back = read(&file[..]).expect("an NPY file");
        assert_eq!(back.values, image);
        assert_eq!(back.interpretation, "values of the type <f4");
    }

    #[test]
    fn the_file_is_what_numpy_writes() {
        // np.save of np.array([[1, 2, 3], [4, 5, 6]], 'f4'), format version 1.0: magic, version,
        // length of the header, the header padded to a multiple of 64, then the data.
        let image = Grid::from_fn(3, 2, |x, y| (1 + x + 3 * y) as f32);
        let mut file = Vec::new();
        write_npy_f32(&mut file, &image).expect("written");
        assert_eq!(&file[..8], b"\x93NUMPY\x01\x00");
        let data_at = 10 + usize::from(u16::from_le_bytes([file[8], file[9]]));
        let header = String::from_utf8_lossy(&file[10..data_at]);
        for entry in ["'descr': '<f4'", "'fortran_order': False", "'shape': (2, 3"] {
            assert!(header.contains(entry), "{entry} is in {header}");
        }
        assert_eq!(data_at % 16, 0);
        assert_eq!(file.len(), data_at + 6 * 4);
        assert_eq!(
            &file[data_at..data_at + 8],
            [1.0_f32.to_le_bytes(), 2.0_f32.to_le_bytes()].concat()
        );
    }

    #[test]
    fn complex_amplitudes_are_read_as_intensities() {
        let image = Grid::from_fn(2, 2, |x, y| Complex::new(x as f32, 3.0 * y as f32));
        let mut file = Vec::new();
        write_npy_complex(&mut file, &image).expect("written");
        let back = read(&file[..]).expect("an NPY file");
        assert_eq!(back.values.values(), [0.0, 1.0, 9.0, 10.0]);
    }

    #[test]
    fn fortran_order_and_other_types_are_understood() {
        let mut file = Vec::new();
        let mut writer = npyz::WriteOptions::new()
            .default_dtype()
            .shape(&[2, 3])
            .order(Order::Fortran)
            .writer(&mut file)
            .begin_nd()
            .expect("a header");
        // Column by column of [[1, 2, 3], [4, 5, 6]].
        writer.extend([1_u16, 4, 2, 5, 3, 6]).expect("data");
        writer.finish().expect("an end");
        let back = read(&file[..]).expect("an NPY file");
        assert_eq!((back.values.width(), back.values.height()), (3, 2));
        assert_eq!(back.values.values(), [1.0, 2.0, 3.0, 4.0, 5.0, 6.0]);
    }

    fn header_only(shape: &[u64]) -> Vec<u8> {
        let mut file = Vec::new();
        npyz::WriteOptions::<f32>::new()
            .default_dtype()
            .shape(shape)
            .writer(&mut file)
            .write_header_only()
            .expect("a header");
        file
    }

    #[test]
    fn shapes_that_are_no_image_are_refused() {
        let read_shape = |shape: &[u64]| read(&header_only(shape)[..]).map(|_| ());
        assert!(
            matches!(read_shape(&[4]), Err(ImageError::Shape(_))),
            "a line"
        );
        assert!(
            matches!(read_shape(&[0, 4]), Err(ImageError::Size { .. })),
            "nothing"
        );
        assert!(
            matches!(
                read_shape(&[1_000_000, 1_000_000]),
                Err(ImageError::Size { .. })
            ),
            "too large"
        );
        assert!(
            matches!(read_shape(&[4, 4]), Err(ImageError::Npy(_))),
            "data is missing"
        );
    }

    #[test]
    fn unknown_types_are_named() {
        let mut file = Vec::new();
        let mut writer = npyz::WriteOptions::new()
            .default_dtype()
            .shape(&[1, 2])
            .writer(&mut file)
            .begin_nd()
            .expect("a header");
        writer.extend([1_i64, 2]).expect("data");
        writer.finish().expect("an end");
        let error = read(&file[..]).expect_err("i8 is not supported");
        assert!(error.to_string().contains("i8"), "{error}");
    }
}
