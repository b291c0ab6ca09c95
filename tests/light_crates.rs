//! The three physics crates are light enough to link, and fit into a renderer of many threads.

#![expect(
    clippy::expect_used,
    reason = "a test stops at what it does not expect"
)]

use std::{
    collections::BTreeSet,
    fs,
    path::{Path, PathBuf},
    process::Command,
};

use tem00::{beam, decorrelation};

const CRATES: [&str; 4] = ["beam", "speckle", "decorrelation", "shading"];

fn root() -> &'static Path {
    Path::new(env!("CARGO_MANIFEST_DIR"))
}

fn read(path: impl AsRef<Path>) -> String {
    let path = root().join(path);
    fs::read_to_string(&path).unwrap_or_else(|error| panic!("{}: {error}", path.display()))
}

/// The crates that a package brings with it, one to a line; build scripts' included.
fn brought_by(package: &str, features: &str) -> BTreeSet<String> {
    let output = Command::new(env!("CARGO"))
        .current_dir(root())
        .args(["tree", "--offline", "--locked", "--package", package])
        .args(["--edges", "normal,build", "--no-default-features"])
        .args([
            "--features",
            features,
            "--target",
            "x86_64-unknown-linux-gnu",
        ])
        .args(["--prefix", "none", "--format", "{p}", "--no-dedupe"])
        .output()
        .expect("cargo runs");
    let tree = String::from_utf8(output.stdout).expect("cargo prints UTF-8");
    let errors = String::from_utf8_lossy(&output.stderr);
    assert!(output.status.success(), "cargo tree of {package}: {errors}");
    let lines = tree.lines().skip(1).filter(|line| !line.is_empty());
    lines.map(str::to_owned).collect()
}

/// The rows of docs/integration.md that begin with the name of a crate, as their further cells.
fn rows(page: &str, name: &str) -> Vec<Vec<String>> {
    let start = format!("| `tem00-{name}` |");
    let rows = page.lines().filter_map(|line| line.strip_prefix(&start));
    rows.map(|row| row.split('|').map(|cell| cell.trim().to_owned()).collect())
        .collect()
}

#[test]
fn the_documentation_counts_the_crates_that_each_brings() {
    let page = read("docs/integration.md");
    for name in CRATES {
        let rows = rows(&page, name);
        assert_eq!(rows.len(), 1, "rows of tem00-{name} in docs/integration.md");
        let manifest = read(format!("crates/light/tem00-{name}/Cargo.toml"));
        for (cell, feature) in rows[0].iter().zip(["", "simd", "parallel"]) {
            let exists = feature.is_empty() || manifest.contains(&format!("\n{feature} = ["));
            let package = format!("tem00-{name}");
            let count = exists.then(|| brought_by(&package, feature).len().to_string());
            assert_eq!(
                *cell,
                count.unwrap_or("–".to_owned()),
                "tem00-{name} with the features [{feature}]"
            );
        }
    }
}

#[test]
fn the_documentation_counts_the_crates_that_the_facade_brings() {
    let page = read("docs/integration.md");
    let cases = [
        ("and brings", ""),
        ("without a tracer, it brings", "triangulation"),
        ("with all of them it brings", "scan,statistics,wave"),
    ];
    for (phrase, features) in cases {
        let (_, count) = page.split_once(phrase).expect("a count of the facade");
        let count: String = count
            .trim()
            .chars()
            .take_while(char::is_ascii_digit)
            .collect();
        let brought = brought_by("tem00", features).len().to_string();
        assert_eq!(count, brought, "tem00 with the features [{features}]");
    }
}

#[test]
fn no_threads_come_along_unless_asked_for() {
    for name in CRATES {
        for features in ["", "simd"] {
            let crates = brought_by(&format!("tem00-{name}"), features);
            assert!(
                !crates.iter().any(|line| line.starts_with("rayon")),
                "tem00-{name} with the features [{features}] brings {crates:?}"
            );
        }
    }
}

#[test]
fn the_documentation_names_functions_that_the_header_or_the_shaders_have() {
    let page = [read("docs/integration.md"), read("docs/functions.md")].concat();
    let shaders = ["beam", "speckle", "decorrelation", "shading"]
        .map(|name| read(format!("crates/light/tem00-{name}/shaders/tem00_{name}.wgsl")));
    let texts = [read("bindings/c/include/tem00.h"), shaders.concat()].concat();
    let names = page.split('`').filter(|word| {
        let kinds = ["camera", "imaging", "light", "speckle", "stack"];
        let kinds = kinds.map(|kind| format!("tem00_{kind}_"));
        kinds.iter().any(|kind| word.starts_with(kind))
    });
    let missing: Vec<_> = names
        .filter(|name| !texts.contains(&format!("{name}(")))
        .collect();
    assert!(
        missing.is_empty(),
        "neither in tem00.h nor in WGSL: {missing:?}"
    );
}

#[test]
fn the_documentation_shows_the_programs_that_run() {
    let page = read("docs/integration.md");
    for (language, file) in [
        ("rust,ignore", "examples/moved_spot.rs"),
        ("cpp", "bindings/integrations/cpp/moved_spot.cpp"),
        ("python", "bindings/integrations/python/moved_spot.py"),
        ("wgsl", "bindings/gpu/examples/factors.wgsl"),
    ] {
        let shown = format!("```{language}\n{}```\n", read(file));
        assert!(page.contains(&shown), "another program than {file}");
    }
}

const fn crosses_threads<T: Send + Sync>() {}

/// Holds the types to `Send + Sync`, and returns their names.
macro_rules! names_of_shared {
    ($($shared:ty),+ $(,)?) => {{
        $(const { crosses_threads::<$shared>() };)+
        let names = [$(stringify!($shared)),+].into_iter();
        names.map(|name| name.split('<').next().unwrap_or(name).to_owned())
    }};
}

/// The types that `lib.rs` of a crate exports: what is named in capitals.
fn exported(name: &str) -> BTreeSet<String> {
    exported_by(&format!("crates/light/tem00-{name}/src/lib.rs"))
}

fn exported_by(file: &str) -> BTreeSet<String> {
    let text = read(file);
    let statements = text
        .split(';')
        .filter_map(|part| part.split_once("\npub use "));
    let words =
        statements.flat_map(|(_, names)| names.split(|c: char| !c.is_alphanumeric() && c != '_'));
    let types = words.filter(|word| {
        word.starts_with(char::is_uppercase) && word.contains(|c: char| c.is_lowercase())
    });
    types.map(str::to_owned).collect()
}

#[test]
fn every_type_of_beam_crosses_threads() {
    use tem00::beam::*;
    let names = names_of_shared! {
        AngularKnot<f64>, AngularProfile, ApertureHit<f64>, AstigmaticBeam, Axis<f64>, BeamError,
        Bounds<f64>, Complex64, DVec3, FanGeometry, FocusCurve, GaussianBeam, LaserLine,
        LineLight<f64>, LineProfile, LocatedBeam, NextEvent<f64>, NextEventSlices<'static, f64>,
        Placement, RayPdf<f64>, RaySample<f64>, SampledEvent<f64>, SpotLight<f64>,
        TabulatedLineLight<'static, f64>,
    };
    let traits = ["Emitter", "Real"].map(str::to_owned);
    let listed: BTreeSet<_> = names.chain(traits).collect();
    assert_eq!(exported("beam"), listed, "types of tem00-beam");
}

#[test]
fn every_type_of_the_laboratory_of_beams_crosses_threads() {
    use tem00::beam::{measurement::*, optics::*};
    let optics = names_of_shared! { AbcdMatrix, ComplexBeamParameter, ThickLens };
    let measurement = names_of_shared! {
        CausticFit, CrossSection, Estimate, FitError, KnifeEdgeFit, RadiusErrors<'static>,
    };
    for (room, listed) in [
        ("optics", optics.collect()),
        ("measurement", measurement.collect()),
    ] {
        let listed: BTreeSet<_> = listed;
        let file = format!("crates/light/tem00-beam/src/{room}.rs");
        assert_eq!(exported_by(&file), listed, "types of {room}");
    }
}

#[test]
fn every_type_of_speckle_crosses_threads() {
    use tem00::speckle::*;
    let names = names_of_shared! {
        Aperture<'static>, Complex<f32>, Exposure, Interpolation,
        NpyError, NpyReader<&'static [u8]>, Phasors, PixelArray,
        Pupil, PupilField, SliceLaw, SlicePath, SpeckleError, SpeckleField, SpecklePattern,
        SpeckleScratch, SpeckleStack, StackFileError, StackNeeds, StackOptions, StackPlan,
        StackSource, Transmission,
    };
    let listed: BTreeSet<_> = names.collect();
    assert_eq!(exported("speckle"), listed, "types of tem00-speckle");
}

#[test]
fn every_type_of_decorrelation_crosses_threads() {
    use tem00::decorrelation::*;
    let names = names_of_shared! {
        CameraFrame, ChangedPoint, Configuration, ConfigurationData, CorrelationLaw, DMat3, DVec2, DVec3,
        DecorrelationError, Focus, Illumination, ImagingGeometry, LensData, LineOfSight, PointChange,
        PupilDistances, RigidChange, RigidMotion, RigidMotions, SpeckleMotion, ThickLensData, Wavefront,
    };
    let listed: BTreeSet<_> = names.collect();
    assert_eq!(
        exported("decorrelation"),
        listed,
        "types of tem00-decorrelation"
    );
}

/// The sources of a folder, tests aside.
fn sources(folder: PathBuf) -> Vec<PathBuf> {
    let mut found = Vec::new();
    for entry in fs::read_dir(folder).expect("a crate has sources") {
        let path = entry.expect("a readable folder").path();
        if path.is_dir() {
            found.extend(sources(path));
        } else if !path.ends_with("tests.rs") {
            found.push(path);
        }
    }
    found
}

#[test]
fn there_is_no_global_state() {
    const KEPT: [&str; 5] = [
        "thread_local!",
        "LazyLock",
        "OnceLock",
        "OnceCell",
        "Atomic",
    ];
    for name in CRATES.into_iter().chain(["numerics"]) {
        for path in sources(root().join(format!("crates/light/tem00-{name}/src"))) {
            let text = read(&path);
            let keeps = |line: &str| {
                let item = line.trim_start().trim_start_matches("pub ");
                item.starts_with("static ") || KEPT.iter().any(|kept| item.contains(kept))
            };
            let line = text.lines().find(|line| keeps(line));
            assert_eq!(line, None, "global state in {}", path.display());
        }
    }
}

#[test]
fn vectors_of_other_libraries_pass_through_mint() {
    let theirs = mint::Vector3 {
        x: 1.0,
        y: -2.0,
        z: 0.5,
    };
    let placement = beam::Placement {
        origin: theirs.into(),
        direction: theirs.into(),
        fan_axis: beam::DVec3::Z,
    };
    let motion = decorrelation::RigidMotion::along(theirs.into()).expect("a translation");
    let back: [mint::Vector3<f64>; 2] = [placement.origin.into(), motion.translation().into()];
    assert_eq!(back, [theirs; 2], "there and back");
}
