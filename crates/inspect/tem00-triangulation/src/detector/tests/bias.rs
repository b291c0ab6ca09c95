use tem00_testkit::{assert_absolute, assert_relative};

use super::*;

/// The estimated less the true position of a pixel-integrated line.
fn bias(method: LineMethod, window: usize, sigma: f64, phase: f64) -> f64 {
    let centre = MIDDLE + phase;
    let point = only(
        &detector(method, window),
        &integrated(LENGTH, centre, sigma),
    );
    assert_eq!(point.validity, Validity::Valid, "{method} at {phase}");
    point.position - centre
}

/// Compares with a law of the phase for some widths, all within `tolerance` pixels.
fn compare(method: LineMethod, sigmas: &[f64], tolerance: f64, law: impl Fn(f64, f64) -> f64) {
    for &sigma in sigmas {
        for phase in phases() {
            let (got, expected) = (bias(method, 31, sigma, phase), law(sigma, phase));
            assert_absolute(got, expected, tolerance);
        }
    }
}

#[test]
fn centre_of_gravity_errs_by_the_light_outside_of_the_window() {
    // Over the window from a to b: ∫ y f dy = −σ² (f(b) − f(a)), and pixels, whose light counts at
    // their middle, take 1/12 of the same difference more (Euler and Maclaurin). Their next term is
    // of the order of f''/500: 2e−5 f(b)/σ² f(0)⁻¹ < 2e−6. The rounding of 31 pixels adds 1e−6.
    let law = |sigma: f64, phase: f64| {
        let (a, b) = (-15.5 - phase, 15.5 - phase);
        let light = cumulative(b, sigma) - cumulative(a, sigma);
        -(sigma * sigma + 1.0 / 12.0) * (density(b, sigma) - density(a, sigma)) / light
    };
    compare(
        LineMethod::CentreOfGravity,
        &[1.0, 3.0, 5.0, 10.0],
        3e-6,
        law,
    );
    assert!(
        law(10.0, 0.4).abs() > 0.1,
        "a window of three radii is short"
    );
}

#[test]
fn a_window_about_the_line_itself_cuts_as_much_from_both_sides() {
    // Grey values are constant over a pixel. Of the pixels at the ends of the window, x and 1 − x
    // of them inside, the light is off by f' x (1 − x)/2 on both sides alike, and by f'' x (1 −
    // x)(1 − 2x)/6, at most f''/62, the other way. That is 31 pixels apart; the window that follows
    // makes it more.
    let b = 15.5;
    for sigma in [1.0_f64, 3.0, 5.0, 10.0] {
        let f = density(b, sigma);
        let second = f * (b * b / sigma.powi(4) - 1.0 / (sigma * sigma));
        let light = 1.0 - 2.0 * cumulative(-b, sigma);
        let max = 31.0 * second.abs() / 62.0 / (light - 31.0 * f);
        assert!(max < 4e-4, "the bound says something: {max}");
        let method = LineMethod::IteratedCentreOfGravity;
        compare(method, &[sigma], max + 1e-6, |_, _| 0.0);
    }
}

#[test]
fn a_threshold_at_zero_is_no_threshold() {
    let method = LineMethod::ThresholdedCentreOfGravity { threshold: 0.0 };
    let plain = |sigma, phase| bias(LineMethod::CentreOfGravity, 31, sigma, phase);
    compare(method, &[1.0, 5.0], 1e-12, plain);
}

#[test]
fn a_threshold_lets_only_the_pixels_at_it_err() {
    // What lies above t f(0) is symmetric. The pixels in which the flanks cross the threshold see
    // the part of a triangle: of the slope s over the width 1 at most s/8 too much or too little,
    // at the distance σ √(2 ln 1/t) on both sides. With the light above the threshold below:
    let (t, sigma) = (0.2_f64, 2.0);
    let reach = sigma * (2.0 * (1.0 / t).ln()).sqrt();
    let slope = reach / (sigma * sigma) * density(reach, sigma);
    let light = 1.0 - 2.0 * cumulative(-reach, sigma) - 2.0 * reach * density(reach, sigma);
    let max = 2.0 * reach * slope / 8.0 / light;
    assert!(max < 0.2, "the bound says something: {max}");
    let method = LineMethod::ThresholdedCentreOfGravity { threshold: t };
    compare(method, &[sigma], max, |_, _| 0.0);
}

#[test]
fn three_point_methods_err_on_points_as_their_formulas_say() {
    // With the values e^{−(k − δ)²/2σ²}, k = −1, 0, 1, and without the factor that all have:
    // parabola (I₊ − I₋)/(2 (2 I₀ − I₋ − I₊)) = sinh(δ/σ²) / (2 (e^{1/2σ²} − cosh(δ/σ²))).
    // The rounding of f32 counts against the curvature, 1/σ² of the peak: 1e−7 σ².
    let parabola = |s: f64, d: f64| {
        let x = d / (s * s);
        x.sinh() / (2.0 * ((0.5 / (s * s)).exp() - x.cosh()))
    };
    let linear = |s: f64, d: f64| {
        let x = d / (s * s);
        x.sinh() / ((0.5 / (s * s)).exp() - (-x.abs()).exp())
    };
    type Law<'a> = &'a dyn Fn(f64, f64) -> f64;
    let laws: [(LineMethod, Law<'_>); 3] = [
        (LineMethod::Parabola, &parabola),
        (LineMethod::LinearInterpolation, &linear),
        (LineMethod::LogGaussian, &|_, d| d),
    ];
    for (method, law) in laws {
        let sigmas = [0.7, 1.0, 2.0, 4.0].into_iter();
        for (sigma, phase) in sigmas.flat_map(|s| phases().map(move |d| (s, d))) {
            let column = sampled(LENGTH, MIDDLE + phase, sigma);
            let got = only(&detector(method, 31), &column).position - MIDDLE;
            let expected = law(sigma, phase);
            assert_absolute(got, expected, 2e-7 * (1.0 + sigma * sigma));
        }
    }
}

#[test]
fn pixels_draw_the_logarithmic_fit_by_the_sixth_power_of_their_size() {
    // A pixel adds ln(1 + (y²/σ⁴ − 1/σ²)/24 + …) to the logarithm. What is quadratic in y only
    // widens the line; the term y⁴/(2880 σ⁸) that is left moves the vertex by δ (1 − 4 δ²) / (1440
    // σ⁶). The next order is 1/σ² of it: 7 · 10⁻⁵/σ⁸ with a factor of about one. Rounding: 2e−7 σ².
    for sigma in [1.0, 1.3] {
        let tolerance = 7e-5 * f64::powi(sigma, -8) + 5e-7;
        compare(LineMethod::LogGaussian, &[sigma], tolerance, |s, d| {
            d * (1.0 - 4.0 * d * d) / (1440.0 * s.powi(6))
        });
    }
}

#[test]
fn the_parabola_errs_on_pixels_as_their_integrals_say() {
    let law = |sigma: f64, phase: f64| {
        let pixel =
            |k: f64| cumulative(k + 0.5 - phase, sigma) - cumulative(k - 0.5 - phase, sigma);
        let [before, at, after] = [-1.0, 0.0, 1.0].map(pixel);
        (after - before) / (2.0 * (2.0 * at - before - after)) - phase
    };
    compare(LineMethod::Parabola, &[0.5, 1.0, 3.0], 2e-6, law);
    assert!(
        law(0.5, 0.25).abs() > 0.04,
        "thin lines are drawn to the pixels"
    );
}

#[test]
fn filters_err_as_the_light_below_the_edges_of_their_taps_says() {
    // With F the light below an edge, the taps before pixel i hold F(i) − F(i−m), those after it
    // F(i+1+m) − F(i+1): the filtered derivative at i is the difference.
    for taps in [2, 4, 8] {
        let law = |sigma: f64, phase: f64| {
            let m = f64::from(u32::try_from(taps).unwrap()) / 2.0;
            let light = |edge: f64| cumulative(edge - phase, sigma);
            let filtered =
                |i: f64| light(i - 0.5) - light(i - 0.5 - m) - light(i + 0.5 + m) + light(i + 0.5);
            let i = if phase < 0.0 { -1.0 } else { 0.0 };
            i + filtered(i) / (filtered(i) - filtered(i + 1.0)) - phase
        };
        // The slope of the filtered derivative is about m²/σ² of the peak: rounding counts σ²/m²
        // times.
        compare(order(taps), &[1.0, 2.0, 4.0], 5e-6, law);
        assert!(law(1.0, 0.25).abs() > 1e-3, "{taps} taps err");
    }
}

#[test]
fn the_fit_finds_the_line_that_the_pixels_integrated() {
    // The fit goes on until a step is 1e−11 pixels; what is left is rounding, 6e−8 · σ.
    for sigma in [0.5, 1.0, 3.0, 5.0] {
        for phase in phases() {
            let column = integrated(LENGTH, MIDDLE + phase, sigma);
            let raised: Vec<f32> = column.iter().map(|value| value + 250.0).collect();
            let point = only(&detector(LineMethod::GaussianFit, 31), &raised);
            assert_absolute(point.position, MIDDLE + phase, 2e-6);
            assert_relative(point.width, 4.0 * sigma, 2e-6);
            assert_absolute(point.background, 250.0, 1e-9);
        }
    }
}

#[test]
fn one_step_of_steger_errs_by_the_cube_of_the_distance() {
    // The line, convolved with the Gaussian, its pixels and those of the kernel, is all but a
    // Gaussian of s² = σ² + σ_l² + 1/6. At the distance δ from its middle −r'/r'' = δ / (1 −
    // δ²/s²). The boxes of the pixels have the fourth cumulant −1/120 each, together −4e−3 s⁴ of
    // the thinnest: half of that times δ is 8e−4. The kernel ends at 4 standard deviations, where
    // it is 3e−4.
    for kernel in [1.0, 2.0, 3.0] {
        let law = |sigma: f64, phase: f64| {
            let s = kernel * kernel + sigma * sigma + 1.0 / 6.0;
            phase / (1.0 - phase * phase / s) - phase
        };
        compare(LineMethod::Steger { sigma: kernel }, &[1.0, 3.0], 1e-3, law);
    }
}

#[test]
fn a_point_tells_width_peak_light_and_background() {
    for sigma in [1.5, 3.0, 5.0] {
        let column = integrated(LENGTH, MIDDLE + 0.3, sigma);
        let raised: Vec<f32> = column.iter().map(|value| value + 100.0).collect();
        let point = only(&detector(LineMethod::CentreOfGravity, 61), &raised);
        let width = point.width / (4.0 * sigma) - 1.0;
        // Interpolation widens, at most by 1/(8 σ²).
        assert!(
            (0.0..=1.0 / (8.0 * sigma * sigma)).contains(&width),
            "{width}"
        );
        assert_relative(point.integral, PEAK * TAU.sqrt() * sigma, 1e-6);
        assert_absolute(point.background, 100.0, 1e-9);
        // The pixel 0.3 from the middle, less the sagitta of its integral.
        let peak = PEAK * (1.0 - (0.3_f64.powi(2) + 1.0 / 12.0) / (2.0 * sigma * sigma));
        assert_relative(point.peak, peak, 5e-3);
    }
}
