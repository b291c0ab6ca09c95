use std::{sync::Barrier, thread};

use tem00_beam::GaussianBeam;
use tem00_decorrelation::{ImagingGeometry, LensData};
use tem00_speckle::PupilField;

use super::*;
use crate::testing::last;

fn refuse(parameter: &str, message: &str) -> Status {
    call(|| Err(Failure::argument(parameter, message)))
}

#[test]
fn a_panic_becomes_a_status_and_its_text_the_message() {
    let cases: [(fn(), &str); 3] = [
        (|| panic!("a slice is too short"), "a slice is too short"),
        (|| panic!("slice {}", core::hint::black_box(7)), "slice 7"),
        (|| std::panic::panic_any(3), "no reason given"),
    ];
    for (body, text) in cases {
        let status = call(|| {
            body();
            Ok(())
        });
        assert_eq!(status, Status::Panic, "{text}");
        assert_eq!(
            last(),
            [format!("the library failed: {text}"), String::new()]
        );
    }
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
    refuse("y", "got 'a\0b'");
    assert_eq!(
        last(),
        ["got 'a b'", "y"],
        "a zero in a message does not end it"
    );
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
        let [text, parameter] = last();
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
fn each_thread_has_its_own_message() {
    let both_failed = Barrier::new(2);
    thread::spawn(|| assert_eq!(last(), ["", ""], "on a new thread"))
        .join()
        .unwrap();
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
        assert_eq!(failure, Failure::argument(parameter, message));
    }
    let [needed, limit] = [2, 1];
    let failure = Failure::from(SpeckleError::MemoryLimit { needed, limit });
    assert_eq!(failure.status, Status::Memory, "{}", failure.message);
}
