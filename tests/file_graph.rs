//! The arrows between the files of a crate form no circle.
//!
//! A file has an arrow to every file that defines what it names: a path is followed through modules,
//! imports and re-exports to the definition. `mod` declarations and re-exports are no arrows, and
//! neither are tests. Methods are not followed, only the types that they are called by.

#![expect(
    clippy::expect_used,
    reason = "a test stops at what it does not expect"
)]

mod sources;

use std::{
    collections::{BTreeMap, BTreeSet},
    path::{Path, PathBuf},
};

use sources::{Token, length_of_group, packages, read, root, tokens};

type Segments = Vec<String>;

/// What a name of a module stands for.
#[derive(Clone, Debug)]
enum Meaning {
    /// Defined here.
    Item,
    /// A module below.
    Module,
    /// Another name for what a path leads to.
    Import(Segments),
}

/// What a path leads to.
enum Target {
    /// An item that the file defines, or part of one.
    Item(usize),
    Module(Segments),
}

#[derive(Debug, Default)]
struct Module {
    file: usize,
    names: BTreeMap<String, Vec<Meaning>>,
    /// Modules and enums whose names are all imported.
    globs: Vec<Segments>,
    /// Paths that the code names.
    named: BTreeSet<Segments>,
}

/// A tree of modules: a library or a program.
#[derive(Debug, Default)]
struct Tree {
    files: Vec<PathBuf>,
    modules: BTreeMap<Segments, Module>,
}

impl Tree {
    fn read(main: PathBuf) -> Self {
        let mut tree = Self::default();
        let folder = main.parent().expect("a file in a folder").to_owned();
        tree.add_file(main, &folder, Vec::new());
        tree
    }

    fn add_file(&mut self, path: PathBuf, folder: &Path, module: Segments) {
        let text = read(&path);
        self.files.push(path);
        let file = self.files.len() - 1;
        Reader {
            tree: self,
            file,
            folder: folder.to_owned(),
            module,
        }
        .module(&tokens(&text));
    }

    /// The file that defines what `path` leads to from `module`. Modules themselves have none.
    fn definition(&self, module: &[String], path: &[String]) -> Option<usize> {
        match self.target(module, path, &mut BTreeSet::new())? {
            Target::Item(file) => Some(file),
            Target::Module(_) => None,
        }
    }

    /// What `path` leads to from `module`; `seen` holds what was tried, against endless imports.
    fn target(
        &self,
        module: &[String],
        path: &[String],
        seen: &mut BTreeSet<(Segments, Segments)>,
    ) -> Option<Target> {
        let Some((first, rest)) = path.split_first() else {
            return Some(Target::Module(module.to_vec()));
        };
        match first.as_str() {
            "crate" => return self.target(&[], rest, seen),
            "self" => return self.target(module, rest, seen),
            "super" => return self.target(module.split_last()?.1, rest, seen),
            _ if !seen.insert((module.to_vec(), path.to_vec())) => return None,
            _ => {}
        }
        let scope = self.modules.get(module)?;
        let meanings = scope.names.get(first).into_iter().flatten();
        let mut found: Vec<_> = meanings
            .filter_map(|meaning| match meaning {
                Meaning::Item => Some(Target::Item(scope.file)),
                Meaning::Module => Some(Target::Module(joined(module, first))),
                // An import that begins with its own name, as of `law` from the module `law`.
                Meaning::Import(target) if target.first() == Some(first) => {
                    self.target(&joined(module, first), &target[1..], seen)
                }
                Meaning::Import(target) => self.target(module, target, seen),
            })
            .collect();
        // What a further segment belongs to is a module before it is anything else.
        found.sort_by_key(|target| matches!(target, Target::Item(_)) != rest.is_empty());
        let inside = |target, seen: &mut _| match target {
            Target::Item(file) => Some(Target::Item(file)),
            Target::Module(module) => self.target(&module, rest, seen),
        };
        if let Some(target) = found.into_iter().find_map(|target| inside(target, seen)) {
            return Some(target);
        }
        for glob in &scope.globs {
            if let Some(Target::Module(module)) = self.target(module, glob, seen)
                && let Some(target) = self.target(&module, path, seen)
            {
                return Some(target);
            }
        }
        None
    }

    /// For each file, the files that define what it names, with the names.
    fn arrows(&self) -> BTreeMap<usize, BTreeMap<usize, BTreeSet<String>>> {
        let mut arrows: BTreeMap<_, BTreeMap<_, BTreeSet<_>>> = BTreeMap::new();
        for (path, module) in &self.modules {
            for named in &module.named {
                match self.definition(path, named) {
                    Some(file) if file != module.file => {
                        let there = arrows.entry(module.file).or_default().entry(file);
                        there.or_default().extend(named.last().cloned());
                    }
                    _ => {}
                }
            }
        }
        arrows
    }

    /// The sets of files of which each leads to each other, as the arrows among them.
    fn circles(&self) -> Vec<String> {
        let arrows = self.arrows();
        let reached: Vec<BTreeSet<usize>> = (0..self.files.len())
            .map(|file| {
                let (mut reached, mut open) = (BTreeSet::new(), vec![file]);
                while let Some(next) = open.pop() {
                    let further = arrows.get(&next).into_iter().flat_map(BTreeMap::keys);
                    open.extend(further.filter(|file| reached.insert(**file)));
                }
                reached
            })
            .collect();
        let circle = |file: usize| -> BTreeSet<usize> {
            let there = reached[file].iter().copied();
            there
                .filter(|other| reached[*other].contains(&file))
                .collect()
        };
        let circles: BTreeSet<_> = (0..self.files.len()).map(circle).collect();
        let circles = circles.into_iter().filter(|files| files.len() > 1);
        circles
            .map(|files| self.described(&files, &arrows))
            .collect()
    }

    fn described(
        &self,
        files: &BTreeSet<usize>,
        arrows: &BTreeMap<usize, BTreeMap<usize, BTreeSet<String>>>,
    ) -> String {
        let mut text = format!("\n{} files:", files.len());
        for from in files {
            for (to, names) in arrows.get(from).into_iter().flatten() {
                if files.contains(to) {
                    let names: Vec<_> = names.iter().map(String::as_str).collect();
                    let (from, to) = (self.name(*from), self.name(*to));
                    text += &format!("\n  {from} → {to}: {}", names.join(", "));
                }
            }
        }
        text
    }

    fn name(&self, file: usize) -> String {
        let path = self.files[file]
            .strip_prefix(root())
            .expect("below the root");
        path.to_string_lossy().replace('\\', "/")
    }
}

/// Reads the tokens of a file into the modules of a tree.
struct Reader<'a> {
    tree: &'a mut Tree,
    file: usize,
    /// Where the files of modules below lie.
    folder: PathBuf,
    module: Segments,
}

impl Reader<'_> {
    /// Reads all items of a module.
    fn module(&mut self, mut rest: &[Token]) {
        let file = self.file;
        self.here().file = file;
        while !rest.is_empty() {
            rest = self.item(rest);
        }
    }

    fn here(&mut self) -> &mut Module {
        self.tree.modules.entry(self.module.clone()).or_default()
    }

    /// Reads one item and returns what follows it.
    fn item<'t>(&mut self, tokens: &'t [Token]) -> &'t [Token] {
        let (is_test, declaration) = without_attributes(tokens);
        let (item, rest) = declaration.split_at(length_of_item(declaration));
        if is_test {
            return rest;
        }
        let (is_public, item) = without_visibility(item);
        match item {
            [keyword, tree @ .., _] if keyword.is("use") => self.import(tree, is_public),
            [keyword, Token::Word(name), end] if keyword.is("mod") && end.is(";") => {
                self.module_in_a_file(name);
            }
            [keyword, Token::Word(name), _, body @ .., _] if keyword.is("mod") => {
                self.module_in_braces(name, body);
            }
            _ => {
                if let Some(name) = defined_name(item) {
                    self.add(name, Meaning::Item);
                }
                self.code(item);
            }
        }
        rest
    }

    fn add(&mut self, name: &str, meaning: Meaning) {
        let names = &mut self.here().names;
        names.entry(name.to_owned()).or_default().push(meaning);
    }

    fn module_in_a_file(&mut self, name: &str) {
        self.add(name, Meaning::Module);
        let module = joined(&self.module, name);
        let folder = self.folder.join(name);
        let flat = self.folder.join(format!("{name}.rs"));
        let path = if flat.exists() {
            flat
        } else {
            folder.join("mod.rs")
        };
        self.tree.add_file(path, &folder, module);
    }

    fn module_in_braces(&mut self, name: &str, body: &[Token]) {
        self.add(name, Meaning::Module);
        Reader {
            tree: self.tree,
            file: self.file,
            folder: self.folder.join(name),
            module: joined(&self.module, name),
        }
        .module(body);
    }

    /// Reads the tree of a `use`. What is not handed on is named by the file itself.
    fn import(&mut self, tree: &[Token], is_public: bool) {
        for (path, name) in leaves(tree) {
            if name == "*" {
                self.here().globs.push(path);
                continue;
            }
            if !is_public {
                self.here().named.insert(path.clone());
            }
            self.add(&name, Meaning::Import(path));
        }
    }

    /// Reads the paths that an item names, and the imports inside it.
    fn code(&mut self, mut rest: &[Token]) {
        let mut before = None;
        while let Some((token, after)) = rest.split_first() {
            let follows_a_value = before == Some('.');
            before = None;
            if token.is("#") {
                let (is_test, declaration) = without_attributes(rest);
                let skipped = if is_test {
                    length_of_item(declaration)
                } else {
                    0
                };
                rest = &declaration[skipped..];
                // An inner attribute, or a `#` of a macro.
                if declaration.len() == after.len() + 1 {
                    rest = after;
                }
            } else if token.is("use") && matches!(after, [Token::Word(_), ..]) {
                let (tree, further) = after.split_at(length_of_item(after));
                self.import(tree.split_last().map_or(&[], |(_, tree)| tree), false);
                rest = further;
            } else if token.word().is_some() && !follows_a_value {
                let (path, further) = path_at(rest);
                self.here().named.insert(path);
                rest = further;
            } else {
                // Two points are a range, whose end may be a path.
                if let Token::Sign(sign) = token {
                    before = Some(*sign).filter(|_| !(follows_a_value && *sign == '.'));
                }
                rest = after;
            }
        }
    }
}

fn joined(module: &[String], name: &str) -> Segments {
    [module, &[name.to_owned()]].concat()
}

/// Whether the attributes before an item keep it for tests, and the item without them.
fn without_attributes(mut tokens: &[Token]) -> (bool, &[Token]) {
    let mut is_test = false;
    while let [hash, rest @ ..] = tokens {
        let inner = usize::from(rest.first().is_some_and(|token| token.is("!")));
        if !hash.is("#") || !rest.get(inner).is_some_and(|token| token.is("[")) {
            break;
        }
        let (attribute, after) = rest[inner..].split_at(length_of_group(&rest[inner..]));
        let test = ["[", "cfg", "(", "test", ")", "]"];
        is_test |= attribute.len() == test.len()
            && attribute
                .iter()
                .zip(test)
                .all(|(token, text)| token.is(text));
        tokens = after;
    }
    (is_test, tokens)
}

fn without_visibility(tokens: &[Token]) -> (bool, &[Token]) {
    match tokens {
        [public, rest @ ..] if public.is("pub") => match rest {
            [open, ..] if open.is("(") => (true, &rest[length_of_group(rest)..]),
            _ => (true, rest),
        },
        _ => (false, tokens),
    }
}

/// The number of tokens of an item: up to its semicolon, or its body in braces.
fn length_of_item(tokens: &[Token]) -> usize {
    // A value or the tree of a `use` may hold braces before the end.
    let (_, item) = without_visibility(tokens);
    let ends_with_braces = match item {
        [first, second, ..] if first.is("const") => ["fn", "unsafe", "extern", "async"]
            .iter()
            .any(|word| second.is(word)),
        [first, ..] => !["static", "type", "use", "let"]
            .iter()
            .any(|word| first.is(word)),
        [] => false,
    };
    let mut index = 0;
    while let Some(token) = tokens.get(index) {
        match token {
            Token::Sign(';') => return index + 1,
            Token::Sign('{') if ends_with_braces => {
                return index + length_of_group(&tokens[index..]);
            }
            Token::Sign('(' | '[' | '{') => index += length_of_group(&tokens[index..]),
            _ => index += 1,
        }
    }
    tokens.len()
}

/// The name that an item defines in its module.
fn defined_name(item: &[Token]) -> Option<&str> {
    const KEYWORDS: [&str; 9] = [
        "fn",
        "struct",
        "enum",
        "trait",
        "type",
        "static",
        "union",
        "macro_rules",
        "const",
    ];
    let mut words = item
        .iter()
        .filter(|token| !token.is("!") && !token.is("\""));
    while let Some(token) = words.next() {
        let word = token.word()?;
        if KEYWORDS.contains(&word) {
            let name = words.find(|token| !token.is("mut"))?.word()?;
            match name {
                "fn" | "unsafe" | "extern" | "async" => return defined_name(&item[1..]),
                _ => return Some(name),
            }
        }
        if !["unsafe", "async", "extern"].contains(&word) {
            return None;
        }
    }
    None
}

/// The leaves of the tree of a `use`: where each leads, and its name here.
fn leaves(tree: &[Token]) -> Vec<(Segments, String)> {
    let (path, rest) = path_at(tree);
    let after = match rest {
        [Token::Sign(':'), Token::Sign(':'), after @ ..] => after,
        _ => rest,
    };
    match after {
        [Token::Sign('*')] => vec![(path, "*".to_owned())],
        [Token::Sign('{'), group @ .., Token::Sign('}')] => split_at_commas(group)
            .into_iter()
            .flat_map(leaves)
            .map(|(below, name)| match below.as_slice() {
                [own] if own == "self" => {
                    let name = if name == "self" {
                        path.last().cloned()
                    } else {
                        Some(name)
                    };
                    (path.clone(), name.unwrap_or_default())
                }
                _ => ([path.as_slice(), &below].concat(), name),
            })
            .collect(),
        [renamed, Token::Word(name)] if renamed.is("as") => vec![(path, name.clone())],
        _ => {
            let name = path.last().cloned().unwrap_or_default();
            vec![(path, name)]
        }
    }
}

fn split_at_commas(tokens: &[Token]) -> Vec<&[Token]> {
    let (mut parts, mut start, mut index) = (Vec::new(), 0, 0);
    while index < tokens.len() {
        match &tokens[index] {
            Token::Sign(',') => {
                parts.push(&tokens[start..index]);
                index += 1;
                start = index;
            }
            Token::Sign('{') => index += length_of_group(&tokens[index..]),
            _ => index += 1,
        }
    }
    parts.push(&tokens[start..]);
    parts.retain(|part| !part.is_empty());
    parts
}

/// The path that `tokens` begin with, and what follows it.
fn path_at(tokens: &[Token]) -> (Segments, &[Token]) {
    let mut path = Vec::new();
    let mut rest = match tokens {
        [Token::Sign(':'), Token::Sign(':'), rest @ ..] => rest,
        _ => tokens,
    };
    while let [Token::Word(word), after @ ..] = rest {
        path.push(word.clone());
        rest = after;
        match after {
            [Token::Sign(':'), Token::Sign(':'), next @ ..]
                if matches!(next, [Token::Word(_), ..]) =>
            {
                rest = next;
            }
            _ => break,
        }
    }
    (path, rest)
}

fn trees() -> Vec<Tree> {
    let mains = packages()
        .into_iter()
        .flat_map(|package| ["src/lib.rs", "src/main.rs"].map(|main| package.join(main)));
    mains.filter(|main| main.exists()).map(Tree::read).collect()
}

#[test]
fn files_form_no_circles() {
    let circles: Vec<_> = trees().iter().flat_map(Tree::circles).collect();
    assert!(
        circles.is_empty(),
        "{} circles:{}",
        circles.len(),
        circles.concat()
    );
}

#[test]
fn arrows_lead_through_re_exports_to_the_definition() {
    let speckle = Tree::read(root().join("crates/light/tem00-speckle/src/lib.rs"));
    let file = |ending: &str| {
        let mut names = (0..speckle.files.len()).map(|file| speckle.name(file));
        names
            .position(|name| name.ends_with(ending))
            .expect("a file")
    };
    let arrows = speckle.arrows();
    let [plan, field, mask] = ["stack/plan.rs", "pupil/field.rs", "pupil/mask.rs"].map(file);
    // `use crate::PupilField` in the plan, re-exported twice.
    assert!(arrows[&plan][&field].contains("PupilField"), "{arrows:?}");
    assert!(arrows[&field].contains_key(&mask), "{arrows:?}");
    // The front page names nothing itself, and tests are left out.
    assert!(!arrows.contains_key(&file("src/lib.rs")), "{arrows:?}");
    let tests = |path: &PathBuf| path.ends_with("tests.rs");
    assert!(!speckle.files.iter().any(tests), "{:?}", speckle.files);
}
