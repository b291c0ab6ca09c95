//! What `measurement.json` says.

use std::collections::BTreeMap;

use serde::Serialize;
use tem00_triangulation::{
    Averaging, CalibrationQuality, LineMethod, MeasuredFrame, Raster, SensorDescription, Validity,
};

use super::{
    Job, Measured,
    refusal::Refusal,
    terms::{Term, Terms},
};

/// All that a program wants to know of a measurement; lengths in metres, places in pixels.
#[derive(Debug, Serialize)]
pub(super) struct Record {
    program: &'static str,
    scene: String,
    seed: u64,
    samples_per_pixel: u32,
    speckle: Option<SpeckleRecord>,
    sensor: SensorRecord,
    detector: DetectorRecord,
    calibration: CalibrationRecord,
    frames: Vec<FrameRecord>,
    profiles: usize,
    average: AverageRecord,
    uncertainty: UncertaintyRecord,
    height_map: Option<MapRecord>,
}

/// How uncertain heights are, or why nothing is known of them.
#[derive(Debug, Serialize)]
struct UncertaintyRecord {
    /// The number of valid points.
    points: usize,
    terms: Vec<Term>,
    combined: Option<f64>,
    expanded: Option<f64>,
    /// Why there is no valid point, if there is none.
    reason: Option<String>,
}

#[derive(Debug, Serialize)]
struct SpeckleRecord {
    /// The speckle size in the middle of the image, along rows and columns, in pixels.
    size: [f64; 2],
    /// The contrast in a point of the image.
    contrast: f64,
    /// What becomes of it from a frame to the next; none where that is not known.
    between_frames: Option<ChangeRecord>,
}

#[derive(Debug, Serialize)]
struct ChangeRecord {
    /// How far the pattern moves, in pixels to the right and down.
    displacement: [f64; 2],
    /// The correlation of what is left of it.
    correlation: f64,
}

#[derive(Debug, Serialize)]
struct SensorRecord {
    quantum_efficiency: f64,
    gain: f64,
    dark_noise: f64,
    dark_current: f64,
    full_well: f64,
    prnu: f64,
    dsnu: f64,
    bit_depth: u32,
    black_level: f64,
    pixel_pitch: f64,
    fill_factor: f64,
    exposure_time: f64,
    serial_number: u64,
}

#[derive(Debug, Serialize)]
struct DetectorRecord {
    method: &'static str,
    window: usize,
    least_peak: f64,
    most_lines: usize,
    saturation: f64,
}

#[derive(Debug, Serialize)]
struct CalibrationRecord {
    method: &'static str,
    boards: Option<usize>,
    rms_reprojection: Option<f64>,
    rms_plane: Option<f64>,
}

#[derive(Debug, Serialize)]
struct AverageRecord {
    frames: u32,
    columns: usize,
    /// How many profiles of independent speckle an averaged one is worth.
    effective_frames: Option<f64>,
}

#[derive(Debug, Serialize)]
struct MapRecord {
    width: usize,
    height: usize,
    /// The first cell's lower edges along the line and along the scan, and the side of a cell; none for
    /// columns and profiles.
    origin: Option<[f64; 2]>,
    pitch: Option<f64>,
    /// The height of the value v of the 16-bit file: offset + scale v, from 1; 0 is a hole.
    offset: f64,
    scale: f64,
    range: Option<[f64; 2]>,
    /// The share of cells that are holes.
    holes: f64,
}

/// What a frame showed.
#[derive(Clone, Debug, Serialize)]
pub(super) struct FrameRecord {
    pub(super) number: u32,
    pub(super) file: String,
    /// The number of points that were found.
    pub(super) points: usize,
    /// How many of them are valid.
    pub(super) valid: usize,
    /// How many of them lie on saturated pixels.
    pub(super) saturated: usize,
    /// How many of them are not valid, by reason.
    pub(super) not_valid: BTreeMap<&'static str, usize>,
    pub(super) saturated_pixels: usize,
    /// The largest grey value.
    pub(super) peak: u16,
    pub(super) mean_width: Option<f64>,
}

impl FrameRecord {
    pub(super) fn of(frame: &MeasuredFrame, file: String) -> Self {
        let count = |validity: Validity| {
            let points = frame.points.iter();
            points.filter(|p| p.seen.validity == validity).count()
        };
        let valid = count(Validity::Valid);
        let mut not_valid = BTreeMap::new();
        for point in frame.points.iter().filter(|point| !point.is_valid()) {
            *not_valid.entry(point.seen.validity.name()).or_default() += 1;
        }
        let widths = frame.points.iter().filter(|point| point.is_valid());
        let width: f64 = widths.map(|point| point.seen.width).sum();
        let mean_width = (valid > 0).then(|| width / valid as f64);
        Self {
            number: frame.frame,
            file,
            points: frame.points.len(),
            valid,
            saturated: count(Validity::Saturated),
            not_valid,
            saturated_pixels: frame.raw.saturated_pixels(),
            peak: frame.raw.values.values().iter().copied().max().unwrap_or(0),
            mean_width,
        }
    }
}

impl Record {
    pub(super) fn of(job: &Job<'_>, measured: &Measured) -> Self {
        let measurement = &job.measurement;
        let render = &measurement.scene().render;
        let speckle = measurement.speckle();
        let Averaging { frames, columns } = measurement.settings().average;
        Self {
            program: concat!("tem00 ", env!("CARGO_PKG_VERSION")),
            scene: job.args.scene.display().to_string(),
            seed: render.seed,
            samples_per_pixel: render.samples_per_pixel,
            speckle: (!job.args.no_speckle).then(|| SpeckleRecord {
                size: speckle.size(),
                contrast: speckle.variance.sqrt(),
                between_frames: measured.speckle_change.map(|change| ChangeRecord {
                    displacement: change.displacement.to_array(),
                    correlation: change.correlation,
                }),
            }),
            sensor: SensorRecord::of(measurement.sensor().description()),
            detector: DetectorRecord::of(job),
            calibration: CalibrationRecord::of(measurement.calibration().quality()),
            frames: measured.frames.clone(),
            profiles: measured.profiles.len(),
            average: AverageRecord {
                frames,
                columns,
                effective_frames: measured.effective_frames,
            },
            uncertainty: UncertaintyRecord::of(&measured.terms),
            height_map: measured.map.as_ref().and_then(MapRecord::of),
        }
    }
}

impl UncertaintyRecord {
    fn of(terms: &Result<Terms, Refusal>) -> Self {
        match terms {
            Ok(terms) => Self {
                points: terms.points,
                terms: terms.terms.clone(),
                combined: Some(terms.combined),
                expanded: Some(terms.expanded),
                reason: None,
            },
            Err(refusal) => Self {
                points: 0,
                terms: Vec::new(),
                combined: None,
                expanded: None,
                reason: Some(refusal.why.clone()),
            },
        }
    }
}

impl SensorRecord {
    const fn of(sensor: &SensorDescription) -> Self {
        Self {
            quantum_efficiency: sensor.quantum_efficiency,
            gain: sensor.gain,
            dark_noise: sensor.dark_noise,
            dark_current: sensor.dark_current,
            full_well: sensor.full_well,
            prnu: sensor.prnu,
            dsnu: sensor.dsnu,
            bit_depth: sensor.bit_depth,
            black_level: sensor.black_level,
            pixel_pitch: sensor.pixel_pitch,
            fill_factor: sensor.fill_factor,
            exposure_time: sensor.exposure_time,
            serial_number: sensor.serial_number,
        }
    }
}

impl DetectorRecord {
    fn of(job: &Job<'_>) -> Self {
        let settings = job.measurement.detector().settings();
        let method: LineMethod = settings.method;
        Self {
            method: method.name(),
            window: settings.window,
            least_peak: settings.least_peak,
            most_lines: settings.most_lines,
            saturation: settings.saturation,
        }
    }
}

impl CalibrationRecord {
    fn of(quality: Option<&CalibrationQuality>) -> Self {
        Self {
            method: if quality.is_some() {
                "estimated"
            } else {
                "exact"
            },
            boards: quality.map(|quality| quality.boards),
            rms_reprojection: quality.map(|quality| quality.rms_reprojection),
            rms_plane: quality.map(|quality| quality.rms_plane),
        }
    }
}

impl MapRecord {
    fn of(map: &tem00_triangulation::HeightMap) -> Option<Self> {
        let (_, scale) = map.quantised()?;
        let (origin, pitch) = match map.raster {
            Raster::Image { .. } => (None, None),
            Raster::Part { origin, pitch } => (Some(origin), Some(pitch)),
        };
        Some(Self {
            width: map.heights.width(),
            height: map.heights.height(),
            origin,
            pitch,
            offset: scale.offset,
            scale: scale.scale,
            range: map.range(),
            holes: map.holes(),
        })
    }
}
