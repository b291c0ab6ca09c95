//! Tests of the kinds of TIFF files that other programs write, made byte by byte.

use std::io::Cursor;

use tem00_testkit::rows;

use super::{RawFormat, decode, hex, numbers, raw};
use crate::image::{ImageError, LoadedImage, RawImage, Reading};

/// An entry of a directory: its tag, and its numbers of 16 bits.
type Entry = (u16, Vec<u16>);

/// Returns the entries of a directory: `tag:number,number`. Beside those of every file, the tags
/// are 258 (bits), 262 (0 white is zero, 1 black is zero, 2 RGB, 3 palette, 5 inks), 277 (samples),
/// 284 (2 planes), 259 (compression), 339 (2 signed, 3 floating-point numbers), 320 (palette), 338
/// (2 opacity, 1 the same, multiplied), 266 (2 bits in reverse), 274 (orientation).
fn entries(text: &str) -> Vec<Entry> {
    let number = |word: &str| word.parse().expect(word);
    let entry = |word: &str| {
        let (tag, numbers) = word.split_once(':').expect(word);
        (number(tag), numbers.split(',').map(number).collect())
    };
    text.split_whitespace().map(entry).collect()
}

fn listed(number: impl Fn(u16) -> u16, count: u16) -> String {
    let words: Vec<String> = (0..count).map(|index| number(index).to_string()).collect();
    words.join(",")
}

/// A file of one directory in either order of bytes, `II` or `MM`, whose strips stand behind it.
fn tiff(order: &str, size: [u16; 2], entries: &str, strips: &[&[u8]]) -> Vec<u8> {
    let is_big = order == "MM";
    let two = |value: u16| {
        if is_big {
            value.to_be_bytes()
        } else {
            value.to_le_bytes()
        }
    };
    let four = |value: usize| {
        let value = u32::try_from(value).expect("a small file");
        if is_big {
            value.to_be_bytes()
        } else {
            value.to_le_bytes()
        }
    };
    let short = |length: usize| u16::try_from(length).expect("short");
    let lengths = strips.iter().map(|strip| short(strip.len()));
    let mut entries = self::entries(entries);
    entries.extend([
        (256, vec![size[0]]),
        (257, vec![size[1]]),
        (273, vec![0; strips.len()]),
        (279, lengths.collect()),
    ]);
    entries.sort();
    let mut behind = 8 + 2 + 12 * entries.len() + 4;
    let further = entries.iter().map(|(_, values)| 2 * values.len().max(2));
    let strips_at = behind + further.sum::<usize>();
    let places = strips.iter().scan(strips_at, |at, strip| {
        *at += strip.len();
        Some(short(*at - strip.len()))
    });
    for (_, values) in entries.iter_mut().filter(|(tag, _)| *tag == 273) {
        *values = places.clone().collect();
    }
    let count = two(short(entries.len()));
    let mut file = [order.as_bytes(), &two(42), &four(8), &count].concat();
    let mut further = Vec::new();
    for (tag, values) in entries {
        let mut bytes: Vec<u8> = values.iter().flat_map(|&value| two(value)).collect();
        bytes.resize(bytes.len().max(4), 0);
        file.extend([&two(tag)[..], &two(3), &four(values.len())].concat());
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

#[test]
fn grey_values_of_all_kinds_are_read() {
    // Three pixels: order of bytes and entries, their bytes, their values, and their bits, 0
    // without a largest value. Rows are whole bytes, the highest bits first; PackBits has a run of
    // five bytes as they are.
    let table = "
        II 258:12 262:1 => 12 3a bc ff f0 => 291 2748 4095 => 12
        MM 258:12 262:1 => 12 3a bc ff f0 => 291 2748 4095 => 12
        II 258:10 262:1 => 00 7f f8 00 => 1 1023 512 => 10
        II 258:14 262:1 => 00 07 ff f8 00 00 => 1 16383 8192 => 14
        II 258:4 262:1 => 1f 70 => 1 15 7 => 4
        II 258:1 262:1 => a0 => 1 0 1 => 1
        II 258:12 262:0 => fe ef fe 00 00 => 17 1 4095 => 12
        II 258:12 262:1 259:32773 => 04 12 3a bc ff f0 => 291 2748 4095 => 12
        II 258:32 262:1 339:3 => 0000803e bd378635 00b88847 => 0.25 1e-6 7e4 => 0
        MM 258:32 262:1 339:3 => 3e800000 358637bd 4788b800 => 0.25 1e-6 7e4 => 0
        II 258:64 262:1 339:3 => 000000000000e03f 0000000000000440 0000000065cdcd41 => 0.5 2.5 1e9 => 0
        II 258:16 262:1 339:3 => 003c 00c0 ff7b => 1 -2 65504 => 0
        II 258:16 262:1 339:2 => fbff 0000 007d => -5 0 32000 => 0
        II 258:8 262:1 339:2 => ff 03 7f => -1 3 127 => 0
        MM 258:32 262:1 339:2 => fffeee90 00000005 00000009 => -70000 5 9 => 0
        MM 258:32 262:1 => 00011170 00000005 00000009 => 70000 5 9 => 0
        II 258:8 262:3 320:RAMP => 00 fa ff => 255 5 0 => 8
        MM 258:16 262:1 => 0100 0007 ffff => 256 7 65535 => 16";
    let table = table.replace("RAMP", &listed(|v| 257 * (255 - v % 256), 768));
    for [entries, bytes, values, bits] in rows(&table) {
        let (order, entries) = entries.split_once(' ').expect("an order");
        let strip = hex(&bytes);
        let image = image_of(&tiff(order, [3, 1], entries, &[&strip]), None).expect(entries);
        let values = numbers(&values);
        assert_eq!(image.values.values(), values, "{entries}");
        assert_eq!(image.bit_depth.unwrap_or(0).to_string(), bits, "{entries}");
        // A second row in a strip of its own.
        let of_two = tiff(
            order,
            [3, 2],
            &format!("{entries} 278:1"),
            &[&strip, &strip],
        );
        let image = image_of(&of_two, None).expect(entries);
        assert_eq!(image.values.values(), values.repeat(2), "{entries}");
    }
}

#[test]
fn colours_stand_pixel_by_pixel_in_planes_or_in_a_palette() {
    // Two pixels: entries, strips, and what is added to all values. Palettes have 8 bits, twice in
    // 16 or in their upper half, or 16.
    let table = "
        II 258:8,8,8 262:2 277:3 => 09 0a 14 50 5a 64 => 0
        II 258:8,8,8 262:2 277:3 284:2 => 09 50/0a 5a/14 64 => 0
        MM 258:16,16,16 262:2 277:3 284:2 => 0009 0050/000a 005a/0014 0064 => 0
        II 258:2 262:3 320:TWICE => 10 => 0
        MM 258:2 262:3 320:UPPER => 10 => 0
        MM 258:2 262:3 320:DEEP => 10 => 1000
        II 258:12,12,12 262:2 277:3 => 00 90 0a 01 40 50 05 a0 64 => 0
        II 258:8,8,8,8 262:2 277:4 338:2 => 09 0a 14 07 50 5a 64 07 => 0
        II 258:8,8,8,8 262:2 277:4 338:2 284:2 => 09 50/0a 5a/14 64/07 07 => 0";
    let colours = [9, 80, 0, 0, 10, 90, 0, 0, 20, 100, 0, 0];
    let of = |stored: fn(u16) -> u16| listed(|index| stored(colours[usize::from(index)]), 12);
    let table = table.replace("TWICE", &of(|v| 257 * v));
    let table = table
        .replace("UPPER", &of(|v| 256 * v))
        .replace("DEEP", &of(|v| v + 1000));
    for [entries, strips, offset] in rows(&table) {
        let (order, entries) = entries.split_once(' ').expect("an order");
        let strips: Vec<Vec<u8>> = strips.split('/').map(hex).collect();
        let strips: Vec<&[u8]> = strips.iter().map(|strip| &**strip).collect();
        let file = tiff(order, [2, 1], entries, &strips);
        let offset: f32 = offset.parse().expect("a number");
        for (channel, expected) in [
            (None, [13.0, 90.0]),
            (Some("R"), [9.0, 80.0]),
            (Some("G"), [10.0, 90.0]),
            (Some("b"), [20.0, 100.0]),
        ] {
            let found = image_of(&file, channel).expect(entries).values;
            let expected = expected.map(|value| value + offset);
            assert_eq!(found.values(), expected, "{entries}");
        }
    }
}

fn image_of(file: &[u8], channel: Option<&str>) -> Result<RawImage, ImageError> {
    raw(file, RawFormat::Tiff, channel)
}

fn light(file: &[u8]) -> Result<LoadedImage, ImageError> {
    let samples = decode(Cursor::new(file), RawFormat::Tiff)?;
    samples.upright().judged(None)?.light(&Reading::default())
}

#[test]
fn what_a_file_says_beside_its_pixels_is_honoured_or_said() {
    let of_three = |further: &str| {
        let entries = format!("258:8 262:1 {further}");
        light(&tiff("II", [3, 1], &entries, &[&[51, 102, 255]])).expect("three pixels")
    };
    let turned = of_three("274:3");
    assert_eq!(turned.values.values(), [1.0, 0.4, 0.2]);
    assert!(turned.interpretation.contains("turned"), "{turned:?}");
    let told = of_three("34675:1,2,3").interpretation;
    assert!(told.contains("profile of the file is not read"), "{told}");
    let alpha = "258:8,8 262:1 277:2 338:1";
    let grey = light(&tiff("II", [2, 1], alpha, &[&[51, 9, 255, 9]])).expect("two pixels");
    assert_eq!(grey.values.values(), [0.2, 1.0], "never opacity");
    let bands = "258:8,8,8 262:1 277:3";
    let bands = tiff("II", [2, 1], bands, &[&[51, 9, 1, 255, 9, 1]]);
    let asked = light(&bands).expect_err("bands of anything").to_string();
    assert!(asked.contains("--channel: 1, 2, 3"), "{asked}");
    let second = image_of(&bands, Some("2")).expect("there is one").values;
    assert_eq!(second.values(), [9.0, 9.0]);
}

#[test]
fn what_is_not_read_is_refused_with_its_reason() {
    let row = [0_u8; 12];
    let table = "
        258:12,12,12 262:2 277:3 284:2 => 3 × 12 bits
        258:8 262:1 266:2 => 1 × 8 bits
        258:8,8,8,8 262:5 277:4 => CMYK
        258:24 262:1 => 1 × 24 bits
        258:8 262:3 320:7,7,7,7,7,7,7,7,7 => palettes
        258:8 262:1 259:7 => ompress
        258:BANDS 262:1 277:17 => Multiband";
    for [entries, part] in rows(&table.replace("BANDS", &listed(|_| 8, 17))) {
        let strips = if entries.contains("284:2") { 3 } else { 1 };
        let file = tiff("II", [1, 1], &entries, &[&row[..]; 3][..strips]);
        let told = light(&file).expect_err(&entries).to_string();
        assert!(told.contains(&part), "{entries}: {told}");
    }
    // Pixels that 12 bytes cannot hold, and more of them than are ever read.
    for (height, part) in [(4_096, "cannot hold"), (65_535, "65535 × 65535 pixels")] {
        let claim = tiff("II", [65_535, height], "258:8 262:1", &[&row]);
        let told = light(&claim).expect_err("a claim").to_string();
        assert!(told.contains(part), "{told}");
    }
}
