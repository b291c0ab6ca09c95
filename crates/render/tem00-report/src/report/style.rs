//! The looks of a report.

use core::fmt::Write as _;

use crate::plot::colours;

/// Plain on paper, light or dark on a screen as the reader has it.
pub(super) const CSS: &str = include_str!("page.css");

/// Returns the styles that differ on a dark screen: the page, and every colour of a drawing.
pub(super) fn dark() -> String {
    let mut css = String::from(
        "@media screen and (prefers-color-scheme: dark) { :root { --ink: #e4e4e4; \
         --paper: #17191c; --faint: #a8a8a8; --rule: #3a3d42; --shade: #22262b; \
         --accent: #7fb2ea; }\n",
    );
    let frame = [
        ("#000000", "#c8c8c8"),
        ("#cccccc", "#3a3d42"),
        ("#ffffff", "#17191c"),
    ];
    let colours = colours::ALL
        .iter()
        .map(|colour| (colour.light, colour.dark));
    for (light, dark) in frame.into_iter().chain(colours) {
        // Writing to memory never fails.
        let _ = writeln!(
            css,
            "svg [fill=\"{light}\"] {{ fill: {dark}; }} \
             svg [stroke=\"{light}\"] {{ stroke: {dark}; }}"
        );
    }
    // Dark heights need brighter paper, and bright heights darker paper.
    css.push_str(".cloud { background: #9aa0a8; color: #101010; } }\n");
    css
}
