use std::path::Path;

use crate::{
    ConfigError, Document, FileAccess, Format, Problem, Reading, Section, sources::Sources,
};

/// Reads a file of keys, and the files that it includes. The path `-` is standard input.
///
/// # Errors
///
/// Returns an error if a file cannot be read or is not valid TOML, if it has a key that its
/// `format` does not know, and the errors of `read`, placed in the file.
pub fn read_document<'a, T>(
    path: &Path,
    reading: impl Into<Reading<'a>>,
    format: Format,
    read: impl FnOnce(&Document<'_>) -> Result<T, Problem>,
) -> Result<T, ConfigError> {
    let sources = Sources::of_file(path, reading.into(), format)?;
    with_document(&sources, read).map_err(|problem| sources.locate(problem))
}

/// Reads text as [`read_document`] reads a file; other files are looked for in `base_directory`.
///
/// # Errors
///
/// Returns the errors of [`read_document`].
///
/// The [front page](crate) has an example.
pub fn parse_document<T>(
    text: &str,
    base_directory: &Path,
    format: Format,
    read: impl FnOnce(&Document<'_>) -> Result<T, Problem>,
) -> Result<T, ConfigError> {
    let access = (base_directory, FileAccess::WithinFolder);
    let sources = Sources::of_text(text.to_owned(), None, access, format)?;
    with_document(&sources, read).map_err(|problem| sources.locate(problem))
}

fn with_document<T>(
    sources: &Sources,
    read: impl FnOnce(&Document<'_>) -> Result<T, Problem>,
) -> Result<T, Problem> {
    let parsed = sources
        .in_order()
        .map(|source| Ok((source, source.parse()?)));
    let parsed: Vec<_> = parsed.collect::<Result<_, Problem>>()?;
    let files = parsed
        .iter()
        .map(|(source, document)| Section::root(document.get_ref(), source, sources.format()));
    read(&Document::new(files.collect::<Result<_, _>>()?, sources))
}
