//! The cells of a heat map as a picture in its SVG: thousands of rectangles are megabytes.

use base64::{Engine, engine::general_purpose::STANDARD};
use kuva::render::{
    color::Color,
    render::{Primitive, Scene},
};

use super::colours::HOLE;
use crate::image::write_png;

/// The placeholder of the cells.
const MARK: &str = "data-cells=\"\"";

/// The overlap of a cell with the next.
const OVERLAP: f64 = 0.5;

/// The cells of a scene, taken out of it.
pub(super) struct Cells {
    index: usize,
    rectangles: Primitive,
    image: String,
}

impl Cells {
    /// Takes the cells out of a scene, if it has any, and leaves a mark.
    pub(super) fn take(scene: &mut Scene) -> Option<Self> {
        let mut images = scene.elements.iter().map(image).enumerate();
        let (index, image) = images.find_map(|(index, image)| Some((index, image?)))?;
        let mark = Primitive::GroupStart {
            transform: None,
            title: None,
            extra_attrs: Some(MARK.to_owned()),
        };
        let rectangles = core::mem::replace(&mut scene.elements[index], mark);
        scene.elements.insert(index + 1, Primitive::GroupEnd);
        Some(Self {
            index,
            rectangles,
            image,
        })
    }

    /// Puts the cells back into the scene, and returns the SVG with the picture in place of the
    /// mark.
    pub(super) fn put_back(self, scene: &mut Scene, svg: &str) -> String {
        scene.elements.remove(self.index + 1);
        scene.elements[self.index] = self.rectangles;
        svg.replacen(&format!("<g {MARK}></g>"), &self.image, 1)
    }
}

/// Returns cells as an element of SVG; holes are transparent.
fn image(element: &Primitive) -> Option<String> {
    let Primitive::RectBatch { x, y, w, h, fills } = element else {
        return None;
    };
    let first = y.first()?;
    let columns = y
        .iter()
        .take_while(|&y| y.to_bits() == first.to_bits())
        .count();
    let rows = fills.len() / columns;
    // From the bottom up.
    let pixels = fills.chunks(columns).rev().flatten().flat_map(rgba);
    let data = STANDARD.encode(png(columns, rows, &pixels.collect::<Vec<_>>())?);
    let (width, height) = (w.first()? - OVERLAP, h.first()? - OVERLAP);
    let (width, height) = (width * columns as f64, height * rows as f64);
    let (x, y) = (x.first()?, y.last()?);
    Some(format!(
        "<image x=\"{x:.2}\" y=\"{y:.2}\" width=\"{width:.2}\" height=\"{height:.2}\" \
         preserveAspectRatio=\"none\" style=\"image-rendering:pixelated\" \
         href=\"data:image/png;base64,{data}\"/>"
    ))
}

fn rgba(colour: &Color) -> [u8; 4] {
    match *colour {
        Color::Rgb(r, g, b) if Color::from(HOLE) != Color::Rgb(r, g, b) => [r, g, b, 255],
        _ => [0; 4],
    }
}

fn png(columns: usize, rows: usize, pixels: &[u8]) -> Option<Vec<u8>> {
    let mut bytes = Vec::new();
    let kind = (png::ColorType::Rgba, png::BitDepth::Eight);
    write_png(&mut bytes, [columns, rows], kind, &[], pixels, |_| {}).ok()?;
    Some(bytes)
}
