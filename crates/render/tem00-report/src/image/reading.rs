//! Reading an image as one value per pixel.

use std::path::Path;

use tem00_numerics::Grid;

use super::{
    common::{Format, ImageError, LoadedImage, Reading, name_of, open},
    exr_reader, npy_file,
    raw_file::{self, RawFormat},
};

/// Reads an image of any of the formats as one value per pixel, in proportion to the light.
///
/// # Errors
///
/// Returns an error if the file cannot be read, has none of the formats, is empty or too large,
/// lacks the requested part or channel, or holds a value that is not an amount of light.
pub fn read_image(path: &Path, reading: &Reading<'_>) -> Result<LoadedImage, ImageError> {
    let mut reading = *reading;
    let samples = match Format::of_path(path) {
        // OpenEXR files may have any number of channels: their reader chooses.
        Some(Format::Exr) => exr_reader::read(open(path)?, reading.channel.take())?,
        Some(Format::Npy) => npy_file::read(open(path)?)?,
        Some(Format::Png) | None => {
            let format =
                RawFormat::of_path(path).ok_or_else(|| ImageError::Format(name_of(path)))?;
            raw_file::read_samples(path, format)?
        }
    };
    // Parts are named as viewers show the image.
    let whole = samples.upright().judged(None)?;
    let part = match reading.crop {
        Some(crop) => whole.cropped(crop)?,
        None => whole,
    };
    let image = part.light(&reading)?;
    check_values(&image.values, reading.black_level.is_some())?;
    Ok(image)
}

/// Checks that values are amounts of light; above a black level noise may be negative.
fn check_values(values: &Grid<f32>, above_black: bool) -> Result<(), ImageError> {
    let bad = |value: &&f32| !(value.is_finite() && (above_black || **value >= 0.0));
    for (y, row) in values.rows().enumerate() {
        if let Some((x, &value)) = row.iter().enumerate().find(|(_, value)| bad(value)) {
            let help = if value < 0.0 {
                "; noise about a black level may be below it: --black-level 0 takes it as it is"
            } else {
                ""
            };
            return Err(ImageError::Value { x, y, value, help });
        }
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn light_is_finite_and_not_negative() {
        let grid = |value| {
            let at = |x, y| if (x, y) == (1, 1) { value } else { 0.5 };
            Grid::from_fn(3, 2, at)
        };
        let with = |value| check_values(&grid(value), false);
        assert!(with(0.0).is_ok(), "darkness is allowed");
        assert!(check_values(&grid(-1.0), true).is_ok(), "noise");
        assert!(check_values(&grid(f32::NAN), true).is_err(), "no number");
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
