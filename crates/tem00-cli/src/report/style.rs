//! The looks of a report.

/// Plain on paper, light or dark on a screen as the reader has it; drawings keep their white paper.
pub(super) const CSS: &str = "\
:root { color-scheme: light dark; --ink: #1c1c1c; --paper: #ffffff; --faint: #6a6a6a; --rule: #d0d0d0;
  --shade: #f3f5f8; --accent: #1f5fa8; }
@media (prefers-color-scheme: dark) { :root { --ink: #e4e4e4; --paper: #17191c; --faint: #a0a0a0;
  --rule: #3a3d42; --shade: #22262b; --accent: #7fb2ea; } }
body { margin: 0; background: var(--paper); color: var(--ink);
  font: 16px/1.5 system-ui, sans-serif; }
main { max-width: 60rem; margin: 0 auto; padding: 1.5rem; }
h1 { font-size: 1.6rem; line-height: 1.2; }
h2 { font-size: 1.2rem; margin-top: 2rem; border-bottom: 1px solid var(--rule); }
.verdict { padding: 0.75rem 1rem; background: var(--shade); border-left: 4px solid var(--accent); }
dl { display: grid; grid-template-columns: max-content auto; gap: 0.1rem 1.5rem; }
dt { color: var(--faint); }
dd { margin: 0; }
.scroll { overflow-x: auto; }
table { border-collapse: collapse; font-variant-numeric: tabular-nums; }
caption { text-align: left; color: var(--faint); padding-bottom: 0.3rem; }
th, td { padding: 0.25rem 0.75rem; text-align: left; border-bottom: 1px solid var(--rule); }
.number { text-align: right; }
tr.total td { font-weight: 600; border-top: 2px solid var(--ink); }
figure { margin: 1.5rem 0; }
figure svg, figure img { display: block; max-width: 100%; height: auto; background: #ffffff; }
figcaption { color: var(--faint); font-size: 0.9rem; margin-top: 0.3rem; }
pre { overflow-x: auto; padding: 0.75rem; background: var(--shade); font-size: 0.85rem; }
summary { cursor: pointer; color: var(--accent); }
footer { margin-top: 3rem; color: var(--faint); font-size: 0.85rem; }
@media print { :root { color-scheme: light; --ink: #000000; --paper: #ffffff; --shade: #f3f5f8; }
  main { max-width: none; padding: 0; } figure, tr { break-inside: avoid; } pre { white-space: pre-wrap; } }
";
