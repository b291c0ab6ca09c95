use std::{ffi::CStr, sync::Barrier, thread};

use tem00_beam::GaussianBeam;
use tem00_decorrelation::{ImagingGeometry, LensData};
use tem00_speckle::PupilField;

use super::*;

fn read(text: *const c_char) -> String {
    // SAFETY: it is the text of this thread, and no call fails meanwhile.
    unsafe { CStr::from_ptr(text) }.to_str().unwrap().to_owned()
}

/// Message and parameter of the last failure.
fn last() -> [String; 2] {
    [read(tem00_last_error()), read(tem00_last_error_parameter())]
}

fn refuse(parameter: &str, message: &str) -> Status {
    call(|| Err(Failure::argument(parameter, message)))
}

#[test]
fn a_thread_without_failure_has_no_message() {
    thread::spawn(|| assert_eq!(last(), ["", ""], "on a new thread"))
        .join()
        .unwrap();
}

#[test]
fn a_panic_becomes_a_status_and_its_text_the_message() {
    let borrowed = call(|| panic!("a slice is too short"));
    assert_eq!(borrowed, Status::Panic, "of a panic");
    assert_eq!(
        last(),
        ["the library failed: a slice is too short", ""],
        "of a str"
    );

    let formatted = call(|| panic!("slice {}", 7));
    assert_eq!(formatted, Status::Panic, "of a panic with numbers");
    assert_eq!(last(), ["the library failed: slice 7", ""], "of a String");

    let other = call(|| std::panic::panic_any(3));
    assert_eq!(other, Status::Panic, "of a panic without text");
    assert_eq!(
        last(),
        ["the library failed: no reason given", ""],
        "of a number"
    );
}

#[test]
fn a_failure_stays_until_the_next_one() {
    assert_eq!(
        refuse("x", "x is wrong"),
        Status::InvalidArgument,
        "a failure"
    );
    assert_eq!(call(|| Ok(())), Status::Ok, "a success");
    assert_eq!(last(), ["x is wrong", "x"], "after a success");
    refuse("y", "y is wrong");
    assert_eq!(last(), ["y is wrong", "y"], "after the next failure");
}

/// A program that keeps the pointer of one failure while others follow.
#[test]
fn the_pointer_of_a_failure_stays_valid_and_shows_the_next_one() {
    refuse("x", "x is wrong");
    let kept = [tem00_last_error(), tem00_last_error_parameter()];
    for length in [1, 10, 100, 1_000, 3_000] {
        let name = "y".repeat(length.min(60));
        let message = "z".repeat(length);
        refuse(&name, &message);
        assert_eq!(kept, [tem00_last_error(), tem00_last_error_parameter()]);
        let [text, parameter] = kept.map(read);
        assert_eq!(parameter, name, "at {length} bytes");
        assert!(text.starts_with(&message[..length.min(2_000)]), "{text}");
    }
}

#[test]
fn long_messages_end_between_characters() {
    for shift in 0..3 {
        refuse(
            "path",
            &format!("{}{}", "a".repeat(shift), "€".repeat(2_000)),
        );
        let [text, _] = last();
        assert!(text.len() < 2_048 && text.ends_with("€…"), "{text}");
    }
}

#[test]
fn a_zero_in_a_message_does_not_end_it() {
    refuse("path", "got 'a\0b'");
    assert_eq!(last()[0], "got 'a b'", "the whole message");
}

#[test]
fn each_thread_has_its_own_message() {
    let both_failed = Barrier::new(2);
    thread::scope(|scope| {
        for name in ["first", "second"] {
            let both_failed = &both_failed;
            scope.spawn(move || {
                refuse(name, name);
                both_failed.wait();
                assert_eq!(last(), [name, name], "on the thread {name}");
            });
        }
    });
}

#[test]
fn errors_of_the_library_keep_their_message_and_name_their_parameter() {
    let beam = GaussianBeam::from_waist(-1.0, 1e-3).unwrap_err();
    let field = PupilField::new(64, 4, 0).unwrap_err();
    let lens = ImagingGeometry::from_lens(LensData {
        wavelength: 650e-9,
        focal_length: 25e-3,
        f_number: 0.1,
        surface_to_pupil: 0.3,
        pixel_pitch: 3.45e-6,
    })
    .unwrap_err();
    let failures: [(Failure, String, &str); 3] = [
        (beam.clone().into(), beam.to_string(), "wavelength"),
        (field.clone().into(), field.to_string(), "diameter"),
        (lens.clone().into(), lens.to_string(), "f_number"),
    ];
    for (failure, message, parameter) in failures {
        assert_eq!(failure.status, Status::InvalidArgument, "{message}");
        assert_eq!(failure.message, message, "of {parameter}");
        assert_eq!(failure.parameter, parameter, "{message}");
    }
}

#[test]
fn memory_has_a_status_of_its_own() {
    let [needed, limit] = [2, 1];
    let failure = Failure::from(SpeckleError::MemoryLimit { needed, limit });
    assert_eq!(failure.status, Status::Memory, "{}", failure.message);
}
