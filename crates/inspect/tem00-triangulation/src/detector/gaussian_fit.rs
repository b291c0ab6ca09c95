use core::f64::consts::{FRAC_PI_2, SQRT_2};

use tem00_numerics::{NormalEquations, minimise};

use super::{
    extent::Extent,
    profile::{Estimate, Profile},
};

/// A Gaussian on a constant background, integrated over pixels.
///
/// ```text
/// m_i = A ∫ exp(−2 (y − c)²/w²) dy + B      over the pixel i
///     = A √(π/8) w [erf(√2 u₊/w) − erf(√2 u₋/w)] + B,   u± = y_i ± ½ − c
/// ```
#[derive(Clone, Copy, Debug)]
struct Gaussian {
    amplitude: f64,
    centre: f64,
    radius: f64,
    background: f64,
}

/// Fits by least squares, starting from the position and the width of the light.
pub(super) fn fit(profile: &Profile<'_>) -> Option<Estimate> {
    let extent = Extent::of(profile)?;
    let start = Gaussian {
        amplitude: 1.0,
        centre: extent.middle,
        radius: (extent.width / 2.0).max(0.5),
        background: 0.0,
    };
    let equations = |model: &Gaussian| model.normal_equations(profile);
    let found = minimise(start, Gaussian::stepped, equations).ok()?;
    found.state.estimate(profile)
}

impl Gaussian {
    fn stepped(&self, step: &[f64]) -> Self {
        Self {
            amplitude: self.amplitude + step[0],
            centre: self.centre + step[1],
            radius: self.radius + step[2],
            background: self.background + step[3],
        }
    }

    /// The normal equations of a profile in units of its peak.
    fn normal_equations(&self, profile: &Profile<'_>) -> Option<NormalEquations> {
        let window = profile.line.window.len() as f64;
        if !(self.radius > 0.1 && self.radius < 4.0 * window) {
            return None;
        }
        let peak = profile.at(0);
        let mut equations = NormalEquations::new(4);
        for (y, value) in profile.pixels() {
            let (model, slopes) = self.pixel(y);
            equations.add(model - value / peak, &slopes);
        }
        Some(equations)
    }

    /// The estimate, if the pixels hold a line: for a line beside them, much thinner than a pixel
    /// or wider than the window they give no information, and the fit diverges.
    fn estimate(&self, profile: &Profile<'_>) -> Option<Estimate> {
        let window = profile.line.window.len() as f64;
        let is_wide = self.radius > 0.2 && self.radius < window;
        let is_inside = profile
            .pixels()
            .any(|(y, _)| (y - self.centre).abs() <= 0.5);
        let is_line = self.amplitude > 0.0 && is_wide && is_inside;
        is_line.then_some(Estimate {
            position: self.centre,
            width: Some(2.0 * self.radius),
        })
    }

    /// The value of a pixel and its derivatives by A, c, w and B.
    fn pixel(&self, y: f64) -> (f64, [f64; 4]) {
        let (w, below, above) = (self.radius, y - 0.5 - self.centre, y + 0.5 - self.centre);
        let gaussian = |u: f64| (-2.0 * (u / w).powi(2)).exp();
        let (e_below, e_above) = (gaussian(below), gaussian(above));
        let erf = libm::erf(SQRT_2 * above / w) - libm::erf(SQRT_2 * below / w);
        let integral = 0.5 * FRAC_PI_2.sqrt() * w * erf;
        let widening = (integral - above * e_above + below * e_below) / w;
        let by = [
            integral,
            self.amplitude * (e_below - e_above),
            self.amplitude * widening,
            1.0,
        ];
        (self.amplitude * integral + self.background, by)
    }
}
