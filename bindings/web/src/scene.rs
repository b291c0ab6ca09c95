//! The rows that the passes read, in the order of the struct `Scene` of page.wgsl.

use tem00_numerics::cast::to_f32;
use tem00_shading::PlacedLight;

use crate::{
    AnyError, colour,
    optics::{self, SENSOR},
    settings::Values,
    speckle::Speckle,
};

/// The number of rows.
pub const COUNT: u64 = 42;

/// Rows of four numbers.
pub type Rows = Vec<[f32; 4]>;

/// The rows for so many camera samples along a side of a pixel.
///
/// # Errors
///
/// Returns an error if the settings make no light or no camera.
pub fn rows(values: &Values, speckle: &Speckle, samples: u32) -> Result<Rows, AnyError> {
    let camera = optics::camera(values)?;
    let (boxes, sphere) = optics::part(values);
    let [red, green, blue] = colour::of_wavelength(values.wavelength);
    let [width, height] = SENSOR.map(|n| n as f32);
    let slope = camera.description().pixel_pitch / camera.image_distance();

    // The light that is off stays dark.
    let (mut line, mut spot) = ([[0.0; 4]; 7], [[0.0; 4]; 6]);
    match optics::laser(values)?.placed() {
        PlacedLight::Line(light) => line = light.to_rows_f32(),
        PlacedLight::Spot(light) => spot = light.to_rows_f32(),
    }
    let mut rows = Rows::new();
    rows.extend(line);
    rows.extend(spot);
    rows.extend(speckle.rows(values)?);
    rows.extend(optics::rows_of(&optics::pose(values)?));
    for index in 0..optics::BOXES {
        let corners = boxes.get(index).copied().unwrap_or_default();
        rows.extend(corners.map(|corner| corner.extend(0.0).to_array()));
    }
    rows.push(sphere);
    rows.push(
        [
            values.lamp,
            values.speckle,
            values.printed,
            values.false_colour,
        ]
        .map(to_f32),
    );
    rows.push([width, height, boxes.len() as f32, to_f32(slope)]);
    let exposure = optics::exposure(values);
    rows.push([values.zoom_x, values.zoom_y, exposure, values.zoom].map(to_f32));
    rows.push([red, green, blue, samples as f32]);
    Ok(rows)
}
