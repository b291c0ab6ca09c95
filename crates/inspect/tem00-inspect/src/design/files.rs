//! The files of a search.

use std::{
    io::{self, Write},
    path::{Path, PathBuf},
};

use tem00_report::{failure::Failure, output, report::Report};
use tem00_triangulation::{Candidate, DesignFigure, Neighbours};

use super::{plots, report, search::Design};
use crate::units;

/// Writes all files into the folder, and returns the report and the names of the files to open
/// first.
pub(super) fn write(
    design: &Design<'_>,
    near: &[Neighbours],
    folder: &Path,
) -> Result<(Report, Vec<PathBuf>), Failure> {
    let path = |name: &str| folder.join(name);
    let best = best(design)?;
    let mut names = vec!["design.csv", "design.json", "design.html"];
    if let Some(best) = &best {
        output::save(&path("best.toml"), |file| file.write_all(best.as_bytes()))?;
        names.insert(0, "best.toml");
    }
    output::save(&path("design.csv"), |file| write_csv(design, file))?;
    let drawings = plots::all(design, near).into_iter();
    let drawings =
        drawings.map(|named| Ok((named.drawing.save(folder, &named.name)?, named.caption)));
    let drawings = drawings.collect::<Result<_, Failure>>()?;
    let report = report::report(design, near, drawings, best.as_deref())?;
    report.save_json(&path("design.json"))?;
    report.save_page(&path("design.html"))?;
    Ok((report, names.into_iter().map(path).collect()))
}

/// Returns the best set-up as the text of a set-up file, if there is one.
fn best(design: &Design<'_>) -> Result<Option<String>, Failure> {
    let Some((winner, figures)) = design.winner().and_then(|w| Some((w, w.allowed()?))) else {
        return Ok(None);
    };
    // A name may hold what would end the line of a comment.
    let file = design
        .file
        .display()
        .to_string()
        .replace(char::is_control, " ");
    let expanded = units::shown(DesignFigure::ExpandedUncertainty.unit());
    let text = Design::setup_of(winner)?.description().to_toml();
    Ok(Some(format!(
        "# The best of the {} set-ups that `tem00-inspect design {file}` tried: number {}.\n\
         # By formulas, a height on the reference plane is known to ±{} (95 %).\n\
         #\n\
         #     tem00-inspect budget best.toml\n\n\
         {text}",
        design.search.count(),
        winner.index,
        expanded.text(figures.expanded_uncertainty),
    )))
}

/// Writes all set-ups, in SI units that the headings end with, a line for each.
fn write_csv(design: &Design<'_>, out: &mut impl Write) -> io::Result<()> {
    let sweeps = || {
        design
            .search
            .question()
            .sweeps
            .iter()
            .map(|sweep| sweep.parameter())
    };
    write!(out, "number")?;
    for parameter in sweeps() {
        write!(
            out,
            ",{}{}",
            parameter.key(),
            units::si_suffix(parameter.unit())
        )?;
    }
    // A varied quantity may be a figure as well, and then has its column already.
    let figures: Vec<_> = DesignFigure::ALL
        .into_iter()
        .filter(|figure| sweeps().all(|parameter| parameter.key() != figure.name()))
        .collect();
    for figure in &figures {
        write!(out, ",{figure}{}", units::si_suffix(figure.unit()))?;
    }
    if design.lets_light_in() {
        write!(out, ",subsurface_height_m")?;
    }
    writeln!(
        out,
        ",line_noise_ratio,contrast_ratio,dominant,allowed,why_not"
    )?;
    for candidate in design.outcome.candidates() {
        write!(out, "{}", candidate.index)?;
        for parameter in sweeps() {
            write!(out, ",{:e}", parameter.value_in(&candidate.description))?;
        }
        write_figures(candidate, (&figures, design.lets_light_in()), out)?;
    }
    Ok(())
}

fn write_figures(
    candidate: &Candidate,
    (shown, lets_light_in): (&[DesignFigure], bool),
    out: &mut impl Write,
) -> io::Result<()> {
    match &candidate.figures {
        Ok(figures) => {
            for figure in shown {
                write!(out, ",{:e}", figure.value_in(figures))?;
            }
            if let Some(shift) = figures.subsurface {
                write!(out, ",{:e}", shift.height)?;
            }
            let effect = figures.bandwidth;
            write!(out, ",{:e},{:e}", effect.line_noise_ratio, effect.contrast)?;
            let broken = candidate
                .broken
                .iter()
                .map(|constraint| constraint.figure.name());
            let broken = broken.collect::<Vec<_>>().join(" ");
            let dominant = figures.dominant.name();
            writeln!(out, ",{dominant},{},{broken}", broken.is_empty())
        }
        Err(why) => {
            let why = why.to_string().replace('"', "\"\"");
            let empty = shown.len() + 2 + usize::from(lets_light_in);
            writeln!(out, "{},,false,\"{why}\"", ",".repeat(empty))
        }
    }
}
