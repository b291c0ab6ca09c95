//! Values from a command line that replace values of a file.

use core::{ops::Range, str::FromStr};

use toml_edit::{DocumentMut, Item, Value};

use crate::error::Problem;
use crate::input_file::FileAccess;
use crate::source::INCLUDE;

/// A key of a document, and the value that replaces the value of the file.
///
/// A change is written `camera.f_number=8`: the path of the key, with dots between tables, and the
/// value in the syntax of the file. An index counts several tables of one name, such as lasers,
/// from 0: `laser[0].power=2 mW`. A value that is not valid TOML is taken as a string, so that
/// quotation marks, which shells remove, may be left out.
///
/// The value is read as if it stood in the file: the same rules apply, and the error for an unknown
/// key names the nearest known key.
///
/// # Examples
///
/// ```
/// use tem00_config::Change;
///
/// let change: Change = "laser[0].power=2 mW".parse()?;
/// assert_eq!(change.to_string(), "laser[0].power=2 mW");
/// assert!("camera".parse::<Change>().is_err());
/// # Ok::<(), String>(())
/// ```
#[derive(Clone, Debug)]
pub struct Change {
    text: String,
    path: Vec<Step>,
    value: Value,
}

/// Settings for reading a document: where the files that it names may lie,
/// and which of its values are replaced.
#[derive(Clone, Copy, Debug)]
pub struct Reading<'a> {
    /// The locations of the files that the document may name.
    pub access: FileAccess,
    /// The values that replace values of the document.
    pub changes: &'a [Change],
}

impl From<FileAccess> for Reading<'_> {
    /// Reads the file without changes.
    fn from(access: FileAccess) -> Self {
        Self {
            access,
            changes: &[],
        }
    }
}

/// The maximum number of steps in the path of a key. Files use five.
const MAX_STEPS: usize = 32;

/// A step towards a value.
#[derive(Clone, Debug, PartialEq, Eq)]
enum Step {
    Key(String),
    Index(usize),
}

impl FromStr for Change {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        let parsed = text.split_once('=').and_then(|(path, value)| {
            let path: Option<Vec<_>> = path.trim().split('.').map(steps).collect();
            Some((path?.concat(), value.trim()))
        });
        let (path, value) = parsed.ok_or(
            "must be a key and its value, such as camera.f_number=8 or laser[0].power=2mW",
        )?;
        if path.len() > MAX_STEPS {
            let steps = path.len();
            return Err(format!("a key has at most {MAX_STEPS} steps, got {steps}"));
        }
        if matches!(path.as_slice(), [Step::Key(key), ..] if key == INCLUDE) {
            return Err("`include` cannot be changed: what it names has been read".into());
        }
        Ok(Self {
            text: text.to_owned(),
            path,
            value: value.parse().unwrap_or_else(|_| Value::from(value)),
        })
    }
}

impl core::fmt::Display for Change {
    fn fmt(&self, f: &mut core::fmt::Formatter<'_>) -> core::fmt::Result {
        f.write_str(&self.text)
    }
}

/// Reads a key with the indices behind it, as in "laser[0]".
fn steps(text: &str) -> Option<Vec<Step>> {
    let (key, indices) = match text.split_once('[') {
        Some((key, indices)) => (key, indices.strip_suffix(']')?.split("][").collect()),
        None => (text, Vec::new()),
    };
    let is_bare = |c: char| c.is_ascii_alphanumeric() || c == '_' || c == '-';
    if key.is_empty() || !key.chars().all(is_bare) {
        return None;
    }
    let indices = indices
        .into_iter()
        .map(|index| index.parse().map(Step::Index).ok());
    [Some(Step::Key(key.to_owned()))]
        .into_iter()
        .chain(indices)
        .collect()
}

/// Writes the changes into the texts of a document. Each change goes into the text that has its
/// section, or else into the text with the index `main`. The texts are TOML, in the order in which
/// they are put together.
pub(crate) fn apply(changes: &[Change], texts: &mut [String], main: usize) -> Result<(), Problem> {
    let documents = texts.iter().map(|text| text.parse::<DocumentMut>());
    let documents: Result<Vec<_>, _> = documents.collect();
    // Reading the texts afterwards reports what is wrong with them, and where.
    let Ok(mut documents) = documents else {
        return Ok(());
    };
    for change in changes {
        change.apply(&mut documents, main)?;
    }
    for (text, document) in texts.iter_mut().zip(documents) {
        *text = document.to_string();
    }
    Ok(())
}

/// Returns the first change after which the text with a number has a line.
pub(crate) fn writer<'a>(
    changes: &'a [Change],
    texts: &[String],
    number: usize,
    line: &str,
) -> Option<&'a Change> {
    let has_line = |&last: &usize| {
        let mut texts = texts.to_vec();
        let main = texts.len() - 1;
        let applied = apply(&changes[..=last], &mut texts, main);
        applied.is_ok() && texts[number].lines().any(|written| written == line)
    };
    (0..changes.len())
        .find(has_line)
        .map(|index| &changes[index])
}

impl Change {
    /// Returns whether both change the same value, or one replaces a whole of which the other
    /// changes a part.
    pub fn overlaps(&self, other: &Self) -> bool {
        let steps = self.path.len().min(other.path.len());
        self.path[..steps] == other.path[..steps]
    }

    /// Returns the text of the change.
    pub(crate) fn text(&self) -> &str {
        &self.text
    }

    /// Returns the place in the text of the change of what it has written, which may have
    /// quotation marks there.
    pub(crate) fn span_of(&self, written: &str) -> Range<usize> {
        let found = [written, written.trim_matches('"')]
            .into_iter()
            .find_map(|part| Some((self.text.rfind(part)?, part.len())));
        found.map_or(0..self.text.len(), |(start, length)| start..start + length)
    }

    fn apply(&self, documents: &mut [DocumentMut], main: usize) -> Result<(), Problem> {
        let mut path = self.path.clone();
        let owner = owner(&mut path, documents).unwrap_or(main);
        let Some(document) = documents.get_mut(owner) else {
            return Ok(());
        };
        let mut item = document.as_item_mut();
        for (depth, step) in path.iter().enumerate() {
            let next = match step {
                Step::Key(key) => item.get_mut(key.as_str()),
                Step::Index(index) => item.get_mut(*index),
            };
            item = next.ok_or_else(|| self.nowhere(depth))?;
        }
        let mut value = self.value.clone();
        let decor = item.as_value().map(Value::decor).cloned();
        *value.decor_mut() = decor.unwrap_or_default();
        if value.decor().prefix().is_none() {
            value.decor_mut().set_prefix(" ");
        }
        *item = Item::Value(value);
        Ok(())
    }

    /// Returns the problem that there is nothing at a step of the path.
    fn nowhere(&self, depth: usize) -> Problem {
        let written = |steps: &[Step]| {
            let text = steps.iter().map(|step| match step {
                Step::Key(key) => format!(".{key}"),
                Step::Index(index) => format!("[{index}]"),
            });
            text.collect::<String>().trim_start_matches('.').to_owned()
        };
        let message = match &self.path[depth] {
            Step::Key(_) => format!(
                "`{}`: `{}` has no keys of its own",
                self.text,
                written(&self.path[..depth])
            ),
            Step::Index(_) => format!(
                "`{}`: there is no `{}`; indices count from 0",
                self.text,
                written(&self.path[..=depth])
            ),
        };
        Problem::new(message)
    }
}

/// Returns the number of the document that has the section at the start of a path. Where several
/// documents have tables of that section, the index counts through all of them and is converted
/// into the index within its document.
fn owner(path: &mut [Step], documents: &[DocumentMut]) -> Option<usize> {
    let [Step::Key(key), rest @ ..] = path else {
        return None;
    };
    let mut owner = None;
    for (number, document) in documents.iter().enumerate() {
        let Some(item) = document.get(key) else {
            continue;
        };
        owner = Some(number);
        let tables = item.as_array_of_tables().map(toml_edit::ArrayOfTables::len);
        match (tables, rest.first_mut()) {
            (Some(count), Some(Step::Index(index))) if *index >= count => *index -= count,
            _ => return owner,
        }
    }
    // An index beyond the last table is no index of the last document either.
    if let (Some(_), Some(Step::Index(index))) = (owner, rest.first_mut()) {
        *index = usize::MAX;
    }
    owner
}

#[cfg(test)]
mod tests {
    use super::*;

    const TEXT: &str = "# a scene\nseed = 1\n[camera]\nf_number = 8 # stopped down\n\
                        tilt = { angle = \"5 deg\" }\n[[laser]]\npower = \"5 mW\"\n\
                        spot.waist_radius = \"1 mm\"\n[[laser]]\n";

    fn changed(changes: &[&str]) -> Result<String, Problem> {
        let changes: Vec<Change> = changes.iter().map(|text| text.parse().unwrap()).collect();
        let mut texts = [TEXT.to_owned()];
        apply(&changes, &mut texts, 0)?;
        let [text] = texts;
        Ok(text)
    }

    #[test]
    fn a_value_takes_the_place_of_another_and_nothing_else_changes() {
        for (change, from, to) in [
            ("seed=7", "seed = 1", "seed = 7"),
            (
                "camera.f_number = 2.8",
                "f_number = 8 #",
                "f_number = 2.8 #",
            ),
            ("laser[0].power=2 mW", "\"5 mW\"", "\"2 mW\""),
            ("laser[0].power=\"2 mW\"", "\"5 mW\"", "\"2 mW\""),
            ("camera.tilt.angle=0.1", "\"5 deg\"", "0.1"),
            ("laser[0].spot.waist_radius=[1, 2]", "\"1 mm\"", "[1, 2]"),
        ] {
            assert_eq!(
                changed(&[change]).unwrap(),
                TEXT.replacen(from, to, 1),
                "{change}"
            );
        }
    }

    #[test]
    fn what_is_not_there_is_added_in_its_section() {
        let text = changed(&[
            "camera.resolution=[8, 6]",
            "laser[1].wavelength=650nm",
            "render.seed=3",
            "camera.tilt.azimuth=0",
        ]);
        let document: DocumentMut = text.unwrap().parse().unwrap();
        assert_eq!(
            document["camera"]["resolution"]
                .as_array()
                .map(toml_edit::Array::len),
            Some(2)
        );
        assert_eq!(document["laser"][1]["wavelength"].as_str(), Some("650nm"));
        assert_eq!(document["render"]["seed"].as_integer(), Some(3));
        assert_eq!(document["camera"]["tilt"]["azimuth"].as_integer(), Some(0));
        assert_eq!(document["camera"]["tilt"]["angle"].as_str(), Some("5 deg"));
    }

    #[test]
    fn paths_that_lead_nowhere_are_told() {
        for (change, part) in [
            ("laser[2].power=1", "no `laser[2]`"),
            ("camera[0].f_number=1", "no `camera[0]`"),
            ("camera.f_number.x=1", "`camera.f_number` has no keys"),
            ("laser.power=1", "`laser` has no keys"),
        ] {
            let problem = changed(&[change]).unwrap_err();
            assert!(problem.message.contains(part), "{}", problem.message);
        }
        for bad in [
            "",
            "a",
            "=1",
            "a..b=1",
            "a[=1",
            "a[x].b=1",
            "[0]=1",
            "a b=1",
            "a.=1",
            "include=1",
            &format!("a{}=1", ".a".repeat(32)),
            &format!("a{}=1", "[0]".repeat(10_000)),
        ] {
            assert!(bad.parse::<Change>().is_err(), "{bad}");
        }
        assert!(format!("a{}=1", ".a".repeat(31)).parse::<Change>().is_ok());
        // A value that is too deep for TOML is text.
        let deep = format!("a={}", "[".repeat(10_000));
        assert!(
            deep.parse::<Change>()
                .is_ok_and(|change| change.value.is_str())
        );
    }

    #[test]
    fn changes_of_one_value_overlap() {
        let change = |text: &str| text.parse::<Change>().unwrap();
        for (first, second, overlap) in [
            ("a.b=1", " a.b = 2", true),
            ("a={b = 1}", "a.b=2", true),
            ("a[0].b=1", "a[00].b=2", true),
            ("a[0].b=1", "a[1].b=2", false),
            ("a.b=1", "a.bc=2", false),
        ] {
            let [first, second] = [first, second].map(change);
            assert_eq!(first.overlaps(&second), overlap, "{first} {second}");
            assert_eq!(second.overlaps(&first), overlap, "{first} {second}");
        }
    }

    #[test]
    fn indices_count_through_all_files() {
        let mut texts = ["[[laser]]\n".to_owned(), TEXT.to_owned()];
        let change = "laser[1].power=\"1 W\"".parse().unwrap();
        apply(&[change], &mut texts, 1).unwrap();
        assert_eq!(texts[0], "[[laser]]\n");
        assert_eq!(texts[1], TEXT.replacen("5 mW", "1 W", 1));
    }
}
