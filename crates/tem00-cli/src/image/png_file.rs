use std::io::{BufRead, Seek, Write};

use png::{
    BitDepth, ColorType, Decoder, Encoder, ScaledFloat, SrgbRenderingIntent, Transformations,
};
use tem00_numerics::Grid;

use super::selection::Selection;
use super::{ImageError, LoadedImage, Transfer, checked_area, grid};
use crate::colour::{srgb_decoded, srgb_encoded};

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

/// Reads a PNG file of any colour type and depth.
pub(super) fn read(
    reader: impl BufRead + Seek,
    channel: Option<&str>,
    transfer: Option<Transfer>,
) -> Result<LoadedImage, ImageError> {
    let mut decoder = Decoder::new(reader);
    decoder.set_transformations(Transformations::EXPAND);
    let mut reader = decoder.read_info()?;
    let (width, height) = (reader.info().width, reader.info().height);
    let area = checked_area(width.into(), height.into())?;
    let (colour, depth) = reader.output_color_type();
    let selection = Selection::new(colour.into(), channel)?;
    let curve = Curve::new(reader.info(), transfer);
    let full = if depth == BitDepth::Sixteen {
        u16::MAX
    } else {
        u8::MAX.into()
    };

    let mut pixels = Pixels {
        values: Vec::with_capacity(area),
        saturated: 0,
        coloured: false,
    };
    let mut line = vec![0; reader.output_line_size(width).unwrap_or(0)];
    if reader.info().interlaced {
        line.resize(reader.output_buffer_size().unwrap_or(0), 0);
        reader.next_frame(&mut line)?;
        pixels.extend(&line, &selection, &curve, full);
    } else {
        while reader.read_row(&mut line)?.is_some() {
            pixels.extend(&line, &selection, &curve, full);
        }
    }
    Ok(LoadedImage {
        values: grid(width as usize, height as usize, pixels.values)?,
        interpretation: interpretation(&selection, pixels.coloured, &curve),
        saturated: Some(share(pixels.saturated, area)),
    })
}

fn interpretation(selection: &Selection, coloured: bool, curve: &Curve) -> String {
    let channels = &selection.description;
    let differ = if coloured {
        ", which differ: light of one colour may want one channel"
    } else {
        ""
    };
    format!("{channels}{differ}, {}", curve.description())
}

#[expect(clippy::cast_precision_loss, reason = "there are at most 2²⁸ pixels")]
fn share(part: usize, whole: usize) -> f64 {
    part as f64 / whole as f64
}

/// The pixels read so far.
struct Pixels {
    values: Vec<f32>,
    saturated: usize,
    /// Whether the chosen channels differ anywhere.
    coloured: bool,
}

impl Pixels {
    #[expect(clippy::cast_possible_truncation, reason = "pixels are stored as f32")]
    fn extend(&mut self, data: &[u8], selection: &Selection, curve: &Curve, full: u16) {
        let bytes = if full > u8::MAX.into() { 2 } else { 1 };
        let component = |pixel: &[u8], index: usize| match pixel[bytes * index..][..bytes] {
            [high, low] => u16::from_be_bytes([high, low]),
            [value] => value.into(),
            _ => 0,
        };
        for pixel in data.chunks_exact(bytes * selection.components) {
            let chosen = || {
                selection
                    .chosen
                    .clone()
                    .map(|index| component(pixel, index))
            };
            let linear: f64 = chosen()
                .map(|value| curve.linear(f64::from(value) / f64::from(full)))
                .sum();
            let count = u32::try_from(selection.chosen.len()).map_or(1.0, f64::from);
            self.coloured |= chosen().any(|value| Some(value) != chosen().next());
            self.saturated += usize::from(chosen().any(|value| value == full));
            self.values.push((linear / count) as f32);
        }
    }
}

/// How the stored values relate to the light, and who says so.
enum Curve {
    Linear { told: bool },
    Srgb { told: bool },
    Gamma(f64),
}

impl Curve {
    fn new(info: &png::Info<'_>, transfer: Option<Transfer>) -> Self {
        match (transfer, info.srgb, info.gama_chunk) {
            (Some(Transfer::Linear), ..) => Self::Linear { told: true },
            (Some(Transfer::Srgb), ..) => Self::Srgb { told: true },
            (None, Some(_), _) => Self::Srgb { told: false },
            (None, None, Some(gamma)) if gamma.into_scaled() > 0 => {
                Self::Gamma(f64::from(gamma.into_scaled()) / 1e5)
            }
            (None, None, _) => Self::Linear { told: false },
        }
    }

    fn linear(&self, stored: f64) -> f64 {
        match self {
            Self::Linear { .. } => stored,
            Self::Srgb { .. } => srgb_decoded(stored),
            Self::Gamma(gamma) => stored.powf(1.0 / gamma),
        }
    }

    fn description(&self) -> String {
        match self {
            Self::Linear { told: true } => "linear, as told".into(),
            Self::Linear { told: false } => "taken as linear, the file does not say".into(),
            Self::Srgb { told: true } => "sRGB curve undone, as told".into(),
            Self::Srgb { told: false } => "sRGB curve undone, as the file says".into(),
            Self::Gamma(gamma) => format!("gamma {gamma} undone, as the file says"),
        }
    }
}

#[cfg(test)]
mod tests {
    use std::io::Cursor;

    use approx::assert_abs_diff_eq;

    use super::*;

    fn read_back(file: Vec<u8>, channel: Option<&str>, transfer: Option<Transfer>) -> LoadedImage {
        read(Cursor::new(file), channel, transfer).expect("the file is a PNG")
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
                read(Cursor::new(file), Some("Z"), None),
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
            assert!(
                read(Cursor::new(&file[..length]), None, None).is_err(),
                "{length} bytes"
            );
        }
    }
}
