//! `tem00 pattern`: one speckle pattern, compared with the theory.

mod theory;

use std::{
    borrow::Cow,
    io::{self, Write},
    path::Path,
};

use num_complex::Complex;
use tem00_numerics::{Grid, parallel::map_pieces};
use tem00_report::{
    failure::Failure,
    image::{Format, ImageError, Layer, open, write_exr, write_grey_png},
    interrupt,
    npy::{NpyError, NpyReader, write_npy, write_real_npy},
    output,
    report::Report,
};
use tem00_speckle::{PupilField, SpeckleError, SpeckleField, SpecklePattern};

use crate::{args::PatternArgs, check_writable, comparison};

/// The largest size Q: 2²⁸ samples, the maximum that
/// [`read_image`](tem00_report::image::read_image) accepts.
const MAXIMUM_SIZE: usize = 1 << 14;

/// The memory needed to generate, measure and write one sample of intensity, in bytes; its complex
/// amplitude needs more.
const BYTES_PER_SAMPLE: u64 = 24;

/// The maximum memory of an external field, in bytes: as much as the largest pattern of amplitudes.
const FIELD_MEMORY: u64 = 8 << 28;

/// Generates a pattern, writes it to the requested file and prints the table.
///
/// # Errors
///
/// Returns a failure if the input is not valid or the file cannot be written.
pub(crate) fn run(args: &PatternArgs, out: &mut impl Write) -> Result<(), Failure> {
    output::thread_pool(None)?
        .install(|| write_and_compare(args))
        .and_then(|report| report.print(false, &[], out))
}

/// Writes the pattern and returns its comparison with the theory.
fn write_and_compare(args: &PatternArgs) -> Result<Report, Failure> {
    let format = output_format(&args.output, args.amplitude)?;
    let field = pupil_field(args)?;
    check_writable(&args.output)?;
    interrupt::check()?;

    let values = if args.amplitude {
        Values::Amplitude(field.field())
    } else {
        Values::Intensity(field.pattern())
    };
    let pattern = values.pattern();
    if !pattern.values().values().iter().any(|&value| value > 0.0) {
        return Err(Failure::input(
            "the pupil sees no light of the field",
            "choose another --pupil or --diameter, or a --field that is not dark in its middle",
        ));
    }
    let compared = theory::compare(&field, &pattern)?;
    output::save(&args.output, |file| {
        write(file, format, &values, &description(args, &field))
    })?;
    let mut report = Report::new("Speckle pattern, measured and theory");
    let table = comparison::table(&compared.rows);
    report.section("Statistics").table(table);
    let notes = compared.notes.into_iter();
    notes.for_each(|line| report.note(line));
    Ok(report)
}

fn output_format(path: &Path, amplitude: bool) -> Result<Format, Failure> {
    match Format::of_path(path) {
        None => Err(Failure::input(
            format!("{} names no known image format", path.display()),
            "end the name in .png, .exr or .npy",
        )),
        Some(Format::Png) if amplitude => Err(Failure::input(
            format!("{} cannot hold complex amplitudes", path.display()),
            "end the name in .npy or .exr, or leave --amplitude out",
        )),
        Some(format) => Ok(format),
    }
}

/// Returns the field, random or read from a file, with the pupil in front of it.
fn pupil_field(args: &PatternArgs) -> Result<PupilField, Failure> {
    let samples = args.field.as_deref().map(read_field).transpose()?;
    let side = samples.as_ref().map(|s| s.width().min(s.height()));
    let fitting = side.map(|side| args.diameter.unwrap_or(side).saturating_mul(4));
    let size = args.size.or(fitting).unwrap_or(512);
    if size > MAXIMUM_SIZE {
        return Err(Failure::input(
            format!("the pattern size must be at most {MAXIMUM_SIZE} samples, got {size}"),
            "choose a smaller --size: the pattern repeats without a seam",
        ));
    }
    let samples_of_pattern = (size * size) as u64;
    let each = if args.amplitude { 8 } else { 0 } + BYTES_PER_SAMPLE;
    output::check_room(
        &format!("a pattern of {size} × {size} samples"),
        samples_of_pattern * each,
        "choose a smaller --size: the pattern repeats without a seam",
    )?;
    let diameter = args.diameter.or(side).unwrap_or(size / 4);
    let field = match samples {
        None => PupilField::new(size, diameter, args.seed),
        Some(samples) => behind(samples, size, diameter),
    };
    field
        .and_then(|field| field.with_pupil(args.pupil.clone()))
        .map_err(|error| {
            Failure::input(
                error.to_string(),
                "the size Q is --size, the diameter C is --diameter: 8 ≤ C ≤ Q / 2",
            )
        })
}

/// Returns the field of external samples, seen through a pupil of whole samples.
fn behind(
    samples: Grid<Complex<f32>>,
    size: usize,
    diameter: usize,
) -> Result<PupilField, SpeckleError> {
    let speckle_size = PupilField::new(size, diameter, 0)?.speckle_size();
    PupilField::from_samples(samples, [size; 2], speckle_size)
}

fn read_field(path: &Path) -> Result<Grid<Complex<f32>>, Failure> {
    let read =
        || -> Result<_, NpyError> { NpyReader::new(open(path)?)?.into_complex(FIELD_MEMORY) };
    read().map_err(|error| {
        Failure::input(
            format!("--field {}: {error}", path.display()),
            "give a NumPy array of complex64 or complex128, height × width: \
             np.save(\"field.npy\", array)",
        )
    })
}

fn description(args: &PatternArgs, field: &PupilField) -> String {
    let source = match &args.field {
        None => format!("seed {}", args.seed),
        Some(path) => format!("field of {}", path.display()),
    };
    format!(
        "speckle pattern of mean 1: Q = {}, C = {:.0}, pupil {:?}, {} phasors, {source}",
        field.size()[0],
        field.diameter()[0],
        args.pupil,
        field.phasor_count(),
    )
}

/// The values to write: the intensity or the complex amplitude.
enum Values {
    Intensity(SpecklePattern),
    Amplitude(SpeckleField),
}

impl Values {
    fn pattern(&self) -> Cow<'_, SpecklePattern> {
        match self {
            Self::Intensity(pattern) => Cow::Borrowed(pattern),
            Self::Amplitude(field) => Cow::Owned(field.to_pattern()),
        }
    }
}

fn write(
    file: &mut (impl Write + io::Seek),
    format: Format,
    values: &Values,
    description: &str,
) -> Result<(), ImageError> {
    match (format, values) {
        (Format::Npy, Values::Intensity(pattern)) => Ok(write_real_npy(pattern.values(), file)?),
        (Format::Npy, Values::Amplitude(field)) => Ok(write_npy(field.values(), file)?),
        (Format::Exr, Values::Intensity(pattern)) => {
            write_layer(file, description, vec![("intensity", pattern.values())])
        }
        (Format::Exr, Values::Amplitude(field)) => {
            let values = field.values();
            let (real, imaginary) = (values.map(|u| u.re), values.map(|u| u.im));
            let channels = vec![("real", &real), ("imaginary", &imaginary)];
            write_layer(file, description, channels)
        }
        (Format::Png, _) => write_scaled_png(file, values.pattern().values(), description),
    }
}

fn write_layer(
    file: &mut (impl Write + io::Seek),
    description: &str,
    channels: Vec<(&'static str, &Grid<f32>)>,
) -> Result<(), ImageError> {
    let layer = Layer {
        name: "pattern".into(),
        wavelength: None,
        comments: description.into(),
        channels,
    };
    write_exr(file, &[layer], None)
}

fn write_scaled_png(
    file: &mut impl Write,
    values: &Grid<f32>,
    description: &str,
) -> Result<(), ImageError> {
    let brightest = |samples: &[f32]| samples.iter().copied().fold(f32::MIN_POSITIVE, f32::max);
    let white = brightest(&map_pieces(values.values(), |_, piece| brightest(piece)));
    let text = [
        ("Description", description.to_owned()),
        ("Scale", format!("white is the intensity {white}, linear")),
    ];
    write_grey_png(file, values, white, &text)
}
