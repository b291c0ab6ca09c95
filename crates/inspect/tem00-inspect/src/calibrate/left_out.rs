//! Parts of line photographs that a calibration cannot use.

use std::path::Path;

use tem00_calibration::CalibrationQuality;
use tem00_report::output::name;
use tem00_triangulation::{LinePoint, Validity};

use crate::{
    lines::notes::{SATURATED, reason},
    saturated_points::{PointCounts, not_valid},
};

/// The points of the line that were found in photographs: one in each column.
#[derive(Debug, Default)]
pub(super) struct FoundPoints {
    /// Validities of the points of all photographs.
    validities: Vec<Validity>,
    pictures: usize,
    /// The photographs without a valid point, and why they have none.
    empty: Vec<String>,
    boards_without_line: usize,
}

impl FoundPoints {
    /// Adds a photograph of a line, or that a board has none.
    pub(super) fn add(&mut self, picture: Option<&Path>, columns: &[Vec<LinePoint>]) {
        let Some(picture) = picture else {
            self.boards_without_line += 1;
            return;
        };
        self.pictures += 1;
        let of_column = |points: &Vec<LinePoint>| {
            let is_valid = |point: &&LinePoint| point.validity == Validity::Valid;
            let first = points.iter().find(is_valid).or(points.first());
            first.map(|point| point.validity)
        };
        let found: Vec<Validity> = columns.iter().filter_map(of_column).collect();
        if !found.contains(&Validity::Valid) {
            let why = most_frequent(&found).map_or_else(
                || "no line was found: --min-peak takes fainter ones".to_owned(),
                reason,
            );
            self.empty
                .push(format!("{} ({why})", name(picture, "line")));
        }
        self.validities.extend(found);
    }

    /// Returns how many points of the line were used, and why the others were not.
    pub(super) fn sentence(&self, quality: &CalibrationQuality) -> String {
        let counts = self.counts();
        let used = quality.line_points;
        let beyond = counts.valid.saturating_sub(used + quality.outliers);
        let mut reasons = vec![format!("{} too far off", quality.outliers)];
        if beyond > 0 {
            reasons.push(format!("{beyond} beyond the boards"));
        }
        let not_valid = not_valid(self.validities.iter().copied()).into_iter();
        reasons.extend(not_valid.map(|(name, count)| format!("{count} {name}")));
        format!(
            "{used} of {} points of the line, in {} of {} pictures, are used; left out: {}.",
            counts.points,
            self.pictures - self.empty.len(),
            self.pictures,
            reasons.join(", ")
        )
    }

    /// Returns the reasons for doubt: saturation, and photographs without results.
    pub(super) fn warnings(&self) -> Vec<String> {
        let mut warnings: Vec<String> = self.counts().warning(SATURATED).into_iter().collect();
        if !self.empty.is_empty() {
            warnings.push(format!(
                "{} of {} pictures of the line gave no point: {}",
                self.empty.len(),
                self.pictures,
                self.empty.join(", ")
            ));
        }
        if self.boards_without_line > 0 {
            warnings.push(format!(
                "{} boards have no picture of the line: they count for the camera alone",
                self.boards_without_line
            ));
        }
        warnings
    }

    fn counts(&self) -> PointCounts {
        PointCounts::of(self.validities.iter().copied())
    }
}

fn most_frequent(validities: &[Validity]) -> Option<Validity> {
    let count = |of: &Validity| validities.iter().filter(|validity| *validity == of).count();
    validities.iter().copied().max_by_key(count)
}
