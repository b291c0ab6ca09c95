//! Any text is a scene or an error with a place in that text.

#![no_main]

use std::path::Path;

use libfuzzer_sys::fuzz_target;
use tem00_scene::parse_scene;

fuzz_target!(|text: &str| {
    if let Err(error) = parse_scene(text, Path::new("/nowhere")) {
        assert!(!error.to_string().is_empty());
        assert!(
            error
                .span()
                .is_none_or(|span| error.source_text().get(span).is_some())
        );
    }
});
