use std::io::Write;

use png::{BitDepth, ColorType, Encoder, ScaledFloat, SrgbRenderingIntent};
use tem00_numerics::Grid;

use super::common::ImageError;
use crate::colour::srgb_encoded;

/// Writes linear sRGB components in [0, 1] as 16-bit sRGB; larger ones become 1.
///
/// Each pair of `text` becomes a text chunk.
pub fn write_rgb_png(
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
pub fn write_grey_png(
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

    use super::super::{LoadedImage, RawFormat, Reading, Transfer, raw_file::decode};
    use super::*;

    fn read(
        file: &[u8],
        channel: Option<&str>,
        transfer: Option<Transfer>,
    ) -> Result<LoadedImage, ImageError> {
        let reading = Reading {
            channel,
            transfer,
            ..Reading::default()
        };
        let samples = decode(Cursor::new(file), RawFormat::Png)?.judged(None)?;
        samples.light(&reading)
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

    /// The kind and the content of a chunk.
    type Chunk<'a> = (&'a [u8; 4], &'a [u8]);

    /// A grey file of two pixels of 8 bits with chunks before its image.
    fn with_chunks(chunks: &[Chunk<'_>]) -> Vec<u8> {
        let mut file = Vec::new();
        let mut writer = Encoder::new(&mut file, 2, 1)
            .write_header()
            .expect("a header");
        for (kind, content) in chunks {
            let kind = png::chunk::ChunkType(**kind);
            writer.write_chunk(kind, content).expect("a chunk");
        }
        writer.write_image_data(&[51, 255]).expect("data");
        writer.finish().expect("an end");
        file
    }

    #[test]
    fn the_curve_of_a_file_is_undone_or_said() {
        let mut packed =
            flate2::write::ZlibEncoder::new(b"p\0\0".to_vec(), flate2::Compression::fast());
        packed.write_all(b"any profile").expect("memory");
        let profile = packed.finish().expect("memory");
        let [gamma, one] = [45_455_u32, 100_000].map(u32::to_be_bytes);
        // 0.2 by each curve: x^2.2, IEC 61966-2-1, BT.709.
        let srgb = ((0.2_f32 + 0.055) / 1.055).powf(2.4);
        let television = ((0.2_f32 + 0.099) / 1.099).powf(1.0 / 0.45);
        let cases: [(&[Chunk<'_>], f32, &str); 9] = [
            (&[], 0.2, "taken as linear, the file does not say"),
            (
                &[(b"gAMA", &gamma)],
                0.2_f32.powf(2.2),
                "gamma 0.45455 undone",
            ),
            (&[(b"gAMA", &one)], 0.2, "gamma 1 undone"),
            (
                &[(b"sRGB", &[0])],
                srgb,
                "sRGB curve undone, as the file says",
            ),
            (
                &[(b"gAMA", &one), (b"sRGB", &[0])],
                srgb,
                "sRGB curve undone",
            ),
            (
                &[(b"cICP", &[1, 13, 0, 1])],
                srgb,
                "sRGB curve undone, as the file says",
            ),
            (
                &[(b"sRGB", &[0]), (b"cICP", &[1, 8, 0, 1])],
                0.2,
                "linear, as the file says",
            ),
            (
                &[(b"gAMA", &gamma), (b"cICP", &[1, 1, 0, 1])],
                television,
                "curve of BT.709 undone",
            ),
            (
                &[(b"iCCP", &profile)],
                0.2,
                "the colour profile of the file is not read",
            ),
        ];
        for (chunks, expected, part) in cases {
            let file = with_chunks(chunks);
            let image = read(&file, None, None).expect("two pixels");
            assert_abs_diff_eq!(image.values[(0, 0)], expected, epsilon = 2e-6);
            assert!(
                image.interpretation.contains(part),
                "{}",
                image.interpretation
            );
            let samples = decode(Cursor::new(&file), RawFormat::Png).expect("two pixels");
            let raw = samples
                .judged(None)
                .and_then(|samples| samples.image(None))
                .expect("raw");
            let is_curved = (expected - 0.2).abs() > 1e-3 || part.contains("profile");
            assert_eq!(
                raw.interpretation.contains("as they are"),
                is_curved,
                "{raw:?}"
            );
            assert_abs_diff_eq!(raw.values[(0, 0)], 51.0);
        }
        // The perceptual quantiser.
        let file = with_chunks(&[(b"cICP", &[9, 16, 0, 1])]);
        let told = read(&file, None, None)
            .expect_err("it is not known")
            .to_string();
        assert!(
            told.contains("function 16") && told.contains("--transfer linear"),
            "{told}"
        );
        assert!(
            read(&file, None, Some(Transfer::Linear)).is_ok(),
            "as asked"
        );
    }

    #[test]
    fn parts_are_named_as_viewers_show_the_image() {
        // The orientation 8 in an EXIF entry, a quarter turn to the left.
        let exif = b"MM\0*\0\0\0\x08\0\x01\x01\x12\0\x03\0\0\0\x01\0\x08\0\0\0\0\0\0";
        let file = with_chunks(&[(b"eXIf", exif)]);
        let samples = decode(Cursor::new(&file), RawFormat::Png).expect("two pixels");
        let upright = samples.upright().judged(None).expect("two pixels");
        let light = upright.light(&Reading::default()).expect("light");
        assert_eq!((light.values.width(), light.values.height()), (1, 2));
        assert_abs_diff_eq!(light.values[(0, 0)], 1.0);
        assert!(
            light.interpretation.contains("turned"),
            "{}",
            light.interpretation
        );
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
