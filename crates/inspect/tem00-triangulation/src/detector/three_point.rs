use super::profile::Profile;

/// The greatest value and its neighbours: before, at and after.
fn three(profile: &Profile<'_>) -> [f64; 3] {
    [-1, 0, 1].map(|offset| profile.at(offset))
}

/// The vertex of the parabola.
pub(super) fn parabola(profile: &Profile<'_>) -> Option<f64> {
    vertex(three(profile))
}

/// The vertex of the parabola through the logarithms.
pub(super) fn log_gaussian(profile: &Profile<'_>) -> Option<f64> {
    let values = three(profile);
    let has_logarithms = values.iter().all(|&value| value > 0.0);
    has_logarithms
        .then(|| vertex(values.map(f64::ln)))
        .flatten()
}

fn vertex([before, at, after]: [f64; 3]) -> Option<f64> {
    let curvature = (at - before) + (at - after);
    (curvature > 0.0).then(|| (after - before) / (2.0 * curvature))
}

/// Returns the position where straight flanks of equal slope meet.
pub(super) fn linear(profile: &Profile<'_>) -> Option<f64> {
    let [before, at, after] = three(profile);
    let rise = at - before.min(after);
    (rise > 0.0).then(|| (after - before) / (2.0 * rise))
}
