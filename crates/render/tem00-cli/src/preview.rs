//! From radiance to a picture for the eye.

use tem00_numerics::{
    Grid,
    cast::{to_f32, to_usize},
};
use tem00_report::colour::rgb_of_wavelength;

/// The fraction of the lit pixels that the automatic exposure leaves below white: in fully
/// developed speckle, the pixels below three times the mean.
const BELOW_WHITE: f64 = 0.95;

/// A pixel counts as lit if it is brighter than this fraction of the brightest.
const LIT: f32 = 0.01;

/// A picture in linear sRGB, in the unit of the layers it was made of.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Picture(Grid<[f32; 3]>);

impl Picture {
    /// Creates a dark picture.
    ///
    /// # Panics
    ///
    /// Panics unless `width > 0` and `height > 0`.
    pub(crate) fn dark(width: usize, height: usize) -> Self {
        Self(Grid::filled(width, height, [0.0; 3]))
    }

    /// Adds light of one wavelength, in metres.
    ///
    /// # Panics
    ///
    /// Panics unless the layer has the size of the picture.
    pub(crate) fn add_laser(&mut self, layer: &Grid<f32>, wavelength: f64) {
        self.add(layer, rgb_of_wavelength(wavelength));
    }

    /// Adds white light.
    ///
    /// # Panics
    ///
    /// Panics unless the layer has the size of the picture.
    pub(crate) fn add_white(&mut self, layer: &Grid<f32>) {
        self.add(layer, [1.0; 3]);
    }

    fn add(&mut self, layer: &Grid<f32>, colour: [f64; 3]) {
        assert_eq!(
            (layer.width(), layer.height()),
            (self.0.width(), self.0.height()),
            "a layer has the size of the picture"
        );
        for (pixel, value) in self.0.values_mut().iter_mut().zip(layer.values()) {
            for (component, weight) in pixel.iter_mut().zip(colour) {
                *component += to_f32(weight) * value;
            }
        }
    }

    /// Returns one component of every pixel: 0 red, 1 green, 2 blue.
    ///
    /// # Panics
    ///
    /// Panics unless `component < 3`.
    pub(crate) fn component(&self, component: usize) -> Grid<f32> {
        self.0.map(|pixel| pixel[component])
    }

    /// Returns whether there is no light at all.
    pub(crate) fn is_dark(&self) -> bool {
        self.0.values().iter().flatten().all(|&value| value <= 0.0)
    }

    /// Returns the level that the picture should show as white: 95 % of the lit pixels lie below
    /// it. A pixel is lit if it exceeds 1 % of the brightest.
    ///
    /// The level of a dark picture is 1.
    pub(crate) fn automatic_white_level(&self) -> f32 {
        let largest = |pixel: &[f32; 3]| pixel.iter().copied().fold(0.0, f32::max);
        let mut levels: Vec<f32> = self.0.values().iter().map(largest).collect();
        let brightest = levels.iter().copied().fold(0.0, f32::max);
        levels.retain(|&level| level > LIT * brightest);
        levels.sort_by(f32::total_cmp);
        let index = to_usize(levels.len() as f64 * BELOW_WHITE);
        levels.get(index).or(levels.last()).copied().unwrap_or(1.0)
    }

    /// Returns the picture with `white` scaled to 1; brighter pixels keep their hue.
    pub(crate) fn exposed(&self, white: f32) -> Grid<[f32; 3]> {
        self.0.map(|pixel| {
            let scale = pixel.iter().copied().fold(white, f32::max);
            pixel.map(|component| component / scale)
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn lasers_keep_their_colour_and_lights_are_white() {
        let mut picture = Picture::dark(2, 1);
        picture.add_laser(
            &Grid::from_fn(2, 1, |x, _| if x == 0 { 2.0 } else { 0.0 }),
            650e-9,
        );
        picture.add_white(&Grid::filled(2, 1, 0.5));
        let [laser, light] = picture.exposed(1.0).values()[..] else {
            panic!("two pixels");
        };
        // Three times too bright, and as red as before: 0.52 / 2.5.
        assert!(
            laser[0] > 0.999 && laser[1] < 0.21,
            "red on grey: {laser:?}"
        );
        assert!(
            light.iter().all(|c| (c - 0.5).abs() < 1e-7),
            "grey: {light:?}"
        );
    }

    #[test]
    fn a_small_spot_in_the_dark_sets_the_exposure() {
        // 20 of 10000 pixels are lit, far fewer than the five percent that may be burnt out.
        let spot = Grid::from_fn(100, 100, |x, y| match (x < 20, y == 0) {
            (true, true) => 3.0 + 0.01 * x as f32,
            _ => 1e-3,
        });
        let mut picture = Picture::dark(100, 100);
        picture.add_white(&spot);
        let white = picture.automatic_white_level();
        assert!((3.0..3.2).contains(&white), "white level {white}");
    }

    #[test]
    fn five_percent_of_the_lit_pixels_are_burnt_out() {
        let mut picture = Picture::dark(100, 100);
        picture.add_white(&Grid::from_fn(100, 100, |x, y| 0.5 + (x + 100 * y) as f32));
        let white = picture.automatic_white_level();
        // Of 10000 equally spaced levels those above 1 % of the brightest are lit: 9900.
        let burnt = 10_000.0 - f64::from(white);
        assert!(
            (burnt - 0.05 * 9_900.0).abs() < 2.0,
            "{burnt} pixels are burnt out"
        );
    }

    #[test]
    fn darkness_has_a_finite_exposure() {
        let picture = Picture::dark(3, 3);
        let white = picture.automatic_white_level();
        assert!(
            white > 0.0
                && picture
                    .exposed(white)
                    .values()
                    .iter()
                    .flatten()
                    .all(|v| *v == 0.0),
            "dark"
        );
    }
}
