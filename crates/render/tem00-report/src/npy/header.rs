//! The header before the values.

use std::io::Read;

use super::{
    NpyError,
    literal::{Literal, Literals},
};

const MAGIC: &[u8; 6] = b"\x93NUMPY";
/// The values begin at a multiple of this.
const BLOCK: usize = 64;
/// Maximum length of a header, in bytes: NumPy itself reads 10 000 unless it is told to trust the file.
const LONGEST: usize = 1 << 16;
/// NumPy leaves room for the first side to grow to this many digits.
const GROWTH: usize = 21;

/// Description of the array.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(super) struct Header {
    pub(super) element_type: String,
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
            [major, minor] => return Err(NpyError::Version { major, minor }),
        };
        if length > LONGEST {
            return Err(NpyError::Header("it must be at most 65536 bytes long"));
        }
        let mut text = vec![0; length];
        reader.read_exact(&mut text)?;
        let text = str::from_utf8(&text).map_err(|_| NpyError::Header("it must be text"))?;
        Self::parse(text)
    }

    /// Reads a dictionary like `{'descr': '<c8', 'fortran_order': False, 'shape': (2, 3), }`.
    fn parse(text: &str) -> Result<Self, NpyError> {
        let mut entries = Literals::new(text);
        let mut found = [None, None, None];
        if !entries.takes('{') {
            return Err(NpyError::Header("it must be a dictionary of Python"));
        }
        while !entries.takes('}') {
            let known = match entries.text() {
                Some("descr") => 0,
                Some("fortran_order") => 1,
                Some("shape") => 2,
                _ => {
                    return Err(NpyError::Header(
                        "its entries must be descr, fortran_order and shape",
                    ));
                }
            };
            if !entries.takes(':') {
                return Err(NpyError::Header("an entry has no value"));
            }
            found[known] = Some(entries.value()?);
            if !entries.takes(',') && !entries.clone().takes('}') {
                return Err(NpyError::Header("its entries must be separated by commas"));
            }
        }
        if !entries.is_at_end() {
            return Err(NpyError::Header("nothing must follow its dictionary"));
        }
        Self::from_entries(found)
    }

    fn from_entries(entries: [Option<Literal>; 3]) -> Result<Self, NpyError> {
        let [element_type, columns_first, shape] = entries;
        let element_type = match element_type {
            Some(Literal::Text(name) | Literal::Other(name)) => name,
            _ => return Err(NpyError::Header("descr must name the type of the values")),
        };
        let Some(Literal::Boolean(columns_first)) = columns_first else {
            return Err(NpyError::Header("fortran_order must be True or False"));
        };
        let Some(Literal::Numbers(shape)) = shape else {
            return Err(NpyError::Header(
                "shape must be a tuple of integers of at least 0",
            ));
        };
        Ok(Self {
            element_type,
            columns_first,
            shape,
        })
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
