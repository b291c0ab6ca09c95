//! The terms of the height uncertainty, over all points.

use tem00_numerics::cast::to_usize;
use tem00_report::report::{
    Cell, Column, Table,
    units::{MICROMETRES, NUMBER, PERCENT},
};
use tem00_scan::MeasuredPoint;
use tem00_triangulation::{DVec3, UncertaintySource};

/// Term of the uncertainty.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Term {
    /// The source of the error.
    pub(super) name: &'static str,
    /// Advice that lowers the term.
    remedy: &'static str,
    /// The standard uncertainty of a line's position, in pixels; `None` for the calibration.
    pub(super) position: Option<f64>,
    /// The standard uncertainty of a height, in metres.
    pub(super) height: f64,
    /// The fraction of the variance of a height that it contributes, from 0 to 1.
    pub(super) variance_fraction: f64,
}

impl Term {
    fn new(source: Option<UncertaintySource>, position: Option<f64>, variance: f64) -> Self {
        let indirect =
            "another pose, a duller surface or a smaller window reduces it; averaging does not";
        Self {
            name: source.map_or("indirect light", UncertaintySource::name),
            remedy: source.map_or(indirect, UncertaintySource::remedy),
            position,
            height: variance.sqrt(),
            variance_fraction: 0.0,
        }
    }
}

/// The terms, as root mean squares over the valid points.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Terms {
    /// The number of valid points.
    pub(super) points: usize,
    /// The fraction of valid points for which a tenth or more of the light met a second surface.
    pub(super) indirect: f64,
    /// The number of valid points on lines of such light alone, which the terms leave out.
    pub(super) alone: usize,
    /// Each term.
    pub(super) terms: Vec<Term>,
    /// The combined standard uncertainty of a height, in metres.
    pub(super) combined: f64,
    /// The expanded uncertainty of a height for a level of confidence of 95 %, in metres.
    pub(super) expanded: f64,
    /// The median of the points' own expanded uncertainties, and the value that 95 % of them do not
    /// exceed.
    pub(super) quantiles: [f64; 2],
}

/// The coverage factor of 95 % of a normal distribution.
const COVERAGE: f64 = 1.96;

/// A term of the variance of a position, in square pixels.
type Variance = fn(&MeasuredPoint) -> f64;

/// The terms of the variance of a position; light that met a second surface is not noise.
const OF_POSITION: [(Option<UncertaintySource>, Variance); 7] = [
    (Some(UncertaintySource::Speckle), |point| {
        point.noise.speckle
    }),
    (Some(UncertaintySource::ShotNoise), |point| point.noise.shot),
    (Some(UncertaintySource::DarkNoise), |point| point.noise.dark),
    (Some(UncertaintySource::Quantisation), |point| {
        point.noise.quantisation
    }),
    (Some(UncertaintySource::Prnu), |point| point.noise.prnu),
    (Some(UncertaintySource::Dsnu), |point| point.noise.dsnu),
    (None, |point| point.indirect.shift.powi(2)),
];

/// The minimum fraction of indirect light in a line for which a point is counted.
const MUCH: f64 = 0.1;

impl Terms {
    /// Sums up the terms of all valid points for heights along a direction; `None` if there is
    /// none.
    pub(super) fn of(profiles: &[Vec<MeasuredPoint>], height: DVec3) -> Option<Self> {
        let all = || profiles.iter().flatten().filter(|point| point.is_valid());
        let found = all().count();
        // Their errors are as large as the part, and would dominate a mean square.
        let alone = all().filter(|point| point.indirect.alone).count();
        let valid = || all().filter(|point| alone == found || !point.indirect.alone);
        let points = valid().count();
        if points == 0 {
            return None;
        }
        let mean = |term: &dyn Fn(&MeasuredPoint) -> f64| {
            let count = points as f64;
            valid().map(term).sum::<f64>() / count
        };
        let mut terms: Vec<Term> = OF_POSITION
            .iter()
            .map(|(source, of)| {
                let per_pixel = |point: &MeasuredPoint| point.per_pixel.dot(height).powi(2);
                let variance = mean(&|point| of(point) * per_pixel(point));
                Term::new(*source, Some(mean(of).sqrt()), variance)
            })
            .collect();
        let calibration = mean(&|point| point.calibration_uncertainty_along(height).powi(2));
        terms.push(Term::new(
            Some(UncertaintySource::Calibration),
            None,
            calibration,
        ));
        let variance: f64 = terms.iter().map(|term| term.height.powi(2)).sum();
        for term in terms.iter_mut().filter(|_| variance > 0.0) {
            term.variance_fraction = term.height.powi(2) / variance;
        }
        let has_much = |point: &MeasuredPoint| f64::from(u8::from(point.indirect.fraction >= MUCH));
        Some(Self {
            points,
            indirect: mean(&has_much),
            alone,
            terms,
            combined: variance.sqrt(),
            expanded: COVERAGE * variance.sqrt(),
            quantiles: {
                let of_point = |point: &MeasuredPoint| COVERAGE * point.uncertainty_along(height);
                let mut own: Vec<f64> = valid().map(of_point).collect();
                own.sort_by(f64::total_cmp);
                [0.5, 0.95].map(|part| quantile(&own, part))
            },
        })
    }

    /// Returns the term that counts most.
    pub(super) fn dominant(&self) -> Option<&Term> {
        let terms = self.terms.iter();
        terms.max_by(|a, b| a.variance_fraction.total_cmp(&b.variance_fraction))
    }

    /// Returns the uncertainty of heights, what dominates and what lowers it.
    pub(super) fn verdict(&self) -> String {
        let dominant = self.dominant().map_or_else(String::new, |term| {
            format!(
                " The largest term is {}, with {:.0} % of the variance: {}.",
                term.name,
                100.0 * term.variance_fraction,
                term.remedy
            )
        });
        format!(
            "Expanded uncertainty of the height of a point: U = {} (95 %, k = {COVERAGE}), as root \
             mean square of {} points; half of them have {} at most, 95 % of them {}.{dominant}",
            MICROMETRES.with_digits(3).text(self.expanded),
            self.points,
            MICROMETRES.with_digits(3).text(self.quantiles[0]),
            MICROMETRES.with_digits(3).text(self.quantiles[1]),
        )
    }

    /// Notes the light that met a second surface, where there is much of it.
    pub(super) fn notes_of_indirect_light(&self) -> Vec<String> {
        let mut lines = Vec::new();
        if self.indirect > 0.0 {
            lines.push(format!(
                "In {} of the points a tenth or more of the light came by a second surface. No \
                 repetition shows what that moves them by; u has it, as the render knows it.",
                PERCENT.with_digits(2).text(self.indirect)
            ));
        }
        if self.alone > 0 {
            lines.push(format!(
                "Points on lines of such light alone, left out of U: {}.",
                self.alone
            ));
        }
        lines
    }

    /// Returns the terms as a table.
    pub(super) fn table(&self) -> Table {
        let columns = [
            Column::new("name", "term"),
            Column::new("position_pixels", "position (px)"),
            Column::new("height", "height (µm)"),
            Column::new("variance_fraction", "part of u² (%)"),
        ];
        let caption = "Root mean squares over all valid points";
        let mut table = Table::new(caption, columns).under("terms");
        for term in &self.terms {
            table.row([
                term.name.into(),
                Cell::or_dash(term.position.map(|position| NUMBER.cell(position))),
                MICROMETRES.cell(term.height),
                PERCENT.with_digits(3).cell(term.variance_fraction),
            ]);
        }
        for (name, length) in [
            ("combined", self.combined),
            ("expanded, 95 %", self.expanded),
        ] {
            table.total([name.into(), Cell::default(), MICROMETRES.cell(length)]);
        }
        table
    }
}

/// Returns the smallest of the `ascending` values that the fraction `part` of them does not exceed.
/// There is at least one value.
fn quantile(ascending: &[f64], part: f64) -> f64 {
    let rank = to_usize((part * ascending.len() as f64).ceil());
    ascending[rank.clamp(1, ascending.len()) - 1]
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn without_a_valid_point_there_are_no_terms() {
        assert_eq!(Terms::of(&[], DVec3::Z), None);
        assert_eq!(Terms::of(&[vec![], vec![]], DVec3::Z), None);
    }

    #[test]
    #[expect(clippy::float_cmp, reason = "values of the list")]
    fn a_quantile_is_the_least_value_that_is_not_exceeded() {
        let values: Vec<f64> = (1..=20).map(f64::from).collect();
        for (count, part, expected) in [
            (20, 0.5, 10.0),
            (20, 0.95, 19.0),
            (19, 0.5, 10.0),
            (19, 0.95, 19.0),
            (2, 0.5, 1.0),
            (1, 0.95, 1.0),
        ] {
            let found = quantile(&values[..count], part);
            assert_eq!(found, expected, "{part} of {count}");
        }
    }
}
