use core::f64::consts::{FRAC_PI_2, SQRT_2};

use nalgebra::{Matrix4, Vector4};

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

/// A sum of squares to be made small, with its normal equations.
struct Normal {
    cost: f64,
    matrix: Matrix4<f64>,
    right: Vector4<f64>,
}

/// Fits by the method of Levenberg and Marquardt, from the position and the width of the light on.
pub(super) fn fit(profile: &Profile<'_>) -> Option<Estimate> {
    const MAX_STEPS: usize = 200;
    let scale = profile.at(0);
    let extent = Extent::of(profile)?;
    let mut model = Gaussian {
        amplitude: 1.0,
        centre: extent.middle,
        radius: (extent.width / 2.0).max(0.5),
        background: 0.0,
    };
    let window = profile.line.window.len() as f64;
    let mut normal = model.normal(profile, scale);
    let mut damping = 1e-3;
    for _ in 0..MAX_STEPS {
        let (next, step) = model.improved(&normal, damping)?;
        let is_last = step < Gaussian::STAYS;
        let is_possible = next.radius > 0.1 && next.radius < 4.0 * window;
        let candidate = next.normal(profile, scale);
        if is_possible && candidate.cost <= (1.0 + Gaussian::ROUNDING) * normal.cost {
            (model, normal) = (next, candidate);
            damping = f64::max(damping / 10.0, 1e-15);
        } else {
            damping *= 10.0;
        }
        if is_last {
            return model.estimate(window);
        }
    }
    None
}

impl Gaussian {
    /// The step of the centre and the radius, in pixels, that ends the fit.
    const STAYS: f64 = 1e-11;
    /// Largest allowed relative rise of the sum of squares. Near its minimum it is flat: its rounding hides a step of
    /// 1e−8 of the radius, which the normal equations still tell.
    const ROUNDING: f64 = 1e-12;

    /// The estimate, if the pixels hold a line: they tell nothing of one much thinner than a pixel or
    /// wider than the window, and the fit ran into its bounds.
    fn estimate(&self, window: f64) -> Option<Estimate> {
        let is_line = self.amplitude > 0.0 && self.radius > 0.2 && self.radius < window;
        is_line.then_some(Estimate {
            position: self.centre,
            width: Some(2.0 * self.radius),
        })
    }

    /// The value of a pixel and its derivatives by A, c, w and B.
    fn pixel(&self, y: f64) -> (f64, Vector4<f64>) {
        let (w, below, above) = (self.radius, y - 0.5 - self.centre, y + 0.5 - self.centre);
        let gaussian = |u: f64| (-2.0 * (u / w).powi(2)).exp();
        let (e_below, e_above) = (gaussian(below), gaussian(above));
        let erf = libm::erf(SQRT_2 * above / w) - libm::erf(SQRT_2 * below / w);
        let integral = 0.5 * FRAC_PI_2.sqrt() * w * erf;
        let widening = (integral - above * e_above + below * e_below) / w;
        let by = Vector4::new(
            integral,
            self.amplitude * (e_below - e_above),
            self.amplitude * widening,
            1.0,
        );
        (self.amplitude * integral + self.background, by)
    }

    fn normal(&self, profile: &Profile<'_>, scale: f64) -> Normal {
        let mut normal = Normal {
            cost: 0.0,
            matrix: Matrix4::zeros(),
            right: Vector4::zeros(),
        };
        for (y, value) in profile.pixels() {
            let (model, by) = self.pixel(y);
            let residual = value / scale - model;
            normal.cost += residual * residual;
            normal.matrix += by * by.transpose();
            normal.right += residual * by;
        }
        normal
    }

    /// The model after a damped step, and how far centre and radius went.
    fn improved(&self, normal: &Normal, damping: f64) -> Option<(Self, f64)> {
        let mut matrix = normal.matrix;
        for i in 0..4 {
            matrix[(i, i)] += damping * matrix[(i, i)];
        }
        let step = matrix.cholesky()?.solve(&normal.right);
        let next = Self {
            amplitude: self.amplitude + step[0],
            centre: self.centre + step[1],
            radius: self.radius + step[2],
            background: self.background + step[3],
        };
        let moved = step[1].abs().max(step[2].abs());
        moved.is_finite().then_some((next, moved))
    }
}
