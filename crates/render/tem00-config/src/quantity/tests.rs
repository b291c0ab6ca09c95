use tem00_testkit::rows;

use super::*;

#[test]
fn quantities_are_the_numbers_they_spell() {
    let cases = [
        (&LENGTH, "650 nm", 650e-9),
        (&LENGTH, "650nm", 650e-9),
        (&LENGTH, "  0.25  mm ", 0.25e-3),
        (&LENGTH, "-5e1 um", -50e-6),
        (&LENGTH, "3.45 \u{b5}m", 3.45e-6),
        (&LENGTH, "3.45 \u{3bc}m", 3.45e-6),
        (&LENGTH, "2. cm", 0.02),
        (&LENGTH, "1e-3 m", 1e-3),
        (&ANGLE, "180 deg", core::f64::consts::PI),
        (&ANGLE, "90°", core::f64::consts::FRAC_PI_2),
        (&ANGLE, "20 mrad", 0.02),
        (&POWER, "5 mW", 5e-3),
        (&RADIANCE, "0.5 W/(m2 sr)", 0.5),
        (&MEMORY, "1 GiB", 1_073_741_824.0),
        (&MEMORY, "100 MB", 1e8),
    ];
    for (dimension, text, expected) in cases {
        assert_eq!(dimension.parse(text), Some(expected), "{text:?}");
    }
}

#[test]
fn messages_come_back_in_the_unit_that_was_typed() {
    let table = "
        20 mm => focus_distance must be greater than the focal length (in metres), got 0.02
            => focus_distance must be greater than the focal length, got 20 mm
        0.1 um => waist radius 5e-8 m is below the limit of 4.138e-7 m
            => waist radius 0.05 um is below the limit of 0.4138 um
        10 um => wavelength must be from 368e-9 m to 1088e-9 m, where it was measured, got 0.00001
            => wavelength must be from 0.368 um to 1.088 um, where it was measured, got 10 um
        0 W => power must be at least 0.5, got 0
            => power must be at least 0.5, got 0 W
        180 deg => at most 1 rad
            => at most 57.3 deg
        0.5 um => line_thickness must be from 1 µm to 1 m (in metres), got 5e-7
            => line_thickness must be from 1 um to 1000000 um, got 0.5 um
        2 rad => angle must be from 1° to 89° (in radians), got 2
            => angle must be from 0.01745 rad to 1.553 rad, got 2 rad
        10 mm => distance must be from 1.001 focal lengths to 1 m (in metres), got 0.01
            => distance must be from 1.001 focal lengths to 1000 mm, got 10 mm
        2000 W => power must be positive, at most 1000000 mW (in watts), got 2000
            => power must be positive, at most 1000 W, got 2000 W
    ";
    let table = table.replace("\n            =>", " =>");
    for [typed, message, expected] in rows(&table) {
        let dimensions = [&LENGTH, &ANGLE, &POWER].into_iter();
        let mut retyped = dimensions.filter_map(|of| of.retyped(&message, &typed));
        assert_eq!(retyped.next(), Some(expected), "{typed}");
    }
    let bare = LENGTH.retyped("got 5", "5");
    assert_eq!(bare, None, "a bare number is in SI units");
}

#[test]
fn anything_else_is_no_quantity() {
    let not_lengths = "|mm|5|5 deg|5 mW|5 MM|1 2 mm|nan mm|inf m|0x10 mm|1,5 mm|5 mm wide|\
                       --5 mm|5 m m|e5 m|5e mm";
    for text in not_lengths.split('|') {
        assert_eq!(LENGTH.parse(text), None, "{text:?}");
    }
}

#[test]
fn values_are_written_as_a_person_writes_them() {
    // The text that is read, and the text that is written: as short, in the usual unit if it may
    // be.
    for (dimension, usual, text, expected) in [
        (&DURATION, "ms", "0.16 ms", "0.16 ms"),
        (&DURATION, "ms", "20 us", "0.02 ms"),
        (&ANGLE, "deg", "40 deg", "40 deg"),
        (&ANGLE, "deg", "0.25 rad", "250 mrad"),
        (&LENGTH, "nm", "0.66 um", "660 nm"),
        (&LENGTH, "um", "3.45 um", "3.45 um"),
        (&LENGTH, "mm", "0.3 m", "300 mm"),
        (&POWER, "mW", "1e1 mW", "10 mW"),
    ] {
        let value = dimension.parse(text).unwrap();
        assert_eq!(dimension.text(value, usual), format!("\"{expected}\""));
        let read = dimension.parse(expected).unwrap();
        assert_eq!(read.to_bits(), value.to_bits(), "{text} is {expected}");
    }
    assert_eq!(NUMBER.text(5.6, ""), "5.6");
    assert_eq!(NUMBER.text(1e-9, ""), "1e-9");
    // No unit makes this short.
    assert_eq!(ANGLE.text(0.1 + 0.2, "deg"), "0.30000000000000004");
}

#[test]
fn values_are_rounded_to_what_reads_back() {
    // A third of the way from 0.02 ms to 0.64 ms on a logarithmic scale, and its neighbours.
    let value = 0.02e-3 * 32.0_f64.powf(3.0 / 5.0);
    let rounded = DURATION.rounded(value, 0.8e-6, "ms");
    assert_eq!(Some(rounded), DURATION.parse("0.16 ms"));
    assert_eq!(DURATION.text(rounded, "ms"), "\"0.16 ms\"");
    let rounded = |value, step| Some(NUMBER.rounded(value, step, ""));
    assert_eq!(rounded(5.039_68, 0.0104), Some(5.04));
    assert_eq!(rounded(123.4, 30.0), Some(123.0), "no step is so wide");
    for step in [0.0, f64::NAN, 1e-30] {
        assert_eq!(rounded(5.039_68, step), Some(5.039_68), "{step}");
    }
}

#[test]
fn the_list_of_units_reads_as_a_sentence() {
    assert_eq!(LENGTH.units(), "nm, um, µm, mm, cm or m", "lengths");
    assert_eq!(NUMBER.units(), "", "numbers have no unit");
}
