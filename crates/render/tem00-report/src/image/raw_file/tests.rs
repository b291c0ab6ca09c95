mod camera_formats;
mod tiff_flavours;

use std::{fs, io::Cursor, path::PathBuf};

use png::{BitDepth, ColorType, Encoder};
use tem00_numerics::Grid;
use tiff::encoder::{TiffEncoder, colortype};

use super::{frame::BIT_DEPTHS, *};

fn values(bit_depth: u32) -> Grid<u16> {
    let full = u16::MAX >> (16 - bit_depth);
    Grid::from_fn(7, 5, |x, y| match (x, y) {
        (6, 4) => full,
        _ => u16::try_from(x * 37 + y * 101).expect("a small number") % full,
    })
}

fn folder() -> tempfile::TempDir {
    tempfile::tempdir().expect("a temporary folder")
}

/// Writes a PNG file with `chunk` before its image.
fn png(path: &PathBuf, (colour, depth): (ColorType, BitDepth), chunk: Option<&[u8]>, data: &[u8]) {
    let mut file = Vec::new();
    let pixel = colour.samples() * if depth == BitDepth::Sixteen { 2 } else { 1 };
    let width = u32::try_from(data.len() / pixel).expect("a short row");
    let mut encoder = Encoder::new(&mut file, width, 1);
    encoder.set_color(colour);
    encoder.set_depth(depth);
    let mut writer = encoder.write_header().expect("a header");
    if let Some(bits) = chunk {
        writer.write_chunk(png::chunk::sBIT, bits).expect("a chunk");
    }
    writer.write_image_data(data).expect("an image");
    writer.finish().expect("an end");
    fs::write(path, file).expect("a file");
}

fn write_tiff<C: colortype::ColorType>(path: &PathBuf, size: [u32; 2], data: &[C::Inner])
where
    [C::Inner]: tiff::encoder::TiffValue,
{
    let mut file = Cursor::new(Vec::new());
    let mut encoder = TiffEncoder::new(&mut file).expect("a header");
    let image = encoder.write_image::<C>(size[0], size[1], data);
    image.expect("an image");
    fs::write(path, file.into_inner()).expect("a file");
}

#[test]
fn frames_of_all_bit_depths_come_back_unchanged() {
    let folder = folder();
    for bit_depth in BIT_DEPTHS {
        let values = values(bit_depth);
        let frame = GreyFrame {
            values: &values,
            bit_depth,
        };
        for name in ["a.png", "a.tif", "a.TIFF"] {
            let path = folder.path().join(name);
            let text = [("camera", "\u{e9}l\u{e8}ve \"7\"".to_owned())];
            write_raw(&path, frame, &text).expect("the frame is written");
            let back = read_raw(&path, None, None).expect("the frame is read");
            assert_eq!(
                back.values,
                values.map(|&value| f32::from(value)),
                "{name}, {bit_depth} bits"
            );
            assert_eq!(back.bit_depth, Some(bit_depth), "{name}");
            let full = u16::MAX >> (16 - bit_depth);
            assert_eq!(back.saturated, values.map(|&value| value == full), "{name}");
        }
    }
}

#[test]
fn eight_bits_take_a_byte_and_more_take_two() {
    let folder = folder();
    for (bit_depth, expected) in [(8, BitDepth::Eight), (10, BitDepth::Sixteen)] {
        let path = folder.path().join("a.png");
        write_raw(
            &path,
            GreyFrame {
                values: &values(bit_depth),
                bit_depth,
            },
            &[],
        )
        .expect("the frame is written");
        let file = Cursor::new(fs::read(&path).expect("the file"));
        let reader = png::Decoder::new(file).read_info().expect("a PNG");
        assert_eq!(reader.info().bit_depth, expected, "{bit_depth} bits");
    }
}

#[test]
fn values_that_other_programs_scaled_up_are_scaled_back() {
    let path = folder().keep().join("a.png");
    let sixteen: Vec<u8> = [0x0010_u16, 0x0AB0, 0xFFFF].map(u16::to_be_bytes).concat();
    png(
        &path,
        (ColorType::Grayscale, BitDepth::Sixteen),
        Some(&[12]),
        &sixteen,
    );
    let image = read_raw(&path, None, None).expect("the frame is read");
    assert_eq!(image.values.values(), [1.0, 171.0, 4_095.0]);
    assert_eq!((image.bit_depth, image.saturated_pixels()), (Some(12), 1));
    assert!(
        image.interpretation.contains("scaled up"),
        "{}",
        image.interpretation
    );
}

#[test]
fn the_bits_of_a_camera_can_be_told() {
    let path = folder().keep().join("a.png");
    let sixteen: Vec<u8> = [7_u16, 1_023].map(u16::to_be_bytes).concat();
    png(
        &path,
        (ColorType::Grayscale, BitDepth::Sixteen),
        None,
        &sixteen,
    );
    let of = |bits| read_raw(&path, None, bits);
    let image = of(None).expect("the frame is read");
    assert_eq!(image.bit_depth, Some(16), "the file does not know");
    assert_eq!(
        image.saturated_pixels(),
        1,
        "but its values end at that of 10 bits"
    );
    for (bits, saturated) in [(10, 1), (12, 0), (16, 0)] {
        let told = of(Some(bits)).expect("the bits are enough");
        assert_eq!(
            (told.bit_depth, told.saturated_pixels()),
            (Some(bits), saturated)
        );
    }
    let error = of(Some(8)).expect_err("1023 does not fit").to_string();
    assert!(
        error.contains("at most 255, but there is one of 1023"),
        "{error}"
    );
    write_raw(
        &path,
        GreyFrame {
            values: &values(10),
            bit_depth: 10,
        },
        &[],
    )
    .expect("the frame is written");
    let error = of(Some(12)).expect_err("ten bits are ten").to_string();
    assert!(error.contains("have 10 bits"), "{error}");
}

#[test]
fn colours_are_chosen_or_averaged() {
    let path = folder().keep().join("a.png");
    let data = [10, 20, 60, 255, 0, 0];
    png(&path, (ColorType::Rgb, BitDepth::Eight), None, &data);
    let of = |channel| read_raw(&path, channel, None).expect("the frame is read");
    assert_eq!(of(None).values.values(), [30.0, 85.0]);
    assert_eq!(of(None).saturated_pixels(), 1, "one channel is enough");
    assert_eq!(of(Some("g")).values.values(), [20.0, 0.0]);
    assert_eq!(
        of(Some("g")).saturated_pixels(),
        0,
        "the other channel does not count"
    );
    assert!(
        matches!(
            read_raw(&path, Some("A"), None),
            Err(ImageError::Channel { .. })
        ),
        "there is no channel A"
    );

    let path = path.with_extension("tif");
    write_tiff::<colortype::RGB16>(&path, [2, 1], &[100, 200, 600, 3, 3, 3]);
    let of = |channel| read_raw(&path, channel, None).expect("the frame is read");
    assert_eq!(of(None).values.values(), [300.0, 3.0]);
    assert_eq!(of(Some("B")).values.values(), [600.0, 3.0]);
}

#[test]
fn what_is_no_frame_is_refused_in_words() {
    let folder = folder();
    let file = |name: &str, content: &[u8]| {
        let path = folder.path().join(name);
        fs::write(&path, content).expect("the file is written");
        read_raw(&path, None, None).expect_err(name).to_string()
    };
    assert!(
        file("a.gif", b"").contains("use .png, .tif, .jpg, .bmp or .pgm"),
        "another format"
    );
    assert!(
        file("a.png", b"").contains("not a readable PNG"),
        "an empty PNG"
    );
    assert!(file("a.tif", b"II*\0").contains("TIFF"), "a cut header");
    assert!(file("b.tif", b"no image at all").contains("TIFF"), "text");

    let missing = read_raw(&folder.path().join("none.png"), None, None);
    assert!(matches!(missing, Err(ImageError::Io(_))), "missing");
}

#[test]
fn cut_files_are_errors() {
    let folder = folder();
    for name in ["a.png", "a.tif"] {
        let path = folder.path().join(name);
        write_raw(
            &path,
            GreyFrame {
                values: &values(12),
                bit_depth: 12,
            },
            &[],
        )
        .expect("the frame is written");
        let whole = fs::read(&path).expect("the file");
        for length in (0..whole.len() - 12).step_by(7) {
            fs::write(&path, &whole[..length]).expect("a cut file");
            assert!(
                read_raw(&path, None, None).is_err(),
                "{name}: {length} bytes"
            );
        }
    }
}

#[test]
fn absurd_sizes_are_refused_before_memory_is_taken() {
    let folder = folder();
    let path = folder.path().join("a.tif");
    write_raw(
        &path,
        GreyFrame {
            values: &values(8),
            bit_depth: 8,
        },
        &[],
    )
    .expect("the frame is written");
    let mut file = fs::read(&path).expect("the file");
    // The entries of width and height, tags 256 and 257, of one LONG each.
    for tag in [256_u16, 257] {
        let key: Vec<u8> = [tag.to_le_bytes(), 4_u16.to_le_bytes()].concat();
        let place = file
            .windows(4)
            .position(|bytes| bytes == key)
            .expect("the tag");
        file[place + 8..place + 12].copy_from_slice(&1_000_000_u32.to_le_bytes());
    }
    fs::write(&path, file).expect("the file");
    assert!(
        read_raw(&path, None, None).is_err(),
        "a TIFF of 10¹² pixels"
    );

    let mut file = Vec::new();
    let encoder = Encoder::new(&mut file, 1_000_000, 1_000_000);
    let mut writer = encoder.write_header().expect("a header");
    let chunk = writer.write_chunk(png::chunk::IDAT, &[0; 16]);
    chunk.expect("a chunk");
    drop(writer);
    let path = path.with_extension("png");
    fs::write(&path, file).expect("the file");
    let error = read_raw(&path, None, None)
        .expect_err("10¹² pixels")
        .to_string();
    assert!(error.contains("1000000 × 1000000 pixels"), "{error}");
}
