mod camera_formats;
mod tiff_flavours;

use std::{fs, io::Cursor, path::PathBuf};

use png::{BitDepth, ColorType, Encoder};
use tem00_numerics::Grid;
use tiff::encoder::{TiffEncoder, colortype};

use super::*;
use crate::npy::tests::hex;

fn raw(file: &[u8], format: RawFormat, channel: Option<&str>) -> Result<RawImage, ImageError> {
    let samples = decode(Cursor::new(file), format)?;
    samples.judged(None)?.image(channel)
}

/// Returns the numbers of a text.
fn numbers(text: &str) -> Vec<f32> {
    text.split_whitespace()
        .filter_map(|word| word.parse().ok())
        .collect()
}

fn values(bit_depth: u32) -> Grid<u16> {
    let full = u16::MAX >> (16 - bit_depth);
    Grid::from_fn(7, 5, |x, y| match (x, y) {
        (6, 4) => full,
        _ => u16::try_from(x * 37 + y * 101).expect("a small number") % full,
    })
}

/// Writes a frame of `bit_depth` bits.
fn write(path: &Path, bit_depth: u32) -> Grid<u16> {
    let values = values(bit_depth);
    let frame = GreyFrame {
        values: &values,
        bit_depth,
    };
    let text = [("camera", "\u{e9}l\u{e8}ve \"7\"".to_owned())];
    write_raw(path, frame, &text).expect("the frame is written");
    values
}

fn folder() -> tempfile::TempDir {
    tempfile::tempdir().expect("a temporary folder")
}

/// Writes a PNG file of one row, with the bits of grey values in its chunk sBIT if there are any.
fn png(path: &PathBuf, colour: ColorType, values: &[u16], bits: &[u8]) {
    let mut file = Vec::new();
    let width = u32::try_from(values.len() / colour.samples()).expect("a short row");
    let mut encoder = Encoder::new(&mut file, width, 1);
    encoder.set_color(colour);
    encoder.set_depth(BitDepth::Sixteen);
    let mut writer = encoder.write_header().expect("a header");
    if !bits.is_empty() {
        writer.write_chunk(png::chunk::sBIT, bits).expect("a chunk");
    }
    let data: Vec<u8> = values
        .iter()
        .flat_map(|value| value.to_be_bytes())
        .collect();
    writer.write_image_data(&data).expect("an image");
    writer.finish().expect("an end");
    fs::write(path, file).expect("a file");
}

#[test]
fn frames_of_all_bit_depths_come_back_unchanged() {
    let folder = folder();
    for bit_depth in BIT_DEPTHS {
        for name in ["a.png", "a.tif", "a.TIFF"] {
            let path = folder.path().join(name);
            let values = write(&path, bit_depth);
            let back = read_raw(&path, None, None).expect("the frame is read");
            let expected = values.map(|&value| f32::from(value));
            assert_eq!(back.values, expected, "{name}, {bit_depth} bits");
            assert_eq!(back.bit_depth, Some(bit_depth), "{name}");
            let full = u16::MAX >> (16 - bit_depth);
            assert_eq!(back.saturated, values.map(|&value| value == full), "{name}");
        }
        // Eight bits take a byte, and more take two.
        let file = File::open(folder.path().join("a.png")).expect("the file");
        let reader = png::Decoder::new(std::io::BufReader::new(file)).read_info();
        let stored = reader.expect("a PNG").info().bit_depth as u32;
        assert_eq!(stored, if bit_depth == 8 { 8 } else { 16 });
    }
}

#[test]
fn values_that_other_programs_scaled_up_are_scaled_back() {
    let path = folder().keep().join("a.png");
    png(
        &path,
        ColorType::Grayscale,
        &[0x0010, 0x0AB0, 0xFFFF],
        &[12],
    );
    let image = read_raw(&path, None, None).expect("the frame is read");
    assert_eq!(image.values.values(), [1.0, 171.0, 4_095.0]);
    assert_eq!((image.bit_depth, image.saturated_pixels()), (Some(12), 1));
    assert!(image.interpretation.contains("scaled up"), "{image:?}");
}

#[test]
fn the_bits_of_a_camera_can_be_told() {
    let path = folder().keep().join("a.png");
    png(&path, ColorType::Grayscale, &[7, 1_023], &[]);
    let of = |bits| read_raw(&path, None, bits);
    // The file has 16 bits and no further information, but its values end at the largest value of
    // 10 bits.
    for (told, bits, saturated) in [
        (None, 16, 1),
        (Some(10), 10, 1),
        (Some(12), 12, 0),
        (Some(16), 16, 0),
    ] {
        let image = of(told).expect("the bits are enough");
        let found = (image.bit_depth, image.saturated_pixels());
        assert_eq!(found, (Some(bits), saturated), "{told:?}");
    }
    let refused = |bits| of(Some(bits)).expect_err("other bits").to_string();
    let told = refused(8);
    assert!(
        told.contains("at most 255, but there is one of 1023"),
        "{told}"
    );
    write(&path, 10);
    let told = refused(12);
    assert!(told.contains("have 10 bits"), "{told}");
}

#[test]
fn colours_are_chosen_or_averaged() {
    let path = folder().keep().join("a.png");
    png(&path, ColorType::Rgb, &[10, 20, 60, 65_535, 0, 0], &[]);
    let of = |channel| read_raw(&path, channel, None).expect("the frame is read");
    assert_eq!(of(None).values.values(), [30.0, 21_845.0]);
    assert_eq!(of(None).saturated_pixels(), 1, "one channel is enough");
    assert_eq!(of(Some("g")).values.values(), [20.0, 0.0]);
    assert_eq!(of(Some("g")).saturated_pixels(), 0, "another channel");
    let missing = read_raw(&path, Some("A"), None);
    assert!(
        matches!(missing, Err(ImageError::Channel { .. })),
        "{missing:?}"
    );

    let mut file = Cursor::new(Vec::new());
    let mut encoder = TiffEncoder::new(&mut file).expect("a header");
    let image = encoder.write_image::<colortype::RGB16>(2, 1, &[100, 200, 600, 3, 3, 3]);
    image.expect("an image");
    let of = |channel| raw(file.get_ref(), RawFormat::Tiff, channel).expect("the frame is read");
    assert_eq!(of(None).values.values(), [300.0, 3.0]);
    assert_eq!(of(Some("B")).values.values(), [600.0, 3.0]);
}

#[test]
fn what_is_no_frame_is_refused_in_words() {
    let folder = folder();
    for [name, content, part] in tem00_testkit::rows(
        "a.gif => => use .png, .tif, .jpg, .bmp or .pgm
        a.png => => not a readable PNG
        a.tif => II*\0 => TIFF
        b.tif => no image at all => TIFF",
    ) {
        let path = folder.path().join(&name);
        fs::write(&path, content).expect("the file is written");
        let told = read_raw(&path, None, None).expect_err(&name).to_string();
        assert!(told.contains(&part), "{name}: {told}");
    }
    let missing = read_raw(&folder.path().join("none.png"), None, None);
    assert!(matches!(missing, Err(ImageError::Io(_))), "missing");
}

#[test]
fn cut_files_are_errors() {
    let folder = folder();
    for (name, format) in [("a.png", RawFormat::Png), ("a.tif", RawFormat::Tiff)] {
        let path = folder.path().join(name);
        write(&path, 12);
        let whole = fs::read(&path).expect("the file");
        for length in (0..whole.len() - 12).step_by(7) {
            let cut = raw(&whole[..length], format, None);
            assert!(cut.is_err(), "{name}: {length} bytes");
        }
    }
}

#[test]
fn absurd_sizes_are_refused_before_memory_is_taken() {
    let mut file = Vec::new();
    let encoder = Encoder::new(&mut file, 1_000_000, 1_000_000);
    let mut writer = encoder.write_header().expect("a header");
    let chunk = writer.write_chunk(png::chunk::IDAT, &[0; 16]);
    chunk.expect("a chunk");
    drop(writer);
    let told = raw(&file, RawFormat::Png, None)
        .expect_err("10¹² pixels")
        .to_string();
    assert!(told.contains("1000000 × 1000000 pixels"), "{told}");
}
