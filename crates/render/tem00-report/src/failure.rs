//! Failures of the program and their exit codes.

use std::{
    io::{self, IsTerminal},
    path::Path,
};

use annotate_snippets::{Group, Level, Renderer};
use tem00_config::{ConfigError, printable_line};

use crate::excerpt::Excerpt;

/// The reason why the program ends before its work is done.
#[derive(Debug)]
pub enum Failure {
    /// The input of the user cannot be used. Exit code 2.
    Input(Box<Problem>),
    /// A resource is unavailable, whatever the input: memory, a readable file, or a writable folder
    /// that no other process uses. Exit code 2.
    Unavailable(Box<Problem>),
    /// The work itself failed. Exit code 1.
    Running(Box<Problem>),
    /// The work was done and has no result: nothing was measured, or nothing found. Exit code 3.
    NoResult(Box<Problem>),
    /// The user interrupted the program. Exit code 130, as shells count it.
    Interrupted,
    /// Nobody reads standard output any more, as after `| head`. Exit code 0: the reader has
    /// enough.
    NoReader,
}

impl Failure {
    /// Returns a failure about the input: what is wrong with which value, and what is allowed.
    pub fn input(message: impl Into<String>, help: impl Into<String>) -> Self {
        Self::Input(Problem::new(message.into(), Some(help.into())).into())
    }

    /// Returns a failure about a resource that the work needs and does not find now, and what to do
    /// about it.
    pub fn unavailable(message: impl Into<String>, help: impl Into<String>) -> Self {
        Self::Unavailable(Problem::new(message.into(), Some(help.into())).into())
    }

    /// Returns a failure about the input or, if `no_memory`, about the available memory.
    pub fn refused(no_memory: bool, message: String, help: impl Into<String>) -> Self {
        if no_memory {
            Self::unavailable(message, help)
        } else {
            Self::input(message, help)
        }
    }

    /// Returns the failure that completed work has no result, and what to change.
    pub fn no_result(message: impl Into<String>, help: impl Into<String>) -> Self {
        Self::NoResult(Problem::new(message.into(), Some(help.into())).into())
    }

    /// Returns a failure about a position in a text file.
    pub fn input_at(
        message: impl Into<String>,
        help: Option<String>,
        (file, text): (&Path, &str),
        span: core::ops::Range<usize>,
    ) -> Self {
        Self::Input(
            Problem {
                excerpt: Some(Excerpt::around(file, text, &span)),
                ..Problem::new(message.into(), help)
            }
            .into(),
        )
    }

    /// Returns a failure about a scene file, a set-up file or one that they include, with
    /// `otherwise` for help where the error has no position and no help of its own.
    pub fn file(path: &Path, error: &ConfigError, otherwise: &str) -> Self {
        let help = error.help().map(str::to_owned);
        let path = error.path().unwrap_or(path);
        let failure = match error.span() {
            Some(span) => Self::input_at(error.message(), help, (path, error.source_text()), span),
            None => Self::input(
                format!("{}: {}", path.display(), error.message()),
                help.unwrap_or_else(|| otherwise.into()),
            ),
        };
        match failure {
            Self::Input(problem) if error.is_unreadable() => Self::Unavailable(problem),
            other => other,
        }
    }

    /// Returns a failure of the work itself.
    pub fn running(message: impl Into<String>) -> Self {
        Self::Running(Problem::new(message.into(), None).into())
    }

    /// Returns the failure to write a file.
    pub fn writing(path: &Path, error: impl core::fmt::Display) -> Self {
        Self::running(format!("cannot write {}: {error}", path.display()))
    }

    /// Returns the failure to write standard output.
    pub fn stdout(error: &io::Error) -> Self {
        if error.kind() == io::ErrorKind::BrokenPipe {
            Self::NoReader
        } else {
            Self::running(format!("cannot write to standard output: {error}"))
        }
    }

    const fn problem(&self) -> Option<&Problem> {
        match self {
            Self::Input(problem)
            | Self::Unavailable(problem)
            | Self::Running(problem)
            | Self::NoResult(problem) => Some(problem),
            Self::Interrupted | Self::NoReader => None,
        }
    }

    /// Returns the message of the failure, in one line.
    pub fn message(&self) -> &str {
        self.problem().map_or("", |problem| &problem.message)
    }

    /// Returns the failure with its subject in front of its message, if a resource is unavailable.
    pub fn about(mut self, what: impl core::fmt::Display) -> Self {
        if let Self::Unavailable(problem) = &mut self {
            problem.message = format!("{what}: {}", problem.message);
        }
        self
    }

    /// Returns the exit code of the program.
    pub fn exit_code(&self) -> u8 {
        match self {
            Self::NoReader => 0,
            Self::Running(_) => 1,
            Self::Input(_) | Self::Unavailable(_) => 2,
            Self::NoResult(_) => 3,
            Self::Interrupted => 130,
        }
    }

    /// Returns what to print on standard error, if anything.
    pub fn report(&self) -> Option<String> {
        match self {
            Self::Interrupted => Some("tem00: interrupted\n".into()),
            other => other.problem().map(Problem::printed),
        }
    }
}

/// Message with its position in a file.
#[derive(Debug)]
pub struct Problem {
    message: String,
    help: Option<String>,
    excerpt: Option<Excerpt>,
}

impl Problem {
    /// The maximum number of characters of a message.
    const MAX_CHARS: usize = 2000;

    /// Returns a problem without a position. Its quotations may be long and hold any characters.
    fn new(message: String, help: Option<String>) -> Self {
        let shown = |text: String| printable_line(&text, Self::MAX_CHARS);
        Self {
            message: shown(message),
            help: help.map(shown),
            excerpt: None,
        }
    }

    /// Returns the text for standard error, in colours where that is a terminal.
    fn printed(&self) -> String {
        let title = Level::ERROR.primary_title(&self.message);
        let mut group = match &self.excerpt {
            Some(excerpt) => excerpt.under(title),
            None => Group::with_title(title),
        };
        if let Some(help) = &self.help {
            group = group.element(Level::HELP.message(help));
        }
        let plain = std::env::var_os("NO_COLOR").is_some_and(|value| !value.is_empty());
        let renderer = if io::stderr().is_terminal() && !plain {
            Renderer::styled()
        } else {
            Renderer::plain()
        };
        renderer.render(&[group]) + "\n"
    }
}
