//! The report of a measurement.

use serde_json::{Map, Value, json};
use tem00_report::{
    failure::Failure,
    report::{
        Cell, Report, Section,
        units::{MICROMETRES, MILLIMETRES, PERCENT},
    },
};
use tem00_scan::{HeightMap, MeasuredPoint, QuantisedGrid, Raster};
use tem00_tracer::Sampling;
use tem00_triangulation::LineMethod;

use super::{
    drawings::Drawings,
    files::{MapImage, images},
    frame,
    job::{Job, ScanResult, in_words},
    refusal::{BRIGHT, Refusal},
    terms::Terms,
};

/// The correlations between the errors.
const CORRELATIONS: &str = "Speckle correlates the errors of neighbouring columns over about a \
    speckle, and those of frames in which the surface has not moved; shot noise, dark noise and \
    quantisation are new in every pixel and frame; PRNU and DSNU are new in every pixel and stay \
    from frame to frame; the error of the calibration is common to all points.";

/// The minimum ratio of the speckle noise of a camera to the speckle noise of a frame for which the
/// reader is warned.
const MUCH_MORE_SPECKLE: f64 = 1.1;

/// Notes how much more speckle noise a camera would see, if it is much more.
fn speckle_by_waves(report: &mut Report, job: &Job<'_>, measured: &ScanResult) {
    let shown = measured.shown.as_ref();
    let ratio = shown.and_then(|frame| job.measurement.speckle_by_waves(frame));
    report.data("speckle_by_waves", ratio);
    if let Some(ratio) = ratio.filter(|ratio| *ratio >= MUCH_MORE_SPECKLE) {
        report.verdict(format!(
            "A camera would see {ratio:.2} times as much speckle noise of this line: it is \
             narrower than its speckle or its blur, which rendered frames leave out. U is that of \
             the frames; `tem00-inspect budget` has that of a camera."
        ));
    }
}

/// Notes that the noise of a detector is not first order, where that makes U much too large.
fn first_order(report: &mut Report, method: LineMethod) {
    let why = match method {
        LineMethod::Parabola | LineMethod::LogGaussian | LineMethod::LinearInterpolation => {
            "it is not linear in the speckle of three pixels"
        }
        LineMethod::Steger { .. } => "it also averages neighbouring columns",
        _ => return,
    };
    report.verdict(format!(
        "U is first order in the noise, and one and a half to two times too large for this \
         detector: {why}. The trials of `tem00-inspect budget` find its noise."
    ));
}

/// Returns the report, and writes its diagrams.
///
/// # Errors
///
/// Returns a failure if a file cannot be written.
pub(super) fn report(job: &Job<'_>, measured: &ScanResult) -> Result<Report, Failure> {
    let drawings = Drawings { job, measured };
    let mut report = Report::new(format!("{}: measured by triangulation", job.name));
    let scene = job.args.common.scene.display().to_string();
    report.data("scene", &scene);
    report.data("profiles", measured.profiles.len());
    job.notes.iter().for_each(|note| report.note(note));
    let saturation = frame::point_counts(&measured.frames).warning(BRIGHT);
    saturation.iter().for_each(|line| report.warning(line));
    match &measured.terms {
        Ok(terms) => {
            report.verdict(terms.verdict());
            saturation
                .iter()
                .for_each(|line| report.verdict(format!("{line}.")));
            for line in terms.notes_of_indirect_light() {
                report.verdict(line);
            }
            first_order(&mut report, job.measurement.detector().settings().method);
            let average = job.measurement.settings().average;
            measured
                .speckle_sentence(average)
                .into_iter()
                .for_each(|line| report.verdict(line));
            speckle_by_waves(&mut report, job, measured);
        }
        Err(refusal) => {
            report.verdict(format!("Nothing was measured: {}.", refusal.why));
            report.verdict(format!("What helps: {}.", refusal.advice));
            drawings.remove()?;
        }
    }
    match measured.map.as_ref() {
        Some(map) => height_map(&mut report, &drawings, map)?,
        None => report.data("height_map", Value::Null),
    }
    match &measured.terms {
        Ok(terms) => {
            drawings.profile(report.section("Profile").in_detail())?;
            uncertainty(report.section("Uncertainty of a height"), &drawings, terms)?;
        }
        Err(Refusal { why, .. }) => report.data(
            "uncertainty",
            json!({"points": 0, "terms": [], "combined": null, "expanded": null, "reason": why}),
        ),
    }
    let section = report.section("Frames").in_detail();
    drawings.frame(section)?;
    section.table(frame::table(&measured.frames));
    let section = report.section("Settings").in_detail();
    settings(section, job, measured);
    if let Ok(text) = std::fs::read_to_string(&job.args.common.scene) {
        section.file(scene, text);
    }
    Ok(report)
}

fn height_map(
    report: &mut Report,
    drawings: &Drawings<'_>,
    map: &HeightMap,
) -> Result<(), Failure> {
    let images: Map<String, Value> = images(map).map(image_data).collect();
    if images.is_empty() {
        report.data("height_map", Value::Null);
        return Ok(());
    }
    let (origin, pitch) = match map.raster {
        Raster::Image { .. } => (None, None),
        Raster::Part { origin, pitch } => (Some(origin), Some(pitch)),
    };
    let heights = map.range().map(|range| {
        let [low, high] = range.map(|height| MILLIMETRES.with_digits(5).text(height));
        Cell::new(range, format!("{low} to {high}"))
    });
    let [width, height] = [map.heights.width(), map.heights.height()];
    let section = report.section("Height map").under("height_map").in_detail();
    drawings.maps(section, map)?;
    section
        .fact("range", "heights", Cell::or_dash(heights))
        .fact(
            "size",
            "cells",
            Cell::new([width, height], format!("{width} × {height}")),
        )
        .fact(
            "holes",
            "holes",
            PERCENT.with_digits(3).quantity(map.holes()),
        )
        // The lower edges of the first cell along the line and along the scan, and the side of a
        // cell; none for columns and profiles.
        .data("origin", origin)
        .data("pitch", pitch)
        .data("images", images);
    Ok(())
}

/// The values of an image in 16 bits: offset + scale · v for v from 1; 0 is a hole.
fn image_data(image: MapImage) -> (String, Value) {
    let QuantisedGrid { offset, scale, .. } = image.values;
    let value = json!({"offset": offset, "scale": scale, "unit": image.unit});
    (image.name.to_owned(), value)
}

fn uncertainty(
    section: &mut Section,
    drawings: &Drawings<'_>,
    terms: &Terms,
) -> Result<(), Failure> {
    section
        .under("uncertainty")
        .data("points", terms.points)
        .data("indirect_points", terms.indirect)
        .data("points_of_indirect_light_alone", terms.alone)
        .table(terms.table())
        .data("combined", terms.combined)
        .data("expanded", terms.expanded)
        .data("median_expanded", terms.quantiles[0])
        .data("quantile_95_expanded", terms.quantiles[1])
        .data("reason", Value::Null);
    drawings.terms(section, terms)?;
    section.paragraph(CORRELATIONS);
    Ok(())
}

fn settings(section: &mut Section, job: &Job<'_>, measured: &ScanResult) {
    let measurement = &job.measurement;
    let render = &measurement.scene().render;
    section
        .fact("average", "average", average(job, measured))
        .fact(
            "speckle",
            "speckle size on the sensor",
            speckle(job, measured),
        )
        .fact(
            "height_per_pixel",
            "height per pixel",
            height_per_pixel(job, measured),
        )
        .fact("detector", "detector", detector(job))
        .fact("sensor", "sensor", sensor(job))
        .fact("calibration", "calibration", calibration(job))
        .fact("seed", "seed", render.seed)
        .fact(
            "samples_per_pixel",
            "samples per pixel",
            render.samples_per_pixel,
        )
        .data("adaptive", render.sampling == Sampling::Adaptive);
}

fn average(job: &Job<'_>, measured: &ScanResult) -> Cell {
    let average = job.measurement.settings().average;
    let worth = measured
        .effective_frames
        .map_or_else(String::new, |frames| {
            format!("; worth {frames:.1} profiles of independent speckle")
        });
    Cell::new(
        json!({
            "frames": average.frames,
            "columns": average.columns,
            "effective_frames": measured.effective_frames,
        }),
        format!(
            "{} frames, {} columns{worth}",
            average.frames, average.columns
        ),
    )
}

/// The speckle size in the middle of the image, along rows and columns, and the change of speckle
/// from one frame to the next.
fn speckle(job: &Job<'_>, measured: &ScanResult) -> Cell {
    if job.args.common.no_speckle {
        return Cell::missing("disabled");
    }
    let speckle = job.measurement.speckle();
    let ([across, down], contrast) = (speckle.size(), speckle.variance.sqrt());
    let change = measured.speckle_change.as_ref();
    let between = change.map_or_else(String::new, |change| {
        format!("; from frame to frame {}", in_words(change))
    });
    Cell::new(
        json!({
            "size": [across, down],
            "contrast": contrast,
            "between_frames": change.map(|change| json!({
                "displacement": change.displacement.to_array(),
                "correlation": change.correlation,
            })),
        }),
        format!("{across:.2} × {down:.2} pixels, contrast {contrast:.2}{between}"),
    )
}

/// The height of a pixel, at the first valid point.
fn height_per_pixel(job: &Job<'_>, measured: &ScanResult) -> Cell {
    let height = job.measurement.settings().height;
    let mut points = measured.profiles.iter().flatten();
    let point = points.find(|point| point.is_valid());
    let per_pixel = |point: &MeasuredPoint| point.per_pixel.dot(height).abs();
    Cell::or_dash(point.map(|point| MICROMETRES.with_digits(3).quantity(per_pixel(point))))
}

fn detector(job: &Job<'_>) -> Cell {
    let settings = job.measurement.detector().settings();
    let method = settings.method.name();
    Cell::new(
        json!({
            "method": method,
            "window": settings.window,
            "min_peak": settings.min_peak,
            "max_lines": settings.max_lines,
            "saturation": settings.saturation,
        }),
        format!("{method}, window {} pixels", settings.window),
    )
}

fn sensor(job: &Job<'_>) -> Cell {
    let sensor = job.measurement.sensor().description();
    Cell::new(
        sensor,
        format!(
            "{} bits, {:.3} DN per electron, exposure {:.4} ms, full well {:.0} electrons",
            sensor.bit_depth,
            sensor.gain,
            1e3 * sensor.exposure_time,
            sensor.full_well
        ),
    )
}

fn calibration(job: &Job<'_>) -> Cell {
    let quality = job.measurement.calibration().quality();
    let (method, text) = match quality {
        None => ("exact", "exact, from the scene".to_owned()),
        Some(quality) => (
            "estimated",
            format!("estimated from {} boards", quality.boards),
        ),
    };
    Cell::new(json!({ "method": method, "quality": quality }), text)
}
