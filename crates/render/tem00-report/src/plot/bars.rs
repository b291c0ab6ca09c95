//! Bars over categories.

use kuva::prelude::{BarPlot, Plot};

use super::{
    Colour,
    drawing::{Drawing, Panel, panel},
};

/// Bars over categories, one bar per series in each.
#[derive(Clone, Debug)]
pub struct Bars {
    title: String,
    value_label: String,
    series: Vec<(String, Colour)>,
    groups: Vec<(String, Vec<f64>)>,
}

impl Bars {
    /// Starts bars of the series, each of a name and a colour, with the label of the axis of
    /// values; one series needs no name.
    pub fn new(title: &str, value_label: &str, series: &[(&str, Colour)]) -> Self {
        Self {
            title: title.to_owned(),
            value_label: value_label.to_owned(),
            series: series
                .iter()
                .map(|&(name, colour)| (name.to_owned(), colour))
                .collect(),
            groups: Vec::new(),
        }
    }

    /// Adds a category with the value of each series; a value that is not finite has no bar.
    pub fn group(mut self, name: &str, values: &[f64]) -> Self {
        let bar = |&value: &f64| if value.is_finite() { value } else { 0.0 };
        let values = values.iter().map(bar).collect();
        self.groups.push((name.to_owned(), values));
        self
    }

    /// Draws the bars.
    pub fn draw(self) -> Drawing {
        Drawing::of_panel(self.panel())
    }

    fn panel(self) -> Panel {
        let empty = self.groups.is_empty();
        let mut bars = BarPlot::new();
        for (name, values) in self.groups {
            let colours = self.series.iter().map(|(_, colour)| colour.light);
            bars = bars.with_group(name, values.into_iter().zip(colours));
        }
        if self.series.len() > 1 {
            bars = bars.with_legend(self.series.iter().map(|(name, _)| name.as_str()).collect());
        }
        let plots = if empty {
            Vec::new()
        } else {
            vec![Plot::from(bars)]
        };
        let (plots, mut layout) = panel(plots, &self.title, ["", &self.value_label]);
        layout.x_label = None;
        (plots, layout.with_x_tick_rotate(-35.0))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::plot::colours::{FORMULAS, TRIALS};

    #[test]
    fn bars_show_their_words() {
        let series = [("analytic", FORMULAS), ("Monte Carlo", TRIALS)];
        let bars = Bars::new("contributions", "u (µm)", &series);
        let bars = bars.group("speckle", &[3.0, 3.1]);
        let drawing = bars.group("shot noise", &[0.2, f64::NAN]).draw();
        let svg = drawing.svg();
        let words = "contributions|u (µm)|analytic|Monte Carlo|speckle|shot noise";
        for word in words.split('|') {
            assert!(svg.contains(word), "{word} is on the chart");
        }
        assert!(!svg.contains("NaN"), "{svg}");
    }

    #[test]
    fn no_bars_are_no_panic() {
        let drawing = Bars::new("nothing", "u (µm)", &[("", FORMULAS)]).draw();
        assert!(drawing.svg().contains("nothing"), "{}", drawing.svg());
    }
}
