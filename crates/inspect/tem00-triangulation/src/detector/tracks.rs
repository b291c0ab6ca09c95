use std::collections::VecDeque;

use super::LinePoint;

/// The points of a line so far.
#[derive(Default)]
struct Track {
    /// The last column with a point.
    last: usize,
    /// The last column up to which it was seen, or hidden by another line.
    followed_to: usize,
    /// The last points, which show where the line continues: column and position.
    recent: VecDeque<(f64, f64)>,
    points: usize,
    sum: f64,
}

/// Numbers the points of all columns by the lines that they belong to.
pub(super) fn number(columns: &mut [Vec<LinePoint>], window: usize) {
    let gate = (window as f64 / 4.0).max(2.0);
    let max_missing = 2 * window;
    let mut tracks: Vec<Track> = Vec::new();
    let mut active: Vec<usize> = Vec::new();
    for (x, points) in columns.iter_mut().enumerate() {
        active.retain(|&track| x - tracks[track].last <= max_missing + 1);
        let expected = Expected::of(&tracks, &active, x);
        let near = near(&expected, points, gate);
        let owners = owners(&near, points.len());
        for track in hidden(&expected, points, &owners, window) {
            tracks[track].followed_to = x;
        }
        for (i, (point, owner)) in points.iter_mut().zip(owners).enumerate() {
            let track = owner.unwrap_or(tracks.len());
            if owner.is_none() {
                tracks.push(Track::default());
                active.push(track);
            }
            tracks[track].add(x, point.position, is_clear(&near, i));
            point.line = track;
        }
    }
    let numbers = numbers(&tracks);
    let points = columns.iter_mut().flatten();
    points.for_each(|point| point.line = numbers[point.line]);
}

/// Expected position of a track in a column.
struct Expected {
    track: usize,
    position: f64,
    /// The number of columns since it was seen.
    since: usize,
    /// True if it was seen in the column before, or has been hidden by others ever since it was.
    is_followed: bool,
}

impl Expected {
    fn of(tracks: &[Track], active: &[usize], x: usize) -> Vec<Self> {
        let expected = |&track: &usize| Self {
            track,
            position: tracks[track].at(x as f64),
            since: x - tracks[track].last,
            is_followed: tracks[track].followed_to + 1 == x,
        };
        active.iter().map(expected).collect()
    }
}

/// A point that may continue a track.
struct Pair<'a> {
    expected: &'a Expected,
    point: usize,
    /// The distance between the two, in pixels, times the columns since the line was seen: the
    /// straight line through its last points is the less certain the farther it leads.
    distance: f64,
}

/// Returns all points of a column that may continue a track: first for tracks that were seen in the
/// previous column, then the nearest.
///
/// Where a line has ended, the straight line through its last points leads anywhere, and often over
/// another line.
fn near<'a>(expected: &'a [Expected], points: &[LinePoint], gate: f64) -> Vec<Pair<'a>> {
    let mut pairs = Vec::new();
    for expected in expected {
        let distances = points
            .iter()
            .map(|found| (found.position - expected.position).abs());
        let within = distances
            .enumerate()
            .filter(|(_, distance)| *distance <= gate);
        pairs.extend(within.map(|(point, distance)| Pair {
            expected,
            point,
            distance: distance * expected.since as f64,
        }));
    }
    pairs.sort_by(|a, b| {
        let [a_unseen, b_unseen] = [a, b].map(|pair| pair.expected.since > 1);
        a_unseen
            .cmp(&b_unseen)
            .then(a.distance.total_cmp(&b.distance))
    });
    pairs
}

/// The tracks without a point that may be hidden: lines closer than half a window are seen as one,
/// which continues as another of them. A line that begins hides no other line.
fn hidden(
    expected: &[Expected],
    points: &[LinePoint],
    owners: &[Option<usize>],
    window: usize,
) -> Vec<usize> {
    let reach = (window / 2 + 1) as f64;
    let followed = || expected.iter().filter(|expected| expected.is_followed);
    let goes_on = |owner: &Option<usize>| followed().any(|other| *owner == Some(other.track));
    let of_others: Vec<f64> = points
        .iter()
        .zip(owners)
        .filter(|(_, owner)| goes_on(owner))
        .map(|(point, _)| point.position)
        .collect();
    let is_hidden = |hidden: &&Expected| {
        of_others
            .iter()
            .any(|position| (position - hidden.position).abs() <= reach)
    };
    followed()
        .filter(is_hidden)
        .map(|hidden| hidden.track)
        .collect()
}

/// Returns true if a point belongs to a single line. Where two lines come close, a point may belong
/// to both, and does not show where one of them goes; lines that have ended do not count next to a
/// line that has not.
fn is_clear(near: &[Pair<'_>], point: usize) -> bool {
    let of_point = || near.iter().filter(|pair| pair.point == point);
    let followed = of_point().filter(|pair| pair.expected.is_followed).count();
    match followed {
        0 => of_point().count() < 2,
        _ => followed < 2,
    }
}

/// The track of each point, each of at most one.
fn owners(near: &[Pair<'_>], points: usize) -> Vec<Option<usize>> {
    let mut owners = vec![None; points];
    for pair in near {
        let track = Some(pair.expected.track);
        if owners[pair.point].is_none() && !owners.contains(&track) {
            owners[pair.point] = track;
        }
    }
    owners
}

/// The number of each track.
fn numbers(tracks: &[Track]) -> Vec<usize> {
    let longest = tracks.iter().map(|track| track.points).max().unwrap_or(0);
    let is_short = |track: &Track| 10 * track.points < longest;
    let mut order: Vec<usize> = (0..tracks.len()).collect();
    order.sort_by(|&a, &b| {
        let [a, b] = [&tracks[a], &tracks[b]];
        let by_length = is_short(a).cmp(&is_short(b));
        by_length.then(a.mean().total_cmp(&b.mean()))
    });
    let mut numbers = vec![0; tracks.len()];
    order
        .iter()
        .zip(0..)
        .for_each(|(&track, number)| numbers[track] = number);
    numbers
}

impl Track {
    /// The number of points that predict where a line continues.
    const RECENT: usize = 16;
    /// The minimum number of points that determine a slope.
    const FEWEST: usize = 4;

    fn add(&mut self, x: usize, position: f64, is_clear: bool) {
        self.last = x;
        self.followed_to = x;
        self.points += 1;
        self.sum += position;
        if is_clear || self.recent.len() < Self::FEWEST {
            self.recent.push_back((x as f64, position));
        }
        if self.recent.len() > Self::RECENT {
            self.recent.pop_front();
        }
    }

    fn mean(&self) -> f64 {
        self.sum / self.points as f64
    }

    /// Returns the expected position of the line in a column: on the straight line of least
    /// squares.
    fn at(&self, x: f64) -> f64 {
        let count = self.recent.len() as f64;
        let mean = |of: fn(&(f64, f64)) -> f64| self.recent.iter().map(of).sum::<f64>() / count;
        let (mean_x, mean_y) = (mean(|point| point.0), mean(|point| point.1));
        if self.recent.len() < Self::FEWEST {
            return self.recent.back().map_or(mean_y, |point| point.1);
        }
        let (mut square, mut product) = (0.0, 0.0);
        for (at, y) in &self.recent {
            square += (at - mean_x) * (at - mean_x);
            product += (at - mean_x) * (y - mean_y);
        }
        mean_y + product / square * (x - mean_x)
    }
}
