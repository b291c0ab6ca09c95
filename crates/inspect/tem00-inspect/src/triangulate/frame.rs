//! The summary of each frame.

use std::collections::BTreeMap;

use tem00_report::report::{Cell, Column, Table, units::NUMBER};
use tem00_scan::MeasuredFrame;
use tem00_triangulation::Validity;

use crate::saturated_points::PointCounts;

/// The summary of a frame.
#[derive(Clone, Debug)]
pub(super) struct FrameRecord {
    pub(super) number: u32,
    pub(super) file: String,
    /// The number of points that were found.
    pub(super) points: usize,
    /// The number of valid points.
    pub(super) valid: usize,
    /// The number of points on saturated pixels.
    pub(super) saturated: usize,
    /// The numbers of points that are not valid, by reason.
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

/// Returns the numbers of points of all frames.
pub(super) fn point_counts(frames: &[FrameRecord]) -> PointCounts {
    let sum = |of: fn(&FrameRecord) -> usize| frames.iter().map(of).sum();
    PointCounts {
        points: sum(|frame| frame.points),
        valid: sum(|frame| frame.valid),
        saturated: sum(|frame| frame.saturated),
    }
}

/// Returns the frames as a table.
pub(super) fn table(frames: &[FrameRecord]) -> Table {
    let columns = [
        Column::new("number", "frame"),
        Column::new("file", "file"),
        Column::new("points", "points found"),
        Column::new("valid", "of them valid"),
        Column::new("saturated", "on saturated pixels"),
        Column::data("not_valid"),
        Column::new("peak_dn", "largest grey value (DN)"),
        Column::new("saturated_pixels", "saturated pixels"),
        Column::new("mean_width_pixels", "mean width of the line, 1/e² (px)"),
    ];
    let mut table = Table::new("What was found in each frame", columns).under("frames");
    for frame in frames {
        table.row([
            frame.number.into(),
            frame.file.as_str().into(),
            frame.points.into(),
            frame.valid.into(),
            frame.saturated.into(),
            Cell::new(&frame.not_valid, ""),
            u32::from(frame.peak).into(),
            frame.saturated_pixels.into(),
            Cell::or_dash(frame.mean_width.map(|width| NUMBER.cell(width))),
        ]);
    }
    table
}
