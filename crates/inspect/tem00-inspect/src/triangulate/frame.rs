//! The summary of each frame.

use std::collections::BTreeMap;

use tem00_report::report::{Cell, Column, Table, units::NUMBER};
use tem00_scan::MeasuredFrame;

use crate::saturated_points::{PointCounts, not_valid};

/// The summary of a frame.
#[derive(Clone, Debug)]
pub(super) struct FrameRecord {
    pub(super) number: u32,
    pub(super) file: String,
    pub(super) counts: PointCounts,
    /// The numbers of points that are not valid, by reason.
    pub(super) not_valid: BTreeMap<&'static str, usize>,
    pub(super) saturated_pixels: usize,
    /// The largest grey value.
    pub(super) peak: u16,
    pub(super) mean_width: Option<f64>,
}

impl FrameRecord {
    pub(super) fn of(frame: &MeasuredFrame, file: String) -> Self {
        let validities = frame.points.iter().map(|point| point.seen.validity);
        let counts = PointCounts::of(validities.clone());
        let widths = frame.points.iter().filter(|point| point.is_valid());
        let width: f64 = widths.map(|point| point.seen.width).sum();
        let mean_width = (counts.valid > 0).then(|| width / counts.valid as f64);
        Self {
            number: frame.frame,
            file,
            counts,
            not_valid: not_valid(validities),
            saturated_pixels: frame.raw.saturated_pixels(),
            peak: frame.raw.values.values().iter().copied().max().unwrap_or(0),
            mean_width,
        }
    }
}

/// Returns the numbers of points of all frames.
pub(super) fn point_counts(frames: &[FrameRecord]) -> PointCounts {
    let counts = frames.iter().map(|frame| frame.counts);
    counts.fold(PointCounts::default(), |sum, counts| PointCounts {
        points: sum.points + counts.points,
        valid: sum.valid + counts.valid,
        saturated: sum.saturated + counts.saturated,
    })
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
    let mut table = Table::new("Results of each frame", columns).under("frames");
    for frame in frames {
        table.row([
            frame.number.into(),
            frame.file.as_str().into(),
            frame.counts.points.into(),
            frame.counts.valid.into(),
            frame.counts.saturated.into(),
            Cell::new(&frame.not_valid, ""),
            u32::from(frame.peak).into(),
            frame.saturated_pixels.into(),
            Cell::or_dash(frame.mean_width.map(|width| NUMBER.cell(width))),
        ]);
    }
    table
}
