//! Page of diagrams: histogram, autocovariance and power spectrum, compared with theory.

use tem00_report::plot::{
    Chart, Drawing,
    colours::{ALONG_X, ALONG_Y, FITTED, MEASURED, THEORY},
};
use tem00_statistics::airy_autocovariance;

use super::curves::{Bin, Curves, Frequency, Lag, chat};

/// The content of the page.
#[derive(Clone, Copy, Debug)]
pub(super) struct Page<'a> {
    pub(super) title: &'a str,
    pub(super) curves: &'a Curves,
}

impl Page<'_> {
    /// Draws the page.
    pub(super) fn draw(&self) -> Drawing {
        let charts = [
            self.histogram(),
            self.autocovariance(),
            self.power_spectrum(),
        ];
        Chart::draw_row(self.title, charts.map(Chart::legend_inside).into())
    }

    fn histogram(&self) -> Chart {
        let bins = &self.curves.histogram;
        let centre = |bin: &Bin| 0.5 * (bin.from + bin.to);
        let occupied = bins.iter().filter(|bin| bin.density > 0.0);
        let measured = occupied.clone().map(|bin| (centre(bin), bin.density));
        let lowest = occupied.fold(1.0, |low: f64, bin| low.min(bin.density));
        // Where the law lies far below one pixel per bin there is nothing to compare.
        let floor = 0.3 * lowest;
        let law = |density: fn(&Bin) -> Option<f64>| {
            let points = bins.iter();
            let points = points.filter_map(move |bin| Some((centre(bin), density(bin)?)));
            points.filter(move |point| point.1 > floor)
        };
        let axes = ["intensity / mean", "probability density"];
        let chart = Chart::new("Histogram", axes).log_y();
        let chart = chart.dots("measured", measured).coloured(MEASURED);
        let exponential = law(|bin| Some(bin.exponential));
        let chart = chart.line("exponential", exponential).coloured(THEORY);
        let Some(shape) = self.curves.gamma_shape else {
            return chart;
        };
        let label = format!("Gamma, M = {shape:.3}");
        chart.dashed(&label, law(|bin| bin.gamma)).coloured(FITTED)
    }

    fn autocovariance(&self) -> Chart {
        let lags = &self.curves.autocovariance;
        let cut = |along: fn(&Lag) -> f64| lags.iter().map(move |lag| (lag.lag as f64, along(lag)));
        let axes = ["lag in pixels", "autocovariance"];
        let chart = Chart::new("Autocovariance", axes);
        let chart = chart.dots("along x", cut(|lag| lag.x)).coloured(ALONG_X);
        let mut chart = chart.crosses("along y", cut(|lag| lag.y)).coloured(ALONG_Y);
        if let Some([x, y]) = self.curves.speckle_size {
            let end = lags.last().map_or(0.0, |lag| lag.lag as f64);
            for (axis, size, colour) in [("x", x, ALONG_X), ("y", y, ALONG_Y)] {
                let airy = sampled(end, |lag| airy_autocovariance(lag / size));
                let label = format!("Airy, {axis}: {size:.2} pixels");
                chart = chart.line(&label, airy).coloured(colour);
            }
        }
        chart
    }

    fn power_spectrum(&self) -> Chart {
        let rings = &self.curves.power_spectrum;
        let points = rings
            .iter()
            .map(|ring: &Frequency| (ring.frequency, ring.power));
        let axes = ["cycles per pixel", "power, pixels² per variance"];
        let chart = Chart::new("Power spectrum", axes);
        let chart = chart.dots("measured", points).coloured(MEASURED);
        let Some([x, y]) = self.curves.speckle_size else {
            return chart;
        };
        let size = (x * y).sqrt();
        let end = rings.last().map_or(0.0, |ring| ring.frequency);
        let label = format!("circular pupil, {size:.2} pixels");
        let law = sampled(end, |frequency| chat(size, frequency));
        chart.line(&label, law).coloured(THEORY)
    }
}

/// Samples a function from 0 to `end`.
fn sampled(end: f64, function: impl Fn(f64) -> f64) -> Vec<(f64, f64)> {
    const STEPS: u32 = 400;
    let position = |step: u32| end * f64::from(step) / f64::from(STEPS);
    (0..=STEPS)
        .map(|step| (position(step), function(position(step))))
        .collect()
}
