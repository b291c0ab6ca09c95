use proptest::prelude::*;
use tem00_testkit::robust;

use super::{minimal, parse, with};

#[test]
fn any_text_is_read_or_refused() {
    let read = |bytes: &[u8]| {
        if let Err(error) = parse(&String::from_utf8_lossy(bytes)) {
            let span = error.span().unwrap_or(0..0);
            assert!(error.source_text().get(span).is_some(), "{error}");
        }
    };
    robust(read, &[minimal().as_bytes()]);
}

proptest! {
    #[test]
    fn any_number_in_any_place_is_read_or_refused(
        place in 0_usize..6,
        number in prop_oneof![
            8 => any::<f64>(),
            1 => prop::sample::select(vec![0.0, 1e308, 5e-324, f64::INFINITY, f64::NAN]),
        ],
    ) {
        let places = ["\"300 mm\"", "\"650 nm\"", "\"5 mW\"", "0.1", "\"0.5 mm\"", "\"40 mm\""];
        let text = with(places[place], &toml_float(number));
        match parse(&text) {
            Ok(scene) => prop_assert!(scene.camera.image_distance().is_finite(), "{text}"),
            Err(error) => prop_assert!(!error.message().is_empty(), "{text}"),
        }
    }
}

/// Spells a number as TOML does.
fn toml_float(number: f64) -> String {
    format!("{number:e}").replace("NaN", "nan")
}
