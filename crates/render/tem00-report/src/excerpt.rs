//! The line of a text file that has a mistake.

use std::{ops::Range, path::Path};

use annotate_snippets::{AnnotationKind, Group, Origin, Snippet, Title};
use tem00_config::{is_hazard, printable_line};

/// The longest line that is shown whole, in bytes.
const WIDEST: usize = 160;

/// A line of a file, or a piece of a long line, in printable characters only.
#[derive(Debug)]
pub(crate) struct Excerpt {
    name: String,
    text: String,
    /// The mistake in it, in bytes.
    span: Range<usize>,
    /// The lines before the excerpt, and the characters of its line before it.
    line: usize,
    column: usize,
}

impl Excerpt {
    /// Returns the excerpt around the beginning of `span`, a range of bytes of the text of a file.
    pub(crate) fn around(file: &Path, text: &str, span: &Range<usize>) -> Self {
        let start = text.floor_char_boundary(span.start);
        let line = line_at(text, start);
        let end = text.floor_char_boundary(span.end.clamp(start, line.end));
        let (shown, end) = if line.len() <= WIDEST {
            (line.clone(), end)
        } else {
            let end = text.floor_char_boundary(end.min(start + WIDEST / 2));
            let from = text.floor_char_boundary(start.saturating_sub(WIDEST / 4));
            let to = text.floor_char_boundary(line.end.min(end + WIDEST / 4));
            (from.max(line.start)..to, end)
        };
        Self {
            name: printable_line(&file.display().to_string(), 1000),
            text: text[shown.clone()].chars().map(of_same_length).collect(),
            span: start - shown.start..end - shown.start,
            line: text[..line.start].matches('\n').count(),
            column: text[line.start..shown.start].chars().count(),
        }
    }

    /// Returns the excerpt under the message about it.
    pub(crate) fn under<'a>(&'a self, title: Title<'a>) -> Group<'a> {
        let snippet = Snippet::source(&self.text)
            .line_start(self.line + 1)
            .annotation(AnnotationKind::Primary.span(self.span.clone()));
        if self.column == 0 {
            return title.element(snippet.path(&self.name));
        }
        // The snippet does not know how much of its line was cut.
        let column = self.column + self.text[..self.span.start].chars().count() + 1;
        let origin = Origin::path(&self.name).line(self.line + 1);
        title.element(origin.char_column(column)).element(snippet)
    }
}

/// Returns the line of a byte, without the line feed.
fn line_at(text: &str, at: usize) -> Range<usize> {
    let start = text[..at].rfind('\n').map_or(0, |newline| newline + 1);
    let end = text[at..].find('\n').map_or(text.len(), |end| at + end);
    start..end
}

/// Returns the character, or as many question marks as it has bytes if it cannot be printed.
fn of_same_length(character: char) -> String {
    if is_hazard(character) {
        "?".repeat(character.len_utf8())
    } else {
        character.to_string()
    }
}

#[cfg(test)]
mod tests {
    use annotate_snippets::{Level, Renderer};

    use super::*;

    fn around(text: &str, word: &str) -> Excerpt {
        let start = text.find(word).expect("the word is there");
        Excerpt::around(Path::new("a"), text, &(start..start + word.len()))
    }

    fn marked(excerpt: &Excerpt) -> &str {
        &excerpt.text[excerpt.span.clone()]
    }

    fn printed(excerpt: &Excerpt) -> String {
        let title = Level::ERROR.primary_title("no");
        Renderer::plain().render(&[excerpt.under(title)])
    }

    #[test]
    fn short_lines_are_shown_whole() {
        let excerpt = around("one\ntwo\nµ wrong\nfour\nfive\n", "wrong");
        assert_eq!((&*excerpt.text, marked(&excerpt)), ("µ wrong", "wrong"));
        // The third line, the third character.
        assert!(printed(&excerpt).contains("a:3:3\n"), "{excerpt:?}");
        let excerpt = around("wrong", "wrong");
        assert_eq!((&*excerpt.text, marked(&excerpt)), ("wrong", "wrong"));
    }

    #[test]
    fn of_long_lines_a_piece_is_shown() {
        let long = "µ".repeat(1 << 20);
        let text = format!("one\n{long}wrong{long}\nthree");
        let excerpt = around(&text, "wrong");
        assert!(excerpt.text.len() <= WIDEST, "{}", excerpt.text);
        assert_eq!(marked(&excerpt), "wrong");
        let printed = printed(&excerpt);
        let place = format!("a:2:{}\n", (1 << 20) + 1);
        assert!(printed.contains(&place), "{printed}");
        // A long mistake is cut.
        let excerpt = around(&text, &long);
        let marked = marked(&excerpt);
        assert!(marked.len() <= WIDEST && !marked.is_empty(), "{marked}");
        assert_eq!(excerpt.line, 1);
    }

    #[test]
    fn what_cannot_be_printed_keeps_its_length() {
        let excerpt = around("\u{1b}[2J\u{9b}\u{202e} = wrong\r\n", "wrong");
        let found = (&*excerpt.text, marked(&excerpt));
        assert_eq!(found, ("?[2J????? = wrong?", "wrong"));
    }

    #[test]
    fn every_span_has_an_excerpt() {
        let text = "a\nµ\r\n\n";
        for start in 0..=text.len() + 1 {
            for end in start..=text.len() + 2 {
                let excerpt = Excerpt::around(Path::new("a"), text, &(start..end));
                let marked = excerpt.text.get(excerpt.span.clone());
                assert!(marked.is_some(), "{start}..{end}");
                let printed = printed(&excerpt);
                assert!(printed.starts_with("error: no\n"), "{start}..{end}");
            }
        }
    }
}
