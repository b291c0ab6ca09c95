//! What the documentation names in code stands in the sources: types and their members, modules,
//! files and tests.

#![expect(
    clippy::expect_used,
    reason = "a test stops at what it does not expect"
)]

mod sources;

use std::{
    collections::{BTreeMap, BTreeSet},
    path::{Path, PathBuf},
};

use sources::{Token, entries, length_of_group, packages, read, root, tokens};

/// Names of other programs that read like names of tests.
const FOREIGN: &[&str] = &["llvm_ad_mono_polarized"];

/// Definitions in the sources.
#[derive(Debug, Default)]
struct Names {
    /// Functions and methods of Rust, WGSL and Python.
    functions: BTreeSet<String>,
    /// Methods, constants, variants and fields of each type.
    members: BTreeMap<String, BTreeSet<String>>,
    /// The files, from the root of the repository on, each with its words.
    files: BTreeMap<String, BTreeSet<String>>,
}

impl Names {
    fn of_the_workspace() -> Self {
        let mut names = Self::default();
        for package in packages() {
            for folder in ["src", "shaders", "tests", "benches", "examples", "python"] {
                names.add_folder(&package.join(folder));
            }
        }
        for folder in ["docs/book", "examples", "bindings/integrations"] {
            names.add_folder(&root().join(folder));
        }
        names
    }

    fn add_folder(&mut self, folder: &Path) {
        if !folder.is_dir() || folder.ends_with("target") {
            return;
        }
        for path in entries(folder) {
            self.add_folder(&path);
            let extension = path.extension().and_then(|extension| extension.to_str());
            if let Some("rs" | "wgsl" | "py" | "pyi" | "toml") = extension {
                let name = path.strip_prefix(root()).expect("below the root");
                let name = name.to_string_lossy().replace('\\', "/");
                self.add_file(name, &tokens(&read(&path)));
            }
        }
    }

    fn add_file(&mut self, name: String, tokens: &[Token]) {
        let words = tokens.iter().filter_map(Token::word).map(str::to_owned);
        self.files.insert(name, words.collect());
        for (index, token) in tokens.iter().enumerate() {
            let Some(word) = token.word() else { continue };
            let rest = &tokens[index + 1..];
            match (word, rest.first().and_then(Token::word)) {
                ("fn" | "def", Some(name)) => {
                    self.functions.insert(name.to_owned());
                }
                ("impl" | "trait" | "enum" | "struct", _) => self.add_type(rest),
                _ => {}
            }
        }
    }

    /// Adds the members of a type, from behind its keyword on.
    fn add_type(&mut self, rest: &[Token]) {
        let is_end = |token: &Token| ["{", ";", "("].iter().any(|end| token.is(end));
        let Some(open) = rest.iter().position(is_end) else {
            return;
        };
        let body = &rest[open..][..length_of_group(&rest[open..])];
        let Some(name) = name_of_type(&rest[..open]) else {
            return;
        };
        let members = self.members.entry(name.to_owned()).or_default();
        let mut index = 1;
        while index < body.len() {
            match &body[index] {
                Token::Sign('(' | '[' | '{') => index += length_of_group(&body[index..]) - 1,
                Token::Word(word) => {
                    members.insert(word.clone());
                }
                Token::Sign(_) => {}
            }
            index += 1;
        }
    }

    /// Why a span of code names nothing, if so: a name, or several as `owner::{name, name}`.
    fn missing(&self, span: &str) -> Option<String> {
        if let Some((owner, list)) = span.split_once("::{") {
            let mut names = list.trim_end_matches('}').split(", ");
            return names.find_map(|name| self.missing_name(&format!("{owner}::{name}")));
        }
        self.missing_name(span.split(['(', '<', ' ']).next().unwrap_or_default())
    }

    fn missing_name(&self, span: &str) -> Option<String> {
        if span.contains('*') || FOREIGN.contains(&span) {
            return None;
        }
        let is_path = |c: char| c.is_ascii_alphanumeric() || "_:…".contains(c);
        if span.ends_with(".rs") || span.ends_with(".py") {
            let ending = format!("/{span}");
            let exists = |file: &String| file == span || file.ends_with(&ending);
            return (!self.files.keys().any(exists)).then(|| "no such file".to_owned());
        }
        if !span.chars().all(is_path) {
            return None;
        }
        let segments: Vec<_> = span.split("::").collect();
        let last = segments.last().copied().unwrap_or_default();
        if let [.., owner, member] = segments.as_slice()
            && owner.starts_with(char::is_uppercase)
        {
            let Some(members) = self.members.get(*owner) else {
                return Some(format!("no type {owner}"));
            };
            return (!members.contains(*member)).then(|| format!("no member of {owner}"));
        }
        if segments.len() > 1 {
            let mut pairs = segments.windows(2);
            let missing = pairs.find(|pair| !self.has_inside(pair[0], pair[1]));
            return missing.map(|pair| format!("no {} in {}", pair[1], pair[0]));
        }
        // Sentences are names of tests; shorter ones may be keys of files.
        let is_sentence = last.matches('_').count() >= 3 && !last.contains(char::is_uppercase);
        let is_word = || self.files.values().any(|words| words.contains(last));
        let known = || self.has_function_like(last) || is_word();
        (is_sentence && !known()).then(|| "no such function".to_owned())
    }

    /// Whether a crate or module has a file or a word of that name.
    fn has_inside(&self, module: &str, name: &str) -> bool {
        let (file, folder) = (
            format!("/{module}.rs"),
            format!("/{}/", module.replace('_', "-")),
        );
        let (below, dashed) = (format!("/{module}/{name}"), format!("/{module}/"));
        self.files.iter().any(|(path, words)| {
            let inside = path.ends_with(&file) || path.contains(&folder) || path.contains(&dashed);
            name.contains('…') || inside && (words.contains(name) || path.contains(&below))
        })
    }

    /// Whether a function has these parts of a name, with anything for each "…".
    fn has_function_like(&self, pattern: &str) -> bool {
        let parts: Vec<_> = pattern.split('…').collect();
        let [first, middle @ .., last] = parts.as_slice() else {
            return self.functions.contains(pattern);
        };
        self.functions.iter().any(|name| {
            let inner = name
                .strip_prefix(first)
                .and_then(|name| name.strip_suffix(last));
            inner.is_some_and(|inner| middle.iter().all(|part| inner.contains(part)))
        })
    }
}

/// The type of `impl<T> Trait for path::Type<T> where …`, without its keyword.
fn name_of_type(tokens: &[Token]) -> Option<&str> {
    let (mut depth, mut name) = (0_i32, None);
    for token in tokens {
        match token {
            Token::Sign('<') => depth += 1,
            Token::Sign('>') => depth -= 1,
            Token::Word(word) if depth == 0 => match word.as_str() {
                "for" => name = None,
                "where" => break,
                "dyn" | "mut" | "const" => {}
                word => name = Some(word),
            },
            Token::Sign(':' | '&' | '-') | Token::Word(_) => {}
            Token::Sign(_) => break,
        }
    }
    name
}

/// The pages of the documentation.
fn pages() -> Vec<PathBuf> {
    let folders = ["docs", "docs/theory", "docs/validation"].map(|folder| root().join(folder));
    let mut pages: Vec<_> = folders.iter().flat_map(|folder| entries(folder)).collect();
    pages.retain(|page| page.extension().is_some_and(|extension| extension == "md"));
    pages.push(root().join("README.md"));
    pages
}

/// The spans of code of a page with their lines, without blocks of code.
fn spans(text: &str) -> Vec<(usize, &str)> {
    let (mut spans, mut in_block) = (Vec::new(), false);
    for (number, line) in text.lines().enumerate() {
        if line.trim_start().starts_with("```") {
            in_block = !in_block;
        } else if !in_block {
            let code = line.split('`').skip(1).step_by(2);
            spans.extend(code.map(|span| (number + 1, span)));
        }
    }
    spans
}

#[test]
fn what_the_documentation_names_exists() {
    let names = Names::of_the_workspace();
    let mut missing = String::new();
    for page in pages() {
        for (line, span) in spans(&read(&page)) {
            if let Some(reason) = names.missing(span) {
                missing += &format!("\n{}:{line}: `{span}`: {reason}", page.display());
            }
        }
    }
    assert!(missing.is_empty(), "{missing}");
}

#[test]
fn theory_validation_and_front_page_of_a_crate_name_each_other() {
    for theory in entries(&root().join("docs/theory")) {
        let name = theory.file_name().expect("a page").to_string_lossy();
        let text = read(&theory);
        let mut names = text.split('`').filter(|span| span.starts_with("tem00-"));
        let package = names.next().expect("a page names its crate");
        let front = read(&root().join(format!("crates/{package}/README.md")));
        let validation = read(&root().join(format!("docs/validation/{name}")));

        assert!(front.contains(&format!("docs/theory/{name}")), "{package}");
        assert!(
            front.contains(&format!("docs/validation/{name}")),
            "{package}"
        );
        assert!(text.contains(&format!("(../validation/{name})")), "{name}");
        assert!(
            validation.contains(&format!("(../theory/{name})")),
            "{name}"
        );
    }
}
