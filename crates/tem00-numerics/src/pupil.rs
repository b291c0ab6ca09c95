use core::f64::consts::{FRAC_2_PI, FRAC_PI_2, PI};

/// Returns the normalised overlap of two discs of equal diameter, the function called *chat*.
///
/// `shift` is the distance of the centres in units of the diameter.
///
/// ```text
/// chat(ρ) = (2/π) (acos ρ − ρ √(1 − ρ²))    0 ≤ ρ ≤ 1
/// chat(ρ) = 0                               ρ ≥ 1
/// ```
///
/// It is the optical transfer function of a circular pupil, the amplitude correlation of two
/// speckle fields whose pupils are displaced by ρ diameters, and the shape of the power spectrum of
/// a speckle pattern. The function is even; the sign of `shift` does not matter.
///
/// # References
///
/// - J. W. Goodman, *Introduction to Fourier Optics*, 2005, §6.3.
pub fn disc_overlap(shift: f64) -> f64 {
    let rho = shift.abs();
    if rho >= 1.0 {
        return 0.0;
    }
    if rho > SERIES_LIMIT {
        return overlap_near_one(1.0 - rho);
    }
    FRAC_2_PI * (rho.acos() - rho * ((1.0 - rho) * (1.0 + rho)).sqrt())
}

/// From here on the difference in the closed form cancels and the series is more exact.
const SERIES_LIMIT: f64 = 0.99;

/// chat(1 − ε) = (8√2 / 3π) ε^(3/2) (1 − 3ε/20 − 3ε²/224 − ε³/384 − …), from integrating
/// −chat′ = (4/π) √(2ε − ε²) term by term. At ε = 0.01 the first term left out is 9e−12.
fn overlap_near_one(epsilon: f64) -> f64 {
    let leading = 8.0 * core::f64::consts::SQRT_2 / (3.0 * PI) * epsilon * epsilon.sqrt();
    leading * (1.0 - epsilon * (3.0 / 20.0 + epsilon * (3.0 / 224.0 + epsilon / 384.0)))
}

/// Returns the shift ρ in [0, 1], in units of the diameter, at which [`disc_overlap`] is `overlap`.
///
/// An overlap of 1 or more needs no shift and one of 0 or less is reached at ρ = 1, so that values
/// with rounding noise at either end are mapped to the end.
pub fn disc_overlap_inverse(overlap: f64) -> f64 {
    if overlap >= 1.0 {
        return 0.0;
    }
    if overlap.is_nan() || overlap <= 0.0 {
        return 1.0;
    }
    // ρ = cos(φ/2) turns chat into (φ − sin φ)/π, which is Kepler's equation at eccentricity 1.
    (0.5 * kepler(PI * overlap)).cos()
}

/// Solves φ − sin φ = `area` for φ in (0, π), by Newton's method inside a shrinking bracket.
fn kepler(area: f64) -> f64 {
    let (mut low, mut high) = (0.0, PI);
    // φ³/6 ≈ φ − sin φ for small φ.
    let mut phi = (6.0 * area).cbrt().min(PI);
    for _ in 0..60 {
        let excess = segment(phi) - area;
        if excess > 0.0 {
            high = phi;
        } else {
            low = phi;
        }
        let slope = 2.0 * (0.5 * phi).sin().powi(2);
        let newton = phi - excess / slope;
        let next = if newton > low && newton < high {
            newton
        } else {
            0.5 * (low + high)
        };
        if (next - phi).abs() <= f64::EPSILON * phi {
            return next;
        }
        phi = next;
    }
    phi
}

/// φ − sin φ without cancellation for small φ.
fn segment(phi: f64) -> f64 {
    if phi > 0.2 {
        return phi - phi.sin();
    }
    let p2 = phi * phi;
    // The first term left out is φ¹⁰/39916800 · 6 relative, 2e−14 at φ = 0.2.
    phi * p2 / 6.0 * (1.0 - p2 / 20.0 * (1.0 - p2 / 42.0 * (1.0 - p2 / 72.0)))
}

/// Returns `jinc(x) = 2 J₁(x) / x`, which is 1 at x = 0.
///
/// The amplitude of the Airy pattern of a circular pupil; its first zero lies at x = 3.8317.
pub fn jinc(x: f64) -> f64 {
    if x.abs() < 1e-4 {
        // 1 − x²/8 + x⁴/192: the last term is below 1e−18.
        return 1.0 - x * x / 8.0;
    }
    2.0 * libm::j1(x) / x
}

/// Returns `sinc(x) = sin(x) / x`, which is 1 at x = 0 and 0 at infinity.
pub fn sinc(x: f64) -> f64 {
    if x.is_infinite() {
        return 0.0;
    }
    if x.abs() < 1e-4 {
        // 1 − x²/6 + x⁴/120: the last term is below 1e−18.
        return 1.0 - x * x / 6.0;
    }
    x.sin() / x
}

/// Returns the x in [0, π] at which [`sinc`] is `value`, on the branch before the first zero.
///
/// A value of 1 or more is reached at x = 0 and one of 0 or less at x = π.
pub fn sinc_inverse(value: f64) -> f64 {
    if value >= 1.0 {
        return 0.0;
    }
    if value.is_nan() || value <= 0.0 {
        return PI;
    }
    // sin(x)/x falls monotonically on (0, π): bisection down to rounding.
    let (mut low, mut high) = (0.0, PI);
    while high - low > f64::EPSILON * high {
        let middle = 0.5 * (low + high);
        if middle <= low || middle >= high {
            break;
        }
        if sinc(middle) > value {
            low = middle;
        } else {
            high = middle;
        }
    }
    0.5 * (low + high)
}

/// Returns the overlap of two discs on a circular path, `angle` half-turns apart.
///
/// The path's diameter is the discs' diameter, so that discs half a turn apart just cease to
/// overlap:
///
/// ```text
/// chat(sin(π x / 2)) = 1 − x − sin(π x) / π        0 ≤ x ≤ 1
/// ```
///
/// The function is even and has the period 2, one full turn.
pub fn circular_path_overlap(angle: f64) -> f64 {
    let reduced = angle.rem_euclid(2.0);
    let half_turns = reduced.min(2.0 - reduced);
    disc_overlap((FRAC_PI_2 * half_turns).sin())
}

/// Returns the `angle` in [0, 1], in half-turns, at which [`circular_path_overlap`] is `overlap`.
///
/// Values outside [0, 1] map to the nearer end, as in [`disc_overlap_inverse`].
pub fn circular_path_overlap_inverse(overlap: f64) -> f64 {
    FRAC_2_PI * disc_overlap_inverse(overlap).asin()
}

#[cfg(test)]
mod tests {
    use approx::assert_relative_eq;
    use proptest::prelude::*;

    use super::*;

    /// The overlap by quadrature: the lens is twice the area of a circular segment.
    fn overlap_by_quadrature(rho: f64) -> f64 {
        const STEPS: u32 = 200_000;
        // With t = cos φ the area 4/π ∫ √(1−t²) dt from ρ to 1 has a smooth integrand.
        let end = rho.acos();
        let h = end / f64::from(STEPS);
        let sum: f64 = (0..STEPS)
            .map(|i| (h * (f64::from(i) + 0.5)).sin().powi(2))
            .sum();
        4.0 / PI * sum * h
    }

    #[test]
    fn disc_overlap_matches_quadrature() {
        for rho in [0.0, 0.1, 0.25, 0.5, 0.75, 0.985, 0.995, 0.9999] {
            // The midpoint rule with h = 1e−5 is exact to h² ≈ 1e−10 relative.
            assert_relative_eq!(
                disc_overlap(rho),
                overlap_by_quadrature(rho),
                max_relative = 1e-9
            );
        }
    }

    #[test]
    fn closed_form_and_series_of_the_overlap_meet() {
        let below = disc_overlap(SERIES_LIMIT - 1e-15);
        let above = disc_overlap(SERIES_LIMIT + 1e-15);
        assert_relative_eq!(below, above, max_relative = 1e-11);
    }

    #[test]
    fn overlap_beyond_contact_is_zero() {
        for shift in [1.0, -1.0, 1.5, f64::INFINITY] {
            assert!(disc_overlap(shift).abs() < f64::MIN_POSITIVE, "at {shift}");
        }
    }

    #[test]
    fn pupil_functions_vanish_at_infinity() {
        for x in [f64::INFINITY, f64::NEG_INFINITY] {
            assert!(sinc(x).abs() < f64::MIN_POSITIVE, "sinc({x}) = {}", sinc(x));
            assert!(jinc(x).abs() < f64::MIN_POSITIVE, "jinc({x}) = {}", jinc(x));
        }
    }

    #[test]
    fn airy_amplitude_vanishes_at_its_first_zero() {
        // The first zero of J₁ (Abramowitz & Stegun 1964, table 9.5).
        assert!(jinc(3.831_705_970_207_512).abs() < 1e-15, "not a zero");
        // Both sides of the switch to the series; the slope there is −x/4 = −2.5e−5.
        assert_relative_eq!(jinc(0.999_999e-4), jinc(1.000_001e-4), epsilon = 1e-14);
        assert_relative_eq!(sinc(0.999_999e-4), sinc(1.000_001e-4), epsilon = 1e-14);
    }

    #[test]
    fn overlap_on_the_circle_is_the_law_of_the_stack() {
        for step in 0..=40_u32 {
            let x = f64::from(step) / 40.0;
            let law = 1.0 - x - (PI * x).sin() / PI;
            // Absolute, since the law itself cancels near x = 1.
            assert!((circular_path_overlap(x) - law).abs() < 1e-14, "x = {x}");
            assert!(
                (circular_path_overlap(2.0 - x) - law).abs() < 1e-14,
                "wrap at {x}"
            );
        }
    }

    proptest! {
        #[test]
        fn inverse_of_the_overlap_recovers_the_shift(rho in 0.0_f64..1.0) {
            // chat′(0) = −4/π, chat′(1) = 0: rounding of the overlap, ε, moves ρ by ε/|chat′|,
            // which is ε^(2/3) at worst.
            let tolerance = 1e-10;
            prop_assert!((disc_overlap_inverse(disc_overlap(rho)) - rho).abs() < tolerance);
        }

        #[test]
        fn inverse_of_sinc_recovers_its_argument(x in 1e-3_f64..3.1) {
            // sinc′(x) ≈ −x/3: rounding moves x by 3 ε / x ≤ 7e−13.
            prop_assert!((sinc_inverse(sinc(x)) - x).abs() < 1e-12);
        }

        #[test]
        fn inverses_stay_in_range(value in proptest::num::f64::ANY) {
            prop_assert!((0.0..=1.0).contains(&disc_overlap_inverse(value)));
            prop_assert!((0.0..=PI).contains(&sinc_inverse(value)));
            prop_assert!((0.0..=1.0).contains(&circular_path_overlap_inverse(value)));
        }
    }
}
