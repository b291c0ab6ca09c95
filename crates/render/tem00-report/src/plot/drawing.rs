//! Drawings as SVG and PNG.

use std::{io::Write, path::Path};

use kuva::{
    PngBackend,
    backend::svg::SvgBackend,
    prelude::{Layout, LegendPosition, Plot},
    render::render::{Primitive, Scene, render_multiple},
};

use super::cells::Cells;
use crate::{failure::Failure, kind::of_ending, output, report::is_unwanted};

/// The pixels of a PNG per unit of the drawing.
const PNG_SCALE: f32 = 2.5;

/// The formats of a drawing, distinguished by the end of the file's name.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum PlotFormat {
    Svg,
    Png,
}

impl PlotFormat {
    pub fn of_path(path: &Path) -> Option<Self> {
        of_ending(path, &[("svg", Self::Svg), ("png", Self::Png)])
    }
}

/// Diagram under construction: its content and the axes around it.
pub(super) type Panel = (Vec<Plot>, Layout);

/// A finished drawing.
#[derive(Debug)]
pub struct Drawing {
    scene: Scene,
    svg: String,
}

impl Drawing {
    pub(super) fn of_panel((plots, layout): Panel) -> Self {
        Self::of_scene(render_multiple(plots, layout))
    }

    /// Creates a drawing from a scene that was drawn element by element.
    pub fn of_scene(mut scene: Scene) -> Self {
        scene.height = scene.height.max(lowest_text(&scene) + MARGIN);
        let svg = svg(&mut scene);
        Self { scene, svg }
    }

    /// Returns the drawing as SVG.
    pub fn svg(&self) -> &str {
        &self.svg
    }

    /// Returns the drawing as a file of the format, or what prevents it.
    pub fn bytes(&self, format: PlotFormat) -> Result<Vec<u8>, String> {
        match format {
            PlotFormat::Svg => Ok(self.svg.clone().into_bytes()),
            PlotFormat::Png => PngBackend::new()
                .with_scale(PNG_SCALE)
                .render_scene(&self.scene),
        }
    }

    /// Writes `name.svg` and `name.png` into the folder, and returns the text of the SVG.
    ///
    /// # Errors
    ///
    /// Returns a failure if a file cannot be written.
    pub fn save(self, folder: &Path, name: &str) -> Result<String, Failure> {
        let write = |end: &str, bytes: &[u8]| {
            let path = folder.join(format!("{name}.{end}"));
            output::save(&path, |file| file.write_all(bytes))
        };
        write("svg", self.svg.as_bytes())?;
        let png = self.bytes(PlotFormat::Png).map_err(Failure::running)?;
        write("png", &png)?;
        Ok(self.svg)
    }
}

/// Returns the plots with the axes around them; without plots the axes have a default range. The
/// diagram is read on a telephone, and two diagrams stand side by side on a desk: hence its size
/// and the sizes of its letters.
pub(super) fn panel(plots: Vec<Plot>, title: &str, [across, up]: [&str; 2]) -> Panel {
    const EMPTY: (f64, f64) = (0.0, 1.0);
    let layout = if plots.is_empty() {
        Layout::new(EMPTY, EMPTY)
    } else {
        Layout::auto_from_plots(&plots)
    };
    let layout = layout
        .with_width(WIDTH)
        .with_height(HEIGHT)
        .with_title_size(15)
        .with_label_size(13)
        .with_tick_size(12)
        .with_body_size(12)
        .with_legend_position(LegendPosition::OutsideBottomColumns)
        .with_legend_box(false)
        .with_title(title);
    (plots, layout.with_x_label(across).with_y_label(up))
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
    let svg = with_own_ids(&SvgBackend::new().render_scene(scene));
    let svg = svg.replace(is_unwanted, "\u{fffd}");
    let view_box = format!("<svg viewBox=\"0 0 {} {}\"", scene.width, scene.height);
    let svg = svg.replacen("<svg", &view_box, 1);
    match cells {
        None => svg,
        Some(cells) => cells.put_back(scene, &svg),
    }
}

/// Prefix that the drawing library gives to names of elements, before a number that counts through
/// the process.
const COUNTED: &str = "kuva-clip-";

/// Returns SVG whose elements have names that depend on it alone, and are its own among all
/// drawings of a page.
fn with_own_ids(svg: &str) -> String {
    let mut parts = svg.split(COUNTED);
    let mut texts = vec![parts.next().unwrap_or_default()];
    let (mut numbers, mut seen) = (Vec::new(), Vec::new());
    for part in parts {
        let end = part
            .find(|c: char| !c.is_ascii_digit())
            .unwrap_or(part.len());
        let (number, rest) = part.split_at(end);
        let first = seen.iter().position(|&other| other == number);
        numbers.push(first.unwrap_or(seen.len()));
        if first.is_none() {
            seen.push(number);
        }
        texts.push(rest);
    }
    let of = format!("{:x}", md5::compute(texts.concat()));
    let (start, rest) = texts.split_at(1);
    let named = numbers.iter().zip(rest);
    named.fold(start.concat(), |svg, (number, rest)| {
        format!("{svg}clip-{}-{number}{rest}", &of[..8])
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::plot::Chart;

    #[test]
    fn a_drawing_is_the_same_whatever_was_drawn_before() {
        let chart = |name: &str| {
            let line = [(0.0, 1.0), (1.0, 2.0)];
            Chart::new(name, ["x (mm)", "z (mm)"])
                .line("profile", line)
                .draw()
        };
        let first = chart("heights").svg().to_owned();
        let is_own = first.contains("clip-") && !first.contains(COUNTED);
        assert!(is_own, "{first}");
        let other = chart("other");
        assert_eq!(first, chart("heights").svg());
        let id = |svg: &str| svg.split("id=\"").nth(1).map(|rest| rest[..14].to_owned());
        assert_ne!(id(&first), id(other.svg()), "two drawings on a page");
    }

    #[test]
    fn no_name_makes_an_svg_ill_formed() {
        for bad in ["\u{ffff}", "\u{fffe}", "\u{1b}[0m", "\0", "\u{202e}"] {
            let chart = Chart::new(bad, [bad, bad]).line(bad, [(0.0, 1.0), (1.0, 2.0)]);
            let drawing = chart.draw();
            assert!(!drawing.svg().contains(is_unwanted), "{bad:?}");
            assert!(drawing.svg().contains('\u{fffd}'), "{bad:?}");
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
