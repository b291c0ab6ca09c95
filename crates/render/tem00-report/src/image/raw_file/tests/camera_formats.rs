//! Tests of the formats that cameras and their programs write, made byte by byte or by another
//! program.

use std::io::Cursor;

use tem00_testkit::{robust, rows};

use super::{RawFormat, decode, hex, numbers, raw};
use crate::image::{LoadedImage, Reading, Transfer};

const GREY_JPEG: &[u8] = include_bytes!("../data/grey.jpg");
const TURNED_JPEG: &[u8] = include_bytes!("../data/turned.jpg");
const RESTARTS_JPEG: &[u8] = include_bytes!("../data/restarts.jpg");
const PROGRESSIVE_JPEG: &[u8] = include_bytes!("../data/progressive.jpg");
const COLOUR_JPEG: &[u8] = include_bytes!("../data/colour.jpg");

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

/// A bitmap of so many bits and rows from the bottom up, with its rows given as they stand in the
/// file.
fn bitmap(size: [i32; 2], bits: u16, palette: &[[u8; 4]], rows: &[u8]) -> Vec<u8> {
    let colours = u32::try_from(palette.len()).expect("a palette");
    let mut file = b"BM\0\0\0\0\0\0\0\0".to_vec();
    file.extend([54 + 4 * colours, 40].map(u32::to_le_bytes).concat());
    file.extend(size.map(i32::to_le_bytes).concat());
    file.extend([1, bits].map(u16::to_le_bytes).concat());
    file.extend([0; 16]);
    file.extend([colours, 0].map(u32::to_le_bytes).concat());
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
    let file = bitmap([3, 1], 8, &palette, &[7, 200, 255, 0]);
    let grey = raw(&file, RawFormat::Bmp, None).expect("a bitmap");
    assert_eq!(grey.values.values(), [7.0, 200.0, 255.0]);
    assert!(grey.interpretation.starts_with("grey, 8 bits"), "{grey:?}");
    assert_eq!(grey.saturated_pixels(), 1);
    // Blue, green, red.
    let colours = bitmap([2, 1], 8, &[[1, 2, 6, 0], [5, 5, 5, 0]], &[0, 1, 0, 0]);
    let mean = raw(&colours, RawFormat::Bmp, None).expect("a bitmap");
    assert_eq!(mean.values.values(), [3.0, 5.0]);
}

#[test]
fn bitmaps_have_one_to_thirty_two_bits() {
    let black_and_white = [[0; 4], [255; 4]];
    let fields = |masks: [u32; 3]| masks.map(u32::to_le_bytes);
    let green_is_finer = fields([0xf800, 0x07e0, 0x001f]);
    let wide = fields([0xff, 0xff00, 0x00ff_0000]);
    for (bits, method, head, row, expected) in [
        (
            1,
            0,
            &black_and_white[..],
            [0b0110_0000, 0, 0, 0],
            [0.0, 255.0],
        ),
        (4, 0, &black_and_white, [0x10, 0, 0, 0], [255.0, 0.0]),
        // The mean of the colours: 31 of 31 thrice, and 16 of 31 in blue.
        (16, 0, &[], [0xff, 0x7f, 0x10, 0], [255.0, 44.0]),
        // 31 of 31 in red, and 1 of 63 in green.
        (
            16,
            3,
            &green_is_finer,
            [0, 0xf8, 0x20, 0],
            [85.0, 4.0 / 3.0],
        ),
        (32, 3, &wide, [3, 4, 8, 0], [5.0, 5.0]),
    ] {
        let rows = [row, row].concat();
        let mut file = bitmap([2, 1], bits, head, &rows);
        file[30] = method;
        let read = raw(&file, RawFormat::Bmp, None).expect("a bitmap");
        assert_eq!(read.values.values(), expected, "{bits} bits, {method}");
    }
}

#[test]
fn maps_are_read_in_bytes_and_as_text_in_grey_and_in_colour() {
    // The header, bytes behind it, the values and their bits.
    let table = "
        P5 # a camera\\n# of 12 bits\\n3 1\\n4095\\n => 0007 0abc 0fff => 7 2748 4095 => 12
        P2\\n2 2 # four\\n255\\n1 2\\n30\\n 255 => => 1 2 30 255 => 8
        P6 1 1 255\\n => 01 02 06 => 3 => 8
        P3 1 1 65535 1 2 60000\\n => => 20001 => 16";
    for [header, bytes, expected, bits] in rows(table) {
        let file = [header.as_bytes(), &hex(&bytes)].concat();
        let image = raw(&file, RawFormat::Pnm, None).expect(&header);
        assert_eq!(image.values.values(), numbers(&expected), "{header}");
        assert_eq!(image.bit_depth.map(|bits| bits.to_string()), Some(bits));
    }
    let blue = raw(b"P3 1 1 65535 1 2 60000\n", RawFormat::Pnm, Some("b"));
    assert_eq!(blue.expect("a map").values.values(), [60_000.0]);
    let light = light(b"P2 3 1 4095 7 2748 4095", RawFormat::Pnm, None);
    assert_eq!(light.saturated, Some(1.0 / 3.0));
    let part = light.values[(1, 0)];
    assert!((part - 2_748.0 / 4_095.0).abs() < 1e-7, "in proportion");
}

#[test]
fn headers_of_maps_may_end_as_on_windows_and_the_length_must_fit() {
    // The first byte of the pixels is a line feed, or a carriage return.
    for first in [b'\n', b'\r', b' ', 7] {
        for (magic, largest, count) in [("P5", 255, 3), ("P5", 65_535, 6), ("P6", 255, 9)] {
            let pixels: Vec<u8> = [first].into_iter().chain(1..count).collect();
            let header = format!("{magic}\n# a camera\n3 1\n{largest}\n");
            let map = |header: &str, pixels: &[u8]| {
                raw(&[header.as_bytes(), pixels].concat(), RawFormat::Pnm, None)
            };
            let expected = map(&header, &pixels).expect("a map");
            for header in [
                header.replace('\n', "\r\n"),
                header.trim_end().to_owned() + " ",
            ] {
                let image = map(&header, &pixels).expect("a map");
                assert_eq!(image.values, expected.values, "{header:?}, {first}");
                let next = map(&header, &[&pixels, header.as_bytes()].concat());
                assert!(next.expect("two maps").has_further_images, "{header:?}");
                for wrong in [&[&pixels, &b"\n"[..]].concat(), &pixels[1..]] {
                    assert!(map(&header, wrong).is_err(), "{header:?}: another length");
                }
            }
        }
    }
    // Every value of twelve bits comes back.
    let pixels: Vec<u8> = (0..4_096_u16).flat_map(u16::to_be_bytes).collect();
    let file = [&b"P5 4096 1 4095\n"[..], &pixels].concat();
    let found = raw(&file, RawFormat::Pnm, None).expect("a map").values;
    let expected: Vec<f32> = (0..4_096_u16).map(f32::from).collect();
    assert_eq!(found.values(), expected);
}

#[test]
fn photographs_have_the_grey_values_of_another_reader() {
    let grey = raw(GREY_JPEG, RawFormat::Jpeg, None).expect("a photograph");
    assert_eq!((grey.values.width(), grey.values.height()), (24, 16));
    for (y, row) in grey.values.rows().enumerate() {
        for (x, &value) in row.iter().enumerate() {
            // Decoders may round the cosine transform by one.
            let expected = (20 + 6 * x + 4 * y) as f32;
            assert!((value - expected).abs() <= 1.0, "({x}, {y}) is {value}");
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
    for (file, orientation) in [(TURNED_JPEG, 6), (RESTARTS_JPEG, 1), (PROGRESSIVE_JPEG, 1)] {
        let image = raw(file, RawFormat::Jpeg, None).expect("a photograph");
        assert_eq!(image.values, expected.values, "{orientation}");
        assert_eq!(image.orientation, orientation);
    }
    let samples = decode(Cursor::new(TURNED_JPEG), RawFormat::Jpeg).expect("a photograph");
    let upright = samples.upright().judged(None);
    let upright = upright.and_then(|samples| samples.image(None));
    let upright = upright.expect("a photograph").values;
    assert_eq!((upright.width(), upright.height()), (16, 24));
    // A quarter turn to the right: the left lower corner comes to the left upper one.
    let corners = [upright[(0, 0)], upright[(15, 0)]].map(f32::to_bits);
    let stored = [expected.values[(0, 15)], expected.values[(0, 0)]];
    assert_eq!(corners, stored.map(f32::to_bits));
}

#[test]
fn photographs_without_all_of_their_data_are_refused() {
    let marker = |file: &[u8], kind: u8| {
        let place = file.windows(2).position(|pair| pair == [0xff, kind]);
        place.expect("a marker")
    };
    for file in [GREY_JPEG, COLOUR_JPEG, RESTARTS_JPEG, PROGRESSIVE_JPEG] {
        let scan = marker(file, 0xda);
        let start = scan + 2 + usize::from(file[scan + 3]);
        // The last bytes may hold but the ones that fill them.
        for length in start..file.len() - 4 {
            let cut = [&file[..length], &[0xff, 0xd9]].concat();
            let told = raw(&cut, RawFormat::Jpeg, None)
                .expect_err("cut")
                .to_string();
            assert!(told.contains("before its last pixel"), "{length}: {told}");
        }
        let followed = [file, b"anything else \xff\xd8 \xff\xd9"].concat();
        assert!(
            raw(&followed, RawFormat::Jpeg, None).is_ok(),
            "more behind it"
        );
    }
    // A restart and what stands before it are lost on the way, or the file is cut there.
    let [restart, next] = [0xd1, 0xd2].map(|kind| marker(RESTARTS_JPEG, kind));
    for rest in [&RESTARTS_JPEG[next..], &[0xff, 0xd9]] {
        let lost = [&RESTARTS_JPEG[..restart], rest].concat();
        assert!(
            raw(&lost, RawFormat::Jpeg, None).is_err(),
            "a restart is missing"
        );
    }
    // 4096 rows of 65,535 pixels, and 41 kB of a comment.
    let mut claim = GREY_JPEG.to_vec();
    let frame = marker(GREY_JPEG, 0xc0);
    claim[frame + 5..frame + 9].copy_from_slice(&[0x10, 0x00, 0xff, 0xff]);
    claim.splice(
        2..2,
        [&[0xff, 0xfe, 0xa0, 0x02][..], &[b' '; 0xa000]].concat(),
    );
    let told = raw(&claim, RawFormat::Jpeg, None)
        .expect_err("a claim")
        .to_string();
    assert!(told.contains("cannot hold"), "{told}");
}

#[test]
fn cut_and_mutated_files_are_errors_or_images_and_no_panics() {
    let grey = [[1, 1, 1, 0]; 4];
    let bitmaps = [
        bitmap([2, 2], 24, &[], &[7; 16]),
        bitmap([3, 1], 8, &grey, &[0, 1, 2, 0]),
    ];
    let maps = [&b"P5 3 2 255\n123456"[..], b"P3 1 2 99 1 2 3 4 5 6\n"];
    for (format, files) in [
        (RawFormat::Jpeg, [GREY_JPEG, COLOUR_JPEG]),
        (RawFormat::Bmp, [&bitmaps[0], &bitmaps[1]]),
        (RawFormat::Pnm, maps),
    ] {
        for file in files {
            assert!(raw(file, format, None).is_ok(), "{format:?}");
            for length in 0..file.len() - 2 {
                let cut = raw(&file[..length], format, None);
                assert!(cut.is_err(), "{format:?} of {length} bytes");
            }
        }
        robust(|bytes| drop(raw(bytes, format, None)), &files);
    }
}

#[test]
fn what_these_formats_cannot_hold_is_said() {
    let refused = |file: &[u8], format| {
        let read = raw(file, format, None);
        read.expect_err("it is wrong").to_string()
    };
    let table = "
        P4 1 1\\n => with none of P2, P3, P5 and P6
        P5 1 1 70000\\n12 =>
        P5 1 1 0\\n12 =>
        P2 2 1 9 1 =>
        P2 2 1 9 1 2 3 =>
        P5 99999999 99999999 255\\n =>
        P5 1 x 255\\n =>
        P5 99999999999 1 255\\n =>";
    for [file, part] in rows(table) {
        let told = refused(file.as_bytes(), RawFormat::Pnm);
        assert!(told.contains(&part), "{file}: {told}");
    }
    let mut compressed = bitmap([1, 1], 8, &[], &[0; 4]);
    compressed[30] = 1;
    let said = refused(&compressed, RawFormat::Bmp);
    assert!(said.contains("method 1"), "{said}");
    let large = bitmap([i32::MAX, 65_535], 24, &[], &[]);
    assert!(!refused(&large, RawFormat::Bmp).is_empty(), "too large");
}
