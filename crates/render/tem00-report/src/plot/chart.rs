//! Points and lines over two axes.

use std::sync::Arc;

use kuva::prelude::{
    BandPlot, Figure, Layout, LegendPosition, LinePlot, LineStyle, MarkerShape, Plot, ScatterPlot,
    TickFormat,
};

use super::{
    Colour,
    colours::COMBINED,
    drawing::{Drawing, EMPTY, Panel, styled},
};
use crate::digits::number;

/// The largest number with a position on an axis: differences and squares of such are numbers still.
const LARGEST: f64 = 1e100;

/// Points and lines over two axes, each linear or logarithmic.
///
/// A point that has no position on its axes, because it is not finite, beyond 1e100 or not positive on a
/// logarithmic axis, is left out, and breaks the line or the band that it is of.
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
    /// The pieces between points without a position: x, y and, for bands, the upper y.
    pieces: Vec<Vec<[f64; 3]>>,
}

/// The style of a series.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Mark {
    Line,
    Dashed,
    Dots,
    Crosses,
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
        self.with(name, Mark::Line, points)
    }

    /// Adds a dashed line through points.
    pub fn dashed(self, name: &str, points: impl IntoIterator<Item = (f64, f64)>) -> Self {
        self.with(name, Mark::Dashed, points)
    }

    /// Adds a dot at each point.
    pub fn dots(self, name: &str, points: impl IntoIterator<Item = (f64, f64)>) -> Self {
        self.with(name, Mark::Dots, points)
    }

    /// Adds a cross at each point.
    pub fn crosses(self, name: &str, points: impl IntoIterator<Item = (f64, f64)>) -> Self {
        self.with(name, Mark::Crosses, points)
    }

    /// Adds the area between two curves: x, lower y and upper y of each point. It has no entry in the
    /// legend: name the curve that it belongs to, as in "profile ± u".
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
        let log = self.log;
        let mut series = self.series;
        series.iter_mut().for_each(|series| series.keep_places(log));
        series.retain(|series| !series.pieces.is_empty());
        let extents = [0, 1].map(|axis| extent(&series, axis));
        let plots: Vec<Plot> = series.iter().flat_map(Series::plots).collect();
        let mut layout = styled(if plots.is_empty() {
            Layout::new(EMPTY, EMPTY)
        } else {
            Layout::auto_from_plots(&plots)
        });
        if self.legend_inside {
            layout = layout
                .with_legend_position(LegendPosition::InsideTopRight)
                .with_legend_box(true);
        }
        if log[0] && !plots.is_empty() {
            let (low, high) = log_range(extents[0]);
            layout = layout
                .with_log_x()
                .with_x_axis_min(low)
                .with_x_axis_max(high);
        }
        if log[1] && !plots.is_empty() {
            let (low, high) = log_range(extents[1]);
            layout = layout
                .with_log_y()
                .with_y_axis_min(low)
                .with_y_axis_max(high);
        }
        layout = layout.with_tick_format(TickFormat::Custom(Arc::new(number)));
        let [x, y] = self.labels;
        let layout = layout.with_title(self.title);
        (plots, layout.with_x_label(x).with_y_label(y))
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
            pieces: vec![points],
        });
    }
}

impl Series {
    /// Leaves out the points that have no position on their axes.
    fn keep_places(&mut self, [log_x, log_y]: [bool; 2]) {
        let on_axis = |value: f64, log: bool| value.abs() <= LARGEST && (value > 0.0 || !log);
        let has_place = |&[x, low, high]: &[f64; 3]| {
            on_axis(x, log_x) && on_axis(low, log_y) && on_axis(high, log_y)
        };
        let pieces = self.pieces.iter();
        let pieces = pieces.flat_map(|points| points.split(|point| !has_place(point)));
        let pieces = pieces.filter(|piece| !piece.is_empty());
        self.pieces = match self.mark {
            Mark::Line | Mark::Dashed | Mark::Band => pieces.map(<[_]>::to_vec).collect(),
            Mark::Dots | Mark::Crosses => {
                let points: Vec<_> = pieces.flatten().copied().collect();
                Vec::from_iter((!points.is_empty()).then_some(points))
            }
        };
    }

    /// Returns what is drawn of each piece; only the first is in the legend.
    fn plots(&self) -> Vec<Plot> {
        let pieces = self.pieces.iter().enumerate();
        let names = pieces.map(|(index, piece)| (if index == 0 { &*self.name } else { "" }, piece));
        names.map(|(name, piece)| self.plot(name, piece)).collect()
    }

    fn plot(&self, name: &str, piece: &[[f64; 3]]) -> Plot {
        match self.mark {
            Mark::Band => self.area(piece),
            Mark::Crosses => self.scatter(name, piece, MarkerShape::Cross, 3.0),
            Mark::Dots => self.scatter(name, piece, MarkerShape::Circle, 2.5),
            // No line goes through a point alone.
            _ if piece.len() == 1 => self.scatter(name, piece, MarkerShape::Circle, 1.5),
            Mark::Line => self.curve(name, piece, LineStyle::Solid),
            Mark::Dashed => self.curve(name, piece, LineStyle::Dashed),
        }
    }

    fn curve(&self, name: &str, piece: &[[f64; 3]], style: LineStyle) -> Plot {
        let plot = LinePlot::new().with_data(places(piece));
        let plot = plot.with_line_style(style).with_stroke_width(1.4);
        let plot = plot.with_color(self.colour.light);
        named(name, plot, LinePlot::with_legend).into()
    }

    fn scatter(&self, name: &str, piece: &[[f64; 3]], marker: MarkerShape, size: f64) -> Plot {
        let plot = ScatterPlot::new().with_data(places(piece));
        let plot = plot.with_marker(marker).with_size(size);
        let plot = plot.with_color(self.colour.light);
        named(name, plot, ScatterPlot::with_legend).into()
    }

    fn area(&self, piece: &[[f64; 3]]) -> Plot {
        let column = |index: usize| piece.iter().map(move |point| point[index]);
        let plot = BandPlot::new(column(0), column(1), column(2));
        let plot = plot.with_color(self.colour.light).with_opacity(0.25);
        plot.into()
    }
}

fn places(piece: &[[f64; 3]]) -> impl Iterator<Item = (f64, f64)> {
    piece.iter().map(|&[x, y, _]| (x, y))
}

/// Returns the minimum and the maximum of all points on a logarithmic axis.
fn extent(series: &[Series], axis: usize) -> (f64, f64) {
    let points = series
        .iter()
        .flat_map(|series| series.pieces.iter().flatten());
    let numbers = points.flat_map(|point| if axis == 0 { &point[..1] } else { &point[1..] });
    numbers.fold((f64::MAX, f64::MIN_POSITIVE), |(low, high), &number| {
        (low.min(number), high.max(number))
    })
}

/// Returns the range of a logarithmic axis: from 1, 2 or 5 times a power of ten below all numbers to one
/// above them, and not the whole decades, in which a few points would be lost.
fn log_range((low, high): (f64, f64)) -> (f64, f64) {
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
        for word in [
            "a &lt; b &amp; c",
            "length (mm)",
            "deviation (µm)",
            "theory",
            "measured",
        ] {
            assert!(text.contains(word), "{word} is on the chart");
        }
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
    fn a_chart_scales() {
        let text = svg(chart().line("u", [(0.0, 1.0), (1.0, 2.0)]));
        assert!(text.starts_with("<svg viewBox=\"0 0 480 "), "{text}");
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
            let (from, to) = log_range((low, high));
            // Powers of ten are rounded.
            let near = |a: f64, b: f64| (a / b - 1.0).abs() < 1e-12;
            assert!(
                near(from, expected.0) && near(to, expected.1),
                "{from} … {to}"
            );
        }
    }
}
