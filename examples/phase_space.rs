//! How can straight rays make a beam that is bent?
//!
//! Draws rays from the phase-space density of a focused beam and lays them beside the hyperboloid
//! w(z): every ray is straight, their envelope is not.

#![expect(clippy::print_stdout, reason = "an example prints its answer")]

mod plot;

use std::error::Error;

use kuva::prelude::{LinePlot, Plot};
use rand::{RngExt, SeedableRng};
use rand_chacha::ChaCha8Rng;
use tem00::beam::{DVec3, Emitter, GaussianBeam, Placement, SpotLight};

const RAYS: usize = 100_000;
const SHOWN: usize = 150;
const WAIST_DISTANCE: f64 = 20e-3;

/// Where the ray is at the distance `z` from the aperture, along x.
fn position(origin: [f64; 3], direction: [f64; 3], z: f64) -> f64 {
    origin[0] + direction[0] / direction[2] * z
}

fn main() -> Result<(), Box<dyn Error>> {
    let beam = GaussianBeam::from_waist(650e-9, 20e-6)?;
    let placement = Placement {
        origin: DVec3::ZERO,
        direction: DVec3::Z,
        fan_axis: DVec3::X,
    };
    let light = SpotLight::place(&beam, WAIST_DISTANCE, &placement, 1.0)?;
    let mut random = ChaCha8Rng::seed_from_u64(1);
    let rays: Vec<_> = (0..RAYS)
        .map(|_| light.sample_ray(random.random()))
        .collect();

    println!("{RAYS} rays of a beam focused to 20 µm");
    println!("z / mm | w(z) / µm | 2σ of the rays / µm");
    for z in [0.0, 10e-3, 18e-3, 20e-3, 22e-3, 40e-3] {
        let squares = rays
            .iter()
            .map(|ray| position(ray.origin, ray.direction, z).powi(2));
        let width = 2.0 * (squares.sum::<f64>() / RAYS as f64).sqrt();
        let theory = beam.radius_at(z - WAIST_DISTANCE);
        let [z, theory, width] = [z * 1e3, theory * 1e6, width * 1e6];
        println!("{z:>6.1} | {theory:>9.2} | {width:>9.2}");
    }

    let reach = 2.0 * WAIST_DISTANCE;
    let mut plots: Vec<Plot> = Vec::new();
    for ray in &rays[..SHOWN] {
        let at = |z: f64| (z * 1e3, position(ray.origin, ray.direction, z) * 1e6);
        let thread = LinePlot::new().with_data([at(0.0), at(reach)]);
        plots.push(thread.with_stroke_width(0.4).into());
    }
    for sign in [1.0, -1.0] {
        let edge = (0..=200).map(|i| {
            let z = reach * f64::from(i) / 200.0;
            (z * 1e3, sign * beam.radius_at(z - WAIST_DISTANCE) * 1e6)
        });
        plots.push(LinePlot::new().with_data(edge).with_color("crimson").into());
    }
    let title = "Straight rays and the beam radius ±w(z)";
    let path = plot::write("phase_space", title, ["z / mm", "x / µm"], plots)?;
    println!("{}", path.display());
    Ok(())
}
