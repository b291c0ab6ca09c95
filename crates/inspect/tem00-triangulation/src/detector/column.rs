use core::ops::Range;

use super::DetectorSettings;

/// A column of an image, with the lines that stand out of it.
pub(super) struct Column {
    /// The grey values above the background; values that are not finite count as background.
    pub(super) above: Vec<f64>,
    /// The grey value of the background.
    pub(super) background: f64,
    /// The pixels that the background was taken from.
    pub(super) background_pixels: Vec<usize>,
    /// The lines from the top.
    pub(super) lines: Vec<Sighting>,
    /// The column in which they were looked for.
    pub(super) smooth: Smoothed,
}

/// A line that stands out of a column, before its position is estimated.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(super) struct Sighting {
    /// The pixel in the middle of the window: the maximum of the smoothed column.
    pub(super) centre: usize,
    /// The pixels up to where the neighbouring lines begin.
    pub(super) zone: Range<usize>,
    /// The pixels of the window, in the zone.
    pub(super) window: Range<usize>,
    /// The greatest pixel of the window.
    pub(super) greatest: usize,
}

impl Sighting {
    /// Returns true if the window reaches beyond a column of `length` pixels.
    pub(super) const fn is_cut(&self, half: usize, length: usize) -> bool {
        self.centre < half || self.centre + half >= length
    }

    /// Returns the same line with the window about another pixel.
    pub(super) fn about(&self, centre: usize, half: usize, length: usize) -> Self {
        let window = uncut(centre, half, length);
        Self {
            centre,
            window: window.start.max(self.zone.start)..window.end.min(self.zone.end),
            ..self.clone()
        }
    }

    /// Returns true if the window was cut where another line begins.
    pub(super) fn is_crowded(&self, half: usize, length: usize) -> bool {
        self.window != uncut(self.centre, half, length)
    }
}

impl Column {
    /// The minimum number of pixels whose median is a background.
    const FEWEST_BACKGROUND: usize = 8;

    /// Finds the lines of a column.
    ///
    /// The background is the median of the pixels outside of all windows. If these are fewer than
    /// [`FEWEST_BACKGROUND`](Self::FEWEST_BACKGROUND) pixels, it is the lowest decile of the
    /// column.
    pub(super) fn of(column: &[f32], settings: &DetectorSettings) -> Self {
        let is_known = |i: usize| column[i].is_finite();
        let values = finite(column);
        let half = settings.window / 2;
        let smooth = Smoothed::of(&values, settings.window);
        let centres = smooth.maxima(half + 1, settings.max_lines);
        let (background, background_pixels) = background(&values, is_known, &centres, half);
        let above = |i: usize| {
            if is_known(i) {
                values[i] - background
            } else {
                0.0
            }
        };
        let above: Vec<f64> = (0..values.len()).map(above).collect();
        let zones = zones(&smooth.values, &centres);
        let sightings = centres.iter().zip(zones).map(|(&centre, zone)| {
            let window = uncut(centre, half, above.len());
            let window = window.start.max(zone.start)..window.end.min(zone.end);
            let greatest = greatest(&above, window.clone(), centre);
            Sighting {
                centre,
                zone,
                window,
                greatest,
            }
        });
        let stands_out = |line: &Sighting| {
            above[line.greatest] > 0.0 && above[line.greatest] >= settings.min_peak
        };
        Self {
            lines: sightings.filter(stands_out).collect(),
            above,
            background,
            background_pixels,
            smooth,
        }
    }
}

/// Returns the values, with the smallest value in place of values that are not finite.
fn finite(column: &[f32]) -> Vec<f64> {
    let finite = || column.iter().copied().filter(|value| value.is_finite());
    let min = finite().reduce(f32::min).unwrap_or(0.0);
    let known = |&value: &f32| f64::from(if value.is_finite() { value } else { min });
    column.iter().map(known).collect()
}

/// The window about a pixel, as far as there are pixels.
fn uncut(centre: usize, half: usize, length: usize) -> Range<usize> {
    centre.saturating_sub(half)..(centre + half + 1).min(length)
}

/// The greatest pixel of a window; of equal pixels, the one nearest to its middle.
fn greatest(above: &[f64], window: Range<usize>, centre: usize) -> usize {
    window
        .max_by(|&a, &b| {
            let by_value = above[a].total_cmp(&above[b]);
            by_value.then(b.abs_diff(centre).cmp(&a.abs_diff(centre)))
        })
        .unwrap_or(centre)
}

/// The background, and the pixels that it was taken from.
fn background(
    values: &[f64],
    is_known: impl Fn(usize) -> bool,
    centres: &[usize],
    half: usize,
) -> (f64, Vec<usize>) {
    let mut is_line = vec![false; values.len()];
    for &centre in centres {
        is_line[uncut(centre, half, values.len())].fill(true);
    }
    let known = (0..values.len()).filter(|&i| is_known(i));
    let outside: Vec<usize> = known.clone().filter(|&i| !is_line[i]).collect();
    if outside.len() >= Column::FEWEST_BACKGROUND {
        let mut values: Vec<f64> = outside.iter().map(|&i| values[i]).collect();
        return (median(&mut values), outside);
    }
    let mut order: Vec<usize> = known.collect();
    order.sort_by(|&a, &b| values[a].total_cmp(&values[b]));
    let decile = order.get(order.len() / 10).copied();
    (
        decile.map_or(0.0, |i| values[i]),
        decile.into_iter().collect(),
    )
}

/// The pixels that belong to each line: up to the smallest smoothed value between it and its
/// neighbours, of equal values, the one nearest to the middle. That pixel belongs to neither.
fn zones(smoothed: &[f64], centres: &[usize]) -> Vec<Range<usize>> {
    let valley = |pair: &[usize]| {
        let (from, to) = (pair[0], pair[1]);
        let off_middle = |i: usize| (2 * i).abs_diff(from + to);
        (from + 1..to)
            .min_by(|&a, &b| {
                let by_value = smoothed[a].total_cmp(&smoothed[b]);
                by_value.then(off_middle(a).cmp(&off_middle(b)))
            })
            .unwrap_or(to)
    };
    let valleys: Vec<usize> = centres.windows(2).map(valley).collect();
    let starts = core::iter::once(0).chain(valleys.iter().map(|valley| valley + 1));
    let ends = valleys.iter().copied().chain([smoothed.len()]);
    starts.zip(ends).map(|(start, end)| start..end).collect()
}

/// A column after a triangular filter.
pub(super) struct Smoothed {
    values: Vec<f64>,
    /// The number of pixels in each half of the triangle.
    width: usize,
    /// A maximum must be greater than this.
    min: f64,
}

impl Smoothed {
    /// Minimum height of a line, in standard deviations of the smoothed noise. Of 10⁵ independent
    /// pixels of Gaussian noise none reaches it in 9999 of 10 000 cases.
    const STAND_OUT: f64 = 6.0;
    /// The lower quartile of |a − b| for two independent standard normal numbers a and b.
    const QUARTILE_OF_DIFFERENCES: f64 = 0.450_6;

    /// Smooths over a quarter of the window, twice.
    ///
    /// The noise is judged by the quieter of the differences of neighbours, the level by the lower
    /// quartile: both hold as long as a quarter of the column is background.
    fn of(raw: &[f64], window: usize) -> Self {
        let width = (window / 4) | 1;
        let values = box_mean(&box_mean(raw, width), width);
        let mut differences: Vec<f64> = raw.windows(2).map(|p| (p[1] - p[0]).abs()).collect();
        let noise = quartile(&mut differences) / Self::QUARTILE_OF_DIFFERENCES;
        // The triangle has the weights (m − |j|)/m²; the sum of their squares is (2m² + 1)/(3m³).
        let m = width as f64;
        let gain = ((2.0 * m * m + 1.0) / (3.0 * m * m * m)).sqrt();
        let level = quartile(&mut values.clone());
        Self {
            min: level + Self::STAND_OUT * gain * noise,
            values,
            width,
        }
    }

    /// Returns by how much the maximum at `centre` moves per grey value of each pixel that
    /// contributes to it: the vertex of the parabola through it and its neighbours, which it
    /// follows in the mean. Nothing at the ends of a column.
    pub(super) fn motion(&self, centre: usize) -> Vec<(usize, f64)> {
        let neighbours = centre.checked_sub(1).zip(self.values.get(centre + 1));
        let Some((before, &s_after)) = neighbours else {
            return Vec::new();
        };
        let (s_before, s) = (self.values[before], self.values[centre]);
        let curvature = s_before - 2.0 * s + s_after;
        let vertex = 0.5 * (s_before - s_after) / curvature;
        let m = self.width as f64;
        let weight = |i: usize, at: usize| (m - i.abs_diff(at) as f64).max(0.0) / (m * m);
        let moves = |i: usize| {
            let [k_before, k, k_after] = [before, centre, centre + 1].map(|at| weight(i, at));
            let tilt = 0.5 * (k_before - k_after) - vertex * (k_before - 2.0 * k + k_after);
            (i, tilt / curvature)
        };
        uncut(centre, self.width, self.values.len())
            .map(moves)
            .collect()
    }

    /// The greatest maxima, at least `apart` pixels from each other, from the top.
    fn maxima(&self, apart: usize, max: usize) -> Vec<usize> {
        let s = &self.values;
        let at = |i: usize| s.get(i).copied().unwrap_or(f64::NEG_INFINITY);
        let is_maximum = |&i: &usize| s[i] > at(i.wrapping_sub(1)) && s[i] >= at(i + 1);
        let mut order: Vec<usize> = (0..s.len())
            .filter(|&i| s[i] > self.min)
            .filter(is_maximum)
            .collect();
        order.sort_by(|&a, &b| s[b].total_cmp(&s[a]).then(a.cmp(&b)));
        let mut taken: Vec<usize> = Vec::new();
        for i in order {
            if taken.len() < max && taken.iter().all(|&j| i.abs_diff(j) >= apart) {
                taken.push(i);
            }
        }
        taken.sort_unstable();
        taken
    }
}

/// The mean over an odd number of pixels about each value, as far as there are values.
fn box_mean(values: &[f64], width: usize) -> Vec<f64> {
    let mean = |i| {
        let about = &values[uncut(i, width / 2, values.len())];
        about.iter().sum::<f64>() / about.len() as f64
    };
    let half = width / 2;
    let Some(inner) = values.len().checked_sub(2 * half) else {
        return (0..values.len()).map(mean).collect();
    };
    // All pixels at once, one neighbour after the other: additions of vectors.
    let mut sums = vec![0.0; inner];
    for neighbours in values.windows(inner.max(1)).take(width) {
        let pairs = sums.iter_mut().zip(neighbours);
        pairs.for_each(|(sum, value)| *sum += value);
    }
    let inner_means = sums.iter().map(|sum| sum / width as f64);
    let (first, last) = (0..half, values.len() - half..values.len());
    let edges = first.map(mean).chain(inner_means);
    edges.chain(last.map(mean)).collect()
}

/// The lower quartile, 0 without values.
fn quartile(values: &mut [f64]) -> f64 {
    if values.is_empty() {
        return 0.0;
    }
    let rank = (values.len() - 1) / 4;
    *values.select_nth_unstable_by(rank, f64::total_cmp).1
}

/// The median of at least one value; of an even number the mean of the two in the middle.
fn median(values: &mut [f64]) -> f64 {
    let is_odd = !values.len().is_multiple_of(2);
    let (below, &mut upper, _) = values.select_nth_unstable_by(values.len() / 2, f64::total_cmp);
    match below.iter().copied().reduce(f64::max) {
        Some(lower) if !is_odd => lower.midpoint(upper),
        _ => upper,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn each_pixel_has_the_mean_of_the_neighbours_that_it_has() {
        let values = [1.0, 5.0, 2.0, 8.0, 3.0, 9.0, 4.0];
        for width in [1, 3, 5, 7, 9, 21] {
            let means = box_mean(&values, width);
            assert_eq!(means.len(), values.len(), "{width}");
            for (i, mean) in means.iter().enumerate() {
                let near = |j: &usize| j.abs_diff(i) <= width / 2;
                let about: Vec<f64> = (0..7).filter(near).map(|j| values[j]).collect();
                let expected = about.iter().sum::<f64>() / about.len() as f64;
                assert!((mean - expected).abs() < 1e-15, "{width}, {i}: {mean}");
            }
        }
    }
}
