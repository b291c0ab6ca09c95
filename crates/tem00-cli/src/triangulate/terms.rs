//! What makes heights uncertain, over all points.

use core::fmt::Write as _;

use serde::Serialize;
use tem00_triangulation::{DVec3, MeasuredPoint, PlaceNoise, UncertaintySource};

/// One term of the uncertainty.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub(super) struct Term {
    /// What it comes from.
    pub(super) name: &'static str,
    /// The standard uncertainty of a line's place, in pixels; none of the calibration.
    pub(super) place: Option<f64>,
    /// The standard uncertainty of a height, in metres.
    pub(super) height: f64,
    /// The share of the variance of a height, from 0 to 1.
    pub(super) share: f64,
}

/// The terms, as root mean squares over the valid points.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub(super) struct Terms {
    /// The number of valid points.
    pub(super) points: usize,
    /// Each term.
    pub(super) terms: Vec<Term>,
    /// The combined standard uncertainty of a height, in metres.
    pub(super) combined: f64,
    /// The expanded uncertainty of a height for a level of confidence of 95 %, in metres.
    pub(super) expanded: f64,
}

/// The coverage factor of 95 % of a normal distribution.
const COVERAGE: f64 = 1.96;

/// A term of the noise of a place, in square pixels.
type Variance = fn(&PlaceNoise) -> f64;

/// The terms of the noise of a place, by name.
const NOISE: [(&str, Variance); 6] = [
    ("speckle", |noise| noise.speckle),
    ("shot noise", |noise| noise.shot),
    ("dark noise", |noise| noise.dark),
    ("quantisation", |noise| noise.quantisation),
    ("PRNU", |noise| noise.prnu),
    ("DSNU", |noise| noise.dsnu),
];

/// The term that is not one of a place.
const CALIBRATION: &str = "calibration";

impl Terms {
    /// Sums up the terms of all valid points for heights along a direction; `None` if there is none.
    pub(super) fn of(profiles: &[Vec<MeasuredPoint>], height: DVec3) -> Option<Self> {
        let valid = || profiles.iter().flatten().filter(|point| point.is_valid());
        let points = valid().count();
        if points == 0 {
            return None;
        }
        let mean = |term: &dyn Fn(&MeasuredPoint) -> f64| {
            let count = points as f64;
            valid().map(term).sum::<f64>() / count
        };
        let mut terms: Vec<Term> = NOISE
            .iter()
            .map(|(name, of)| {
                let per_pixel = |point: &MeasuredPoint| point.per_pixel.dot(height).powi(2);
                let variance = mean(&|point| of(&point.noise) * per_pixel(point));
                Term {
                    name,
                    place: Some(mean(&|point| of(&point.noise)).sqrt()),
                    height: variance.sqrt(),
                    share: 0.0,
                }
            })
            .collect();
        let calibration = mean(&|point| point.calibration_uncertainty_along(height).powi(2));
        terms.push(Term {
            name: CALIBRATION,
            place: None,
            height: calibration.sqrt(),
            share: 0.0,
        });
        let variance: f64 = terms.iter().map(|term| term.height.powi(2)).sum();
        for term in terms.iter_mut().filter(|_| variance > 0.0) {
            term.share = term.height.powi(2) / variance;
        }
        Some(Self {
            points,
            terms,
            combined: variance.sqrt(),
            expanded: COVERAGE * variance.sqrt(),
        })
    }

    /// Returns the term that counts most.
    pub(super) fn dominant(&self) -> Option<&Term> {
        let terms = self.terms.iter();
        terms.max_by(|a, b| a.share.total_cmp(&b.share))
    }

    /// Returns how well heights are known, what dominates and what lowers it.
    pub(super) fn verdict(&self) -> String {
        let dominant = self.dominant().map_or_else(String::new, |term| {
            format!(
                " What dominates is {}, with {:.0} % of the variance: {}.",
                term.name,
                100.0 * term.share,
                remedy(term.name)
            )
        });
        format!(
            "Expanded uncertainty of the height of a point: U = {} (95 %, k = {COVERAGE}), as root mean \
             square of {} points.{dominant}",
            micrometres(self.expanded),
            self.points,
        )
    }

    /// Returns the table for a terminal.
    pub(super) fn text(&self) -> String {
        let mut text = format!(
            "{:<14}{:>14}{:>14}{:>9}\n",
            "term", "place (px)", "height (µm)", "share"
        );
        for term in &self.terms {
            let place = term
                .place
                .map_or("-".to_owned(), |place| format!("{place:.4}"));
            // Memory takes whatever it is given.
            let _ = writeln!(
                text,
                "{:<14}{place:>14}{:>14.3}{:>7.1} %",
                term.name,
                1e6 * term.height,
                100.0 * term.share
            );
        }
        let _ = writeln!(
            text,
            "{:<14}{:>14}{:>14.3}\n{:<14}{:>14}{:>14.3}",
            "combined",
            "",
            1e6 * self.combined,
            "expanded, 95 %",
            "",
            1e6 * self.expanded
        );
        let _ = writeln!(text, "{}", self.verdict());
        text
    }
}

/// Returns what lowers a term.
fn remedy(name: &str) -> &'static str {
    let mut sources = UncertaintySource::ALL.into_iter();
    let source = sources.find(|source| source.name() == name);
    source.map_or("", UncertaintySource::remedy)
}

/// A length in micrometres, with three digits or so.
pub(super) fn micrometres(length: f64) -> String {
    let value = 1e6 * length;
    let digits = if value.abs() >= 100.0 {
        0
    } else if value.abs() >= 10.0 {
        1
    } else {
        2
    };
    format!("{value:.digits$} µm")
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
    fn every_term_has_a_remedy() {
        for (name, _) in NOISE {
            assert!(!remedy(name).is_empty(), "{name}");
        }
        assert!(!remedy(CALIBRATION).is_empty(), "{CALIBRATION}");
    }
}
