use proptest::prelude::*;

use super::{minimal, parse, with};

proptest! {
    #[test]
    fn any_text_is_read_or_refused(text in ".{0,200}") {
        // The message is made, too: it slices the text.
        let _ = parse(&text).map_err(|error| error.to_string());
    }

    #[test]
    fn any_damage_to_a_scene_is_read_or_refused(
        start in 0_usize..400,
        length in 0_usize..12,
        patch in "[-0-9a-z.\"'\\[\\]{}=, \nµ]{0,12}",
    ) {
        let text: Vec<char> = minimal().chars().collect();
        let start = start.min(text.len());
        let end = (start + length).min(text.len());
        let damaged: String = text[..start].iter().copied()
            .chain(patch.chars())
            .chain(text[end..].iter().copied())
            .collect();
        if let Err(error) = parse(&damaged) {
            let span = error.span().unwrap_or(0..0);
            prop_assert!(error.source_text().get(span).is_some(), "{error}");
        }
    }

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
