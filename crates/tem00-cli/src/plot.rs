//! Diagrams: charts of points and lines, bars and heat maps, as SVG and PNG.

mod bars;
mod cells;
mod chart;
pub(crate) mod colours;
mod heat_map;

use std::{io::Write, path::Path};

use kuva::{
    PngBackend,
    backend::svg::SvgBackend,
    prelude::{Figure, Layout, LegendPosition, Plot},
    render::render::{Primitive, Scene, render_multiple},
};

use self::cells::Cells;
pub(crate) use self::{
    bars::Bars,
    chart::Chart,
    colours::Colour,
    heat_map::{HeatMap, Scale, height_colour},
};
use crate::{atomic::write_atomically, failure::Failure};

/// The pixels of a PNG per unit of the drawing.
const PNG_SCALE: f32 = 2.5;

/// The formats of a drawing, told apart by the end of the file's name.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Format {
    Svg,
    Png,
}

impl Format {
    pub(crate) fn of_path(path: &Path) -> Option<Self> {
        let extension = path.extension()?.to_str()?;
        [("svg", Self::Svg), ("png", Self::Png)]
            .into_iter()
            .find(|(name, _)| extension.eq_ignore_ascii_case(name))
            .map(|(_, format)| format)
    }
}

/// One diagram in the making: what is drawn, and the axes about it.
type Panel = (Vec<Plot>, Layout);

/// A finished drawing.
pub(crate) struct Drawing {
    scene: Scene,
    svg: String,
}

impl Drawing {
    fn of_panel((plots, layout): Panel) -> Self {
        Self::of_scene(render_multiple(plots, layout))
    }

    /// Takes what was drawn element by element.
    pub(crate) fn of_scene(mut scene: Scene) -> Self {
        scene.height = scene.height.max(lowest_text(&scene) + MARGIN);
        let svg = svg(&mut scene);
        Self { scene, svg }
    }

    /// Puts charts side by side under a title.
    pub(crate) fn of_row(title: &str, charts: Vec<Chart>) -> Self {
        let columns = charts.len();
        let (plots, layouts) = charts.into_iter().map(Chart::panel).unzip();
        Self::of_scene(
            Figure::new(1, columns)
                .with_title(title)
                .with_plots(plots)
                .with_layouts(layouts)
                .with_cell_size(460.0, 400.0)
                .render(),
        )
    }

    /// Returns the drawing as SVG.
    #[cfg(test)]
    pub(crate) fn svg(&self) -> &str {
        &self.svg
    }

    /// Returns the drawing as a file of the format, or what prevents it.
    pub(crate) fn bytes(&self, format: Format) -> Result<Vec<u8>, String> {
        match format {
            Format::Svg => Ok(self.svg.clone().into_bytes()),
            Format::Png => PngBackend::new()
                .with_scale(PNG_SCALE)
                .render_scene(&self.scene),
        }
    }

    /// Writes `name.svg` and `name.png` into the folder, and returns the text of the SVG.
    ///
    /// # Errors
    ///
    /// Returns a failure if a file cannot be written.
    pub(crate) fn save(self, folder: &Path, name: &str) -> Result<String, Failure> {
        let write = |end: &str, bytes: &[u8]| {
            let path = folder.join(format!("{name}.{end}"));
            write_atomically(&path, |file| file.write_all(bytes))
                .map_err(|error| Failure::writing(&path, error))
        };
        write("svg", self.svg.as_bytes())?;
        let png = self.bytes(Format::Png).map_err(Failure::running)?;
        write("png", &png)?;
        Ok(self.svg)
    }
}

/// Returns the range of the axes of a diagram without a point.
const EMPTY: (f64, f64) = (0.0, 1.0);

/// Gives a diagram its size and the sizes of its letters: it is read on a telephone, and two of them stand
/// side by side on a desk.
fn styled(layout: Layout) -> Layout {
    layout
        .with_width(WIDTH)
        .with_height(HEIGHT)
        .with_title_size(15)
        .with_label_size(13)
        .with_tick_size(12)
        .with_body_size(12)
        .with_legend_position(LegendPosition::OutsideBottomColumns)
        .with_legend_box(false)
}

const WIDTH: f64 = 480.0;
const HEIGHT: f64 = 360.0;

/// The margin below the lowest text.
const MARGIN: f64 = 6.0;

/// Returns where the lowest text stands: a legend of several rows is taller than was planned for.
fn lowest_text(scene: &Scene) -> f64 {
    let texts = scene.elements.iter().filter_map(|element| match element {
        Primitive::Text { y, .. } => Some(*y),
        _ => None,
    });
    texts.fold(0.0, f64::max)
}

/// Returns a scene as SVG that scales, with cells as a picture.
fn svg(scene: &mut Scene) -> String {
    let cells = Cells::take(scene);
    let svg = SvgBackend::new().render_scene(scene);
    let view_box = format!("<svg viewBox=\"0 0 {} {}\"", scene.width, scene.height);
    let svg = svg.replacen("<svg", &view_box, 1);
    match cells {
        None => svg,
        Some(cells) => cells.put_back(scene, &svg),
    }
}

/// Returns whether an item is among the `most` of `count` that are drawn: all are if they are few, and of
/// many a part that is even over all of them, which multiples of the golden ratio are.
pub(crate) fn is_drawn(index: usize, count: usize, most: usize) -> bool {
    const GOLDEN: f64 = 0.618_033_988_749_894_9;
    (GOLDEN * index as f64).fract() * count as f64 <= most as f64
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_name_tells_the_format() {
        let of = |name: &str| Format::of_path(Path::new(name));
        assert_eq!(of("a/b.SVG"), Some(Format::Svg));
        assert_eq!(of("b.png"), Some(Format::Png));
        assert_eq!(of("b.pdf"), None);
        assert_eq!(of("svg"), None);
    }

    #[test]
    fn few_items_are_all_drawn_and_of_many_an_even_part() {
        let most = 4_000;
        assert!((0..most).all(|index| is_drawn(index, most, most)), "few");
        let count = 200_000;
        // Of each tenth, as a parameter of ten values has them, a tenth: to a few by the discrepancy
        // of the golden ratio, 1 + log₂ of the number.
        for remainder in 0..10 {
            let tenth = (0..count).filter(|index| index % 10 == remainder);
            let drawn = tenth.filter(|&index| is_drawn(index, count, most)).count();
            assert!(drawn.abs_diff(most / 10) <= 18, "{remainder}: {drawn}");
        }
    }

    #[test]
    fn a_drawing_is_saved_in_both_formats() {
        let folder = tempfile::tempdir().expect("a temporary folder");
        let chart =
            Chart::new("heights", ["x (mm)", "z (mm)"]).line("profile", [(0.0, 1.0), (1.0, 2.0)]);
        let svg = chart
            .draw()
            .save(folder.path(), "profile")
            .expect("the folder can be written");
        let read = |name: &str| std::fs::read(folder.path().join(name)).expect("the file is there");
        assert_eq!(read("profile.svg"), svg.as_bytes());
        assert_eq!(read("profile.png")[..8], *b"\x89PNG\r\n\x1a\n");
    }
}
