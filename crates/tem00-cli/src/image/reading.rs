//! Reading an image as one value per pixel.

use std::path::Path;

use tem00_numerics::Grid;
use tem00_tracer::Crop;

use super::{
    common::{Format, ImageError, LoadedImage, Reading, check_inside, name_of, open},
    exr_file, npy_file,
    raw_file::{self, RawFormat},
};

/// Reads an image of any of the formats as one value per pixel, in proportion to the light.
///
/// # Errors
///
/// Returns an error if the file cannot be read, is none of the formats, is empty or too large, does not
/// have the part or the channel wanted, or holds a value that is no amount of light.
pub(crate) fn read_image(path: &Path, reading: &Reading<'_>) -> Result<LoadedImage, ImageError> {
    let image = match Format::of_path(path) {
        Some(Format::Exr) => cropped(exr_file::read(open(path)?, reading.channel)?, reading.crop),
        Some(Format::Npy) => cropped(npy_file::read(open(path)?)?, reading.crop),
        Some(Format::Png) | None => grey_values(path, reading),
    }?;
    check_values(&image.values)?;
    Ok(image)
}

/// Reads an image of grey values.
fn grey_values(path: &Path, reading: &Reading<'_>) -> Result<LoadedImage, ImageError> {
    let format = RawFormat::of_path(path).ok_or_else(|| ImageError::Format(name_of(path)))?;
    let whole = raw_file::read_samples(path, format)?;
    let part = match reading.crop {
        Some(crop) => whole.cropped(crop)?,
        None => whole,
    };
    part.light(reading.channel, reading.transfer)
}

/// Returns the part of an image in a rectangle.
fn cropped(image: LoadedImage, crop: Option<Crop>) -> Result<LoadedImage, ImageError> {
    let Some(crop) = crop else {
        return Ok(image);
    };
    let values = &image.values;
    check_inside(crop, [values.width(), values.height()])?;
    let at = |x: usize, y: usize| values[(crop.x + x, crop.y + y)];
    Ok(LoadedImage {
        values: Grid::from_fn(crop.width, crop.height, at),
        ..image
    })
}

fn check_values(values: &Grid<f32>) -> Result<(), ImageError> {
    let bad = |value: &&f32| !(value.is_finite() && **value >= 0.0);
    for (y, row) in values.rows().enumerate() {
        if let Some((x, &value)) = row.iter().enumerate().find(|(_, value)| bad(value)) {
            return Err(ImageError::Value { x, y, value });
        }
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn light_is_finite_and_not_negative() {
        let with = |value| {
            check_values(&Grid::from_fn(3, 2, |x, y| {
                if (x, y) == (1, 1) { value } else { 0.5 }
            }))
        };
        assert!(with(0.0).is_ok(), "darkness is allowed");
        for bad in [-1.0, f32::NAN, f32::INFINITY] {
            assert!(
                matches!(with(bad), Err(ImageError::Value { x: 1, y: 1, .. })),
                "{bad} is found where it is"
            );
        }
    }

    #[test]
    fn a_file_that_is_not_what_its_name_says_is_an_error() {
        let folder = tempfile::tempdir().expect("a temporary folder");
        for name in [
            "a.png", "a.tif", "a.jpg", "a.bmp", "a.pgm", "a.exr", "a.npy", "a.txt",
        ] {
            let path = folder.path().join(name);
            std::fs::write(&path, "no image at all").expect("the file is written");
            assert!(read_image(&path, &Reading::default()).is_err(), "{name}");
        }
        let missing = read_image(&folder.path().join("b.png"), &Reading::default());
        assert!(missing.is_err(), "missing");
    }
}
