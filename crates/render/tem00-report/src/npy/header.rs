//! The header before the values.

use std::io::Read;

use serde::Deserialize;
use serde_json::Value;

use super::NpyError;

const MAGIC: &[u8; 6] = b"\x93NUMPY";
/// The values begin at a multiple of this.
const BLOCK: usize = 64;
/// Maximum length of a header, in bytes: NumPy itself reads 10 000 unless it is told to trust the
/// file.
const LONGEST: usize = 1 << 16;
/// NumPy leaves room for the first side to grow to this many digits.
const GROWTH: usize = 21;

/// Description of the array: the entries of the dictionary in a header.
#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct Header {
    descr: Value,
    #[serde(rename = "fortran_order")]
    pub(super) columns_first: bool,
    pub(super) shape: Vec<u64>,
}

impl Header {
    pub(super) fn read(reader: &mut impl Read) -> Result<Self, NpyError> {
        let mut magic = Vec::new();
        reader.take(MAGIC.len() as u64).read_to_end(&mut magic)?;
        if !MAGIC.starts_with(&magic) {
            return Err(NpyError::Foreign);
        }
        let mut version = [0; 2];
        reader.read_exact(&mut version)?;
        let length = match version {
            [1, 0] => {
                let mut length = [0; 2];
                reader.read_exact(&mut length)?;
                usize::from(u16::from_le_bytes(length))
            }
            [2 | 3, 0] => {
                let mut length = [0; 4];
                reader.read_exact(&mut length)?;
                u32::from_le_bytes(length) as usize
            }
            [major, minor] => return Err(NpyError::Version(major, minor)),
        };
        if length > LONGEST {
            return Err(NpyError::Header(
                "it must be at most 65536 bytes long".into(),
            ));
        }
        let mut text = vec![0; length];
        reader.read_exact(&mut text)?;
        let header = serde_json::from_str(&json(&String::from_utf8_lossy(&text)));
        header.map_err(|error| NpyError::Header(error.to_string()))
    }

    /// Returns the type of the values as the file names it.
    pub(super) fn element_type(&self) -> String {
        match &self.descr {
            Value::String(name) => name.clone(),
            other => other.to_string(),
        }
    }

    /// The bytes before an array whose rows follow each other, as NumPy writes them.
    pub(super) fn bytes_of(element_type: &str, shape: &[usize]) -> Vec<u8> {
        let sides: Vec<_> = shape.iter().map(ToString::to_string).collect();
        let growth = GROWTH.saturating_sub(sides.first().map_or(0, String::len));
        let mut text = format!(
            "{{'descr': '{element_type}', 'fortran_order': False, 'shape': ({}), }}{}",
            sides.join(", "),
            " ".repeat(growth)
        );
        let start = MAGIC.len() + 4;
        let end = (start + text.len() + 1).next_multiple_of(BLOCK);
        text.extend(core::iter::repeat_n(' ', end - start - text.len() - 1));
        text.push('\n');
        let mut bytes = MAGIC.to_vec();
        bytes.extend([1, 0]);
        // Shapes of three sides at most: a few hundred bytes.
        let length = u16::try_from(text.len()).unwrap_or(u16::MAX);
        bytes.extend(length.to_le_bytes());
        bytes.extend(text.into_bytes());
        bytes
    }
}

/// Returns a dictionary of Python, like
/// `{'descr': '<c8', 'fortran_order': False, 'shape': (2, 3), }`, as JSON.
fn json(python: &str) -> String {
    let mut json = String::with_capacity(python.len());
    for c in python.chars() {
        match c {
            '\'' => json.push('"'),
            '(' => json.push('['),
            'T' | 'F' => json.push(c.to_ascii_lowercase()),
            // Python 2 wrote an L behind long numbers.
            'L' if json.ends_with(|before: char| before.is_ascii_digit()) => {}
            ')' | ']' | '}' => {
                let end = json.trim_end();
                json.truncate(end.strip_suffix(',').unwrap_or(end).len());
                json.push(if c == ')' { ']' } else { c });
            }
            _ => json.push(c),
        }
    }
    json
}
