use super::*;
use crate::plot::Chart;

fn report() -> Report {
    let mut report = Report::new("A <set-up> & its \"budget\"");
    report.heading("What dominates");
    report.verdict("speckle");
    report.paragraph("</main><script>alert(1)</script>");
    report.facts(&[("wavelength", "660 nm".into()), ("<b>", "&".into())]);
    let mut table = Table::new("terms", &["term", "u (µm)"]);
    table.row(vec!["speckle".into(), "3.2".into()]);
    report.table(&table);
    let charts =
        ["one", "two"].map(|name| Chart::new(name, ["x", "y"]).line("", [(0.0, 1.0), (1.0, 0.0)]));
    let drawings = charts.map(Chart::draw);
    report.drawings(
        drawings
            .iter()
            .map(|drawing| (drawing.svg(), "a \"caption\"")),
    );
    report.picture(b"\x89PNG\r\n\x1a\n", 209, "a \"picture\"");
    report.cloud(Cloud {
        labels: ["x", "y", "z"],
        to_scale: true,
        points: vec![[0.0; 3], [1.0; 3]],
    });
    report.file("setup.toml", "wavelength = \"660 nm\" # a < b\n");
    report
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
}

#[test]
fn a_report_refers_to_nothing_outside() {
    let (html, script) = split(&report().html());
    for outside in [
        "http", "fetch", "import", "XMLHttp", "src", "//www", "Date", "random",
    ] {
        assert!(!script.contains(outside), "{outside} is not in the script");
    }
    // The name of the language of drawings is no address to load anything from.
    let html = html.replace("xmlns=\"http://www.w3.org/2000/svg\"", "");
    for outside in [
        "http:", "https:", "//", "<link", "<script", "@import", "<iframe",
    ] {
        // Base64 may hold two slashes in a row.
        let found = html.lines().filter(|line| !line.contains(";base64,"));
        assert!(
            !found.clone().any(|line| line.contains(outside)),
            "{outside} is not there"
        );
    }
    let sources = html.split("src=\"").skip(1);
    assert!(
        sources.clone().count() == 1 && sources.clone().all(|source| source.starts_with("data:")),
        "pictures are inside"
    );
}

#[test]
fn drawings_do_not_share_names() {
    let html = report().html();
    let mut ids: Vec<&str> = html
        .split(" id=\"")
        .skip(1)
        .filter_map(|rest| rest.split('"').next())
        .collect();
    let count = ids.len();
    ids.sort_unstable();
    ids.dedup();
    assert_eq!(ids.len(), count, "{ids:?}");
}

#[test]
fn a_report_is_a_file() {
    let folder = tempfile::tempdir().expect("a temporary folder");
    let path = folder.path().join("report.html");
    let report = report();
    report.save(&path).expect("the folder can be written");
    let read = std::fs::read_to_string(&path).expect("the file is there");
    assert_eq!(read, report.html());
}
