//! `tem00 stats`: the speckle in an image of any origin.

mod curves;
mod findings;
mod page;

use std::{io::Write, path::Path};

use tem00_numerics::{Grid, cast::to_usize};
use tem00_report::{
    failure::Failure,
    image::{LoadedImage, Reading, read_image},
    kind::{Kind, wrong_or},
    output::{self, note},
    plot::PlotFormat,
    report::Report,
};
use tem00_statistics::{
    Boundary, Contrast, Moments, SpeckleSize, StatisticsError, autocovariance, estimate::FlatImage,
    test::GreyLevels,
};

use crate::{
    args::StatsArgs,
    check_writable,
    comparison::{self, Row},
};
use curves::{Curves, Measured};
use findings::Findings;

/// The minimum number of pixels along an axis for a speckle and its surroundings.
const FEWEST_PIXELS: usize = 8;

/// The default window of the local mean, in speckle sizes: it removes 0.3 % of the variance, which
/// a correction restores.
const WINDOW: f64 = 20.0;

/// The smallest window that is chosen by default, in speckle sizes.
const MIN_WINDOW: f64 = 8.0;

/// The smallest window for which the removed variance is known, in speckle sizes.
const SMALLEST_WINDOW: f64 = 6.0;
/// The memory needed to measure one pixel, in bytes: most of it holds the lags of the
/// autocovariance, of which there are four for each pixel.
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

/// Measures an image, prints the table, or JSON, and draws the requested page.
///
/// # Errors
///
/// Returns a failure if the image cannot be read or holds no speckle to measure, or if the page
/// cannot be written.
pub(crate) fn run(args: &StatsArgs, out: &mut impl Write) -> Result<(), Failure> {
    let plot = args.plot.as_deref().map(plot_file).transpose()?;
    let reading = Reading {
        channel: args.channel.as_deref(),
        transfer: args.transfer,
        black_level: args.black_level,
        crop: args.crop,
    };
    let image = read_image(&args.image, &reading).map_err(|error| {
        let help = "give an image of light, and a --crop inside it";
        wrong_or(&args.image, Kind::Image, || cannot(args, &error, help))
    })?;
    let (width, height) = (image.values.width(), image.values.height());
    if width.min(height) < FEWEST_PIXELS {
        let error = format!("the image has {width} × {height} pixels");
        let help = format!("speckle needs at least {FEWEST_PIXELS} pixels along either axis");
        return Err(cannot(args, &error, &help));
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

/// Measures an image, flattened on request.
fn measurement(args: &StatsArgs, image: &LoadedImage) -> Result<Measurement, Failure> {
    let flat = args.flatten.map(|window| flattened(&image.values, window));
    let flat = flat.transpose().map_err(|error| {
        let help = "take a brighter part with --crop, or another window";
        cannot(args, &error, help)
    })?;
    let is_raw = args.black_level.is_none();
    measure(&args.image, image, (flat.as_ref(), is_raw)).map_err(|error| {
        let help = "give an image that light and speckle fill, or a part of one with --crop; \
                    --flatten divides by uneven light";
        cannot(args, &error, help)
    })
}

fn cannot(args: &StatsArgs, error: &impl core::fmt::Display, help: &str) -> Failure {
    Failure::input(format!("{}: {error}", args.image.display()), help)
}

/// Returns the file of the page and its format, if it can be written.
fn plot_file(path: &Path) -> Result<(&Path, PlotFormat), Failure> {
    let format = PlotFormat::of_path(path).ok_or_else(|| {
        Failure::input(
            format!("{} names no known format of a page", path.display()),
            "end the name in .svg or .png",
        )
    })?;
    check_writable(path)?;
    Ok((path, format))
}

fn draw(measurement: &Measurement, path: &Path, format: PlotFormat) -> Result<(), Failure> {
    let page = page::Page {
        title: &measurement.image,
        curves: &measurement.curves,
    };
    let bytes = page.draw().bytes(format);
    let bytes = bytes.map_err(|error| Failure::writing(path, error))?;
    output::save(path, |file| file.write_all(&bytes))
}

impl Measurement {
    fn report(&self) -> Report {
        let mut report = Report::new(format!("{}: the speckle of an image", self.image));
        report.data("image", &self.image);
        report.data("width", self.width);
        report.data("height", self.height);
        report.data("interpretation", &self.interpretation);
        report.data("curves", &self.curves);
        let table = comparison::table(&self.rows);
        report.section("Statistics").table(table);
        report.verdict(comparison::conclusion(&self.rows));
        self.warnings.iter().for_each(|line| report.warning(line));
        self.assumptions.iter().for_each(|line| report.note(line));
        report
    }
}

/// Divides an image by its mean over windows of `window` pixels, or of a width that suits its
/// speckle.
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
            "the local mean must be taken over {smallest} pixels at least, 6 speckle sizes of \
             {size:.2} pixels, got {}",
            window.unwrap_or(shorter)
        ));
    }
    Ok(flat)
}

/// Returns the size of the speckle in uneven light, and the largest window that follows the light.
///
/// Uneven light makes speckles appear larger than they are, so it is divided out before they are
/// measured. If the image does not hold eight of the remaining structures, these are uneven light
/// as well, and smaller windows are tried until speckle fills them.
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

/// Returns the number of whole pixels that hold a length.
fn pixels(length: f64) -> usize {
    to_usize(length.ceil())
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
        has_theory: true,
        rows: Vec::new(),
        warnings: Vec::new(),
        assumptions: Vec::new(),
    };
    let mean = Moments::from_samples(image.values.values())?.mean();
    found.brightness(mean, image);
    let lags = autocovariance(values, Boundary::Finite)?;
    let size = found.size(&lags)?;
    found.evenness(&lags, size)?;
    if is_raw && found.has_theory && flat.is_none() {
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
mod tests;
