//! External text in a form that is safe to show.

use std::borrow::Cow;

/// Returns text that cannot control a terminal: control characters, and characters that change the
/// direction of writing, are replaced by `\u001b` and the like. Line feeds and tabs stay.
///
/// Inside a JSON string the replacements mean the same characters.
pub fn printable(text: &str) -> Cow<'_, str> {
    if !text.contains(is_hazard) {
        return Cow::Borrowed(text);
    }
    let mut out = String::with_capacity(text.len() + 16);
    for character in text.chars() {
        if is_hazard(character) {
            out += &format!("\\u{:04x}", u32::from(character));
        } else {
            out.push(character);
        }
    }
    Cow::Owned(out)
}

/// Returns the [`printable`] text on one line, cut after `max_chars` characters.
pub fn printable_line(text: &str, max_chars: usize) -> String {
    let cut = text.char_indices().nth(max_chars);
    let (kept, rest) = text.split_at(cut.map_or(text.len(), |(at, _)| at));
    let line = printable(kept).replace('\n', "\\n").replace('\t', "\\t");
    let more = if rest.is_empty() { "" } else { "…" };
    line + more
}

/// Returns whether a character could do something to a terminal or a page other than show itself: a
/// control character other than a line feed or a tab, a separator of lines, or a mark that changes
/// the direction of writing.
pub const fn is_hazard(character: char) -> bool {
    matches!(character,
        '\0'..='\x08' | '\x0b'..='\x1f' | '\x7f'..='\u{9f}'
        | '\u{61c}' | '\u{200e}' | '\u{200f}' | '\u{2028}'..='\u{202e}' | '\u{2066}'..='\u{2069}')
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_a_terminal_obeys_is_written_out() {
        for (text, shown) in [
            ("σ = 3.2 µm\n\tand more", "σ = 3.2 µm\n\tand more"),
            ("\u{1b}[31mred\u{1b}[0m", "\\u001b[31mred\\u001b[0m"),
            ("\u{9b}2J\u{7f}\r\0", "\\u009b2J\\u007f\\u000d\\u0000"),
            ("\u{202e}txt.exe\u{2066}", "\\u202etxt.exe\\u2066"),
        ] {
            assert_eq!(printable(text), shown);
        }
        // ECMA-48: C0 is 0 to 31 with ESC, DEL is 127, C1 is 128 to 159.
        let hazards = ('\0'..='\u{a0}').filter(|&c| is_hazard(c)).count();
        assert_eq!(hazards, 32 - 2 + 1 + 32);
    }

    #[test]
    fn a_line_is_one_line_and_not_too_long() {
        assert_eq!(printable_line("a\nb\tc", 9), "a\\nb\\tc");
        assert_eq!(printable_line("µµµµ", 4), "µµµµ");
        assert_eq!(printable_line("µµµµµ", 4), "µµµµ…");
        let long = "\u{1b}".repeat(1 << 20);
        assert_eq!(printable_line(&long, 10).chars().count(), 61);
    }
}
