//! The literals of Python that stand in the header of a NumPy file.

use super::NpyError;

/// A value of the header's dictionary.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(super) enum Literal {
    /// A string without escapes.
    Text(String),
    Boolean(bool),
    /// A tuple or list of integers of at least 0.
    Numbers(Vec<u64>),
    /// Anything else, as it is written: the type of a structured array.
    Other(String),
}

/// The rest of a text that is read from its front.
#[derive(Clone, Debug)]
pub(super) struct Literals<'a> {
    rest: &'a str,
}

impl<'a> Literals<'a> {
    pub(super) const fn new(text: &'a str) -> Self {
        Self { rest: text }
    }

    /// Takes `token`, and the blanks before it, if it comes next.
    pub(super) fn takes(&mut self, token: char) -> bool {
        match self.rest.trim_start().strip_prefix(token) {
            Some(rest) => {
                self.rest = rest;
                true
            }
            None => false,
        }
    }

    /// Returns whether only blanks are left.
    pub(super) fn is_at_end(&self) -> bool {
        self.rest.trim_start().is_empty()
    }

    /// Takes a string in quotes of either kind.
    pub(super) fn text(&mut self) -> Option<&'a str> {
        let quote = ['\'', '"'].into_iter().find(|&quote| self.takes(quote))?;
        let (text, rest) = self.rest.split_once(quote)?;
        self.rest = rest;
        Some(text)
    }

    /// Takes any value.
    pub(super) fn value(&mut self) -> Result<Literal, NpyError> {
        let start = self.rest.trim_start();
        if let Some(text) = self.text() {
            return Ok(Literal::Text(text.to_owned()));
        }
        for (word, value) in [("True", true), ("False", false)] {
            if let Some(rest) = start.strip_prefix(word) {
                self.rest = rest;
                return Ok(Literal::Boolean(value));
            }
        }
        self.rest = start;
        let raw = self.bracketed()?;
        Ok(numbers(raw).map_or_else(|| Literal::Other(raw.to_owned()), Literal::Numbers))
    }

    /// Takes all from a bracket to the one that closes it, strings and brackets within.
    fn bracketed(&mut self) -> Result<&'a str, NpyError> {
        let (mut depth, mut quote) = (0_usize, None);
        for (at, c) in self.rest.char_indices() {
            match (quote, c) {
                (Some(open), c) if c == open => quote = None,
                (Some(_), _) => {}
                (None, '\'' | '"') => quote = Some(c),
                (None, '(' | '[') => depth += 1,
                (None, ')' | ']') => depth = depth.saturating_sub(1),
                _ => {}
            }
            if depth == 0 {
                let (value, rest) = self.rest.split_at(at + c.len_utf8());
                self.rest = rest;
                return match value.len() {
                    1 => Err(NpyError::Header("an entry is no literal of Python")),
                    _ => Ok(value),
                };
            }
        }
        Err(NpyError::Header("a bracket is not closed"))
    }
}

/// The numbers of a tuple or a list.
fn numbers(raw: &str) -> Option<Vec<u64>> {
    let inner = raw
        .strip_prefix('(')
        .and_then(|raw| raw.strip_suffix(')'))
        .or_else(|| raw.strip_prefix('[')?.strip_suffix(']'))?;
    let inner = inner.trim();
    let inner = inner.strip_suffix(',').unwrap_or(inner);
    if inner.is_empty() {
        return Some(Vec::new());
    }
    // Python 2 wrote an L behind long numbers.
    let number = |text: &str| text.trim().trim_end_matches('L').parse().ok();
    inner.split(',').map(number).collect()
}
