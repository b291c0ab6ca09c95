//! The worked examples of JCGM 101:2008, § 9, to the digits that the document states, and to closed
//! forms where there are some. All seeds are fixed.

#![expect(
    clippy::unwrap_used,
    reason = "a test stops at what it does not expect"
)]

use tem00_uncertainty::{
    Correlation, CoverageInterval, CoverageProbability, Distribution, FirstOrder, Input, Inputs,
    IntervalKind, Propagation, PropagationOptions,
};

const P95: CoverageProbability = CoverageProbability::P95;

fn input(estimate: f64, uncertainty: f64, distribution: Distribution) -> Input {
    Input::new(estimate, uncertainty, distribution).unwrap()
}

fn normal(estimate: f64, uncertainty: f64) -> Input {
    input(estimate, uncertainty, Distribution::Normal)
}

fn rectangular(low: f64, high: f64) -> Input {
    let half = 0.5 * (high - low);
    let (middle, u) = (0.5 * (low + high), half / 3.0_f64.sqrt());
    input(middle, u, Distribution::Rectangular)
}

fn student(estimate: f64, scale: f64, degrees_of_freedom: f64) -> Input {
    let input = input(estimate, scale, Distribution::StudentT);
    input.with_degrees_of_freedom(degrees_of_freedom).unwrap()
}

fn independent(inputs: Vec<Input>) -> Inputs {
    Inputs::independent(inputs).unwrap()
}

/// Asserts that a value is the stated one, rounded to a unit, as far as trials may scatter.
fn assert_stated(what: &str, value: f64, stated: f64, unit: f64, scatter: f64) {
    let error = (value - stated).abs();
    assert!(
        error <= 0.5 * unit + scatter,
        "{what}: {value}, stated {stated}, scatter {scatter}"
    );
}

/// Asserts that the ends of an interval are the stated ones.
fn assert_interval(found: CoverageInterval, stated: [f64; 2], unit: f64, scatter: f64) {
    assert_stated("lower end", found.low, stated[0], unit, scatter);
    assert_stated("upper end", found.high, stated[1], unit, scatter);
}

/// Asserts that an interval has the stated length.
///
/// Ends of shortest intervals scatter with the cube root of the number of trials, and together; the
/// length does not: with the density f at both ends its standard error is √(p(1 − p)/M)/f. Of the
/// 10⁶ trials of the document that is 0.0037 u of normal and 0.0044 u of exponential values; three
/// of the latter are allowed, and the rounding.
fn assert_length(found: CoverageInterval, stated: [f64; 2], unit: f64, u: f64) {
    let length = stated[1] - stated[0];
    let scatter = 3.0 * 0.0044 * u;
    assert_stated("length", found.length(), length, 2.0 * unit, scatter);
}

/// Returns the p quantile of the sum of rectangular quantities around 0, whose density is a
/// convolution:
///
/// ```text
/// F(x) = Σ Πsᵢ (x + Σ sᵢ aᵢ)₊ⁿ / (n! Π 2aᵢ)      over all signs sᵢ = ±1
/// ```
fn quantile_of_rectangulars(half_widths: [f64; 4], p: f64) -> f64 {
    let cumulative = |x: f64| {
        let of_signs = |signs: u32| {
            let sign = |i: usize| if signs & (1 << i) == 0 { 1.0 } else { -1.0 };
            let end: f64 = (0..4).map(|i| sign(i) * half_widths[i]).sum();
            (0..4).map(sign).product::<f64>() * (x + end).max(0.0).powi(4)
        };
        let widths: f64 = half_widths.iter().map(|half| 2.0 * half).product();
        (0..16).map(of_signs).sum::<f64>() / (24.0 * widths)
    };
    let end: f64 = half_widths.iter().sum();
    let (mut low, mut high) = (-end, end);
    for _ in 0..60 {
        let middle = 0.5 * (low + high);
        if cumulative(middle) < p {
            low = middle;
        } else {
            high = middle;
        }
    }
    low
}

/// § 9.2: a sum of four quantities. The tolerance is divided by 5, as the document does.
#[test]
fn the_additive_model_has_the_stated_intervals() {
    let sum = |x: &[f64]| x.iter().sum::<f64>();
    let root = 3.0_f64.sqrt();
    let wide = rectangular(-10.0 * root, 10.0 * root);
    let unit = rectangular(-root, root);
    let quantile = |last| quantile_of_rectangulars([root, root, root, last], 0.975);
    // Annex E.2 of the document.
    assert!(
        (quantile(root) - 2.0 * root * (2.0 - 0.6_f64.powf(0.25))).abs() < 1e-12,
        "closed forms"
    );
    let normals = vec![normal(0.0, 1.0); 4];
    let one_wide = vec![unit, unit, unit, wide];
    let at = 2.0 * 1.959_964;
    // Tables 2 to 4: inputs, standard uncertainty, upper ends by trials and by first order, the
    // unit of their last digit, and the exact upper end.
    for (inputs, [u, by_trials, by_first_order, digit, exact]) in [
        (normals, [2.00, 3.92, 3.92, 0.01, at]),
        (vec![unit; 4], [2.00, 3.88, 3.92, 0.01, quantile(root)]),
        (one_wide, [10.1, 17.0, 19.9, 0.1, quantile(10.0 * root)]),
    ] {
        let inputs = independent(inputs);
        let first_order = FirstOrder::new(&inputs, sum).unwrap();
        assert_stated("u(y)", first_order.combined(), u, digit, 0.0);
        let ends = [-by_first_order, by_first_order];
        assert_interval(first_order.interval(P95), ends, digit, 0.0);
        let options = PropagationOptions {
            tolerance_divisor: 5.0,
            ..PropagationOptions::default()
        };
        let trials = Propagation::new(&inputs, sum, options).unwrap();
        assert!(trials.is_stable(), "{}", trials.largest_error());
        let scatter = trials.tolerance();
        assert_stated("y", trials.estimate(), 0.0, digit, scatter);
        assert_stated("u(y)", trials.uncertainty(), u, digit, scatter);
        assert_interval(trials.interval(), [-by_trials, by_trials], digit, scatter);
        assert_interval(trials.interval(), [-exact, exact], 0.0, scatter);
        // Validated where the ends agree to half a unit of the second digit of u: δ = 0.05 and 0.5.
        let is_close = by_first_order - by_trials < 0.05;
        let validation = trials.validate(&first_order);
        assert_eq!(validation.is_valid(), is_close, "{validation:?}");
    }
}

/// § 9.3: the deviation of a weight from its nominal mass, in mg and kg/m³.
#[test]
fn the_calibration_of_a_mass_has_the_stated_results() {
    const NOMINAL: f64 = 100_000.0;
    let inputs = independent(vec![
        normal(NOMINAL, 0.050),
        normal(1.234, 0.020),
        rectangular(1.10, 1.30),
        rectangular(7000.0, 9000.0),
        rectangular(7950.0, 8050.0),
    ]);
    let model = |x: &[f64]| {
        let buoyancy = (x[2] - 1.2) * (1.0 / x[3] - 1.0 / x[4]);
        (x[0] + x[1]) * (1.0 + buoyancy) - NOMINAL
    };
    // Table 6, by first order; the derivatives by the densities vanish.
    let first_order = FirstOrder::new(&inputs, model).unwrap();
    assert_stated("y", first_order.estimate(), 1.2340, 1e-4, 0.0);
    assert_stated("u(y)", first_order.combined(), 0.0539, 1e-4, 0.0);
    assert_interval(first_order.interval(P95), [1.1285, 1.3395], 1e-4, 0.0);
    // By trials whose tolerance is that of one digit, divided by 10.
    let options = PropagationOptions {
        digits: 1,
        tolerance_divisor: 10.0,
        ..PropagationOptions::default()
    };
    let trials = Propagation::new(&inputs, model, options).unwrap();
    assert!(trials.is_stable(), "{}", trials.largest_error());
    let scatter = trials.tolerance();
    assert_stated("y", trials.estimate(), 1.2341, 1e-4, scatter);
    assert_stated("u(y)", trials.uncertainty(), 0.0754, 1e-4, scatter);
    let u = trials.uncertainty();
    assert_length(trials.interval(), [1.0834, 1.3825], 1e-4, u);
    let validation = trials.validate(&first_order);
    assert_stated("tolerance", validation.tolerance, 0.005, 0.0, 1e-15);
    assert!(!validation.is_valid(), "{validation:?}");
    // V = u₁² + u₂² + m² V(ρ_a) E((1/ρ_W − 1/ρ_R)²), with E(1/ρ) = ln(b/a)/(b − a), E(1/ρ²) =
    // 1/(ab).
    let [mean, other] =
        [(7000.0_f64, 9000.0_f64), (7950.0, 8050.0)].map(|(a, b)| libm::log(b / a) / (b - a));
    let square = 1.0 / 63e6 + 1.0 / (7950.0 * 8050.0) - 2.0 * mean * other;
    let variance = 0.05_f64.powi(2) + 0.02_f64.powi(2) + (NOMINAL * 0.1).powi(2) / 3.0 * square;
    assert_stated("u(y)", trials.uncertainty(), variance.sqrt(), 0.0, scatter);
}

/// § 9.4: the loss X₁² + X₂² in the comparison of power meters, in units of 10⁻⁶, and its shortest
/// intervals.
#[test]
fn the_comparison_loss_has_the_stated_results() {
    const UNIT: f64 = 1e-6;
    // Correlation, x₁, y and u(y); the interval by trials and by first order.
    for ([coefficient, at, estimate, uncertainty], shortest, by_first_order) in [
        ([0.0, 0.0, 50.0, 50.0], [0.0, 150.0], [0.0, 0.0]),
        ([0.0, 0.010, 150.0, 112.0], [0.0, 367.0], [-96.0, 296.0]),
        (
            [0.0, 0.050, 2551.0, 502.0],
            [1590.0, 3543.0],
            [1520.0, 3480.0],
        ),
        ([0.9, 0.0, 50.0, 67.0], [0.0, 185.0], [0.0, 0.0]),
        ([0.9, 0.010, 150.0, 121.0], [13.0, 398.0], [-96.0, 296.0]),
        (
            [0.9, 0.050, 2551.0, 505.0],
            [1628.0, 3555.0],
            [1520.0, 3480.0],
        ),
    ] {
        let between = [0, 1];
        let correlation = Correlation {
            between,
            coefficient,
        };
        let all = vec![normal(at, 0.005), normal(0.0, 0.005)];
        let inputs = Inputs::correlated(all, &[correlation]).unwrap();
        let model = |x: &[f64]| (x[0] * x[0] + x[1] * x[1]) / UNIT;
        let first_order = FirstOrder::new(&inputs, model).unwrap();
        assert_interval(first_order.interval(P95), by_first_order, 1.0, 0.0);
        let options = PropagationOptions {
            interval: IntervalKind::Shortest,
            max_trials: 2_000_000,
            ..PropagationOptions::default()
        };
        let trials = Propagation::new(&inputs, model, options).unwrap();
        let scatter = trials.largest_error();
        // V = 2 Σλ² + 4 x₁² u², with the eigenvalues λ = (1 ± r) u² of the covariance.
        let square = 0.005_f64.powi(2) / UNIT;
        let variance = 4.0 * square * (square * (1.0 + coefficient * coefficient) + at * at / UNIT);
        let mean = at * at / UNIT + 2.0 * square;
        let (y, u) = (trials.estimate(), trials.uncertainty());
        assert_stated("y", y, mean, 0.0, scatter);
        assert_stated("u(y)", u, variance.sqrt(), 0.0, scatter);
        assert_stated("y", y, estimate, 1.0, scatter);
        assert_stated("u(y)", u, uncertainty, 1.0, scatter);
        assert_length(trials.interval(), shortest, 1.0, variance.sqrt());
    }
}

#[test]
fn the_gauge_block_has_the_stated_results() {
    let trapezoid = |half: f64, d: f64, r: &[f64]| (half + d * r[0]) * r[1];
    let within = rectangular(-1.0, 1.0);
    let mut all = vec![
        student(50_000_623.0, 25.0, 18.0),
        student(215.0, 6.0, 24.0),
        student(0.0, 4.0, 5.0),
        student(0.0, 7.0, 8.0),
        rectangular(9.5e-6, 13.5e-6),
        normal(-0.1, 0.2),
        input(0.0, 0.5 / 2.0_f64.sqrt(), Distribution::Arcsine),
    ];
    all.extend([within; 4]);
    let inputs = independent(all);
    let model = |x: &[f64]| {
        let expansion = trapezoid(1e-6, 0.1e-6, &x[7..9]);
        let temperature = trapezoid(0.050, 0.025, &x[9..11]);
        let thermal = x[0] * (expansion * (x[5] + x[6]) + x[4] * temperature);
        x[0] + x[1] + x[2] + x[3] - thermal - 50_000_000.0
    };
    let options = PropagationOptions {
        probability: CoverageProbability::P99,
        interval: IntervalKind::Shortest,
        ..PropagationOptions::default()
    };
    let trials = Propagation::new(&inputs, model, options).unwrap();
    assert!(trials.is_stable(), "{}", trials.largest_error());
    let scatter = trials.tolerance();
    assert_stated("y", trials.estimate(), 838.0, 1.0, scatter);
    assert_stated("u(y)", trials.uncertainty(), 36.0, 1.0, scatter);
    assert_interval(trials.interval(), [745.0, 932.0], 1.0, scatter);
    // Variances of t distributions, and L² E(α²) V(δθ) + L² V(δα) E(θ²); a trapezoid has half²/3 +
    // d²/9.
    let of_lengths: f64 = inputs.as_slice()[..4]
        .iter()
        .map(|x| x.standard_deviation().powi(2))
        .sum();
    let of = |half: f64, d: f64| half * half / 3.0 + d * d / 9.0;
    let expansion = 11.5e-6_f64.powi(2) + of(2e-6, 0.0);
    let temperature = 0.1_f64.powi(2) + 0.2_f64.powi(2) + 0.5_f64.powi(2) / 2.0;
    let thermal = expansion * of(0.050, 0.025) + of(1e-6, 0.1e-6) * temperature;
    let variance = of_lengths + 5e7_f64.powi(2) * thermal;
    assert_stated("u(y)", trials.uncertainty(), variance.sqrt(), 0.0, scatter);
}
