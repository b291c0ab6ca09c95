use tem00_numerics::Grid;

/// The rendered layers of one frame.
///
/// All radiances are in W/(m² sr), averaged over the pixel, at the wavelength of their source.
#[derive(Clone, Debug, PartialEq)]
pub struct Frame {
    /// The layers of each laser, in the order of the scene.
    pub lasers: Vec<LaserLayers>,
    /// The radiance from incoherent lamps.
    pub lamps: Grid<f32>,
}

/// The layers of one laser.
#[derive(Clone, Debug, PartialEq)]
pub struct LaserLayers {
    /// The vacuum wavelength, in metres.
    pub wavelength: f64,
    /// Radiance of the first interaction, from laser to surface to camera, before speckle.
    pub coherent_before: Grid<f32>,
    /// The speckle factor, averaged over the pixel without regard to the light; 1 where the pixel
    /// sees no surface.
    pub speckle: Grid<f32>,
    /// Radiance of the first interaction after each camera sample was multiplied by its speckle
    /// factor.
    pub coherent_after: Grid<f32>,
    /// Radiance that has met more than one surface, which carries no speckle.
    pub incoherent: Grid<f32>,
    /// The power that the laser brings to the surfaces seen in the image, in watts.
    ///
    /// It is estimated from the camera's samples: the irradiance at each hit times the area that
    /// the sample covers there. It is the laser's power when the whole footprint is in the image.
    pub power_on_target: f64,
}

/// One row of the layers of one source.
#[derive(Clone, Debug)]
pub(crate) struct Row {
    pub pixels: Vec<Pixel>,
}

/// What one pixel holds of one source: means over its samples.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct Pixel {
    pub coherent_before: f64,
    pub speckle: f64,
    pub coherent_after: f64,
    pub incoherent: f64,
    pub power: f64,
}

impl Pixel {
    /// Adds `other · weight`.
    pub(crate) fn add(&mut self, other: &Self, weight: f64) {
        self.coherent_before += weight * other.coherent_before;
        self.speckle += weight * other.speckle;
        self.coherent_after += weight * other.coherent_after;
        self.incoherent += weight * other.incoherent;
        self.power += weight * other.power;
    }
}

/// Assembles rows, in order, into the layers of a laser.
pub(crate) fn laser_layers(wavelength: f64, rows: &[Row]) -> LaserLayers {
    LaserLayers {
        wavelength,
        coherent_before: layer(rows, |pixel| pixel.coherent_before),
        speckle: layer(rows, |pixel| pixel.speckle),
        coherent_after: layer(rows, |pixel| pixel.coherent_after),
        incoherent: layer(rows, |pixel| pixel.incoherent),
        // Summed in the order of the rows, so that the sum has the same bits for any number of threads.
        power_on_target: rows
            .iter()
            .flat_map(|row| &row.pixels)
            .map(|pixel| pixel.power)
            .sum(),
    }
}

/// Assembles rows, in order, into the layer of the lamps.
pub(crate) fn lamp_layer(rows: &[Row]) -> Grid<f32> {
    layer(rows, |pixel| pixel.incoherent)
}

#[expect(
    clippy::cast_possible_truncation,
    reason = "images are stored in single precision"
)]
fn layer(rows: &[Row], value: impl Fn(&Pixel) -> f64) -> Grid<f32> {
    let width = rows.first().map_or(0, |row| row.pixels.len());
    Grid::from_fn(width, rows.len(), |x, y| value(&rows[y].pixels[x]) as f32)
}
