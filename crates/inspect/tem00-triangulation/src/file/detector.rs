use tem00_config::{Document, NUMBER, Problem, Section, Value};

use crate::{DetectorSettings, FilterOrder, LineDetector, LineMethod};

const KEYS: &[&str] = &[
    "method",
    "window",
    "threshold",
    "order",
    "sigma",
    "min_peak",
    "max_lines",
];

/// Reads the section `[detector]`: how lines are found.
///
/// Missing keys, or a missing section, have the values of [`DetectorSettings::default`]; a missing
/// window is as wide as the method needs. The saturation is infinite: it follows from the bits of
/// the sensor.
///
/// ```toml
/// [detector]
/// method = "thresholded_centre_of_gravity"
/// threshold = 0.2        # of that method; `order` = 2, 4 or 8 is of "blais_rioux",
///                        # `sigma` of "steger"
/// window = 31            # pixels, odd
/// min_peak = 10        # grey values
/// max_lines = 1
/// ```
///
/// # Errors
///
/// Returns a problem, placed in the file, if a key is unknown, of another method, or outside its
/// range.
pub fn read_detector(document: &Document<'_>) -> Result<DetectorSettings, Problem> {
    let default = DetectorSettings::default();
    let Some(section) = document.table("detector", KEYS)? else {
        return Ok(default);
    };
    let method = method(&section)?;
    let min = method.min_window();
    let settings = DetectorSettings {
        method,
        window: section.or("window", default.window.max(min), |value| {
            window(value, min)
        })?,
        min_peak: section.or("min_peak", default.min_peak, |value| {
            value.within(&NUMBER, 0.0.., "zero or more grey values")
        })?,
        max_lines: section.or("max_lines", default.max_lines, |value| {
            whole(value, 1, DetectorSettings::MAX_LINES)
        })?,
        ..default
    };
    match LineDetector::new(settings) {
        Ok(_) => Ok(settings),
        Err(error) => Err(section.problem(error)),
    }
}

fn method(section: &Section<'_>) -> Result<LineMethod, Problem> {
    let names = LineMethod::ALL.map(|method| (method.name(), method));
    let mut method = section.or("method", LineMethod::CentreOfGravity, |value| {
        value.one_of(&names)
    })?;
    for (key, owner) in [
        ("threshold", "thresholded_centre_of_gravity"),
        ("order", "blais_rioux"),
        ("sigma", "steger"),
    ] {
        if section.has(key) && method.name() != owner {
            let message = format!("`{key}` belongs to the method \"{owner}\", not to \"{method}\"");
            return Err(section.problem_with(key, message));
        }
    }
    match &mut method {
        LineMethod::ThresholdedCentreOfGravity { threshold } => {
            *threshold = section.or("threshold", *threshold, |value| {
                value.within(
                    &NUMBER,
                    0.0..1.0,
                    "from 0 to below 1, a fraction of the peak",
                )
            })?;
        }
        LineMethod::BlaisRioux { order } => *order = section.or("order", *order, filter_order)?,
        LineMethod::Steger { sigma } => {
            *sigma = section.or("sigma", *sigma, |value| {
                value.within(&NUMBER, 0.5..=100.0, "from 0.5 to 100 pixels")
            })?;
        }
        _ => (),
    }
    Ok(method)
}

fn filter_order(value: &Value<'_>) -> Result<FilterOrder, Problem> {
    let taps = whole(value, 2, 8)?;
    FilterOrder::from_taps(taps).ok_or_else(|| value.must_be("2, 4 or 8"))
}

/// Reads an odd number of pixels.
fn window(value: &Value<'_>, min: usize) -> Result<usize, Problem> {
    let max = DetectorSettings::MAX_WINDOW;
    let pixels = whole(value, min.min(max), max)?;
    if pixels.is_multiple_of(2) {
        return Err(value.must_be("odd, with as many pixels on either side of the peak"));
    }
    Ok(pixels)
}

fn whole(value: &Value<'_>, min: usize, max: usize) -> Result<usize, Problem> {
    let number = value.integer(min as u64..=max as u64)?;
    Ok(usize::try_from(number).unwrap_or(max))
}

#[cfg(test)]
mod tests {
    use std::path::Path;

    use tem00_config::{ConfigError, Format, parse_document};
    use tem00_testkit::rows;

    use super::*;

    const FORMAT: Format = Format {
        noun: "set-up",
        keys: &["detector"],
        uncertain: &[],
        help: "",
    };

    fn read(lines: &str) -> Result<DetectorSettings, ConfigError> {
        let text = format!("[detector]\n{lines}\n");
        parse_document(&text, Path::new("."), FORMAT, read_detector)
    }

    #[test]
    fn an_empty_file_has_the_usual_detector() {
        let settings = parse_document("", Path::new("."), FORMAT, read_detector).unwrap();
        assert_eq!(settings, DetectorSettings::default());
        assert!(
            LineDetector::new(settings).is_ok(),
            "the default is a detector"
        );
    }

    #[test]
    fn every_method_can_be_named_and_keeps_its_parameters() {
        for method in LineMethod::ALL {
            let settings = read(&format!("method = \"{method}\"")).unwrap();
            assert_eq!(settings.method, method, "{method}");
            assert_eq!(LineMethod::from_name(method.name()), Some(method));
        }
        let wide = read("method = \"steger\"\nsigma = 6").unwrap();
        assert_eq!(wide.method, LineMethod::Steger { sigma: 6.0 });
        assert_eq!(wide.window, 49, "four σ to either side");
        let eighth =
            read("method = \"blais_rioux\"\norder = 8\nwindow = 11\nmax_lines = 3").unwrap();
        let order = FilterOrder::Eighth;
        assert_eq!(eighth.method, LineMethod::BlaisRioux { order });
        assert_eq!((eighth.window, eighth.max_lines), (11, 3));
    }

    #[test]
    fn what_cannot_be_is_refused_where_it_stands() {
        let table = r#"
            method = "parabla" => did you mean => 10
            window = 30 => `window` must be odd => 10
            window = 1 => from 3 to 1001 => 10
            threshold = 0.5 => belongs to the method => 13
            method = "thresholded_centre_of_gravity"\nthreshold = 1 => below 1 => 13
            method = "blais_rioux"\norder = 6 => 2, 4 or 8 => 9
            method = "blais_rioux"\norder = 8\nwindow = 9 => from 11 to 1001 => 10
            min_peak = -1 => zero or more => 12
            max_lines = 0 => from 1 to 100 => 13
            windows = 3 => did you mean `window`? => 1
        "#;
        for [text, expected, column] in rows(table) {
            let error = read(&text).unwrap_err();
            let message = format!("{error} {}", error.help().unwrap_or_default());
            assert!(message.contains(&expected), "{text}: {message}");
            let place = (text.lines().count() + 1, column.parse().unwrap());
            assert_eq!(error.line_column(), Some(place), "{text}: {message}");
        }
    }
}
