//! Reports: one HTML file that opens offline.

mod cloud;
mod escape;
mod style;
mod table;

use core::fmt::Write as _;
use std::{io::Write as _, path::Path};

use base64::{Engine, engine::general_purpose::STANDARD};

use self::escape::escaped;
pub(crate) use self::{cloud::Cloud, table::Table};
use crate::{atomic::write_atomically, failure::Failure};

/// A report in the making: one HTML file with everything in it, for screens and paper.
///
/// It refers to nothing outside of itself: scripts, styles, fonts or pictures; a browser is told to load
/// none. Whatever it is given as text appears as that text. The same calls give the same bytes.
#[derive(Clone, Debug)]
pub(crate) struct Report {
    title: String,
    body: String,
    /// Whether there are points to turn.
    turns: bool,
}

impl Report {
    /// Starts a report with its title.
    pub(crate) fn new(title: &str) -> Self {
        let mut report = Self {
            title: title.to_owned(),
            body: String::new(),
            turns: false,
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

    /// Adds drawings with their captions, side by side where there is room.
    pub(crate) fn drawings<'a>(&mut self, drawings: impl IntoIterator<Item = (&'a str, &'a str)>) {
        self.body.push_str("<div class=\"drawings\">\n");
        for (svg, caption) in drawings {
            self.drawing(svg, caption);
        }
        self.body.push_str("</div>\n");
    }

    /// Adds a drawing with its caption. `svg` is the text of an SVG file of this program.
    pub(crate) fn drawing(&mut self, svg: &str, caption: &str) {
        let label = format!("<svg role=\"img\" aria-label=\"{}\"", escaped(caption));
        // A declaration may only begin a file.
        let start = svg.find("<svg").unwrap_or(svg.len());
        self.figure(&svg[start..].replacen("<svg", &label, 1), caption);
    }

    /// Adds points in space that the reader may turn, if there are any.
    pub(crate) fn cloud(&mut self, cloud: Cloud<'_>) {
        if let Some((svg, caption)) = cloud.draw() {
            self.turns = true;
            self.drawing(&svg, &caption);
        }
    }

    /// Adds a picture with its caption, a small one enlarged. `png` is the content of a PNG file of so many
    /// columns.
    pub(crate) fn picture(&mut self, png: &[u8], columns: usize, caption: &str) {
        /// About the width of the page.
        const WIDTH: usize = 900;
        let data = STANDARD.encode(png);
        let text = escaped(caption);
        let shown = (WIDTH / columns.max(1)).max(1) * columns;
        let class = if shown > columns {
            " class=\"enlarged\""
        } else {
            ""
        };
        self.figure(
            &format!(
                "<img{class} width=\"{shown}\" alt=\"{text}\" src=\"data:image/png;base64,{data}\">"
            ),
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
        let dark = style::dark();
        let script = if self.turns {
            format!("<script>\n{}</script>\n", cloud::SCRIPT)
        } else {
            String::new()
        };
        format!(
            "<!DOCTYPE html>\n<html lang=\"en\">\n<head>\n<meta charset=\"utf-8\">\n\
             <meta http-equiv=\"Content-Security-Policy\" content=\"default-src 'none'; img-src data:; \
             style-src 'unsafe-inline'; script-src 'unsafe-inline'\">\n<meta name=\"viewport\" content=\"width=device-width, initial-scale=1\">\n\
             <title>{title}</title>\n<style>\n{style}{dark}</style>\n</head>\n<body>\n<main>\n{body}\
             <footer>tem00 {version}</footer>\n</main>\n{script}</body>\n</html>\n"
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
