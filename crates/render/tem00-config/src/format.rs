use toml::de::{DeTable, DeValue};

/// A kind of file that is read section by section.
#[derive(Clone, Copy, Debug)]
pub struct Format {
    /// The subject of such a file, as messages name it: "scene".
    pub noun: &'static str,
    /// The keys that are allowed outside of its sections. `"include"` among them lets a file name
    /// other files that belong to it.
    pub keys: &'static [&'static str],
    /// The keys of its sections whose values may be uncertain: a value, or a table with the keys of
    /// [`UNCERTAIN`](crate::UNCERTAIN).
    pub uncertain: &'static [&'static str],
    /// The advice given when there is no such file.
    pub help: &'static str,
}

/// Subject of a document.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub enum DocumentKind {
    /// A scene: camera, lasers and surfaces in space.
    Scene,
    /// A set-up: a triangulation sensor as data sheets describe it.
    Setup,
    /// A grid: the values that a sweep goes over.
    Grid,
}

/// Returns the kind of document that the sections of a text show, so that an error can name the
/// kind of a wrong file; `None` if the text is not TOML, or of no known kind.
///
/// A scene may have several lasers and surfaces, `[[laser]]` and `[[surface]]`; a set-up has one
/// `[laser]` and one `[surface]`; a grid has only `[sweep]`.
pub fn kind_of_document(text: &str) -> Option<DocumentKind> {
    let document = DeTable::parse(text.trim_start_matches('\u{feff}')).ok()?;
    if document
        .get_ref()
        .keys()
        .all(|key| key.get_ref() == "sweep")
    {
        return document
            .get_ref()
            .contains_key("sweep")
            .then_some(DocumentKind::Grid);
    }
    let sections = ["laser", "surface"].map(|key| document.get_ref().get(key));
    let kinds = sections
        .into_iter()
        .flatten()
        .map(|section| match section.get_ref() {
            DeValue::Array(_) => Some(DocumentKind::Scene),
            DeValue::Table(_) => Some(DocumentKind::Setup),
            _ => None,
        });
    let kinds: Vec<_> = kinds.collect();
    match *kinds {
        [Some(kind)] => Some(kind),
        [Some(kind), Some(other)] if kind == other => Some(kind),
        _ => None,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn scenes_and_set_ups_are_told_apart() {
        for (text, kind) in [
            (
                "[[laser]]\n[[surface]]\n[camera]",
                Some(DocumentKind::Scene),
            ),
            ("[laser]\n[surface]\n[camera]", Some(DocumentKind::Setup)),
            ("[[surface]]", Some(DocumentKind::Scene)),
            // Both at once is a mistake in one of them.
            ("[laser]\n[[surface]]", None),
            (
                "[sweep]\ncommand = 1\n[[sweep.vary]]",
                Some(DocumentKind::Grid),
            ),
            ("[sweep]\n[laser]", Some(DocumentKind::Setup)),
            ("[camera]", None),
            ("laser = 5", None),
            ("[laser", None),
            ("", None),
        ] {
            assert_eq!(kind_of_document(text), kind, "{text}");
        }
    }
}
