//! `tem00 stats`: the speckle in an image of any origin.

mod curves;
mod findings;
mod page;

use std::{io::Write, path::Path};

use tem00_numerics::Grid;
use tem00_report::{
    failure::Failure,
    image::{LoadedImage, Reading, read_image},
    kind::{Kind, wrong_or},
    output::{self, note},
    plot::Format,
    report::Report,
};
use tem00_statistics::{
    Boundary, Contrast, Moments, SpeckleSize, StatisticsError, autocovariance, estimate::FlatImage,
    test::GreyLevels,
};

use crate::{
    args::StatsArgs,
    comparison::{self, Row},
};
use curves::{Curves, Measured};
use findings::Findings;

/// The fewest pixels along an axis that hold a speckle and its surroundings.
const FEWEST_PIXELS: usize = 8;

/// The window of the local mean in speckle sizes, by default: it takes 0.3 % of the
/// variance, which is put back.
const WINDOW: f64 = 20.0;

/// The smallest window in speckle sizes that is taken by default.
const MIN_WINDOW: f64 = 8.0;

/// The smallest window in speckle sizes for which what is taken is known.
const SMALLEST_WINDOW: f64 = 6.0;
/// The bytes that it takes to measure a pixel, most of them for the lags of the autocovariance, of which
/// there are four for each.
const BYTES_PER_PIXEL: u64 = 100;

/// The statistics of an image.
#[derive(Debug)]
struct Measurement {
    image: String,
    width: usize,
    height: usize,
    interpretation: String,
    rows: Vec<Row>,
    warnings: Vec<String>,
    assumptions: Vec<String>,
    curves: Curves,
}

/// Measures an image, prints the table, or JSON, and draws the page asked for.
///
/// # Errors
///
/// Returns a failure if the image cannot be read or holds no speckle to measure, or if the page
/// cannot be written.
pub(crate) fn run(args: &StatsArgs, out: &mut impl Write) -> Result<(), Failure> {
    let cannot = |error: &dyn core::fmt::Display, help: &str| {
        Failure::input(format!("{}: {error}", args.image.display()), help)
    };
    let plot = args.plot.as_deref().map(plot_file).transpose()?;
    let reading = Reading {
        channel: args.channel.as_deref(),
        transfer: args.transfer,
        black_level: args.black_level,
        crop: args.crop,
    };
    let image = read_image(&args.image, &reading).map_err(|error| {
        let help = "give an image of light, and a --crop inside it";
        wrong_or(&args.image, Kind::Image, || cannot(&error, help))
    })?;
    let (width, height) = (image.values.width(), image.values.height());
    if width.min(height) < FEWEST_PIXELS {
        let error = format!("the image has {width} × {height} pixels");
        let help = format!("speckle needs at least {FEWEST_PIXELS} pixels along either axis");
        return Err(cannot(&error, &help));
    }
    let pixels = (width * height) as u64;
    let name = args.image.display().to_string();
    let help = "--crop takes a part, which shows the same speckle";
    output::check_room(&name, pixels * BYTES_PER_PIXEL, help)?;
    let pool = output::thread_pool(None)?;
    let measurement = pool.install(|| measurement(args, &image))?;
    if let Some((path, format)) = plot {
        draw(&measurement, path, format)?;
    }
    if !args.json {
        note(&format!(
            "{}: {}",
            measurement.image, measurement.interpretation
        ));
    }
    measurement.report().print(args.json, &[], out)
}

/// Measures an image, flattened if that was asked for.
fn measurement(args: &StatsArgs, image: &LoadedImage) -> Result<Measurement, Failure> {
    let cannot = |error: &dyn core::fmt::Display, help: &str| {
        Failure::input(format!("{}: {error}", args.image.display()), help)
    };
    let help = "give an image that light and speckle fill, or a part of one with --crop; --flatten divides by uneven light";
    let flat = match args.flatten {
        Some(window) => Some(flattened(&image.values, window).map_err(|error| {
            cannot(
                &error,
                "take a brighter part with --crop, or another window",
            )
        })?),
        None => None,
    };
    let is_raw = args.black_level.is_none();
    measure(&args.image, image, (flat.as_ref(), is_raw)).map_err(|error| cannot(&error, help))
}

/// Returns the file of the page and its format, if it can be written.
fn plot_file(path: &Path) -> Result<(&Path, Format), Failure> {
    let format = Format::of_path(path).ok_or_else(|| {
        Failure::input(
            format!("{} names no known format of a page", path.display()),
            "end the name in .svg or .png",
        )
    })?;
    tem00_report::atomic::probe_writable(path).map_err(|error| {
        Failure::input(
            format!("cannot write {}: {error}", path.display()),
            "name a file in a folder that exists and may be written",
        )
    })?;
    Ok((path, format))
}

fn draw(measurement: &Measurement, path: &Path, format: Format) -> Result<(), Failure> {
    let page = page::Page {
        title: &measurement.image,
        curves: &measurement.curves,
    };
    let bytes = page
        .draw()
        .bytes(format)
        .map_err(|error| Failure::writing(path, error))?;
    tem00_report::atomic::write_atomically(path, |file| file.write_all(&bytes))
        .map_err(|error| Failure::writing(path, error))
}

impl Measurement {
    fn report(&self) -> Report {
        let mut report = Report::new(format!("{}: the speckle of an image", self.image));
        report.data("image", &self.image);
        report.data("width", self.width);
        report.data("height", self.height);
        report.data("interpretation", &self.interpretation);
        report.data("curves", &self.curves);
        report
            .section("Statistics")
            .table(comparison::table(&self.rows));
        report.verdict(comparison::conclusion(&self.rows));
        self.warnings.iter().for_each(|line| report.warning(line));
        self.assumptions.iter().for_each(|line| report.note(line));
        report
    }
}

/// Divides an image by its mean over windows of so many pixels, or as many as its speckle wants.
fn flattened(image: &Grid<f32>, window: Option<usize>) -> Result<FlatImage, String> {
    let words = |error: StatisticsError| error.to_string();
    let shorter = image.width().min(image.height());
    let chosen = match window {
        Some(window) => window,
        None => {
            let (size, largest) = size_in_light(image).map_err(words)?;
            let wanted = pixels(WINDOW * size).min(largest);
            wanted.max(pixels(MIN_WINDOW * size)).min(shorter)
        }
    };
    let flat = FlatImage::new(image, chosen).map_err(words)?;
    let size = size_in(&flat).map_err(words)?;
    let smallest = pixels(SMALLEST_WINDOW * size);
    if window.unwrap_or(shorter) < smallest {
        return Err(format!(
            "the local mean must be taken over {smallest} pixels at least, 6 speckle sizes of {size:.2} \
             pixels, got {}",
            window.unwrap_or(shorter)
        ));
    }
    Ok(flat)
}

/// Returns the size of the speckle in uneven light, and the largest window that follows the light.
///
/// Light makes speckles seem larger than they are: it is taken out before they are measured. Where the image does not
/// hold eight of what is left, that is light as well, and smaller windows are tried until speckle fills them.
fn size_in_light(image: &Grid<f32>) -> Result<(f64, usize), StatisticsError> {
    let shorter = image.width().min(image.height());
    let size_over = |window| size_in(&FlatImage::new(image, window)?);
    let coarse = size_over(shorter / 4);
    if coarse
        .as_ref()
        .is_ok_and(|size| MIN_WINDOW * size <= shorter as f64)
    {
        // Enough windows to follow the light of a small image.
        return coarse.map(|size| (size, shorter / 3));
    }
    let windows = core::iter::successors(Some(shorter / 8), |window| Some(window / 2));
    let mut filled = windows
        .take_while(|&window| window as f64 >= SMALLEST_WINDOW)
        .filter_map(|window| Some((size_over(window).ok()?, window)))
        .filter(|&(size, window)| SMALLEST_WINDOW * size <= window as f64);
    filled.next().map_or_else(|| Ok((coarse?, shorter)), Ok)
}

/// Returns the speckle size of a flat image, or a pixel where speckles are smaller.
fn size_in(flat: &FlatImage) -> Result<f64, StatisticsError> {
    match SpeckleSize::from_image(flat.values(), Boundary::Finite) {
        Ok(size) => Ok(size.mean()),
        Err(StatisticsError::Unresolved { .. }) => Ok(1.0),
        Err(error) => Err(error),
    }
}

#[expect(
    clippy::cast_possible_truncation,
    clippy::cast_sign_loss,
    reason = "a few speckle sizes, which are positive and below the size of the image"
)]
fn pixels(length: f64) -> usize {
    length.ceil() as usize
}

fn measure(
    path: &Path,
    image: &LoadedImage,
    (flat, is_raw): (Option<&FlatImage>, bool),
) -> Result<Measurement, StatisticsError> {
    let original = GreyLevels::from_values(image.values.values());
    let values = flat.map_or(&image.values, FlatImage::values);
    // Quotients lie between the levels.
    let levels = original.as_ref().filter(|_| flat.is_none());
    let mut found = Findings {
        values,
        flat,
        levels,
        mean: Moments::from_samples(values.values())?.mean(),
        contrast: Contrast::from_samples(values.values())?,
        is_even: true,
        rows: Vec::new(),
        warnings: Vec::new(),
        assumptions: Vec::new(),
    };
    let mean = Moments::from_samples(image.values.values())?.mean();
    found.brightness(mean, image);
    let lags = autocovariance(values, Boundary::Finite)?;
    let size = found.size(&lags)?;
    found.evenness(&lags, size)?;
    if is_raw && found.is_even && flat.is_none() {
        found.pedestal(image, original.as_ref())?;
    }
    found.contrast(size)?;
    found.size_rows(size);
    let fit = found.distribution(size)?;
    let measured = Measured {
        values,
        levels,
        mean: found.mean,
        contrast: found.contrast.value(),
        size,
        gamma: fit.and_then(|fit| fit.distribution().ok()),
    };
    Ok(Measurement {
        image: path.display().to_string(),
        width: values.width(),
        height: values.height(),
        interpretation: image.interpretation.clone(),
        curves: measured.curves(&lags)?,
        rows: found.rows,
        warnings: found.warnings,
        assumptions: found.assumptions,
    })
}

#[cfg(test)]
mod tests {
    use tem00_numerics::Grid;
    use tem00_speckle::PupilField;

    use super::*;
    use crate::comparison::Expectation;

    fn measured(values: Grid<f32>) -> Measurement {
        measure(Path::new("pattern"), &loaded(values), (None, true)).expect("an image of speckle")
    }

    fn loaded(values: Grid<f32>) -> LoadedImage {
        LoadedImage {
            values,
            interpretation: "computed".into(),
            saturated: None,
            unit: Some(1.0),
            step: None,
        }
    }

    fn row<'a>(found: &'a Measurement, quantity: &str) -> &'a Row {
        let mut rows = found.rows.iter();
        let row = rows.find(|row| row.quantity == quantity);
        row.expect("the row is there")
    }

    fn value(found: &Measurement, quantity: &str) -> f64 {
        row(found, quantity).measured
    }

    /// Returns the difference from theory in tolerances.
    fn deviation(found: &Measurement, quantity: &str) -> f64 {
        match row(found, quantity).theory {
            Expectation::Near { value, tolerance } => {
                (row(found, quantity).measured - value).abs() / tolerance
            }
            _ => panic!("{quantity} has a theory"),
        }
    }

    fn drawn(measurement: &Measurement) -> String {
        let page = page::Page {
            title: "speckle & <light>",
            curves: &measurement.curves,
        };
        page.draw().svg().to_owned()
    }

    /// A window out of a pattern with speckles of 4 samples, and a brightness of its own.
    fn window(seed: u64) -> Grid<f32> {
        let pattern = PupilField::new(512, 128, seed).expect("valid").pattern();
        Grid::from_fn(400, 300, |x, y| 7.0 * pattern.values()[(x, y)])
    }

    #[test]
    fn fully_developed_speckle_is_recognised() {
        let found = measured(window(3));
        assert!(deviation(&found, "contrast") < 1.0, "{found:?}");
        // The size spreads by 0.58 / n; the window is at least 75 speckles wide: 3 % are 4 σ.
        for axis in ["x", "y"] {
            let size = value(&found, &format!("speckle size {axis} (pixels)"));
            assert!(
                (size / 4.0 - 1.0).abs() < 0.031,
                "speckle size {axis} is {size}"
            );
        }
        assert!(
            value(&found, "KS p-value of exponential") > 1e-3,
            "{found:?}"
        );
    }

    #[test]
    fn averaged_speckle_is_gamma_and_not_exponential() {
        let (a, b) = (window(4), window(5));
        let sum = Grid::from_fn(400, 300, |x, y| a[(x, y)] + b[(x, y)]);
        let found = measured(sum);
        assert!(
            value(&found, "KS p-value of exponential") < 1e-6,
            "{found:?}"
        );
        assert!(value(&found, "KS p-value of Gamma") > 1e-3, "{found:?}");
        // The shape is 2 to the error that is stated, and some 3/n of bias.
        let error = value(&found, "its standard error");
        assert!(
            (value(&found, "shape of Gamma") - 2.0).abs() < 4.0 * error + 1e-3,
            "{found:?}"
        );
        let page = drawn(&found);
        for text in [
            "speckle &amp; &lt;light&gt;",
            "Histogram",
            "Gamma, M = ",
            "Autocovariance",
            "Airy, x",
            "Power spectrum",
        ] {
            assert!(page.contains(text), "{text} is on the page");
        }
        assert!(!page.contains("NaN"), "every point has a place");
    }

    #[test]
    fn speckle_below_a_pixel_is_measured_without_a_size() {
        let pattern = PupilField::new(512, 256, 6).expect("valid").pattern();
        // Every fifth sample at a speckle size of 2: nothing correlates.
        let sparse = Grid::from_fn(100, 100, |x, y| pattern.values()[(5 * x, 5 * y)]);
        let found = measured(sparse);
        let mut quantities = found.rows.iter().map(|row| &row.quantity);
        assert!(quantities.all(|name| !name.contains("size")), "{found:?}");
        let page = drawn(&found);
        assert!(!page.contains("Airy") && !page.contains("pupil"), "no size");
        assert!(
            value(&found, "KS p-value of exponential") > 1e-3,
            "{found:?}"
        );
    }

    #[test]
    fn rounding_to_few_grey_levels_is_no_deviation() {
        for (seed, mean) in [(7, 0.5), (8, 3.0), (9, 30.0)] {
            let light = window(seed).map(|value| (value / 7.0 * mean).round());
            let found = measured(light);
            for test in ["KS", "χ²"] {
                let p_value = value(&found, &format!("{test} p-value of exponential"));
                assert!(p_value > 1e-3, "{test} at {mean} levels: {found:?}");
            }
            let off = deviation(&found, "contrast");
            assert!(off < 1.0, "{off} at {mean} levels");
        }
    }

    #[test]
    fn black_pixels_of_a_rounded_image_are_light_below_half_a_level() {
        let found = measured(window(9).map(|value| (value / 7.0 * 30.0).round()));
        let (shape, error) = ("shape of Gamma", "its standard error");
        let [shape, error] = [shape, error].map(|quantity| row(&found, quantity).measured);
        assert!((shape - 1.0).abs() < 4.0 * error, "{shape} ± {error}");
        let none = |note: &String| !note.contains("some samples are 0");
        assert!(found.assumptions.iter().all(none), "{found:?}");
    }

    #[test]
    fn few_grey_levels_allow_no_fit() {
        let found = measured(window(8).map(|value| (value / 7.0 * 3.0).round()));
        let quantities = found.rows.iter().map(|row| &row.quantity);
        let mut fitted =
            quantities.filter(|name| name.contains("Gamma") || name.starts_with("contrast, if"));
        assert_eq!(fitted.next(), None, "three levels");
    }

    /// The warning of a pedestal, if there is one.
    fn pedestal(values: Grid<f32>) -> Option<String> {
        let mut warnings = measured(values).warnings.into_iter();
        warnings.find(|warning| warning.contains("--black-level"))
    }

    #[test]
    fn a_pedestal_is_told_by_the_darkest_values() {
        // A tenth of the mean of 3500 to thirty times that of 70 over a black level of 64 and more.
        for (mean, level) in [
            (3_500.0, 350.0),
            (300.0, 64.0),
            (70.0, 64.0),
            (200.0, 6_000.0),
        ] {
            let raw = window(21).map(|value| (value / 7.0 * mean + level).round());
            let told = pedestal(raw).expect("a warning");
            let mut words = told.split("--black-level ").nth(1).into_iter();
            let number = words.find_map(|rest| rest.split(' ').next()?.parse::<f32>().ok());
            let number = number.expect("a number");
            // A thousandth of the pixels have less than a thousandth of the mean.
            let is_near = (number - level).abs() < 2e-3 * mean + 1.0;
            assert!(is_near, "{mean} + {level}: {told}");
        }
        let two = |degree: f32| {
            let (a, b) = (window(22), window(23));
            Grid::from_fn(400, 300, |x, y| a[(x, y)] + degree * b[(x, y)])
        };
        let many = |count: u64| {
            let patterns: Vec<_> = (30..30 + count).map(window).collect();
            Grid::from_fn(400, 300, |x, y| {
                patterns.iter().map(|p| p[(x, y)]).sum::<f32>()
            })
        };
        let coarse = |mean: f32| window(24).map(|value| (value / 7.0 * mean).round());
        for (name, values) in [
            ("one pattern", window(21)),
            ("two patterns", two(1.0)),
            ("partly polarised", two(0.3)),
            ("five patterns", many(5)),
            ("twenty patterns", many(20)),
            ("a mean of 3 levels", coarse(3.0)),
            ("a mean of 40 levels", coarse(40.0)),
        ] {
            assert_eq!(pedestal(values), None, "{name}");
        }
    }

    #[test]
    fn pixels_without_gaps_see_the_contrast_of_their_size() {
        let pattern = PupilField::new(1024, 128, 10).expect("valid").pattern();
        // Speckles of 8 samples, on pixels of 6 × 6 samples.
        let sum = |x: usize, y: usize| {
            let samples = (0..36).map(|i| pattern.values()[(6 * x + i % 6, 6 * y + i / 6)]);
            samples.sum::<f32>()
        };
        let found = measured(Grid::from_fn(170, 170, sum));
        let off = deviation(&found, "contrast, if pixels have no gaps");
        assert!(off < 1.0, "{found:?}");
        assert!(deviation(&found, "contrast") > 2.0, "{found:?}");
    }

    #[test]
    fn an_interval_holds_the_contrast() {
        let found = measured(window(11));
        let contrast = value(&found, "contrast");
        let [low, high] =
            ["from", "to"].map(|end| value(&found, &format!("contrast, {end} (95 %)")));
        assert!(low < contrast && contrast < high, "{low} {contrast} {high}");
        // ± 1.96 · 0.765 / n in the logarithm, for n = √(400 · 300) / 4 = 87; the error is estimated
        // from the samples.
        let width = (high / low).ln() / (2.0 * 1.96 * 0.765 / 86.6);
        assert!((0.8..1.25).contains(&width), "{width}");
    }

    #[test]
    fn an_even_image_is_no_speckle() {
        let image = loaded(Grid::filled(20, 20, 1.0));
        let found = measure(Path::new("grey"), &image, (None, true));
        assert!(found.is_err(), "nothing varies");
    }
}
