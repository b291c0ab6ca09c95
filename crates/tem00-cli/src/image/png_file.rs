use std::io::Write;

use png::{BitDepth, ColorType, Encoder, ScaledFloat, SrgbRenderingIntent};
use tem00_numerics::Grid;

use super::common::ImageError;
use crate::colour::srgb_encoded;

/// Writes linear sRGB components in [0, 1] as 16-bit sRGB; larger ones become 1.
///
/// Each pair of `text` becomes a text chunk.
pub(crate) fn write_rgb_png(
    writer: impl Write,
    image: &Grid<[f32; 3]>,
    text: &[(&str, String)],
) -> Result<(), ImageError> {
    let mut encoder = encoder(writer, image, ColorType::Rgb, text)?;
    encoder.set_source_srgb(SrgbRenderingIntent::RelativeColorimetric);
    let mut data = Vec::with_capacity(6 * image.values().len());
    for component in image.values().iter().flatten() {
        let encoded = srgb_encoded(f64::from(component.clamp(0.0, 1.0)));
        data.extend(sixteen_bits(encoded).to_be_bytes());
    }
    finish(encoder, &data)
}

/// Writes values as 16-bit grey in proportion to them, 0 black and `white` white; larger ones
/// become white.
///
/// The file states gamma 1, so that viewers that follow it show the right brightness.
pub(crate) fn write_grey_png(
    writer: impl Write,
    image: &Grid<f32>,
    white: f32,
    text: &[(&str, String)],
) -> Result<(), ImageError> {
    let mut encoder = encoder(writer, image, ColorType::Grayscale, text)?;
    encoder.set_source_gamma(ScaledFloat::new(1.0));
    let mut data = Vec::with_capacity(2 * image.values().len());
    for value in image.values() {
        data.extend(sixteen_bits(f64::from(value / white)).to_be_bytes());
    }
    finish(encoder, &data)
}

fn encoder<'a, W: Write, T>(
    writer: W,
    image: &Grid<T>,
    colour: ColorType,
    text: &[(&str, String)],
) -> Result<Encoder<'a, W>, ImageError> {
    let size = |pixels: usize| u32::try_from(pixels).unwrap_or(u32::MAX);
    let mut encoder = Encoder::new(writer, size(image.width()), size(image.height()));
    encoder.set_color(colour);
    encoder.set_depth(BitDepth::Sixteen);
    for (keyword, content) in text {
        encoder.add_itxt_chunk((*keyword).to_owned(), content.clone())?;
    }
    Ok(encoder)
}

fn finish<W: Write>(encoder: Encoder<'_, W>, data: &[u8]) -> Result<(), ImageError> {
    let mut writer = encoder.write_header()?;
    writer.write_image_data(data)?;
    Ok(writer.finish()?)
}

#[expect(
    clippy::cast_possible_truncation,
    clippy::cast_sign_loss,
    reason = "the rounded value lies in [0, 65535]"
)]
fn sixteen_bits(value: f64) -> u16 {
    (value.clamp(0.0, 1.0) * f64::from(u16::MAX)).round() as u16
}

#[cfg(test)]
mod tests {
    use std::io::Cursor;

    use approx::assert_abs_diff_eq;
    use png::Decoder;

    use super::super::{LoadedImage, RawFormat, Transfer, raw_file::decode};
    use super::*;

    fn read(
        file: &[u8],
        channel: Option<&str>,
        transfer: Option<Transfer>,
    ) -> Result<LoadedImage, ImageError> {
        decode(Cursor::new(file), RawFormat::Png)?.light(channel, transfer)
    }

    fn read_back(file: Vec<u8>, channel: Option<&str>, transfer: Option<Transfer>) -> LoadedImage {
        read(&file, channel, transfer).expect("the file is a PNG")
    }

    fn text_of(file: &[u8]) -> Vec<(String, String)> {
        let mut reader = Decoder::new(Cursor::new(file)).read_info().expect("a PNG");
        reader.finish().expect("a whole PNG");
        let chunks = &reader.info().utf8_text;
        chunks
            .iter()
            .map(|chunk| (chunk.keyword.clone(), chunk.get_text().expect("UTF-8")))
            .collect()
    }

    #[test]
    fn grey_survives_with_half_a_step_of_rounding() {
        let image = Grid::from_fn(5, 3, |x, y| 0.7 * x as f32 + 0.1 * y as f32);
        let mut file = Vec::new();
        write_grey_png(&mut file, &image, 4.0, &[("scale", "4 is white".into())]).expect("written");

        let back = read_back(file.clone(), None, None);
        for (got, expected) in back.values.values().iter().zip(image.values()) {
            // Half of 1/65535, and f32 rounding of 6e-8.
            assert_abs_diff_eq!(4.0 * got, expected, epsilon = 4.0 * 7.8e-6);
        }
        assert_eq!(back.saturated, Some(0.0));
        assert_eq!(
            text_of(&file),
            [("scale".to_owned(), "4 is white".to_owned())]
        );
    }

    #[test]
    fn colour_is_stored_by_the_srgb_curve_and_read_back_linear() {
        let image = Grid::from_fn(4, 2, |x, y| [0.25 * x as f32, 0.5 * y as f32, 0.1]);
        let mut file = Vec::new();
        write_rgb_png(&mut file, &image, &[]).expect("written");

        for (index, name) in ["R", "g", "B"].into_iter().enumerate() {
            let back = read_back(file.clone(), Some(name), None);
            for (got, pixel) in back.values.values().iter().zip(image.values()) {
                // Half a step of 1/65535 where the curve's inverse has its largest slope, 2.27.
                assert_abs_diff_eq!(*got, pixel[index], epsilon = 1.8e-5);
            }
        }
        let mean = read_back(file.clone(), None, None);
        assert_abs_diff_eq!(
            mean.values[(3, 1)],
            (0.75 + 0.5 + 0.1) / 3.0,
            epsilon = 1.8e-5
        );
        // 0.735357 is the sRGB value of 0.5.
        let stored = read_back(file.clone(), Some("G"), Some(Transfer::Linear));
        assert_abs_diff_eq!(stored.values[(0, 1)], 0.735_357, epsilon = 1e-5);
        assert!(
            matches!(
                read(&file, Some("Z"), None),
                Err(ImageError::Channel { .. })
            ),
            "there is no channel Z"
        );
    }

    #[test]
    fn too_bright_is_white_and_counted() {
        let image = Grid::from_fn(10, 10, |x, _| if x < 3 { 2.0 } else { 0.5 });
        let mut file = Vec::new();
        write_grey_png(&mut file, &image, 1.0, &[]).expect("written");
        let back = read_back(file, None, None);
        assert_eq!(back.saturated, Some(0.3));
        assert_abs_diff_eq!(back.values[(0, 0)], 1.0);
    }

    #[test]
    fn eight_bit_files_without_a_curve_are_taken_as_linear() {
        let mut file = Vec::new();
        let mut encoder = Encoder::new(&mut file, 2, 1);
        encoder.set_color(ColorType::Rgba);
        let mut writer = encoder.write_header().expect("a header");
        writer
            .write_image_data(&[51, 102, 153, 9, 255, 0, 0, 9])
            .expect("data");
        writer.finish().expect("an end");

        let back = read_back(file, None, None);
        assert_abs_diff_eq!(back.values[(0, 0)], 0.4, epsilon = 1e-7);
        assert_abs_diff_eq!(back.values[(1, 0)], 1.0 / 3.0, epsilon = 1e-7);
        assert_eq!(back.saturated, Some(0.5));
    }

    #[test]
    fn channels_that_differ_are_named() {
        let said = |blue: f32, channel| {
            let image = Grid::from_fn(3, 3, |x, _| [0.3, 0.3, if x == 2 { blue } else { 0.3 }]);
            let mut file = Vec::new();
            write_rgb_png(&mut file, &image, &[]).expect("written");
            read_back(file, channel, None).interpretation
        };
        assert!(said(0.4, None).contains("differ"), "a blue pixel");
        assert!(!said(0.3, None).contains("differ"), "grey");
        assert!(!said(0.4, Some("B")).contains("differ"), "one channel");
    }

    #[test]
    fn a_cut_file_is_an_error() {
        let mut file = Vec::new();
        let image = Grid::from_fn(50, 50, |x, y| ((x * y) % 7) as f32);
        write_grey_png(&mut file, &image, 7.0, &[]).expect("written");
        for length in [0, 20, file.len() / 2] {
            assert!(read(&file[..length], None, None).is_err(), "{length} bytes");
        }
    }
}
