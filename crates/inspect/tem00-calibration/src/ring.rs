use glam::DVec2;
use tem00_numerics::Grid;

/// The ring of pixels, at a distance of about 5, on which a corner of squares shows: sixteen
/// directions.
const RING: [(i32, i32); 16] = [
    (5, 0),
    (5, 2),
    (4, 4),
    (2, 5),
    (0, 5),
    (-2, 5),
    (-4, 4),
    (-5, 2),
    (-5, 0),
    (-5, -2),
    (-4, -4),
    (-2, -5),
    (0, -5),
    (2, -5),
    (4, -4),
    (5, -2),
];

/// Reach of the ring, in pixels.
pub(super) const REACH: usize = 5;

/// Maximum number of candidates kept per expected corner.
const MAX_CANDIDATES: usize = 3;

/// The minimum response of a corner, as a fraction of the response of a typical corner.
const MIN_RESPONSE: f64 = 0.2;

/// Returns the positions that look like corners where four squares meet, the clearest first: local
/// maxima of a response to rings that are bright, dark, bright and dark.
///
/// `number` corners are expected; positions that respond much less are left out.
///
/// # References
///
/// - S. Bennett and J. Lasenby, *`ChESS` – Quick and Robust Detection of Chess-board
///   Features*, 2014.
pub(super) fn corner_candidates(image: &Grid<f32>, number: usize) -> Vec<DVec2> {
    let responses = Grid::from_fn(image.width(), image.height(), |x, y| response(image, x, y));
    let mut peaks = peaks(&responses);
    peaks.sort_by(|one, two| two.0.total_cmp(&one.0));
    let typical = peaks.get(number / 2).map_or(0.0, |peak| peak.0);
    peaks
        .into_iter()
        .take_while(|peak| peak.0 > MIN_RESPONSE * typical)
        .take(MAX_CANDIDATES * number)
        .map(|peak| peak.1)
        .collect()
}

/// Returns the likeness of the ring about a pixel to the ring of a corner.
///
/// ```text
/// Σ |I_n + I_{n+8} − I_{n+4} − I_{n+12}|       opposite alike, quarters unlike: four terms
/// − Σ |I_n − I_{n+8}|                           an edge: eight terms
/// − 16 |mean of the ring − mean at the middle|  a stripe or a dot
/// ```
fn response(image: &Grid<f32>, x: usize, y: usize) -> f64 {
    let inside = |at: usize, size: usize| at >= REACH && at + REACH < size;
    if !inside(x, image.width()) || !inside(y, image.height()) {
        return 0.0;
    }
    let at = |(dx, dy): (i32, i32)| {
        let shifted = |at: usize, by: i32| at.wrapping_add_signed(by as isize);
        f64::from(image[(shifted(x, dx), shifted(y, dy))])
    };
    let ring = RING.map(at);
    let crosses = (0..4).map(|n| (ring[n] + ring[n + 8] - ring[n + 4] - ring[n + 12]).abs());
    let edges = (0..8).map(|n| (ring[n] - ring[n + 8]).abs());
    let middle = [(0, 0), (1, 0), (-1, 0), (0, 1), (0, -1)].map(at);
    let mean = ring.iter().sum::<f64>() / 16.0 - middle.iter().sum::<f64>() / 5.0;
    crosses.sum::<f64>() - edges.sum::<f64>() - 16.0 * mean.abs()
}

/// Returns the positive values that no other within the reach of a ring exceeds, with the middles
/// of their pixels.
fn peaks(responses: &Grid<f64>) -> Vec<(f64, DVec2)> {
    let mut peaks = Vec::new();
    for y in REACH..responses.height().saturating_sub(REACH) {
        for x in REACH..responses.width().saturating_sub(REACH) {
            let value = responses[(x, y)];
            if value > 0.0 && is_greatest(responses, (x, y), value) {
                peaks.push((value, DVec2::new(x as f64 + 0.5, y as f64 + 0.5)));
            }
        }
    }
    peaks
}

/// Returns whether a response is a local maximum; of equal neighbours the first counts.
fn is_greatest(responses: &Grid<f64>, (x, y): (usize, usize), value: f64) -> bool {
    (y - REACH..=y + REACH).all(|v| {
        (x - REACH..=x + REACH).all(|u| {
            let other = responses[(u, v)];
            other < value || (other <= value && (v, u) >= (y, x))
        })
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    fn found(grey: impl Fn(f64, f64) -> bool) -> Vec<DVec2> {
        let image = Grid::from_fn(40, 40, |x, y| {
            let bright = grey(x as f64 + 0.5 - 20.0, y as f64 + 0.5 - 20.0);
            if bright { 200.0 } else { 20.0 }
        });
        corner_candidates(&image, 1)
    }

    #[test]
    fn corners_are_seen_in_every_direction() {
        for degrees in [0.0_f64, 20.0, 45.0, 70.0] {
            let direction = DVec2::from_angle(degrees.to_radians());
            let positions = found(|x, y| {
                let turned = direction.rotate(DVec2::new(x, y));
                (turned.x > 0.0) == (turned.y > 0.0)
            });
            assert_eq!(positions.len(), 1, "{degrees}°: {positions:?}");
            // The response hardly falls within two pixels; the position is refined later.
            let distance = positions[0].distance(DVec2::splat(20.0));
            assert!(distance < 2.0, "{distance}");
        }
    }

    #[test]
    fn edges_stripes_dots_and_flat_images_are_no_corners() {
        assert!(found(|x, _| x > 0.0).is_empty(), "an edge");
        assert!(found(|x, _| x.abs() < 2.0).is_empty(), "a stripe");
        assert!(found(|x, y| x.hypot(y) < 3.0).is_empty(), "a dot");
        let outer = found(|x, y| x > 0.0 && y > 0.0);
        assert!(outer.is_empty(), "an outer corner");
        assert!(found(|_, _| true).is_empty(), "nothing");
    }
}
