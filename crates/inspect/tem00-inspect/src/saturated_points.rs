//! Points of lines on saturated pixels: the judgement that all commands share.

use std::collections::BTreeMap;

use tem00_triangulation::Validity;

/// Returns the numbers of points that are not valid, by reason.
pub(crate) fn not_valid(
    validities: impl Iterator<Item = Validity>,
) -> BTreeMap<&'static str, usize> {
    let mut counts = BTreeMap::new();
    for validity in validities.filter(|validity| *validity != Validity::Valid) {
        *counts.entry(validity.name()).or_default() += 1;
    }
    counts
}

/// The fraction of points on saturated pixels above which a warning is given.
const TOLD: f64 = 0.05;

/// The fraction of points on saturated pixels above which the other points give no result: they are
/// the dark part of what was to be measured.
const TOO_MANY: f64 = 0.5;

/// Numbers of points of lines.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(crate) struct PointCounts {
    /// Number of points found.
    pub(crate) points: usize,
    /// Number of valid points.
    pub(crate) valid: usize,
    /// Number of points on saturated pixels.
    pub(crate) saturated: usize,
}

impl PointCounts {
    /// Counts points by their validities.
    pub(crate) fn of(validities: impl Iterator<Item = Validity>) -> Self {
        validities.fold(Self::default(), |counts, validity| Self {
            points: counts.points + 1,
            valid: counts.valid + usize::from(validity == Validity::Valid),
            saturated: counts.saturated + usize::from(validity == Validity::Saturated),
        })
    }

    /// Returns a warning if many points are saturated; `because` gives the reason and the remedy.
    pub(crate) fn warning(&self, because: &str) -> Option<String> {
        let fraction = self.fraction(self.saturated);
        (fraction > TOLD).then(|| {
            format!(
                "{:.0} % of the points are not valid, {:.0} % because {because}",
                100.0 * self.fraction(self.points - self.valid),
                100.0 * fraction
            )
        })
    }

    /// Returns whether so many points are on saturated pixels that the others give no result.
    pub(crate) fn are_too_many(&self) -> bool {
        self.fraction(self.saturated) > TOO_MANY
    }

    fn fraction(&self, count: usize) -> f64 {
        count as f64 / self.points.max(1) as f64
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn saturation_is_told_above_a_twentieth_and_no_result_above_one_half() {
        for (saturated, is_told, are_too_many) in [
            (0, false, false),
            (50, false, false),
            (51, true, false),
            (500, true, false),
            (501, true, true),
            (1_000, true, true),
        ] {
            let of = |validity, count| core::iter::repeat_n(validity, count);
            let points = of(Validity::Saturated, saturated)
                .chain(of(Validity::Cut, (1_000 - saturated) / 2))
                .chain(of(Validity::Valid, (1_001 - saturated) / 2));
            let counts = PointCounts::of(points);
            assert_eq!(counts.points, 1_000);
            let told = counts.warning("of them");
            assert_eq!(told.is_some(), is_told, "{saturated}: {told:?}");
            assert_eq!(counts.are_too_many(), are_too_many, "{saturated}");
        }
        assert_eq!(PointCounts::default().warning("of them"), None, "no points");
    }
}
