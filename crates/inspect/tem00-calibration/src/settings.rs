use tem00_config::{Document, LENGTH, Problem, Section};

/// The keys of the section `[calibration]`.
const KEYS: &[&str] = &["method", "uncertainty", "corners", "square_size", "boards"];

/// Calibration of camera and laser plane, as a file gives it.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct CalibrationSettings {
    /// The boards from whose images the calibration is estimated; `None` for camera and laser plane
    /// as in the file, without error.
    pub boards: Option<BoardSettings>,
    /// The standard uncertainty of a height, in metres, that the calibration has from other
    /// sources.
    pub uncertainty: f64,
}

/// The images of a checkerboard from which a calibration is estimated.
#[derive(Clone, Debug, PartialEq)]
pub struct BoardSettings {
    /// The numbers of inner corners along the rows and along the columns.
    pub corners: [usize; 2],
    /// The side of a square, in metres; `None` for the side with which the board fills the image.
    pub square: Option<f64>,
    /// The number of boards that are rendered.
    pub boards: usize,
}

impl Default for BoardSettings {
    fn default() -> Self {
        Self {
            corners: [9, 6],
            square: None,
            boards: 12,
        }
    }
}

/// Reads the section `[calibration]` of a file; without one the calibration is exact.
///
/// # Errors
///
/// Returns a problem, placed in the file, if a value is not possible, or if the keys of a board
/// stand in an exact calibration.
pub fn read_calibration(document: &Document<'_>) -> Result<CalibrationSettings, Problem> {
    let Some(section) = document.table("calibration", KEYS)? else {
        return Ok(CalibrationSettings::default());
    };
    let choices = [("exact", false), ("estimated", true)];
    let estimated = section.or("method", false, |value| value.one_of(&choices))?;
    let uncertainty = section.or("uncertainty", 0.0, |value| {
        value.within(&LENGTH, 0.0.., "a standard uncertainty of 0 or more")
    })?;
    let boards = if estimated {
        Some(boards(&section)?)
    } else {
        refuse_boards(&section)?;
        None
    };
    Ok(CalibrationSettings {
        boards,
        uncertainty,
    })
}

fn boards(section: &Section<'_>) -> Result<BoardSettings, Problem> {
    let default = BoardSettings::default();
    let corners = match section.optional("corners") {
        Some(value) => {
            let [columns, rows] = value.elements("two numbers of inner corners, such as [9, 6]")?;
            [
                number(columns.integer(3..=50)?),
                number(rows.integer(3..=50)?),
            ]
        }
        None => default.corners,
    };
    let square = section
        .optional("square_size")
        .map(|value| value.positive(&LENGTH));
    Ok(BoardSettings {
        corners,
        square: square.transpose()?,
        boards: number(section.or("boards", 12, |value| value.integer(3..=1000))?),
    })
}

/// A whole number of at most 1000.
fn number(value: u64) -> usize {
    usize::try_from(value).unwrap_or(0)
}

fn refuse_boards(section: &Section<'_>) -> Result<(), Problem> {
    let of_boards = &KEYS[2..];
    match of_boards.iter().find(|key| section.has(key)) {
        None => Ok(()),
        Some(key) => {
            let problem = format!("{key} belongs to an estimated calibration");
            Err(section
                .problem_with(key, problem)
                .with_help("write `method = \"estimated\"`"))
        }
    }
}

#[cfg(test)]
mod tests {
    use std::path::Path;

    use tem00_config::{Format, parse_document};
    use tem00_testkit::rows;

    use super::*;

    const FORMAT: Format = Format {
        noun: "set-up",
        keys: &["calibration"],
        uncertain: &[],
        help: "",
    };

    fn read(text: &str) -> Result<CalibrationSettings, String> {
        parse_document(text, Path::new("."), FORMAT, read_calibration)
            .map_err(|error| format!("{:?} {error}", error.line_column()))
    }

    #[test]
    fn without_a_section_the_calibration_is_exact() {
        assert_eq!(read("").unwrap(), CalibrationSettings::default());
        let known = read("[calibration]\nuncertainty = \"2 um\"").unwrap();
        assert_eq!(known.boards, None);
        assert!((known.uncertainty - 2e-6).abs() < 1e-20, "{known:?}");
    }

    #[test]
    fn boards_are_described_by_their_corners() {
        let text = "[calibration]\nmethod = \"estimated\"\ncorners = [7, 5]\n\
                    square_size = \"3 mm\"\nboards = 20";
        let expected = BoardSettings {
            corners: [7, 5],
            square: Some(3e-3),
            boards: 20,
        };
        assert_eq!(read(text).unwrap().boards, Some(expected));
    }

    #[test]
    fn mistakes_are_placed_in_the_file() {
        let table = r#"
            method = "guessed" => one of
            corners = [7, 5] => belongs to an estimated
            method = "estimated"\ncorners = [2, 5] => corners
            method = "estimated"\nboards = 1 => boards
            method = "estimated"\nsquare_size = "0 mm" => square_size
            uncertainty = "-1 um" => uncertainty
            squares = [7, 5] => squares
        "#;
        for [text, part] in rows(table) {
            let error = read(&format!("[calibration]\n{text}")).unwrap_err();
            assert!(error.contains(&part), "{text}: {error}");
            assert!(error.starts_with("Some(("), "{text}: {error}");
        }
    }
}
