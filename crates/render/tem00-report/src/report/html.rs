//! Reports as pages: one HTML file that opens offline.

use core::fmt::{self, Write as _};
use std::{io::Write as _, path::Path};

use base64::{Engine, engine::general_purpose::STANDARD};

use super::{Block, Report, Section, Table, cell::Cell, cloud, escape::escaped, style};
use crate::{failure::Failure, output};

impl Report {
    /// Writes the report as a page.
    ///
    /// # Errors
    ///
    /// Returns a failure if the file cannot be written.
    pub fn save_page(&self, path: &Path) -> Result<(), Failure> {
        output::save(path, |file| file.write_all(self.html().as_bytes()))
    }

    /// Returns the page. It refers to nothing outside of itself: scripts, styles, fonts or
    /// pictures; a browser is forbidden to load any.
    pub(super) fn html(&self) -> String {
        let (title, style, dark) = (escaped(&self.title), style::CSS, style::dark());
        let version = env!("CARGO_PKG_VERSION");
        let mut body = String::new();
        // Writing to memory never fails.
        let _ = self.write_body(&mut body);
        let (policy, script) = if self.sections.iter().any(Section::turns) {
            let script = format!("<script>\n{}</script>\n", cloud::SCRIPT);
            ("; script-src 'unsafe-inline'", script)
        } else {
            ("", String::new())
        };
        format!(
            "<!DOCTYPE html>\n<html lang=\"en\">\n<head>\n<meta charset=\"utf-8\">\n\
             <meta http-equiv=\"Content-Security-Policy\" content=\"default-src 'none'; \
             img-src data:; style-src 'unsafe-inline'; base-uri 'none'; \
             form-action 'none'{policy}\">\n\
             <meta name=\"viewport\" content=\"width=device-width, initial-scale=1\">\n\
             <title>{title}</title>\n<style>\n{style}{dark}</style>\n</head>\n\
             <body>\n<main>\n{body}\
             <footer>tem00 {version}</footer>\n</main>\n{script}</body>\n</html>\n"
        )
    }

    fn write_body(&self, out: &mut String) -> fmt::Result {
        element(out, "h1", &self.title)?;
        if let Some((result, others)) = self.verdicts.split_first() {
            writeln!(out, "<p class=\"verdict\">{}</p>", escaped(result))?;
            paragraphs(out, others)?;
        }
        paragraphs(out, &self.warnings)?;
        paragraphs(out, &self.notes)?;
        let mut sections = self.sections.iter();
        sections.try_for_each(|section| section.write_html(out))
    }
}

fn paragraphs(out: &mut String, texts: &[String]) -> fmt::Result {
    texts.iter().try_for_each(|text| element(out, "p", text))
}

fn element(out: &mut String, name: &str, text: &str) -> fmt::Result {
    writeln!(out, "<{name}>{}</{name}>", escaped(text))
}

impl Section {
    fn turns(&self) -> bool {
        let mut blocks = self.blocks.iter();
        blocks.any(|block| matches!(block, Block::Drawing { turns: true, .. }))
    }

    fn write_html(&self, out: &mut String) -> fmt::Result {
        element(out, "h2", &self.heading)?;
        let shown = |block: &&Block| !matches!(block, Block::Data(..));
        let blocks: Vec<_> = self.blocks.iter().filter(shown).collect();
        // Names stand in one list, and drawings side by side.
        let mut runs = blocks.chunk_by(|a, b| a.tags() != ALONE && a.tags() == b.tags());
        runs.try_for_each(|run| {
            let (start, end) = run[0].tags();
            out.push_str(start);
            run.iter().try_for_each(|block| block.write_html(out))?;
            out.push_str(end);
            Ok(())
        })
    }
}

/// The tags about blocks that do not stand together.
const ALONE: (&str, &str) = ("", "");

impl Block {
    /// Returns the tags about a run of blocks of this kind.
    const fn tags(&self) -> (&'static str, &'static str) {
        match self {
            Self::Fact(..) => ("<dl>\n", "</dl>\n"),
            Self::Drawing { turns: false, .. } => ("<div class=\"drawings\">\n", "</div>\n"),
            _ => ALONE,
        }
    }

    fn write_html(&self, out: &mut String) -> fmt::Result {
        match self {
            Self::Fact(_, name, value) => {
                let (name, value) = (escaped(name), escaped(&value.text));
                writeln!(out, "<dt>{name}</dt><dd>{value}</dd>")
            }
            Self::Data(..) => Ok(()),
            Self::Table(table) => table.write_html(out),
            Self::Paragraph(text) => element(out, "p", text),
            Self::Drawing { svg, caption, .. } => {
                let label = format!("<svg role=\"img\" aria-label=\"{}\"", escaped(caption));
                // A declaration may only begin a file.
                let start = svg.find("<svg").unwrap_or(svg.len());
                with_caption(out, &svg[start..].replacen("<svg", &label, 1), caption)
            }
            Self::Picture {
                png,
                columns,
                caption,
            } => with_caption(out, &image(png, *columns, caption), caption),
            Self::File(name, text) => {
                let (name, text) = (escaped(name), escaped(text));
                let details = "<details><summary>";
                writeln!(out, "{details}{name}</summary><pre>{text}</pre></details>")
            }
        }
    }
}

fn with_caption(out: &mut String, content: &str, caption: &str) -> fmt::Result {
    let caption = escaped(caption);
    writeln!(
        out,
        "<figure>{content}<figcaption>{caption}</figcaption></figure>"
    )
}

/// Returns a picture, a small one enlarged.
fn image(png: &[u8], columns: usize, caption: &str) -> String {
    /// About the width of the page.
    const WIDTH: usize = 900;
    let shown = (WIDTH / columns.max(1)).max(1) * columns;
    let class = if shown > columns {
        " class=\"enlarged\""
    } else {
        ""
    };
    let (text, data) = (escaped(caption), STANDARD.encode(png));
    format!("<img{class} width=\"{shown}\" alt=\"{text}\" src=\"data:image/png;base64,{data}\">")
}

impl Table {
    /// Writes the table: words to the left, numbers to the right.
    fn write_html(&self, out: &mut String) -> fmt::Result {
        let caption = escaped(&self.caption);
        let columns = self.columns.iter().enumerate();
        let shown: Vec<_> = columns
            .filter_map(|(index, column)| Some((index, column.heading.as_deref()?)))
            .map(|(index, heading)| (index, heading, self.class(index)))
            .collect();
        writeln!(
            out,
            "<div class=\"scroll\"><table><caption>{caption}</caption>"
        )?;
        out.push_str("<thead><tr>");
        for (_, heading, class) in &shown {
            write!(out, "<th scope=\"col\"{class}>{}</th>", escaped(heading))?;
        }
        out.push_str("</tr></thead>\n<tbody>\n");
        for (number, row) in self.all_rows().enumerate() {
            out.push_str(if number < self.rows.len() {
                "<tr>"
            } else {
                "<tr class=\"total\">"
            });
            for (index, _, class) in &shown {
                let text = row.get(*index).map_or("", Cell::text);
                write!(out, "<td{class}>{}</td>", escaped(text))?;
            }
            out.push_str("</tr>\n");
        }
        out.push_str("</tbody></table></div>\n");
        Ok(())
    }

    /// Returns the attribute of the cells of a column.
    fn class(&self, column: usize) -> &'static str {
        let cells = || self.all_rows().filter_map(|row| row.get(column));
        let is_number = |cell: &Cell| cell.data.is_number() || cell.data.is_null();
        if cells().any(|cell| cell.data.is_number()) && cells().all(is_number) {
            " class=\"number\""
        } else {
            ""
        }
    }
}
