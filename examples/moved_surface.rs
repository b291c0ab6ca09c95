//! What does speckle do when the surface moves by a quarter of a millimetre?
//!
//! A laser line with its fan along y lights a surface from one side, a camera looks from the other.
//! Prints how far the pattern moves in the image and how much of it is left (γ), with correct
//! physics and with the formulas as printed in Bergmann et al. 2016.

#![expect(clippy::print_stdout, reason = "an example prints its answer")]

use tem00::decorrelation::{
    CameraFrame, Configuration, ConfigurationData, DVec2, DVec3, Illumination, ImagingGeometry,
    LensData, RigidMotion, RigidMotions, SpeckleMotion, Wavefront,
};
use tem00::numerics::circular_path_overlap;
use tem00_paper as paper;

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let geometry = ImagingGeometry::from_lens(LensData {
        wavelength: 650e-9,
        focal_length: 25e-3,
        f_number: 8.0,
        surface_to_pupil: 0.3,
        pixel_pitch: 3.45e-6,
    })?;
    let eye = DVec3::new(0.15, 0.0, 0.26);
    let camera = CameraFrame::look_at(eye, DVec3::ZERO, DVec3::Y)?;
    let (laser, laser_distance) = (DVec3::new(-0.5, 0.0, 0.866), 0.2);
    // The waist of the line lies on the surface: its wavefront is curved along the fan only.
    let line = Wavefront::astigmatic(laser, DVec3::Y, 1.0 / laser_distance, 0.0)?;
    let before = Configuration::new(ConfigurationData {
        wavelength: geometry.wavelength(),
        point: DVec3::ZERO,
        normal: DVec3::Z,
        illumination: Illumination::near(DVec3::ZERO, line)?,
        camera,
        pupil: eye,
    })?;
    let (axes, angles) =
        paper::EulerAngles::between(&camera, DVec3::Z).ok_or("a normal of unit length")?;
    let emitter = paper::Emitter {
        direction: axes.transpose() * line.direction_to_source(),
        distance: laser_distance,
    };

    println!("The surface moves by 0.25 mm");
    for (name, direction) in [("x", DVec3::X), ("y", DVec3::Y), ("z", DVec3::Z)] {
        let displacement = direction * 0.25e-3;
        let after = before.moved(&RigidMotions {
            surface: RigidMotion::along(displacement)?,
            ..RigidMotions::default()
        })?;
        let ours = SpeckleMotion::between(&geometry, &before, &after);
        let pixels = ours.speckle_displacement() / geometry.pixel_pitch();

        let a = axes.transpose() * displacement;
        let sensor = paper::image_displacement(geometry.magnification(), angles, a);
        let pupil = paper::pupil_displacement(angles, emitter, geometry.surface_to_pupil(), a);
        let pupil = pupil.unwrap_or(DVec2::ZERO);
        let u = paper::slice_coordinate(&geometry, pupil, ours.axial_displacement, 1);
        let printed = -sensor / geometry.pixel_pitch();
        let printed_gamma = circular_path_overlap(u).powi(2);

        let gamma = ours.correlation;
        println!("along {name}: correct {pixels:5.2} px, γ = {gamma:.3}");
        println!("         printed {printed:5.2} px, γ = {printed_gamma:.3}");
    }
    Ok(())
}
