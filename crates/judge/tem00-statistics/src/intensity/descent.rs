use core::f64::consts::{FRAC_1_SQRT_2, PI, SQRT_2};

use num_complex::Complex;

/// The factor `(scale / (p − pole))^count` of a Laplace transform, with its pole at zero or left of
/// it.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Factor {
    pub(crate) pole: f64,
    pub(crate) scale: f64,
    pub(crate) count: f64,
}

/// Returns the inverse Laplace transform of a product of factors at `time`; the factor with the
/// rightmost pole comes first.
///
/// ```text
/// f(x) = (1/2πi) ∫ exp(φ(p)) dp      φ(p) = p x − Σ nⱼ ln((p − pⱼ)/sⱼ)
/// ```
///
/// On the real axis right of all poles φ has one minimum, the saddle of the integrand. The path of
/// steepest descent from the saddle, φ = φ₀ − τ², encloses all poles, as all other saddles lie on
/// the real axis between them. Along the path the integrand is exp(−τ²) times a smooth function,
/// which the trapezoidal rule sums to 1e−13 without cancellation: poles may coincide, nearly
/// coincide or lie far apart, and even very small results keep their digits. The computing time
/// grows with the number of factors.
pub(crate) fn inverse_laplace_transform(factors: &[Factor], time: f64) -> f64 {
    let Some(first) = factors.first() else {
        return 0.0;
    };
    let behind: Vec<f64> = factors
        .iter()
        .map(|f| (first.pole - f.pole) * time)
        .collect();
    let saddle = saddle(factors, &behind);
    // The distances of all poles from the saddle: the distance of the first pole in units of each,
    // and its square.
    let ratios = behind.iter().map(|behind| saddle / (saddle + behind));
    let norm: f64 = factors
        .iter()
        .zip(ratios.clone())
        .map(|(factor, ratio)| factor.count * ratio * ratio)
        .sum();
    let norm = norm.sqrt();
    let terms: Vec<Term> = factors
        .iter()
        .zip(ratios)
        .map(|(factor, ratio)| Term {
            count: factor.count,
            ratio: ratio / norm,
        })
        .collect();
    // One of the first factors is reserved for the measure of the path.
    let others = |index: usize| factors[index].count - if index == 0 { 1.0 } else { 0.0 };
    let height: f64 = (0..factors.len())
        .filter(|&index| others(index) > 0.0)
        .map(|index| others(index) * (factors[index].scale * time / (saddle + behind[index])).ln())
        .sum();
    let (decay, height) = (first.pole * time, saddle + height);
    // The first exponential by itself is exact, but may be zero where the product is not.
    let size = if decay > -600.0 {
        decay.exp() * height.exp()
    } else {
        (decay + height).exp()
    };
    first.scale / norm * size * path_integral(&terms)
}

/// A factor in terms of the path: the reciprocal distance of its pole from the saddle. The squares
/// of all terms add up to one.
#[derive(Clone, Copy, Debug)]
struct Term {
    count: f64,
    ratio: f64,
}

/// The distance of the saddle from the first pole, divided by the time: Σ nⱼ/(d + behindⱼ) = 1.
fn saddle(factors: &[Factor], behind: &[f64]) -> f64 {
    let sums = |d: f64| {
        let terms = factors.iter().zip(behind);
        terms.fold((0.0, 0.0), |(sum, squares), (factor, behind)| {
            let inverse = (d + behind).recip();
            let term = factor.count * inverse;
            (sum + term, squares + term * inverse)
        })
    };
    // Bounds: all poles coincide with the first, or the first is alone.
    let (mut high, mut low) = (factors.iter().map(|factor| factor.count).sum(), 1.0);
    let mut d: f64 = high;
    // Newton's method on the reciprocal of the sum, which is nearly straight, within the bracket.
    for _ in 0..100 {
        let (sum, squares) = sums(d);
        if sum > 1.0 {
            low = d;
        } else {
            high = d;
        }
        let newton = d - (1.0 - sum) * sum / squares;
        let next = if (low..=high).contains(&newton) {
            newton
        } else {
            0.5 * (low + high)
        };
        let change = (next - d).abs();
        d = next;
        if change <= f64::EPSILON * d {
            break;
        }
    }
    d
}

/// The step of the trapezoidal rule in τ, and the number of steps: exp(−6.3²) is 6e−18.
const STEP: f64 = 0.15;
const STEPS: u32 = 42;

/// (1/π) Im ∫₀^∞ exp(−τ²) dy/dτ dτ along the path, with the distance y from the saddle, in units in
/// which φ falls as y²/2 on both sides.
fn path_integral(terms: &[Term]) -> f64 {
    let zero = Complex::new(0.0, 0.0);
    // The last three points.
    let mut path = [zero; 3];
    let mut sum = FRAC_1_SQRT_2;
    for step in 1..=STEPS {
        let tau = STEP * f64::from(step);
        let [c, b, a] = path;
        let guess = match step {
            1 => Complex::new(0.0, SQRT_2 * tau),
            2 => a * 2.0,
            _ => (a - b) * 3.0 + c,
        };
        let (y, slope) = point_of_path(terms, tau, guess);
        sum += (-tau * tau).exp() * slope.im;
        path = [b, a, y];
    }
    STEP / PI * sum
}

/// The point of the path at τ, and dy/dτ there, by Newton's method.
fn point_of_path(terms: &[Term], tau: f64, guess: Complex<f64>) -> (Complex<f64>, Complex<f64>) {
    const STEPS: usize = 30;
    let mut y = guess;
    for _ in 0..STEPS {
        let (fall, curvature) = fall(terms, y);
        let change = (fall + tau * tau) / (y * curvature);
        y -= change;
        // The next step would be about the square of this one.
        if change.norm_sqr() < 1e-18 * y.norm_sqr() {
            break;
        }
    }
    let (_, curvature) = fall(terms, y);
    (y, -2.0 * tau / (y * curvature))
}

/// φ − φ₀ = Σ n [z − ln(1 + z)] with z = `ratio` y, and its derivative over y.
fn fall(terms: &[Term], y: Complex<f64>) -> (Complex<f64>, Complex<f64>) {
    let zero = Complex::new(0.0, 0.0);
    terms.iter().fold((zero, zero), |(fall, curvature), term| {
        let z = y * term.ratio;
        let one_and_z = z + 1.0;
        let logarithm = Complex::new(
            0.5 * (2.0 * z.re + z.norm_sqr()).ln_1p(),
            z.im.atan2(one_and_z.re),
        );
        let square = term.count * term.ratio * term.ratio;
        (
            fall + (z - logarithm) * term.count,
            curvature + one_and_z.inv() * square,
        )
    })
}
