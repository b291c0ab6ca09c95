//! Diagrams: charts of points and lines, bars and heat maps, as SVG and PNG.

mod bars;
mod chart;
mod heat_map;

use std::{io::Write, path::Path};

use kuva::{
    PngBackend,
    backend::svg::SvgBackend,
    prelude::{Figure, Layout, Plot},
    render::render::{Scene, render_multiple},
};

pub(crate) use self::{bars::Bars, chart::Chart, heat_map::HeatMap};
use crate::{atomic::write_atomically, failure::Failure};

/// The pixels of a PNG per unit of the drawing.
const PNG_SCALE: f32 = 2.0;

/// The colours of series, told apart by most kinds of colour vision.
const COLOURS: [&str; 8] = [
    "#1f5fa8", "#d2701a", "#2a8a5a", "#a03040", "#7a4fa0", "#18a0b0", "#8a6030", "#808080",
];

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
pub(crate) struct Drawing(Scene);

impl Drawing {
    fn of_panel((plots, layout): Panel) -> Self {
        Self(render_multiple(plots, layout))
    }

    /// Puts charts side by side under a title.
    pub(crate) fn of_row(title: &str, charts: Vec<Chart>) -> Self {
        let columns = charts.len();
        let (plots, layouts) = charts.into_iter().map(Chart::panel).unzip();
        Self(
            Figure::new(1, columns)
                .with_title(title)
                .with_plots(plots)
                .with_layouts(layouts)
                .with_cell_size(460.0, 400.0)
                .render(),
        )
    }

    /// Returns the drawing as SVG.
    pub(crate) fn svg(&self) -> String {
        SvgBackend::new().render_scene(&self.0)
    }

    /// Returns the drawing as a file of the format, or what prevents it.
    pub(crate) fn bytes(&self, format: Format) -> Result<Vec<u8>, String> {
        match format {
            Format::Svg => Ok(self.svg().into_bytes()),
            Format::Png => PngBackend::new()
                .with_scale(PNG_SCALE)
                .render_scene(&self.0),
        }
    }

    /// Writes `name.svg` and `name.png` into the folder, and returns the text of the SVG.
    ///
    /// # Errors
    ///
    /// Returns a failure if a file cannot be written.
    pub(crate) fn save(&self, folder: &Path, name: &str) -> Result<String, Failure> {
        let svg = self.svg();
        let write = |end: &str, bytes: &[u8]| {
            let path = folder.join(format!("{name}.{end}"));
            write_atomically(&path, |file| file.write_all(bytes))
                .map_err(|error| Failure::writing(&path, error))
        };
        write("svg", svg.as_bytes())?;
        let png = self.bytes(Format::Png).map_err(Failure::running)?;
        write("png", &png)?;
        Ok(svg)
    }
}

/// Returns the range of the axes of a diagram without a point.
const EMPTY: (f64, f64) = (0.0, 1.0);

/// Where a column of series stands, beside the data.
const LEGEND: kuva::prelude::LegendPosition = kuva::prelude::LegendPosition::OutsideRightTop;

fn colour(index: usize) -> &'static str {
    COLOURS[index % COLOURS.len()]
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
