use core::f64::consts::PI;

use super::subsurface::PixelSpread;
use tem00_numerics::{cast::to_usize, disc_overlap, quadrature::integrate, sinc};

/// The period of the sum, in units of the range that is evaluated: copies of the line stay that far
/// away.
const PERIOD: f64 = 4.0;

/// The profile of the image of a laser line along a column of pixels: a Gaussian that a round pupil
/// blurs, in or out of focus, and pixels integrate.
///
/// ```text
/// m(y) = ∫ exp(−π² W² f²/8) T(f) sinc(π a f) cos(2π f y) df        from −1/h to 1/h
/// T(f) = (4/π) ∫ sin²φ cos(π b f (cos φ − h f)) dφ                  from 0 to acos(h f)
/// m(y) → 2h / (π³ y²)                                              far from the line
/// ```
///
/// W is the full width of the Gaussian between the points of 1/e², h the speckle size along the
/// column, b the diameter of the disc of defocus and a the height of the sensitive part of a pixel;
/// the integral of m is 1. T is the transfer function of the lens (Hopkins 1955), chat(h f) in
/// focus. The wings come from the lens: they hold 4h/(π³ Y) of the light outside of ±Y.
///
/// The integral is a sum over equal steps of the frequency. Its copies of the line, a period apart,
/// are so far away that only their wings remain, whose sum is known and subtracted.
#[derive(Clone, Debug)]
pub(crate) struct LineProfile {
    period: f64,
    speckle_size: f64,
    /// The spectrum at whole multiples of 1/period, the first halved.
    spectrum: Vec<f64>,
    /// The sine transform of a line that light from below the surface spreads, or none.
    odd: Vec<f64>,
}

/// A line that a lens images onto pixels. All lengths are along the column, in pixels.
#[derive(Clone, Copy, Debug)]
pub(crate) struct LensedLine {
    /// The full width of the line between the points of 1/e², as a sharp lens would image it.
    pub(crate) width: f64,
    /// The diameter of the disc of defocus.
    pub(crate) blur: f64,
    pub(crate) speckle_size: f64,
    /// The height of the sensitive part of a pixel.
    pub(crate) pixel: f64,
}

impl LineProfile {
    /// Creates the profile for positions up to `reach` from the middle of the line, in pixels.
    pub(crate) fn new(line: &LensedLine, spread: &PixelSpread, reach: f64) -> Self {
        let LensedLine {
            width,
            blur,
            speckle_size,
            pixel,
        } = *line;
        let period = PERIOD * reach.max(4.0 * (width + blur + speckle_size) + spread.range());
        // Beyond 5.5/W the Gaussian is 10⁻¹⁶.
        let end = speckle_size.recip().min(5.5 / width);
        let at = |index: usize| {
            let f = index as f64 / period;
            let gaussian = (-(PI * width * f).powi(2) / 8.0).exp();
            let half = if index == 0 { 0.5 } else { 1.0 };
            let lens = transfer(speckle_size * f, blur * f);
            2.0 / period * half * gaussian * lens * sinc(PI * pixel * f)
        };
        let steps = to_usize((end * period).ceil());
        let mut profile = Self {
            period,
            speckle_size,
            spectrum: (0..=steps).map(at).collect(),
            odd: Vec::new(),
        };
        if !spread.is_none() {
            profile.spread(spread);
        }
        profile
    }

    /// Spreads the line by light from below the surface.
    fn spread(&mut self, spread: &PixelSpread) {
        let transforms = spread.transforms(self.period.recip(), self.spectrum.len());
        for (even, [cos, sin]) in self.spectrum.iter_mut().zip(transforms) {
            self.odd.push(sin * *even);
            *even *= cos;
        }
    }

    /// Returns the place of the crest, found in steps from the entry of the line.
    pub(crate) fn crest(&self, step: f64) -> f64 {
        let higher = |step: f64| {
            let mut place = 0.0;
            while self.at(place + step) > self.at(place) {
                place += step;
            }
            place
        };
        higher(step) + higher(-step)
    }

    /// Returns the full width at half of the crest, to a thousandth of it.
    pub(crate) fn width_at_half(&self, crest: f64, step: f64) -> f64 {
        let half = 0.5 * self.at(crest);
        let side = |sign: f64| {
            let is_bright = |distance: f64| self.at(crest + sign * distance) > half;
            let mut end = step;
            while is_bright(end) {
                end *= 2.0;
            }
            // The flank is not farther than half of the way back.
            let mut near = 0.5 * end;
            while end - near > 1e-3 * end {
                let middle = 0.5 * (near + end);
                *(if is_bright(middle) {
                    &mut near
                } else {
                    &mut end
                }) = middle;
            }
            end
        };
        side(-1.0) + side(1.0)
    }

    /// Returns the fraction of the light per pixel, averaged over the sensitive part of a pixel
    /// whose middle is `distance` from the middle of the line.
    pub(crate) fn at(&self, distance: f64) -> f64 {
        let angle = 2.0 * PI * distance / self.period;
        let even = sum_of_waves(&self.spectrum, angle, f64::cos);
        let odd = sum_of_waves(&self.odd, angle, f64::sin);
        (even + odd - self.copies(0.5 * angle)).max(0.0)
    }

    /// The wings of all copies: Σ 2h/(π³ (y + k P)²) over k ≠ 0, at `angle` = π y/P.
    fn copies(&self, angle: f64) -> f64 {
        let sum = if angle.abs() < 1e-3 {
            1.0 / 3.0
        } else {
            angle.sin().powi(-2) - angle.powi(-2)
        };
        2.0 * self.speckle_size / (PI * self.period * self.period) * sum
    }
}

/// Returns Σ aₖ wave(k φ) over the amplitudes aₖ from k = 0, for a sine or cosine.
///
/// Four sums are independent of each other, so that none waits for the one before it:
/// wave((k + 4) φ) = 2 cos 4φ wave(k φ) − wave((k − 4) φ).
fn sum_of_waves(amplitudes: &[f64], angle: f64, wave: fn(f64) -> f64) -> f64 {
    if amplitudes.is_empty() {
        return 0.0;
    }
    let double = 2.0 * (4.0 * angle).cos();
    let mut before = [-4.0, -3.0, -2.0, -1.0].map(|k| wave(k * angle));
    let mut now = [0.0, 1.0, 2.0, 3.0].map(|k| wave(k * angle));
    let mut sums = [0.0; 4];
    for amplitudes in amplitudes.chunks(4) {
        for ((sum, amplitude), wave) in sums.iter_mut().zip(amplitudes).zip(now) {
            *sum += amplitude * wave;
        }
        let after = core::array::from_fn(|k| double * now[k] - before[k]);
        (before, now) = (now, after);
    }
    sums.iter().sum()
}

/// The transfer function of a round pupil at the frequency at which its copies lie `shift`
/// diameters apart and the disc of defocus is `blur` periods wide.
pub(crate) fn transfer(shift: f64, blur: f64) -> f64 {
    if blur == 0.0 {
        return disc_overlap(shift);
    }
    let f = |angle: f64| {
        let cos = angle.cos();
        (1.0 - cos) * (1.0 + cos) * (PI * blur * (cos - shift)).cos()
    };
    // A panel holds a period at most.
    4.0 / PI * integrate(f, [0.0, shift.min(1.0).acos()], 2.0 / blur.max(1.0))
}

#[cfg(test)]
mod tests {
    use tem00_numerics::jinc;
    use tem00_testkit::assert_absolute;

    use super::*;

    /// The Airy pattern summed along the line, at a distance in speckle sizes.
    fn airy_line(x: f64) -> f64 {
        // Beyond 200 h the mean of the pattern, 4/(π⁴ r³) in units of h, continues.
        const ALONG: f64 = 200.0;
        let airy = |step: u32| {
            let y = f64::from(step) / 8.0;
            let half = if step == 0 { 0.5 } else { 1.0 };
            half * jinc(PI * x.hypot(y)).powi(2)
        };
        let sum = (0..1600).map(airy).sum::<f64>() / 4.0;
        PI / 4.0 * (sum + 4.0 / (PI.powi(4) * ALONG * ALONG))
    }

    /// Line profile out of focus: the light through each chord of the pupil. `blur` is in speckle
    /// sizes.
    fn defocused_line(x: f64, blur: f64) -> f64 {
        let of_chord = |angle: f64| {
            let half = 0.5 * angle.sin();
            let wave = |part: fn(f64) -> f64| {
                let at = |v: f64| part(PI * (blur * v * v + 2.0 * v * x));
                integrate(at, [-half, half], 0.1)
            };
            angle.sin() * wave(f64::cos).hypot(wave(f64::sin)).powi(2)
        };
        4.0 / PI * integrate(of_chord, [0.0, 0.5 * PI], 0.2)
    }

    /// The profile in space: the image of a sharp line, over line and pixel by the midpoint rule.
    fn in_space(line: &LensedLine, distance: f64, of_point: impl Fn(f64) -> f64) -> f64 {
        const STEPS: u32 = 400;
        let LensedLine {
            width,
            speckle_size,
            pixel,
            ..
        } = *line;
        let middle =
            |step: u32, end: f64| ((f64::from(step) + 0.5) / f64::from(STEPS) * 2.0 - 1.0) * end;
        let mut sum = 0.0;
        let mut weights = 0.0;
        for step in 0..STEPS {
            let s = middle(step, 1.3 * width + 0.5 * pixel);
            // The line, averaged over a pixel that is s away.
            let scale = 8.0_f64.sqrt() / width;
            let line = libm::erf(scale * (s + 0.5 * pixel)) - libm::erf(scale * (s - 0.5 * pixel));
            sum += line * of_point((distance - s) / speckle_size) / speckle_size;
            weights += line;
        }
        sum / weights
    }

    #[test]
    fn it_is_the_line_blurred_by_the_lens_and_the_pixel() {
        for (width, speckle_size, blur) in [
            (0.5, 1.6, 0.0),
            (4.6, 1.67, 0.0),
            (12.0, 4.0, 0.0),
            (0.5, 1.6, 6.4),
            (4.6, 1.67, 8.0),
        ] {
            let line = LensedLine {
                width,
                blur,
                speckle_size,
                pixel: 0.9,
            };
            let profile = LineProfile::new(&line, &PixelSpread::default(), 30.0);
            for distance in [0.0, 0.7, 3.1, 9.0, 29.5] {
                let expected = if blur == 0.0 {
                    in_space(&line, distance, airy_line)
                } else {
                    let of_point = |x: f64| defocused_line(x, blur / speckle_size);
                    in_space(&line, distance, of_point)
                };
                // The rings of the copies are left, a tenth of their wings of 10⁻⁵ and below.
                assert_absolute(
                    profile.at(distance),
                    expected,
                    1e-6_f64.max(1e-5 * expected),
                );
            }
        }
    }

    #[test]
    fn all_light_is_in_the_pixels_and_the_wings_beyond() {
        let (width, speckle_size) = (4.0, 1.6);
        let line = LensedLine {
            width,
            blur: 0.0,
            speckle_size,
            pixel: 1.0,
        };
        let profile = LineProfile::new(&line, &PixelSpread::default(), 200.0);
        let inside: f64 = (-200..200).map(|y| profile.at(f64::from(y) + 0.2)).sum();
        let outside = 4.0 * speckle_size / (PI.powi(3) * 200.0);
        // The next order of the wings is 3σ²/Y² of them.
        assert_absolute(inside + outside, 1.0, 1e-6);
    }
}
