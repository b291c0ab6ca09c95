use core::ops::ControlFlow;

use tem00_numerics::cast::to_usize;

use super::profile::Profile;

/// The centre of gravity over the window.
pub(super) fn plain(profile: &Profile<'_>) -> Option<f64> {
    centre(profile, |value| value)
}

/// The centre of gravity of the values above a fraction of the greatest value.
pub(super) fn thresholded(profile: &Profile<'_>, threshold: f64) -> Option<f64> {
    let level = threshold * profile.at(0);
    centre(profile, |value| (value - level).max(0.0))
}

/// The centre of gravity, if it lies in the window.
fn centre(profile: &Profile<'_>, weight: impl Fn(f64) -> f64) -> Option<f64> {
    let weights = profile.pixels().map(|(y, value)| (y, weight(value)));
    let (sum, moment) = weights.fold((0.0, 0.0), |(sum, moment), (y, weight)| {
        (sum + weight, moment + weight * y)
    });
    let (first, last) = ends(profile)?;
    // Negative values can leave next to nothing to divide by.
    let centre = moment / sum;
    (sum > 0.0 && first <= centre && centre <= last).then_some(centre)
}

/// The outer edges of the window, as distances from the middle of the greatest pixel.
fn ends(profile: &Profile<'_>) -> Option<(f64, f64)> {
    let (first, _) = profile.pixels().next()?;
    let (last, _) = profile.pixels().next_back()?;
    Some((first - 0.5, last + 0.5))
}

/// The centre of gravity over a window about itself.
pub(super) fn iterated(profile: &Profile<'_>) -> Option<f64> {
    const MAX_STEPS: usize = 500;
    /// In pixels.
    const STAYS: f64 = 1e-12;
    let (first, last) = ends(profile)?;
    let half = (last - first) / 2.0;
    let start = first + half;
    let found = (0..MAX_STEPS).try_fold(start, |centre, _| match about(profile, centre, half) {
        None => ControlFlow::Break(None),
        Some(next) if (next - centre).abs() <= STAYS => ControlFlow::Break(Some(next)),
        Some(next) => ControlFlow::Continue(next),
    });
    found.break_value().flatten()
}

/// The centre of gravity of the grey values, constant over each pixel, from `centre − half` to
/// `centre + half`, as far as the line's own pixels reach.
fn about(profile: &Profile<'_>, centre: f64, half: f64) -> Option<f64> {
    let (zone, origin) = (&profile.line.zone, profile.line.greatest as f64);
    let (from, to) = (centre - half, centre + half);
    let first = to_usize((from + origin).floor()).max(zone.start);
    let end = (to_usize((to + origin).ceil()) + 1).min(zone.end);
    let (mut sum, mut moment) = (0.0, 0.0);
    for i in first..end {
        let y = i as f64 - origin;
        let (low, high) = ((y - 0.5).max(from), (y + 0.5).min(to));
        if low < high {
            let weight = (high - low) * profile.above[i];
            sum += weight;
            moment += weight * (low + high) / 2.0;
        }
    }
    let next = moment / sum;
    (sum > 0.0 && from <= next && next <= to).then_some(next)
}
