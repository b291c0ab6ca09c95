//! The inner loop: spherical waves of many scatterers at one point.

use core::slice;

use glam::DVec3;
use num_complex::Complex;
use tem00_numerics::vectorised;

/// Scatterers summed side by side: two AVX-512 or eight SSE2 registers of `f64`.
const LANES: usize = 8;

/// Point sources as separate arrays, padded with dark sources to whole groups of [`LANES`].
#[derive(Clone, Debug, Default, PartialEq)]
pub(crate) struct Sources {
    x: Vec<f64>,
    y: Vec<f64>,
    z: Vec<f64>,
    re: Vec<f64>,
    im: Vec<f64>,
}

impl FromIterator<(DVec3, Complex<f64>)> for Sources {
    fn from_iter<I: IntoIterator<Item = (DVec3, Complex<f64>)>>(sources: I) -> Self {
        let mut all = Self::default();
        for (position, amplitude) in sources {
            all.push(position, amplitude);
        }
        while !all.x.len().is_multiple_of(LANES) {
            all.push(DVec3::ZERO, Complex::new(0.0, 0.0));
        }
        all
    }
}

impl Sources {
    fn push(&mut self, position: DVec3, amplitude: Complex<f64>) {
        self.x.push(position.x);
        self.y.push(position.y);
        self.z.push(position.z);
        self.re.push(amplitude.re);
        self.im.push(amplitude.im);
    }

    /// Returns `Σ amplitude · exp(ikr) / r` at a point, with `r` at least one wavelength in 1/r.
    pub(crate) fn wave_at(&self, point: DVec3, wavelength: f64) -> Complex<f64> {
        let mut sum = Complex::ZERO;
        vectorised(
            #[inline(always)]
            || sum = self.sum_at(point, wavelength),
        );
        sum
    }

    #[inline(always)]
    fn sum_at(&self, point: DVec3, wavelength: f64) -> Complex<f64> {
        let half_turns_per_metre = 2.0 / wavelength;
        let (mut re, mut im) = ([0.0; LANES], [0.0; LANES]);
        let positions = groups(&self.x).zip(groups(&self.y)).zip(groups(&self.z));
        let amplitudes = groups(&self.re).zip(groups(&self.im));
        for (((x, y), z), (a, b)) in positions.zip(amplitudes) {
            for lane in 0..LANES {
                let (dx, dy, dz) = (point.x - x[lane], point.y - y[lane], point.z - z[lane]);
                let distance = (dx * dx + dy * dy + dz * dz).sqrt();
                let inverse = 1.0 / distance.max(wavelength);
                let (sin, cos) = sin_cos_half_turns(distance * half_turns_per_metre);
                re[lane] += inverse * (a[lane] * cos - b[lane] * sin);
                im[lane] += inverse * (a[lane] * sin + b[lane] * cos);
            }
        }
        Complex::new(re.iter().sum(), im.iter().sum())
    }
}

fn groups(values: &[f64]) -> slice::Iter<'_, [f64; LANES]> {
    values.as_chunks().0.iter()
}

/// Returns sine and cosine of `π t` for `0 ≤ t < 2⁵¹`, with an error below 1e−11 in addition to the
/// error of `t`.
///
/// Above this range, where a phase is meaningless, the results are arbitrary numbers in [−1, 1].
/// There are no branches and only operations that vector units have.
#[inline(always)]
fn sin_cos_half_turns(t: f64) -> (f64, f64) {
    use core::f64::consts::PI;
    /// Added to a number below 2⁵¹, it leaves no bits for a fraction: the sum is rounded to an
    /// integer, whose parity is the last bit.
    const WHOLE: f64 = 6_755_399_441_055_744.0;
    let shifted = t + WHOLE;
    let fraction = t - (shifted - WHOLE);
    // Half a turn at most, unless t was too large or not finite.
    let fraction = if fraction.abs() <= 0.5 { fraction } else { 0.0 };
    let sign = shifted.to_bits() << 63;
    let angle = PI * fraction;
    let (sin, cos) = (sine(angle), cosine(angle));
    let turned = |x: f64| f64::from_bits(x.to_bits() ^ sign);
    (turned(sin), turned(cos))
}

/// Taylor series on [−π/2, π/2]: the first omitted term is (π/2)¹⁷/17! = 6e−12.
#[inline(always)]
fn sine(a: f64) -> f64 {
    let a2 = a * a;
    let sum = 1.0 / 6_227_020_800.0 - a2 * (1.0 / 1_307_674_368_000.0);
    let sum = 1.0 / 39_916_800.0 - a2 * sum;
    let sum = 1.0 / 362_880.0 - a2 * sum;
    let sum = 1.0 / 5_040.0 - a2 * sum;
    let sum = 1.0 / 120.0 - a2 * sum;
    let sum = 1.0 / 6.0 - a2 * sum;
    a - a * a2 * sum
}

/// Taylor series on [−π/2, π/2]: the first omitted term is (π/2)¹⁸/18! = 5e−13.
#[inline(always)]
fn cosine(a: f64) -> f64 {
    let a2 = a * a;
    let sum = 1.0 / 87_178_291_200.0 - a2 * (1.0 / 20_922_789_888_000.0);
    let sum = 1.0 / 479_001_600.0 - a2 * sum;
    let sum = 1.0 / 3_628_800.0 - a2 * sum;
    let sum = 1.0 / 40_320.0 - a2 * sum;
    let sum = 1.0 / 720.0 - a2 * sum;
    let sum = 1.0 / 24.0 - a2 * sum;
    let sum = 0.5 - a2 * sum;
    1.0 - a2 * sum
}

#[cfg(test)]
mod tests {
    use core::f64::consts::PI;

    use super::*;

    #[test]
    fn the_series_are_sine_and_cosine() {
        for i in 0..400_000_u32 {
            // The test covers up to 4000 half turns in uneven steps.
            let t = f64::from(i) * 0.010_000_7;
            let (sin, cos) = sin_cos_half_turns(t);
            let angle = PI * (t - 2.0 * (0.5 * t).round());
            // The tolerances are the first omitted terms.
            assert!((sin - angle.sin()).abs() < 7e-12, "sin at {t}");
            assert!((cos - angle.cos()).abs() < 1e-12, "cos at {t}");
        }
    }

    #[test]
    fn parity_holds_up_to_the_largest_phase() {
        for whole in [0_u64, 1, 1_000_001, (1 << 50) + 1, (1 << 51) - 1] {
            let (_, cos) = sin_cos_half_turns(whole as f64);
            let expected = if whole % 2 == 0 { 1.0 } else { -1.0 };
            assert!((cos - expected).abs() < 1e-15, "{cos} at {whole}");
        }
    }

    #[test]
    fn no_phase_gives_anything_but_a_phasor() {
        for t in [1e17, 1e300, f64::INFINITY] {
            let (sin, cos) = sin_cos_half_turns(t);
            assert!(sin.abs() <= 1.0 && cos.abs() <= 1.0, "{sin} {cos} at {t}");
        }
    }

    #[test]
    fn sums_have_the_same_bits_with_any_vector_instructions() {
        let source = |i: u32| {
            let at = f64::from(i);
            let position = DVec3::new(1e-6 * at, 3e-6 * (0.7 * at).sin(), 1e-7 * at.sqrt());
            (position, Complex::new(at.cos(), 0.1 * at))
        };
        let sources: Sources = (0..1000).map(source).collect();
        let point = DVec3::new(1e-3, 2e-3, 0.3);
        let bits = |wave: Complex<f64>| [wave.re, wave.im].map(f64::to_bits);
        // Outside `vectorised` the loop uses the instructions that every processor of the target
        // has.
        let plain = sources.sum_at(point, 650e-9);
        assert_eq!(bits(sources.wave_at(point, 650e-9)), bits(plain));
    }

    #[test]
    fn dark_sources_fill_the_last_group_only() {
        let source = (DVec3::Z, Complex::new(2.0, 0.0));
        for count in [1, 7, 8, 9] {
            let sources: Sources = core::iter::repeat_n(source, count).collect();
            assert_eq!(sources.x.len(), count.next_multiple_of(LANES));
            // At a distance of two wavelengths all waves are in phase.
            let wave = sources.wave_at(DVec3::ZERO, 0.5);
            let expected = 2.0 * count as f64;
            assert!((wave - expected).norm() < 1e-10, "{wave} for {count}");
        }
    }
}
