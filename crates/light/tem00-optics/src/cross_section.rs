mod marginal;

use core::f64::consts::{FRAC_PI_2, LN_2, PI, SQRT_2};

use tem00_beam::Refusal;
use tem00_numerics::{check, quadrature::integrate};

use marginal::{Interval, power_beyond};

/// Distance from the axis, in radii, beyond which the power is negligible: exp(−2 · 7²) = 3e−43.
const REACH: f64 = 7.0;

/// Irradiance of a Gaussian beam of 1 W over a plane across the beam.
///
/// The principal axes of the distribution are x and y, its centre is the origin, and its radii to
/// 1/e² on these axes are `w_x` and `w_y`:
///
/// ```text
/// E(x, y) / P = 2 / (π w_x w_y) · exp(−2 x² / w_x² − 2 y² / w_y²)
/// ```
///
/// A circular beam has two equal radii. Powers are fractions of the total power, from 0 to 1; an
/// aperture of negative size passes no power. They are accurate to 1e−12, and small fractions to a
/// relative error of about 1e−11, for apertures of any size and position.
///
/// # Examples
///
/// A beam of 1 mm radius passes an iris of the same size, and an edge:
///
/// ```
/// use tem00_optics::CrossSection;
///
/// let spot = CrossSection::new([1e-3, 1e-3])?;
/// assert!((spot.power_in_circle(1e-3) - 0.8647).abs() < 1e-4); // 1 − e⁻²
/// assert!((spot.power_past_knife_edge(0.5e-3) - 0.1587).abs() < 1e-4); // one σ
/// # Ok::<(), tem00_beam::Refusal>(())
/// ```
///
/// # References
///
/// - A. E. Siegman, *Lasers*, 1986, sec. 17.1, for apertures.
/// - ISO 11146-1, 2021, for D4σ.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct CrossSection {
    radii: [f64; 2],
}

impl CrossSection {
    /// Creates a cross-section from its principal radii `[w_x, w_y]`, in metres.
    ///
    /// # Errors
    ///
    /// Returns an error if a radius is not a length from 1e−30 m to 1e30 m.
    pub fn new(radii: [f64; 2]) -> Result<Self, Refusal> {
        for radius in radii {
            check::length("radius", radius)?;
        }
        Ok(Self { radii })
    }

    /// Returns the principal radii `[w_x, w_y]` to 1/e², in metres.
    pub const fn radii(&self) -> [f64; 2] {
        self.radii
    }

    /// Returns this cross-section with its axes exchanged, `[w_y, w_x]`, for a slit or a knife edge
    /// across y.
    #[must_use]
    pub const fn transposed(&self) -> Self {
        let [w_x, w_y] = self.radii;
        Self { radii: [w_y, w_x] }
    }

    /// Returns the irradiance per watt of beam power, in m⁻², at `point`, in metres.
    pub fn irradiance_per_watt(&self, point: [f64; 2]) -> f64 {
        let [w_x, w_y] = self.radii;
        let rho = (point[0] / w_x).hypot(point[1] / w_y);
        2.0 / (PI * w_x) / w_y * (-2.0 * rho * rho).exp()
    }

    /// Returns the full widths at half maximum `√(2 ln 2) [w_x, w_y]`, in metres: 1.177 radii.
    pub fn fwhm(&self) -> [f64; 2] {
        let factor = (2.0 * LN_2).sqrt();
        self.radii.map(|radius| factor * radius)
    }

    /// Returns the D4σ widths `[2 w_x, 2 w_y]`, in metres: four standard deviations of the
    /// distribution on each axis, which are diameters.
    pub fn d4_sigma(&self) -> [f64; 2] {
        self.radii.map(|radius| 2.0 * radius)
    }

    /// Returns the distances, in metres, by which a knife edge moves along x and along y between
    /// the positions that leave 10 % and 90 % of the power: `1.28155 [w_x, w_y]`.
    ///
    /// # Examples
    ///
    /// ```
    /// use tem00_optics::CrossSection;
    ///
    /// let spot = CrossSection::new([1e-3, 2e-3])?;
    /// let [along_x, along_y] = spot.knife_edge_width();
    /// assert!((along_x - 1.2816e-3).abs() < 1e-7);
    /// assert!((spot.power_past_knife_edge(along_x / 2.0) - 0.1).abs() < 1e-12);
    /// assert!((along_y / along_x - 2.0).abs() < 1e-12);
    /// # Ok::<(), tem00_beam::Refusal>(())
    /// ```
    pub fn knife_edge_width(&self) -> [f64; 2] {
        // The standard normal variate exceeds this value with a probability of 10 %; from −z σ to
        // z σ the edge moves by 2 z σ = z w.
        const UPPER_DECILE: f64 = 1.281_551_565_544_600_4;
        self.radii.map(|radius| UPPER_DECILE * radius)
    }

    /// Returns the effective area `(∫E dA)² / ∫E² dA = π w_x w_y`, in m².
    ///
    /// The peak irradiance is twice the power divided by this area.
    pub fn effective_area(&self) -> f64 {
        let [w_x, w_y] = self.radii;
        PI * w_x * w_y
    }

    /// Returns the fraction of the power within `radius`, in metres, of the centre.
    ///
    /// For a circular beam it is `1 − exp(−2 radius² / w²)`; for an elliptical one it has no closed
    /// form and is an integral over the chords of the circle.
    pub fn power_in_circle(&self, radius: f64) -> f64 {
        let [w_x, w_y] = self.radii;
        let (wide, slim) = (w_x.max(w_y), w_x.min(w_y));
        let [rho, rho_slim] = [wide, slim].map(|w| radius.max(0.0) / w);
        if wide.total_cmp(&slim).is_eq() {
            return -(-2.0 * rho * rho).exp_m1();
        }
        if rho > REACH {
            return 1.0;
        }
        // Chords across the wide axis, as a function of the angle s of their ends from it.
        let chord = |s: f64| {
            let (sin, cos) = s.sin_cos();
            let along = rho * cos;
            rho * sin * (-2.0 * along * along).exp() * libm::erf(SQRT_2 * rho_slim * sin)
        };
        // Near the ends of the axis chords grow on the scale of the small radius, farther away on
        // the scale of the large one.
        let (mut start, mut step) = (0.0, rho_slim.recip().max(1e-18));
        let mut sum = 0.0;
        while start < FRAC_PI_2 {
            let end = (start + step.min(0.5).min(0.5 / rho)).min(FRAC_PI_2);
            sum += integrate(chord, [start, end], FRAC_PI_2);
            (start, step) = (end, 2.0 * step);
        }
        (2.0 * (2.0 / PI).sqrt() * sum).min(1.0)
    }

    /// Returns the radius, in metres, of the circle about the centre that holds the given
    /// `fraction` of the power.
    ///
    /// For a circular beam it is `w √(−ln(1 − fraction) / 2)`; for an elliptical one the root of
    /// [`power_in_circle`](Self::power_in_circle), accurate to 1e−12 in the power.
    ///
    /// # Errors
    ///
    /// Returns an error if `fraction` is not in the interval [0, 1).
    ///
    /// # Examples
    ///
    /// An aperture of 3/2 of the beam radius passes 98.9 % of the power; 99 % need a slightly
    /// larger one:
    ///
    /// ```
    /// use tem00_optics::CrossSection;
    ///
    /// let spot = CrossSection::new([1e-3, 1e-3])?;
    /// assert!((spot.circle_radius(0.99)? - 1.517e-3).abs() < 1e-6);
    /// # Ok::<(), tem00_beam::Refusal>(())
    /// ```
    pub fn circle_radius(&self, fraction: f64) -> Result<f64, Refusal> {
        check::that(
            (0.0..1.0).contains(&fraction),
            "fraction",
            fraction,
            "",
            "in [0, 1)",
        )?;
        let per_radius = (-0.5 * (-fraction).ln_1p()).sqrt();
        let [w_x, w_y] = self.radii;
        if w_x.total_cmp(&w_y).is_eq() || fraction <= 0.0 {
            return Ok(per_radius * w_x);
        }
        // The circular beams of the smaller and of the larger radius enclose more and less.
        let bracket = [w_x.min(w_y), w_x.max(w_y)].map(|radius| (per_radius * radius).ln());
        let log_radius = root(bracket, |log_radius| {
            self.power_in_circle(log_radius.exp()) - fraction
        });
        Ok(log_radius.exp())
    }

    /// Returns the fraction of the power within a centred square with sides of the given length, in
    /// metres, along x and y: the ensquared power.
    ///
    /// ```text
    /// erf(side / (√2 w_x)) · erf(side / (√2 w_y))
    /// ```
    pub fn power_in_square(&self, side: f64) -> f64 {
        self.power_in_rectangle([0.0, 0.0], [side, side])
    }

    /// Returns the fraction of the power within the rectangle about `centre` whose sides along x
    /// and y have the full lengths `size`, all in metres.
    pub fn power_in_rectangle(&self, centre: [f64; 2], size: [f64; 2]) -> f64 {
        self.power_in_slit(centre[0], size[0]) * self.transposed().power_in_slit(centre[1], size[1])
    }

    /// Returns the fraction of the power that passes a slit across x: from `centre − width / 2` to
    /// `centre + width / 2`, in metres, at any y.
    pub fn power_in_slit(&self, centre: f64, width: f64) -> f64 {
        Interval::new(centre, 0.5 * width).power(self.radii[0])
    }

    /// Returns the fraction of the power at x greater than `position`, in metres, which passes a
    /// knife edge that covers everything below `position`.
    ///
    /// ```text
    /// ½ erfc(√2 position / w_x)
    /// ```
    pub fn power_past_knife_edge(&self, position: f64) -> f64 {
        power_beyond(position, self.radii[0])
    }
}

/// The root within `bracket` of a function that rises through it, by the Illinois variant of the
/// rule of false position.
fn root([mut a, mut b]: [f64; 2], f: impl Fn(f64) -> f64) -> f64 {
    const MAX_STEPS: usize = 200;
    let (mut f_a, mut f_b) = (f(a), f(b));
    for _ in 0..MAX_STEPS {
        let x = b - f_b * (b - a) / (f_b - f_a);
        if !(x > a.min(b) && x < a.max(b)) {
            break;
        }
        let f_x = f(x);
        if (f_x > 0.0) == (f_b > 0.0) {
            f_a *= 0.5;
        } else {
            (a, f_a) = (b, f_b);
        }
        (b, f_b) = (x, f_x);
    }
    b
}

#[cfg(test)]
mod tests;
