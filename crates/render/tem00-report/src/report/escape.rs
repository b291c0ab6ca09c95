//! Text in HTML and XML.

use std::borrow::Cow;

use tem00_config::is_hazard;

/// Returns text as HTML and XML show it, between tags and in quoted attributes.
///
/// Characters that no such file may contain, and characters that change the direction of writing,
/// become the replacement character.
pub fn escaped(text: &str) -> Cow<'_, str> {
    let special = |c: char| matches!(c, '&' | '<' | '>' | '"' | '\'') || is_unwanted(c);
    if !text.contains(special) {
        return Cow::Borrowed(text);
    }
    let mut out = String::with_capacity(text.len() + 16);
    for c in text.chars() {
        match c {
            '&' => out.push_str("&amp;"),
            '<' => out.push_str("&lt;"),
            '>' => out.push_str("&gt;"),
            '"' => out.push_str("&quot;"),
            '\'' => out.push_str("&#39;"),
            c if is_unwanted(c) => out.push(char::REPLACEMENT_CHARACTER),
            c => out.push(c),
        }
    }
    Cow::Owned(out)
}

/// Returns whether a character does something other than show itself, or may not appear in XML.
pub fn is_unwanted(c: char) -> bool {
    is_hazard(c) || matches!(c, '\u{fffe}' | '\u{ffff}')
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn text_stays_text() {
        for (text, expected) in [
            ("σ = 3.2 µm", "σ = 3.2 µm"),
            (
                "<script>alert('x')</script>",
                "&lt;script&gt;alert(&#39;x&#39;)&lt;/script&gt;",
            ),
            ("a & \"b\"", "a &amp; &quot;b&quot;"),
            ("two\nlines\tand \u{1b}[0m", "two\nlines\tand \u{fffd}[0m"),
            ("\u{202e}fdp.exe", "\u{fffd}fdp.exe"),
            ("a\u{fffe}b\u{ffff}\u{fffd}", "a\u{fffd}b\u{fffd}\u{fffd}"),
            ("\u{10ffff}\u{fdd0}", "\u{10ffff}\u{fdd0}"),
        ] {
            assert_eq!(escaped(text), expected);
        }
    }
}
