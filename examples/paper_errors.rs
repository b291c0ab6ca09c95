//! By how much are the speckle formulas of Bergmann et al. 2016 off, as printed?
//!
//! Prints printed | correct for each, where they differ most within a range, and draws what is left
//! of a pattern after a motion in the surface and along the axis.
//!
//! ```sh
//! cargo run --release --example paper_errors
//! ```

#![expect(clippy::print_stdout, reason = "an example prints its answer")]

mod plot;

use std::{error::Error, ops::RangeInclusive};

use kuva::prelude::{LinePlot, Plot};
use tem00::{
    decorrelation::{
        CameraFrame, Configuration, ConfigurationData, CorrelationLaw, DVec2, DVec3, Illumination,
        ImagingGeometry, LensData, RigidMotion, RigidMotions, SpeckleMotion, Wavefront,
    },
    numerics::circular_path_overlap,
};
use tem00_paper::{self as paper, Emitter, EulerAngles};

/// From the surface to the pupil, in metres.
const DISTANCE: f64 = 0.3;

/// Prints a printed and a correct value for the x of `range` at which they differ most.
fn row(name: &str, range: RangeInclusive<f64>, x: &str, pair: impl Fn(f64) -> Option<[f64; 2]>) {
    let (start, end) = range.into_inner();
    let places = (0..=1000).map(|i| start + (end - start) * f64::from(i) / 1000.0);
    let worst = places
        .filter_map(|x| Some((x, pair(x)?)))
        .map(|(x, [printed, correct])| ((printed - correct).abs(), printed, correct, x))
        .max_by(|a, b| a.0.total_cmp(&b.0));
    if let Some((_, printed, correct, at)) = worst {
        println!("{name:<28} | {printed:>7.3} | {correct:>7.3} | {x} = {at:.3}");
    }
}

/// A surface under a camera with the axis (sin q1, 0, cos q1), seen along `sight`, that moves by 1
/// µm along `a`: what its speckle moves by in the image and in the pupil, in micrometres along x.
fn moved(
    geometry: &ImagingGeometry,
    q1: f64,
    sight: DVec3,
    curvature: f64,
    a: DVec3,
) -> Option<[f64; 2]> {
    const MICROMETRE: f64 = 1e-6;
    let camera = CameraFrame::look_at(DVec3::new(q1.sin(), 0.0, q1.cos()), DVec3::ZERO, DVec3::Y);
    let light = Wavefront::spherical(DVec3::Z, curvature).ok()?;
    let before = Configuration::new(ConfigurationData {
        wavelength: geometry.wavelength(),
        point: DVec3::ZERO,
        normal: DVec3::Z,
        illumination: Illumination::near(DVec3::ZERO, light).ok()?,
        camera: camera.ok()?,
        pupil: sight * DISTANCE,
    })
    .ok()?;
    let surface = RigidMotion::along(a * MICROMETRE).ok()?;
    let still = RigidMotions::default();
    let after = before.moved(&RigidMotions { surface, ..still }).ok()?;
    let speckle = SpeckleMotion::between(geometry, &before, &after);
    let both = [speckle.image_displacement, speckle.pupil_displacement?];
    Some(both.map(|displacement| displacement.x / MICROMETRE))
}

/// What §6.4 prints for the displacement in the pupil, along x, in light from above.
fn printed_in_pupil(distance: f64, a: DVec3) -> Option<f64> {
    let angles = EulerAngles { q1: 0.0, q2: 0.0 };
    let direction = DVec3::Z;
    let emitter = Emitter {
        direction,
        distance,
    };
    Some(paper::pupil_displacement(angles, emitter, DISTANCE, a)?.x)
}

fn displacements(geometry: &ImagingGeometry) {
    let m = geometry.magnification();
    row("eq. (5): a_I / (m a_z)", 0.0..=60.0, "q1 / °", |q1| {
        let q1 = q1.to_radians();
        let seen = DVec3::new(q1.sin(), 0.0, q1.cos());
        let [correct, _] = moved(geometry, q1, seen, 0.0, DVec3::Z)?;
        let printed = paper::image_displacement(m, EulerAngles { q1, q2: 0.0 }, DVec3::Z);
        // On the sensor, upside down.
        Some([printed.x / m, -correct / m])
    });
    let name = "a_P^S off axis: a_P / a_z";
    row(name, 0.0..=0.5, "tan of sight line", |slope| {
        let sight = DVec3::new(slope, 0.0, 1.0);
        let [_, correct] = moved(geometry, 0.0, sight, 0.0, DVec3::Z)?;
        Some([printed_in_pupil(f64::INFINITY, DVec3::Z)?, correct])
    });
    // A helium–neon laser with a waist of 0.1 mm, its emitter 0.5 m from the surface.
    let name = "d_SL of a beam: a_P / a_x";
    row(name, -0.2..=0.2, "metres past the waist", |z| {
        let curvature = z / (z * z + 49.65e-3_f64.powi(2));
        let [_, correct] = moved(geometry, 0.0, DVec3::Z, curvature, DVec3::X)?;
        Some([printed_in_pupil(0.5, DVec3::X)?, correct])
    });
    row("camera moved with speckle", 0.0..=1.0, "a_P^C", |a| {
        let a = DVec2::new(a, 0.0);
        Some([paper::relative_pupil_displacement(a, a).x, 0.0])
    });
    row("c h / h_p", 0.0..=1.0, "a_I", |a| {
        let (origin, a) = (DVec2::ZERO, DVec2::new(a, 0.0));
        let printed = paper::pattern_coordinate(geometry, origin, a, 1.0);
        let correct = geometry.pattern_coordinate(origin, a, 1.0);
        Some([printed.x, correct.x].map(|c| c * geometry.speckle_size()))
    });
}

/// What is left after a motion of the speckle by `s` D and of the surface by `d_z` `d_z⁰`: printed,
/// on a stack whose slices lie that close, and correct.
fn left(geometry: &ImagingGeometry, s: f64, d_z: f64) -> [f64; 2] {
    let shift = DVec2::new(s * geometry.pupil_diameter(), 0.0);
    let printed_axial = d_z * paper::axial_decorrelation_length(geometry);
    let u = paper::slice_coordinate(geometry, shift, printed_axial, 1);
    let correct = CorrelationLaw::AtPeak.correlation(s, 0.5 * d_z);
    [circular_path_overlap(u).powi(2), correct]
}

fn correlations(geometry: &ImagingGeometry) {
    let left = |s, d_z| Some(left(geometry, s, d_z));
    row("d_z⁰: γ", 1.0..=1.0, "d_z / d_z⁰", |x| left(0.0, x));
    row("u in the plane: γ", 0.0..=1.0, "|a_P| / D", |x| {
        left(x, 0.0)
    });
    row("u along the axis: γ", 0.0..=1.0, "d_z / d_z⁰", |x| {
        left(0.0, x)
    });
    row(
        "u, both opposed: γ",
        0.0..=1.0,
        "|a_P| / D = −d_z / d_z⁰",
        |x| left(x, -x),
    );
    row("u past M: γ", 1.0..=2.0, "|a_P| / D", |x| left(x, 0.0));
}

fn curves(geometry: &ImagingGeometry) -> Vec<Plot> {
    let curve = |name: &str, colour: &str, gamma: &dyn Fn(f64) -> f64| -> Plot {
        let data = (0..=400).map(|i| f64::from(i) * 5e-3);
        let line = LinePlot::new().with_data(data.map(|x| (x, gamma(x))));
        line.with_legend(name).with_color(colour).into()
    };
    vec![
        curve("printed, either way", "crimson", &|x| {
            left(geometry, x, 0.0)[0]
        }),
        curve("in the plane", "steelblue", &|x| left(geometry, x, 0.0)[1]),
        curve("along the axis", "seagreen", &|x| left(geometry, 0.0, x)[1]),
    ]
}

fn main() -> Result<(), Box<dyn Error>> {
    let geometry = ImagingGeometry::from_lens(LensData {
        wavelength: 632.8e-9,
        focal_length: 60e-3,
        f_number: 6.0,
        surface_to_pupil: DISTANCE,
        pixel_pitch: 3.45e-6,
    })?;
    println!("{:<28} | printed | correct | at", "formula");
    displacements(&geometry);
    correlations(&geometry);

    let title = "What is left of a speckle pattern, as printed and correct";
    let axes = ["|a_P| / D or d_z / d_z⁰", "correlation γ"];
    let path = plot::write("paper_errors", title, axes, curves(&geometry))?;
    println!("{}", path.display());
    Ok(())
}
