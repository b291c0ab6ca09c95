//! The report of a budget.

use super::{Answer, Findings, words};
use crate::report::{Report, Table};

/// Returns the report, with the drawings as SVG.
pub(super) fn report(findings: &Findings<'_>, drawings: &[String]) -> Report {
    let mut report = Report::new("Uncertainty budget of a laser-triangulation set-up");
    match &findings.answer {
        Ok(answer) => verdicts(
            &mut report,
            &words::verdicts(answer, findings.setup.light_level()),
        ),
        Err(refusal) => verdicts(&mut report, &words::refusal(refusal)),
    }
    if let Ok(answer) = &findings.answer {
        budget(&mut report, answer, drawings);
    }
    report.heading("The set-up");
    report.facts(&words::facts(findings));
    report.heading("Files");
    report.file(&findings.file.display().to_string(), &findings.text);
    report
}

fn verdicts(report: &mut Report, lines: &[String]) {
    for (number, line) in lines.iter().enumerate() {
        if number == 0 {
            report.verdict(&sentence(line));
        } else {
            report.paragraph(&sentence(line));
        }
    }
}

fn budget(report: &mut Report, answer: &Answer, drawings: &[String]) {
    const CAPTIONS: [&str; 2] = [
        "The standard uncertainty of a height by each source alone, and by all.",
        "The combined standard uncertainty, by formulas, over the heights that are in the image and in \
         the depth of field.",
    ];
    report.heading("The budget");
    report.table(&table(answer));
    report.paragraph(
        "Types after the GUM: A by statistics, B by models and data sheets. Formulas are first order in \
         the noise. Trials expose simulated frames and find the line in them: errors of a single source \
         against the place without noise, those of all at once against the true place; ± is a standard \
         error.",
    );
    let drawings = drawings.iter().map(String::as_str);
    report.drawings(drawings.zip(CAPTIONS));
}

fn table(answer: &Answer) -> Table {
    let lines = words::table(answer);
    let headings: Vec<&str> = lines[0].iter().map(String::as_str).collect();
    let last = lines.len() - 1;
    let mut table = Table::new("Standard uncertainties of a height", &headings);
    for row in &lines[1..last] {
        table.row(row.clone());
    }
    table.total(words::combined(answer));
    table
}

/// Begins a line as a sentence, and ends it as one.
fn sentence(line: &str) -> String {
    let mut letters = line.chars();
    let first = letters
        .next()
        .map(|letter| letter.to_uppercase().to_string());
    format!("{}{}.", first.unwrap_or_default(), letters.as_str())
}
