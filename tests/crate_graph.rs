//! The arrows between the crates point down, the physics crates stay light, their packages stand alone, and all have
//! one version.

#![expect(
    clippy::expect_used,
    reason = "a test stops at what it does not expect"
)]

use std::{
    collections::BTreeSet,
    fs,
    path::{Path, PathBuf},
};

use toml::de::{DeTable, DeValue};

/// Allowed dependencies of each crate: crates of this workspace, then crates from outside.
const ALLOWED: &[(&str, &[&str], &[&str])] = &[
    (
        "tem00-numerics",
        &[],
        &["fearless_simd", "libm", "num-complex", "rayon", "rustfft"],
    ),
    (
        "tem00-statistics",
        &["tem00-numerics"],
        &["libm", "num-complex", "statrs"],
    ),
    (
        "tem00-beam",
        &["tem00-numerics"],
        &["glam", "libm", "num-complex"],
    ),
    (
        "tem00-speckle",
        &["tem00-numerics"],
        &["num-complex", "rand_chacha", "rand_core", "rayon"],
    ),
    (
        "tem00-coherence",
        &["tem00-numerics"],
        &["glam", "libm", "num-complex"],
    ),
    ("tem00-decorrelation", &["tem00-numerics"], &["glam"]),
    (
        "tem00-camera",
        &["tem00-decorrelation", "tem00-numerics"],
        &["glam", "libm", "serde"],
    ),
    (
        "tem00-shading",
        &[
            "tem00-beam",
            "tem00-camera",
            "tem00-coherence",
            "tem00-decorrelation",
            "tem00-numerics",
            "tem00-speckle",
        ],
        &["glam", "libm"],
    ),
    (
        "tem00-config",
        &["tem00-coherence", "tem00-numerics"],
        &["glam", "libm", "strsim", "toml", "toml_edit"],
    ),
    (
        "tem00-wave",
        &["tem00-numerics"],
        &["glam", "num-complex", "rand_chacha", "rand_core"],
    ),
    (
        "tem00-paper",
        &[
            "tem00-beam",
            "tem00-decorrelation",
            "tem00-numerics",
            "tem00-speckle",
        ],
        &["glam"],
    ),
    (
        "tem00-tracer",
        &[
            "tem00-beam",
            "tem00-camera",
            "tem00-coherence",
            "tem00-decorrelation",
            "tem00-numerics",
            "tem00-paper",
            "tem00-shading",
            "tem00-speckle",
        ],
        &[
            "fearless_simd",
            "glam",
            "libm",
            "obvhs",
            "rand_chacha",
            "rand_core",
            "rayon",
        ],
    ),
    (
        "tem00-scene",
        &[
            "tem00-beam",
            "tem00-camera",
            "tem00-config",
            "tem00-decorrelation",
            "tem00-numerics",
            "tem00-tracer",
        ],
        &[
            "base64",
            "earcut",
            "exr",
            "glam",
            "gltf",
            "ply-rs-bw",
            "toml",
        ],
    ),
    ("tem00-topography", &["tem00-numerics"], &["glam", "libm"]),
    (
        "tem00-uncertainty",
        &["tem00-numerics"],
        &[
            "libm",
            "rand_chacha",
            "rand_core",
            "rand_distr",
            "rayon",
            "statrs",
        ],
    ),
    (
        "tem00-triangulation",
        &[
            "tem00-beam",
            "tem00-camera",
            "tem00-coherence",
            "tem00-config",
            "tem00-decorrelation",
            "tem00-numerics",
            "tem00-speckle",
            "tem00-statistics",
            "tem00-uncertainty",
        ],
        &[
            "glam",
            "libm",
            "nalgebra",
            "rand_chacha",
            "rand_core",
            "rand_distr",
            "rayon",
            "serde",
        ],
    ),
    (
        "tem00-scan",
        &[
            "tem00-camera",
            "tem00-config",
            "tem00-decorrelation",
            "tem00-numerics",
            "tem00-scene",
            "tem00-speckle",
            "tem00-statistics",
            "tem00-topography",
            "tem00-tracer",
            "tem00-triangulation",
        ],
        &["glam", "rayon"],
    ),
    (
        "tem00-cli",
        &[
            "tem00-camera",
            "tem00-config",
            "tem00-decorrelation",
            "tem00-numerics",
            "tem00-speckle",
            "tem00-statistics",
            "tem00-scan",
            "tem00-scene",
            "tem00-topography",
            "tem00-tracer",
            "tem00-triangulation",
            "tem00-uncertainty",
        ],
        &[
            "annotate-snippets",
            "base64",
            "clap",
            "clap_complete",
            "clap_mangen",
            "ctrlc",
            "exr",
            "flate2",
            "glam",
            "indicatif",
            "kuva",
            "md5",
            "num-complex",
            "png",
            "rawzip",
            "rayon",
            "serde",
            "serde_json",
            "tempfile",
            "thiserror",
            "tiff",
            "zune-core",
            "zune-jpeg",
        ],
    ),
    (
        "tem00-capi",
        &[
            "tem00-beam",
            "tem00-coherence",
            "tem00-decorrelation",
            "tem00-shading",
            "tem00-speckle",
        ],
        &["rayon"],
    ),
    (
        "tem00-python",
        &[
            "tem00-beam",
            "tem00-cli",
            "tem00-coherence",
            "tem00-decorrelation",
            "tem00-numerics",
            "tem00-shading",
            "tem00-speckle",
            "tem00-statistics",
        ],
        &["numpy", "pyo3"],
    ),
    (
        "tem00-gpu",
        &[
            "tem00-beam",
            "tem00-decorrelation",
            "tem00-numerics",
            "tem00-shading",
            "tem00-speckle",
        ],
        &["bytemuck", "num-complex", "pollster", "wgpu"],
    ),
];

/// Crates of the workspace that judge the others, and so may appear in the tests of any of them.
const JUDGES: &[&str] = &["tem00-statistics", "tem00-numerics", "tem00-testkit", "tem00-wave"];

/// Physics crates, which a renderer links: what they need beyond plain arithmetic is a choice.
const PHYSICS: &[&str] = &[
    "tem00-numerics",
    "tem00-beam",
    "tem00-speckle",
    "tem00-decorrelation",
    "tem00-coherence",
    "tem00-shading",
    "tem00-wave",
    "tem00-topography",
    "tem00-uncertainty",
];

/// The folder of a crate: bindings are named after what they serve.
fn folder(name: &str) -> PathBuf {
    let root = Path::new(env!("CARGO_MANIFEST_DIR"));
    match name {
        "tem00-capi" => root.join("bindings/c"),
        "tem00-python" => root.join("bindings/python"),
        "tem00-gpu" => root.join("bindings/gpu"),
        _ => root.join("crates").join(name),
    }
}

fn manifest(name: &str) -> String {
    let path = folder(name).join("Cargo.toml");
    fs::read_to_string(&path).unwrap_or_else(|error| panic!("{}: {error}", path.display()))
}

fn keys(manifest: &str, section: &str) -> BTreeSet<String> {
    let document = DeTable::parse(manifest).expect("a manifest is valid TOML");
    match document.get_ref().get(section).map(|value| value.get_ref()) {
        Some(DeValue::Table(table)) => table.keys().map(|key| key.get_ref().to_string()).collect(),
        _ => BTreeSet::new(),
    }
}

#[test]
fn every_crate_of_the_workspace_has_its_place_in_the_graph() {
    let root = Path::new(env!("CARGO_MANIFEST_DIR"));
    let found: BTreeSet<_> = ["bindings", "crates"]
        .into_iter()
        .flat_map(|parent| fs::read_dir(root.join(parent)).expect("the workspace has crates"))
        .map(|entry| entry.expect("a readable folder").path())
        .collect();
    let placed = ALLOWED.iter().map(|(name, ..)| folder(name)).collect();
    assert_eq!(found, placed, "crates in the workspace and in the graph");
}

#[test]
fn dependencies_point_down() {
    for (name, inside, outside) in ALLOWED {
        for dependency in keys(&manifest(name), "dependencies") {
            let allowed = if dependency.starts_with("tem00") {
                inside
            } else {
                outside
            };
            assert!(
                allowed.contains(&dependency.as_str()),
                "{name} must not depend on {dependency}"
            );
        }
    }
}

#[test]
fn tests_borrow_only_from_the_judges() {
    for (name, inside, _) in ALLOWED {
        for dependency in keys(&manifest(name), "dev-dependencies") {
            assert!(
                !dependency.starts_with("tem00")
                    || JUDGES.contains(&dependency.as_str())
                    || inside.contains(&dependency.as_str()),
                "the tests of {name} must not depend on {dependency}"
            );
        }
    }
}

#[test]
fn physics_crates_bring_no_threads_unless_asked() {
    for name in PHYSICS {
        let features = keys(&manifest(name), "features");
        assert!(
            !features.contains("default"),
            "{name} must have no default features"
        );
    }
}

/// Shows every file that is `path` or lies below it.
fn visit(path: &Path, show: &mut impl FnMut(&Path)) {
    if path.is_file() {
        show(path);
    } else if let Ok(entries) = fs::read_dir(path) {
        for entry in entries {
            visit(&entry.expect("an entry").path(), show);
        }
    }
}

/// Tests that read pages or scenes of the repository stand in `tests`, which no package holds.
#[test]
fn packages_read_nothing_beside_themselves() {
    let root = Path::new(env!("CARGO_MANIFEST_DIR"));
    let manifest = fs::read_to_string(root.join("Cargo.toml")).expect("a manifest");
    let included = manifest.split_once("\ninclude = [\"/");
    let (_, included) = included.expect("the manifest says what a package holds");
    let included = included.split("\"]").next().unwrap_or(included);
    let packages = ALLOWED.iter().map(|(name, ..)| folder(name));
    let mut sources = 0;
    for package in packages.chain([root.to_owned()]) {
        for path in included.split("\", \"/") {
            visit(&package.join(path), &mut |path| {
                if path.extension().is_none_or(|extension| extension != "rs") {
                    return;
                }
                let text = fs::read_to_string(path).expect("a source is text");
                for outside in ["CARGO_MANIFEST_DIR", "../../"] {
                    assert!(!text.contains(outside), "{}: {outside}", path.display());
                }
                sources += 1;
            });
        }
    }
    assert!(sources > 300, "{sources} sources");
}

#[test]
fn one_version_stands_everywhere() {
    let root = Path::new(env!("CARGO_MANIFEST_DIR"));
    let read = |name| fs::read_to_string(root.join(name)).expect("a readable file");
    let version = env!("CARGO_PKG_VERSION");
    let manifest = read("Cargo.toml");
    let named = manifest
        .lines()
        .filter(|line| line.contains("path = \"crates/"));
    let named: Vec<&str> = named.collect();
    // All but the bindings, which no crate depends on.
    assert_eq!(named.len(), ALLOWED.len() - 3, "crates with a version");
    for line in named {
        let wanted = format!("version = \"{version}\"");
        assert!(line.contains(&wanted), "{line}: not {version}");
    }
    let citation = read("CITATION.cff");
    let cited = citation
        .lines()
        .any(|line| line == format!("version: {version}"));
    assert!(cited, "CITATION.cff: not {version}");
}

/// Until there is an address of the repository nothing has been uploaded.
#[test]
fn nothing_is_offered_before_it_is_there() {
    let root = Path::new(env!("CARGO_MANIFEST_DIR"));
    let manifest = fs::read_to_string(root.join("Cargo.toml")).expect("a readable file");
    if !manifest.contains("repository = \"\"") {
        return;
    }
    let folders = ["crates", "bindings"].map(|name| fs::read_dir(root.join(name)));
    let entries = folders
        .into_iter()
        .flat_map(|folder| folder.expect("a folder"));
    let inside = entries.map(|entry| entry.expect("an entry").path());
    let places = inside
        .chain([root.to_path_buf()])
        .map(|path| path.join("README.md"));
    let pages: Vec<PathBuf> = places.filter(|path| path.is_file()).collect();
    assert!(pages.len() >= ALLOWED.len() - 3, "{pages:?}");
    for page in pages {
        let text = fs::read_to_string(&page).expect("a readable file");
        for line in text.lines() {
            let registry = line.contains("docs.rs/tem00")
                || line.contains("pip install tem00")
                || (line.contains("cargo install") && !line.contains("--path"));
            assert!(!registry, "{}: {line}", page.display());
        }
    }
}
