//! `tem00-inspect lines`.

pub(crate) mod notes;
pub(crate) mod overlay;
mod points;
mod summary;

use std::{
    collections::HashMap,
    io::Write,
    path::{Path, PathBuf},
};

use tem00_calibration::Calibration;
use tem00_numerics::Grid;
use tem00_report::{
    failure::Failure,
    image::{ImageError, RawImage, read_raw, write_rgb_png},
    interrupt,
    kind::{Kind, wrong_or},
    output,
    progress::Progress,
};
use tem00_triangulation::LineDetector;

use crate::{args::LinesArgs, calibration_file::read_calibration, saturated_points::PointCounts};

use self::{
    points::Places,
    summary::{ImageSummary, LineSummary},
};

/// Finds the lines of all images, and prints their summary.
///
/// # Errors
///
/// Returns a failure if the input is not valid, a file cannot be written, the user interrupts it,
/// or, with all files written, if no image has a valid point.
pub(crate) fn run(args: &LinesArgs, out: &mut impl Write) -> Result<(), Failure> {
    let detector = args.detector.detector("lines")?;
    let calibration = args
        .calibration
        .as_deref()
        .map(read_calibration)
        .transpose()?;
    let folder = output::folder(args.output.as_deref(), "lines");
    let _lock = output::prepare(&folder)?;

    let progress = Progress::of(args.images.len() as u64, "images");
    let mut names = Names::default();
    let (mut summaries, mut notes) = (Vec::new(), Vec::new());
    for path in &args.images {
        interrupt::check()?;
        progress.name(path.display().to_string());
        let target = folder.join(names.unused(path));
        let (summary, remarks) = image(path, &target, (args, detector, calibration.as_ref()))?;
        summaries.push(summary);
        notes.extend(remarks);
        progress.advance(1);
    }
    drop(progress);
    let mut report = summary::report(detector.settings(), &summaries);
    summaries
        .iter()
        .filter_map(ImageSummary::warning)
        .for_each(|line| report.warning(line));
    notes.into_iter().for_each(|line| report.note(line));
    report.save_json(&folder.join("lines.json"))?;
    report.print(args.json, &[folder.join("lines.json")], out)?;
    if summaries.iter().any(ImageSummary::has_result) {
        return Ok(());
    }
    Err(Failure::no_result(
        match &summaries[..] {
            [one] if one.counts.valid > 0 => {
                "most points of the lines of the image are on saturated pixels".to_owned()
            }
            [_] => "the image has no point of a line that is valid".to_owned(),
            several => format!(
                "none of the {} images has a point of a line that is valid, or most are on \
                 saturated pixels",
                several.len()
            ),
        },
        "warnings and notes say why; the pictures show what was found",
    ))
}

/// Finds the lines of one image and writes its files, whose names begin with `target`; returns the
/// results, and the notes for the user.
fn image(
    path: &Path,
    target: &Path,
    (args, detector, calibration): (&LinesArgs, LineDetector, Option<&Calibration>),
) -> Result<(ImageSummary, Vec<String>), Failure> {
    let image = read(path, args)?;
    if let Some(calibration) = calibration {
        check_size(path, &image, calibration)?;
    }
    let found = if args.rows {
        detector.detect_marked(&turned(&image.values), &turned(&image.saturated))
    } else {
        detector.detect_marked(&image.values, &image.saturated)
    };
    let lines = LineSummary::of_all(&found);
    let places = Places {
        found: &found,
        rows: args.rows,
        lines: &lines,
        calibration,
    };
    output::save(&with_ending(target, ".csv"), |writer| places.write(writer))?;
    let picture = overlay::picture(&image.values, (&found, args.rows));
    output::save(&with_ending(target, "_lines.png"), |writer| {
        write_rgb_png(writer, &picture, &[])
    })?;
    let notes = notes::of(path, &image, (&found, args));
    let validities = found.iter().flatten().map(|point| point.validity);
    let counts = PointCounts::of(validities);
    Ok((ImageSummary::new(path, &image, (lines, counts)), notes))
}

/// Returns an image whose columns are the rows of another.
fn turned<T: Copy>(image: &Grid<T>) -> Grid<T> {
    Grid::from_fn(image.height(), image.width(), |y, x| image[(x, y)])
}

fn read(path: &Path, args: &LinesArgs) -> Result<RawImage, Failure> {
    if path.is_dir() {
        return Err(Failure::input(
            format!("{} is a folder", path.display()),
            format!("name its images, as in {}", path.join("*.png").display()),
        ));
    }
    read_raw(path, args.channel.as_deref(), args.bits)
        .map_err(|error| wrong_or(path, Kind::Image, || unreadable(path, &error)))
}

/// Returns the failure that a file is no image.
pub(crate) fn unreadable(path: &Path, error: &ImageError) -> Failure {
    Failure::input(
        format!("cannot read {}: {error}", path.display()),
        "images are PNG, TIFF, JPEG, BMP, PGM or PPM files, grey or in colours",
    )
}

fn check_size(path: &Path, image: &RawImage, calibration: &Calibration) -> Result<(), Failure> {
    let [width, height] = calibration.camera().description().resolution;
    let got = [image.values.width(), image.values.height()];
    if got == [width, height] {
        return Ok(());
    }
    Err(Failure::input(
        format!(
            "{} has {} × {} pixels, but the calibrated camera has {width} × {height}",
            path.display(),
            got[0],
            got[1]
        ),
        "a calibration belongs to whole images of the camera it was made with",
    ))
}

fn with_ending(target: &Path, ending: &str) -> PathBuf {
    let mut name = target.as_os_str().to_owned();
    name.push(ending);
    name.into()
}

/// The names of the files of one run.
#[derive(Default)]
struct Names(HashMap<String, usize>);

impl Names {
    /// Returns the name of an image without its ending; if several images have the same, the second
    /// gets `_2`, and so on.
    fn unused(&mut self, path: &Path) -> String {
        let name = output::name(path, "image");
        let mut candidate = name.clone();
        while self.0.contains_key(&candidate) {
            let number = self.0.entry(name.clone()).or_insert(1);
            *number += 1;
            candidate = format!("{name}_{number}");
        }
        self.0.insert(candidate.clone(), 1);
        candidate
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn images_of_one_name_do_not_overwrite_each_other() {
        let mut names = Names::default();
        let paths = ["a/x.png", "b/x.png", "x_2.tif", "x.tif", "y.png"];
        let unused = paths.map(|path| names.unused(Path::new(path)));
        assert_eq!(unused, ["x", "x_2", "x_2_2", "x_3", "y"]);
    }
}
