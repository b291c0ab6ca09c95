//! The looks of a report.

use core::fmt::Write as _;

use crate::plot::colours;

/// Plain on paper, light or dark on a screen as the reader has it.
pub(super) const CSS: &str = "\
@page { size: A4; margin: 15mm; }
:root { color-scheme: light dark; --ink: #1c1c1c; --paper: #ffffff; --faint: #5f5f5f; --rule: #d0d0d0;
  --shade: #f3f5f8; --accent: #1f5fa8; }
* { box-sizing: border-box; }
body { margin: 0; background: var(--paper); color: var(--ink);
  font: 16px/1.5 system-ui, sans-serif; overflow-wrap: break-word; }
main { max-width: 66rem; margin: 0 auto; padding: 1.5rem; }
h1 { font-size: 1.6rem; line-height: 1.2; }
h2 { font-size: 1.2rem; margin-top: 2rem; border-bottom: 1px solid var(--rule); break-after: avoid; }
p { max-width: 48rem; }
.verdict { padding: 0.75rem 1rem; background: var(--shade); border-left: 4px solid var(--accent); }
dl { display: grid; grid-template-columns: minmax(7rem, max-content) 1fr; gap: 0.1rem 1.5rem; }
dt { color: var(--faint); }
dd { margin: 0; }
dt, dd { min-width: 0; overflow-wrap: anywhere; }
.scroll { overflow-x: auto; }
table { border-collapse: collapse; font-size: 0.9rem; font-variant-numeric: tabular-nums; }
caption { text-align: left; color: var(--faint); padding-bottom: 0.3rem; }
th, td { padding: 0.25rem 0.6rem; text-align: left; vertical-align: bottom; overflow-wrap: normal;
  border-bottom: 1px solid var(--rule); }
.number { text-align: right; }
td.number { white-space: nowrap; }
tr.total td { font-weight: 600; border-top: 2px solid var(--ink); }
.drawings { display: grid; gap: 0 2rem;
  grid-template-columns: repeat(auto-fit, minmax(min(100%, 25rem), 1fr)); }
figure { margin: 1.5rem 0; break-inside: avoid; }
figure svg { display: block; width: 100%; max-width: 40rem; height: auto; fill: currentColor;
  font-family: inherit; }
figure svg > rect:first-of-type { fill: none; }
figure img { display: block; max-width: 100%; height: auto; }
figure img.enlarged { image-rendering: pixelated; }
.drawings figure svg { max-width: 34rem; }
figcaption { color: var(--faint); font-size: 0.9rem; margin-top: 0.3rem; max-width: 48rem; }
.cloud .dots { stroke-width: 2.6; stroke-linecap: round; fill: none; }
.cloud .edges { stroke-width: 0.6; stroke-opacity: 0.5; fill: none; }
.cloud .label { font-size: 12px; text-anchor: middle; }
.cloud.turns { cursor: grab; touch-action: none; user-select: none; }
.cloud.turns:active { cursor: grabbing; }
.buttons { display: flex; flex-wrap: wrap; gap: 0.4rem; margin-top: 0.5rem; }
button { font: inherit; font-size: 0.9rem; padding: 0.4rem 0.7rem; color: inherit; background: var(--shade);
  border: 1px solid var(--rule); border-radius: 4px; cursor: pointer; }
.help { margin: 0.3rem 0; color: var(--faint); font-size: 0.9rem; }
pre { overflow-x: auto; padding: 0.75rem; background: var(--shade); font-size: 0.85rem; }
summary { cursor: pointer; color: var(--accent); }
footer { margin-top: 3rem; color: var(--faint); font-size: 0.85rem; }
@media (max-width: 40rem) { main { padding: 1rem; } dl { grid-template-columns: 1fr; }
  dd { margin-bottom: 0.4rem; } th, td { padding: 0.25rem 0.4rem; font-size: 0.9rem; }
  th:first-child, td:first-child { position: sticky; left: 0; background: var(--paper); } }
@media print { :root { font-size: 12.5px; } body { font-size: 1rem; print-color-adjust: exact; }
  main { max-width: none; padding: 0; } h2 { margin-top: 1.2rem; } figure { margin: 0.8rem 0; }
  .scroll { overflow: visible; } table { width: 100%; } th, td { padding: 0.15rem 0.3rem; font-size: 0.82rem; }
  thead { display: table-header-group; } tr, dt, dd { break-inside: avoid; }
  .drawings { grid-template-columns: 1fr 1fr; } svg.cloud { max-width: 32rem; }
  .buttons, .help { display: none; } pre { white-space: pre-wrap; } }
";

/// Returns what differs on a dark screen: the page, and every colour of a drawing.
pub(super) fn dark() -> String {
    let mut css = String::from(
        "@media screen and (prefers-color-scheme: dark) { :root { --ink: #e4e4e4; --paper: #17191c; \
         --faint: #a8a8a8; --rule: #3a3d42; --shade: #22262b; --accent: #7fb2ea; }\n",
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
        // Memory takes whatever it is given.
        let _ = writeln!(
            css,
            "svg [fill=\"{light}\"] {{ fill: {dark}; }} svg [stroke=\"{light}\"] {{ stroke: {dark}; }}"
        );
    }
    // Dark heights want brighter paper, and bright ones darker.
    css.push_str(".cloud { background: #9aa0a8; color: #101010; } }\n");
    css
}
