//! The reports: what a reader sees of them on a screen and on paper.

use std::collections::{BTreeMap, BTreeSet};

use super::*;

/// Returns the contents of all elements of a name.
fn elements<'a>(html: &'a str, name: &str) -> Vec<&'a str> {
    let (start, end) = (format!("<{name} "), format!("</{name}>"));
    let pieces = html.split(&*start).skip(1);
    pieces
        .map(|piece| piece.split(&*end).next().unwrap_or(piece))
        .collect()
}

fn attribute<'a>(element: &'a str, name: &str) -> Option<&'a str> {
    let tag = element.split('>').next()?;
    let (_, rest) = tag.split_once(&format!("{name}=\""))?;
    Some(rest.split_once('"')?.0)
}

/// Returns the points of each curve of a colour in a drawing.
fn curves(svg: &str, colour: &str) -> Vec<Vec<[f64; 2]>> {
    let paths = svg.split("<path ").skip(1);
    let paths = paths.filter(|path| attribute(path, "stroke") == Some(colour));
    let points = paths.map(|path| {
        let course = attribute(path, "d").unwrap_or_default();
        let words = course.split([' ', 'M', 'L']);
        let numbers: Vec<f64> = words.filter_map(|word| word.parse().ok()).collect();
        numbers
            .chunks_exact(2)
            .map(|pair| [pair[0], pair[1]])
            .collect()
    });
    points.collect()
}

/// Adds the words that legends give to colours: after each text without a mark of its own comes
/// that mark.
fn legend(svg: &str, meanings: &mut BTreeMap<String, BTreeSet<String>>) {
    for text in svg.split("<text ").skip(1) {
        let Some((label, rest)) = text.split_once("</text>") else {
            continue;
        };
        let marks = ["<circle", "<line", "<rect", "<path"];
        let is_mark = marks.iter().any(|mark| rest.starts_with(mark));
        let stroke = attribute(rest, "stroke").filter(|colour| *colour != "none");
        let colour = stroke.or_else(|| attribute(rest, "fill"));
        // Black and grey are the colours of axes and grids.
        let is_axis = |colour: &&str| matches!(*colour, "#000000" | "#cccccc" | "none");
        if let (true, Some(colour)) = (is_mark, colour.filter(|colour| !is_axis(colour))) {
            let label = label.split_once('>').map_or("", |(_, label)| label);
            let labels = meanings.entry(colour.to_owned()).or_default();
            labels.insert(label.to_owned());
        }
    }
}

/// Checks what holds of every report.
pub(super) fn check(html: &str) {
    let mut meanings = BTreeMap::new();
    for svg in elements(html, "svg") {
        let view_box = attribute(svg, "viewBox").expect("a drawing has a viewBox");
        let numbers = view_box.split(' ').map(str::parse::<f64>);
        assert_eq!(numbers.filter(Result::is_ok).count(), 4, "{view_box}");
        let place = |text, name| attribute(text, name).and_then(|place| place.parse::<f64>().ok());
        let bottom = place(svg, "height").expect("a height");
        for text in svg.split("<text x=").skip(1) {
            assert!(
                place(text, " y").is_some_and(|y| y < bottom - 3.0),
                "{text}"
            );
        }
        let label = attribute(svg, "aria-label").unwrap_or_default();
        assert!(label.len() > 20, "{label} tells what is drawn");
        assert!(!svg.contains("NaN") && !svg.contains("inf\""), "{svg}");
        legend(svg, &mut meanings);
    }
    let mut seen = BTreeSet::new();
    for (colour, meaning) in &meanings {
        assert_eq!(meaning.len(), 1, "{colour} means {meaning:?}");
        let label = meaning.first();
        assert!(
            seen.insert(label),
            "{label:?} has two colours: {meanings:?}"
        );
    }
    let (_, print) = html.split_once("@media print {").expect("rules for paper");
    let (print, _) = print.split_once("</style>").expect("they end");
    assert_has(print, &[".scroll { overflow: visible; }"]);
    assert_has(
        html,
        &["(prefers-color-scheme: dark)", "default-src 'none'"],
    );
    for line in html.lines().filter(|line| !line.contains(";base64,")) {
        let line = line.replace("http://www.w3.org/2000/svg", "");
        assert!(!line.contains("://"), "no address: {line}");
    }
}

/// Returns the headings in their order.
pub(super) fn headings(html: &str) -> Vec<&str> {
    let headings = html.split("<h2>").skip(1);
    headings
        .filter_map(|rest| Some(rest.split_once("</h2>")?.0))
        .collect()
}

#[test]
fn a_measurement_is_reported_with_its_result_first() {
    // Two plates with nothing between them.
    let folder = written(&replaced(
        SCAN,
        "\"20 mm\", \"20 mm\"",
        "\"19.7 mm\", \"20 mm\"",
    ));
    said(folder.path(), "triangulate a.toml", 0);
    let out = folder.path().join("out/a");
    let html = read(&out.join("report.html"));
    check(&html);
    let expected = [
        "Height map",
        "Profile",
        "Uncertainty of a height",
        "Frames",
        "Settings",
    ];
    assert_eq!(headings(&html), expected);

    // No line goes over the 0.3 mm without a surface, eight or so of the 48 columns of the frame.
    let found = curves(&read(&out.join("uncertainty.svg")), "#2f6fb8");
    assert!(found.len() >= 2, "{} curves", found.len());
    let width = 5.0 / 48.0 * 480.0;
    for pair in found.iter().flat_map(|curve| curve.windows(2)) {
        assert!(pair[1][0] - pair[0][0] < width, "{pair:?}");
    }

    // A frame of 48 columns is shown at a size at which one sees the line.
    let frame = elements(&html, "img")[0];
    let shown = attribute(frame, "width").and_then(|width| width.parse().ok());
    let shown: u32 = shown.expect("a width");
    assert!(shown >= 480 && shown.is_multiple_of(48), "{shown}");
    assert_has(&html, &["image-rendering: pixelated"]);
    assert_eq!(attribute(frame, "class"), Some("enlarged"));

    // The points in space are all valid points.
    let profile = |frame: u32| read(&out.join(format!("profile_{frame:04}.csv")));
    let valid: usize = (0..4)
        .map(|frame| profile(frame).matches(",valid,").count())
        .sum();
    let svgs = elements(&html, "svg").into_iter();
    let mut clouds = svgs.filter(|svg| attribute(svg, "class") == Some("cloud"));
    let cloud = clouds.next().expect("points in space");
    assert_eq!(cloud.matches("h0").count(), valid);
    assert_has(&html, &[&format!("The {valid} valid points")]);
    assert_eq!(html.matches("<script>").count(), 1, "what turns them");
}
