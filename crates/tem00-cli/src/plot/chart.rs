//! Points and lines over two axes.

use std::sync::Arc;

use kuva::prelude::{
    BandPlot, Layout, LegendPosition, LinePlot, LineStyle, MarkerShape, Plot, ScatterPlot,
    TickFormat,
};

use super::{Drawing, EMPTY, LEGEND, Panel, colour};
use crate::table::number;

/// The largest number with a place on an axis: differences and squares of such are numbers still.
const LARGEST: f64 = 1e100;

/// Points and lines over two axes, each linear or logarithmic.
///
/// A point that has no place on its axes, because it is not finite, beyond 1e100 or not positive on a
/// logarithmic axis, is left out.
#[derive(Clone, Debug)]
pub(crate) struct Chart {
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
    colour: String,
    /// x, y and, for bands, the upper y.
    points: Vec<[f64; 3]>,
}

/// How a series is drawn.
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
    pub(crate) fn new(title: &str, labels: [&str; 2]) -> Self {
        Self {
            title: title.to_owned(),
            labels: labels.map(String::from),
            log: [false; 2],
            legend_inside: false,
            series: Vec::new(),
        }
    }

    /// Adds a line through points.
    pub(crate) fn line(self, name: &str, points: impl IntoIterator<Item = (f64, f64)>) -> Self {
        self.with(name, Mark::Line, points)
    }

    /// Adds a dashed line through points.
    pub(crate) fn dashed(self, name: &str, points: impl IntoIterator<Item = (f64, f64)>) -> Self {
        self.with(name, Mark::Dashed, points)
    }

    /// Adds a dot at each point.
    pub(crate) fn dots(self, name: &str, points: impl IntoIterator<Item = (f64, f64)>) -> Self {
        self.with(name, Mark::Dots, points)
    }

    /// Adds a cross at each point.
    pub(crate) fn crosses(self, name: &str, points: impl IntoIterator<Item = (f64, f64)>) -> Self {
        self.with(name, Mark::Crosses, points)
    }

    /// Adds the area between two curves: x, lower y and upper y of each point. It has no place in the
    /// legend: name the curve that it belongs to, as in "profile ± u".
    pub(crate) fn band(mut self, points: impl IntoIterator<Item = (f64, f64, f64)>) -> Self {
        let points = points.into_iter().map(<[f64; 3]>::from).collect();
        self.add("", Mark::Band, points);
        self
    }

    /// Draws the series added last in a colour of CSS.
    pub(crate) fn coloured(mut self, colour: &str) -> Self {
        if let Some(series) = self.series.last_mut() {
            colour.clone_into(&mut series.colour);
        }
        self
    }

    /// Makes the axis across logarithmic.
    pub(crate) const fn log_x(mut self) -> Self {
        self.log[0] = true;
        self
    }

    /// Makes the axis up logarithmic.
    pub(crate) const fn log_y(mut self) -> Self {
        self.log[1] = true;
        self
    }

    /// Puts the legend over the data, at the top right: for charts side by side.
    pub(crate) const fn legend_inside(mut self) -> Self {
        self.legend_inside = true;
        self
    }

    /// Draws the chart.
    pub(crate) fn draw(self) -> Drawing {
        Drawing::of_panel(self.panel())
    }

    pub(super) fn panel(self) -> Panel {
        let log = self.log;
        let legend = if self.legend_inside {
            LegendPosition::InsideTopRight
        } else {
            LEGEND
        };
        let mut series = self.series;
        series.iter_mut().for_each(|series| series.keep_places(log));
        series.retain(|series| !series.points.is_empty());
        let extents = [0, 1].map(|axis| extent(&series, axis));
        let plots: Vec<Plot> = series.iter().map(Series::plot).collect();
        let mut layout = if plots.is_empty() {
            Layout::new(EMPTY, EMPTY)
        } else {
            Layout::auto_from_plots(&plots).with_legend_position(legend)
        };
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
            colour: colour(self.series.len()).to_owned(),
            points,
        });
    }
}

impl Series {
    /// Leaves out the points that have no place on their axes.
    fn keep_places(&mut self, [log_x, log_y]: [bool; 2]) {
        let on_axis = |value: f64, log: bool| value.abs() <= LARGEST && (value > 0.0 || !log);
        self.points.retain(|&[x, low, high]| {
            on_axis(x, log_x) && on_axis(low, log_y) && on_axis(high, log_y)
        });
    }

    fn plot(&self) -> Plot {
        match self.mark {
            Mark::Line => self.curve(LineStyle::Solid),
            Mark::Dashed => self.curve(LineStyle::Dashed),
            Mark::Dots => self.scatter(MarkerShape::Circle, 2.5),
            Mark::Crosses => self.scatter(MarkerShape::Cross, 3.0),
            Mark::Band => self.area(),
        }
    }

    fn places(&self) -> impl Iterator<Item = (f64, f64)> {
        self.points.iter().map(|&[x, y, _]| (x, y))
    }

    fn curve(&self, style: LineStyle) -> Plot {
        let plot = LinePlot::new().with_data(self.places());
        let plot = plot.with_line_style(style).with_stroke_width(1.4);
        let plot = plot.with_color(&self.colour);
        named(&self.name, plot, LinePlot::with_legend).into()
    }

    fn scatter(&self, marker: MarkerShape, size: f64) -> Plot {
        let plot = ScatterPlot::new().with_data(self.places());
        let plot = plot.with_marker(marker).with_size(size);
        let plot = plot.with_color(&self.colour);
        named(&self.name, plot, ScatterPlot::with_legend).into()
    }

    fn area(&self) -> Plot {
        let column = |index: usize| self.points.iter().map(move |point| point[index]);
        let plot = BandPlot::new(column(0), column(1), column(2));
        plot.with_color(&self.colour).with_opacity(0.25).into()
    }
}

/// Returns the least and the greatest number of all points on a logarithmic axis.
fn extent(series: &[Series], axis: usize) -> (f64, f64) {
    let points = series.iter().flat_map(|series| &series.points);
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
        chart.draw().svg()
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
