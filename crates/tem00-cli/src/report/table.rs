//! Tables of a report.

use core::fmt::Write;

use super::escape::escaped;

/// A table: words to the left, numbers to the right, units in the headings.
#[derive(Clone, Debug, Default)]
pub(crate) struct Table {
    caption: String,
    headings: Vec<String>,
    rows: Vec<Row>,
}

#[derive(Clone, Debug)]
struct Row {
    cells: Vec<String>,
    total: bool,
}

impl Table {
    /// Starts a table with its caption and the headings of its columns.
    pub(crate) fn new(caption: &str, headings: &[&str]) -> Self {
        Self {
            caption: caption.to_owned(),
            headings: headings.iter().copied().map(String::from).collect(),
            rows: Vec::new(),
        }
    }

    /// Adds a row. Missing cells stay empty, those too many are left out.
    pub(crate) fn row(&mut self, cells: Vec<String>) {
        self.rows.push(Row {
            cells,
            total: false,
        });
    }

    /// Adds a row that sums up those above.
    pub(crate) fn total(&mut self, cells: Vec<String>) {
        self.rows.push(Row { cells, total: true });
    }

    /// Writes the table as HTML.
    pub(super) fn write(&self, out: &mut String) {
        // Memory takes whatever it is given.
        let _ = self.write_into(out);
    }

    fn write_into(&self, out: &mut String) -> core::fmt::Result {
        let caption = escaped(&self.caption);
        writeln!(
            out,
            "<div class=\"scroll\"><table><caption>{caption}</caption>"
        )?;
        out.push_str("<thead><tr>");
        for (column, heading) in self.headings.iter().enumerate() {
            let (class, heading) = (self.class(column), escaped(heading));
            write!(out, "<th scope=\"col\"{class}>{heading}</th>")?;
        }
        out.push_str("</tr></thead>\n<tbody>\n");
        for row in &self.rows {
            out.push_str(if row.total {
                "<tr class=\"total\">"
            } else {
                "<tr>"
            });
            for column in 0..self.headings.len() {
                let cell = row.cells.get(column).map_or("", String::as_str);
                write!(out, "<td{}>{}</td>", self.class(column), escaped(cell))?;
            }
            out.push_str("</tr>\n");
        }
        out.push_str("</tbody></table></div>\n");
        Ok(())
    }

    /// Returns the attribute of the cells of a column: numbers stand to the right.
    fn class(&self, column: usize) -> &'static str {
        let cells = || {
            let cells = self.rows.iter().filter_map(|row| row.cells.get(column));
            cells.filter(|cell| !cell.is_empty())
        };
        if cells().next().is_some() && cells().all(|cell| is_number(cell)) {
            " class=\"number\""
        } else {
            ""
        }
    }
}

/// Returns whether a cell holds a number, as "3.2e-6", "± 0.1", "12 %" or "-", where there is none.
fn is_number(cell: &str) -> bool {
    let text = cell.trim_start_matches(['±', '≥', '≤', '<', '>', ' ']);
    let text = text.trim_end_matches(['%', ' ']);
    matches!(text, "-" | "–" | "∞") || text.parse::<f64>().is_ok()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn html(table: &Table) -> String {
        let mut out = String::new();
        table.write(&mut out);
        out
    }

    #[test]
    fn columns_of_numbers_stand_to_the_right() {
        let mut table = Table::new("budget", &["term", "u (µm)", "share"]);
        table.row(vec!["speckle".into(), "3.2".into(), "91 %".into()]);
        table.row(vec!["dark noise".into(), "1e-3".into(), "-".into()]);
        table.total(vec!["combined".into(), "± 3.3".into()]);
        let html = html(&table);
        assert!(html.contains("<th scope=\"col\">term</th>"), "{html}");
        assert!(
            html.contains("<th scope=\"col\" class=\"number\">u (µm)</th>"),
            "{html}"
        );
        assert_eq!(html.matches("<td class=\"number\">").count(), 6, "{html}");
        assert!(html.contains("<tr class=\"total\">"), "{html}");
    }

    #[test]
    fn cells_are_escaped_and_rows_are_as_long_as_the_headings() {
        let mut table = Table::new("<b>", &["a"]);
        table.row(vec!["x < y".into(), "too many".into()]);
        let html = html(&table);
        assert!(
            html.contains("x &lt; y") && !html.contains("too many"),
            "{html}"
        );
        assert!(html.contains("<caption>&lt;b&gt;</caption>"), "{html}");
    }
}
