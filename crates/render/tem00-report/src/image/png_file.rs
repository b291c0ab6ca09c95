use std::io::Write;

use png::{BitDepth, ColorType, Encoder, ScaledFloat, SrgbRenderingIntent};
use tem00_numerics::Grid;

use super::{common::ImageError, png_data};
use crate::colour::srgb_encoded;

/// Writes linear sRGB components in [0, 1] as 16-bit sRGB; larger ones become 1.
///
/// Each pair of `text` becomes a text chunk.
pub fn write_rgb_png(
    writer: impl Write,
    image: &Grid<[f32; 3]>,
    text: &[(&str, String)],
) -> Result<(), ImageError> {
    let sixteen = |pixel: [f32; 3]| {
        pixel.map(|component| sixteen_bits(srgb_encoded(component.clamp(0.0, 1.0).into())))
    };
    let data = converted(image, sixteen);
    let data = data.values().as_flattened().as_flattened();
    let size = [image.width(), image.height()];
    let kind = (ColorType::Rgb, BitDepth::Sixteen);
    write_png(writer, size, kind, text, data, |encoder| {
        encoder.set_source_srgb(SrgbRenderingIntent::RelativeColorimetric);
    })
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
    let data = converted(image, |value| sixteen_bits((value / white).into()));
    let data = data.values().as_flattened();
    let size = [image.width(), image.height()];
    let kind = (ColorType::Grayscale, BitDepth::Sixteen);
    write_png(writer, size, kind, text, data, |encoder| {
        encoder.set_source_gamma(ScaledFloat::new(1.0));
    })
}

/// Writes a PNG file from the bytes of its pixels, with text chunks and the settings that `more`
/// makes in the encoder.
pub(crate) fn write_png<'a, W: Write>(
    writer: W,
    size: [usize; 2],
    (colour, depth): (ColorType, BitDepth),
    text: &[(&str, String)],
    data: &[u8],
    more: impl FnOnce(&mut Encoder<'a, W>),
) -> Result<(), ImageError> {
    let [width, height] = size.map(|pixels| u32::try_from(pixels).unwrap_or(u32::MAX));
    let mut encoder = Encoder::new(writer, width, height);
    encoder.set_color(colour);
    encoder.set_depth(depth);
    more(&mut encoder);
    for (keyword, content) in text {
        encoder.add_itxt_chunk((*keyword).to_owned(), content.clone())?;
    }
    let mut writer = encoder.write_header()?;
    let pixel = colour.samples() * if depth == BitDepth::Sixteen { 2 } else { 1 };
    png_data::compress(data, size[0] * pixel, pixel, |piece| {
        writer.write_chunk(png::chunk::IDAT, piece)
    })?;
    Ok(writer.finish()?)
}

/// Returns the stored form of each pixel.
fn converted<T: Copy + Sync, U: Clone + Default + Send>(
    image: &Grid<T>,
    stored: impl Fn(T) -> U + Sync,
) -> Grid<U> {
    let mut result = Grid::filled(image.width(), image.height(), U::default());
    result.for_each_row_mut(|y, row| {
        for (stored_pixel, &pixel) in row.iter_mut().zip(image.row(y)) {
            *stored_pixel = stored(pixel);
        }
    });
    result
}

#[expect(
    clippy::cast_possible_truncation,
    clippy::cast_sign_loss,
    reason = "the rounded value lies in [0, 65535]"
)]
fn sixteen_bits(value: f64) -> [u8; 2] {
    ((value.clamp(0.0, 1.0) * f64::from(u16::MAX)).round() as u16).to_be_bytes()
}

#[cfg(test)]
mod tests {
    use std::io::Cursor;

    use approx::assert_abs_diff_eq;
    use png::Decoder;
    use tem00_testkit::Numbers;

    use super::super::{LoadedImage, RawFormat, Reading, Transfer, raw_file::decode};
    use super::*;
    use crate::npy::tests::hex;

    fn read(file: &[u8], reading: Reading<'_>) -> Result<LoadedImage, ImageError> {
        let samples = decode(Cursor::new(file), RawFormat::Png)?;
        samples.judged(None)?.light(&reading)
    }

    fn read_back(file: &[u8]) -> LoadedImage {
        read(file, Reading::default()).expect("the file is a PNG")
    }

    fn written(image: &Grid<[f32; 3]>) -> Vec<u8> {
        let mut file = Vec::new();
        write_rgb_png(&mut file, image, &[]).expect("written");
        file
    }

    fn of(channel: &str) -> Reading<'_> {
        Reading {
            channel: Some(channel),
            ..Reading::default()
        }
    }

    #[test]
    fn grey_survives_with_half_a_step_of_rounding() {
        let image = Grid::from_fn(5, 3, |x, y| 0.7 * x as f32 + 0.1 * y as f32);
        let mut file = Vec::new();
        let text = [("scale", "4 is white".to_owned())];
        write_grey_png(&mut file, &image, 4.0, &text).expect("written");
        let back = read_back(&file);
        for (got, expected) in back.values.values().iter().zip(image.values()) {
            // Half of 1/65535, and f32 rounding of 6e-8.
            assert_abs_diff_eq!(4.0 * got, expected, epsilon = 4.0 * 7.8e-6);
        }
        assert_eq!(back.saturated, Some(0.0));
        let mut reader = Decoder::new(Cursor::new(&file)).read_info().expect("a PNG");
        reader.finish().expect("a whole PNG");
        let chunk = &reader.info().utf8_text[0];
        assert_eq!(chunk.keyword, "scale");
        assert_eq!(chunk.get_text().ok().as_deref(), Some("4 is white"));
    }

    #[test]
    fn colour_is_stored_by_the_srgb_curve_and_read_back_linear() {
        let image = Grid::from_fn(4, 2, |x, y| [0.25 * x as f32, 0.5 * y as f32, 0.1]);
        let file = written(&image);
        for (index, name) in ["R", "g", "B"].into_iter().enumerate() {
            let back = read(&file, of(name)).expect("a channel");
            for (got, pixel) in back.values.values().iter().zip(image.values()) {
                // Half a step of 1/65535 where the curve's inverse has its largest slope, 2.27.
                assert_abs_diff_eq!(*got, pixel[index], epsilon = 1.8e-5);
            }
        }
        let mean = read_back(&file).values[(3, 1)];
        assert_abs_diff_eq!(mean, (0.75 + 0.5 + 0.1) / 3.0, epsilon = 1.8e-5);
        // 0.735357 is the sRGB value of 0.5.
        let linear = Reading {
            transfer: Some(Transfer::Linear),
            ..of("G")
        };
        let stored = read(&file, linear).expect("green").values[(0, 1)];
        assert_abs_diff_eq!(stored, 0.735_357, epsilon = 1e-5);
        let missing = read(&file, of("Z"));
        assert!(
            matches!(missing, Err(ImageError::Channel { .. })),
            "{missing:?}"
        );
    }

    #[test]
    fn images_of_several_pieces_are_read_back_as_they_were() {
        // Bytes that cannot be compressed, and a ramp.
        let mut numbers = Numbers::new(1);
        for (colour, depth, pixel) in [
            (ColorType::Grayscale, BitDepth::Eight, 1_usize),
            (ColorType::Rgba, BitDepth::Eight, 4),
            (ColorType::Rgb, BitDepth::Sixteen, 6),
        ] {
            let [width, height] = [700, 3_000_000 / 700 / pixel];
            let noise = (0..width * height * pixel).map(|_| numbers.bits().to_be_bytes()[0]);
            let mut data: Vec<u8> = noise.collect();
            let ramp = (0..width * pixel).map(|x| x.to_le_bytes()[0]);
            data.extend(ramp);
            let mut file = Vec::new();
            let size = [width, height + 1];
            write_png(&mut file, size, (colour, depth), &[], &data, |_| {}).expect("written");
            let mut reader = Decoder::new(Cursor::new(&file)).read_info().expect("a PNG");
            let mut back = vec![0; data.len()];
            reader.next_frame(&mut back).expect("whole");
            assert!(back == data, "{colour:?}");
        }
    }

    #[test]
    fn too_bright_is_white_and_counted() {
        let image = Grid::from_fn(10, 10, |x, _| if x < 3 { 2.0 } else { 0.5 });
        let mut file = Vec::new();
        write_grey_png(&mut file, &image, 1.0, &[]).expect("written");
        let back = read_back(&file);
        assert_eq!(back.saturated, Some(0.3));
        assert_abs_diff_eq!(back.values[(0, 0)], 1.0);
    }

    #[test]
    fn eight_bit_files_without_a_curve_are_taken_as_linear() {
        let mut file = Vec::new();
        let kind = (ColorType::Rgba, BitDepth::Eight);
        let data = [51, 102, 153, 9, 255, 0, 0, 9];
        write_png(&mut file, [2, 1], kind, &[], &data, |_| {}).expect("written");
        let back = read_back(&file);
        assert_abs_diff_eq!(back.values[(0, 0)], 0.4, epsilon = 1e-7);
        assert_abs_diff_eq!(back.values[(1, 0)], 1.0 / 3.0, epsilon = 1e-7);
        assert_eq!(back.saturated, Some(0.5));
    }

    #[test]
    fn channels_that_differ_are_named() {
        for (blue, reading, differ) in [
            (0.4, Reading::default(), true),
            (0.3, Reading::default(), false),
            (0.4, of("B"), false),
        ] {
            let image = Grid::from_fn(3, 3, |x, _| [0.3, 0.3, if x == 2 { blue } else { 0.3 }]);
            let told = read(&written(&image), reading)
                .expect("a PNG")
                .interpretation;
            assert_eq!(told.contains("differ"), differ, "{blue}: {told}");
        }
    }

    /// A grey file of two pixels of 8 bits with chunks before its image: `kind:content`, the
    /// content in hexadecimal digits.
    fn with_chunks(chunks: &str) -> Vec<u8> {
        let mut file = Vec::new();
        let mut writer = Encoder::new(&mut file, 2, 1)
            .write_header()
            .expect("a header");
        for chunk in chunks.split_whitespace() {
            let (kind, content) = chunk.split_once(':').expect("a content");
            let kind = kind.as_bytes().try_into().expect("four letters");
            let kind = png::chunk::ChunkType(kind);
            writer.write_chunk(kind, &hex(content)).expect("a chunk");
        }
        writer.write_image_data(&[51, 255]).expect("data");
        writer.finish().expect("an end");
        file
    }

    #[test]
    fn the_curve_of_a_file_is_undone_or_said() {
        let start = b"p\0\0".to_vec();
        let mut packed = flate2::write::ZlibEncoder::new(start, flate2::Compression::fast());
        packed.write_all(b"any profile").expect("memory");
        let profile = packed.finish().expect("memory");
        let profile: String = profile.iter().map(|byte| format!("{byte:02x}")).collect();
        // Chunks, the result for 0.2, and the message.
        let table = "
            => linear => taken as linear, the file does not say
            gAMA:0000b18f => power => gamma 0.45455 undone
            gAMA:000186a0 => linear => gamma 1 undone
            sRGB:00 => sRGB => sRGB curve undone, as the file says
            gAMA:000186a0 sRGB:00 => sRGB => sRGB curve undone
            cICP:010d0001 => sRGB => sRGB curve undone, as the file says
            sRGB:00 cICP:01080001 => linear => linear, as the file says
            gAMA:0000b18f cICP:01010001 => television => curve of BT.709 undone
            iCCP:PROFILE => linear => the colour profile of the file is not read";
        for [chunks, curve, part] in tem00_testkit::rows(&table.replace("PROFILE", &profile)) {
            // By x^2.2, IEC 61966-2-1 and BT.709.
            let expected = match &*curve {
                "power" => 0.2_f32.powf(2.2),
                "sRGB" => ((0.2_f32 + 0.055) / 1.055).powf(2.4),
                "television" => ((0.2_f32 + 0.099) / 1.099).powf(1.0 / 0.45),
                _ => 0.2,
            };
            let file = with_chunks(&chunks);
            let image = read_back(&file);
            assert_abs_diff_eq!(image.values[(0, 0)], expected, epsilon = 2e-6);
            assert!(image.interpretation.contains(&part), "{image:?}");
            let samples = decode(Cursor::new(&file), RawFormat::Png).expect("two pixels");
            let raw = samples.judged(None).and_then(|samples| samples.image(None));
            let raw = raw.expect("two pixels");
            let is_curved = curve != "linear" || part.contains("profile");
            let is_said = raw.interpretation.contains("as they are");
            assert_eq!(is_said, is_curved, "{raw:?}");
            assert_abs_diff_eq!(raw.values[(0, 0)], 51.0);
        }
        // The perceptual quantiser.
        let file = with_chunks("cICP:09100001");
        let told = read(&file, Reading::default()).expect_err("it is not known");
        let told = told.to_string();
        let is_told = told.contains("function 16") && told.contains("--transfer linear");
        assert!(is_told, "{told}");
        let linear = Reading {
            transfer: Some(Transfer::Linear),
            ..Reading::default()
        };
        assert!(read(&file, linear).is_ok(), "as asked");
    }

    #[test]
    fn parts_are_named_as_viewers_show_the_image() {
        // The orientation 8 in an EXIF entry, a quarter turn to the left.
        let exif = "4d4d002a000000080001 0112000300000001000800000000 0000";
        let file = with_chunks(&format!("eXIf:{}", exif.replace(' ', "")));
        let samples = decode(Cursor::new(&file), RawFormat::Png).expect("two pixels");
        let upright = samples.upright().judged(None).expect("two pixels");
        let light = upright.light(&Reading::default()).expect("light");
        assert_eq!((light.values.width(), light.values.height()), (1, 2));
        assert_abs_diff_eq!(light.values[(0, 0)], 1.0);
        assert!(light.interpretation.contains("turned"), "{light:?}");
    }
}
