//! Tests of the formats that cameras and their programs write, made byte by byte or by another program.

use std::io::Cursor;

use super::{RawFormat, RawImage, decode};
use crate::image::ImageError;
use crate::image::{LoadedImage, Reading, Transfer};

const GREY_JPEG: &[u8] = include_bytes!("../data/grey.jpg");
const TURNED_JPEG: &[u8] = include_bytes!("../data/turned.jpg");
const RESTARTS_JPEG: &[u8] = include_bytes!("../data/restarts.jpg");
const PROGRESSIVE_JPEG: &[u8] = include_bytes!("../data/progressive.jpg");
const COLOUR_JPEG: &[u8] = include_bytes!("../data/colour.jpg");

fn raw(file: &[u8], format: RawFormat, channel: Option<&str>) -> Result<RawImage, ImageError> {
    decode(Cursor::new(file), format)?
        .judged(None)?
        .image(channel)
}

fn light(file: &[u8], format: RawFormat, transfer: Option<Transfer>) -> LoadedImage {
    let reading = Reading {
        transfer,
        ..Reading::default()
    };
    let samples = decode(Cursor::new(file), format).expect("the file is read");
    let light = samples
        .judged(None)
        .and_then(|samples| samples.light(&reading));
    light.expect("the file is light")
}

/// A bitmap of so many bits and rows from the bottom up, with its rows given as they stand in the file.
fn bitmap(size: [i32; 2], bits: u16, palette: &[[u8; 4]], rows: &[u8]) -> Vec<u8> {
    let offset = 54 + 4 * u32::try_from(palette.len()).expect("a palette");
    let mut file = b"BM\0\0\0\0\0\0\0\0".to_vec();
    file.extend(offset.to_le_bytes());
    file.extend(40_u32.to_le_bytes());
    file.extend(size.iter().flat_map(|side| side.to_le_bytes()));
    file.extend(1_u16.to_le_bytes());
    file.extend(bits.to_le_bytes());
    file.extend([0; 16]);
    file.extend(
        u32::try_from(palette.len())
            .expect("a palette")
            .to_le_bytes(),
    );
    file.extend([0; 4]);
    file.extend(palette.iter().flatten());
    file.extend(rows);
    file
}

#[test]
fn bitmaps_stand_upside_down_in_rows_of_whole_words() {
    // Blue, green and red, two pixels and two bytes of padding.
    let rows = [1, 2, 3, 4, 5, 6, 0, 0, 7, 8, 9, 10, 11, 12, 0, 0];
    let of = |height, channel| {
        let file = bitmap([2, height], 24, &[], &rows);
        raw(&file, RawFormat::Bmp, Some(channel))
            .expect("a bitmap")
            .values
    };
    assert_eq!(of(2, "R").values(), [9.0, 12.0, 3.0, 6.0]);
    assert_eq!(of(2, "B").values(), [7.0, 10.0, 1.0, 4.0]);
    assert_eq!(of(-2, "R").values(), [3.0, 6.0, 9.0, 12.0], "top down");
    let wide = bitmap([1, 2], 32, &[], &[1, 2, 3, 99, 4, 5, 6, 99]);
    let green = raw(&wide, RawFormat::Bmp, Some("G")).expect("a bitmap");
    assert_eq!(green.values.values(), [5.0, 2.0]);
}

#[test]
fn grey_palettes_make_grey_bitmaps() {
    let palette: Vec<_> = (0..=255).map(|grey| [grey, grey, grey, 0]).collect();
    let grey = raw(
        &bitmap([3, 1], 8, &palette, &[7, 200, 255, 0]),
        RawFormat::Bmp,
        None,
    );
    let grey = grey.expect("a bitmap");
    assert_eq!(grey.values.values(), [7.0, 200.0, 255.0]);
    assert!(
        grey.interpretation.starts_with("grey, 8 bits"),
        "{}",
        grey.interpretation
    );
    assert_eq!(grey.saturated_pixels(), 1);
    // Blue, green, red.
    let colours = bitmap([2, 1], 8, &[[1, 2, 6, 0], [5, 5, 5, 0]], &[0, 1, 0, 0]);
    let mean = raw(&colours, RawFormat::Bmp, None).expect("a bitmap");
    assert_eq!(mean.values.values(), [3.0, 5.0]);
}

#[test]
fn maps_of_twelve_bits_know_their_bits() {
    let mut file = b"P5 # a camera\n# of 12 bits\n3 1\n4095\n".to_vec();
    file.extend([0x00, 0x07, 0x0a, 0xbc, 0x0f, 0xff]);
    let image = raw(&file, RawFormat::Pnm, None).expect("a map");
    assert_eq!(image.values.values(), [7.0, 2_748.0, 4_095.0]);
    assert_eq!((image.bit_depth, image.saturated_pixels()), (Some(12), 1));
    let light = light(&file, RawFormat::Pnm, None);
    assert_eq!(light.saturated, Some(1.0 / 3.0));
    assert!(
        (light.values[(1, 0)] - 2_748.0 / 4_095.0).abs() < 1e-7,
        "in proportion"
    );
}

#[test]
fn maps_are_read_as_text_and_in_colour() {
    let grey = raw(b"P2\n2 2 # four\n255\n1 2\n30\n 255", RawFormat::Pnm, None);
    assert_eq!(
        grey.expect("a map").values.values(),
        [1.0, 2.0, 30.0, 255.0]
    );
    let colour = raw(b"P6 1 1 255\n\x01\x02\x06", RawFormat::Pnm, None).expect("a map");
    assert_eq!(colour.values.values(), [3.0]);
    let text = raw(b"P3 1 1 65535 1 2 60000\n", RawFormat::Pnm, Some("b")).expect("a map");
    assert_eq!(
        (text.values.values(), text.bit_depth),
        (&[60_000.0][..], Some(16))
    );
}

#[test]
fn headers_of_maps_may_end_as_on_windows_and_the_length_must_fit() {
    // The first byte of the pixels is a line feed, or a carriage return.
    for first in [b'\n', b'\r', b' ', 7] {
        for (magic, largest, pixels) in [
            ("P5", 255, &[first, 1, 2][..]),
            ("P5", 65_535, &[first, 1, 2, 3, 4, 5]),
            ("P6", 255, &[first, 1, 2, 3, 4, 5, 6, 7, 8]),
        ] {
            let header = format!("{magic}\n# a camera\n3 1\n{largest}\n");
            let map = |header: &str, pixels: &[u8]| {
                raw(&[header.as_bytes(), pixels].concat(), RawFormat::Pnm, None)
            };
            let expected = map(&header, pixels).expect("a map");
            for end in ["\r\n", " "] {
                let header = if end == " " {
                    header.trim_end().to_owned() + end
                } else {
                    header.replace('\n', end)
                };
                let image = map(&header, pixels).expect("a map");
                assert_eq!(image.values, expected.values, "{header:?}, {first}");
                let next = map(&header, &[pixels, header.as_bytes()].concat());
                assert!(next.expect("two maps").has_further_images, "{header:?}");
                for wrong in [&[pixels, &b"\n"[..]].concat(), &pixels[1..]] {
                    assert!(map(&header, wrong).is_err(), "{header:?}: another length");
                }
            }
        }
    }
    // Every value of twelve bits comes back.
    let values: Vec<u16> = (0..4_096).collect();
    let pixels: Vec<u8> = values
        .iter()
        .flat_map(|value| value.to_be_bytes())
        .collect();
    let file = [&b"P5 4096 1 4095\n"[..], &pixels].concat();
    let found = raw(&file, RawFormat::Pnm, None).expect("a map").values;
    let expected: Vec<f32> = values.into_iter().map(f32::from).collect();
    assert_eq!(found.values(), expected);
}

#[test]
fn photographs_have_the_grey_values_of_another_reader() {
    let grey = raw(GREY_JPEG, RawFormat::Jpeg, None).expect("a photograph");
    assert_eq!((grey.values.width(), grey.values.height()), (24, 16));
    let expected = |x: usize, y: usize| (20 + 6 * x + 4 * y) as f32;
    for (y, row) in grey.values.rows().enumerate() {
        for (x, &value) in row.iter().enumerate() {
            // Decoders may round the cosine transform by one.
            assert!(
                (value - expected(x, y)).abs() <= 1.0,
                "({x}, {y}) is {value}"
            );
        }
    }
    for (channel, at) in [("R", 20.0), ("G", 235.0), ("B", 60.0)] {
        let image = raw(COLOUR_JPEG, RawFormat::Jpeg, Some(channel)).expect("a photograph");
        let value = image.values[(0, 0)];
        assert!((value - at).abs() <= 3.0, "{channel} is {value}");
    }
    let told = light(GREY_JPEG, RawFormat::Jpeg, None).interpretation;
    assert!(told.contains("losses"), "{told}");
    // 0.006995 is the linear value of 20 / 255 by the sRGB curve.
    let dark = light(GREY_JPEG, RawFormat::Jpeg, Some(Transfer::Srgb)).values[(0, 0)];
    assert!((dark - 0.006_995).abs() < 1e-3, "{dark}");
}

#[test]
fn photographs_of_other_kinds_have_the_same_grey_values() {
    let expected = raw(GREY_JPEG, RawFormat::Jpeg, None).expect("a photograph");
    for (name, file, orientation) in [
        ("turned", TURNED_JPEG, 6),
        ("restarts", RESTARTS_JPEG, 1),
        ("progressive", PROGRESSIVE_JPEG, 1),
    ] {
        let image = raw(file, RawFormat::Jpeg, None).expect(name);
        assert_eq!(image.values, expected.values, "{name}");
        assert_eq!(image.orientation, orientation, "{name}");
    }
    let samples = decode(Cursor::new(TURNED_JPEG), RawFormat::Jpeg).expect("a photograph");
    let upright = samples
        .upright()
        .judged(None)
        .and_then(|samples| samples.image(None));
    let upright = upright.expect("a photograph").values;
    assert_eq!((upright.width(), upright.height()), (16, 24));
    // A quarter turn to the right: the left lower corner comes to the left upper one.
    let corners = [upright[(0, 0)], upright[(15, 0)]].map(f32::to_bits);
    let stored = [expected.values[(0, 15)], expected.values[(0, 0)]];
    assert_eq!(corners, stored.map(f32::to_bits));
}

#[test]
fn photographs_without_all_of_their_data_are_refused() {
    for (name, file) in [
        ("one scan", GREY_JPEG),
        ("colour", COLOUR_JPEG),
        ("restarts", RESTARTS_JPEG),
        ("progressive", PROGRESSIVE_JPEG),
    ] {
        let scan = file
            .windows(2)
            .position(|pair| pair == [0xff, 0xda])
            .expect("a scan");
        let start = scan + 2 + usize::from(file[scan + 3]);
        // The last bytes may hold but the ones that fill them.
        for length in start..file.len() - 4 {
            let cut = [&file[..length], &[0xff, 0xd9]].concat();
            let refused = raw(&cut, RawFormat::Jpeg, None).map(|_| ());
            let told = refused.expect_err(name).to_string();
            assert!(
                told.contains("before its last pixel"),
                "{name}, {length}: {told}"
            );
        }
        let followed = [file, b"anything else \xff\xd8 \xff\xd9"].concat();
        assert!(
            raw(&followed, RawFormat::Jpeg, None).is_ok(),
            "{name}, with more behind it"
        );
    }
    // A restart and what stands before it are lost on the way.
    let restart = RESTARTS_JPEG
        .windows(2)
        .position(|pair| pair == [0xff, 0xd1])
        .expect("one");
    let next = RESTARTS_JPEG
        .windows(2)
        .position(|pair| pair == [0xff, 0xd2])
        .expect("one");
    let lost = [&RESTARTS_JPEG[..restart], &RESTARTS_JPEG[next..]].concat();
    assert!(
        raw(&lost, RawFormat::Jpeg, None).is_err(),
        "a restart is missing"
    );
    let end = [&RESTARTS_JPEG[..restart], &[0xff, 0xd9]].concat();
    assert!(
        raw(&end, RawFormat::Jpeg, None).is_err(),
        "cut where a restart was"
    );
}

#[test]
fn cut_and_mutated_files_are_errors_or_images_and_no_panics() {
    let files = [
        (GREY_JPEG.to_vec(), RawFormat::Jpeg),
        (COLOUR_JPEG.to_vec(), RawFormat::Jpeg),
        (bitmap([2, 2], 24, &[], &[7; 16]), RawFormat::Bmp),
        (
            bitmap([3, 1], 8, &[[1, 1, 1, 0]; 4], &[0, 1, 2, 0]),
            RawFormat::Bmp,
        ),
        (b"P5 3 2 255\n123456".to_vec(), RawFormat::Pnm),
        (b"P3 1 2 99 1 2 3 4 5 6\n".to_vec(), RawFormat::Pnm),
    ];
    for (file, format) in files {
        assert!(raw(&file, format, None).is_ok(), "{format:?}");
        for length in 0..file.len().saturating_sub(2) {
            let cut = raw(&file[..length], format, None);
            assert!(cut.is_err(), "{format:?} of {length} bytes");
        }
        let mut state = 1_u32;
        for _ in 0..2_000 {
            let mut mutated = file.clone();
            for _ in 0..2 {
                state = state.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
                let place = (state >> 8) as usize % mutated.len();
                mutated[place] = state.to_le_bytes()[3];
            }
            // Any answer will do.
            let _ = raw(&mutated, format, None);
        }
    }
}

#[test]
fn what_these_formats_cannot_hold_is_said() {
    let refused = |file: &[u8], format| {
        raw(file, format, None)
            .expect_err("it is wrong")
            .to_string()
    };
    for file in [
        &b"P4 1 1\n"[..],
        b"P5 1 1 70000\n12",
        b"P5 1 1 0\n12",
        b"P2 2 1 9 1",
        b"P2 2 1 9 1 2 3",
        b"P5 99999999 99999999 255\n",
        b"P5 1 x 255\n",
        b"P5 99999999999 1 255\n",
    ] {
        assert!(!refused(file, RawFormat::Pnm).is_empty(), "{file:?}");
    }
    let mut compressed = bitmap([1, 1], 8, &[], &[0; 4]);
    compressed[30] = 1;
    let said = refused(&compressed, RawFormat::Bmp);
    assert!(said.contains("method 1"), "{said}");
    let large = bitmap([i32::MAX, 65_535], 24, &[], &[]);
    assert!(!refused(&large, RawFormat::Bmp).is_empty(), "too large");
}
