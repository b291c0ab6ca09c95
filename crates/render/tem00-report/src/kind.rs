//! The kind of a file, where a command needs another kind.

use std::{fs::File, io::Read, path::Path};

use tem00_config::{DocumentKind, kind_of_document};

use crate::failure::Failure;

/// Returns the meaning of the end of a file's name, in capitals or not.
pub(crate) fn of_ending<T: Copy>(path: &Path, known: &[(&str, T)]) -> Option<T> {
    let ending = path.extension()?.to_str()?;
    let found = known
        .iter()
        .find(|(name, _)| ending.eq_ignore_ascii_case(name));
    found.map(|(_, kind)| *kind)
}

/// The number of bytes that determine the kind of a file.
const MAX_BYTES: u64 = 1 << 20;

/// A kind of file that a command takes.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Kind {
    Scene,
    Setup,
    Grid,
    Image,
}

impl Kind {
    const fn noun(self) -> &'static str {
        match self {
            Self::Scene => "a scene file",
            Self::Setup => "a set-up file",
            Self::Grid => "the grid file of a sweep",
            Self::Image => "an image",
        }
    }

    /// Returns the command that takes such a file, or both.
    const fn command(self) -> &'static str {
        match self {
            Self::Scene => "tem00 render` or `tem00-inspect triangulate",
            Self::Setup => "tem00-inspect budget",
            Self::Grid => "tem00-inspect sweep",
            Self::Image => "tem00 stats` or `tem00-inspect lines",
        }
    }

    /// Returns the kind of a file, if it is known.
    fn of(path: &Path) -> Option<Self> {
        let is_file = path.metadata().is_ok_and(|found| found.is_file());
        let file = is_file.then(|| File::open(path).ok()).flatten()?;
        let mut bytes = Vec::new();
        file.take(MAX_BYTES).read_to_end(&mut bytes).ok()?;
        let is_netpbm = match *bytes {
            [b'P', b'2' | b'3' | b'5' | b'6', end, ..] => end.is_ascii_whitespace(),
            _ => false,
        };
        if is_netpbm || IMAGES.iter().any(|magic| bytes.starts_with(magic)) {
            return Some(Self::Image);
        }
        match kind_of_document(core::str::from_utf8(&bytes).ok()?)? {
            DocumentKind::Scene => Some(Self::Scene),
            DocumentKind::Setup => Some(Self::Setup),
            DocumentKind::Grid => Some(Self::Grid),
            _ => None,
        }
    }
}

/// The first bytes of image files: PNG, OpenEXR, NumPy, JPEG, TIFF in both orders of bytes, and
/// BMP.
const IMAGES: [&[u8]; 7] = [
    b"\x89PNG",
    b"\x76\x2f\x31\x01",
    b"\x93NUMPY",
    b"\xff\xd8\xff",
    b"II*\0",
    b"MM\0*",
    b"BM",
];

/// Returns the failure that a file is of another kind than a command needs, with the command that
/// takes it; or `otherwise`, if the file is of the needed kind or of an unknown kind.
pub fn wrong_or(path: &Path, needed: Kind, otherwise: impl FnOnce() -> Failure) -> Failure {
    match Kind::of(path).filter(|kind| *kind != needed) {
        None => otherwise(),
        Some(kind) => {
            let name = path.display();
            Failure::input(
                format!("{name}: this is {}, not {}", kind.noun(), needed.noun()),
                format!("try `{} {name}`", kind.command()),
            )
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_name_tells_the_format() {
        let of = |name: &str| of_ending(Path::new(name), &[("png", 1), ("exr", 2)]);
        assert_eq!(["a/b.PNG", "b.exr"].map(of), [Some(1), Some(2)]);
        assert_eq!(["b.jpg", "png", ""].map(of), [None; 3]);
    }
}
