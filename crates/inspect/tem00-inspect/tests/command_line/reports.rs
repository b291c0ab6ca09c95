//! The reports: what a reader sees of them on a screen and on paper.

use std::{
    collections::{BTreeMap, BTreeSet},
    fs,
    path::Path,
};

use super::{assert_code, folder, run, triangulate::SCAN};

/// A scan of two plates with nothing between them.
fn scan_with_a_gap() -> tempfile::TempDir {
    let folder = folder();
    let plate = "\"20 mm\", \"20 mm\"";
    assert_eq!(SCAN.matches(plate).count(), 2, "two plates");
    let scene = SCAN.replace(plate, "\"19.7 mm\", \"20 mm\"");
    fs::write(folder.path().join("a.toml"), scene).expect("the scene is written");
    folder
}

fn read(path: &Path) -> String {
    fs::read_to_string(path).expect("the file is there")
}

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
    let stroke = format!("stroke=\"{colour}\"");
    let paths = svg.split("<path ").skip(1);
    let paths = paths.filter(|path| {
        path.split('>')
            .next()
            .is_some_and(|tag| tag.contains(&stroke))
    });
    let numbers = paths.map(|path| {
        let d = attribute(path, "d").expect("a path has a course");
        let numbers = d
            .split([' ', 'M', 'L'])
            .filter_map(|word| word.parse().ok());
        let numbers: Vec<f64> = numbers.collect();
        numbers
            .chunks_exact(2)
            .map(|pair| [pair[0], pair[1]])
            .collect()
    });
    numbers.collect()
}

/// Returns the colours that legends give to words: after each text without a mark of its own comes that
/// mark.
fn legend(svg: &str, meanings: &mut BTreeMap<String, BTreeSet<String>>) {
    let texts = svg.split("<text ").skip(1);
    for text in texts {
        let Some((label, rest)) = text.split_once("</text>") else {
            continue;
        };
        let Some((_, label)) = label.split_once('>') else {
            continue;
        };
        let mark = ["<circle", "<line", "<rect", "<path"];
        let kind = mark.iter().find(|kind| rest.starts_with(**kind));
        let colour = kind.and_then(|_| {
            let stroke = attribute(rest, "stroke").filter(|colour| *colour != "none");
            stroke.or_else(|| attribute(rest, "fill"))
        });
        // Black and grey are the colours of axes and grids.
        if let Some(colour) = colour.filter(|c| !matches!(*c, "#000000" | "#cccccc" | "none")) {
            let colours = meanings.entry(colour.to_owned()).or_default();
            colours.insert(label.to_owned());
        }
    }
}

/// What holds of every report.
fn check(html: &str) {
    for svg in elements(html, "svg") {
        let numbers = attribute(svg, "viewBox").expect("a drawing has a viewBox");
        let numbers = numbers.split(' ').map(str::parse::<f64>);
        assert_eq!(
            numbers.filter(Result::is_ok).count(),
            4,
            "{numbers:?}",
            numbers = attribute(svg, "viewBox")
        );
        let bottom = attribute(svg, "height").and_then(|height| height.parse().ok());
        let bottom: f64 = bottom.expect("a height");
        for text in svg.split("<text x=").skip(1) {
            let y = attribute(text, " y").and_then(|y| y.parse::<f64>().ok());
            assert!(y.is_some_and(|y| y < bottom - 3.0), "{text}");
        }
        let label = attribute(svg, "aria-label").unwrap_or_default();
        assert!(label.len() > 20, "{label} tells what is drawn");
        assert!(!svg.contains("NaN") && !svg.contains("inf\""), "{svg}");
    }
    let mut meanings = BTreeMap::new();
    for svg in elements(html, "svg") {
        legend(svg, &mut meanings);
    }
    for (colour, meaning) in &meanings {
        assert_eq!(meaning.len(), 1, "{colour} means {meaning:?}");
    }
    let labels = meanings.values().flatten();
    let mut seen = BTreeSet::new();
    for label in labels {
        assert!(seen.insert(label), "{label} has two colours: {meanings:?}");
    }
    let (_, print) = html.split_once("@media print {").expect("rules for paper");
    let (print, _) = print.split_once("</style>").expect("they end");
    assert!(print.contains(".scroll { overflow: visible; }"), "{print}");
    assert!(html.contains("(prefers-color-scheme: dark)"), "a dark page");
    assert!(html.contains("default-src 'none'"), "nothing is loaded");
    let outside = html.lines().filter(|line| !line.contains(";base64,"));
    let outside = outside.map(|line| line.replace("http://www.w3.org/2000/svg", ""));
    assert!(
        outside.clone().all(|line| !line.contains("://")),
        "no address"
    );
}

/// Returns the headings in their order.
fn headings(html: &str) -> Vec<&str> {
    let headings = html.split("<h2>").skip(1);
    headings
        .filter_map(|rest| Some(rest.split_once("</h2>")?.0))
        .collect()
}

#[test]
fn a_measurement_is_reported_with_its_result_first() {
    let folder = scan_with_a_gap();
    assert_code(&run(folder.path(), "triangulate a.toml"), 0);
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
    let svg = read(&out.join("uncertainty.svg"));
    let found = curves(&svg, "#2f6fb8");
    assert!(found.len() >= 2, "{} curves", found.len());
    let width = 5.0 / 48.0 * 480.0;
    for pair in found.iter().flat_map(|curve| curve.windows(2)) {
        assert!(pair[1][0] - pair[0][0] < width, "{pair:?}");
    }

    // A frame of 48 columns is shown at a size at which one sees the line.
    let frame = elements(&html, "img")[0];
    let shown: u32 = attribute(frame, "width")
        .and_then(|w| w.parse().ok())
        .expect("a width");
    assert!(shown >= 480 && shown.is_multiple_of(48), "{shown}");
    assert!(html.contains("image-rendering: pixelated"));
    assert_eq!(attribute(frame, "class"), Some("enlarged"));

    // The points in space are all valid points.
    let valid = (0..4).map(|frame| {
        let table = read(&out.join(format!("profile_{frame:04}.csv")));
        table.matches(",valid,").count()
    });
    let valid: usize = valid.sum();
    let cloud = elements(&html, "svg");
    let cloud = cloud
        .iter()
        .find(|svg| attribute(svg, "class") == Some("cloud"));
    let cloud = cloud.expect("points in space");
    assert_eq!(cloud.matches("h0").count(), valid);
    assert!(html.contains(&format!("The {valid} valid points")));
    assert_eq!(html.matches("<script>").count(), 1, "what turns them");
}

#[test]
fn a_budget_is_reported_with_its_result_first() {
    let folder = folder();
    fs::write(folder.path().join("a.toml"), super::budget::SETUP).expect("the set-up is written");
    assert_code(&run(folder.path(), "budget a.toml --trials 10"), 0);
    let html = read(&folder.path().join("out/a/budget.html"));
    check(&html);
    let expected = ["The budget", "The set-up", "The inputs", "Files"];
    assert_eq!(headings(&html), expected);
    assert!(!html.contains("<script"), "there is nothing to turn");
}

#[test]
fn a_search_is_reported_in_the_same_bytes_and_colours() {
    let folder = folder();
    let text = format!(
        "{}\n[design.require]\nsaturation = 0.9\n",
        super::design::SETUP
    );
    fs::write(folder.path().join("a.toml"), text).expect("the set-up is written");
    let [one, two] = ["one", "two"].map(|out| {
        assert_code(&run(folder.path(), &format!("design a.toml -o {out}")), 0);
        read(&folder.path().join(out).join("design.html"))
    });
    check(&one);
    assert!(one == two, "no time of day, no elapsed time");
    assert_eq!(headings(&one)[0], "The best set-ups");
    // Speckle is in both diagrams over a parameter.
    assert!(one.matches(">speckle</text>").count() >= 2);
}
