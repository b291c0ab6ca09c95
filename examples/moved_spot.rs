//! Two pictures of a plane under a laser spot that slides by 0.1 mm, and how much of the speckle is
//! left.
//!
//!     cargo run --release --example moved_spot        writes out/moved_spot_0.png and
//!                                                     out/moved_spot_1.png

#![expect(clippy::print_stdout, reason = "an example prints its answer")]

mod picture;

use std::error::Error;

use tem00::decorrelation::pupil_overlap_correlation;
use tem00::numerics::{Grid, cast::to_f32};
use tem00::statistics::pearson_correlation;
use tem00::{Camera, CameraDescription, DVec2, DVec3, Laser, Pose, Speckle, SpeckleFrame};

fn main() -> Result<(), Box<dyn Error>> {
    let camera = Camera::new(CameraDescription::default())?;
    let laser = Laser::spot(650e-9, 3e-3).power(5e-3);
    let laser = laser.placed(DVec3::new(0.2, 0.0, 0.4), DVec3::ZERO, DVec3::X)?;
    let pose = Pose::along(DVec3::new(1e-4, 0.0, 0.0))?;

    // Chooses sizes, slices and seeds, says what it chose, and refuses what does not fit.
    let speckle = Speckle::new(&camera, &laser, 1).for_poses(&[pose]);
    let speckle = speckle.prepare()?;
    println!("{speckle}");
    // Once per body and frame.
    let before = speckle.frame(&Pose::IDENTITY.into())?;
    let after = speckle.frame(&pose.into())?;

    // Per hit: the point that is seen, here of the plane z = 0, how it is lit, and the speckle
    // there.
    let point = |pixel| {
        let ray = camera.ray(pixel);
        ray.origin - ray.origin.z / ray.direction.z * ray.direction
    };
    let factor = |frame: &SpeckleFrame, pixel| frame.factor(point(pixel), DVec3::Z);
    let irradiance = |frame: &SpeckleFrame, pixel| match laser.next_event(point(pixel)) {
        Some(light) => light.e_perp * light.wi.z * factor(frame, pixel),
        None => 0.0,
    };

    let picture = |value: &dyn Fn(DVec2) -> f64| {
        let value = |x, y| to_f32(value(DVec2::new(x as f64 + 0.5, y as f64 + 0.5)));
        Grid::from_fn(camera.width(), camera.height(), value)
    };
    for (name, frame) in [("moved_spot_0", &before), ("moved_spot_1", &after)] {
        let picture = picture(&|pixel| irradiance(frame, pixel) / 200.0);
        println!("{}", picture::write(name, &[picture])?.display());
    }

    // By the law, and as found where the speckle has gone.
    let shift = after.shift(DVec3::ZERO, DVec3::Z).ok_or("out of sight")?;
    let law = pupil_overlap_correlation(shift.pupil);
    let gone = |pixel| factor(&after, pixel + shift.displacement);
    let found = pearson_correlation(&picture(&|p| factor(&before, p)), &picture(&gone))?;
    println!("correlation {found:.3}, by the law {law:.3}");
    Ok(())
}
