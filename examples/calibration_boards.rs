//! Photographs of a checkerboard and of a laser line on it, as a user would take them to calibrate.
//!
//! ```sh
//! cargo run --release --example calibration_boards -- [FOLDER]
//! tem00-inspect calibrate out/calibration_boards --corners 9x6 --square "8.4 mm" \
//!     --pixel-pitch "8 um"
//! ```
//!
//! The boards stand before a camera with a barrel distortion that looks at the laser plane at 30°.
//! The corners that the camera must see and those that are found are written beside the images, and
//! the program prints how far from them the corners in the images are found. The folder is
//! `out/calibration_boards` without one.

#![expect(clippy::print_stdout, reason = "an example prints its answer")]

mod frame_file;

use std::{env, error::Error, fs, path::Path, path::PathBuf, sync::atomic::AtomicBool};

use tem00::{
    calibration::{BoardSettings, find_corners},
    scan::BoardPlan,
    scene::parse_scene,
    triangulation::{Sensor, SensorDescription},
};

const SCENE: &str = r#"
    [camera]
    position = ["0 mm", "-125 mm", "216.5 mm"]
    look_at = ["0 mm", "0 mm", "0 mm"]
    up = [0, 0, 1]
    focal_length = "12 mm"
    f_number = 11
    focus_distance = "250 mm"
    pixel_pitch = "8 um"
    resolution = [640, 480]
    distortion = [-0.2, 0, 0]

    [render]
    samples_per_pixel = 16

    [[laser]]
    wavelength = "650 nm"
    power = "5 mW"
    position = ["0 mm", "0 mm", "300 mm"]
    look_at = ["0 mm", "0 mm", "0 mm"]
    line_direction = [1, 0, 0]
    line = { fan_angle = "40 deg", thickness = "0.8 mm", focus_distance = "300 mm" }

    [[surface]]
    rectangle = { size = ["200 mm", "200 mm"] }
"#;

fn main() -> Result<(), Box<dyn Error>> {
    let folder = env::args_os()
        .nth(1)
        .map_or("out/calibration_boards".into(), PathBuf::from);
    fs::create_dir_all(&folder)?;
    let scene = parse_scene(SCENE, Path::new("."))?;
    let settings = BoardSettings {
        square: Some(8.4e-3),
        boards: 8,
        ..BoardSettings::default()
    };
    let plan = BoardPlan::new(&scene, &settings)?;
    let sensor = Sensor::new(SensorDescription {
        pixel_pitch: 8e-6,
        ..SensorDescription::typical(8)
    })?;
    println!("board | rms distance of the corners / pixel");
    let mut table = String::from("board,corner,x_pixel,y_pixel,x_found_pixel,y_found_pixel\n");
    for (number, pose) in plan.poses().iter().enumerate() {
        let cancel = AtomicBool::new(false);
        let [lit, line] = plan.frames(number, &sensor, &|_| (), &cancel)?;
        frame_file::write(&folder.join(format!("board_{number:02}.png")), &lit)?;
        frame_file::write(&folder.join(format!("line_{number:02}.png")), &line)?;
        let found = find_corners(&lit.grey_values(), plan.board())?;
        let mut sum = 0.0;
        for (i, (corner, found)) in plan.board().points().iter().zip(&found).enumerate() {
            let seen = scene.camera.project(pose.point(*corner));
            let seen = seen.ok_or("a corner is not seen")?;
            let [x, y] = seen.to_array();
            table += &format!("{number},{i},{x},{y},{},{}\n", found.x, found.y);
            sum += seen.distance_squared(*found);
        }
        println!("{number:5} | {:.3}", (sum / found.len() as f64).sqrt());
    }
    fs::write(folder.join("corners.csv"), table)?;
    println!("{}", folder.display());
    Ok(())
}
