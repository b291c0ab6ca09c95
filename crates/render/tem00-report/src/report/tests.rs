use super::*;
use crate::plot::Chart;

fn report() -> Report {
    let mut report = Report::new("A <set-up> & its \"budget\"");
    report.data("seed", 3);
    report.verdict("speckle");
    report.warning("dark");
    report
        .section("What dominates")
        .paragraph("</main><script>alert(1)</script>")
        .fact(
            "wavelength",
            "wavelength",
            units::NANOMETRES.quantity(660e-9),
        )
        .fact("width", "<b>", Cell::missing("not measured: no line"));
    let columns = [
        Column::new("term", "term"),
        Column::new("contribution", "u (µm)"),
        Column::data("unit"),
        Column::shown("x < y"),
    ];
    let mut table = Table::new("<i>", columns).under("terms");
    let u = units::MICROMETRES;
    table.row([
        "speckle".into(),
        u.cell(3.2e-6),
        "px".into(),
        "a & b".into(),
    ]);
    table.row(["bias".into(), Cell::or_dash(None::<f64>), "m".into()]);
    table.total(["combined".into(), u.cell(3.3e-6)]);
    report.section("Budget").under("budget").table(table);
    let details = report.section("Details").in_detail();
    for name in ["one", "two"] {
        let chart = Chart::new(name, ["x", "y"]).line("", [(0.0, 1.0), (1.0, 0.0)]);
        details.drawing(chart.draw().svg(), "a \"caption\"");
    }
    details.picture(b"\x89PNG\r\n\x1a\n".to_vec(), 209, "a \"picture\"");
    details.cloud(Cloud {
        labels: ["x", "y", "z"],
        to_scale: true,
        points: vec![[0.0; 3], [1.0; 3]],
    });
    details.file("setup.toml", "wavelength = \"660 nm\" # a < b\n");
    details.fact("cells", "cells", 7_usize);
    report
}

#[test]
fn a_terminal_ends_with_the_verdict() {
    let mut out = Vec::new();
    report()
        .print(false, &["b.html".into()], &mut out)
        .expect("memory can be written");
    let expected = "\
term      u (µm)  x < y
speckle   3.2     a & b
bias      -
combined  3.3

wavelength: 660 nm
<b>: not measured: no line

speckle

b.html
";
    assert_eq!(String::from_utf8_lossy(&out), expected);
}

#[test]
fn programs_get_si_units_under_keys() {
    let found: Value = serde_json::from_str(&report().json()).expect("JSON");
    let expected = serde_json::json!({
        "program": concat!("tem00 ", env!("CARGO_PKG_VERSION")),
        "seed": 3,
        "wavelength": 660e-9,
        "width": null,
        "budget": {
            "terms": [
                {"term": "speckle", "contribution": 3.2e-6, "unit": "px"},
                {"term": "bias", "contribution": null, "unit": "m"},
            ],
        },
        "cells": 7,
        "verdicts": ["speckle"],
        "warnings": ["dark"],
        "notes": [],
    });
    assert_eq!(found, expected);
}

#[test]
fn columns_of_numbers_stand_to_the_right() {
    let html = report().html();
    for part in [
        "<th scope=\"col\">term</th>",
        "<th scope=\"col\" class=\"number\">u (µm)</th>",
        "<td class=\"number\">3.2</td>",
        "<tr class=\"total\">",
        "<td>a &amp; b</td>",
        "<caption>&lt;i&gt;</caption>",
    ] {
        assert!(html.contains(part), "{part} is in {html}");
    }
    assert_eq!(html.matches("<td class=\"number\">").count(), 3, "{html}");
}

/// Returns the page without its script, which is no HTML, and the script.
fn split(html: &str) -> (String, String) {
    let (before, rest) = html.split_once("<script>").expect("a script");
    let (script, after) = rest.split_once("</script>").expect("it ends");
    (format!("{before}{after}"), script.to_owned())
}

/// Checks that each tag is closed in turn, and returns the names of those met.
fn tags(html: &str) -> Vec<String> {
    const VOID: [&str; 4] = ["meta", "img", "!DOCTYPE", "!--"];
    let (mut open, mut met) = (Vec::new(), Vec::new());
    for piece in html.split('<').skip(1) {
        let (tag, _) = piece.split_once('>').expect("a tag ends");
        let name = tag
            .trim_end_matches('/')
            .split_whitespace()
            .next()
            .unwrap_or_default();
        if let Some(closed) = name.strip_prefix('/') {
            assert_eq!(
                open.pop().as_deref(),
                Some(closed),
                "</{closed}> closes the last tag"
            );
        } else {
            met.push(name.to_owned());
            if !VOID.contains(&name) && !tag.ends_with('/') {
                open.push(name.to_owned());
            }
        }
    }
    assert!(open.is_empty(), "{open:?} are closed");
    met
}

#[test]
fn a_report_is_well_formed() {
    let met = tags(&split(&report().html()).0);
    for name in ["h1", "h2", "dl", "table", "svg", "figure", "img", "pre"] {
        assert!(met.iter().any(|tag| tag == name), "there is a {name}");
    }
    assert!(!met.iter().any(|tag| tag == "script"), "text is no script");
    // Two drawings stand side by side, and the cloud alone.
    let (html, _) = split(&report().html());
    let (_, side_by_side) = html.split_once("<div class=\"drawings\">").expect("a row");
    let (side_by_side, _) = side_by_side.split_once("</div>").expect("its end");
    assert_eq!(side_by_side.matches("<figure>").count(), 2);
}

#[test]
fn a_report_refers_to_nothing_outside() {
    let (html, script) = split(&report().html());
    for outside in "http fetch import XMLHttp src //www Date random".split(' ') {
        assert!(!script.contains(outside), "{outside} is in the script");
    }
    // The name of the language of drawings is no address to load anything from, and Base64 may hold
    // two slashes in a row.
    let html = html.replace("xmlns=\"http://www.w3.org/2000/svg\"", "");
    for line in html.lines().filter(|line| !line.contains(";base64,")) {
        for outside in "http: https: // <link <script @import <iframe".split(' ') {
            assert!(!line.contains(outside), "{outside} is there: {line}");
        }
    }
    let sources: Vec<_> = html.split("src=\"").skip(1).collect();
    let is_inside = sources.len() == 1 && sources[0].starts_with("data:");
    assert!(is_inside, "pictures are inside");
}

#[test]
fn drawings_do_not_share_names() {
    let html = report().html();
    let ids = html.split(" id=\"").skip(1);
    let ids: Vec<_> = ids.map(|rest| rest.split('"').next()).collect();
    for (index, id) in ids.iter().enumerate() {
        assert!(!ids[..index].contains(id), "{ids:?}");
    }
    assert!(!ids.is_empty(), "names");
}
