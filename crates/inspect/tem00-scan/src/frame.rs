use std::borrow::Cow;

use glam::{DMat3, DVec2, DVec3};
use tem00_calibration::Calibration;
use tem00_engine::{FollowedPoint, SpeckleChange};
use tem00_numerics::{Grid, cast::to_f32};
use tem00_tracer::RigidMotion;
use tem00_triangulation::{
    ColumnLight, LineDetector, LinePoint, PositionNoise, ProfilePoint, RawFrame, Sensor, Validity,
    speckle_covariance,
};

use crate::{
    ScanError, exposure::Exposure, image_speckle::ImageSpeckle, speckle_table::SpeckleTable,
};

/// Measurement of the sensor in one frame.
#[derive(Clone, Debug, PartialEq)]
pub struct MeasuredFrame {
    /// The number of the frame.
    pub frame: u32,
    /// The light that fell on the sensor.
    pub exposure: Exposure,
    /// The frame as the camera gives it.
    pub raw: RawFrame,
    /// The lines that were found in each column.
    pub lines: Vec<Vec<LinePoint>>,
    /// The points on them, by column and from the top.
    pub points: Vec<MeasuredPoint>,
    /// The correlation, by speckle, of the line's positions in columns 0, 1, 2 … apart; 1 alone
    /// without speckle.
    pub correlation: Vec<f64>,
    /// The point in the middle of the profile, whose speckle represents the speckle of all points;
    /// `None` without speckle or without points.
    pub reference_point: Option<FollowedPoint>,
}

/// A measured point of a part and how well it is known.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct MeasuredPoint {
    /// The point as the profile has it, before the part is moved back to its place in the
    /// description.
    pub seen: ProfilePoint,
    /// The point on the part as the scene describes it, in metres.
    pub position: DVec3,
    /// The displacement of this position per pixel by which the line moves down, in metres.
    pub per_pixel: DVec3,
    /// The contributions to the variance of the line's position, in square pixels.
    pub noise: PositionNoise,
    /// The light in the line that met a second surface.
    pub indirect: IndirectLight,
    /// The covariance that the calibration gives to the position, in m²: common to all points.
    pub calibration: DMat3,
}

/// Light of a line that met several rough surfaces: a render separates it, a camera cannot.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct IndirectLight {
    /// Its fraction of the light in the window about the line, from 0 to 1.
    pub fraction: f64,
    /// Displacement of the line by this light, in pixels down: an error that repetition does not
    /// reveal, whose size counts as a standard uncertainty. For a line that consists of such light
    /// only, it is the distance, without noise, from the nearest line of other light in the column;
    /// half of the window of the detector if there is none.
    pub shift: f64,
    /// Whether the line consists of such light only: no other line is within half of the window.
    pub alone: bool,
}

impl MeasuredPoint {
    /// Returns the standard uncertainties of the coordinates of the position, in metres.
    pub fn uncertainty(&self) -> DVec3 {
        DVec3::from_array(DVec3::AXES.map(|axis| self.uncertainty_along(axis)))
    }

    /// Returns the standard uncertainty along a direction of length 1, in metres: from the position
    /// of the line and the calibration together.
    pub fn uncertainty_along(&self, direction: DVec3) -> f64 {
        self.line_uncertainty_along(direction)
            .hypot(self.calibration_uncertainty_along(direction))
    }

    /// Returns the standard uncertainty of the position of the line, in pixels, by noise and
    /// indirect light.
    pub fn position_uncertainty(&self) -> f64 {
        self.noise.total().sqrt().hypot(self.indirect.shift)
    }

    /// Returns the standard uncertainty along a direction of length 1 that comes from the position
    /// of the line, in metres.
    pub fn line_uncertainty_along(&self, direction: DVec3) -> f64 {
        self.position_uncertainty() * self.per_pixel.dot(direction).abs()
    }

    /// Returns the standard uncertainty along a direction of length 1 that comes from the
    /// calibration, in metres. It is the same error for all points: it does not average out.
    pub fn calibration_uncertainty_along(&self, direction: DVec3) -> f64 {
        // A variance of rounding errors may turn out negative.
        direction.dot(self.calibration * direction).max(0.0).sqrt()
    }

    /// Returns whether the position of the line can be trusted.
    pub fn is_valid(&self) -> bool {
        self.seen.validity == Validity::Valid
    }
}

/// Inputs for the measurement of a frame.
#[derive(Clone, Debug)]
pub(super) struct FrameContext<'a> {
    pub(super) sensor: &'a Sensor,
    pub(super) detector: &'a LineDetector,
    pub(super) calibration: &'a Calibration,
    /// The covariance that is added to the covariance of the calibration, in m², in the coordinates
    /// of the part.
    pub(super) further: DMat3,
    /// `None` without speckle.
    pub(super) speckle: Option<&'a ImageSpeckle>,
    pub(super) to_part: RigidMotion,
}

impl FrameContext<'_> {
    /// Exposes the sensor and measures the frame.
    pub(super) fn measure(
        &self,
        exposure: Exposure,
        frame: u32,
        seed: u64,
    ) -> Result<MeasuredFrame, ScanError> {
        let raw = self.sensor.expose(&exposure.electrons, seed)?;
        let image = raw.grey_values();
        let lines = self.detector.detect(&image);
        let noise_free = NoiseFreeFrame::of(self, &exposure);
        let points = self.points(&lines, &noise_free);
        let both = self.correlation(&exposure, &points, &SpeckleChange::NONE);
        Ok(MeasuredFrame {
            frame,
            correlation: both[both.len() / 2..].to_vec(),
            reference_point: None,
            points,
            lines,
            raw,
            exposure,
        })
    }

    /// Greatest distance, in pixels, of a line from its position without noise.
    fn reach(&self) -> f64 {
        0.5 * self.detector.settings().window as f64
    }

    fn points(&self, lines: &[Vec<LinePoint>], noise_free: &NoiseFreeFrame) -> Vec<MeasuredPoint> {
        let triangulator = self.calibration.triangulator();
        let profile = triangulator.profile(lines, |_, _| 0.0);
        let measured = |seen: &ProfilePoint| {
            let [_, down] = triangulator.derivatives(seen.pixel)?;
            let noise = noise_free.noise(self, seen);
            let calibration = self.calibration.point_covariance(seen.pixel)?;
            let turn = self.to_part.rotation();
            let mut seen = *seen;
            if seen.validity == Validity::Valid && noise_free.is_sliver(&seen, self.reach()) {
                seen.validity = Validity::Sliver;
            }
            let indirect = noise_free.indirect(self, &seen);
            let deviation = noise.total().sqrt().hypot(indirect.shift);
            seen.point = triangulator.point_with_uncertainty(seen.pixel, deviation)?;
            Some(MeasuredPoint {
                position: self.to_part.point(seen.point.position),
                per_pixel: self.to_part.direction(down),
                calibration: turn * calibration * turn.transpose() + self.further,
                indirect,
                noise,
                seen,
            })
        };
        profile.iter().filter_map(measured).collect()
    }

    /// Returns how speckle correlates the position of the line in neighbouring columns, as the
    /// pattern has changed: for columns from −n to n apart.
    ///
    /// The middle one of the valid points represents all of them. A slope of the line makes the
    /// correlation shorter than this; it is left out.
    pub(super) fn correlation(
        &self,
        exposure: &Exposure,
        points: &[MeasuredPoint],
        change: &SpeckleChange,
    ) -> Vec<f64> {
        let (Some(middle), Some(speckle)) = (middle(points), self.speckle) else {
            return vec![1.0];
        };
        let pixel = middle.seen.pixel;
        let column = NoiseFreeFrame::of(self, exposure).column(self, &middle.seen);
        let light = column.light();
        let sensor = self.sensor.description();
        let still = speckle.column(pixel);
        let still = |apart| still.covariance(apart);
        let variance = speckle_covariance(sensor, still, [&light, &light], [0.0; 2]);
        if variance <= 0.0 {
            return vec![1.0];
        }
        let moved = change.displacement;
        let table = if moved == DVec2::ZERO {
            speckle.table(pixel)
        } else {
            Cow::Owned(SpeckleTable::new(
                &speckle.speckle_at(pixel),
                [-moved.x, -moved.y],
            ))
        };
        let covariance = |columns: f64| {
            let apart = [columns - moved.x, -moved.y];
            let table = |apart| table.covariance(apart);
            let left = speckle_covariance(sensor, table, [&light, &light], apart);
            change.correlation * left
        };
        let reach = table.columns() as f64 + moved.x.abs().ceil().min(FARTHEST);
        let mut columns = -reach;
        let mut correlations = Vec::new();
        while columns <= reach {
            correlations.push(covariance(columns) / variance);
            columns += 1.0;
        }
        correlations
    }
}

/// The maximum number of columns that a pattern is followed beyond its reach.
const FARTHEST: f64 = 1024.0;

/// The middle one of the valid points.
pub(super) fn middle(points: &[MeasuredPoint]) -> Option<&MeasuredPoint> {
    let valid: Vec<&MeasuredPoint> = points.iter().filter(|point| point.is_valid()).collect();
    valid.get(valid.len() / 2).copied()
}

/// The frame that the sensor would give on average over all surfaces that look alike.
struct NoiseFreeFrame {
    electrons: Grid<f32>,
    coherent: Grid<f32>,
    multiple: Grid<f32>,
    grey_values: Grid<f32>,
    lines: Vec<Vec<LinePoint>>,
    /// The lines in light that met only one rough surface; `None` where there is no other light.
    direct: Option<Vec<Vec<LinePoint>>>,
    /// The median of the widths of the lines, in pixels; 0 without any.
    usual_width: f64,
}

/// The width, in pixels and in usual widths, below both of which an edge must have cut the line:
/// two pixels of equal light are 2.7 wide, and slopes of the part seldom halve a line.
const SLIVER: (f64, f64) = (3.0, 0.5);

impl NoiseFreeFrame {
    fn of(context: &FrameContext<'_>, exposure: &Exposure) -> Self {
        let sensor = context.sensor.description();
        let dark = context.sensor.dark_electrons();
        let largest = sensor.largest_value();
        let grey_value = |electrons: f32| {
            let charge = (f64::from(electrons) + dark).min(sensor.full_well);
            to_f32((sensor.black_level + sensor.gain * charge).min(largest))
        };
        let mean = &exposure.without_speckle;
        let grey_values = mean.map(|&electrons| grey_value(electrons));
        let lines = context.detector.detect(&grey_values);
        let multiple = &exposure.multiple;
        let has_several = multiple.values().iter().any(|&electrons| electrons > 0.0);
        let direct = has_several.then(|| {
            let light = |x, y| grey_value(mean[(x, y)] - multiple[(x, y)]);
            let frame = Grid::from_fn(mean.width(), mean.height(), light);
            context.detector.detect(&frame)
        });
        Self {
            usual_width: median_width(&lines),
            lines,
            direct,
            electrons: mean.clone(),
            coherent: exposure.coherent.clone(),
            multiple: multiple.clone(),
            grey_values,
        }
    }

    /// Returns the light that met a second surface in the line of a point.
    fn indirect(&self, context: &FrameContext<'_>, seen: &ProfilePoint) -> IndirectLight {
        let Some(direct) = &self.direct else {
            return IndirectLight::default();
        };
        let reach = context.reach();
        let position = self
            .nearest(seen, reach)
            .map_or(seen.pixel.y, |line| line.position);
        let distances = direct[seen.column]
            .iter()
            .map(|line| position - line.position);
        let nearest = distances.min_by(|a, b| a.abs().total_cmp(&b.abs()));
        let window = |grid: &Grid<f32>| -> f64 {
            let rows = (0..grid.height()).filter(|&y| (y as f64 + 0.5 - position).abs() <= reach);
            rows.map(|y| f64::from(grid[(seen.column, y)])).sum()
        };
        let all = window(&self.electrons);
        IndirectLight {
            fraction: if all > 0.0 {
                window(&self.multiple) / all
            } else {
                0.0
            },
            shift: nearest.unwrap_or(reach),
            alone: nearest.is_none_or(|distance| distance.abs() > reach),
        }
    }

    /// Returns the contributions to the variance of a line's position.
    fn noise(&self, context: &FrameContext<'_>, seen: &ProfilePoint) -> PositionNoise {
        let sensor = context.sensor.description();
        let column = self.column(context, seen);
        let speckle = context.speckle.map(|speckle| speckle.column(seen.pixel));
        let covariance = |apart| {
            speckle
                .as_ref()
                .map_or(0.0, |speckle| speckle.covariance(apart))
        };
        PositionNoise::of_column(sensor, covariance, &column.light())
    }

    /// Returns the line that there would be without noise at the position of a point, if any.
    fn nearest(&self, seen: &ProfilePoint, reach: f64) -> Option<&LinePoint> {
        let distance = |line: &LinePoint| (line.position - seen.pixel.y).abs();
        self.lines[seen.column]
            .iter()
            .filter(|line| distance(line) < reach)
            .min_by(|a, b| distance(a).total_cmp(&distance(b)))
    }

    /// Returns whether an edge of the part cuts the line at a point, or there would be no line
    /// without noise.
    ///
    /// First order would give such a position a very small uncertainty, because little light moves
    /// it little; but it is the position of the edge, and not of the line.
    fn is_sliver(&self, seen: &ProfilePoint, reach: f64) -> bool {
        let (pixels, usual) = SLIVER;
        let narrow = pixels.min(usual * self.usual_width);
        self.nearest(seen, reach)
            .is_none_or(|line| line.width < narrow)
    }

    /// The light in the column of a point, and how its position depends on it: as without speckle
    /// where there would be a line, too.
    fn column(&self, context: &FrameContext<'_>, seen: &ProfilePoint) -> Column {
        let take = |grid: &Grid<f32>| -> Vec<f32> {
            (0..grid.height()).map(|y| grid[(seen.column, y)]).collect()
        };
        let wide = |grid: &Grid<f32>| take(grid).into_iter().map(f64::from).collect();
        let detector = context.detector;
        let nearest = self.nearest(seen, context.reach());
        let line = nearest.copied().unwrap_or(LinePoint {
            position: seen.pixel.y,
            width: seen.width,
            peak: 0.0,
            integral: seen.reflectance,
            background: 0.0,
            validity: seen.validity,
            line: seen.line,
        });
        Column {
            sensitivities: detector.sensitivities(&take(&self.grey_values), &line),
            electrons: wide(&self.electrons),
            coherent: wide(&self.coherent),
        }
    }
}

/// The median of the widths of all points of lines; 0 without any.
fn median_width(lines: &[Vec<LinePoint>]) -> f64 {
    let mut widths: Vec<f64> = lines.iter().flatten().map(|line| line.width).collect();
    widths.sort_by(f64::total_cmp);
    widths.get(widths.len() / 2).copied().unwrap_or(0.0)
}

/// The light in a column, and how the position of a line depends on it.
struct Column {
    electrons: Vec<f64>,
    coherent: Vec<f64>,
    sensitivities: Vec<f64>,
}

impl Column {
    fn light(&self) -> ColumnLight<'_> {
        ColumnLight {
            electrons: &self.electrons,
            coherent: &self.coherent,
            sensitivities: &self.sensitivities,
        }
    }
}
