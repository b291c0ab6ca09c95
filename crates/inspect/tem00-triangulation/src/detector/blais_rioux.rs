use super::{FilterOrder, profile::Profile};

/// The zero of the filtered derivative nearest to the greatest pixel, on the side to which it
/// points.
pub(super) fn zero(profile: &Profile<'_>, order: FilterOrder) -> Option<f64> {
    let filtered = |at: isize| filter(profile, at, order);
    // A window that was moved may have left its greatest pixel.
    let greatest = profile.line.greatest.cast_signed();
    let [start, end] = [profile.line.window.start, profile.line.window.end]
        .map(|end| end.cast_signed() - greatest);
    // The derivative is negative where the line lies further down, for the filter is its negative.
    let crossing = |i: &isize| filtered(*i) <= 0.0 && filtered(*i + 1) > 0.0;
    let found = if filtered(0) <= 0.0 {
        (0..end).find(crossing)
    } else {
        (start - 1..0).rev().find(crossing)
    };
    found.map(|i| {
        let (before, after) = (filtered(i), filtered(i + 1));
        i as f64 + before / (before - after)
    })
}

/// Returns the sum of the pixels above minus the sum of the pixels below one pixel, at a distance
/// from the greatest one.
fn filter(profile: &Profile<'_>, at: isize, order: FilterOrder) -> f64 {
    let half = (order.taps() / 2).cast_signed();
    (1..=half)
        .map(|tap| profile.at(at - tap) - profile.at(at + tap))
        .sum()
}
