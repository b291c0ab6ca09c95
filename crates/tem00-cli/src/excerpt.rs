//! The piece of a text file that has a mistake.

use std::{ops::Range, path::Path};

use miette::{MietteError, MietteSpanContents, SourceCode, SourceSpan, SpanContents};
use tem00_config::{is_hazard, printable_line};

/// The longest line that is shown whole, in bytes.
const WIDEST: usize = 160;

/// A line of a file with its neighbours, or a piece of a long one, in which everything can be printed.
#[derive(Debug)]
pub(crate) struct Excerpt {
    name: String,
    text: String,
    /// Its start in the file: the lines and characters before it.
    line: usize,
    column: usize,
}

impl Excerpt {
    /// Returns the excerpt around the beginning of `span`, a range of bytes of the text of a file, and
    /// where the span lies in it.
    pub(crate) fn around(file: &Path, text: &str, span: &Range<usize>) -> (Self, Range<usize>) {
        let start = text.floor_char_boundary(span.start);
        let line = line_at(text, start);
        let end = text.floor_char_boundary(span.end.clamp(start, line.end));
        let (shown, end) = if line.len() <= WIDEST {
            (with_neighbours(text, &line), end)
        } else {
            let end = text.floor_char_boundary(end.min(start + WIDEST / 2));
            let from = text.floor_char_boundary(start.saturating_sub(WIDEST / 4));
            let to = text.floor_char_boundary(line.end.min(end + WIDEST / 4));
            (from.max(line.start)..to, end)
        };
        let first_line = line_at(text, shown.start).start;
        let excerpt = Self {
            name: printable_line(&file.display().to_string(), 1000),
            text: text[shown.clone()].chars().map(of_same_length).collect(),
            line: text[..first_line].matches('\n').count(),
            column: text[first_line..shown.start].chars().count(),
        };
        (excerpt, start - shown.start..end - shown.start)
    }

    /// Returns the line and the column in the file, from 0, of a byte of the excerpt.
    fn place(&self, at: usize) -> (usize, usize) {
        let before = self.text.get(..at).unwrap_or(&self.text);
        let line_start = before.rfind('\n').map_or(0, |newline| newline + 1);
        let cut = if line_start == 0 { self.column } else { 0 };
        (
            self.line + before.matches('\n').count(),
            cut + before[line_start..].chars().count(),
        )
    }
}

/// Returns the line of a byte, without the line feed.
fn line_at(text: &str, at: usize) -> Range<usize> {
    let start = text[..at].rfind('\n').map_or(0, |newline| newline + 1);
    let end = text[at..].find('\n').map_or(text.len(), |end| at + end);
    start..end
}

/// Returns a line with those before and after it that are not too long.
fn with_neighbours(text: &str, line: &Range<usize>) -> Range<usize> {
    let short = |line: &Range<usize>| line.len() <= WIDEST;
    let before = line.start.checked_sub(1).map(|at| line_at(text, at));
    let after = (line.end < text.len()).then(|| line_at(text, line.end + 1));
    let start = before.filter(short).map_or(line.start, |line| line.start);
    start..after.filter(short).map_or(line.end, |line| line.end)
}

/// Returns the character, or as many question marks as it has bytes if it cannot be printed.
fn of_same_length(character: char) -> String {
    if is_hazard(character) {
        "?".repeat(character.len_utf8())
    } else {
        character.to_string()
    }
}

impl SourceCode for Excerpt {
    fn read_span<'a>(
        &'a self,
        span: &SourceSpan,
        lines_before: usize,
        lines_after: usize,
    ) -> Result<Box<dyn SpanContents<'a> + 'a>, MietteError> {
        let found = self.text.read_span(span, lines_before, lines_after)?;
        let (line, column) = self.place(found.span().offset());
        // Whole lines are numbered, and a place without its neighbours is told with its column.
        let column = if lines_before == 0 { column } else { 0 };
        let (name, data, count) = (self.name.clone(), found.data(), found.line_count());
        let contents =
            MietteSpanContents::new_named(name, data, *found.span(), line, column, count);
        Ok(Box::new(contents))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn around(text: &str, word: &str) -> (Excerpt, String) {
        let start = text.find(word).expect("the word is there");
        let (excerpt, span) = Excerpt::around(Path::new("a"), text, &(start..start + word.len()));
        let marked = excerpt.text[span].to_owned();
        (excerpt, marked)
    }

    #[test]
    fn short_lines_are_shown_with_their_neighbours() {
        let (excerpt, marked) = around("one\ntwo\nµ wrong\nfour\nfive\n", "wrong");
        assert_eq!((&*excerpt.text, &*marked), ("two\nµ wrong\nfour", "wrong"));
        // The third line, the third character.
        assert_eq!(excerpt.place("two\nµ ".len()), (2, 2));
        let (excerpt, marked) = around("wrong", "wrong");
        assert_eq!((&*excerpt.text, &*marked), ("wrong", "wrong"));
    }

    #[test]
    fn of_long_lines_a_piece_is_shown() {
        let long = "µ".repeat(1 << 20);
        let text = format!("one\n{long}wrong{long}\nthree");
        let (excerpt, marked) = around(&text, "wrong");
        assert!(excerpt.text.len() <= WIDEST, "{}", excerpt.text);
        assert_eq!(marked, "wrong");
        let at = excerpt.text.find("wrong").expect("the word is there");
        assert_eq!(excerpt.place(at), (1, 1 << 20));
        // A long neighbour is left out, and a long mistake is cut.
        let (excerpt, _) = around(&format!("{long}\nwrong"), "wrong");
        assert_eq!((&*excerpt.text, excerpt.line), ("wrong", 1));
        let (excerpt, marked) = around(&text, &long);
        assert!(marked.len() <= WIDEST && !marked.is_empty(), "{marked}");
        assert_eq!(excerpt.line, 1);
    }

    #[test]
    fn what_cannot_be_printed_keeps_its_length() {
        let (excerpt, marked) = around("\u{1b}[2J\u{9b}\u{202e} = wrong\r\n", "wrong");
        assert_eq!(
            (&*excerpt.text, &*marked),
            ("?[2J????? = wrong?\n", "wrong")
        );
    }

    #[test]
    fn every_span_has_an_excerpt() {
        let text = "a\nµ\r\n\n";
        for start in 0..=text.len() + 1 {
            for end in start..=text.len() + 2 {
                let (excerpt, span) = Excerpt::around(Path::new("a"), text, &(start..end));
                assert!(excerpt.text.get(span).is_some(), "{start}..{end}");
            }
        }
    }
}
