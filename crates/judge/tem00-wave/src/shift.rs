use core::f64::consts::{PI, TAU};

use glam::{DMat2, DVec2};
use num_complex::Complex;
use tem00_numerics::{Fft2, Grid, cast::to_signed};

/// Displacement of a pattern and its remaining correlation.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Shift {
    /// Displacement of the features of the first pattern in the second, in samples.
    pub offset: DVec2,
    /// Pearson correlation of the two patterns after compensation of the displacement.
    pub correlation: f64,
}

/// Returns the displacement of the second pattern relative to the first.
///
/// The displacement is the position of the maximum of the cross-correlation of the two patterns. It
/// is found in whole samples by Fourier transform, over all displacements that leave a quarter of
/// the width and height in common; then only the common parts are correlated, and the maximum
/// between the samples is the maximum of the band-limited correlation function.
///
/// Returns `None` if a pattern is constant or not finite, or if the correlation has no maximum.
///
/// # Validity
///
/// For patterns that differ only by a displacement the error is below 10⁻⁴ samples if a feature is
/// wider than two samples and the common part is many features wide. Partly decorrelated patterns
/// have an additional statistical error. The result for unrelated patterns is arbitrary.
///
/// The correlation includes everything in the patterns: a bright patch on a dark background is
/// correlated with itself. The edge of a lit patch that does not move with the speckle changes the
/// displacement by some per cent and raises the correlation. To measure the speckle alone, cut out
/// parts in which the light is even.
///
/// A pattern that stretches has no single displacement. The result is the displacement in the
/// middle of the common part; at another point its error is the stretch times the distance from the
/// middle. To remove this error, move the window of the second pattern by the result and measure
/// again.
///
/// # Panics
///
/// Panics unless both patterns have the same size, of at least 16 × 16 samples.
///
/// # Examples
///
/// ```
/// use tem00_wave::{displacement_between, Grid};
///
/// let wave = |x: usize, y: usize, dx: f32, dy: f32| {
///     let (x, y) = (x as f32 - dx, y as f32 - dy);
///     (0.31 * x).sin() * (0.23 * y).cos() + (0.17 * x + 0.29 * y).sin()
/// };
/// let first = Grid::from_fn(64, 64, |x, y| wave(x, y, 0.0, 0.0));
/// let second = Grid::from_fn(64, 64, |x, y| wave(x, y, 2.25, -1.5));
/// let shift = displacement_between(&first, &second).unwrap();
/// assert!((shift.offset.x - 2.25).abs() < 0.01 && (shift.offset.y + 1.5).abs() < 0.01);
/// assert!(shift.correlation > 0.99);
/// ```
pub fn displacement_between(first: &Grid<f32>, second: &Grid<f32>) -> Option<Shift> {
    let size = [first.width(), first.height()];
    assert!(
        size == [second.width(), second.height()],
        "patterns of different sizes"
    );
    assert!(size.iter().all(|&n| n >= 16), "a pattern below 16 × 16");
    let mut whole = whole_displacement(first, second)?;
    // Each pass may correct the whole displacement, using the common part alone.
    for _ in 0..PASSES {
        let correction = Common::new(first, second, whole, DVec2::ZERO)?.largest_nearby();
        if correction == [0, 0] {
            break;
        }
        whole = [0, 1].map(|i| limited(whole[i] + correction[i], size[i]));
    }
    // The taper of the second pattern follows the displacement found so far.
    let mut rest = DVec2::ZERO;
    let mut correlation = 0.0;
    for _ in 0..REFINEMENTS {
        (rest, correlation) = Common::new(first, second, whole, rest)?.maximum_near(rest)?;
    }
    Some(Shift {
        offset: DVec2::new(whole[0] as f64, whole[1] as f64) + rest,
        correlation,
    })
}

const PASSES: usize = 6;

/// Each refinement reduces the error to about a hundredth.
const REFINEMENTS: usize = 3;

/// Reciprocal of the fraction of width and height that two patterns must have in common.
const COMMON: usize = 4;

fn limited(displacement: i64, size: usize) -> i64 {
    let max = to_signed(size - size / COMMON);
    displacement.clamp(-max, max)
}

/// The whole displacement at which the correlation is most significant: its noise grows with the
/// square root of the common area.
fn whole_displacement(first: &Grid<f32>, second: &Grid<f32>) -> Option<[i64; 2]> {
    let size = [first.width(), first.height()];
    let padded = size.map(|n| 2 * n);
    let transform = Fft2::with_aperture(padded[0], padded[1], size[0], size[1]).ok()?;
    let spectra = [first, second].map(|pattern| {
        standardised(pattern, |_, _| 1.0).map(|a| transform.forward(&a, |_, _, v| v))
    });
    let [Some(first), Some(second)] = spectra else {
        return None;
    };
    let correlation = correlation_from(&first, &second)?;
    let significance = |lag: [i64; 2]| {
        let common = [0, 1].map(|i| size[i] as f64 - lag[i].unsigned_abs() as f64);
        f64::from(*correlation.wrapped(lag[0], lag[1])) / (common[0] * common[1]).sqrt()
    };
    let [across, down] = size.map(|n| limited(i64::MAX / 2, n));
    argmax([across, down], significance)
}

/// The lag with the largest value among those up to `reach` in each direction.
fn argmax(reach: [i64; 2], value: impl Fn([i64; 2]) -> f64) -> Option<[i64; 2]> {
    let lags = (-reach[1]..=reach[1]).flat_map(|y| (-reach[0]..=reach[0]).map(move |x| [x, y]));
    lags.map(|lag| (lag, value(lag)))
        .max_by(|(_, a), (_, b)| a.total_cmp(b))
        .map(|(lag, _)| lag)
}

/// Returns `weight · (pattern − mean)` with a mean square of 1.
fn standardised(
    pattern: &Grid<f32>,
    weight: impl Fn(usize, usize) -> f64,
) -> Option<Grid<Complex<f32>>> {
    let width = pattern.width();
    let weighted = || {
        let at = move |i: usize| [i % width, i / width];
        let values = pattern.values().iter().enumerate();
        values.map(move |(i, &value)| (at(i), f64::from(value)))
    };
    let (mut sum, mut weights) = (0.0, 0.0);
    for ([x, y], value) in weighted() {
        sum += weight(x, y) * value;
        weights += weight(x, y);
    }
    let mean = sum / weights;
    let deviation = |[x, y]: [usize; 2], value: f64| weight(x, y) * (value - mean);
    let squares: f64 = weighted()
        .map(|(at, value)| deviation(at, value).powi(2))
        .sum();
    let scale = (pattern.values().len() as f64 / squares).sqrt();
    if !(scale.is_finite() && squares.is_finite()) {
        return None;
    }
    let values = weighted().map(|(at, value)| {
        #[expect(
            clippy::cast_possible_truncation,
            reason = "the transform works in f32"
        )]
        let value = (scale * deviation(at, value)) as f32;
        Complex::new(value, 0.0)
    });
    Grid::from_vec(width, pattern.height(), values.collect()).ok()
}

/// Returns `Σ_x a(x) b(x + d)` at every cyclic lag d, from the spectra of a and b.
fn correlation_from(a: &Grid<Complex<f32>>, b: &Grid<Complex<f32>>) -> Option<Grid<f32>> {
    let (width, height) = (a.width(), a.height());
    // The forward transform of the conjugate spectrum is the conjugate of the inverse transform.
    let cross = Grid::from_fn(width, height, |x, y| a[(x, y)] * b[(x, y)].conj());
    let back = Fft2::new(width, height).ok()?;
    Some(back.forward(&cross, |_, _, value| value.re))
}

/// The common part of two patterns after a whole displacement, tapered at the edges.
struct Common {
    spectra: [Grid<Complex<f32>>; 2],
}

impl Common {
    fn new(first: &Grid<f32>, second: &Grid<f32>, whole: [i64; 2], rest: DVec2) -> Option<Self> {
        let size = [first.width(), first.height()];
        // Fourier transforms of multiples of eight are fast.
        let common = [0, 1].map(|i| {
            let common = size[i] - to_usize(whole[i].abs());
            if common >= 64 { common & !7 } else { common }
        });
        let cut = |pattern: &Grid<f32>, start: [usize; 2]| {
            Grid::from_fn(common[0], common[1], |x, y| {
                pattern[(start[0] + x, start[1] + y)]
            })
        };
        let parts = [
            cut(first, whole.map(|n| to_usize(-n))),
            cut(second, whole.map(to_usize)),
        ];
        let transform = Fft2::new(common[0], common[1]).ok()?;
        let spectrum = |part: &Grid<f32>, moved: DVec2| {
            let [across, down] = [taper(common[0], moved.x), taper(common[1], moved.y)];
            standardised(part, |x, y| across[x] * down[y])
                .map(|values| transform.forward(&values, |_, _, v| v))
        };
        let spectra = [spectrum(&parts[0], DVec2::ZERO), spectrum(&parts[1], rest)];
        match spectra {
            [Some(first), Some(second)] => Some(Self {
                spectra: [first, second],
            }),
            _ => None,
        }
    }

    /// The whole lag of the largest correlation, up to an eighth of the size.
    fn largest_nearby(&self) -> [i64; 2] {
        let [a, b] = &self.spectra;
        let reach = [a.width(), a.height()].map(|n| to_signed(n / 8));
        correlation_from(a, b)
            .and_then(|c| argmax(reach, |[x, y]| f64::from(*c.wrapped(x, y))))
            .unwrap_or([0, 0])
    }

    /// The maximum of the correlation function near a lag, by Newton's method, and its height.
    fn maximum_near(&self, start: DVec2) -> Option<(DVec2, f64)> {
        let mut lag = start;
        for _ in 0..30 {
            let at = self.expansion_at(lag);
            let step = at.newton_step()?;
            lag += step.clamp_length_max(0.5);
            if (lag - start).length() > 4.0 {
                return None;
            }
            // The rounding of f32 spectra limits the accuracy to this step.
            if step.length() < 1e-7 {
                break;
            }
        }
        Some((lag, self.expansion_at(lag).value))
    }

    /// The correlation at a lag, normalised to 1 for equal patterns, with its derivatives.
    fn expansion_at(&self, lag: DVec2) -> Expansion {
        let [a, b] = &self.spectra;
        let (width, height) = (a.width(), a.height());
        let columns = shift_phases(lag.x, width);
        let mut sum = Expansion::default();
        for (y, (ky, turn_y)) in shift_phases(lag.y, height).into_iter().enumerate() {
            let rows = a.row(y).iter().zip(b.row(y));
            for ((a, b), (kx, turn_x)) in rows.zip(&columns) {
                let wide = |v: &Complex<f32>| Complex::new(f64::from(v.re), f64::from(v.im));
                let turned = wide(b) * wide(a).conj() * turn_x * turn_y;
                sum.add(DVec2::new(*kx, ky), turned);
            }
        }
        // Both patterns have a mean square of 1: by Parseval |spectrum|² sums to n².
        let count = width as f64 * height as f64;
        sum.scaled(1.0 / (count * count))
    }
}

/// Angular frequencies along an axis, and their phases after a shift.
fn shift_phases(lag: f64, size: usize) -> Vec<(f64, Complex<f64>)> {
    let frequency = |k: usize| {
        let signed = if 2 * k < size {
            to_signed(k)
        } else {
            to_signed(k) - to_signed(size)
        };
        TAU * signed as f64 / size as f64
    };
    // The highest frequency of an even size is its own negative: a fraction of it is ambiguous.
    let ambiguous = |k: usize| 2 * k == size;
    (0..size)
        .map(|k| {
            let frequency = if ambiguous(k) { 0.0 } else { frequency(k) };
            let magnitude = if ambiguous(k) { 0.0 } else { 1.0 };
            (frequency, Complex::from_polar(magnitude, frequency * lag))
        })
        .collect()
}

/// Value, gradient and second derivatives of a correlation function.
#[derive(Clone, Copy, Debug, Default)]
struct Expansion {
    value: f64,
    gradient: DVec2,
    xx: f64,
    xy: f64,
    yy: f64,
}

impl Expansion {
    /// Adds the wave `Re exp(ik·d) c` and its derivatives.
    fn add(&mut self, k: DVec2, wave: Complex<f64>) {
        self.value += wave.re;
        self.gradient -= k * wave.im;
        self.xx -= k.x * k.x * wave.re;
        self.xy -= k.x * k.y * wave.re;
        self.yy -= k.y * k.y * wave.re;
    }

    fn scaled(self, by: f64) -> Self {
        Self {
            value: self.value * by,
            gradient: self.gradient * by,
            xx: self.xx * by,
            xy: self.xy * by,
            yy: self.yy * by,
        }
    }

    /// The step to the maximum, or `None` where the function is not concave.
    fn newton_step(&self) -> Option<DVec2> {
        let determinant = self.xx * self.yy - self.xy * self.xy;
        if !(self.xx < 0.0 && determinant > 0.0) {
            return None;
        }
        let hessian = DMat2::from_cols_array(&[self.xx, self.xy, self.xy, self.yy]);
        Some(-(hessian.inverse() * self.gradient)).filter(|step| step.is_finite())
    }
}

/// A window that rises along a cosine over an eighth at either end, displaced by `moved` samples.
///
/// Without the taper, features that enter and leave at the edges would pull the maximum towards
/// zero.
fn taper(size: usize, moved: f64) -> Vec<f64> {
    let (size, rise) = (size as f64, (size as f64 / 8.0).max(1.0));
    let window = |x: f64| {
        let from_edge = x.min(size - x).clamp(0.0, rise);
        0.5 - 0.5 * (PI * from_edge / rise).cos()
    };
    core::iter::successors(Some(0.5), |x| Some(x + 1.0))
        .take_while(|&x| x < size)
        .map(|x| window(x - moved))
        .collect()
}

/// Converts an index; a negative number gives zero.
fn to_usize(n: i64) -> usize {
    usize::try_from(n).unwrap_or(0)
}

#[cfg(test)]
mod tests;
