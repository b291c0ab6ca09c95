//! Does a rendered laser spot carry the power of its beam, and how strong is its speckle?
//!
//! Prints `measured | theory` for a spot that comes in at 30° on a diffuse plate.

#![expect(clippy::print_stdout, reason = "an example prints its answer")]

use std::{error::Error, path::Path, sync::atomic::AtomicBool};

use tem00::{
    scene::parse_scene,
    statistics::{Contrast, pixel_contrast},
    tracer::{RenderOptions, SpeckleModel, SpecklePlan, render_frame},
};

const SCENE: &str = r#"
[camera]
position = ["0 mm", "0 mm", "300 mm"]
resolution = [192, 160]

[[laser]]
wavelength = "650 nm"
power = "5 mW"
position = ["100 mm", "0 mm", "173.2 mm"]
spot = { waist_radius = "0.5 mm" }

[[surface]]
rectangle = { size = ["40 mm", "40 mm"] }
"#;

fn main() -> Result<(), Box<dyn Error>> {
    let scene = parse_scene(SCENE, Path::new("."))?;
    let options = RenderOptions {
        samples_per_pixel: 64,
        ..RenderOptions::default()
    };
    let plan = SpecklePlan::new(&scene, options.formulas, options.seed)?;
    println!("{plan}");
    let model = SpeckleModel::generate(&scene, &plan)?;
    let cancel = AtomicBool::new(false);
    let frame = render_frame(&scene, Some(&model), 0, &options, |_| (), &cancel)?;

    let laser = &frame.lasers[0];
    let power = scene.lasers[0].power();
    println!(
        "power on the plate   {:.4} mW | {:.4} mW",
        1e3 * laser.power_on_target,
        1e3 * power
    );

    // A pixel integrates 1/h of a speckle along each side.
    let speckle_size = plan.patterns()[0].speckle_size_in_pixels();
    let measured =
        Contrast::from_samples(laser.speckle.values())?.with_speckle_size(speckle_size)?;
    println!(
        "speckle contrast     {:.3} ± {:.3} | {:.3}",
        measured.value(),
        measured.standard_error(),
        pixel_contrast(1.0 / speckle_size)
    );
    Ok(())
}
