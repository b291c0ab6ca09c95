//! One page of diagrams: histogram, autocovariance and power spectrum beside the theory.

use std::path::Path;

use kuva::{
    PngBackend,
    backend::svg::SvgBackend,
    prelude::{
        Figure, Layout, LegendPosition, LinePlot, LineStyle, MarkerShape, Plot, ScatterPlot,
    },
    render::render::Scene,
};
use tem00_statistics::airy_autocovariance;

use super::curves::{Bin, Curves, Frequency, Lag, chat};

/// What was measured, what theory says and what was fitted.
const MEASURED: &str = "#1f5fa8";
const MEASURED_TOO: &str = "#d2701a";
const THEORY: &str = "#202020";
const FITTED: &str = "#a03040";

/// The pixels of a PNG per unit of the page.
const PNG_SCALE: f32 = 2.0;

/// The formats of the page, told apart by the end of the file's name.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum PageFormat {
    Svg,
    Png,
}

impl PageFormat {
    pub(super) fn of_path(path: &Path) -> Option<Self> {
        let extension = path.extension()?.to_str()?;
        [("svg", Self::Svg), ("png", Self::Png)]
            .into_iter()
            .find(|(name, _)| extension.eq_ignore_ascii_case(name))
            .map(|(_, format)| format)
    }
}

/// The content of the page.
#[derive(Clone, Copy, Debug)]
pub(super) struct Page<'a> {
    pub(super) title: &'a str,
    pub(super) curves: &'a Curves,
}

impl Page<'_> {
    /// Returns the page as a file of the format, or what prevents it.
    pub(super) fn render(&self, format: PageFormat) -> Result<Vec<u8>, String> {
        match format {
            PageFormat::Svg => Ok(SvgBackend::new().render_scene(&self.scene()).into_bytes()),
            PageFormat::Png => PngBackend::new()
                .with_scale(PNG_SCALE)
                .render_scene(&self.scene()),
        }
    }

    fn scene(&self) -> Scene {
        let panels = [
            self.histogram(),
            self.autocovariance(),
            self.power_spectrum(),
        ];
        let (plots, layouts) = panels.into_iter().unzip();
        Figure::new(1, 3)
            .with_title(self.title)
            .with_plots(plots)
            .with_layouts(layouts)
            .with_cell_size(460.0, 400.0)
            .render()
    }

    fn histogram(&self) -> Panel {
        let bins = &self.curves.histogram;
        let centre = |bin: &Bin| 0.5 * (bin.from + bin.to);
        let occupied = bins.iter().filter(|bin| bin.density > 0.0);
        let measured = occupied.clone().map(|bin| (centre(bin), bin.density));
        let lowest = occupied.fold(1.0, |low: f64, bin| low.min(bin.density));
        // Where the law lies far below one pixel per bin there is nothing to compare.
        let floor = 0.3 * lowest;
        let law = |density: fn(&Bin) -> Option<f64>| {
            let points = bins
                .iter()
                .filter_map(|bin| Some((centre(bin), density(bin)?)));
            points.filter(|point| point.1 > floor).collect()
        };
        let mut plots = vec![
            dots(measured.collect(), MEASURED, "measured"),
            line(law(|bin| Some(bin.exponential)), THEORY, "exponential"),
        ];
        if let Some(shape) = self.curves.gamma_shape {
            let label = format!("Gamma, M = {shape:.3}");
            plots.push(dashed(law(|bin| bin.gamma), FITTED, &label));
        }
        let axes = ["intensity / mean", "probability density"];
        let layout = layout(&plots, "Histogram", axes).with_log_y();
        (plots, layout)
    }

    fn autocovariance(&self) -> Panel {
        let lags = &self.curves.autocovariance;
        let cut = |along: fn(&Lag) -> f64| {
            let points = lags.iter().map(|lag| (f64_of(lag.lag), along(lag)));
            points.collect::<Vec<_>>()
        };
        let mut plots = vec![
            dots(cut(|lag| lag.x), MEASURED, "along x"),
            crosses(cut(|lag| lag.y), MEASURED_TOO, "along y"),
        ];
        if let Some([x, y]) = self.curves.speckle_size {
            let end = lags.last().map_or(0.0, |lag| f64_of(lag.lag));
            for (axis, size, color) in [("x", x, MEASURED), ("y", y, MEASURED_TOO)] {
                let airy = sampled(end, |lag| airy_autocovariance(lag / size));
                plots.push(line(
                    airy,
                    color,
                    &format!("Airy, {axis}: {size:.2} pixels"),
                ));
            }
        }
        let layout = layout(
            &plots,
            "Autocovariance",
            ["lag in pixels", "autocovariance"],
        );
        (plots, layout)
    }

    fn power_spectrum(&self) -> Panel {
        let rings = &self.curves.power_spectrum;
        let point = |ring: &Frequency| (ring.frequency, ring.power);
        let mut plots = vec![dots(
            rings.iter().map(point).collect(),
            MEASURED,
            "measured",
        )];
        if let Some([x, y]) = self.curves.speckle_size {
            let size = (x * y).sqrt();
            let end = rings.last().map_or(0.0, |ring| ring.frequency);
            let law = sampled(end, |frequency| chat(size, frequency));
            let label = format!("circular pupil, {:.2} pixels", size);
            plots.push(line(law, THEORY, &label));
        }
        let axes = ["cycles per pixel", "power, pixels² per variance"];
        let layout = layout(&plots, "Power spectrum", axes);
        (plots, layout)
    }
}

type Panel = (Vec<Plot>, Layout);

fn layout(plots: &[Plot], title: &str, axes: [&str; 2]) -> Layout {
    Layout::auto_from_plots(plots)
        .with_title(title)
        .with_x_label(axes[0])
        .with_y_label(axes[1])
        .with_legend_position(LegendPosition::InsideTopRight)
}

fn dots(points: Vec<(f64, f64)>, color: &str, legend: &str) -> Plot {
    let plot = ScatterPlot::new().with_data(points).with_color(color);
    plot.with_size(2.5).with_legend(legend).into()
}

fn crosses(points: Vec<(f64, f64)>, color: &str, legend: &str) -> Plot {
    let plot = ScatterPlot::new().with_data(points).with_color(color);
    let plot = plot.with_marker(MarkerShape::Cross).with_size(3.0);
    plot.with_legend(legend).into()
}

fn line(points: Vec<(f64, f64)>, color: &str, legend: &str) -> Plot {
    let plot = LinePlot::new().with_data(points).with_color(color);
    plot.with_stroke_width(1.4).with_legend(legend).into()
}

fn dashed(points: Vec<(f64, f64)>, color: &str, legend: &str) -> Plot {
    let plot = LinePlot::new().with_data(points).with_color(color);
    let plot = plot.with_line_style(LineStyle::Dashed);
    plot.with_stroke_width(1.4).with_legend(legend).into()
}

/// Samples a function from 0 to `end`.
fn sampled(end: f64, function: impl Fn(f64) -> f64) -> Vec<(f64, f64)> {
    const STEPS: u32 = 400;
    let position = |step: u32| end * f64::from(step) / f64::from(STEPS);
    (0..=STEPS)
        .map(|step| (position(step), function(position(step))))
        .collect()
}

#[expect(clippy::cast_precision_loss, reason = "lags are far below 2⁵²")]
const fn f64_of(lag: usize) -> f64 {
    lag as f64
}

#[cfg(test)]
mod tests {
    use super::*;

    fn curves() -> Curves {
        let bin = |from: f64| Bin {
            from,
            to: from + 0.5,
            density: (-from).exp(),
            exponential: (-from).exp(),
            gamma: Some((-from).exp()),
        };
        Curves {
            speckle_size: None,
            gamma_shape: Some(1.25),
            histogram: [0.0, 0.5, 1.0].map(bin).to_vec(),
            autocovariance: (0..9)
                .map(|lag| Lag {
                    lag,
                    x: 1.0 - 0.1 * f64_of(lag),
                    y: 1.0 - 0.1 * f64_of(lag),
                    airy: None,
                })
                .collect(),
            power_spectrum: [0.1, 0.2, 0.3]
                .map(|frequency| Frequency {
                    frequency,
                    power: 1.0,
                    chat: None,
                })
                .to_vec(),
        }
    }

    fn page(curves: &Curves) -> Page<'_> {
        Page {
            title: "speckle & <light>",
            curves,
        }
    }

    #[test]
    fn the_name_tells_the_format() {
        let of = |name: &str| PageFormat::of_path(Path::new(name));
        assert_eq!(of("a/b.SVG"), Some(PageFormat::Svg));
        assert_eq!(of("b.png"), Some(PageFormat::Png));
        assert_eq!(of("b.pdf"), None);
        assert_eq!(of("svg"), None);
    }

    #[test]
    fn a_page_has_three_panels_and_its_title() {
        let svg = page(&curves())
            .render(PageFormat::Svg)
            .expect("SVG is text");
        let svg = String::from_utf8(svg).expect("UTF-8");
        for text in [
            "speckle &amp; &lt;light&gt;",
            "Histogram",
            "Gamma, M = 1.250",
            "Autocovariance",
            "Power spectrum",
        ] {
            assert!(svg.contains(text), "{text} is on the page");
        }
        assert!(!svg.contains("NaN"), "every point has a place");
    }

    #[test]
    fn a_page_without_a_size_has_no_theory_of_it() {
        let svg = page(&curves())
            .render(PageFormat::Svg)
            .expect("SVG is text");
        let svg = String::from_utf8(svg).expect("UTF-8");
        assert!(!svg.contains("Airy") && !svg.contains("pupil"), "no size");
    }

    #[test]
    fn a_page_is_a_png_as_well() {
        let png = page(&curves())
            .render(PageFormat::Png)
            .expect("the page fits");
        assert_eq!(png[..8], *b"\x89PNG\r\n\x1a\n");
    }
}
