//! Points and lines over two axes.

use std::sync::Arc;

use kuva::prelude::{
    BandPlot, Figure, LegendPosition, LinePlot, LineStyle, MarkerShape, Plot, ScatterPlot,
    TickFormat,
};

use super::{
    Colour,
    colours::COMBINED,
    drawing::{Drawing, Panel, panel},
};
use crate::digits::number;

/// The largest number with a position on an axis: differences and squares of such numbers stay
/// finite.
const LARGEST: f64 = 1e100;

/// Points and lines over two axes, each linear or logarithmic.
///
/// A point that has no position on its axes, because it is not finite, beyond 1e100 or not positive
/// on a logarithmic axis, is left out, and breaks the line or the band that it belongs to.
#[derive(Clone, Debug)]
pub struct Chart {
    title: String,
    labels: [String; 2],
    log: [bool; 2],
    legend_inside: bool,
    series: Vec<Series>,
}

#[derive(Clone, Debug)]
struct Series {
    name: String,
    mark: Mark,
    colour: Colour,
    /// x, y and, for bands, the upper y.
    points: Vec<[f64; 3]>,
}

/// The look of a series.
#[derive(Clone, Debug)]
enum Mark {
    Curve(LineStyle),
    /// Marks of a size.
    Points(MarkerShape, f64),
    Band,
}

impl Chart {
    /// Starts a chart with the labels of its axes, across and up.
    pub fn new(title: &str, labels: [&str; 2]) -> Self {
        Self {
            title: title.to_owned(),
            labels: labels.map(String::from),
            log: [false; 2],
            legend_inside: false,
            series: Vec::new(),
        }
    }

    /// Adds a line through points.
    pub fn line(self, name: &str, points: impl IntoIterator<Item = (f64, f64)>) -> Self {
        self.with(name, Mark::Curve(LineStyle::Solid), points)
    }

    /// Adds a dashed line through points.
    pub fn dashed(self, name: &str, points: impl IntoIterator<Item = (f64, f64)>) -> Self {
        self.with(name, Mark::Curve(LineStyle::Dashed), points)
    }

    /// Adds a dot at each point.
    pub fn dots(self, name: &str, points: impl IntoIterator<Item = (f64, f64)>) -> Self {
        self.with(name, Mark::Points(MarkerShape::Circle, 2.5), points)
    }

    /// Adds a cross at each point.
    pub fn crosses(self, name: &str, points: impl IntoIterator<Item = (f64, f64)>) -> Self {
        self.with(name, Mark::Points(MarkerShape::Cross, 3.0), points)
    }

    /// Adds the area between two curves: x, lower y and upper y of each point. It has no entry in
    /// the legend: name the curve that it belongs to, as in "profile ± u".
    pub fn band(mut self, points: impl IntoIterator<Item = (f64, f64, f64)>) -> Self {
        let points = points.into_iter().map(<[f64; 3]>::from).collect();
        self.add("", Mark::Band, points);
        self
    }

    /// Draws the series added last in a colour.
    pub fn coloured(mut self, colour: Colour) -> Self {
        if let Some(series) = self.series.last_mut() {
            series.colour = colour;
        }
        self
    }

    /// Makes the axis across logarithmic.
    pub const fn log_x(mut self) -> Self {
        self.log[0] = true;
        self
    }

    /// Makes the axis up logarithmic.
    pub const fn log_y(mut self) -> Self {
        self.log[1] = true;
        self
    }

    /// Puts the legend over the data, at the top right: for charts side by side.
    pub const fn legend_inside(mut self) -> Self {
        self.legend_inside = true;
        self
    }

    /// Draws the chart.
    pub fn draw(self) -> Drawing {
        Drawing::of_panel(self.panel())
    }

    /// Draws charts side by side under a title.
    pub fn draw_row(title: &str, charts: Vec<Self>) -> Drawing {
        let columns = charts.len();
        let (plots, layouts) = charts.into_iter().map(Self::panel).unzip();
        Drawing::of_scene(
            Figure::new(1, columns)
                .with_title(title)
                .with_plots(plots)
                .with_layouts(layouts)
                .with_cell_size(460.0, 400.0)
                .render(),
        )
    }

    fn panel(self) -> Panel {
        let drawn = self
            .series
            .iter()
            .map(|series| (series, series.pieces(self.log)));
        let drawn: Vec<_> = drawn.collect();
        let plots = drawn
            .iter()
            .flat_map(|(series, pieces)| series.plots(pieces));
        let [x, y] = &self.labels;
        let (plots, mut layout) = panel(plots.collect(), &self.title, [x, y]);
        layout = layout.with_tick_format(TickFormat::Custom(Arc::new(number)));
        if self.legend_inside {
            layout = layout
                .with_legend_position(LegendPosition::InsideTopRight)
                .with_legend_box(true);
        }
        let points = || drawn.iter().flat_map(|(_, pieces)| pieces.iter().flatten());
        if self.log[0] && !plots.is_empty() {
            let (low, high) = log_range(points().map(|point| point[0]));
            layout.log_x = true;
            (layout.x_axis_min, layout.x_axis_max) = (Some(low), Some(high));
        }
        if self.log[1] && !plots.is_empty() {
            let (low, high) = log_range(points().flat_map(|&[_, low, high]| [low, high]));
            layout.log_y = true;
            (layout.y_axis_min, layout.y_axis_max) = (Some(low), Some(high));
        }
        (plots, layout)
    }

    fn with(
        mut self,
        name: &str,
        mark: Mark,
        points: impl IntoIterator<Item = (f64, f64)>,
    ) -> Self {
        let points = points.into_iter().map(|(x, y)| [x, y, y]).collect();
        self.add(name, mark, points);
        self
    }

    fn add(&mut self, name: &str, mark: Mark, points: Vec<[f64; 3]>) {
        self.series.push(Series {
            name: name.to_owned(),
            mark,
            colour: COMBINED,
            points,
        });
    }
}

impl Series {
    /// Returns the pieces between points without a position on their axes; marks are one piece.
    fn pieces(&self, [log_x, log_y]: [bool; 2]) -> Vec<Vec<[f64; 3]>> {
        let on_axis = |value: f64, log: bool| value.abs() <= LARGEST && (value > 0.0 || !log);
        let has_place = |&[x, low, high]: &[f64; 3]| {
            on_axis(x, log_x) && on_axis(low, log_y) && on_axis(high, log_y)
        };
        let pieces = self.points.split(|point| !has_place(point));
        let pieces = pieces.map(<[_]>::to_vec).filter(|piece| !piece.is_empty());
        let mut pieces: Vec<_> = pieces.collect();
        if let (Mark::Points(..), 1..) = (&self.mark, pieces.len()) {
            pieces = vec![pieces.concat()];
        }
        pieces
    }

    /// Returns the plots of each piece; only the first is in the legend.
    fn plots(&self, pieces: &[Vec<[f64; 3]>]) -> Vec<Plot> {
        let pieces = pieces.iter().enumerate();
        let names = pieces.map(|(index, piece)| (if index == 0 { &*self.name } else { "" }, piece));
        names.map(|(name, piece)| self.plot(name, piece)).collect()
    }

    fn plot(&self, name: &str, piece: &[[f64; 3]]) -> Plot {
        let places = piece.iter().map(|&[x, y, _]| (x, y));
        let column = |index: usize| piece.iter().map(move |point| point[index]);
        let colour = self.colour.light;
        // No line goes through a point alone.
        let mark = match &self.mark {
            Mark::Curve(_) if piece.len() == 1 => Mark::Points(MarkerShape::Circle, 1.5),
            mark => mark.clone(),
        };
        match mark {
            Mark::Band => BandPlot::new(column(0), column(1), column(2))
                .with_color(colour)
                .with_opacity(0.25)
                .into(),
            Mark::Points(marker, size) => {
                let plot = ScatterPlot::new().with_data(places).with_color(colour);
                let plot = plot.with_marker(marker).with_size(size);
                named(name, plot, ScatterPlot::with_legend).into()
            }
            Mark::Curve(style) => {
                let plot = LinePlot::new().with_data(places).with_color(colour);
                let plot = plot.with_line_style(style).with_stroke_width(1.4);
                named(name, plot, LinePlot::with_legend).into()
            }
        }
    }
}

/// Returns the range of a logarithmic axis: from 1, 2 or 5 times a power of ten below all numbers
/// to one above them, and not the whole decades, in which a few points would be lost.
fn log_range(numbers: impl Iterator<Item = f64>) -> (f64, f64) {
    let extent = |(low, high): (f64, f64), number| (low.min(number), high.max(number));
    let (low, high) = numbers.fold((f64::MAX, f64::MIN_POSITIVE), extent);
    let decade = |number: f64| 10.0_f64.powf(number.log10().floor());
    let at_most = |step: &f64| step * decade(low) <= low;
    let at_least = |step: &f64| step * decade(high) >= high;
    let below = [5.0, 2.0].into_iter().find(at_most).unwrap_or(1.0);
    let above = [1.0, 2.0, 5.0].into_iter().find(at_least).unwrap_or(10.0);
    let (from, to) = (below * decade(low), above * decade(high));
    if to > from {
        (from, to)
    } else {
        (0.5 * from, 2.0 * from)
    }
}

/// Enters a series that has a name into the legend.
fn named<P>(name: &str, plot: P, with_legend: impl Fn(P, String) -> P) -> P {
    if name.is_empty() {
        plot
    } else {
        with_legend(plot, name.to_owned())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn svg(chart: Chart) -> String {
        chart.draw().svg().to_owned()
    }

    fn chart() -> Chart {
        Chart::new("a < b & c", ["length (mm)", "deviation (µm)"])
    }

    #[test]
    fn a_chart_shows_its_words() {
        let text = svg(chart()
            .line("theory", [(0.0, 1.0), (1.0, 2.0)])
            .dots("measured", [(0.5, 1.4)])
            .band([(0.0, 0.5, 1.5), (1.0, 1.5, 2.5)]));
        let words = "a &lt; b &amp; c|length (mm)|deviation (µm)|theory|measured";
        for word in words.split('|') {
            assert!(text.contains(word), "{word} is on the chart");
        }
        assert!(
            text.starts_with("<svg viewBox=\"0 0 480 "),
            "it scales: {text}"
        );
    }

    #[test]
    fn points_without_a_place_are_left_out() {
        let points = [
            (1.0, f64::NAN),
            (f64::INFINITY, 1.0),
            (0.0, 1.0),
            (2.0, -1.0),
            (2.0, 3.0),
            (5.0, 4.0),
        ];
        let text = svg(chart().dots("", points).log_x().log_y());
        assert!(!text.contains("NaN") && !text.contains("inf"), "{text}");
        assert_eq!(
            text.matches("<circle").count(),
            2,
            "two points have a place"
        );
    }

    /// Returns the ends of the strokes of a drawing: the first and the last x of each.
    fn strokes(svg: &str) -> Vec<[f64; 2]> {
        let paths = svg.split("<path d=\"").skip(1);
        let paths = paths.filter_map(|rest| Some(rest.split_once('"')?.0));
        let ends = paths.map(|path| {
            let number = |word: &str| word.parse::<f64>().ok();
            let numbers: Vec<_> = path.split([' ', 'M', 'L']).filter_map(number).collect();
            [numbers[0], numbers[numbers.len() - 2]]
        });
        ends.collect()
    }

    #[test]
    fn a_missing_point_breaks_a_curve() {
        let curve = |gap: f64| {
            let height = move |x: f64| if (x - gap).abs() < 1.5 { f64::NAN } else { x };
            (0..20_u8).map(move |x| (f64::from(x), height(f64::from(x))))
        };
        for gap in [f64::INFINITY, 9.0] {
            let text = svg(chart()
                .line("u", curve(gap))
                .coloured(super::super::colours::UNCERTAINTY));
            let found = strokes(&text);
            assert_eq!(found.len(), if gap.is_finite() { 2 } else { 1 }, "{text}");
            if let [left, right] = found[..] {
                // Of 19 steps, three have no line: from 7 to 11 there is none.
                let step = (right[1] - left[0]) / 19.0;
                assert!(
                    (right[0] - left[1] - 4.0 * step).abs() < 0.1 * step,
                    "{found:?}"
                );
            }
            assert_eq!(text.matches(">u</text>").count(), 1, "once in the legend");
        }
        let bands = svg(chart().band((0..9_u8).map(|x| {
            let x = f64::from(x);
            (x, if (x - 4.0).abs() < 0.5 { f64::NAN } else { x }, x + 1.0)
        })));
        assert_eq!(strokes(&bands).len(), 2, "{bands}");
        let alone = [(0.0, 1.0), (1.0, f64::NAN), (2.0, 1.0), (3.0, 2.0)];
        let text = svg(chart().line("", alone));
        assert_eq!(text.matches("<circle").count(), 1, "a point alone is a dot");
    }

    #[test]
    fn a_chart_without_points_has_axes_all_the_same() {
        let text = svg(chart().line("nothing", [(f64::NAN, 0.0)]).log_x());
        assert!(
            text.contains("length (mm)") && !text.contains("NaN"),
            "{text}"
        );
    }

    #[test]
    fn logarithmic_axes_end_about_the_points() {
        for ((low, high), expected) in [
            ((3.0, 40.0), (2.0, 50.0)),
            ((10.0, 100.0), (10.0, 100.0)),
            ((0.7, 0.7), (0.5, 1.0)),
            ((2.0, 2.0), (1.0, 4.0)),
        ] {
            let (from, to) = log_range([low, high].into_iter());
            // Powers of ten are rounded.
            let near = |a: f64, b: f64| (a / b - 1.0).abs() < 1e-12;
            assert!(
                near(from, expected.0) && near(to, expected.1),
                "{from} … {to}"
            );
        }
    }
}
