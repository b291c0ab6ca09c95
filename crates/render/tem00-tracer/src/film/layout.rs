use crate::Crop;

/// Sizes of a film, and the light that it keeps apart.
#[derive(Clone, Copy, Debug)]
pub struct FilmLayout<'a> {
    /// The wavelengths of the lasers, in metres.
    pub wavelengths: &'a [f64],
    /// The part of the image that is rendered.
    pub area: Crop,
    /// The number of strips into which the area is divided.
    pub strips: usize,
    /// True if pilot samples determine the sample count of each pixel.
    pub has_pilot: bool,
    /// True if light is followed from the lasers, too.
    pub light_traced: bool,
}
