//! How does speckle move across the lens of a camera when a surface shifts, lifts or tilts?
//!
//! ```sh
//! cargo run --release --example surface_motion
//! ```
//!
//! A laser 0.25 m away lights a surface from the left, a camera looks at it from 0.3 m and from
//! 20° to the right. The waves of 1600 scatterers are summed on the pupil before and after each
//! motion, and the pattern is found again by cross-correlation.

#![expect(clippy::print_stdout, reason = "an example prints its answer")]

mod plot;

use std::error::Error;

use kuva::prelude::{LinePlot, Plot, ScatterPlot};
use tem00::{
    decorrelation::{
        self, CameraFrame, Configuration, ConfigurationData, RigidMotion, RigidMotions,
    },
    wave::{
        self, Amplitudes, Arrangement, Camera, DVec2, DVec3, Lens, PatchDescription, RoughSurface,
        Roughness, SamplePlane, displacement_between,
    },
};

const WAVELENGTH: f64 = 650e-9;
const LASER: DVec3 = DVec3::new(-0.1, 0.0, 0.229);
const EYE: DVec3 = DVec3::new(0.103, 0.0, 0.282);

/// Motions with the sizes they go to, in millimetres and milliradians.
const MOTIONS: [(&str, f64); 4] = [
    ("sideways / mm", 0.5),
    ("upwards / mm", 0.5),
    ("along its normal / mm", 0.5),
    ("tilt about y / mrad", 1.0),
];

const COLOURS: [&str; 4] = ["crimson", "steelblue", "seagreen", "darkorange"];

/// A motion as a translation and a rotation vector.
fn motion(kind: usize, amount: f64) -> [DVec3; 2] {
    let amount = 1e-3 * amount;
    match kind {
        0 => [DVec3::X * amount, DVec3::ZERO],
        1 => [DVec3::Y * amount, DVec3::ZERO],
        2 => [DVec3::Z * amount, DVec3::ZERO],
        _ => [DVec3::ZERO, DVec3::Y * amount],
    }
}

/// The speckle on a square of the pupil plane.
struct Pupil {
    plane: SamplePlane,
    step: f64,
    light: wave::Illumination,
    surface: RoughSurface,
}

impl Pupil {
    fn new() -> Result<Self, Box<dyn Error>> {
        let lens = Lens {
            pupil_diameter: 4e-3,
            focus_distance: 0.3,
            pupil_to_image: 0.06,
        };
        let camera = Camera::look_at([EYE, DVec3::ZERO], DVec3::Y, lens)?;
        let step = 40e-6;
        let surface = RoughSurface::patch(&PatchDescription {
            centre: DVec3::ZERO,
            normal: DVec3::Z,
            along: DVec3::X,
            size: [2e-3, 2e-3],
            scatterers: [40, 40],
            arrangement: Arrangement::Stratified,
            roughness: Roughness::FullyDeveloped(Amplitudes::ComplexGaussian),
            seed: 1,
        })?;
        Ok(Self {
            plane: camera.pupil_plane(step, 97)?,
            step,
            light: wave::Illumination::point(WAVELENGTH, LASER)?,
            surface,
        })
    }

    /// How far the speckle moves, in metres.
    fn displacement(&self, [along, turn]: [DVec3; 2]) -> Result<DVec2, Box<dyn Error>> {
        let speckle = |surface: &RoughSurface| {
            let field = surface.lit_by(&self.light).field_on(&self.plane);
            field.intensity()
        };
        let axis = turn.try_normalize().unwrap_or(DVec3::Z);
        let turn = wave::RigidMotion::rotation(axis, turn.length(), DVec3::ZERO)?;
        let motion = turn.then(&wave::RigidMotion::translation(along)?);
        let moved = speckle(&self.surface.moved(&motion));
        let shift = displacement_between(&speckle(&self.surface), &moved);
        Ok(shift.ok_or("the patterns have nothing in common")?.offset * self.step)
    }
}

/// The same by the law of finite motions.
fn law([along, turn]: [DVec3; 2]) -> Result<DVec2, Box<dyn Error>> {
    let before = Configuration::new(ConfigurationData {
        wavelength: WAVELENGTH,
        point: DVec3::ZERO,
        normal: DVec3::Z,
        illumination: decorrelation::Illumination::point_source(LASER)?,
        camera: CameraFrame::look_at(EYE, DVec3::ZERO, DVec3::Y)?,
        pupil: EYE,
    })?;
    let axis = turn.try_normalize().unwrap_or(DVec3::Z);
    let turn = RigidMotion::about(DVec3::ZERO, axis, turn.length())?;
    let after = before.moved(&RigidMotions {
        surface: turn.then(&RigidMotion::along(along)?),
        ..RigidMotions::default()
    })?;
    let moved = before.pupil_point_after(&after, DVec2::ZERO);
    Ok(moved.ok_or("the speckle has left the pupil plane")?)
}

/// Rounds to what is printed, and minus zero to zero.
fn tenths(value: f64) -> f64 {
    (10.0 * value).round() / 10.0 + 0.0
}

fn main() -> Result<(), Box<dyn Error>> {
    let pupil = Pupil::new()?;
    let mut plots: Vec<Plot> = Vec::new();
    println!("Displacement of the speckle on the pupil, right and up, in µm");
    println!("{:22} | amount | measured         | theory", "motion");
    for (kind, ((name, most), colour)) in MOTIONS.into_iter().zip(COLOURS).enumerate() {
        let (mut measured, mut theory) = (vec![(0.0, 0.0)], vec![(0.0, 0.0)]);
        for part in [0.2, 0.4, 0.6, 0.8, 1.0] {
            let moved = motion(kind, part * most);
            let (by_waves, by_law) = (pupil.displacement(moved)? * 1e6, law(moved)? * 1e6);
            println!(
                "{name:22} | {:>6.2} | {:>7.1} {:>8.1} | {:>7.1} {:>7.1}",
                part * most,
                tenths(by_waves.x),
                tenths(by_waves.y),
                tenths(by_law.x),
                tenths(by_law.y)
            );
            measured.push((part * most, by_waves.length()));
            theory.push((part * most, by_law.length()));
        }
        let line = LinePlot::new().with_data(theory).with_color(colour);
        let points = ScatterPlot::new().with_data(measured).with_color(colour);
        plots.push(line.with_legend(name).into());
        plots.push(points.into());
    }
    let axes = ["motion / mm or mrad", "displacement on the pupil / µm"];
    let title = "Speckle follows a surface: wave optics (dots), law (lines)";
    println!(
        "{}",
        plot::write("surface_motion", title, axes, plots)?.display()
    );
    Ok(())
}
