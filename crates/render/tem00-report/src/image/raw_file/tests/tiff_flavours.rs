//! Tests of the kinds of TIFF files that other programs write, made byte by byte.

use std::io::Cursor;

use super::{RawFormat, decode};
use crate::image::ImageError;
use crate::image::{LoadedImage, Reading};

/// An entry of a directory: its tag, and its numbers of 16 bits.
type Entry = (u16, Vec<u16>);

/// A name, the order of bytes, entries, a strip, the values of three pixels and their bits.
type GreyCase = (
    &'static str,
    bool,
    Vec<Entry>,
    Vec<u8>,
    [f32; 3],
    Option<u32>,
);

/// A name, the order of bytes, entries, strips, and what is added to all values.
type ColourCase<'a> = (&'static str, bool, Vec<Entry>, Vec<&'a [u8]>, f32);

/// A file of one directory in either order of bytes, whose strips stand behind it.
fn tiff(big: bool, size: [u16; 2], entries: &[Entry], strips: &[&[u8]]) -> Vec<u8> {
    let two = |value: u16| {
        if big {
            value.to_be_bytes()
        } else {
            value.to_le_bytes()
        }
    };
    let four = |value: usize| {
        let value = u32::try_from(value).expect("a small file");
        if big {
            value.to_be_bytes()
        } else {
            value.to_le_bytes()
        }
    };
    let lengths = strips
        .iter()
        .map(|strip| u16::try_from(strip.len()).expect("short"));
    let mut entries: Vec<Entry> = entries.to_vec();
    entries.extend([
        (256, vec![size[0]]),
        (257, vec![size[1]]),
        (273, vec![0; strips.len()]),
        (279, lengths.collect()),
    ]);
    entries.sort();
    let mut behind = 8 + 2 + 12 * entries.len() + 4;
    let strips_at = behind
        + entries
            .iter()
            .map(|(_, values)| 2 * values.len().max(2))
            .sum::<usize>();
    let mut places = strips.iter().scan(strips_at, |at, strip| {
        *at += strip.len();
        u16::try_from(*at - strip.len()).ok()
    });
    let mut file = [if big { &b"MM"[..] } else { b"II" }, &two(42), &four(8)].concat();
    file.extend(two(u16::try_from(entries.len()).expect("few")));
    let mut further = Vec::new();
    for (tag, values) in entries {
        let values: Vec<u16> = match tag {
            273 => places.by_ref().collect(),
            _ => values,
        };
        let mut bytes: Vec<u8> = values.iter().flat_map(|&value| two(value)).collect();
        bytes.resize(bytes.len().max(4), 0);
        file.extend([two(tag), two(3)].concat());
        file.extend(four(values.len()));
        if bytes.len() == 4 {
            file.extend(bytes);
        } else {
            file.extend(four(behind));
            behind += bytes.len();
            further.extend(bytes);
        }
    }
    file.extend([0; 4]);
    file.extend(further);
    file.resize(strips_at, 0);
    file.extend(strips.concat());
    file
}

/// The entries of bits, kind (0 white is zero, 1 black is zero, 2 RGB, 3 palette) and samples.
fn kind(bits: u16, kind: u16, samples: u16) -> Vec<Entry> {
    vec![
        (258, vec![bits; samples.into()]),
        (262, vec![kind]),
        (277, vec![samples]),
    ]
}

fn with(mut entries: Vec<Entry>, further: &[(u16, &[u16])]) -> Vec<Entry> {
    entries.extend(further.iter().map(|(tag, values)| (*tag, values.to_vec())));
    entries
}

const SIGNED: (u16, &[u16]) = (339, &[2]);
const FLOAT: (u16, &[u16]) = (339, &[3]);
const PLANES: (u16, &[u16]) = (284, &[2]);

#[test]
fn grey_values_of_all_kinds_are_read() {
    let le = |values: &[f32]| -> Vec<u8> { values.iter().flat_map(|v| v.to_le_bytes()).collect() };
    let be = |values: &[f32]| -> Vec<u8> { values.iter().flat_map(|v| v.to_be_bytes()).collect() };
    let doubles: Vec<u8> = [0.5_f64, 2.5, 1e9]
        .iter()
        .flat_map(|v| v.to_le_bytes())
        .collect();
    let words =
        |values: [i16; 3]| -> Vec<u8> { values.iter().flat_map(|v| v.to_le_bytes()).collect() };
    let longs =
        |values: [i32; 3]| -> Vec<u8> { values.iter().flat_map(|v| v.to_be_bytes()).collect() };
    let ramp: Vec<u16> = [0, 1, 2]
        .iter()
        .flat_map(|_| (0..256).map(|v| 257 * (255 - v)))
        .collect();
    let cases: [GreyCase; 18] = [
        // Rows are whole bytes, the highest bits first.
        (
            "12 bits",
            false,
            kind(12, 1, 1),
            vec![0x12, 0x3a, 0xbc, 0xff, 0xf0],
            [291.0, 2_748.0, 4_095.0],
            Some(12),
        ),
        (
            "12 bits, MM",
            true,
            kind(12, 1, 1),
            vec![0x12, 0x3a, 0xbc, 0xff, 0xf0],
            [291.0, 2_748.0, 4_095.0],
            Some(12),
        ),
        (
            "10 bits",
            false,
            kind(10, 1, 1),
            vec![0x00, 0x7f, 0xf8, 0x00],
            [1.0, 1_023.0, 512.0],
            Some(10),
        ),
        (
            "14 bits",
            false,
            kind(14, 1, 1),
            vec![0x00, 0x07, 0xff, 0xf8, 0x00, 0x00],
            [1.0, 16_383.0, 8_192.0],
            Some(14),
        ),
        (
            "4 bits",
            false,
            kind(4, 1, 1),
            vec![0x1f, 0x70],
            [1.0, 15.0, 7.0],
            Some(4),
        ),
        (
            "1 bit",
            false,
            kind(1, 1, 1),
            vec![0b1010_0000],
            [1.0, 0.0, 1.0],
            Some(1),
        ),
        (
            "white is zero",
            false,
            kind(12, 0, 1),
            vec![0xfe, 0xef, 0xfe, 0x00, 0x00],
            [17.0, 1.0, 4_095.0],
            Some(12),
        ),
        // A run of five bytes as they are.
        (
            "12 bits, PackBits",
            false,
            with(kind(12, 1, 1), &[(259, &[32_773])]),
            vec![4, 0x12, 0x3a, 0xbc, 0xff, 0xf0],
            [291.0, 2_748.0, 4_095.0],
            Some(12),
        ),
        (
            "float32",
            false,
            with(kind(32, 1, 1), &[FLOAT]),
            le(&[0.25, 1e-6, 7e4]),
            [0.25, 1e-6, 7e4],
            None,
        ),
        (
            "float32, MM",
            true,
            with(kind(32, 1, 1), &[FLOAT]),
            be(&[0.25, 1e-6, 7e4]),
            [0.25, 1e-6, 7e4],
            None,
        ),
        (
            "float64",
            false,
            with(kind(64, 1, 1), &[FLOAT]),
            doubles,
            [0.5, 2.5, 1e9],
            None,
        ),
        (
            "float16",
            false,
            with(kind(16, 1, 1), &[FLOAT]),
            vec![0x00, 0x3c, 0x00, 0xc0, 0xff, 0x7b],
            [1.0, -2.0, 65_504.0],
            None,
        ),
        (
            "int16",
            false,
            with(kind(16, 1, 1), &[SIGNED]),
            words([-5, 0, 32_000]),
            [-5.0, 0.0, 32_000.0],
            None,
        ),
        (
            "int8",
            false,
            with(kind(8, 1, 1), &[SIGNED]),
            vec![255, 3, 127],
            [-1.0, 3.0, 127.0],
            None,
        ),
        (
            "int32, MM",
            true,
            with(kind(32, 1, 1), &[SIGNED]),
            longs([-70_000, 5, 9]),
            [-70_000.0, 5.0, 9.0],
            None,
        ),
        (
            "uint32, MM",
            true,
            kind(32, 1, 1),
            longs([70_000, 5, 9]),
            [70_000.0, 5.0, 9.0],
            None,
        ),
        (
            "grey palette",
            false,
            with(kind(8, 3, 1), &[(320, &ramp)]),
            vec![0, 250, 255],
            [255.0, 5.0, 0.0],
            Some(8),
        ),
        (
            "uint16, MM",
            true,
            kind(16, 1, 1),
            vec![0x01, 0x00, 0x00, 0x07, 0xff, 0xff],
            [256.0, 7.0, 65_535.0],
            Some(16),
        ),
    ];
    for (name, big, entries, strip, expected, bits) in cases {
        let file = tiff(big, [3, 1], &entries, &[&strip]);
        let samples = decode(Cursor::new(&file), RawFormat::Tiff).expect(name);
        let image = samples
            .judged(None)
            .and_then(|samples| samples.image(None))
            .expect(name);
        assert_eq!(image.values.values(), expected, "{name}");
        assert_eq!(image.bit_depth, bits, "{name}");
        // A second row in a strip of its own.
        let rows = tiff(
            big,
            [3, 2],
            &with(entries, &[(278, &[1])]),
            &[&strip, &strip],
        );
        let samples = decode(Cursor::new(&rows), RawFormat::Tiff).expect(name);
        let image = samples
            .judged(None)
            .and_then(|samples| samples.image(None))
            .expect(name);
        assert_eq!(
            image.values.values(),
            [expected, expected].concat(),
            "{name}"
        );
    }
}

#[test]
fn colours_stand_pixel_by_pixel_in_planes_or_in_a_palette() {
    let palette: Vec<u16> = [9, 80, 0, 0, 10, 90, 0, 0, 20, 100, 0, 0]
        .map(|v| 257 * v)
        .into();
    let shifted: Vec<u16> = palette.iter().map(|value| value & 0xff00).collect();
    let deep: Vec<u16> = [9, 80, 0, 0, 10, 90, 0, 0, 20, 100, 0, 0]
        .map(|v| v + 1_000)
        .into();
    let plane: [&[u8]; 3] = [&[9, 80], &[10, 90], &[20, 100]];
    let deep_plane: [&[u8]; 3] = [&[0, 9, 0, 80], &[0, 10, 0, 90], &[0, 20, 0, 100]];
    let cases: [ColourCase<'_>; 9] = [
        (
            "pixels",
            false,
            kind(8, 2, 3),
            vec![&[9, 10, 20, 80, 90, 100]],
            0.0,
        ),
        (
            "planes",
            false,
            with(kind(8, 2, 3), &[PLANES]),
            plane.into(),
            0.0,
        ),
        (
            "planes of 16 bits",
            true,
            with(kind(16, 2, 3), &[PLANES]),
            deep_plane.into(),
            0.0,
        ),
        (
            "palette of 2 bits",
            false,
            with(kind(2, 3, 1), &[(320, &palette)]),
            vec![&[0b0001_0000]],
            0.0,
        ),
        (
            "palette of 8 bits in the upper half",
            true,
            with(kind(2, 3, 1), &[(320, &shifted)]),
            vec![&[0b0001_0000]],
            0.0,
        ),
        (
            "palette of 16 bits",
            true,
            with(kind(2, 3, 1), &[(320, &deep)]),
            vec![&[0b0001_0000]],
            1_000.0,
        ),
        (
            "12 bits",
            false,
            kind(12, 2, 3),
            vec![&[0x00, 0x90, 0x0a, 0x01, 0x40, 0x50, 0x05, 0xa0, 0x64]],
            0.0,
        ),
        (
            "opacity",
            false,
            with(kind(8, 2, 4), &[(338, &[2])]),
            vec![&[9, 10, 20, 7, 80, 90, 100, 7]],
            0.0,
        ),
        (
            "opacity in planes",
            false,
            with(kind(8, 2, 4), &[(338, &[2]), PLANES]),
            [&plane[..], &[&[7, 7]]].concat(),
            0.0,
        ),
    ];
    for (name, big, entries, strips, offset) in cases {
        let file = tiff(big, [2, 1], &entries, &strips);
        for (channel, expected) in [
            (None, [13.0, 90.0]),
            (Some("R"), [9.0, 80.0]),
            (Some("G"), [10.0, 90.0]),
            (Some("b"), [20.0, 100.0]),
        ] {
            let samples = decode(Cursor::new(&file), RawFormat::Tiff).expect(name);
            let image = samples
                .judged(None)
                .and_then(|samples| samples.image(channel))
                .expect(name);
            assert_eq!(
                image.values.values(),
                expected.map(|value| value + offset),
                "{name}"
            );
        }
    }
}

fn light(file: &[u8]) -> Result<LoadedImage, ImageError> {
    let samples = decode(Cursor::new(file), RawFormat::Tiff)?;
    samples.upright().judged(None)?.light(&Reading::default())
}

#[test]
fn what_a_file_says_beside_its_pixels_is_honoured_or_said() {
    let entries = |further: &[(u16, &[u16])]| with(kind(8, 1, 1), further);
    let turned = tiff(false, [3, 1], &entries(&[(274, &[3])]), &[&[51, 102, 255]]);
    let image = light(&turned).expect("three pixels");
    assert_eq!(image.values.values(), [1.0, 0.4, 0.2]);
    assert!(
        image.interpretation.contains("turned"),
        "{}",
        image.interpretation
    );
    let profile = tiff(
        false,
        [3, 1],
        &entries(&[(34_675, &[1, 2, 3])]),
        &[&[51, 102, 255]],
    );
    let told = light(&profile).expect("three pixels").interpretation;
    assert!(told.contains("profile of the file is not read"), "{told}");
    let alpha = with(kind(8, 1, 2), &[(338, &[1])]);
    let grey = light(&tiff(false, [2, 1], &alpha, &[&[51, 9, 255, 9]])).expect("two pixels");
    assert_eq!(grey.values.values(), [0.2, 1.0], "never opacity");
    let bands = tiff(false, [2, 1], &kind(8, 1, 3), &[&[51, 9, 1, 255, 9, 1]]);
    let asked = light(&bands)
        .expect_err("three bands of anything")
        .to_string();
    assert!(asked.contains("--channel: 1, 2, 3"), "{asked}");
    let second =
        decode(Cursor::new(&bands), RawFormat::Tiff).and_then(|samples| samples.judged(None));
    let second = second
        .and_then(|samples| samples.image(Some("2")))
        .expect("there is one");
    assert_eq!(second.values.values(), [9.0, 9.0]);
}

#[test]
fn what_is_not_read_is_refused_with_its_reason() {
    let row = [0_u8; 12];
    let palette = [7_u16; 9];
    for (name, entries, part) in [
        (
            "packed planes",
            with(kind(12, 2, 3), &[PLANES]),
            "3 × 12 bits",
        ),
        (
            "bits in reverse",
            with(kind(8, 1, 1), &[(266, &[2])]),
            "1 × 8 bits",
        ),
        ("ink", kind(8, 5, 4), "CMYK"),
        ("24 bits", kind(24, 1, 1), "1 × 24 bits"),
        (
            "short palette",
            with(kind(8, 3, 1), &[(320, &palette)]),
            "palettes",
        ),
        ("JPEG", with(kind(8, 1, 1), &[(259, &[7])]), "ompress"),
        ("many bands", kind(8, 1, 17), "Multiband"),
    ] {
        let strips = if name == "packed planes" { 3 } else { 1 };
        let file = tiff(false, [1, 1], &entries, &[&row[..]; 3][..strips]);
        let told = light(&file).expect_err(name).to_string();
        assert!(told.contains(part), "{name}: {told}");
    }
    // 65,535 × 4096 pixels in 12 bytes.
    let claim = tiff(false, [65_535, 4_096], &kind(8, 1, 1), &[&row]);
    let told = light(&claim).expect_err("a claim").to_string();
    assert!(told.contains("cannot hold"), "{told}");
}
