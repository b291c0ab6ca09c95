/// Values that differ by less than this fraction of the greater one are the same level: averages of
/// colour channels are rounded to `f32`, and 16-bit values are 16 times as far apart.
const SAME: f64 = 1.0 / (1 << 20) as f64;

/// The largest number of steps up to the largest value: averages over three channels of 16 bits.
const FINEST: f64 = 3.0 * 65_536.0;

/// The values that the pixels of a rounded image take.
///
/// Each level represents the light from half way to the level below up to half way to the level
/// above, its cell. The lowest cell begins half a step below, but not below zero; the highest cell
/// ends half a step above, or is unbounded if so many pixels have this level that the sensor must
/// have clipped.
///
/// # Examples
///
/// Speckle with a mean of half a grey level, rounded to whole levels:
///
/// ```
/// use tem00_statistics::test::GreyLevels;
///
/// let quantile = |i| -0.5 * (1.0 - (f64::from(i) + 0.5) / 10_000.0_f64).ln();
/// let rounded: Vec<f64> = (0..10_000).map(|i| quantile(i).round()).collect();
/// let levels = GreyLevels::from_values(&rounded).expect("a few whole numbers");
/// assert_eq!(levels.cell(1), [0.5, 1.5]);
///
/// // Rounding lowers the mean from 0.5 to 1 / 2 sinh(1) = 0.4255, and raises the contrast.
/// let mean = rounded.iter().sum::<f64>() / 10_000.0;
/// assert!((mean - 0.4255).abs() < 1e-3);
/// assert!((levels.exponential_mean(mean) - 0.5).abs() < 1e-3);
/// assert!((levels.exponential_contrast(mean) - 1.4446).abs() < 1e-3);
/// ```
#[derive(Clone, Debug, PartialEq)]
pub struct GreyLevels {
    levels: Vec<f64>,
    step: f64,
    /// The fraction of the pixels at the largest level.
    largest: f64,
}

impl GreyLevels {
    /// The smallest fraction of the pixels at the largest level for which an image counts as
    /// clipped.
    pub const CLIPPED_FRACTION: f64 = 1e-3;

    /// Finds the levels of an image, if at least every other pixel shares its value with another
    /// pixel and the levels are not finer than in image files, 3 · 2¹⁶ steps.
    ///
    /// Values that differ by less than 10⁻⁶ of the greater one are one level. Returns `None` for an
    /// image that is not rounded, has only one value, or is not an image of light: with a value
    /// that is negative or not finite.
    pub fn from_values<T: Copy + Into<f64> + Sync>(values: &[T]) -> Option<Self> {
        let mut levels: Vec<f64> = values.iter().map(|&value| value.into()).collect();
        if !levels
            .iter()
            .all(|level| level.is_finite() && *level >= 0.0)
        {
            return None;
        }
        levels.sort_unstable_by(f64::total_cmp);
        let maximum = *levels.last()?;
        let below = levels.partition_point(|&level| !are_same(level, maximum));
        let largest = (values.len() - below) as f64 / values.len() as f64;
        levels.dedup_by(|next, level| are_same(*level, *next));
        let gaps = levels.windows(2).map(|pair| pair[1] - pair[0]);
        let step = gaps.fold(f64::INFINITY, f64::min);
        let few = levels.len() >= 2 && 2 * levels.len() <= values.len();
        (few && maximum <= FINEST * step).then_some(Self {
            levels,
            step,
            largest,
        })
    }

    /// Returns the number of levels, which is at least two.
    pub const fn count(&self) -> usize {
        self.levels.len()
    }

    /// Returns the position of the largest level that is not above `value`, or 0.
    pub fn index(&self, value: f64) -> usize {
        self.levels
            .partition_point(|&level| level <= value)
            .saturating_sub(1)
    }

    /// Returns the cell of the level at `index`: the lower and the upper end of the light that it
    /// represents.
    ///
    /// # Panics
    ///
    /// Panics unless `index` is below [`count`](Self::count).
    pub fn cell(&self, index: usize) -> [f64; 2] {
        assert!(index < self.count(), "level {index} of {}", self.count());
        [self.edge(index), self.edge(index + 1)]
    }

    /// Returns the lower edge of the level at `index`; light is not negative.
    fn edge(&self, index: usize) -> f64 {
        let half = 0.5 * self.step;
        match index {
            0 => (self.levels[0] - half).max(0.0),
            _ if index < self.levels.len() => 0.5 * (self.levels[index - 1] + self.levels[index]),
            _ if self.largest > Self::CLIPPED_FRACTION => f64::INFINITY,
            _ => self.levels[self.levels.len() - 1] + half,
        }
    }

    /// Returns the edge of a level that is nearest to `value`.
    pub fn nearest_edge(&self, value: f64) -> f64 {
        let [low, high] = self.cell(self.index(value));
        if value - low < high - value {
            low
        } else {
            high
        }
    }

    /// Returns the smallest difference of two levels.
    pub const fn step(&self) -> f64 {
        self.step
    }

    /// Returns whether all levels are integer multiples of the step, as for a linear sensor.
    pub fn are_multiples(&self) -> bool {
        let off = |level: &f64| {
            let multiple = level / self.step;
            (multiple - multiple.round()).abs() > 0.01
        };
        !self.levels.iter().any(off)
    }

    /// Returns the mean of the exponential distribution whose values, rounded to the levels, have
    /// the mean `rounded`.
    ///
    /// ```text
    /// rounded = step / 2 sinh(step / 2m)
    /// ```
    ///
    /// If the levels are not multiples of the step, it is `rounded` itself.
    pub fn exponential_mean(&self, rounded: f64) -> f64 {
        if !self.are_multiples() {
            return rounded;
        }
        let half = 0.5 * self.step;
        half / (half / rounded).asinh()
    }

    /// Returns the contrast of the rounded values of an exponential distribution, rounded to the
    /// levels, whose mean after rounding is `rounded`.
    ///
    /// ```text
    /// C² = 2 cosh(step / 2m) − 1 = 2 √(1 + (step / 2 rounded)²) − 1
    /// ```
    ///
    /// If the levels are not multiples of the step, it is 1.
    pub fn exponential_contrast(&self, rounded: f64) -> f64 {
        if !self.are_multiples() {
            return 1.0;
        }
        (2.0 * (0.5 * self.step / rounded).hypot(1.0) - 1.0).sqrt()
    }

    /// Returns the samples in ascending order, with the samples of each level spread evenly over
    /// its cell; in an unbounded cell they are not spread.
    ///
    /// Fits of a continuous law need samples that differ.
    pub fn spread(&self, samples: &[f64]) -> Vec<f64> {
        let within = |[low, high]: [f64; 2], share: f64| {
            let end = if high.is_finite() { high } else { low };
            low + share * (end - low)
        };
        self.spread_over(samples, |index| self.cell(index), within)
    }

    /// Returns for each sample a position within the image under `cumulative` of the cell of its
    /// level, evenly spread.
    pub(crate) fn places(&self, samples: &[f64], cumulative: impl Fn(f64) -> f64) -> Vec<f64> {
        let cell = |index: usize| self.cell(index).map(&cumulative);
        let within = |[low, high]: [f64; 2], share: f64| low + share * (high - low);
        self.spread_over(samples, cell, within)
    }

    /// Places the j-th of n samples of a level at the fraction (j + ½)/n of its cell.
    fn spread_over(
        &self,
        samples: &[f64],
        cell: impl Fn(usize) -> [f64; 2],
        within: impl Fn([f64; 2], f64) -> f64,
    ) -> Vec<f64> {
        let mut counts = vec![0_usize; self.count()];
        samples
            .iter()
            .for_each(|&sample| counts[self.index(sample)] += 1);
        let occupied = counts.iter().enumerate().filter(|&(_, &count)| count > 0);
        let spread = occupied.flat_map(|(index, &count)| {
            let cell = cell(index);
            let within = &within;
            (0..count).map(move |j| within(cell, (j as f64 + 0.5) / count as f64))
        });
        spread.collect()
    }
}

/// Returns whether a value and a greater one differ by rounding only.
fn are_same(low: f64, high: f64) -> bool {
    high - low <= high * SAME
}

#[cfg(test)]
mod tests {
    use tem00_testkit::assert_relative;

    use super::*;

    /// Integers from 0 to `last`, many times each except the last one.
    fn levels(last: u16, times: usize) -> GreyLevels {
        let mut values: Vec<f32> = (0..last)
            .flat_map(|level| core::iter::repeat_n(f32::from(level), 400))
            .collect();
        values.extend(core::iter::repeat_n(f32::from(last), times));
        GreyLevels::from_values(&values).expect("the values are few")
    }

    #[test]
    fn cells_reach_half_way_to_the_neighbours() {
        let levels = levels(3, 1);
        let cells: Vec<_> = (0..4).map(|index| levels.cell(index)).collect();
        assert_eq!(cells, [[0.0, 0.5], [0.5, 1.5], [1.5, 2.5], [2.5, 3.5]]);
        let uneven = GreyLevels::from_values(&[2.0, 2.0, 3.0, 3.0, 7.0, 7.0]).expect("few values");
        let cells: Vec<_> = (0..3).map(|index| uneven.cell(index)).collect();
        assert_eq!(cells, [[1.5, 2.5], [2.5, 5.0], [5.0, f64::INFINITY]]);
        assert_eq!([2.0, 6.9, 7.0].map(|value| uneven.index(value)), [0, 1, 2]);
        for (value, edge) in [(1.8, 1.5), (4.0, 5.0), (100.0, 5.0)] {
            assert_relative(uneven.nearest_edge(value), edge, f64::EPSILON);
        }
    }

    #[test]
    fn values_that_hardly_repeat_are_no_levels() {
        let distinct: Vec<f32> = (0..100_u16).map(f32::from).collect();
        assert!(GreyLevels::from_values(&distinct).is_none(), "all differ");
        assert!(GreyLevels::from_values(&[2.0; 9]).is_none(), "one value");
        assert!(GreyLevels::from_values::<f32>(&[]).is_none(), "no value");
        for bad in [-1.0, f64::NAN, f64::INFINITY] {
            let values = [bad, bad, 1.0, 1.0, 2.0, 2.0];
            assert!(
                GreyLevels::from_values(&values).is_none(),
                "{bad} is no light"
            );
        }
    }

    #[test]
    fn values_finer_than_those_of_files_are_no_levels() {
        // Pairs of neighbours, as many as in an image in single precision.
        let fine = |steps: u16| -> Vec<f32> {
            let near_one = (0..200_u16).map(|i| 1.0 - f32::from(i / 2) * f32::from(steps) * 2e-6);
            near_one.collect()
        };
        assert!(
            GreyLevels::from_values(&fine(1)).is_none(),
            "2e-6 of the largest"
        );
        assert!(
            GreyLevels::from_values(&fine(4)).is_some(),
            "8e-6 of the largest"
        );
    }

    #[test]
    fn one_pixel_brighter_by_far_makes_no_levels_of_the_others() {
        // All others lie within 1e-6 of this value from zero.
        let mut values: Vec<f32> = (0..100_u16).map(|i| 1.0 + f32::from(i) / 99.0).collect();
        values.push(1e7);
        assert_eq!(GreyLevels::from_values(&values), None, "a hundred values");
    }

    #[test]
    fn rounding_of_an_average_of_channels_splits_no_level() {
        let third = 1.0_f32 / 3.0;
        let values = [third, third.next_up(), third, 1.0, 1.0, 1.0_f32.next_down()];
        let levels = GreyLevels::from_values(&values).expect("two levels");
        assert_eq!(levels.count(), 2);
        assert_eq!(
            values.map(|value| levels.index(value.into())),
            [0, 0, 0, 1, 1, 1]
        );
    }

    #[test]
    fn the_exponential_law_behind_its_rounding_is_found() {
        let levels = levels(255, 1);
        for mean in [0.3_f64, 1.0, 3.0, 20.0] {
            // ⟨K⟩ and ⟨K²⟩ of K = round(I), term by term; the omitted terms are below exp(−50).
            let (mut first, mut second) = (0.0, 0.0);
            for k in 1..1_000_u32 {
                let k = f64::from(k);
                let share = (-(k - 0.5) / mean).exp() - (-(k + 0.5) / mean).exp();
                first += k * share;
                second += k * k * share;
            }
            let contrast = (second / (first * first) - 1.0).sqrt();
            // The tolerance covers some hundred rounded additions.
            assert_relative(levels.exponential_mean(first), mean, 1e-13);
            let found = levels.exponential_contrast(first);
            assert_relative(found, contrast, 1e-12);
        }
    }

    #[test]
    fn levels_that_are_no_multiples_leave_the_law_alone() {
        let values = [0.0, 0.0, 1.0, 1.0, 2.5, 2.5];
        let levels = GreyLevels::from_values(&values).expect("three levels");
        assert!(!levels.are_multiples(), "2.5 is no multiple of 1");
        assert_relative(levels.exponential_mean(0.7), 0.7, 1e-15);
        assert_relative(levels.exponential_contrast(0.7), 1.0, 1e-15);
    }

    #[test]
    fn samples_are_spread_evenly_over_their_cells() {
        let spread = levels(3, 2).spread(&[1.0, 3.0, 1.0, 0.0]);
        // The clipped level has no upper end: its samples stay at the lower end.
        assert_eq!(spread, [0.25, 0.75, 1.25, 2.5]);
    }
}
