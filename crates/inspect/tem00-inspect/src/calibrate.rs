//! `tem00-inspect calibrate`.

mod left_out;
mod table;

use std::{
    collections::BTreeMap,
    fs,
    io::Write,
    path::{Path, PathBuf},
};

use tem00_calibration::{BoardView, Calibration, CameraModel, Checkerboard, calibrate};
use tem00_report::{
    atomic::probe_writable,
    failure::Failure,
    image::{RawFormat, RawImage, read_raw},
    interrupt,
    progress::Progress,
    report::{Report, units::MILLIMETRES},
};
use tem00_triangulation::TriangulationError;

use self::left_out::FoundPoints;
use crate::{args::CalibrateArgs, calibration_file::write_calibration, lines::unreadable};

/// The photographs of a board.
#[derive(Clone, Debug, PartialEq)]
struct Pair {
    lit: PathBuf,
    line: Option<PathBuf>,
}

pub(crate) fn run(args: &CalibrateArgs, out: &mut impl Write) -> Result<(), Failure> {
    let board = Checkerboard::new(args.corners, args.square).map_err(|error| {
        Failure::input(error.to_string(), "see `tem00-inspect calibrate --help`")
    })?;
    let target = match &args.output {
        Some(path) => path.clone(),
        None => args.folder.join("calibration.json"),
    };
    let pairs = pairs(&args.folder)?;
    probe_writable(&target).map_err(|error| {
        Failure::input(
            format!("cannot write {}: {error}", target.display()),
            "name another file with -o",
        )
    })?;
    let (views, found, resolution) = views(&pairs, &board, args)?;
    let calibration = calibrate(&board, &views, &model(args, resolution)).map_err(|error| {
        let doubts: Vec<String> = found
            .warnings()
            .iter()
            .map(|line| format!("; {line}"))
            .collect();
        Failure::input(
            format!(
                "{} gives no calibration: {error}{}",
                args.folder.display(),
                doubts.concat()
            ),
            "at least 3 whole boards are needed, tilted by 15° to 30° about different axes, with \
             the line on boards at different heights",
        )
    })?;
    write_calibration(&target, &calibration)?;
    let mut report = report(&calibration, &found);
    let distance = calibration.camera().image_distance();
    if let Some(focal_length) = args.focal_length.filter(|length| *length >= distance) {
        report.warning(format!(
            "--focal-length {} is not below the image distance of {}, as in a camera that is in \
             focus: the boards are taken to be in focus instead",
            MILLIMETRES.text(focal_length),
            MILLIMETRES.text(distance)
        ));
    }
    report.print(false, &[target], out)
}

fn model(args: &CalibrateArgs, resolution: [usize; 2]) -> CameraModel {
    CameraModel {
        pixel_pitch: args.pixel_pitch,
        resolution,
        focal_length: args.focal_length,
        f_number: args.f_number,
        tilted: args.tilted,
        radial: usize::from(args.radial),
    }
}

fn report(calibration: &Calibration, found: &FoundPoints) -> Report {
    let mut report = Report::new("Calibration of a camera and a laser");
    report
        .section("Camera")
        .table(table::parameters(calibration));
    let sentences = table::sentences(calibration, found).into_iter();
    sentences.for_each(|sentence| report.verdict(sentence));
    let warnings = found.warnings().into_iter();
    warnings.for_each(|line| report.warning(line));
    report
}

/// Returns the photographs of a folder, by name.
fn pairs(folder: &Path) -> Result<Vec<Pair>, Failure> {
    let entries = fs::read_dir(folder).map_err(|error| {
        Failure::input(
            format!("cannot read the folder {}: {error}", folder.display()),
            "name a folder with the images board_01.png, line_01.png and so on",
        )
    })?;
    let (mut boards, mut lines) = (BTreeMap::new(), BTreeMap::new());
    let paths = entries.filter_map(|entry| entry.ok().map(|entry| entry.path()));
    for path in paths.filter(|path| RawFormat::of_path(path).is_some()) {
        let stem = path.file_stem().and_then(|stem| stem.to_str());
        let (kind, number) = stem
            .and_then(|stem| stem.split_once('_'))
            .unwrap_or_default();
        let number = number.to_owned();
        match kind {
            "board" => drop(boards.insert((number, path.clone()), path)),
            "line" => drop(lines.insert(number, path)),
            _ => (),
        }
    }
    let pairs = boards.into_iter().map(|((number, _), lit)| Pair {
        line: lines.get(&number).cloned(),
        lit,
    });
    let pairs: Vec<_> = pairs.collect();
    let with_lines = pairs.iter().filter(|pair| pair.line.is_some()).count();
    if pairs.is_empty() || with_lines == 0 {
        return Err(Failure::input(
            format!(
                "{} has {} images of boards (board_….png) and {} of lines on them (line_….png)",
                folder.display(),
                pairs.len(),
                lines.len()
            ),
            "save each board twice: board_01.png in ordinary light, and line_01.png under the \
             laser",
        ));
    }
    Ok(pairs)
}

/// Finds boards and lines in all images, which are of one size.
fn views(
    pairs: &[Pair],
    board: &Checkerboard,
    args: &CalibrateArgs,
) -> Result<(Vec<BoardView>, FoundPoints, [usize; 2]), Failure> {
    let detector = args.detector.detector("calibrate")?;
    let progress = Progress::of(pairs.len() as u64, "boards");
    let (mut views, mut found) = (Vec::new(), FoundPoints::default());
    let mut size = None;
    for pair in pairs {
        interrupt::check()?;
        progress.name(pair.lit.display().to_string());
        let lit = read(&pair.lit, args, &mut size)?;
        let columns = match &pair.line {
            Some(path) => {
                let line = read(path, args, &mut size)?;
                detector.detect_marked(&line.values, &line.saturated)
            }
            None => Vec::new(),
        };
        found.add(pair.line.as_deref(), &columns);
        let view = BoardView::find(&lit.values, &columns, board);
        views.push(view.map_err(|error| no_board(&pair.lit, &error))?);
        progress.advance(1);
    }
    Ok((views, found, size.unwrap_or_default()))
}

fn no_board(path: &Path, error: &TriangulationError) -> Failure {
    Failure::input(
        format!("{}: {error}", path.display()),
        "--corners counts the inner corners, one less than squares per side; the whole board must \
         be sharp and in the image, or leave this image out",
    )
}

/// Reads an image, of the size of those before.
fn read(
    path: &Path,
    args: &CalibrateArgs,
    size: &mut Option<[usize; 2]>,
) -> Result<RawImage, Failure> {
    let image =
        read_raw(path, args.channel.as_deref(), None).map_err(|error| unreadable(path, &error))?;
    let [width, height] = [image.values.width(), image.values.height()];
    let [first_width, first_height] = *size.get_or_insert([width, height]);
    if [width, height] == [first_width, first_height] {
        return Ok(image);
    }
    Err(Failure::input(
        format!(
            "{} has {width} × {height} pixels, but those before have {first_width} × \
             {first_height}",
            path.display()
        ),
        "all images must be whole images of one camera",
    ))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn images_are_paired_by_what_follows_their_kind() {
        let folder = tempfile::tempdir().expect("a temporary folder");
        let path = |name: &str| folder.path().join(name);
        let refused = |folder: &Path| pairs(folder).expect_err("there are no pairs");
        let told = refused(folder.path()).message().to_owned();
        assert!(told.contains("0 images of boards"), "{told}");
        let write = |name: &str| fs::write(path(name), "").expect("the file is written");
        "board_02.png board_01.tiff notes.txt other.png"
            .split(' ')
            .for_each(write);
        assert_eq!(refused(folder.path()).exit_code(), 2, "without a line");
        write("line_02.TIF");
        let found = pairs(folder.path()).expect("there are pairs");
        let pair = |lit, line: Option<&str>| Pair {
            lit: path(lit),
            line: line.map(path),
        };
        let expected = [
            pair("board_01.tiff", None),
            pair("board_02.png", Some("line_02.TIF")),
        ];
        assert_eq!(found, expected);
        let missing = refused(&path("missing")).message().to_owned();
        assert!(missing.contains("missing"), "the folder is named");
    }
}
