//! Reports: one HTML file that opens offline.

mod escape;
mod style;
mod table;

use core::fmt::Write as _;
use std::{io::Write as _, path::Path};

use base64::{Engine, engine::general_purpose::STANDARD};

use self::escape::escaped;
pub(crate) use self::table::Table;
use crate::{atomic::write_atomically, failure::Failure};

/// A report in the making: one HTML file with everything in it, for screens and paper.
///
/// It refers to nothing outside of itself: no scripts, no styles, no fonts, no pictures. Whatever it is
/// given as text appears as that text.
#[derive(Clone, Debug)]
pub(crate) struct Report {
    title: String,
    body: String,
}

impl Report {
    /// Starts a report with its title.
    pub(crate) fn new(title: &str) -> Self {
        let mut report = Self {
            title: title.to_owned(),
            body: String::new(),
        };
        report.element("h1", title);
        report
    }

    /// Starts a section.
    pub(crate) fn heading(&mut self, text: &str) {
        self.element("h2", text);
    }

    /// Adds a paragraph.
    pub(crate) fn paragraph(&mut self, text: &str) {
        self.element("p", text);
    }

    /// Adds a paragraph that stands out: what the report comes to.
    pub(crate) fn verdict(&mut self, text: &str) {
        self.push(format_args!("<p class=\"verdict\">{}</p>\n", escaped(text)));
    }

    /// Adds a list of names and what they are.
    pub(crate) fn facts(&mut self, facts: &[(&str, String)]) {
        self.body.push_str("<dl>\n");
        for (name, value) in facts {
            let (name, value) = (escaped(name), escaped(value));
            self.push(format_args!("<dt>{name}</dt><dd>{value}</dd>\n"));
        }
        self.body.push_str("</dl>\n");
    }

    /// Adds a table.
    pub(crate) fn table(&mut self, table: &Table) {
        table.write(&mut self.body);
    }

    /// Adds a drawing with its caption. `svg` is the text of an SVG file of this program.
    pub(crate) fn drawing(&mut self, svg: &str, caption: &str) {
        // A declaration may only begin a file.
        let start = svg.find("<svg").unwrap_or(svg.len());
        self.figure(&svg[start..], caption);
    }

    /// Adds a picture with its caption. `png` is the content of a PNG file.
    pub(crate) fn picture(&mut self, png: &[u8], caption: &str) {
        let data = STANDARD.encode(png);
        let text = escaped(caption);
        self.figure(
            &format!("<img alt=\"{text}\" src=\"data:image/png;base64,{data}\">"),
            caption,
        );
    }

    /// Adds a file as it is, under its name.
    pub(crate) fn file(&mut self, name: &str, text: &str) {
        let (name, text) = (escaped(name), escaped(text));
        self.push(format_args!(
            "<details><summary>{name}</summary><pre>{text}</pre></details>\n"
        ));
    }

    /// Returns the file.
    pub(crate) fn html(&self) -> String {
        let (title, style, body) = (escaped(&self.title), style::CSS, &self.body);
        let version = env!("CARGO_PKG_VERSION");
        format!(
            "<!DOCTYPE html>\n<html lang=\"en\">\n<head>\n<meta charset=\"utf-8\">\n\
             <meta name=\"viewport\" content=\"width=device-width, initial-scale=1\">\n\
             <title>{title}</title>\n<style>\n{style}</style>\n</head>\n<body>\n<main>\n{body}\
             <footer>tem00 {version}</footer>\n</main>\n</body>\n</html>\n"
        )
    }

    /// Writes the file.
    ///
    /// # Errors
    ///
    /// Returns a failure if it cannot be written.
    pub(crate) fn save(&self, path: &Path) -> Result<(), Failure> {
        write_atomically(path, |file| file.write_all(self.html().as_bytes()))
            .map_err(|error| Failure::writing(path, error))
    }

    fn figure(&mut self, content: &str, caption: &str) {
        let caption = escaped(caption);
        self.push(format_args!(
            "<figure>{content}<figcaption>{caption}</figcaption></figure>\n"
        ));
    }

    fn element(&mut self, name: &str, text: &str) {
        self.push(format_args!("<{name}>{}</{name}>\n", escaped(text)));
    }

    fn push(&mut self, text: core::fmt::Arguments<'_>) {
        // Memory takes whatever it is given.
        let _ = self.body.write_fmt(text);
    }
}

#[cfg(test)]
mod tests;
