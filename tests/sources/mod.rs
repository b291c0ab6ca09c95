//! The sources of the workspace as tokens, for the tests that read them.

use std::{
    fs,
    path::{Path, PathBuf},
};

use toml::de::{DeTable, DeValue};

/// A word of Rust, or a character between words.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(crate) enum Token {
    Word(String),
    Sign(char),
}

impl Token {
    pub(crate) fn is(&self, text: &str) -> bool {
        match self {
            Self::Word(word) => word == text,
            Self::Sign(sign) => text.chars().eq([*sign]),
        }
    }

    pub(crate) fn word(&self) -> Option<&str> {
        match self {
            Self::Word(word) => Some(word),
            Self::Sign(_) => None,
        }
    }
}

pub(crate) fn root() -> &'static Path {
    Path::new(env!("CARGO_MANIFEST_DIR"))
}

pub(crate) fn read(path: &Path) -> String {
    fs::read_to_string(path).unwrap_or_else(|error| panic!("{}: {error}", path.display()))
}

/// The folders of all packages of the workspace, that of the facade first.
pub(crate) fn packages() -> Vec<PathBuf> {
    let manifest = read(&root().join("Cargo.toml"));
    let document = DeTable::parse(&manifest).expect("a manifest is valid TOML");
    let workspace = document.get_ref().get("workspace").map(|w| w.get_ref());
    let Some(DeValue::Table(workspace)) = workspace else {
        panic!("the manifest has no workspace");
    };
    let Some(DeValue::Array(members)) = workspace.get("members").map(|m| m.get_ref()) else {
        panic!("the workspace has no members");
    };
    let mut packages = Vec::new();
    for member in members {
        let DeValue::String(member) = member.get_ref() else {
            panic!("a member of the workspace is no text");
        };
        match member.strip_suffix("/*") {
            Some(folder) => packages.extend(entries(&root().join(folder))),
            None => packages.push(root().join(&**member)),
        }
    }
    packages.retain(|folder| folder.join("Cargo.toml").exists());
    packages
}

/// The entries of a folder, by name.
pub(crate) fn entries(folder: &Path) -> Vec<PathBuf> {
    let entries = fs::read_dir(folder).expect("a folder");
    let mut paths: Vec<_> = entries
        .map(|entry| entry.expect("an entry").path())
        .collect();
    paths.sort();
    paths
}

/// Splits Rust into tokens. Comments are left out; a literal is one sign, `"` for text and `0` for a
/// number.
pub(crate) fn tokens(text: &str) -> Vec<Token> {
    let mut tokens = Vec::new();
    let mut rest = text;
    while let Some(next) = rest.chars().next() {
        if let Some(after) = comment(rest) {
            rest = after;
        } else if let Some(after) = literal(rest) {
            tokens.push(Token::Sign('"'));
            rest = after;
        } else if next.is_alphanumeric() || next == '_' {
            let end = rest
                .find(|c: char| !(c.is_alphanumeric() || c == '_'))
                .unwrap_or(rest.len());
            let (word, after) = rest.split_at(end);
            tokens.push(match next {
                '0'..='9' => Token::Sign('0'),
                _ => Token::Word(word.to_owned()),
            });
            rest = after;
        } else {
            if !next.is_whitespace() {
                tokens.push(Token::Sign(next));
            }
            rest = &rest[next.len_utf8()..];
        }
    }
    tokens
}

/// What follows a comment that `text` begins with.
fn comment(text: &str) -> Option<&str> {
    if text.starts_with("//") {
        return Some(text.find('\n').map_or("", |end| &text[end..]));
    }
    let mut rest = text.strip_prefix("/*")?;
    let mut depth = 1;
    while depth > 0 {
        let at = rest.find(['*', '/'])?;
        rest = &rest[at..];
        let (step, width) = match () {
            () if rest.starts_with("*/") => (-1, 2),
            () if rest.starts_with("/*") => (1, 2),
            () => (0, 1),
        };
        depth += step;
        rest = &rest[width..];
    }
    Some(rest)
}

/// What follows a text, a character or a lifetime that `text` begins with.
fn literal(text: &str) -> Option<&str> {
    if let Some(rest) = text.strip_prefix('\'') {
        let mut characters = rest.chars();
        let (first, second) = (characters.next()?, characters.next());
        return match (first, second) {
            ('\\', _) => rest[2..].find('\'').map(|end| &rest[2 + end + 1..]),
            (_, Some('\'')) => Some(&rest[first.len_utf8() + 1..]),
            // A lifetime or a label: its name is left out with it.
            _ => Some(rest.trim_start_matches(|c: char| c.is_alphanumeric() || c == '_')),
        };
    }
    let unprefixed = text.trim_start_matches(['b', 'c']);
    if text.len() - unprefixed.len() > 1 {
        return None;
    }
    if let Some(raw) = unprefixed.strip_prefix('r') {
        let hashes = raw.len() - raw.trim_start_matches('#').len();
        let body = raw[hashes..].strip_prefix('"')?;
        let end = format!("\"{}", "#".repeat(hashes));
        return body.find(&end).map(|at| &body[at + end.len()..]);
    }
    let mut escaped = false;
    let body = unprefixed.strip_prefix('"')?;
    for (at, c) in body.char_indices() {
        match c {
            '"' if !escaped => return Some(&body[at + 1..]),
            '\\' => escaped = !escaped,
            _ => escaped = false,
        }
    }
    None
}

/// The number of tokens from an opening bracket to its end.
pub(crate) fn length_of_group(tokens: &[Token]) -> usize {
    let mut depth = 0_usize;
    for (index, token) in tokens.iter().enumerate() {
        match token {
            Token::Sign('(' | '[' | '{') => depth += 1,
            Token::Sign(')' | ']' | '}') => depth -= 1,
            _ => {}
        }
        if depth == 0 {
            return index + 1;
        }
    }
    tokens.len()
}
