//! The rows that the passes read, in the order of the struct `Scene` of page.wgsl.

use tem00_decorrelation::{FieldSetup, ImageOrientation, MotionField};
use tem00_numerics::cast::to_f32;

use crate::{
    AnyError, colour,
    optics::{self, SENSOR, View},
    settings::Values,
    speckle::Speckle,
};

/// The number of rows.
pub const COUNT: u64 = 34;

/// Rows of four numbers.
pub type Rows = Vec<[f32; 4]>;

/// The rows for so many camera samples along a side of a pixel.
///
/// # Errors
///
/// Returns an error if the settings make no light or no camera.
pub fn rows(values: &Values, speckle: &Speckle, samples: u32) -> Result<Rows, AnyError> {
    let view = View::new(values)?;
    let (line, spot) = optics::lights(values)?;
    let motion = MotionField::new(FieldSetup {
        geometry: view.geometry,
        camera: view.frame,
        pupil_centre: view.eye,
        orientation: ImageOrientation::ScreenUpright,
        pattern_speckle_size: speckle.size,
    })?;
    let geometry = &view.geometry;
    let slope = geometry.pixel_pitch() / (geometry.magnification() * geometry.surface_to_pupil());
    let per_pixel = speckle.size / geometry.speckle_size_in_pixels();
    let (boxes, sphere) = optics::part(values);
    let [red, green, blue] = colour::of_wavelength(values.wavelength);
    let [width, height] = SENSOR.map(|n| n as f32);

    let mut rows = Rows::new();
    rows.extend(line.to_rows());
    rows.extend(spot.to_rows());
    rows.extend(motion.to_rows()?);
    rows.push([view.eye.x, view.eye.y, view.eye.z, slope].map(to_f32));
    rows.extend(optics::pose(values));
    for index in 0..optics::BOXES {
        let corners = boxes.get(index).copied().unwrap_or_default();
        rows.extend(corners.map(|corner| corner.extend(0.0).to_array()));
    }
    rows.push(sphere);
    rows.push([values.lamp, values.light, values.speckle, values.printed].map(to_f32));
    rows.push([width, height, boxes.len() as f32, to_f32(per_pixel)]);
    let [exposure, zoom] = [optics::exposure(values), values.zoom].map(to_f32);
    rows.push([
        speckle.overlaps.len() as f32,
        samples as f32,
        exposure,
        zoom,
    ]);
    rows.push([values.zoom_x, values.zoom_y, values.false_colour, 0.0].map(to_f32));
    rows.push([red, green, blue, 0.0]);
    Ok(rows)
}
