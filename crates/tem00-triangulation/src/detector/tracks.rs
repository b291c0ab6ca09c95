use std::collections::VecDeque;

use super::LinePoint;

/// The points of a line so far.
struct Track {
    /// The last column with a point.
    last: usize,
    /// The last points that tell where the line goes on: column and place.
    recent: VecDeque<(f64, f64)>,
    points: usize,
    sum: f64,
}

/// Numbers the points of all columns by the lines that they belong to.
pub(super) fn number(columns: &mut [Vec<LinePoint>], window: usize) {
    let gate = (window as f64 / 4.0).max(2.0);
    let most_missing = 2 * window;
    let mut tracks: Vec<Track> = Vec::new();
    let mut active: Vec<usize> = Vec::new();
    for (x, points) in columns.iter_mut().enumerate() {
        active.retain(|&track| x - tracks[track].last <= most_missing + 1);
        let near = near(&tracks, &active, x, points, gate);
        let owners = owners(&near, points.len());
        for (i, (point, owner)) in points.iter_mut().zip(owners).enumerate() {
            let track = owner.unwrap_or(tracks.len());
            if owner.is_none() {
                tracks.push(Track::new());
                active.push(track);
            }
            // Where two lines come close, a point may be of both: it does not tell where one goes.
            let is_clear = near.iter().filter(|pair| pair.point == i).count() < 2;
            tracks[track].add(x, point.position, is_clear);
            point.line = track;
        }
    }
    let numbers = numbers(&tracks);
    let points = columns.iter_mut().flatten();
    points.for_each(|point| point.line = numbers[point.line]);
}

/// A point that may continue a track.
struct Pair {
    distance: f64,
    track: usize,
    point: usize,
}

/// All points of a column that may continue a track, the nearest first.
fn near(
    tracks: &[Track],
    active: &[usize],
    x: usize,
    points: &[LinePoint],
    gate: f64,
) -> Vec<Pair> {
    let mut pairs = Vec::new();
    for &track in active {
        let expected = tracks[track].at(x as f64);
        let pairs_of = points.iter().enumerate().map(|(point, found)| Pair {
            distance: (found.position - expected).abs(),
            track,
            point,
        });
        pairs.extend(pairs_of.filter(|pair| pair.distance <= gate));
    }
    pairs.sort_by(|a, b| a.distance.total_cmp(&b.distance));
    pairs
}

/// The track of each point, each of at most one.
fn owners(near: &[Pair], points: usize) -> Vec<Option<usize>> {
    let mut owners = vec![None; points];
    for pair in near {
        if owners[pair.point].is_none() && !owners.contains(&Some(pair.track)) {
            owners[pair.point] = Some(pair.track);
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
    /// The points that tell where a line goes on.
    const RECENT: usize = 16;
    /// The fewest points that tell a slope.
    const FEWEST: usize = 4;

    const fn new() -> Self {
        Self {
            last: 0,
            recent: VecDeque::new(),
            points: 0,
            sum: 0.0,
        }
    }

    fn add(&mut self, x: usize, position: f64, is_clear: bool) {
        self.last = x;
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

    /// Where the line is expected in a column: on the straight line of least squares.
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
