//! Failures of the program and their exit codes.

use std::{io, path::Path};

use miette::{Diagnostic, Report, SourceSpan};
use tem00_config::{ConfigError, printable_line};
use thiserror::Error;

use crate::excerpt::Excerpt;

/// The reason for which the program ends before its work is done.
#[derive(Debug)]
pub(crate) enum Failure {
    /// The user gave something that cannot be used. Exit code 2.
    Input(Report),
    /// The work itself failed. Exit code 1.
    Running(Report),
    /// The work was done and has no result: nothing was measured, or nothing found. Exit code 3.
    NoResult(Report),
    /// The user asked for the end. Exit code 130, as shells count it.
    Interrupted,
    /// Nobody reads standard output any more, as after `| head`. Exit code 0: they had enough.
    NoReader,
}

impl Failure {
    /// Returns a complaint about the input: what is wrong with which value, and what is allowed.
    pub(crate) fn input(message: impl Into<String>, help: impl Into<String>) -> Self {
        Self::Input(Report::new(Problem::new(message.into(), Some(help.into()))))
    }

    /// Returns why work that was done has no result, and what to change.
    pub(crate) fn no_result(message: impl Into<String>, help: impl Into<String>) -> Self {
        Self::NoResult(Report::new(Problem {
            message: message.into(),
            help: Some(help.into()),
            source_code: None,
            span: None,
        }))
    }

    /// Returns a complaint about a position in a text file.
    pub(crate) fn input_at(
        message: impl Into<String>,
        help: Option<String>,
        (file, text): (&Path, &str),
        span: core::ops::Range<usize>,
    ) -> Self {
        let (excerpt, span) = Excerpt::around(file, text, &span);
        Self::Input(Report::new(Problem {
            source_code: Some(excerpt),
            span: Some(span.into()),
            ..Problem::new(message.into(), help)
        }))
    }

    /// Returns a complaint about a scene file, a set-up file or one that they include, with `otherwise`
    /// for help where the complaint has no position and no help of its own.
    pub(crate) fn file(path: &Path, error: &ConfigError, otherwise: &str) -> Self {
        let help = error.help().map(str::to_owned);
        let path = error.path().unwrap_or(path);
        match error.span() {
            Some(span) => Self::input_at(error.message(), help, (path, error.source_text()), span),
            None => Self::input(
                format!("{}: {}", path.display(), error.message()),
                help.unwrap_or_else(|| otherwise.into()),
            ),
        }
    }

    /// Returns a failure of the work itself.
    pub(crate) fn running(message: impl Into<String>) -> Self {
        Self::Running(Report::new(Problem::new(message.into(), None)))
    }

    /// Returns the failure to write a file.
    pub(crate) fn writing(path: &Path, error: impl core::fmt::Display) -> Self {
        Self::running(format!("cannot write {}: {error}", path.display()))
    }

    /// Returns the failure to write standard output.
    pub(crate) fn stdout(error: &io::Error) -> Self {
        if error.kind() == io::ErrorKind::BrokenPipe {
            Self::NoReader
        } else {
            Self::running(format!("cannot write to standard output: {error}"))
        }
    }

    /// Returns the exit code of the program.
    pub(crate) fn exit_code(&self) -> u8 {
        match self {
            Self::NoReader => 0,
            Self::Running(_) => 1,
            Self::Input(_) => 2,
            Self::NoResult(_) => 3,
            Self::Interrupted => 130,
        }
    }

    /// Returns what to print on standard error, if anything.
    pub(crate) fn report(&self) -> Option<String> {
        match self {
            Self::Input(report) | Self::Running(report) | Self::NoResult(report) => {
                Some(format!("{report:?}"))
            }
            Self::Interrupted => Some("tem00: interrupted\n".into()),
            Self::NoReader => None,
        }
    }
}

/// One message with the position it is about.
#[derive(Debug, Diagnostic, Error)]
#[error("{message}")]
struct Problem {
    message: String,
    #[help]
    help: Option<String>,
    #[source_code]
    source_code: Option<Excerpt>,
    #[label("here")]
    span: Option<SourceSpan>,
}

impl Problem {
    /// The most characters of a message.
    const MAX_CHARS: usize = 2000;

    /// Returns a problem without a position. What it quotes may be long and hold anything.
    fn new(message: String, help: Option<String>) -> Self {
        let shown = |text: String| printable_line(&text, Self::MAX_CHARS);
        Self {
            message: shown(message),
            help: help.map(shown),
            source_code: None,
            span: None,
        }
    }
}
