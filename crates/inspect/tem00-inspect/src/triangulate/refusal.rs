//! The reason why a measurement has no result, and the remedy.

use tem00_triangulation::Validity;

use super::frame::{FrameRecord, point_counts};
use crate::saturated_points::PointCounts;

/// The reason why nothing was measured, and the remedy.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Refusal {
    pub(super) why: String,
    pub(super) advice: &'static str,
}

impl Refusal {
    /// Returns why no point of the frames is valid, or too few to measure with.
    pub(super) fn of(frames: &[FrameRecord]) -> Self {
        let PointCounts { points, valid, .. } = point_counts(frames);
        let count = |reason: &Reason| -> usize {
            let counts = frames
                .iter()
                .map(|frame| frame.not_valid.get(reason.0.name()));
            counts.flatten().sum()
        };
        let max = REASONS
            .iter()
            .map(|reason| (count(reason), reason))
            .max_by_key(|(count, _)| *count)
            .filter(|(count, _)| *count > 0);
        match max {
            Some((count, (_, what, advice))) => Self {
                why: if valid == 0 {
                    format!("none of {points} points of the line is valid: {count} {what}")
                } else {
                    format!("{count} of {points} points of the line {what}")
                },
                advice,
            },
            None => Self::without_points(frames),
        }
    }

    fn without_points(frames: &[FrameRecord]) -> Self {
        let peak = frames.iter().map(|frame| frame.peak).max().unwrap_or(0);
        let is_saturated = frames.iter().any(|frame| frame.saturated_pixels > 0);
        Self {
            why: format!("no line was found; the largest grey value is {peak} DN"),
            advice: if is_saturated {
                BRIGHT
            } else {
                "look at the raw frames: is the line in the image? If it is too dark, raise \
                 `exposure` in [sensor] or `power` in [[laser]]"
            },
        }
    }
}

/// A validity, its description and its remedy.
type Reason = (Validity, &'static str, &'static str);

/// The sentence on saturated pixels, and what helps.
pub(super) const BRIGHT: &str =
    "pixels are saturated: lower `exposure` in [sensor] or `power` in [[laser]]";

const REASONS: [Reason; 6] = [
    (Validity::Saturated, "lie on saturated pixels", BRIGHT),
    (
        Validity::Cut,
        "lie closer to an edge of the image than half a window",
        "lower `window` in [detector], or show more of the part",
    ),
    (
        Validity::Crowded,
        "lie within a window of another line",
        "lower `window` or `max_lines` in [detector]",
    ),
    (
        Validity::Sliver,
        "are slivers of a line at the edge of the part, or noise",
        "look at the raw frames: does the line fall on the part?",
    ),
    (
        Validity::Failed,
        "have no estimate of their position",
        "try another `method` or a wider `window` in [detector]",
    ),
    (
        Validity::Missing,
        "have pixels without a value",
        "look at the raw frames",
    ),
];

#[cfg(test)]
mod tests {
    use super::*;

    fn frame(points: usize, not_valid: &[(&'static str, usize)]) -> FrameRecord {
        FrameRecord {
            number: 0,
            file: String::new(),
            counts: PointCounts {
                points,
                ..PointCounts::default()
            },
            not_valid: not_valid.iter().copied().collect(),
            saturated_pixels: 0,
            peak: 90,
            mean_width: None,
        }
    }

    #[test]
    fn the_most_frequent_reason_is_told_with_what_helps() {
        let frames = [
            frame(5, &[("saturated", 2), ("cut", 3)]),
            frame(4, &[("saturated", 4)]),
        ];
        let dark = [frame(0, &[])];
        for (frames, why, advice) in [
            (&frames[..], "9 points", "lower `exposure`"),
            (&frames, "6 lie on saturated pixels", "lower `exposure`"),
            (&dark, "90 DN", "raise `exposure`"),
        ] {
            let found = Refusal::of(frames);
            assert!(found.why.contains(why), "{found:?}");
            assert!(found.advice.contains(advice), "{found:?}");
        }
    }

    #[test]
    fn every_reason_has_its_words() {
        for frames in REASONS.map(|(validity, ..)| [frame(1, &[(validity.name(), 1)])]) {
            let found = Refusal::of(&frames);
            assert!(found.why.contains("1 points of the line"), "{found:?}");
        }
    }
}
